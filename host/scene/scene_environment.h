// [environment], and the one key of [output] that concerns it.
#pragma once

#include "host/scene/scene.h"
#include "host/scene/toml_value.h"

namespace clshade {

/// Reads the table [environment].
[[nodiscard]] Environment read_environment(const TomlEntry& entry);

/// Reads the table [output]: its `background`. Throws UsageError where one is asked for without an environment.
[[nodiscard]] bool read_background(const TomlEntry& output, bool has_environment);

} // namespace clshade
