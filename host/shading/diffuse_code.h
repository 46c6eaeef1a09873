// What a diffuse model is called in kernels/diffuse.cl.
#pragma once

#include "host/scene/scene.h"

#include <string_view>

namespace clshade {

struct DiffuseCode {
    std::string_view terms_type; ///< empty: the model has no terms
    std::string_view terms_function;
    std::string_view value; ///< expression for one light `i`; m.terms are the terms
};

[[nodiscard]] DiffuseCode diffuse_code(DiffuseModel model);

} // namespace clshade
