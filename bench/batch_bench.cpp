#include "bench/batch_bench.h"

#include "bench/batch_encode.h"
#include "bench/batch_folder.h"
#include "bench/batch_library_rival.h"
#include "bench/batch_oiio_rival.h"
#include "bench/batch_ours.h"
#include "bench/batch_sequence.h"
#include "bench/host_kernels.h"
#include "bench/round_robin.h"
#include "bench/statistics.h"
#include "host/base/error.h"

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

namespace clshade {

namespace {

constexpr int sequence_frames = 12;
/// What a turn lasts at least; fast rows go through the sequence several times. A run begins with the memory of its
/// frames and ends with the last one's encoding: neither should count, as they do not in a night of frames.
constexpr double turn_milliseconds = 4000.0;
constexpr int most_passes = 6;
constexpr std::size_t distinct_frames = 4; ///< the others are copies: making a frame takes longer than shading it
constexpr double library_limit = 1.15;
constexpr double oiio_half_zip_limit = 0.5;
constexpr double oiio_float_none_limit = 0.2;

using Files = std::vector<std::filesystem::path>;

double mean_bytes(const Files& files) {
    double sum = 0.0;
    for (const std::filesystem::path& file : files) {
        sum += static_cast<double>(std::filesystem::file_size(file));
    }
    return sum / static_cast<double>(files.size());
}

rivals::DistantLight light_of(const Light& light) {
    const glm::dvec3 to_light = -glm::normalize(light.direction);
    rivals::DistantLight result{};
    for (int c = 0; c < 3; ++c) {
        result.to_light[c] = static_cast<float>(to_light[c]);
        result.irradiance[c] = static_cast<float>(light.power[c]);
    }
    return result;
}

/// One row: its files, and who works on them.
class BatchMatch {
  public:
    BatchMatch(BatchContestant& ours, const BatchRow& row, int frames, int threads)
        : ours_(&ours), row_(row), folder_(frames), threads_(threads) {}

    [[nodiscard]] BenchResult run(const BenchOptions& options) {
        write_sequence();
        result_.key = row_.key();
        result_.width = row_.width;
        result_.height = row_.height;
        result_.lights = 1;
        const OurRun first = ours_->run(our_work());
        if (!options.quick) {
            passes_ = std::clamp(static_cast<int>(turn_milliseconds / first.milliseconds) + 1, 1, most_passes);
        }
        const auto frames = static_cast<int>(folder_.inputs().size());
        result_.batch = {frames * passes_, 0.0, static_cast<double>(first.bytes_read) / frames,
                         mean_bytes(folder_.ours())};
        enter_ours();
        enter_library();
        enter_oiio();
        RoundSettings settings;
        settings.warm_up = 0; // everything has run once
        settings.rounds = options.quick ? 1 : std::clamp(options.rounds / 3, 1, 5);
        settings.seconds = 0.0;
        timings_ = run_round_robin(contestants_, settings);
        judge();
        return std::move(result_);
    }

  private:
    void write_sequence() const {
        const SequenceFormat format{row_.width, row_.height, row_.half, row_.compression};
        for (std::size_t i = 0; i < folder_.inputs().size(); ++i) {
            if (i < distinct_frames) {
                write_sequence_frame(folder_.inputs()[i], format, static_cast<int>(i));
            } else {
                std::filesystem::copy_file(folder_.inputs()[i % distinct_frames], folder_.inputs()[i]);
            }
        }
    }

    [[nodiscard]] OurWork our_work() const {
        return {again(folder_.inputs()), again(folder_.ours()), row_.half, row_.compression};
    }

    /// As often as a turn goes through the sequence.
    [[nodiscard]] Files again(const Files& files) const {
        Files all;
        for (int pass = 0; pass < passes_; ++pass) {
            all.insert(all.end(), files.begin(), files.end());
        }
        return all;
    }

