// Shading a frame on a device: what to build, what to launch, in which pieces.
#pragma once

#include "host/device/device.h"
#include "host/device/program.h"
#include "host/gbuffer/frame.h"
#include "host/prefilter/prefilter.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace clshade {

struct ShaderOptions {
    AovSelection aovs;
    int lanes = 0;                     ///< 1, 4, 8, 16; 0: the best known for the device and driver
    std::uint64_t max_memory = 0;      ///< bytes of device memory for planes; 0: what the device has
    std::size_t pixels_per_launch = 0; ///< 0: automatic; tests force small bands
};

/// One launch's share of the time table.
struct KernelTime {
    std::string kernel; ///< stable key, e.g. "shade.blinn_phong.lambert.distant1"
    double milliseconds = 0.0;
    std::uint64_t bytes = 0; ///< planes read and written once
};

struct ShadedImage {
    PlaneSlab planes; ///< in the order of output_plane_names
    std::vector<std::string> plane_names;
    PixelCounts counts;
    std::vector<KernelTime> kernel_times;
    std::string identity; ///< of the program that shaded it
    bool built_from_cache = false;
    double build_milliseconds = 0.0;
    double transfer_milliseconds = 0.0;
};

/// A picture's place on the device: its planes, and room for what kernels write. Refers to the frame's planes, which
/// must outlive it. Kernels that are compared with each other work on one: time depends on which pages they got.
struct PictureMemory {
    /// Copies the planes to the device where it has memory of its own; `outputs` planes to write. Throws
    /// RuntimeFailure. `reused`: a slab for the result if it has the right shape, whatever it holds.
    PictureMemory(Device& device, Frame& frame, int outputs, PlaneSlab reused = {});

    PlaneSlab result;
    Buffer plane_buffer;
    Buffer result_buffer; ///< over `result`
    double transfer_milliseconds = 0.0;
};

/// A frame bound to the device: planes uploaded, constants written, arguments set; launch as often as you like.
/// Refers to the frame it was made from, which must outlive it. Move-only.
class PreparedFrame {
  public:
    ~PreparedFrame();
    PreparedFrame(PreparedFrame&&) noexcept;
    PreparedFrame& operator=(PreparedFrame&&) noexcept;
    PreparedFrame(const PreparedFrame&) = delete;
    PreparedFrame& operator=(const PreparedFrame&) = delete;

    /// Enqueues the kernel over the whole frame and returns at once.
    void launch();
    /// Waits for the last launch; its duration on the device.
    [[nodiscard]] double wait_milliseconds();
    /// Input planes read plus output planes written, each once, for the pixels of the picture.
    [[nodiscard]] std::uint64_t bytes() const;
    [[nodiscard]] int planes_read() const;
    [[nodiscard]] int planes_written() const;
    /// Stable key of the kernel: "shade.blinn_phong.lambert.distant1" (several materials: "mixed4").
    [[nodiscard]] const std::string& key() const;
    [[nodiscard]] const BuildReport& build() const;
    /// Brings results to the host and gives them away, and with them the picture's memory.
    [[nodiscard]] ShadedImage take();

    struct State;
    explicit PreparedFrame(std::unique_ptr<State> state);

  private:
    std::unique_ptr<State> state_;
};

class EnvironmentMaps;
struct MaterialsSource;

/// Builds one program per distinct set of materials, planes, light types, outputs and lanes, and keeps it; frames with
/// the same ones reuse it. Constants of materials are baked in; lights and the camera are run-time constants.
class Shader {
  public:
    Shader(Device& device, SourceSet kernels, ProgramCache cache, ShaderOptions options);

    /// Shades a frame, or the rows of it that its planes hold, in bands where it does not fit the device or the memory
    /// limit. Throws RuntimeFailure. The result does not depend on bands. An environment must have its maps (Prefilter;
    /// std::invalid_argument). `reused`: a slab for the result if it has the right shape, whatever it holds.
    [[nodiscard]] ShadedImage shade(Frame& frame, PlaneSlab reused = {});
    /// For benches: the whole frame in one launch. Throws RuntimeFailure if it does not fit.
    [[nodiscard]] PreparedFrame prepare(Frame& frame);
    /// The same in memory that others of the same planes use too, in turns. Throws std::invalid_argument where the
    /// frame's outputs are not as many as the memory's.
    [[nodiscard]] PreparedFrame prepare(Frame& frame, std::shared_ptr<PictureMemory> memory);

    /// Every file of the program for a frame, the generated ones among them, for people to read from shade.cl on, and
    /// the options of its build.
    [[nodiscard]] SourceSet sources(const Frame& frame) const;
    [[nodiscard]] std::string build_options() const;
    [[nodiscard]] int lanes() const { return lanes_; }
    /// On the shader's device, with its kernels, cache and lanes.
    [[nodiscard]] Prefilter& prefilter() { return prefilter_; }

  private:
    /// The environment's maps on the device, made anew where those at hand are of another one; null without
    /// environment.
    [[nodiscard]] std::shared_ptr<const EnvironmentMaps> maps_for(const Frame& frame, const MaterialsSource& materials);
    [[nodiscard]] const Program& program_for(const Frame& frame, const MaterialsSource& materials);
    /// Pixels of one launch: all of them, or as many as the device and --max-mem can hold.
    [[nodiscard]] std::size_t band_pixels(const Frame& frame, std::size_t outputs) const;
    [[nodiscard]] ShadedImage shade_in_bands(Frame& frame, std::size_t band, PlaneSlab reused);

    Device* device_;
    SourceSet kernels_;
    ProgramCache cache_;
    ShaderOptions options_;
    int lanes_;
    std::map<std::string, Program> programs_; ///< by generated source and options
    Prefilter prefilter_;
    std::shared_ptr<const EnvironmentMaps> maps_;
};

/// The vector width `--lanes auto` stands for: what the device prefers, 1 on GPUs.
[[nodiscard]] int automatic_lanes(const DeviceInfo& device);

} // namespace clshade
