// What single precision does to a pixel, told from the mathematics: how far the radiance moves when the vectors and
// parameters that enter the formulas are off by one rounding. No kernel was asked.
#pragma once

#include "host/gbuffer/frame.h"

#include <array>
#include <vector>

namespace clshade::reference {

/// Per pixel, row by row without padding; all 0 where there is no surface.
struct RoundingScale {
    /// Light level: the sum of E_0 over all lights in its largest channel, times coverage; an environment counts with
    /// pi times its mean radiance, a background with that where it shows. Absolute errors of bounded terms are in
    /// proportion to it.
    std::vector<double> irradiance;
    /// For R, G, B: by how much the radiance changes when N, E and L each turn by one unit roundoff (2^-24 rad, more
    /// where a difference of positions loses digits; tangents turn with N, and once by themselves), when parameters
    /// divided by coverage move by 2^-24, and when every index of refraction in a stack and its absorption do. An
    /// environment's share moves with N, E and the parameters, a background with the pixel's ray. Every
    /// change counts with its absolute value; the sum is a first-order bound for one rounding of everything.
    std::array<std::vector<double>, 3> shift;
};

/// Evaluates the reference around each pixel, on `threads` threads. About twenty times the work of `shade`, thirty for
/// deep stacks.
[[nodiscard]] RoundingScale rounding_scale(const Frame& frame, int threads);

} // namespace clshade::reference
