// The part of a program that depends on the scene's materials: materials.cl, one fused kernel for every set of stacks.
// Structure and constants are in the source; lights are not, so that moving one needs no compiler.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/shading/environment_layout.h"

#include <string>
#include <vector>

namespace clshade {

/// Replaces kernels/materials.cl.
struct MaterialsSource {
    std::string text;
    /// Fitted Fresnel curves of metals that are further than 1e-5 from the spectral sum, in words.
    std::vector<std::string> warnings;
    /// Where the source looks up an environment.
    MapsLayout maps;
};
[[nodiscard]] MaterialsSource materials_source(const Frame& frame);

} // namespace clshade
