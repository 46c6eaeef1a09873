#include "host/prefilter/grid_mean.h"

#include <cmath>
#include <cstddef>

namespace clshade {

namespace {

/// Points a cell side; coarse grids take more, for the density of solid angle varies within their cells.
int points_of(int cells) {
    return cells >= 96 ? 2 : 192 / cells;
}

/// Solid angle per area of the octahedral square, without a factor: with v on the octahedron |x| + |y| + |z| = 1,
/// dw = const dx dy / |v|^3. The square folds where |x| + |y| > 1.
double density(double x, double y) {
    const double ax = std::abs(x);
    const double ay = std::abs(y);
    const double z = 1.0 - ax - ay;
    const glm::dvec3 v = z >= 0.0 ? glm::dvec3(ax, ay, z) : glm::dvec3(1.0 - ay, 1.0 - ax, z);
    const double squared = glm::dot(v, v);
    return 1.0 / (squared * std::sqrt(squared));
}

glm::dvec3 vertex(std::span<const float> grid, int cells, int i, int j) {
    const auto at =
        3 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(cells + 1) + static_cast<std::size_t>(i));
    return {grid[at], grid[at + 1], grid[at + 2]};
}

} // namespace

glm::dvec3 grid_mean(std::span<const float> grid, int cells) {
    const int points = points_of(cells);
    glm::dvec3 sum(0.0);
    double area = 0.0;
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            const glm::dvec3 corner = vertex(grid, cells, i, j);
            const glm::dvec3 right = vertex(grid, cells, i + 1, j) - corner;
            const glm::dvec3 below = vertex(grid, cells, i, j + 1) - corner;
            const glm::dvec3 twist = vertex(grid, cells, i + 1, j + 1) - corner - right - below;
            for (int py = 0; py < points; ++py) {
                for (int px = 0; px < points; ++px) {
                    const double fx = (px + 0.5) / points;
                    const double fy = (py + 0.5) / points;
                    const double weight = density(2.0 * (i + fx) / cells - 1.0, 2.0 * (j + fy) / cells - 1.0);
                    sum += weight * (corner + fx * right + fy * below + fx * fy * twist);
                    area += weight;
                }
            }
        }
    }
    return sum / area;
}

} // namespace clshade
