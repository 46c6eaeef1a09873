#include "tests/reference/single_precision.h"

#include <algorithm>
#include <cmath>

namespace clshade::reference {

namespace {

constexpr float inverse_pi = 0.318309886F;

glm::vec3 vector_at(const Frame& frame, const std::array<PlaneIndex, 3>& planes, int x, int y) {
    return {frame.planes.at(planes[0], x, y), frame.planes.at(planes[1], x, y), frame.planes.at(planes[2], x, y)};
}

float spot_share(const Light& light, const glm::vec3& l) {
    if (light.type != LightType::spot) {
        return 1.0F;
    }
    const float cosine = glm::dot(glm::normalize(glm::vec3(light.direction)), -l);
    const float angle = std::acos(glm::clamp(cosine, -1.0F, 1.0F));
    const auto cone = static_cast<float>(light.cone_angle);
    const float t = glm::clamp((cone - angle) / (cone * static_cast<float>(light.cone_softness)), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

struct Values {
    glm::vec3 f0{0.0F};
    glm::vec3 albedo{0.0F};
    float n = 0.0F;
    float diffuse_n = 0.0F;
};

/// `length`: of L + E, which h was divided by.
float lobe_single(const glm::vec3& n, const glm::vec3& h, float length, float shininess, LobeForm form) {
    if (shininess == 0.0F) {
        return 1.0F;
    }
    const float nh = std::max(glm::dot(n, h), 1e-12F / length);
    const glm::vec3 cross = glm::cross(n, h);
    const float by_sine = 0.5F * std::log1p(-std::min(glm::dot(cross, cross), 1.0F));
    const float by_cosine = std::log(std::min(nh, 1.0F));
    const bool use_sine = form == LobeForm::log1p || (form == LobeForm::accurate && nh > 0.5F);
    return std::exp(shininess * (use_sine ? by_sine : by_cosine));
}

glm::vec3 reflect_single(const BoundMaterial& m, const Values& v, const glm::vec3& n, const glm::vec3& e,
                         const glm::vec3& l, LobeForm form) {
    const float nl = glm::dot(n, l);
    if (!(nl > 0.0F)) {
        return glm::vec3(0.0F);
    }
    const float ne = std::max(glm::dot(n, e), 1e-4F);
    const glm::vec3 sum = l + e;
    const float length2 = glm::dot(sum, sum);
    const float length = std::sqrt(std::max(length2, 1e-12F));
    const glm::vec3 h = sum / length;
    const float eh = length2 / (2.0F * length);
    const float lobe = lobe_single(n, h, length, v.n, form);
    const bool exact = m.base().specular == SpecularModel::blinn_phong_exact;
    const float norm =
        exact ? (v.n + 2.0F) / (12.5663706F * (2.0F - std::exp2(-0.5F * v.n))) : 0.0397436F * v.n + 0.0856832F;
    const float w = 1.0F - eh;
    const float weight = exact ? w * w * w * w * w : std::exp2((-5.55473F * eh - 6.98316F) * eh);
    const glm::vec3 specular = (v.f0 + (1.0F - v.f0) * weight) * (norm * lobe * (nl / std::max(nl, ne)));
    const float wl = 1.0F - std::min(nl, 1.0F);
    const glm::vec3 kept = (1.0F - v.f0) * (exact ? 1.0F - wl * wl * wl * wl * wl : 1.0F);
    float cosine = nl;
    if (m.diffuse == DiffuseModel::oren_nayar) {
        const float gamma = glm::dot(e, l) - ne * nl;
        const float t = gamma >= 0.0F ? std::min(1.0F, nl / ne) : nl;
        cosine = nl * (1.0F - 1.0F / (2.0F + 0.65F * v.diffuse_n)) + gamma / (2.22222F + 0.1F * v.diffuse_n) * t;
    }
    return v.albedo * inverse_pi * cosine * kept + specular;
}

} // namespace

PlaneSlab shade_in_single_precision(const Frame& frame, LobeForm form) {
    const BoundMaterial& m = frame.materials.front();
    PlaneSlab out(frame.planes.width(), frame.planes.height(), 4);
    for (int y = 0; y < out.height(); ++y) {
        for (int x = 0; x < out.width(); ++x) {
            const float c = frame.planes.at(frame.roles.coverage, x, y);
            const glm::vec3 raw = vector_at(frame, frame.roles.normal, x, y);
            if (!(c > 0.0F) || glm::length(raw) < 1e-6F) {
                continue;
            }
            Values v;
            v.f0 = glm::clamp(vector_at(frame, m.base().f0.planes, x, y) / c, 0.0F, 1.0F);
            v.albedo = glm::clamp(vector_at(frame, m.albedo.planes, x, y) / c, 0.0F, 1.0F);
            v.n = std::clamp(frame.planes.at(m.base().shininess.planes[0], x, y) / c, 0.0F, 65536.0F);
            if (m.diffuse == DiffuseModel::oren_nayar) {
                v.diffuse_n = std::clamp(frame.planes.at(m.diffuse_shininess.planes[0], x, y) / c, 0.0F, 65536.0F);
            }
            const glm::vec3 p = vector_at(frame, frame.roles.position, x, y);
            const glm::vec3 n = glm::normalize(raw);
            const glm::vec3 e = glm::normalize(glm::vec3(frame.view.eye) - p);
            glm::vec3 radiance(0.0F);
            for (const Light& light : frame.lights) {
                const bool distant = light.type == LightType::distant;
                const glm::vec3 path =
                    distant ? -glm::vec3(glm::normalize(light.direction)) : glm::vec3(light.position) - p;
                const glm::vec3 l = distant ? path : glm::normalize(path);
                const glm::vec3 e0 = glm::vec3(light.power) / (distant ? 1.0F : glm::dot(path, path));
                radiance += reflect_single(m, v, n, e, l, form) * e0 * spot_share(light, l);
            }
            for (int i = 0; i < 3; ++i) {
                out.at(i, x, y) = radiance[i] * c;
            }
            out.at(3, x, y) = c;
        }
    }
    return out;
}

} // namespace clshade::reference
