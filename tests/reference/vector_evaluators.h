// Evaluators of the published vectors of sections 3, 4, 5 and 10.1 of models.md.
#pragma once

#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <string>

namespace clshade::reference {

using Outputs = std::map<std::string, double>; ///< a single number has the name "", of three the names are 0, 1, 2
using Evaluators = std::map<std::string, std::function<Outputs(const nlohmann::json&)>>;

[[nodiscard]] Evaluators layer_evaluators();

} // namespace clshade::reference
