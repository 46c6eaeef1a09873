#include "host/reference/brdf.h"

#include "host/reference/diffuse.h"
#include "host/reference/layers.h"

namespace clshade::reference {

namespace {

glm::dvec3 diffuse_part(const MaterialValues& m, const Angles& angles) {
    const double shininess = m.diffuse_shininess;
    const double sigma2 = sigma2_of_shininess(shininess); // scene file: models in sigma take sigma^2 = 2/shininess
    switch (m.diffuse) {
    case DiffuseModel::none:
        break;
    case DiffuseModel::lambert:
        return lambert(angles, m.albedo);
    case DiffuseModel::oren_nayar:
        return oren_nayar_improved(angles, m.albedo, shininess);
    case DiffuseModel::oren_nayar_full: {
        const OrenNayarParts parts = oren_nayar_full(angles, m.albedo, sigma2);
        return parts.l1 + parts.l2;
    }
    case DiffuseModel::oren_nayar_qualitative:
        return oren_nayar_qualitative(angles, m.albedo, sigma2);
    case DiffuseModel::oren_nayar_simplified_1:
        return oren_nayar_simplified_1(angles, m.albedo, sigma2);
    case DiffuseModel::oren_nayar_simplified_2:
        return oren_nayar_simplified_2(angles, m.albedo, sigma2);
    case DiffuseModel::oren_nayar_shininess:
        return oren_nayar_shininess(angles, m.albedo, shininess);
    }
    return glm::dvec3(0.0);
}

} // namespace

Reflected reflect(const MaterialValues& material, const Angles& angles) {
    Reflected r;
    if (!(angles.nl > 0.0)) {
        return r;
    }
    const StackWeights weights = stack_weights(material, angles);
    r.diffuse = diffuse_part(material, angles) * weights.diffuse;
    for (std::size_t k = 0; k < material.layers().size(); ++k) {
        r.specular += lobe_f_cos(material.layers()[k], material.fresnel, angles) * weights.specular[k];
    }
    return r;
}

} // namespace clshade::reference
