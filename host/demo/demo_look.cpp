// What the demo's objects are painted with.
#include "host/demo/demo_stage.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace clshade::demo {

namespace {

constexpr float pi = glm::pi<float>();

/// 0 or 1 in alternating squares.
float checks(float u, float v) {
    const float parity = std::floor(u) + std::floor(v);
    return parity - 2.0F * std::floor(0.5F * parity);
}

float fraction(float x) {
    return x - std::floor(x);
}

/// Smooth wave between 0 and 1.
float wave(float x) {
    return 0.5F + 0.5F * std::sin(x);
}

/// Longitude and latitude of a point on a sphere, 0..1 each.
glm::vec2 sphere_coordinates(const Object& object, glm::vec3 p) {
    const glm::vec3 d = glm::normalize(p - object.centre);
    return {0.5F + std::atan2(d.y, d.x) / (2.0F * pi), 0.5F + std::asin(std::clamp(d.z, -1.0F, 1.0F)) / pi};
}

/// Polished tiles in rings about a medallion, with rough joints.
Look stage_look(glm::vec3 p) {
    const float radius = glm::length(glm::vec2(p));
    const float ring = radius / 0.42F;
    const float sectors = ring < 1.0F ? 1.0F : ring < 3.0F ? 12.0F : ring < 6.0F ? 24.0F : 36.0F;
    const float sector = (std::atan2(p.y, p.x) / (2.0F * pi) + 0.5F) * sectors;
    const float tile_width = 2.0F * pi * radius / sectors;
    const bool joint =
        (ring > 0.5F && fraction(ring) < 0.05F) || (sectors > 1.0F && fraction(sector) * tile_width < 0.02F);
    const float parity = checks(ring, sector);
    Look look;
    look.albedo = glm::mix(glm::vec3(0.105F, 0.125F, 0.16F), glm::vec3(0.21F, 0.225F, 0.25F), parity);
    look.roughness = 0.34F + 0.14F * parity;
    if (joint) {
        look.albedo = glm::vec3(0.05F, 0.055F, 0.065F);
        look.roughness = 0.75F;
    }
    return look;
}

/// Pale marble with veins.
Look plinth_look(glm::vec3 p) {
    const float bend = std::sin(2.3F * p.x + 1.7F * std::sin(3.1F * p.z + 1.3F * p.y)) + 0.6F * std::sin(5.7F * p.y);
    const float vein = std::pow(1.0F - std::abs(std::sin(2.1F * p.x + 3.3F * p.z + 1.4F * bend)), 6.0F);
    Look look;
    look.albedo = glm::mix(glm::vec3(0.62F, 0.60F, 0.56F), glm::vec3(0.20F, 0.21F, 0.24F), 0.85F * vein);
    look.roughness = 0.30F + 0.25F * vein;
    return look;
}

/// A colour ramp over the word: blue, magenta, orange.
Look letters_look(const Object& object, glm::vec3 p) {
    const float place = std::clamp((p.x + 2.7F) / 5.4F, 0.0F, 1.0F);
    const glm::vec3 blue(0.02F, 0.20F, 0.66F);
    const glm::vec3 magenta(0.58F, 0.05F, 0.36F);
    const glm::vec3 orange(0.92F, 0.36F, 0.03F);
    Look look;
    look.albedo = place < 0.5F ? glm::mix(blue, magenta, 2.0F * place) : glm::mix(magenta, orange, 2.0F * place - 1.0F);
    look.f0 = glm::vec3(0.05F);
    const bool front = p.y < object.centre.y - object.size.y + 0.01F;
    look.roughness = front ? 0.36F : 0.24F; // brushed faces, polished edges
    return look;
}

/// Blue and white stripes; the white ones are duller.
Look plastic_look(const Object& object, glm::vec3 p) {
    const glm::vec2 uv = sphere_coordinates(object, p);
    const bool white = fraction(7.0F * uv.y + 0.25F) < 0.5F;
    Look look;
    look.albedo = white ? glm::vec3(0.78F, 0.78F, 0.76F) : glm::vec3(0.03F, 0.13F, 0.50F);
    look.f0 = glm::vec3(0.045F);
    look.roughness = white ? 0.36F : 0.22F;
    return look;
}

/// Metals show their F0. The albedo stands for the surroundings that punctual lights do not reflect: it is such that
/// the diffuse weight 1 - F0 brings a tenth of the metal's colour.
Look metal(glm::vec3 f0, float roughness) {
    return {0.1F * f0 / (1.0F - f0), f0, roughness};
}

Look gold_look(const Object& object, glm::vec3 p) {
    const glm::vec2 uv = sphere_coordinates(object, p);
    return metal({0.90F, 0.64F, 0.24F}, 0.36F + 0.16F * wave(uv.y * 30.0F));
}

Look copper_look(const Object& object, glm::vec3 p) {
    const glm::vec2 uv = sphere_coordinates(object, p);
    return metal({0.88F, 0.50F, 0.36F}, checks(18.0F * uv.x, 9.0F * uv.y) > 0.5F ? 0.56F : 0.34F);
}

Look chalk_look(const Object& object, glm::vec3 p) {
    const glm::vec2 uv = sphere_coordinates(object, p);
    Look look;
    look.albedo =
        checks(14.0F * uv.x, 7.0F * uv.y) > 0.5F ? glm::vec3(0.80F, 0.76F, 0.68F) : glm::vec3(0.72F, 0.38F, 0.30F);
    look.f0 = glm::vec3(0.02F);
    look.roughness = 0.9F;
    return look;
}

Look rubber_look(const Object& object, glm::vec3 p) {
    const glm::vec2 uv = sphere_coordinates(object, p);
    const float groove = std::pow(wave(uv.y * 60.0F), 4.0F);
    Look look;
    look.albedo = glm::vec3(0.045F, 0.05F, 0.055F) * (1.0F + groove);
    look.roughness = 0.50F + 0.2F * groove;
    return look;
}

} // namespace

Look look_of(const Object& object, glm::vec3 p) {
    switch (object.substance) {
    case Substance::stage:
        return stage_look(p);
    case Substance::plinth:
        return plinth_look(p);
    case Substance::letters:
        return letters_look(object, p);
    case Substance::plastic:
        return plastic_look(object, p);
    case Substance::gold:
        return gold_look(object, p);
    case Substance::copper:
        return copper_look(object, p);
    case Substance::car_paint:
        return {{0.46F, 0.012F, 0.018F}, glm::vec3(0.055F), 0.20F};
    case Substance::chalk:
        return chalk_look(object, p);
    case Substance::rubber:
        return rubber_look(object, p);
    case Substance::steel:
        return metal({0.56F, 0.57F, 0.58F}, 0.12F + 0.5F * object.variation);
    case Substance::none:
        break;
    }
    return {};
}

} // namespace clshade::demo
