// Results as bytes for the cache on disk. Sizes follow from filter_layout.h, so none are stored.
#pragma once

#include "host/environment/filtered_set.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace clshade {

/// All but name and hash.
[[nodiscard]] std::vector<std::byte> pack(const FilteredSet& set);
/// Nothing unless the bytes are as many as a set takes.
[[nodiscard]] std::optional<FilteredSet> unpack_set(std::span<const std::byte> bytes);

[[nodiscard]] std::vector<std::byte> pack(std::span<const float> values);
/// Nothing unless the bytes are exactly `count` floats.
[[nodiscard]] std::optional<std::vector<float>> unpack_floats(std::span<const std::byte> bytes, std::size_t count);

} // namespace clshade
