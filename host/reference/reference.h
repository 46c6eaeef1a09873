// The scalar reference: every model in double precision, written from models.md for a reader, sharing no code with the
// kernels. It implements the pixel rules of host/gbuffer/frame.h.
#pragma once

#include "host/gbuffer/frame.h"

#include <glm/glm.hpp>

#include <string>
#include <utility>
#include <vector>

namespace clshade::reference {

/// One pixel's result. Radiance before rounding to float.
struct Pixel {
    glm::dvec3 radiance{0.0};
    double alpha = 0.0;
    glm::dvec3 diffuse{0.0};
    glm::dvec3 specular{0.0};
    glm::dvec3 environment{0.0};    ///< the environment's share of diffuse and specular; not the background
    std::vector<glm::dvec3> lights; ///< per light, filled only if asked for
    int material = -1;              ///< index of the material that claimed the pixel; -1: no surface
    bool nonfinite = false;
    bool clamped = false;
    bool fractional_id = false;
    bool no_tangent = false; ///< of an anisotropic layer: missing or parallel to the normal
};

/// Shades pixel (x, y), counted from the data window's top left corner.
[[nodiscard]] Pixel shade_pixel(const Frame& frame, int x, int y, const AovSelection& aovs);

struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::vector<double>> planes; ///< in the order of output_plane_names, width * height each, no padding
    std::vector<int> material;               ///< per pixel, -1: no surface
    PixelCounts counts;
};

/// Shades the whole frame on `threads` threads (rows in parallel; the result does not depend on it).
[[nodiscard]] Image shade(const Frame& frame, const AovSelection& aovs, int threads);

/// What a pixel's formulas start from, by name, for messages about it: coverage, N, E, position, material, its
/// parameters after conversion (those of layer k, the top being 1, as "layer1.f0.R", "layer1.shininess", "layer1.T.X",
/// "layer1.absorption.R"), and per light ("key.NL", ...) N.L, N.E, N.H, E.H and E_0. Of an environment
/// "environment.NE", its mirror direction "environment.R.X" and E/pi "environment.E/pi.R", and per layer "layer1.mip"
/// and what was looked up there, "layer1.L.R". "nonfinite" = 1 or "surface" = 0 alone where there is nothing to shade;
/// with a background also its direction, "ray.X".
[[nodiscard]] std::vector<std::pair<std::string, double>> describe_pixel(const Frame& frame, int x, int y);

} // namespace clshade::reference
