// Pictures of the sky: solid angles, cleaning, halving, doubling, sources of the filter, the studio.
#include "host/environment/filter_layout.h"
#include "host/environment/lat_long.h"
#include "host/environment/sh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace clshade {
namespace {

constexpr double pi = std::numbers::pi;

LatLong picture(int height, float value = 0.0F) {
    LatLong image;
    image.name = "test";
    image.width = 2 * height;
    image.height = height;
    image.rgb.assign(static_cast<std::size_t>(height) * static_cast<std::size_t>(height) * 6, value);
    return image;
}

float& at(LatLong& image, int x, int y, int c) {
    return image
        .rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) * 3 +
             static_cast<std::size_t>(c)];
}

LatLong noise(int height) {
    LatLong image = picture(height);
    std::mt19937 random(7);
    std::exponential_distribution<float> values(2.0F);
    std::generate(image.rgb.begin(), image.rgb.end(), [&] { return values(random); });
    return image;
}

TEST(LatLong, SolidAnglesAreThoseOfZonesAndAddUpToTheSphere) {
    for (const int height : {1, 2, 5, 64, 500}) {
        double sum = 0.0;
        for (int y = 0; y < height; ++y) {
            const double angle = texel_solid_angle(2 * height, height, y);
            const double zone = pi / height * (std::cos(pi * y / height) - std::cos(pi * (y + 1) / height));
            EXPECT_NEAR(angle, zone, 1e-15) << height << " " << y; // cosines near 1 round to 1e-16
            sum += angle * 2 * height;
        }
        EXPECT_NEAR(sum, 4.0 * pi, 1e-12);
    }
}

TEST(LatLong, CleaningCountsTexelsNotChannels) {
    LatLong image = picture(4, 0.5F);
    at(image, 0, 0, 0) = -1.0F;
    at(image, 0, 0, 2) = -2.0F;
    at(image, 1, 0, 1) = std::numeric_limits<float>::quiet_NaN();
    at(image, 2, 0, 1) = std::numeric_limits<float>::infinity();
    at(image, 3, 0, 1) = -std::numeric_limits<float>::infinity();
    at(image, 4, 0, 0) = -1.0F; // both faults: counted once, as not finite
    at(image, 4, 0, 1) = std::numeric_limits<float>::quiet_NaN();
    at(image, 7, 3, 2) = -1e-30F;
    image.negative = 10;
    clean(image);
    EXPECT_EQ(image.negative, 12U);
    EXPECT_EQ(image.nonfinite, 4U);
    EXPECT_EQ(at(image, 0, 0, 0), 0.0F);
    EXPECT_EQ(at(image, 0, 0, 1), 0.5F); // the good channel stays
    EXPECT_EQ(at(image, 0, 0, 2), 0.0F);
    for (int x = 1; x <= 4; ++x) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(at(image, x, 0, c), 0.0F) << x << " " << c;
        }
    }
    EXPECT_EQ(at(image, 7, 3, 2), 0.0F);
    EXPECT_EQ(at(image, 6, 3, 2), 0.5F);
}

TEST(LatLong, HalvingKeepsTheEnergyOfASun) {
    // One texel of 2e5 beside the pole, where neighbouring rows differ most, and one at the equator.
    for (const int row : {0, 1, 5, 255}) {
        LatLong image = picture(512, 0.1F);
        at(image, 37, row, 0) = 2e5F;
        at(image, 38, row, 1) = 2e5F;
        const glm::dvec3 before = mean_radiance(image);
        while (image.height % 2 == 0) {
            image = halved(image);
            const glm::dvec3 after = mean_radiance(image);
            for (int c = 0; c < 3; ++c) {
                // Every halving rounds each texel to a float, 6e-8.
                EXPECT_NEAR(after[c] / before[c], 1.0, 1e-6) << row << " " << image.height;
            }
        }
        EXPECT_EQ(image.height, 1);
        EXPECT_EQ(image.width, 2);
    }
}