    void enter_ours() {
        contestants_.push_back({row_.key(), [this] {
                                    folder_.settle();
                                    return ours_->run(our_work()).milliseconds;
                                }});
    }

    /// Every way once; the fastest stands for the library.
    void enter_library() {
        auto work = std::make_shared<BareWork>();
        work->inputs = again(folder_.inputs());
        work->outputs = again(folder_.theirs());
        work->channels = ours_->channels(folder_.inputs().front());
        work->compression = row_.compression;
        work->picture = std::make_shared<StoredPicture>(read_stored_picture(folder_.ours().front()));
        work->threads = threads_;
        std::optional<LibraryPath> best;
        double least = 0.0;
        for (const LibraryPath path : library_paths(row_.compression)) {
            folder_.settle();
            const double milliseconds = decode_and_encode(*work, path);
            if (!best || milliseconds < least) {
                best = path;
                least = milliseconds;
            }
        }
        RivalResult rival;
        rival.name = "decode_encode";
        rival.note = description_of(best.value());
        // What it wrote is what it was given, but for the loss of the compression.
        rival.max_error = stored_difference(read_stored_picture(folder_.theirs().back()), *work->picture);
        if (!row_.compression.starts_with("dwa") && rival.max_error > 0.0) {
            rival.status = BenchStatus::error;
            rival.reason = "its files do not hold the picture that it was given";
            result_.against.push_back(std::move(rival));
            return;
        }
        result_.batch->rival_bytes_written = mean_bytes(folder_.theirs());
        add_rival(std::move(rival), [this, work, path = best.value()] {
            folder_.settle();
            return decode_and_encode(*work, path);
        });
    }

    void enter_oiio() {
        RivalResult rival;
        rival.name = "oiio";
        rival.note = "OpenImageIO, one OpenMP loop";
        if (const std::string trouble = oiio_rival_trouble(); !trouble.empty()) {
            rival.status = BenchStatus::unsupported;
            rival.reason = trouble;
            result_.against.push_back(std::move(rival));
            return;
        }
        auto work = std::make_shared<OiioWork>();
        work->light = light_of(ours_->light());
        work->threads = threads_;
        // Checked on one frame without the rounding of half and the loss of DWA.
        const OurWork exact{{folder_.inputs().front()}, {folder_.ours().front()}, false, "none"};
        (void)ours_->run(exact);
        work->inputs = exact.inputs;
        work->outputs = {folder_.theirs().front()};
        work->half = exact.half;
        work->compression = exact.compression;
        (void)run_oiio_rival(*work);
        rival.max_error =
            stored_difference(read_stored_picture(work->outputs.front()), read_stored_picture(exact.outputs.front()));
        if (!(rival.max_error <= oiio_tolerance)) {
            rival.status = BenchStatus::error;
            rival.reason = fmt::format("its picture differs by {:.2g}, more than {:.2g}; a rival that computes "
                                       "something else is not timed",
                                       rival.max_error, oiio_tolerance);
            result_.against.push_back(std::move(rival));
            return;
        }
        work->inputs = again(folder_.inputs());
        work->outputs = again(folder_.theirs());
        work->half = row_.half;
        work->compression = row_.compression;
        add_rival(std::move(rival), [this, work] {
            folder_.settle();
            return run_oiio_rival(*work);
        });
    }

    void add_rival(RivalResult rival, std::function<double()> run) {
        rivals_.push_back({result_.against.size(), contestants_.size()});
        contestants_.push_back({rival.name, std::move(run)});
        result_.against.push_back(std::move(rival));
    }

