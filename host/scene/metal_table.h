// Optical constants of metals for blinn_phong_spectral: built in, or from a table file.
#pragma once

#include "host/scene/scene.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

/// Names of the built-in metals.
[[nodiscard]] std::span<const std::string_view> built_in_metal_names();

/// Data of models.md section 4; absent for another name.
[[nodiscard]] std::optional<Metal> built_in_metal(std::string_view name);

/// Reads lines "wavelength_nm,n,k". Commas, semicolons or blanks separate; a first line of words, blank lines and what
/// follows a '#' are skipped. `file` names the table in messages. Throws UsageError "FILE:LINE:COL: ..." unless there
/// are two rows or more, every value is finite, wavelengths rise strictly within 100..20000 nm and meet the visible
/// 380..780 nm, n is above 0 and k is 0 or more (both at most 10000).
[[nodiscard]] Metal parse_metal_table(std::string_view text, const std::string& name, const std::string& file);

/// The metal that a scene calls `name`: a built-in one, or else the table of that path relative to `folder`. Throws
/// UsageError at `where` if it is neither, and what parse_metal_table throws.
[[nodiscard]] Metal find_metal(const std::string& name, const std::filesystem::path& folder,
                               const SourceLocation& where);

} // namespace clshade
