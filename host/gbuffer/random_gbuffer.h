// A seeded random G-buffer that covers every model's whole domain, for `check` without INPUT.
#pragma once

#include "host/gbuffer/frame.h"

#include <cstdint>

namespace clshade {

/// A frame of width x height pixels: normals at all angles to the eye including grazing, back-facing and zero ones,
/// shininess log-uniform over 0..65536 and its ends, F0 0..1 and its ends, albedo 0..1, coverage 0..1, a few mirror
/// configurations per light so that highlights of any shininess are hit; lights of all three types; one material of
/// the given models whose parameters all come from planes. The same seed gives the same bytes on every machine.
[[nodiscard]] Frame random_frame(int width, int height, SpecularModel specular, DiffuseModel diffuse,
                                 std::uint64_t seed);

} // namespace clshade
