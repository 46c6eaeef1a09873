// Evaluators of the published vectors of sections 3 to 7, 9 and 10.1 of models.md.
#pragma once

#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <string>

namespace clshade::reference {

using Outputs =
    std::map<std::string, double>; ///< a single number has the name "", those of a list are called 0, 1, 2, ...
using Evaluators = std::map<std::string, std::function<Outputs(const nlohmann::json&)>>;

/// Sections 3, 4, 5 and 10.1.
[[nodiscard]] Evaluators layer_evaluators();
/// Sections 6, 7 and 9.
[[nodiscard]] Evaluators ambient_evaluators();

} // namespace clshade::reference
