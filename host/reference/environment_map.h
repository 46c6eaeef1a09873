// An environment's picture as surfaces see it: filtered by the reference itself, in double precision, where it is
// looked at (host/environment/filter_layout.h). Unrotated and unscaled: directions are those of the image frame.
#pragma once

#include "host/environment/filter_layout.h"
#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"
#include "host/reference/lazy_table.h"
#include "host/reference/spherical_harmonics.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace clshade::reference {

/// Octahedral map: a direction of any length to (x, y) in [-1, 1]^2, and back to a unit vector.
[[nodiscard]] glm::dvec2 octahedral(const glm::dvec3& direction);
[[nodiscard]] glm::dvec3 direction_of_octahedral(const glm::dvec2& place);

/// Values at (cells+1)^2 directions, made when they are first asked for; bilinear between.
class DirectionGrid {
  public:
    /// `make` gets a vertex's index and direction.
    using Make = std::function<glm::dvec3(std::size_t, const glm::dvec3&)>;
    DirectionGrid(int cells, Make make);

    [[nodiscard]] int cells() const { return cells_; }
    [[nodiscard]] glm::dvec3 vertex(int i, int j) const;
    /// A direction of any length.
    [[nodiscard]] glm::dvec3 along(const glm::dvec3& direction) const;

  private:
    int cells_;
    Make make_;
    LazyTable<glm::dvec3> values_;
};

class EnvironmentMap {
  public:
    /// To be filtered here.
    explicit EnvironmentMap(std::shared_ptr<const LatLong> image);
    /// Filtered by somebody else.
    explicit EnvironmentMap(std::shared_ptr<const FilteredSet> maps);

    /// L(R, n) of rule 11 without intensity.
    [[nodiscard]] glm::dvec3 radiance(const glm::dvec3& direction, double shininess) const;
    [[nodiscard]] const DirectionGrid& level(int i) const { return *levels_[static_cast<std::size_t>(i)]; }
    /// E/pi for a normal.
    [[nodiscard]] glm::dvec3 irradiance_over_pi(const glm::dvec3& normal) const { return irradiance_->along(normal); }
    [[nodiscard]] const ShRadiance& sh() const { return sh_; }
    /// Mean radiance over the sphere.
    [[nodiscard]] const glm::dvec3& mean() const { return mean_; }
    /// Null if there are only maps.
    [[nodiscard]] const std::shared_ptr<const LatLong>& image() const { return image_; }

  private:
    std::shared_ptr<const LatLong> image_;
    std::vector<std::unique_ptr<DirectionGrid>> levels_;
    std::unique_ptr<DirectionGrid> irradiance_;
    ShRadiance sh_{};
    glm::dvec3 mean_{0.0};
};

/// The map of a picture. The one asked for last is remembered: frames, and passes over one frame, share what was
/// filtered.
[[nodiscard]] std::shared_ptr<const EnvironmentMap> environment_map_of(const std::shared_ptr<const LatLong>& image);

} // namespace clshade::reference
