#include "bench/device_rivals.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace clshade {

/// Generated from bench/kernels by cmake/EmbedText.cmake: file name and text.
std::vector<std::pair<std::string, std::string>> embedded_rivals();

namespace {

constexpr std::size_t local_size = 64; // as the shading kernels; the size does not matter on CPU devices

Program stream_program(Device& device, int planes_in, int planes_out, int lanes) {
    const std::string options =
        fmt::format("-cl-std=CL1.2 -DLANES={} -DPLANES_IN={} -DPLANES_OUT={}", lanes, planes_in, planes_out);
    return {device, rival_sources(), "stream.cl", options, ProgramCache::standard()};
}

} // namespace

SourceSet rival_sources() {
    SourceSet sources;
    for (auto& [name, text] : embedded_rivals()) {
        sources.add(name, std::move(text), "bench/kernels/" + name);
    }
    return sources;
}

StreamRival::StreamRival(Device& device, std::shared_ptr<PictureMemory> memory, std::size_t plane_stride, int planes_in,
                         int planes_out, int lanes)
    : memory_(std::move(memory)), kernel_(stream_program(device, planes_in, planes_out, lanes), "stream"),
      work_items_(memory_->result.padded_pixels() / static_cast<std::size_t>(lanes)) {
    const auto units = static_cast<std::size_t>(lanes);
    kernel_.set_argument(0, memory_->plane_buffer);
    kernel_.set_argument(1, static_cast<std::uint32_t>(plane_stride / units));
    kernel_.set_argument(2, memory_->result_buffer);
    kernel_.set_argument(3, static_cast<std::uint32_t>(memory_->result.stride() / units));
}

double StreamRival::run() {
    kernel_.launch(work_items_, local_size);
    return kernel_.wait_milliseconds();
}

} // namespace clshade