    /// Times become times of a frame.
    void judge() {
        const Timings& ours = timings_.front();
        if (!ours.error.empty()) {
            throw RuntimeFailure(ours.error);
        }
        const auto frames = static_cast<double>(result_.batch->frames);
        const double pixels = static_cast<double>(row_.width) * row_.height;
        const double bytes = result_.batch->bytes_read + result_.batch->bytes_written;
        result_.rounds = static_cast<int>(ours.milliseconds.size());
        result_.median_ms = median(ours.milliseconds) / frames;
        result_.min_ms = percentile(ours.milliseconds, 0.0) / frames;
        result_.spread = spread(ours.milliseconds);
        result_.bytes_per_pixel = bytes / pixels;
        result_.mpix_per_s = pixels * 1e-3 / result_.median_ms;
        result_.gb_per_s = bytes * 1e-6 / result_.median_ms;
        result_.batch->frames_per_second = 1e3 / result_.median_ms;
        for (const auto& [index, contestant] : rivals_) {
            RivalResult& rival = result_.against[index];
            const Timings& theirs = timings_.at(contestant);
            if (!theirs.error.empty()) {
                rival.status = BenchStatus::error;
                rival.reason = theirs.error;
                continue;
            }
            rival.rounds = static_cast<int>(theirs.milliseconds.size());
            rival.median_ms = median(theirs.milliseconds) / frames;
            rival.min_ms = percentile(theirs.milliseconds, 0.0) / frames;
            rival.ratio = paired_ratio(ours.milliseconds, theirs.milliseconds);
        }
    }

    struct Entered {
        std::size_t rival;
        std::size_t contestant;
    };

    BatchContestant* ours_;
    BatchRow row_;
    BatchFolder folder_;
    int threads_;
    int passes_ = 1;
    BenchResult result_;
    std::vector<Contestant> contestants_;
    std::vector<Entered> rivals_;
    std::vector<Timings> timings_;
};

BenchResult failed(const BatchRow& row, const std::string& reason) {
    BenchResult result;
    result.key = row.key();
    result.width = row.width;
    result.height = row.height;
    result.status = BenchStatus::error;
    result.reason = reason;
    return result;
}

void judge(std::vector<SpeedLimit>& limits, const BenchResult& row, const char* rival, double limit) {
    for (const RivalResult& each : row.against) {
        if (each.name == rival && each.status == BenchStatus::ok) {
            limits.push_back({fmt::format("{} to {}", row.key, rival), false, limit, each.ratio});
        }
    }
}

} // namespace

std::vector<BenchResult> run_batch_rows(Device& device, const BenchOptions& options, const std::vector<BatchRow>& rows,
                                        const std::function<void(const std::string&)>& tell) {
    std::vector<BenchResult> results;
    if (rows.empty()) {
        return results;
    }
    const int threads = options.threads > 0 ? options.threads : threads_or_all(0);
    BatchContestant ours(device, options, threads);
    const int lanes = options.lanes > 0 ? options.lanes : automatic_lanes(device.info());
    const int frames = options.quick ? 3 : sequence_frames;
    for (const BatchRow& row : rows) {
        tell(row.key());
        try {
            BenchResult result = row.kind == BatchKind::run ? BatchMatch(ours, row, frames, threads).run(options)
                                                            : time_encoding(ours, row, options);
            result.lanes = lanes;
            results.push_back(std::move(result));
        } catch (const UsageError&) {
            throw; // a wrong --kernel-dir or --lanes is the same for every row
        } catch (const std::exception& failure) {
            results.push_back(failed(row, failure.what()));
        }
    }
    return results;
}

std::vector<SpeedLimit> batch_limits(const std::vector<BenchResult>& results) {
    std::vector<SpeedLimit> limits;
    for (const BenchResult& row : results) {
        if (row.status != BenchStatus::ok || !row.batch || row.width != 1920 || row.height != 1080) {
            continue;
        }
        judge(limits, row, "decode_encode", library_limit);
        if (row.key.starts_with("batch.half.zip.")) {
            judge(limits, row, "oiio", oiio_half_zip_limit);
        }
        if (row.key.starts_with("batch.float.none.")) {
            judge(limits, row, "oiio", oiio_float_none_limit);
        }
    }
    return limits;
}

} // namespace clshade
