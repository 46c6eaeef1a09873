// What a pixel of the G-buffer says: rules 1 to 7 of host/gbuffer/frame.h.
#pragma once

#include "host/gbuffer/frame.h"

#include <glm/glm.hpp>

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

/// A parameter set after rule 6, clamped, for one pixel of one material.
struct MaterialValues {
    SpecularModel specular = SpecularModel::none;
    DiffuseModel diffuse = DiffuseModel::none;
    glm::dvec3 f0{0.0};
    glm::dvec3 albedo{0.0};
    double shininess = 0.0;
    double diffuse_shininess = 0.0;
    bool clamped = false; ///< f0 or albedo lay beyond 0..1 by more than 1e-3
};

/// Planes that rule 1 wants finite, each once, but for the depth plane, whose +Inf is allowed.
[[nodiscard]] std::vector<PlaneIndex> planes_to_be_finite(const Frame& frame);

/// Rule 1. `planes` is what planes_to_be_finite returned.
[[nodiscard]] bool all_finite(const Frame& frame, const std::vector<PlaneIndex>& planes, int x, int y);

/// Rules 2 to 5 and 7 for a pixel that passed rule 1; none where there is no surface.
[[nodiscard]] std::optional<Surface> read_surface(const Frame& frame, int x, int y);

/// Rule 6. Only the parameters that the models use are read.
[[nodiscard]] MaterialValues read_material(const Frame& frame, const Surface& surface, int x, int y);

/// Rule 6 for emission; zero without it.
[[nodiscard]] glm::dvec3 read_emission(const Frame& frame, const Surface& surface, int x, int y);

/// Does this model read this parameter? (A lobe `none` needs neither F0 nor shininess; Lambert needs no shininess.)
[[nodiscard]] bool uses_diffuse_shininess(DiffuseModel model);

} // namespace clshade::reference
