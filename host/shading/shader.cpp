#include "host/shading/shader.h"

#include "host/base/error.h"
#include "host/shading/constants.h"
#include "host/shading/environment_maps.h"
#include "host/shading/frame_layout.h"
#include "host/shading/material_code.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <utility>

namespace clshade {

namespace {

/// One local size for everything: each further one costs PoCL a compilation of 46 to 79 ms.
constexpr std::size_t work_group = 64;
static_assert(plane_alignment % (work_group * static_cast<std::size_t>(row_alignment)) == 0);

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

/// A buffer that holds the given constants.
template <class T>
Buffer constant_buffer(Device& device, std::span<const T> values) {
    Buffer buffer(device, values.size_bytes(), Access::read);
    buffer.write(std::as_bytes(values));
    return buffer;
}

/// The small buffers every launch takes, and the environment's maps.
struct Constants {
    Buffer frame;
    Buffer lights;
    Buffer counts;
    Buffer environment; ///< with maps only
    std::shared_ptr<const EnvironmentMaps> maps;

    Constants(Device& device, const Frame& source, std::shared_ptr<const EnvironmentMaps> environment_maps)
        : maps(std::move(environment_maps)) {
        if (maps) {
            const EnvironmentConstants values = environment_constants(*source.environment);
            environment = constant_buffer(device, std::span(&values, 1));
        }
        const FrameConstants view = frame_constants(source);
        frame = constant_buffer(device, std::span(&view, 1));
        const auto light_values = light_constants(source);
        lights = constant_buffer(device, std::span<const LightConstants>(light_values));
        counts = Buffer(device, sizeof(std::uint32_t) * COUNT_SIZE, Access::read_write);
        reset_counts();
    }

    void reset_counts() {
        constexpr std::array<std::uint32_t, COUNT_SIZE> zero{};
        counts.write(bytes_of(zero));
    }

    [[nodiscard]] PixelCounts read_counts() {
        std::array<std::uint32_t, COUNT_SIZE> values{};
        counts.read(std::as_writable_bytes(std::span(values)));
        return {.nonfinite = values[COUNT_NONFINITE],
                .clamped = values[COUNT_CLAMPED],
                .fractional_ids = values[COUNT_FRACTIONAL_IDS],
                .no_tangent = values[COUNT_NO_TANGENT]};
    }
};

void set_arguments(Kernel& kernel, const Buffer& planes, std::size_t plane_stride, const Buffer& result,
                   std::size_t result_stride, std::uint64_t first, const Constants& constants) {
    kernel.set_argument(0, planes);
    kernel.set_argument(1, static_cast<std::uint64_t>(plane_stride));
    kernel.set_argument(2, result);
    kernel.set_argument(3, static_cast<std::uint64_t>(result_stride));
    kernel.set_argument(4, first);
    kernel.set_argument(5, constants.frame);
    kernel.set_argument(6, constants.lights);
    kernel.set_argument(7, constants.counts);
    if (constants.maps) {
        kernel.set_argument(8, constants.environment);
        kernel.set_argument(9, constants.maps->maps());
        kernel.set_argument(10, constants.maps->ambient());
        kernel.set_argument(11, constants.maps->picture());
    }
}

/// Index of the first pixel that the planes hold among those of the whole picture.
std::uint64_t first_pixel(const Frame& frame) {
    return static_cast<std::uint64_t>(frame.first_row) * static_cast<std::uint64_t>(frame.planes.pitch());
}

/// Room for the outputs: what is at hand if it has the shape.
PlaneSlab shaped_like(const Frame& frame, int outputs, PlaneSlab reused) {
    const bool fits =
        reused.width() == frame.planes.width() && reused.height() == frame.planes.height() && reused.count() == outputs;
    return fits ? std::move(reused) : PlaneSlab(frame.planes.width(), frame.planes.height(), outputs);
}

/// Planes of single lights are added to, so they start at zero; all others are written.
void clear_lights(PlaneSlab& result, const AovSelection& aovs) {
    if (aovs.lights) {
        const auto all = result.all();
        std::fill(all.begin(), all.end(), 0.0F);
    }
}

std::uint64_t frame_bytes(const Frame& frame, std::size_t outputs) {
    return static_cast<std::uint64_t>(frame.planes.width()) * static_cast<std::uint64_t>(frame.planes.height()) *
           (planes_read(frame).size() + outputs) * sizeof(float);
}

} // namespace

PictureMemory::PictureMemory(Device& device, Frame& frame, int outputs, PlaneSlab reused)
    : result(shaped_like(frame, outputs, std::move(reused))),
      plane_buffer(device, std::as_writable_bytes(frame.planes.all()), Access::read),
      result_buffer(device, std::as_writable_bytes(result.all()), Access::read_write) {
    const auto start = Clock::now();
    plane_buffer.upload();
    result_buffer.upload();
    transfer_milliseconds = milliseconds_since(start);
}

struct PreparedFrame::State {
    State(Device& device, const Program& built, const Frame& frame, std::vector<std::string> names, int lane_count,
          std::shared_ptr<PictureMemory> place, std::shared_ptr<const EnvironmentMaps> maps)
        : program(built), plane_names(std::move(names)), lanes(lane_count), constants(device, frame, std::move(maps)),
          kernel(built, "shade"), inputs(static_cast<int>(clshade::planes_read(frame).size())), key(kernel_key(frame)),
          bytes(frame_bytes(frame, plane_names.size())), memory(std::move(place)) {
        set_arguments(kernel, memory->plane_buffer, frame.planes.stride(), memory->result_buffer,
                      memory->result.stride(), first_pixel(frame), constants);
    }

