// Which pixels a material claims: `ids` and `names`.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_reader.h"
#include "host/scene/toml_value.h"

#include <vector>

namespace clshade {

/// Reads `ids` and `names` of a material's table. `default` may have neither, any other material needs one of them.
void read_claims(const TableReader& table, Material& material);

/// Throws for an id or name that is claimed twice. `table` holds the materials by name.
void check_claims(const TomlTable& table, const std::vector<Material>& materials);

} // namespace clshade
