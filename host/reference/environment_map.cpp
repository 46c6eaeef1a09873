#include "host/reference/environment_map.h"

#include "host/reference/picture.h"
#include "host/reference/radiance_filter.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

namespace clshade::reference {

namespace {

double sign_of(double x) {
    return x < 0.0 ? -1.0 : 1.0;
}

/// The lower half of the octahedron, folded out: its own inverse.
glm::dvec2 folded(const glm::dvec2& p) {
    return {(1.0 - std::abs(p.y)) * sign_of(p.x), (1.0 - std::abs(p.x)) * sign_of(p.y)};
}

std::size_t vertex_count(int cells) {
    const auto side = static_cast<std::size_t>(cells) + 1;
    return side * side;
}

/// A grid of values that are there already, three floats a vertex.
std::unique_ptr<DirectionGrid> stored_grid(int cells, const std::shared_ptr<const FilteredSet>& owner,
                                           const std::vector<float>& values) {
    const auto read = [owner, &values](std::size_t vertex, const glm::dvec3&) {
        return glm::dvec3(values[3 * vertex], values[3 * vertex + 1], values[3 * vertex + 2]);
    };
    return std::make_unique<DirectionGrid>(cells, read);
}

/// Integrals over the picture: of the radiance, and of it times each basis function.
struct Projection {
    ShRadiance sh{};
    glm::dvec3 mean{0.0};
};

Projection project(const Picture& picture) {
    Projection result;
    for (int y = 0; y < picture.height; ++y) {
        const double dw = solid_angle_of_texel(picture.width, picture.height, y);
        for (int x = 0; x < picture.width; ++x) {
            const glm::dvec3 d =
                direction_of(polar_angle_of_row(y, picture.height), azimuth_of_column(x, picture.width));
            const std::array<double, 9> basis = sh_basis(d);
            const glm::dvec3 power = picture.at(x, y) * dw;
            for (std::size_t i = 0; i < basis.size(); ++i) {
                result.sh[i] += power * basis[i];
            }
            result.mean += power;
        }
    }
    result.mean /= 4.0 * std::numbers::pi;
    return result;
}

} // namespace

glm::dvec2 octahedral(const glm::dvec3& direction) {
    const glm::dvec3 p = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    return p.z < 0.0 ? folded({p.x, p.y}) : glm::dvec2(p.x, p.y);
}

glm::dvec3 direction_of_octahedral(const glm::dvec2& place) {
    const double z = 1.0 - std::abs(place.x) - std::abs(place.y);
    const glm::dvec2 p = z < 0.0 ? folded(place) : place;
    return glm::normalize(glm::dvec3(p.x, p.y, z));
}

DirectionGrid::DirectionGrid(int cells, Make make)
    : cells_(cells), make_(std::move(make)), values_(vertex_count(cells)) {}

glm::dvec3 DirectionGrid::vertex(int i, int j) const {
    const auto index =
        static_cast<std::size_t>(j) * (static_cast<std::size_t>(cells_) + 1) + static_cast<std::size_t>(i);
    const auto make = [&] {
        const glm::dvec2 place{2.0 * i / cells_ - 1.0, 2.0 * j / cells_ - 1.0};
        return make_(index, direction_of_octahedral(place));
    };
    return values_.at(index, make);
}

glm::dvec3 DirectionGrid::along(const glm::dvec3& direction) const {
    const glm::dvec2 p = (octahedral(direction) + 1.0) * (0.5 * cells_);
    const int i = std::clamp(static_cast<int>(p.x), 0, cells_ - 1);
    const int j = std::clamp(static_cast<int>(p.y), 0, cells_ - 1);
    const double u = p.x - i;
    const double v = p.y - j;
    return (vertex(i, j) * (1.0 - u) + vertex(i + 1, j) * u) * (1.0 - v) +
           (vertex(i, j + 1) * (1.0 - u) + vertex(i + 1, j + 1) * u) * v;
}

EnvironmentMap::EnvironmentMap(std::shared_ptr<const LatLong> image) : image_(std::move(image)) {
    Picture picture(*image_);
    const Projection projection = project(picture);
    sh_ = projection.sh;
    mean_ = projection.mean;

    picture = enlarged(std::move(picture));
    std::shared_ptr<const FilterSource> source;
    for (int i = 0; i < radiance_levels; ++i) {
        while (halves_for(picture, level_shininess(i))) {
            picture = halved(picture);
            source.reset();
        }
        if (!source) {
            source = std::make_shared<FilterSource>(picture);
        }
        const int squarings = radiance_levels - 2 - i; // n/2 = 2^squarings; the last level has n = 1
        levels_.push_back(
            std::make_unique<DirectionGrid>(level_cells(i), [source, squarings](std::size_t, const glm::dvec3& d) {
                return source->radiance(d, squarings);
            }));
        if (level_shininess(i) == irradiance_source_shininess) {
            irradiance_ = std::make_unique<DirectionGrid>(
                irradiance_cells, [source](std::size_t, const glm::dvec3& d) { return source->irradiance_over_pi(d); });
        }
    }
}

EnvironmentMap::EnvironmentMap(std::shared_ptr<const FilteredSet> maps) : sh_(maps->sh), mean_(maps->mean) {
    check_sizes(*maps);
    for (int i = 0; i < radiance_levels; ++i) {
        levels_.push_back(stored_grid(level_cells(i), maps, maps->radiance[static_cast<std::size_t>(i)]));
    }
    irradiance_ = stored_grid(irradiance_cells, maps, maps->irradiance);
}

glm::dvec3 EnvironmentMap::radiance(const glm::dvec3& direction, double shininess) const {
    const double mip = mip_of_shininess(shininess, sharpest_shininess, radiance_levels - 1, 1.0);
    const int upper = std::min(static_cast<int>(mip), radiance_levels - 2);
    const double t = mip - upper;
    return level(upper).along(direction) * (1.0 - t) + level(upper + 1).along(direction) * t;
}

std::shared_ptr<const EnvironmentMap> environment_map_of(const std::shared_ptr<const LatLong>& image) {
    static std::mutex mutex;
    static std::shared_ptr<const EnvironmentMap> last;
    const std::scoped_lock lock(mutex);
    if (!last || last->image() != image) {
        last = std::make_shared<EnvironmentMap>(image);
    }
    return last;
}

} // namespace clshade::reference
