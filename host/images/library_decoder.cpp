#include "host/base/error.h"
#include "host/images/part_decoder.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <new>

namespace clshade {

namespace {

/// OpenEXR addresses pixel (x, y) of the file as base + x * xStride + y * yStride, so the base may lie outside the
/// plane: computed as a number, for it is no valid pointer.
char* base_of(float* plane, const PlaneGeometry& geometry) {
    const std::int64_t offset = std::int64_t{geometry.window.y_min} * geometry.pitch + geometry.window.x_min;
    const auto address = reinterpret_cast<std::uintptr_t>(plane) -
                         static_cast<std::uintptr_t>(offset * static_cast<std::int64_t>(sizeof(float)));
    return reinterpret_cast<char*>(address); // NOLINT(performance-no-int-to-ptr): see above
}

void set_library_threads(int threads) {
    const int workers = threads > 1 ? threads : 0;
    if (Imf::globalThreadCount() != workers) {
        Imf::setGlobalThreadCount(workers);
    }
}

} // namespace

void decode_with_library(const ExrFile& file, int part, const std::vector<PlaneTarget>& targets,
                         const PlaneGeometry& geometry, int threads) {
    try {
        set_library_threads(threads);
        Imf::MultiPartInputFile input(file.name().c_str(), Imf::globalThreadCount(), false);
        Imf::InputPart pixels(input, part);
        Imf::FrameBuffer buffer;
        for (const PlaneTarget& target : targets) {
            buffer.insert(target.channel, Imf::Slice(Imf::FLOAT, base_of(target.plane, geometry), sizeof(float),
                                                     static_cast<std::size_t>(geometry.pitch) * sizeof(float)));
        }
        pixels.setFrameBuffer(buffer);
        const Imath::Box2i& window = pixels.header().dataWindow();
        pixels.readPixels(window.min.y, window.max.y);
    } catch (const std::bad_alloc&) {
        file.fail("not enough memory to decode the pixels; free memory or use fewer threads");
    } catch (const std::exception& error) {
        const std::string label = file.part_label(part);
        file.fail(fmt::format("{}pixels are damaged ({}); render or copy the file again",
                              label.empty() ? "" : label + ": ", error.what()));
    }
}

} // namespace clshade
