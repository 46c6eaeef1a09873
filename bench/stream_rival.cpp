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

StreamRival::StreamRival(Device& device, Frame& frame, int planes_in, int planes_out, int lanes)
    : output_slab_(frame.planes.width(), frame.planes.height(), planes_out),
      input_(device, std::as_writable_bytes(frame.planes.all()), Access::read),
      output_(device, std::as_writable_bytes(output_slab_.all()), Access::write),
      kernel_(stream_program(device, planes_in, planes_out, lanes), "stream"),
      work_items_(frame.planes.padded_pixels() / static_cast<std::size_t>(lanes)) {
    const auto units = static_cast<std::size_t>(lanes);
    input_.upload();
    kernel_.set_argument(0, input_);
    kernel_.set_argument(1, static_cast<std::uint32_t>(frame.planes.stride() / units));
    kernel_.set_argument(2, output_);
    kernel_.set_argument(3, static_cast<std::uint32_t>(output_slab_.stride() / units));
}

double StreamRival::run() {
    kernel_.launch(work_items_, local_size);
    return kernel_.wait_milliseconds();
}

const PlaneSlab& StreamRival::output() {
    output_.download();
    return output_slab_;
}

} // namespace clshade
