#include "bench/batch_oiio_rival.h"

#include "host/base/error.h"

#include <ImfThreading.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string_view>

namespace clshade {

namespace {

/// The names of the rows' sequences, in the order of rivals::Interleaved.
constexpr std::array<const char*, 14> wanted{"N.X",      "N.Y",      "N.Z",  "P.X",  "P.Y",  "P.Z",       "albedo.R",
                                             "albedo.G", "albedo.B", "f0.R", "f0.G", "f0.B", "roughness", "coverage"};
static_assert(wanted.size() == rivals::interleaved_channels);

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
    throw RuntimeFailure(fmt::format("{}: OpenImageIO: {}", file.string(), why));
}

/// The camera's place, from the header: (0, 0, 0, 1) times the inverse of the matrix, row vectors.
std::array<float, 3> eye_of(const OIIO::ImageSpec& spec, const std::filesystem::path& file) {
    glm::mat4 matrix(1.0F);
    if (!spec.getattribute("worldtocamera", OIIO::TypeMatrix, &matrix)) {
        fail(file, "no camera in the header");
    }
    const glm::mat4 inverse = glm::inverse(matrix); // in memory rows stand where glm has columns
    return {inverse[3].x, inverse[3].y, inverse[3].z};
}

struct Picture {
    OIIO::ImageSpec spec;
    std::vector<float> pixels; ///< kept from frame to frame
};

void read(const std::filesystem::path& file, Picture& picture) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) {
        fail(file, OIIO::geterror());
    }
    picture.spec = input->spec();
    picture.pixels.resize(static_cast<std::size_t>(picture.spec.image_pixels()) *
                          static_cast<std::size_t>(picture.spec.nchannels));
    if (!input->read_image(0, 0, 0, picture.spec.nchannels, OIIO::TypeFloat, picture.pixels.data())) {
        fail(file, input->geterror());
    }
}

void write(const std::filesystem::path& file, const OiioWork& work, const Picture& from,
           const std::vector<float>& shaded) {
    OIIO::ImageSpec spec(from.spec.width, from.spec.height, 4, work.half ? OIIO::TypeHalf : OIIO::TypeFloat);
    spec.attribute("compression", work.compression);
    const auto output = OIIO::ImageOutput::create(file.string());
    if (!output || !output->open(file.string(), spec)) {
        fail(file, output ? output->geterror() : OIIO::geterror());
    }
    if (!output->write_image(OIIO::TypeFloat, shaded.data()) || !output->close()) {
        fail(file, output->geterror());
    }
}

rivals::Interleaved layout_of(const OIIO::ImageSpec& spec, const std::filesystem::path& file) {
    rivals::Interleaved layout{};
    layout.channels = static_cast<std::size_t>(spec.nchannels);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const int channel = spec.channelindex(wanted[i]);
        if (channel < 0) {
            fail(file, std::string("no channel ") + wanted[i]);
        }
        layout.offset[i] = static_cast<std::size_t>(channel);
    }
    return layout;
}

#ifdef _OPENMP
void shade(const Picture& picture, const std::filesystem::path& file, const OiioWork& work,
           std::vector<float>& shaded) {
    const rivals::Interleaved layout = layout_of(picture.spec, file);
    const std::array<float, 3> eye = eye_of(picture.spec, file);
    rivals::Scene scene;
    std::copy(eye.begin(), eye.end(), scene.eye);
    scene.lights = &work.light;
    scene.light_count = 1;
    const rivals::InterleavedRange loop = host_kernels().interleaved;
    const auto width = static_cast<std::size_t>(picture.spec.width);
    const int height = picture.spec.height;
    shaded.resize(4 * width * static_cast<std::size_t>(height));
#pragma omp parallel for schedule(static) num_threads(work.threads)
    for (int y = 0; y < height; ++y) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        loop(picture.pixels.data() + first * layout.channels, layout, scene, shaded.data() + 4 * first, width);
    }
}
#endif

} // namespace

std::string oiio_rival_trouble() {
#ifdef _OPENMP
    return {};
#else
    return "built without OpenMP";
#endif
}

double run_oiio_rival([[maybe_unused]] const OiioWork& work) {
#ifdef _OPENMP
    Imf::setGlobalThreadCount(work.threads); // as OpenImageIO does when it first opens an EXR
    OIIO::attribute("threads", work.threads);
    OIIO::attribute("exr_threads", work.threads);
    const auto start = std::chrono::steady_clock::now();
    Picture picture;
    std::vector<float> shaded;
    for (std::size_t i = 0; i < work.inputs.size(); ++i) {
        read(work.inputs[i], picture);
        shade(picture, work.inputs[i], work, shaded);
        write(work.outputs[i], work, picture, shaded);
    }
    const double milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    Imf::setGlobalThreadCount(0);
    return milliseconds;
#else
    throw RuntimeFailure(oiio_rival_trouble());
#endif
}

} // namespace clshade
