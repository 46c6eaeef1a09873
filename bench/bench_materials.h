// Materials of the benchmark's rows. Bases read the planes of the bench frame; what lies above them is constant, as a
// user writes a clear coat.
#pragma once

#include "host/gbuffer/frame.h"

namespace clshade {

inline constexpr int most_coats = 7;

/// A stack of one: albedo, F0 and shininess from the planes. The anisotropic lobe lies along the world's X axis, four
/// times rougher along it than across; the metal of the spectral one is gold.
[[nodiscard]] BoundMaterial single_layer(SpecularModel specular = SpecularModel::blinn_phong,
                                         DiffuseModel diffuse = DiffuseModel::lambert);

/// The base of the layer tables: Blinn-Phong of index 2.0 over a diffuse part, albedo and shininess from the planes.
/// Section 5 of models.md has F_b as a constant of the material, as the deck does.
[[nodiscard]] BoundMaterial layer_base(DiffuseModel diffuse = DiffuseModel::lambert);

/// A base under one to seven coats. The topmost is models.md section 13's second layer: index 1.5, shininess 512,
/// absorption (0.02, 0.05, 0.10), or for `original` the alpha d of the same colour (section 5). No two coats are alike,
/// so that none of them can be left out.
[[nodiscard]] BoundMaterial coated(int coats, FresnelModel fresnel, AbsorptionModel absorption,
                                   BoundMaterial base = layer_base());

/// Oil over matte skin with Oren-Nayar (models.md section 10.1); albedo from the planes.
[[nodiscard]] BoundMaterial skin();

} // namespace clshade
