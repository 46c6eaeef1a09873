// The only user of images, so host/device has no class for them: this file works on that component's own handles.
#include "bench/device_rivals.h"
#include "bench/host_rivals.h"
#include "host/device/opencl.h"

#include <array>
#include <stdexcept>
#include <vector>

namespace clshade {

struct NaiveRival::State {
    std::shared_ptr<Device::State> device;
    cl::Program program;
    cl::Kernel kernel;
    std::vector<cl::Image2D> inputs; ///< normal, position, albedo, F0 and shininess
    cl::Image2D result;
    std::size_t width = 0;
    std::size_t height = 0;
    std::vector<float> picture;

    [[nodiscard]] std::array<cl::size_type, 3> region() const { return {width, height, 1}; }
};

namespace {

constexpr std::array<cl::size_type, 3> origin{0, 0, 0};

cl_float4 float4_of(const float (&xyz)[3]) {
    return {{xyz[0], xyz[1], xyz[2], 0.0F}};
}

/// Up to four planes of the frame as one RGBA picture; what is missing is 0.
std::vector<float> interleave(const PlaneSlab& planes, int first, int count) {
    const auto width = static_cast<std::size_t>(planes.width());
    std::vector<float> pixels(width * static_cast<std::size_t>(planes.height()) * 4);
    for (int p = 0; p < count; ++p) {
        for (int y = 0; y < planes.height(); ++y) {
            const std::span<const float> row = planes.row(first + p, y);
            float* to = pixels.data() + static_cast<std::size_t>(y) * width * 4 + p;
            for (std::size_t x = 0; x < width; ++x) {
                to[4 * x] = row[x];
            }
        }
    }
    return pixels;
}

} // namespace

NaiveRival::NaiveRival(Device& device, const Frame& frame) : state_(std::make_unique<State>()) {
    const std::vector<rivals::DistantLight> lights = distant_lights(frame);
    if (lights.size() != 1) {
        throw std::invalid_argument("the naive rival shades one light");
    }
    State& state = *state_;
    state.device = device.state();
    state.width = static_cast<std::size_t>(frame.planes.width());
    state.height = static_cast<std::size_t>(frame.planes.height());
    state.picture.resize(state.width * state.height * 4);
    const Program program(device, rival_sources(), "naive.cl", "-cl-std=CL1.2", ProgramCache::standard());
    state.program = program.state()->program;

    guarded(device.info(), "preparing the naive rival", [&] {
        const cl::ImageFormat rgba(CL_RGBA, CL_FLOAT);
        state.kernel = cl::Kernel(state.program, "shade_naive");
        cl_uint argument = 0;
        for (const auto& [first, count] : {std::pair(0, 3), std::pair(3, 3), std::pair(6, 3), std::pair(9, 4)}) {
            const cl::Image2D image(state.device->context, CL_MEM_READ_ONLY, rgba, state.width, state.height);
            const std::vector<float> pixels = interleave(frame.planes, first, count);
            state.device->queue.enqueueWriteImage(image, CL_TRUE, origin, state.region(), 0, 0, pixels.data());
            state.kernel.setArg(argument++, image);
            state.inputs.push_back(image);
        }
        state.result = cl::Image2D(state.device->context, CL_MEM_WRITE_ONLY, rgba, state.width, state.height);
        state.kernel.setArg(argument++, state.result);
        const glm::vec3 eye = frame.view.eye;
        state.kernel.setArg(argument++, cl_float4{{eye.x, eye.y, eye.z, 0.0F}});
        state.kernel.setArg(argument++, float4_of(lights.front().to_light));
        state.kernel.setArg(argument++, float4_of(lights.front().irradiance));
    });
}

NaiveRival::~NaiveRival() = default;

bool NaiveRival::supported(const Device& device) {
    return guarded(device.info(), "asking for images",
                   [&] { return device.state()->device.getInfo<CL_DEVICE_IMAGE_SUPPORT>() != CL_FALSE; });
}

double NaiveRival::run() {
    return guarded(state_->device->info, "running the naive rival", [this] {
        cl::Event event;
        // The driver chooses the size of the work-groups, as usually left to it.
        state_->device->queue.enqueueNDRangeKernel(
            state_->kernel, cl::NullRange, cl::NDRange(state_->width, state_->height), cl::NullRange, nullptr, &event);
        event.wait();
        const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
        return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - start) * 1e-6;
    });
}

std::span<const float> NaiveRival::output() {
    guarded(state_->device->info, "reading the naive rival's picture", [this] {
        state_->device->queue.enqueueReadImage(state_->result, CL_TRUE, origin, state_->region(), 0, 0,
                                               state_->picture.data());
    });
    return state_->picture;
}

} // namespace clshade
