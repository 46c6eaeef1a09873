// Spherical harmonics of pictures against their definition.
#include "host/environment/sh.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

namespace clshade {
namespace {

constexpr double pi = std::numbers::pi;
using Coefficients = std::array<glm::dvec3, 9>;

/// models.md section 6, digits as printed there.
std::array<double, 9> basis(const glm::dvec3& d) {
    return {0.282094792,
            0.488602512 * d.y,
            0.488602512 * d.z,
            0.488602512 * d.x,
            1.092548431 * d.x * d.y,
            1.092548431 * d.y * d.z,
            0.315391565 * (3.0 * d.z * d.z - 1.0),
            1.092548431 * d.x * d.z,
            0.546274215 * (d.x * d.x - d.y * d.y)};
}

/// Of a texel's centre, from lat_long.h: u = 0.5 - atan2(d.y, d.x)/(2 pi), v = acos(d.z)/pi.
glm::dvec3 direction(const LatLong& image, int x, int y) {
    const double azimuth = (0.5 - (x + 0.5) / image.width) * 2.0 * pi;
    const double polar = pi * (y + 0.5) / image.height;
    return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
}

LatLong picture(int height, const std::function<glm::dvec3(const glm::dvec3&)>& radiance) {
    LatLong image;
    image.name = "test";
    image.width = 2 * height;
    image.height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::dvec3 value = radiance(direction(image, x, y));
            for (int c = 0; c < 3; ++c) {
                image.rgb.push_back(static_cast<float>(value[c]));
            }
        }
    }
    return image;
}

/// Three lamps of different colours, smooth and without symmetry.
glm::dvec3 lamps(const glm::dvec3& d) {
    const auto lobe = [&](const glm::dvec3& axis, double n) {
        return std::pow(0.5 + 0.5 * glm::dot(d, glm::normalize(axis)), n);
    };
    return glm::dvec3(5.0, 1.0, 0.2) * lobe({1.0, 0.3, 0.5}, 20.0) +
           glm::dvec3(0.1, 2.0, 4.0) * lobe({-0.4, -0.9, 0.2}, 8.0) +
           glm::dvec3(1.0, 1.0, 3.0) * lobe({0.1, 0.7, -0.8}, 40.0) + 0.1;
}

/// The coefficients of the function that has value f(d) = sum of c Y, found from nine directions.
Coefficients project(const std::function<glm::dvec3(const glm::dvec3&)>& f) {
    // Bands 0 to 2 are polynomials of degree 2, and products of two of them of degree 4: Gauss-Legendre with 5 nodes in
    // z and 12 azimuths integrates them exactly.
    const std::array<double, 5> nodes{0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                      -0.9061798459386640};
    const std::array<double, 5> weights{0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                                        0.2369268850561891};
    Coefficients sums{};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double s = std::sqrt(1.0 - nodes[i] * nodes[i]);
        for (int k = 0; k < 12; ++k) {
            const double p = 2.0 * pi * k / 12.0;
            const glm::dvec3 d(s * std::cos(p), s * std::sin(p), nodes[i]);
            const std::array<double, 9> y = basis(d);
            for (std::size_t j = 0; j < 9; ++j) {
                sums[j] += weights[i] * 2.0 * pi / 12.0 * y[j] * f(d);
            }
        }
    }
    return sums;
}

glm::dvec3 evaluate(const Coefficients& sh, const glm::dvec3& d) {
    const std::array<double, 9> y = basis(d);
    glm::dvec3 sum(0.0);
    for (std::size_t j = 0; j < 9; ++j) {
        sum += y[j] * sh[j];
    }
    return sum;
}

