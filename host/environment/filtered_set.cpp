#include "host/environment/filtered_set.h"

#include <fmt/format.h>

#include <stdexcept>

namespace clshade {

namespace {

void check_size(const std::vector<float>& values, std::size_t cells, const char* what) {
    const std::size_t wanted = (cells + 1) * (cells + 1) * 3;
    if (values.size() != wanted) {
        throw std::invalid_argument(fmt::format("{} has {} values instead of {}", what, values.size(), wanted));
    }
}

} // namespace

void check_sizes(const FilteredSet& set) {
    for (int level = 0; level < radiance_levels; ++level) {
        check_size(set.radiance[static_cast<std::size_t>(level)], static_cast<std::size_t>(level_cells(level)),
                   "a radiance level");
    }
    check_size(set.irradiance, irradiance_cells, "the irradiance map");
}

} // namespace clshade
