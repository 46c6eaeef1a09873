// An environment on a device: the maps of a FilteredSet as the records that kernels look up (kernels/lookup.cl).
#pragma once

#include "host/base/aligned_buffer.h"
#include "host/device/device.h"
#include "host/gbuffer/frame.h"
#include "host/prefilter/prefilter.h"
#include "host/shading/environment_layout.h"

#include <memory>
#include <span>
#include <vector>

namespace clshade {

/// Turns a grid of (width + 1)(height + 1) vertices, RGB interleaved, into width height colour records.
void fill_colour_records(std::span<float> records, std::span<const float> vertices, int width, int height,
                         const glm::dvec3& scale);
/// The same of vertices with two values to pair records.
void fill_pair_records(std::span<float> records, std::span<const float> vertices, int width, int height);

/// The vertices of a map for one exponent: what interpolation between two levels gives, on the grid of the finer one.
[[nodiscard]] std::vector<float> blended_level(const FilteredSet& maps, double shininess);

/// Buffers of one environment for the materials of a frame. Not movable: buffers stand on its memory.
class EnvironmentMaps {
  public:
    /// The frame's environment must have its maps. Throws RuntimeFailure where the device cannot hold them.
    EnvironmentMaps(Device& device, const Frame& frame, Prefilter& prefilter);

    /// Do these maps serve the frame too?
    [[nodiscard]] bool serve(const Frame& frame) const;
    [[nodiscard]] const Buffer& maps() const { return maps_buffer_; }
    [[nodiscard]] const Buffer& ambient() const { return ambient_buffer_; }
    [[nodiscard]] const Buffer& picture() const { return picture_buffer_; }

  private:
    /// What the maps were made from.
    struct Origin {
        std::shared_ptr<const FilteredSet> maps;
        std::shared_ptr<const LatLong> picture; ///< null without background
        glm::dvec3 intensity{1.0};
        std::vector<double> exponents;
        std::vector<Metal> metals;
        std::vector<bool> linear; ///< of each metal
        bool levels = false;
    };
    [[nodiscard]] static Origin origin_of(const Frame& frame, const MapsLayout& layout);
    void fill(const Frame& frame, const MapsLayout& layout, Prefilter& prefilter);
    void fill_ambient(Prefilter& prefilter);
    void fill_picture(const LatLong& picture);

    Origin origin_;
    AlignedBuffer maps_;
    AlignedBuffer ambient_;
    AlignedBuffer picture_;
    Buffer maps_buffer_;
    Buffer ambient_buffer_;
    Buffer picture_buffer_;
};

} // namespace clshade
