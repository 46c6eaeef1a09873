#include "host/reference/rounding.h"

#include "host/reference/angles.h"
#include "host/reference/brdf.h"
#include "host/reference/environment_light.h"
#include "host/reference/layers.h"
#include "host/reference/lights.h"
#include "host/reference/rows.h"
#include "host/reference/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clshade::reference {

namespace {

constexpr double unit_roundoff = 0x1p-24; // of single precision

/// N, E, L and how far each may turn, in radians.
struct Directions {
    std::array<glm::dvec3, 3> vectors; ///< N, E, L
    std::array<double, 3> turns;
};

/// Two unit vectors at right angles to v and to each other.
std::array<glm::dvec3, 2> tangents(const glm::dvec3& v) {
    const glm::dvec3 other = std::abs(v.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 first = glm::normalize(glm::cross(v, other));
    return {first, glm::cross(v, first)};
}

/// Normalising rounds each component once; decoding and turning to world space round it a few times more.
double vector_roundings(const Frame& frame) {
    double roundings = 1.0;
    roundings += frame.normal_encoding == NormalEncoding::unorm ? 3.0 : 0.0;
    roundings += frame.normal_space == NormalSpace::camera ? 2.0 : 0.0;
    return roundings;
}

/// The eye is rounded where it stands: far from the origin and close to the surface, that is an angle.
double eye_turn(const Frame& frame, const Surface& surface) {
    const View& view = frame.view;
    if (view.orthographic || !surface.position || surface.position_from_depth) {
        return 3.0 * unit_roundoff; // the ray's direction is a sum of three terms
    }
    return (1.0 + glm::length(view.eye) / glm::length(view.eye - *surface.position)) * unit_roundoff;
}

/// The same for a light's position, and for a surface position that had to be computed from depth.
double light_turn(const Frame& frame, const Light& light, const Surface& surface) {
    if (light.type == LightType::distant || !surface.position) {
        return unit_roundoff;
    }
    double size = glm::length(light.position);
    if (surface.position_from_depth) {
        size += glm::length(frame.view.origin) + 3.0 * glm::length(*surface.position - frame.view.origin);
    }
    return (1.0 + size / glm::length(light.position - *surface.position)) * unit_roundoff;
}

/// A material at a pixel and what its parameters may be instead, each off by one rounding.
struct Variants {
    MaterialValues base;
    std::vector<MaterialValues> others;
};

/// sqrt(f0) and the index of refraction round once each: with q = sqrt(f0), n = (1 + q)/(1 - q) moves by
/// u + 2 q u/(1 - q^2), relatively, and q/(1 - q^2) = (n - 1)(n + 1)/(4 n). Media of nearly the same index keep few
/// digits of their contrast. Downwards, since q = 1, an infinite index, can go no other way: grazing light tells it
/// from the float next to it.
glm::dvec3 nudged_index(const glm::dvec3& n) {
    glm::dvec3 nudged = n;
    for (int i = 0; i < 3; ++i) {
        const double q = std::isinf(n[i]) ? 1.0 : (n[i] - 1.0) / (n[i] + 1.0);
        const double rounded = q * (1.0 - unit_roundoff);
        nudged[i] = std::max(1.0, (1.0 + rounded) / (1.0 - rounded) * (1.0 - unit_roundoff));
    }
    return nudged;
}

/// t turned in the surface by its own rounding, which weighs more the closer t is to the normal.
glm::dvec3 nudged_tangent(const Frame& frame, const LayerValues& layer) {
    return layer.tangent_read +
           vector_roundings(frame) * unit_roundoff * glm::length(layer.tangent_read) * layer.frame.bitangent;
}

/// Layer by layer: the index where interfaces inside the stack or the exact formula use it, and the tangent.
void add_layer_variants(const Frame& frame, const glm::dvec3& normal, Variants& variants) {
    const MaterialValues& base = variants.base;
    const bool uses_index = base.layers().size() > 1 || base.fresnel == FresnelModel::exact;
    for (std::size_t k = 0; k < base.layers().size(); ++k) {
        const LayerValues& layer = base.layers()[k];
        if (uses_index && layer.specular != SpecularModel::none) {
            MaterialValues& other = variants.others.emplace_back(base);
            other.layers()[k].index = nudged_index(layer.index);
            find_interfaces(other);
        }
        if (layer.specular == SpecularModel::blinn_phong_anisotropic && !layer.frame.missing) {
            MaterialValues& other = variants.others.emplace_back(base);
            other.layers()[k].tangent_read = nudged_tangent(frame, layer);
            find_tangents(other, normal);
        }
    }
    if (base.absorption != AbsorptionModel::none) {
        MaterialValues& other = variants.others.emplace_back(base);
        for (LayerValues& layer : other.layers()) {
            layer.absorption *= 1.0 + unit_roundoff;
        }
    }
}

Variants variants_at(const PreparedFrame& prepared, const Surface& surface, int x, int y) {
    Variants variants;
    variants.base = read_material(prepared, surface, x, y);
    Surface nudged = surface;
    nudged.coverage *= 1.0 - unit_roundoff;
    variants.others.push_back(read_material(prepared, nudged, x, y));
    add_layer_variants(prepared.frame(), surface.normal, variants);
    return variants;
}

/// Radiance of one light along given directions. `power` is the irradiance before the cone.
glm::dvec3 radiance(const MaterialValues& material, const Light& light, const glm::dvec3& power,
                    const std::array<glm::dvec3, 3>& d) {
    const Reflected r = reflect(material, angles_between(d[0], d[1], d[2]));
    return (r.diffuse + r.specular) * power * cone_share(light, d[2]);
}

glm::dvec3 larger_change(const glm::dvec3& base, const glm::dvec3& one, const glm::dvec3& other) {
    return glm::max(glm::abs(one - base), glm::abs(other - base));
}

/// Sum of the changes for one light.
glm::dvec3 light_shift(const Variants& variants, const Light& light, const glm::dvec3& power, const Directions& d) {
    const glm::dvec3 base = radiance(variants.base, light, power, d.vectors);
    glm::dvec3 shift =
        2.0 * d.turns[2] * glm::abs(base); // E_0 = power / distance^2: the distance is off as the angle is
    for (const MaterialValues& other : variants.others) {
        shift += glm::abs(radiance(other, light, power, d.vectors) - base);
    }
    MaterialValues material = variants.base;
    for (std::size_t v = 0; v < d.vectors.size(); ++v) {
        for (const glm::dvec3& tangent : tangents(d.vectors[v])) {
            std::array<glm::dvec3, 3> turned = d.vectors;
            const auto radiance_turned = [&](double turn) {
                turned[v] = glm::normalize(d.vectors[v] + turn * tangent);
                find_tangents(material, turned[0]); // T and B turn with N
                return radiance(material, light, power, turned);
            };
            const glm::dvec3 plus = radiance_turned(d.turns[v]);
            shift += larger_change(base, plus, radiance_turned(-d.turns[v]));
        }
    }
    return shift;
}

/// Radiance of the environment along given N and E.
glm::dvec3 environment_radiance(const MaterialValues& material, const PreparedEnvironment& environment,
                                const glm::dvec3& normal, const glm::dvec3& eye) {
    const EnvironmentLight light = environment_light(material, environment, normal, eye);
    return light.diffuse + light.specular;
}

/// Sum of the changes for the environment.
glm::dvec3 environment_shift(const Variants& variants, const PreparedEnvironment& environment,
                             const std::array<glm::dvec3, 2>& vectors, const std::array<double, 2>& turns) {
    const glm::dvec3 base = environment_radiance(variants.base, environment, vectors[0], vectors[1]);
    glm::dvec3 shift(0.0);
    for (const MaterialValues& other : variants.others) {
        shift += glm::abs(environment_radiance(other, environment, vectors[0], vectors[1]) - base);
    }
    MaterialValues material = variants.base;
    for (std::size_t v = 0; v < vectors.size(); ++v) {
        for (const glm::dvec3& tangent : tangents(vectors[v])) {
            std::array<glm::dvec3, 2> turned = vectors;
            const auto radiance_turned = [&](double turn) {
                turned[v] = glm::normalize(vectors[v] + turn * tangent);
                find_tangents(material, turned[0]);
                return environment_radiance(material, environment, turned[0], turned[1]);
            };
            const glm::dvec3 plus = radiance_turned(turns[v]);
            shift += larger_change(base, plus, radiance_turned(-turns[v]));
        }
    }
    return shift;
}

/// The same for a background: a ray is a sum of three terms, normalised.
glm::dvec3 background_shift(const PreparedEnvironment& environment, const glm::dvec3& ray) {
    const glm::dvec3 base = environment.background(ray);
    glm::dvec3 shift(0.0);
    for (const glm::dvec3& tangent : tangents(ray)) {
        const glm::dvec3 turn = 4.0 * unit_roundoff * tangent;
        shift += larger_change(base, environment.background(ray + turn), environment.background(ray - turn));
    }
    return shift;
}

/// Irradiance of a light before its cone.
glm::dvec3 power_at(Light light, const std::optional<glm::dvec3>& position) {
    if (light.type == LightType::spot) {
        light.type = LightType::point;
    }
    return incident_light(light, position).irradiance;
}

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

struct PixelScale {
    double irradiance = 0.0;
    glm::dvec3 shift{0.0};
};

/// Light level of an environment.
glm::dvec3 environment_level(const PreparedEnvironment& environment) {
    return std::numbers::pi * environment.mean();
}

PixelScale surface_scale(const PreparedFrame& prepared, const Surface& surface, int x, int y) {
    const Frame& frame = prepared.frame();
    PixelScale scale;
    const Variants variants = variants_at(prepared, surface, x, y);
    glm::dvec3 level(0.0);
    for (const Light& light : frame.lights) {
        const Incident incident = incident_light(light, surface.position);
        level += incident.irradiance;
        const Directions directions{
            {surface.normal, surface.eye, incident.direction},
            {vector_roundings(frame) * unit_roundoff, eye_turn(frame, surface), light_turn(frame, light, surface)}};
        scale.shift += light_shift(variants, light, power_at(light, surface.position), directions);
    }
    if (const PreparedEnvironment* environment = prepared.environment()) {
        level += environment_level(*environment);
        scale.shift += environment_shift(variants, *environment, {surface.normal, surface.eye},
                                         {vector_roundings(frame) * unit_roundoff, eye_turn(frame, surface)});
    }
    scale.irradiance = largest(level) * surface.coverage;
    scale.shift *= surface.coverage;
    return scale;
}

PixelScale pixel_scale(const PreparedFrame& prepared, int x, int y) {
    PixelScale scale;
    if (!all_finite(prepared, x, y)) {
        return scale;
    }
    const std::optional<Surface> surface = read_surface(prepared.frame(), x, y);
    if (surface) {
        scale = surface_scale(prepared, *surface, x, y);
    }
    const PreparedEnvironment* environment = prepared.environment();
    const double bare = surface ? 1.0 - surface->coverage : 1.0;
    if (environment != nullptr && environment->bound().background && bare > 0.0) {
        scale.irradiance += bare * largest(environment_level(*environment));
        scale.shift += bare * background_shift(*environment, ray_direction(prepared.frame(), x, y));
    }
    return scale;
}

} // namespace

RoundingScale rounding_scale(const Frame& frame, int threads) {
    const auto width = static_cast<std::size_t>(frame.planes.width());
    const std::size_t pixels = width * static_cast<std::size_t>(frame.planes.height());
    RoundingScale scale;
    scale.irradiance.assign(pixels, 0.0);
    scale.shift.fill(std::vector<double>(pixels, 0.0));
    const PreparedFrame prepared(frame);
    const auto scan_row = [&](int y) {
        for (int x = 0; x < frame.planes.width(); ++x) {
            const PixelScale pixel = pixel_scale(prepared, x, y);
            const std::size_t at = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            scale.irradiance[at] = pixel.irradiance;
            for (int c = 0; c < 3; ++c) {
                scale.shift[static_cast<std::size_t>(c)][at] = pixel.shift[c];
            }
        }
    };
    for_each_row(frame.planes.height(), threads, scan_row);
    return scale;
}

} // namespace clshade::reference