    Program program;
    std::vector<std::string> plane_names;
    int lanes;
    Constants constants;
    Kernel kernel;
    int inputs;
    std::string key;
    std::uint64_t bytes;
    std::shared_ptr<PictureMemory> memory;
    double kernel_milliseconds = 0.0;
};

PreparedFrame::PreparedFrame(std::unique_ptr<State> state) : state_(std::move(state)) {}
PreparedFrame::~PreparedFrame() = default;
PreparedFrame::PreparedFrame(PreparedFrame&&) noexcept = default;
PreparedFrame& PreparedFrame::operator=(PreparedFrame&&) noexcept = default;

void PreparedFrame::launch() {
    state_->kernel.launch(state_->memory->result.padded_pixels() / static_cast<std::size_t>(state_->lanes), work_group);
}

double PreparedFrame::wait_milliseconds() {
    state_->kernel_milliseconds = state_->kernel.wait_milliseconds();
    state_->program.store_binary();
    return state_->kernel_milliseconds;
}

std::uint64_t PreparedFrame::bytes() const {
    return state_->bytes;
}

int PreparedFrame::planes_read() const {
    return state_->inputs;
}

int PreparedFrame::planes_written() const {
    return state_->memory->result.count();
}

const std::string& PreparedFrame::key() const {
    return state_->key;
}

const BuildReport& PreparedFrame::build() const {
    return state_->program.report();
}

ShadedImage PreparedFrame::take() {
    const auto start = Clock::now();
    PictureMemory& memory = *state_->memory;
    memory.result_buffer.download();
    memory.plane_buffer.download(); // the host may write the planes again
    ShadedImage image;
    image.counts = state_->constants.read_counts();
    image.transfer_milliseconds = memory.transfer_milliseconds + milliseconds_since(start);
    image.kernel_times = {{state_->key, state_->kernel_milliseconds, state_->bytes}};
    image.plane_names = state_->plane_names;
    const BuildReport& report = state_->program.report();
    image.identity = report.identity;
    image.built_from_cache = report.from_cache;
    image.build_milliseconds = report.milliseconds;
    memory.result_buffer = Buffer(); // before the memory it stands on goes away
    image.planes = std::move(memory.result);
    return image;
}

int automatic_lanes(const DeviceInfo& device) {
    if (device.kind != DeviceKind::cpu) {
        return 1;
    }
    for (const int lanes : {16, 8, 4}) {
        if (device.preferred_float_lanes >= static_cast<unsigned>(lanes)) {
            return lanes;
        }
    }
    return 1;
}

Shader::Shader(Device& device, SourceSet kernels, ProgramCache cache, ShaderOptions options)
    : device_(&device), kernels_(std::move(kernels)), cache_(std::move(cache)), options_(options),
      lanes_(options.lanes == 0 ? automatic_lanes(device.info()) : options.lanes),
      prefilter_(device, kernels_, cache_, lanes_) {
    constexpr std::array<int, 4> widths = {1, 4, 8, 16};
    if (std::find(widths.begin(), widths.end(), lanes_) == widths.end()) {
        throw UsageError(
            fmt::format("--lanes {}: kernels come in 1, 4, 8 and 16 lanes; use one of these or auto", lanes_));
    }
}

SourceSet Shader::sources(const Frame& frame) const {
    SourceSet sources = kernels_;
    sources.add("frame_layout.h", frame_layout_source(frame, options_.aovs), "generated/frame_layout.h");
    sources.add("materials.cl", materials_source(frame).text, "generated/materials.cl");
    return sources;
}

std::string Shader::build_options() const {
    return fmt::format("-DLANES={}", lanes_);
}

const Program& Shader::program_for(const Frame& frame, const MaterialsSource& materials) {
    const std::string layout = frame_layout_source(frame, options_.aovs);
    const std::string options = build_options();
    const std::string key = layout + materials.text + options;
    auto found = programs_.find(key);
    if (found == programs_.end()) {
        SourceSet sources = kernels_;
        sources.add("frame_layout.h", layout, "generated/frame_layout.h");
        sources.add("materials.cl", materials.text, "generated/materials.cl");
        found = programs_.emplace(key, Program(*device_, sources, "shade.cl", options, cache_)).first;
    }
    return found->second;
}

PreparedFrame Shader::prepare(Frame& frame) {
    const auto outputs = static_cast<int>(output_plane_names(frame, options_.aovs).size());
    return prepare(frame, std::make_shared<PictureMemory>(*device_, frame, outputs));
}

PreparedFrame Shader::prepare(Frame& frame, std::shared_ptr<PictureMemory> memory) {
    std::vector<std::string> names = output_plane_names(frame, options_.aovs);
    if (static_cast<int>(names.size()) != memory->result.count()) {
        throw std::invalid_argument("a frame's outputs do not fit the picture's memory");
    }
    const MaterialsSource materials = materials_source(frame);
    const Program& program = program_for(frame, materials);
    return PreparedFrame(std::make_unique<PreparedFrame::State>(*device_, program, frame, std::move(names), lanes_,
                                                                std::move(memory), maps_for(frame, materials)));
}

std::shared_ptr<const EnvironmentMaps> Shader::maps_for(const Frame& frame, const MaterialsSource& materials) {
    if (!frame.environment) {
        return nullptr;
    }
    if (!maps_ || !maps_->serve(*frame.environment, materials.maps)) {
        maps_.reset(); // one set at a time
        maps_ = std::make_shared<const EnvironmentMaps>(*device_, *frame.environment, materials.maps, prefilter_);
    }
    return maps_;
}

std::size_t Shader::band_pixels(const Frame& frame, std::size_t outputs) const {
    const std::size_t all = frame.planes.padded_pixels();
    if (options_.pixels_per_launch > 0) {
        const std::size_t groups = std::max<std::size_t>(1, options_.pixels_per_launch / plane_alignment);
        return std::min(all, groups * plane_alignment);
    }
    const DeviceInfo& info = device_->info();
    const std::uint64_t plane_bytes = frame.planes.all().size_bytes();
    const std::uint64_t result_bytes = outputs * frame.planes.stride() * sizeof(float);
    const std::uint64_t largest = std::max(plane_bytes, result_bytes);
    // On unified memory nothing is copied, so only the largest single allocation is a limit.
    const std::uint64_t limit =
        options_.max_memory > 0 && !info.unified_memory ? options_.max_memory : info.global_memory;
    if (largest <= info.max_allocation && (info.unified_memory || plane_bytes + result_bytes <= limit)) {
        return all;
    }
    const auto planes = static_cast<std::uint64_t>(frame.planes.count()) + outputs;
    const std::uint64_t most_planes =
        std::max<std::uint64_t>(static_cast<std::uint64_t>(frame.planes.count()), outputs);
    const std::uint64_t pixels =
        std::min(limit / (planes * sizeof(float)), info.max_allocation / (most_planes * sizeof(float)));
    const std::uint64_t groups = pixels / plane_alignment;
    if (groups == 0) {
        throw RuntimeFailure(
            fmt::format("device '{}': {} MiB of device memory hold no band of {} planes; raise --max-mem", info.name,
                        limit >> 20U, planes));
    }
    return std::min<std::size_t>(all, groups * plane_alignment);
}

ShadedImage Shader::shade_in_bands(Frame& frame, std::size_t band, PlaneSlab reused) {
    const auto start = Clock::now();
    const MaterialsSource materials = materials_source(frame);
    Program program = program_for(frame, materials);
    ShadedImage image;
    image.plane_names = output_plane_names(frame, options_.aovs);
    image.planes = shaped_like(frame, static_cast<int>(image.plane_names.size()), std::move(reused));
    clear_lights(image.planes, options_.aovs);
    Constants constants(*device_, frame, maps_for(frame, materials));
    const auto inputs = static_cast<std::size_t>(frame.planes.count());
    const std::size_t outputs = image.plane_names.size();
    Buffer planes(*device_, inputs * band * sizeof(float), Access::read);
    Buffer result(*device_, outputs * band * sizeof(float), Access::read_write);
    Kernel kernel(program, "shade");
    set_arguments(kernel, planes, band, result, band, 0, constants);

    double kernel_milliseconds = 0.0;
    for (std::size_t first = 0; first < frame.planes.padded_pixels(); first += band) {
        const std::size_t pixels = std::min(band, frame.planes.padded_pixels() - first);
        const std::size_t row = pixels * sizeof(float);
        const std::size_t pitch = band * sizeof(float);
        planes.write_rows(std::as_bytes(frame.planes.all()).data() + first * sizeof(float),
                          frame.planes.stride() * sizeof(float), pitch, row, inputs);
        // As they start on the host: see clear_lights.
        std::byte* host_result = std::as_writable_bytes(image.planes.all()).data() + first * sizeof(float);
        result.write_rows(host_result, image.planes.stride() * sizeof(float), pitch, row, outputs);
        kernel.set_argument(4, first_pixel(frame) + first);
        kernel.launch(pixels / static_cast<std::size_t>(lanes_), work_group);
        kernel_milliseconds += kernel.wait_milliseconds();
        result.read_rows(host_result, image.planes.stride() * sizeof(float), pitch, row, outputs);
    }
    program.store_binary();
    image.counts = constants.read_counts();
    image.kernel_times = {{kernel_key(frame), kernel_milliseconds, frame_bytes(frame, outputs)}};
    const BuildReport& report = program.report();
    image.identity = report.identity;
    image.built_from_cache = report.from_cache;
    image.build_milliseconds = report.milliseconds;
    image.transfer_milliseconds = milliseconds_since(start) - kernel_milliseconds - report.milliseconds;
    return image;
}

ShadedImage Shader::shade(Frame& frame, PlaneSlab reused) {
    const std::size_t outputs = output_plane_names(frame, options_.aovs).size();
    const std::size_t band = band_pixels(frame, outputs);
    if (band < frame.planes.padded_pixels() || options_.pixels_per_launch > 0) {
        return shade_in_bands(frame, band, std::move(reused));
    }
    PlaneSlab result = shaped_like(frame, static_cast<int>(outputs), std::move(reused));
    clear_lights(result, options_.aovs);
    PreparedFrame prepared =
        prepare(frame, std::make_shared<PictureMemory>(*device_, frame, static_cast<int>(outputs), std::move(result)));
    prepared.launch();
    static_cast<void>(prepared.wait_milliseconds());
    return prepared.take();
}

} // namespace clshade
