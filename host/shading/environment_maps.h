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

/// scale_factor scale + bias_factor bias along N.E for one exponent, as 128 values and 128 slopes.
void fill_curve(std::span<float> curve, const AmbientTables& tables, const AmbientCurve& wanted);

/// Buffers of one environment for the materials of a frame. Not movable: buffers stand on its memory.
class EnvironmentMaps {
  public:
    /// The environment must have its maps. Throws RuntimeFailure where the device cannot hold them.
    EnvironmentMaps(Device& device, const BoundEnvironment& environment, const MapsLayout& layout,
                    Prefilter& prefilter);

    /// Do these maps serve another frame's environment and materials too?
    [[nodiscard]] bool serve(const BoundEnvironment& environment, const MapsLayout& layout) const;
    [[nodiscard]] const Buffer& maps() const { return maps_buffer_; }
    [[nodiscard]] const Buffer& ambient() const { return ambient_buffer_; }
    [[nodiscard]] const Buffer& picture() const { return picture_buffer_; }

  private:
    void fill(Prefilter& prefilter);
    void fill_ambient(Prefilter& prefilter);
    void fill_picture();

    // What the maps were made from.
    std::shared_ptr<const FilteredSet> set_;
    std::shared_ptr<const LatLong> shown_; ///< null without background
    glm::dvec3 intensity_;
    MapsLayout layout_;

    AlignedBuffer maps_;
    AlignedBuffer ambient_;
    AlignedBuffer picture_;
    Buffer maps_buffer_;
    Buffer ambient_buffer_;
    Buffer picture_buffer_;
};

} // namespace clshade
