#include "host/prefilter/blob.h"

#include <algorithm>

namespace clshade {

namespace {

template <class T>
void append(std::vector<std::byte>& bytes, std::span<const T> values) {
    const auto raw = std::as_bytes(values);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// Takes values from the front of `bytes`, which must hold them.
template <class T>
void take(std::span<const std::byte>& bytes, std::span<T> values) {
    std::copy_n(bytes.begin(), values.size_bytes(), std::as_writable_bytes(values).begin());
    bytes = bytes.subspan(values.size_bytes());
}

std::size_t grid_floats(int cells) {
    const auto side = static_cast<std::size_t>(cells) + 1;
    return 3 * side * side;
}

std::size_t set_bytes(const FilteredSet& set) {
    std::size_t floats = grid_floats(irradiance_cells);
    for (int level = 0; level < radiance_levels; ++level) {
        floats += grid_floats(level_cells(level));
    }
    return floats * sizeof(float) + sizeof(set.sh) + sizeof(set.mean);
}

} // namespace

std::vector<std::byte> pack(const FilteredSet& set) {
    std::vector<std::byte> bytes;
    bytes.reserve(set_bytes(set));
    for (const std::vector<float>& level : set.radiance) {
        append(bytes, std::span<const float>(level));
    }
    append(bytes, std::span<const float>(set.irradiance));
    append(bytes, std::span<const glm::dvec3>(set.sh));
    append(bytes, std::span<const glm::dvec3>(&set.mean, 1));
    return bytes;
}

std::optional<FilteredSet> unpack_set(std::span<const std::byte> bytes) {
    FilteredSet set;
    if (bytes.size() != set_bytes(set)) {
        return std::nullopt;
    }
    for (int level = 0; level < radiance_levels; ++level) {
        std::vector<float>& values = set.radiance[static_cast<std::size_t>(level)];
        values.resize(grid_floats(level_cells(level)));
        take(bytes, std::span(values));
    }
    set.irradiance.resize(grid_floats(irradiance_cells));
    take(bytes, std::span(set.irradiance));
    take(bytes, std::span<glm::dvec3>(set.sh));
    take(bytes, std::span<glm::dvec3>(&set.mean, 1));
    return set;
}

std::vector<std::byte> pack(std::span<const float> values) {
    std::vector<std::byte> bytes;
    append(bytes, values);
    return bytes;
}

std::optional<std::vector<float>> unpack_floats(std::span<const std::byte> bytes, std::size_t count) {
    if (bytes.size() != count * sizeof(float)) {
        return std::nullopt;
    }
    std::vector<float> values(count);
    take(bytes, std::span(values));
    return values;
}

} // namespace clshade
