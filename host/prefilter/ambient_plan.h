// What the AmbientBRDF kernel reads, worked out in double: vertices, nodes of quadrature, normalisers. No device.
#pragma once

#include "kernels/filter_types.h"

#include <vector>

namespace clshade {

/// Vertices of the tables along N.E padded to whole groups of lanes; the last vertex repeated.
inline constexpr int ambient_pitch = 144;

/// Positions in 0..1 and weights.
struct Nodes {
    std::vector<double> positions;
    std::vector<double> weights;
};

/// Gauss-Legendre on 0..1.
[[nodiscard]] Nodes gauss_legendre(int count);
/// The same after x = sin^2(pi t/2), which makes square roots at both ends smooth.
[[nodiscard]] Nodes crowded_nodes(int count);

/// All nodes as the kernel takes them, position and weight in turn.
[[nodiscard]] std::vector<float> ambient_nodes();
/// N.E, its sine and its angle, each `ambient_pitch` values.
[[nodiscard]] std::vector<float> ambient_eyes();
/// n of row j.
[[nodiscard]] double ambient_shininess(int j);
/// models.md sections 1 and 2.
[[nodiscard]] double exact_normaliser(double shininess);
[[nodiscard]] double linear_normaliser(double shininess);
/// The rows of the tables with that normaliser.
[[nodiscard]] std::vector<AmbientRow> ambient_rows(bool linear);

} // namespace clshade