TEST(LatLong, HalvingTakesTheFourTexels) {
    LatLong image = picture(4);
    at(image, 4, 2, 1) = 1.0F;
    at(image, 5, 3, 1) = 3.0F;
    LatLong half = halved(image);
    EXPECT_EQ(half.width, 4);
    EXPECT_EQ(half.height, 2);
    // Rows 2 and 3 of 4: from cos 90 = 0 to -cos 45, and on to -1.
    const double upper = std::sqrt(0.5);
    EXPECT_NEAR(at(half, 2, 1, 1), 0.5 * (upper * 1.0 + (1.0 - upper) * 3.0), 1e-7);
    EXPECT_EQ(std::count(half.rgb.begin(), half.rgb.end(), 0.0F), 4 * 2 * 3 - 1);
}

TEST(LatLong, HalvingKeepsWhatIsKnownOfThePicture) {
    LatLong image = picture(2, 1.0F);
    image.up = UpAxis::y;
    image.halvings = 3;
    image.negative = 4;
    image.nonfinite = 5;
    for (const LatLong& other : {halved(image), doubled(image)}) {
        EXPECT_EQ(other.name, "test");
        EXPECT_EQ(other.up, UpAxis::y);
        EXPECT_EQ(other.halvings, 3);
        EXPECT_EQ(other.negative, 4U);
        EXPECT_EQ(other.nonfinite, 5U);
    }
    EXPECT_THROW(static_cast<void>(halved(picture(1))), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(halved(picture(5))), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(doubled(LatLong())), std::invalid_argument);
}

TEST(LatLong, DoublingIsBilinearWithSeamAndPoles) {
    const int height = 3;
    LatLong image = noise(height);
    LatLong twice = doubled(image);
    ASSERT_EQ(twice.width, 12);
    ASSERT_EQ(twice.height, 6);
    // Straight from the words of filter_layout.h: u wraps, and beyond a pole the nearest row, half a turn on.
    const auto texel = [&](int x, int y, int c) {
        if (y < 0 || y >= height) {
            x += height;
            y = std::clamp(y, 0, height - 1);
        }
        return static_cast<double>(at(image, (x + 2 * image.width) % image.width, y, c));
    };
    for (int y = 0; y < twice.height; ++y) {
        for (int x = 0; x < twice.width; ++x) {
            const double px = (x + 0.5) / 2.0 - 0.5;
            const double py = (y + 0.5) / 2.0 - 0.5;
            const int x0 = static_cast<int>(std::floor(px));
            const int y0 = static_cast<int>(std::floor(py));
            const double fx = px - x0;
            const double fy = py - y0;
            for (int c = 0; c < 3; ++c) {
                const double wanted = (1 - fy) * ((1 - fx) * texel(x0, y0, c) + fx * texel(x0 + 1, y0, c)) +
                                      fy * ((1 - fx) * texel(x0, y0 + 1, c) + fx * texel(x0 + 1, y0 + 1, c));
                EXPECT_NEAR(at(twice, x, y, c), wanted, 1e-6 * wanted) << x << " " << y; // rounded to a float once
            }
        }
    }
}

TEST(LatLong, SourcesHaveFiveTexelsADeviation) {
    for (const int height : {512, 1024, 2048, 4096, 500, 64, 1, 7, 384}) {
        for (int level = 0; level < radiance_levels; ++level) {
            const double n = level_shininess(level);
            const double largest = 2.0 / std::sqrt(n) / 5.0;
            int rows = height;
            while (rows < 128) {
                rows *= 2;
            }
            while (rows % 2 == 0 && pi / (0.5 * rows) <= largest) {
                rows /= 2;
            }
            EXPECT_EQ(source_height(2 * height, height, n), rows) << height << " " << n;
        }
    }
    // By hand: n = 8192 wants texels of 0.0044, 711 rows; n = 128 wants 0.0354, 89 rows; n = 1 wants 0.4, 8 rows.
    EXPECT_EQ(source_height(2048, 1024, 8192.0), 1024);
    EXPECT_EQ(source_height(4096, 2048, 8192.0), 1024);
    EXPECT_EQ(source_height(1024, 512, 8192.0), 512);
    EXPECT_EQ(source_height(1024, 512, 128.0), 128);
    EXPECT_EQ(source_height(1024, 512, 1.0), 8);
    EXPECT_EQ(source_height(1000, 500, 1.0), 125); // odd: no further
    EXPECT_EQ(source_height(2, 1, 8192.0), 128);
    EXPECT_THROW(static_cast<void>(source_height(0, 0, 8.0)), std::invalid_argument);
}

