#include "bench/batch_encode.h"

#include "bench/batch_folder.h"
#include "bench/batch_sequence.h"
#include "bench/round_robin.h"
#include "bench/statistics.h"
#include "host/base/error.h"
#include "host/images/image_reader.h"

#include <array>
#include <chrono>

namespace clshade {

namespace {

constexpr std::array<const char*, 4> names{"R", "G", "B", "A"};

PlaneSlab shaded_picture(BatchContestant& ours, const BatchRow& row, const BatchFolder& folder) {
    write_sequence_frame(folder.inputs().front(), {row.width, row.height, row.half, "none"}, 0);
    (void)ours.run({folder.inputs(), folder.ours(), row.half, "none"});
    const ImageLayout layout = read_layout(folder.ours().front());
    std::vector<int> channels;
    for (const char* const name : names) {
        for (std::size_t i = 0; i < layout.channels.size(); ++i) {
            if (layout.channels[i].name == name) {
                channels.push_back(static_cast<int>(i));
            }
        }
    }
    PlaneSlab planes(row.width, row.height, static_cast<int>(names.size()));
    PlaneReader(folder.ours().front(), layout, channels, layout.parts.front().data_window).read(0, planes);
    return planes;
}

} // namespace

BenchResult time_encoding(BatchContestant& ours, const BatchRow& row, const BenchOptions& options) {
    const BatchFolder folder(1);
    const PlaneSlab planes = shaded_picture(ours, row, folder);
    OutputImage image;
    image.data_window = {0, 0, row.width - 1, row.height - 1};
    image.display_window = image.data_window;
    for (std::size_t i = 0; i < names.size(); ++i) {
        image.channels.push_back({names[i], &planes, static_cast<int>(i), false});
    }
    const ExrSettings settings = encoding_of(row.half, row.compression);
    WrittenFile written;
    const auto write = [&] {
        folder.settle();
        const auto start = std::chrono::steady_clock::now();
        ExrWriter writer(folder.theirs().front(), image, settings);
        writer.write(image.channels, 0, row.height);
        written = writer.commit();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    RoundSettings rounds;
    rounds.warm_up = 1;
    rounds.rounds = options.quick ? 1 : options.rounds;
    rounds.seconds = 0.0;
    const Timings timings = run_round_robin({{row.key(), write}}, rounds).front();
    if (!timings.error.empty()) {
        throw RuntimeFailure(timings.error);
    }
    const double pixels = static_cast<double>(row.width) * row.height;
    const auto bytes = static_cast<double>(written.bytes);
    BenchResult result;
    result.key = row.key();
    result.width = row.width;
    result.height = row.height;
    result.layers = 0;
    result.rounds = static_cast<int>(timings.milliseconds.size());
    result.median_ms = median(timings.milliseconds);
    result.min_ms = percentile(timings.milliseconds, 0.0);
    result.spread = spread(timings.milliseconds);
    result.bytes_per_pixel = bytes / pixels;
    result.mpix_per_s = pixels * 1e-3 / result.median_ms;
    result.gb_per_s = bytes * 1e-6 / result.median_ms;
    result.batch = {1, 1e3 / result.median_ms, 0.0, bytes, 0.0};
    return result;
}

} // namespace clshade
