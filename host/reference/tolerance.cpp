#include "host/reference/tolerance.h"

namespace clshade::reference {

Tolerance default_tolerance(SpecularModel specular, DiffuseModel /*diffuse*/) {
    return {.rel = specular == SpecularModel::none ? 2e-6 : 1e-5,
            .abs = 0.0,
            .per_irradiance = 3e-7,
            .per_roundoff = 3.0,
            .percentile = 99.99,
            .hard = 4.0};
}

} // namespace clshade::reference