TEST(LatLong, SourcesAreDoubledOrHalved) {
    const LatLong image = noise(256);
    EXPECT_EQ(filter_source(image, 8192.0).rgb, image.rgb);
    EXPECT_EQ(filter_source(image, 128.0).rgb, halved(image).rgb);
    EXPECT_EQ(filter_source(image, 32.0).rgb, halved(halved(image)).rgb);
    const LatLong small = noise(50);
    EXPECT_EQ(filter_source(small, 8192.0).rgb, doubled(doubled(small)).rgb);
    EXPECT_EQ(filter_source(small, 8.0).rgb, halved(halved(halved(doubled(doubled(small))))).rgb);
}

TEST(LatLong, HashesTellSizesAndTexelsApart) {
    const LatLong image = noise(8);
    const std::string hash = content_hash(image);
    EXPECT_EQ(hash.size(), 32U);
    LatLong other = image;
    other.name = "another name";
    EXPECT_EQ(content_hash(other), hash);
    other.rgb.back() = std::nextafter(other.rgb.back(), 9.0F);
    EXPECT_NE(content_hash(other), hash);
    LatLong turned = image;
    std::swap(turned.width, turned.height);
    EXPECT_NE(content_hash(turned), hash);
}

TEST(Studio, HasTheLightItSays) {
    const LatLong studio = built_in_studio();
    EXPECT_EQ(studio.height, 256);
    EXPECT_EQ(studio.width, 512);
    EXPECT_EQ(studio.up, UpAxis::y);
    EXPECT_EQ(studio.name, "studio");
    const glm::dvec3 mean = mean_radiance(studio);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean[c], 0.55, 0.1);
    }
    EXPECT_GT(mean.r, mean.b); // the key is warm
    const float peak = *std::max_element(studio.rgb.begin(), studio.rgb.end());
    EXPECT_GT(peak, 18.0F);
    EXPECT_LT(peak, 22.0F);
    EXPECT_GT(*std::min_element(studio.rgb.begin(), studio.rgb.end()), 0.0F);
    EXPECT_THROW(static_cast<void>(built_in_studio(7)), std::invalid_argument);
}

/// Radiance of the studio along (x, y, z): +X right, +Y up, +Z towards the camera (conventions.md section 4, OpenEXR).
glm::dvec3 seen(LatLong& studio, double x, double y, double z) {
    const double u = 0.5 - std::atan2(x, z) / (2.0 * pi);
    const double v = std::acos(y / std::sqrt(x * x + y * y + z * z)) / pi;
    const int column = static_cast<int>(u * studio.width) % studio.width;
    const int row = std::min(static_cast<int>(v * studio.height), studio.height - 1);
    return {at(studio, column, row, 0), at(studio, column, row, 1), at(studio, column, row, 2)};
}

TEST(Studio, HasItsLampsWhereTheyBelong) {
    LatLong studio = built_in_studio();
    const glm::dvec3 key = seen(studio, -0.62, 0.62, 0.66);
    EXPECT_GT(key.g, 15.0);
    EXPECT_GT(key.r, 1.2 * key.b); // warm
    EXPECT_LT(seen(studio, 0.62, 0.62, 0.66).g, 1.0);
    const glm::dvec3 fill = seen(studio, 0.96, 0.16, 0.16);
    EXPECT_GT(fill.g, 1.5);
    EXPECT_GT(fill.b, 1.2 * fill.r); // cool
    EXPECT_GT(seen(studio, -0.72, 0.26, -0.66).g, 5.0);
    EXPECT_LT(seen(studio, 0.0, -1.0, 0.0).g, 0.05);
    EXPECT_LT(seen(studio, 0.0, -0.8, -0.6).g, 0.05);
}

TEST(Studio, IsTheSameAtEverySize) {
    const glm::dvec3 fine = mean_radiance(built_in_studio(512));
    for (const int height : {128, 256, 1024}) {
        const glm::dvec3 mean = mean_radiance(built_in_studio(height));
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mean[c] / fine[c], 1.0, 0.01)
                << height; // sampled at texel centres; edges are one texel wide or more
        }
    }
}

} // namespace
} // namespace clshade
