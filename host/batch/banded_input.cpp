#include "host/batch/banded_input.h"

#include "host/batch/memory.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace clshade {

namespace {

/// Bytes of all samples of a row, needed or not: decoders unpack whole chunks.
std::uint64_t row_bytes(const ImageLayout& layout) {
    std::uint64_t bytes = 0;
    for (const ChannelInfo& channel : layout.channels) {
        const Window& window = layout.parts[static_cast<std::size_t>(channel.part)].data_window;
        bytes += static_cast<std::uint64_t>(window.width()) * (channel.type == SampleType::half ? 2 : 4);
    }
    return bytes;
}

/// A slab of the given height, kept from the last band if that was as high.
void shape(PlaneSlab& planes, int width, int rows, int count) {
    if (planes.width() != width || planes.height() != rows || planes.count() != count) {
        planes = PlaneSlab(); // before the next is made
        planes = PlaneSlab(width, rows, count);
    }
}

} // namespace

BandedInput::BandedInput(PlannedInput input, std::uint64_t memory, int block)
    : reader_(input.file, input.layout, input.plan.channels, input.plan.frame.data_window), loaded_(describe(input)),
      planes_(static_cast<int>(input.plan.channels.size())), kept_(static_cast<int>(input.plan.keep.size())),
      step_(std::lcm(block, reader_.band_rows())) {
    if (step_ > input.plan.frame.data_window.height()) {
        step_ = block; // odd tiles: some are decoded twice
    }
    chunk_bytes_ = row_bytes(input.layout) * static_cast<std::uint64_t>(reader_.band_rows());
    accept(loaded_, finish(input, memory));
}

Frame BandedInput::finish(PlannedInput& input, std::uint64_t memory) {
    Frame band = camera_frame(input.plan);
    std::vector<int> channels;
    for (const int plane : camera_planes(input.plan)) {
        channels.push_back(input.plan.channels[static_cast<std::size_t>(plane)]);
    }
    if (channels.empty()) {
        return finish_frame(std::move(input.plan), [](const auto& /*visit*/) {});
    }
    const int height = band.data_window.height();
    const int width = band.data_window.width();
    const auto count = static_cast<int>(channels.size());
    const std::uint64_t row = static_cast<std::uint64_t>(width + row_alignment) * channels.size() * sizeof(float);
    const auto rows = static_cast<int>(std::clamp<std::uint64_t>(memory / row / static_cast<std::uint64_t>(step_), 1,
                                                                 static_cast<std::uint64_t>(height)) *
                                       static_cast<std::uint64_t>(step_));
    PlaneReader reader(input.file, input.layout, channels, band.data_window);
    Frame frame = finish_frame(std::move(input.plan), [&](const std::function<void(const Frame&)>& visit) {
        for (band.first_row = 0; band.first_row < height; band.first_row += rows) {
            shape(band.planes, width, std::min(rows, height - band.first_row), count);
            reader.read(band.first_row, band.planes);
            visit(band);
        }
    });
    camera_bytes_ = reader.bytes_read();
    return frame;
}

void BandedInput::read(Frame& frame, int first_row, int rows) {
    shape(frame.planes, frame.data_window.width(), rows, planes_);
    frame.first_row = first_row;
    reader_.read(first_row, frame.planes);
}

int BandedInput::largest_band(std::uint64_t memory, int outputs) const {
    const Window& window = loaded_.frame.data_window;
    const std::uint64_t step_bytes = band_memory(window.width(), planes_, outputs + kept_, step_);
    // Packed and unpacked, for a few threads.
    const std::uint64_t scratch = 8 * chunk_bytes_;
    const std::uint64_t steps = memory > scratch ? (memory - scratch) / std::max<std::uint64_t>(step_bytes, 1) : 0;
    return static_cast<int>(std::clamp<std::uint64_t>(steps, 1, static_cast<std::uint64_t>(window.height()))) * step_;
}

} // namespace clshade
