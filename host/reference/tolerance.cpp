#include "host/reference/tolerance.h"

#include <algorithm>

namespace clshade::reference {

namespace {

bool is_plain_lobe(SpecularModel model) {
    return model == SpecularModel::blinn_phong || model == SpecularModel::blinn_phong_exact;
}

double relative_tolerance(const BoundMaterial& material) {
    const SpecularModel base = material.base().specular;
    if (material.layers.size() > 1) {
        return 2e-5;
    }
    if (base == SpecularModel::none) {
        return 2e-6;
    }
    return is_plain_lobe(base) && material.fresnel == FresnelModel::constant ? 1e-5 : 2e-5;
}

} // namespace

Tolerance default_tolerance(const BoundMaterial& material, bool environment) {
    if (environment) {
        return {.rel = 1e-4, .abs = 0.0, .per_irradiance = 1e-6, .per_roundoff = 3.0, .percentile = 99.9, .hard = 4.0};
    }
    return {.rel = relative_tolerance(material),
            .abs = 0.0,
            .per_irradiance = 3e-7,
            .per_roundoff = 3.0,
            .percentile = 99.99,
            .hard = 4.0};
}

Tolerance background_tolerance(bool background) {
    if (!background) {
        return Tolerance::plain(0.0, 0.0, 100.0);
    }
    return {.rel = 1e-5, .abs = 0.0, .per_irradiance = 3e-7, .per_roundoff = 3.0, .percentile = 99.9, .hard = 4.0};
}

} // namespace clshade::reference
