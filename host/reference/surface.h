// What a pixel of the G-buffer says: rules 1 to 7 of host/gbuffer/frame.h.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/ambient_brdf.h"
#include "host/reference/environment.h"
#include "host/reference/material_values.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace clshade::reference {

/// A pixel's surface after rules 1 to 5 and 7.
struct Surface {
    double coverage = 1.0;
    glm::dvec3 normal{0.0};             ///< N: unit, world space
    glm::dvec3 eye{0.0};                ///< E: unit, world space
    std::optional<glm::dvec3> position; ///< P for point and spot lights; none where nothing tells it
    bool position_from_depth = false;   ///< P was not read but computed
    int material = 0;                   ///< index of the material that claims the pixel
    bool fractional_id = false;
};

/// Planes that rule 1 wants finite, each once, but for the depth plane, whose +Inf is allowed.
[[nodiscard]] std::vector<PlaneIndex> planes_to_be_finite(const Frame& frame);

/// What is worked out once per frame, before its pixels are read. The frame must outlive it and stay as it is.
class PreparedFrame {
  public:
    explicit PreparedFrame(const Frame& frame);

    [[nodiscard]] const Frame& frame() const { return *frame_; }
    [[nodiscard]] const std::vector<PlaneIndex>& finite_planes() const { return finite_planes_; }
    /// Of a spectral layer.
    [[nodiscard]] const SpectralMetal& metal(std::size_t material, std::size_t layer) const {
        return metals_[material][layer];
    }
    /// The same under an environment; null without one.
    [[nodiscard]] const MetalAmbient* metal_ambient(std::size_t material, std::size_t layer) const {
        return metal_ambients_[material][layer].get();
    }
    /// Null if the frame has none.
    [[nodiscard]] const PreparedEnvironment* environment() const { return environment_ ? &*environment_ : nullptr; }

  private:
    const Frame* frame_;
    std::vector<PlaneIndex> finite_planes_;
    std::vector<std::vector<SpectralMetal>> metals_; ///< per material and layer
    std::vector<std::vector<std::shared_ptr<const MetalAmbient>>> metal_ambients_;
    std::optional<PreparedEnvironment> environment_;
};

/// Rule 1.
[[nodiscard]] bool all_finite(const PreparedFrame& prepared, int x, int y);

/// Direction of the pixel's ray, unit. The view must have rays.
[[nodiscard]] glm::dvec3 ray_direction(const Frame& frame, int x, int y);

/// Rules 2 to 5 and 7 for a pixel that passed rule 1; none where there is no surface.
[[nodiscard]] std::optional<Surface> read_surface(const Frame& frame, int x, int y);

/// Rule 6. Only the parameters that the models use are read. Interfaces are found (host/reference/layers.h).
[[nodiscard]] MaterialValues read_material(const PreparedFrame& prepared, const Surface& surface, int x, int y);

/// Rule 6 for tangents: (again) made perpendicular to a normal.
void find_tangents(MaterialValues& material, const glm::dvec3& normal);

/// Rule 6 for emission; zero without it.
[[nodiscard]] glm::dvec3 read_emission(const Frame& frame, const Surface& surface, int x, int y);

/// Does this model read this parameter? (Lambert needs no shininess.)
[[nodiscard]] bool uses_diffuse_shininess(DiffuseModel model);

} // namespace clshade::reference
