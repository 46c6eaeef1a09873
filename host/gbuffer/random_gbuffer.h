// A seeded random G-buffer that covers every model's whole domain, for `check` without INPUT.
#pragma once

#include "host/gbuffer/frame.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace clshade {

/// What a random material is made of. Values are up to the frame.
struct StackShape {
    std::vector<SpecularModel> layers = {SpecularModel::blinn_phong}; ///< top first
    DiffuseModel diffuse = DiffuseModel::lambert;
    FresnelModel fresnel = FresnelModel::constant;
    AbsorptionModel absorption = AbsorptionModel::none;
    // How the material takes an environment's light. Planes and constants do not depend on them.
    AmbientAbsorption absorption_ibl = AmbientAbsorption::deck;
    AmbientTransmittance transmittance_ibl = AmbientTransmittance::fresnel;
    AmbientDiffuse ambient = AmbientDiffuse::precise;
    /// false: every parameter comes from planes (f0 above a spectral layer and metals excepted, which are constants).
    /// true: each parameter is a constant or planes, by chance.
    bool some_constant = false;
    double largest_shininess = 65536.0;
};

/// A frame of width x height pixels: normals at all angles to the eye including grazing, back-facing and zero ones,
/// shininess log-uniform over 0..shape.largest_shininess and its ends, F0 0..1 and its ends (above the base mostly of
/// dielectrics), albedo 0..1, coverage 0..1, absorption 0..0.6 with zeros, tangents at all angles including zero and
/// parallel ones (others stand 3 degrees off the normal at least), a few mirror configurations per light so that the
/// highlights of every layer are hit; lights of all three types; one material of the given shape. The same seed gives
/// the same bytes on every machine. Throws UsageError unless the shape has 1 to 8 layers.
[[nodiscard]] Frame random_frame(int width, int height, const StackShape& shape, std::uint64_t seed);

/// The same for a single layer.
[[nodiscard]] Frame random_frame(int width, int height, SpecularModel specular, DiffuseModel diffuse,
                                 std::uint64_t seed);

/// A random shape: 1 to 8 layers of any lobes (the base at least with a lobe or a diffuse part), any diffuse, Fresnel
/// and absorption model, any way to take an environment's light, some_constant true or false.
[[nodiscard]] StackShape random_shape(std::uint64_t seed);

/// Lights the frame by `image` too: turned by any angle about any axis, intensity 0.5..2 per channel, no background, no
/// maps. The same seed gives the same values on every machine.
void add_random_environment(Frame& frame, std::shared_ptr<const LatLong> image, AmbientSource diffuse,
                            std::uint64_t seed);

} // namespace clshade
