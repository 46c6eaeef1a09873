#include "host/gbuffer/random_numbers.h"

#include "host/base/rounding.h"

#include <algorithm>
#include <cmath>

namespace clshade {

namespace {

/// A vector at right angles to `axis`, pushed towards it by up to `reach` either way.
glm::dvec3 grazing(RandomGenerator& random, const glm::dvec3& axis, double reach) {
    const glm::dvec3 any = random.direction();
    const double push = random.between(-reach, reach);
    return any - glm::dot(any, axis) * axis + push * axis;
}

/// The normal that mirrors E into L, off by a few widths 1/sqrt(n) of the lobe.
glm::dvec3 near_mirror(RandomGenerator& random, const glm::dvec3& eye, const glm::dvec3& light, double n) {
    const double spread = random.between(0.0, 3.0) / std::sqrt(n + 1.0);
    const glm::dvec3 aside = random.in_unit_ball();
    const glm::dvec3 half = eye + light;
    if (glm::dot(half, half) < 1e-4) {
        return eye + spread * aside;
    }
    return glm::normalize(half) + spread * aside;
}

/// F0 of a dielectric with an index in 1..2.5.
double dielectric_f0(RandomGenerator& random) {
    const double index = random.between(1.0, 2.5);
    const double root = (index - 1.0) / (index + 1.0);
    return root * root;
}

} // namespace

std::uint64_t RandomGenerator::next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

double RandomGenerator::unit() {
    return static_cast<double>(next() >> 11U) * 0x1p-53;
}

double RandomGenerator::between(double low, double high) {
    return low + (high - low) * unit();
}

int RandomGenerator::below(int count) {
    return static_cast<int>(next() % static_cast<std::uint64_t>(count));
}

glm::dvec3 RandomGenerator::in_unit_ball() {
    for (;;) {
        const double x = between(-1.0, 1.0);
        const double y = between(-1.0, 1.0);
        const double z = between(-1.0, 1.0);
        if (x * x + y * y + z * z <= 1.0) {
            return {x, y, z};
        }
    }
}

glm::dvec3 RandomGenerator::direction() {
    for (;;) {
        const glm::dvec3 v = in_unit_ball();
        if (glm::dot(v, v) > 1e-4) {
            return glm::normalize(v);
        }
    }
}

glm::dmat3 random_rotation(RandomGenerator& random) {
    // A unit quaternion, uniform on its sphere; short ones are left out as inexact.
    for (;;) {
        const double w = random.between(-1.0, 1.0);
        const double x = random.between(-1.0, 1.0);
        const double y = random.between(-1.0, 1.0);
        const double z = random.between(-1.0, 1.0);
        const double norm = w * w + x * x + y * y + z * z;
        if (norm > 1.0 || norm < 1e-4) {
            continue;
        }
        const double k = 2.0 / norm;
        return {glm::dvec3(1.0 - k * (y * y + z * z), k * (x * y + w * z), k * (x * z - w * y)),
                glm::dvec3(k * (x * y - w * z), 1.0 - k * (x * x + z * z), k * (y * z + w * x)),
                glm::dvec3(k * (x * z + w * y), k * (y * z - w * x), 1.0 - k * (x * x + y * y))};
    }
}

double random_shininess(RandomGenerator& random, double largest) {
    constexpr double smallest = 1.0 / 16.0;
    int octaves = 1;
    for (double start = 2.0 * smallest; start < largest; start *= 2.0) {
        ++octaves;
    }
    const int end = random.below(16);
    const int octave = random.below(octaves);
    double n = (1.0 + random.unit()) * smallest;
    for (int i = 0; i < octave; ++i) {
        n *= 2.0;
    }
    if (end == 0) {
        return 0.0;
    }
    return end == 1 ? largest : std::min(n, largest);
}

glm::dvec3 random_colour(RandomGenerator& random) {
    const int kind = random.below(10);
    const glm::dvec3 colour{random.unit(), random.unit(), random.unit()}; // braces: evaluated in this order
    if (kind < 2) {
        return glm::dvec3(kind);
    }
    return kind < 5 ? glm::dvec3(colour.x) : colour;
}

glm::dvec3 random_coat_f0(RandomGenerator& random) {
    const int kind = random.below(16);
    if (kind < 2) {
        return glm::dvec3(0.0);
    }
    if (kind == 2) {
        return random_colour(random);
    }
    const glm::dvec3 f0{dielectric_f0(random), dielectric_f0(random), dielectric_f0(random)};
    return kind < 8 ? f0 : glm::dvec3(f0.x);
}

glm::dvec3 random_absorption(RandomGenerator& random) {
    constexpr double largest = 0.6;
    const int kind = random.below(6);
    if (kind == 0) {
        return glm::dvec3(0.0);
    }
    if (kind < 3) {
        return glm::dvec3(random.between(0.0, largest));
    }
    glm::dvec3 absorption;
    for (int i = 0; i < 3; ++i) {
        const bool zero = random.below(6) == 0;
        absorption[i] = zero ? 0.0 : random.between(0.0, largest);
    }
    return absorption;
}

double random_coverage(RandomGenerator& random) {
    const int kind = random.below(20);
    const double partial = random.between(1.0 / 256.0, 1.0);
    if (kind == 0) {
        return 0.0;
    }
    return kind < 6 ? rounded_to_float(partial) : 1.0;
}

glm::dvec3 random_normal(RandomGenerator& random, const glm::dvec3& eye, const glm::dvec3& light, double n) {
    const int kind = random.below(50);
    if (kind == 0) {
        return glm::dvec3(0.0);
    }
    if (kind < 6) {
        return grazing(random, eye, kind < 4 ? 0.1 : 0.001);
    }
    if (kind < 12) {
        return grazing(random, light, kind < 10 ? 0.1 : 0.001);
    }
    if (kind < 32) {
        return near_mirror(random, eye, light, n);
    }
    const glm::dvec3 any = random.direction();
    const bool back_facing = kind < 36;
    return (glm::dot(any, eye) < 0.0) == back_facing ? any : -any;
}

bool is_sound_tangent(const glm::dvec3& tangent, const glm::dvec3& normal) {
    // Three degrees: single precision then keeps the frame to a few millionths.
    constexpr double smallest_sine = 0.05;
    const glm::dvec3 across = glm::cross(tangent, normal);
    return glm::dot(across, across) >=
           smallest_sine * smallest_sine * glm::dot(tangent, tangent) * glm::dot(normal, normal);
}

glm::dvec3 random_tangent(RandomGenerator& random, const glm::dvec3& normal) {
    const int kind = random.below(16);
    const double length = random.between(0.5, 2.0);
    if (kind == 0) {
        return glm::dvec3(0.0);
    }
    const bool has_normal = glm::dot(normal, normal) > 0.0;
    if (kind == 1 && has_normal) {
        return (random.below(2) == 0 ? length : -length) * glm::normalize(normal);
    }
    glm::dvec3 direction = random.direction();
    while (has_normal && !is_sound_tangent(direction, normal)) {
        direction = random.direction();
    }
    return length * direction;
}

} // namespace clshade