TEST(Sh, OfAConstant) {
    const LatLong image = picture(64, [](const glm::dvec3&) { return glm::dvec3(1.0, 2.0, 0.5); });
    const Coefficients sh = sh_of(image);
    for (int c = 0; c < 3; ++c) {
        const double value = c == 0 ? 1.0 : c == 1 ? 2.0 : 0.5;
        EXPECT_NEAR(sh[0][c], value * std::sqrt(4.0 * pi), 1e-12);
        for (std::size_t j = 1; j < 9; ++j) {
            // Texel centres stand for whole texels: band 2 along the axis is off by the square of a texel.
            EXPECT_NEAR(sh[j][c], 0.0, j == 6 ? 3e-3 : 1e-12) << j;
        }
        EXPECT_NEAR(mean_radiance(image)[c], value, 1e-12);
    }
}

TEST(Sh, OfSingleTexelsIsTheBasis) {
    for (const auto& [x, y] : {std::array{0, 0}, {5, 3}, {13, 7}, {24, 11}, {31, 15}, {16, 8}}) {
        LatLong image = picture(16, [](const glm::dvec3&) { return glm::dvec3(0.0); });
        image.rgb[(static_cast<std::size_t>(y) * 32 + static_cast<std::size_t>(x)) * 3 + 1] = 4.0F;
        const Coefficients sh = sh_of(image);
        const std::array<double, 9> wanted = basis(direction(image, x, y));
        const double energy = 4.0 * texel_solid_angle(32, 16, y);
        for (std::size_t j = 0; j < 9; ++j) {
            EXPECT_NEAR(sh[j].g, energy * wanted[j], 2e-9 * energy) << x << " " << y << " " << j; // digits of basis()
            EXPECT_EQ(sh[j].r, 0.0);
            EXPECT_EQ(sh[j].b, 0.0);
        }
        EXPECT_NEAR(mean_radiance(image).g, energy / (4.0 * pi), 1e-15);
    }
}

TEST(Sh, AxesHaveTheirSigns) {
    // models.md section 6: order 1, y, z, x. Light from one axis only fills its coefficient, with a plus.
    const std::array<glm::dvec3, 3> axes{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Coefficients sh =
            sh_of(picture(64, [&](const glm::dvec3& d) { return glm::dvec3(std::max(0.0, glm::dot(d, axes[i]))); }));
        for (std::size_t j = 0; j < 3; ++j) {
            // Integral of max(0, c) c over the sphere: 2 pi/3. Half a thousandth for 64 rows.
            EXPECT_NEAR(sh[j + 1].r, i == j ? std::sqrt(3.0 / (4.0 * pi)) * 2.0 * pi / 3.0 : 0.0, 5e-4) << i << j;
        }
    }
}

TEST(Sh, OfARotatedPictureIsTheRotatedSh) {
    // A rotation about no axis of the picture.
    const glm::dvec3 x = glm::normalize(glm::dvec3(0.3, -0.7, 0.6));
    const glm::dvec3 y = glm::normalize(glm::cross(glm::dvec3(0.2, 0.9, 0.4), x));
    const glm::dmat3 rotation(x, y, glm::cross(x, y));
    const glm::dmat3 back = glm::transpose(rotation);
    const Coefficients still = sh_of(picture(256, lamps));
    const Coefficients turned = sh_of(picture(256, [&](const glm::dvec3& d) { return lamps(back * d); }));
    const Coefficients wanted = project([&](const glm::dvec3& d) { return evaluate(still, back * d); });
    double moved = 0.0;
    for (std::size_t j = 0; j < 9; ++j) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(turned[j][c], wanted[j][c], 2e-4 * still[0][c]) << j; // 256 rows: (pi/256)^2
            moved = std::max(moved, std::abs(turned[j][c] - still[j][c]));
        }
    }
    EXPECT_GT(moved, 0.1);
}

TEST(Sh, IsKeptByHalving) {
    const LatLong image = picture(256, lamps);
    const Coefficients fine = sh_of(image);
    const Coefficients coarse = sh_of(halved(image));
    for (std::size_t j = 0; j < 9; ++j) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(coarse[j][c], fine[j][c], 2e-4 * fine[0][c]); // (pi/128)^2
        }
    }
}

} // namespace
} // namespace clshade
