// Radiance levels and irradiance map against sums in double, analytic lobes, and what must not show: seams, poles,
// suns.
#include "host/environment/filter_layout.h"
#include "host/environment/sh.h"
#include "host/prefilter/grid_mean.h"
#include "tests/prefilter/support.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

namespace clshade::tests {
namespace {

constexpr double pi = std::numbers::pi;
/// Single precision over sums of thousands of terms; measured: 2e-6.
constexpr double tolerance = 1e-5;

const std::vector<float>& level_of(const FilteredSet& set, int level) {
    return set.radiance.at(static_cast<std::size_t>(level));
}

/// Vertices worth asking: poles, horizon, axes, diagonals, borders and some from within.
std::vector<glm::ivec2> places(int cells) {
    const int half = cells / 2;
    return {{half, half},
            {0, 0},
            {cells, 0},
            {0, cells},
            {cells, cells},
            {half, 0},
            {0, half},
            {cells, half},
            {half, cells},
            {half / 2, half / 2},
            {half + 1, half},
            {half, half - 1},
            {cells, half - 1},
            {1, cells},
            {half / 3, half + half / 4},
            {cells - half / 5, half / 7},
            {half + half / 3, cells - 1},
            {half - half / 4, half - half / 8}};
}

double largest_error(const FilteredSet& set, const LatLong& image) {
    double worst = 0.0;
    for (int level = 0; level < radiance_levels; ++level) {
        const double n = level_shininess(level);
        const int cells = level_cells(level);
        const LatLong source = filter_source(image, n);
        for (const glm::ivec2 p : places(cells)) {
            const glm::dvec3 expected = filtered(source, vertex_direction(cells, p.x, p.y), power_lobe(n));
            worst = std::max(worst, relative_difference(vertex_value(level_of(set, level), cells, p.x, p.y), expected));
        }
    }
    const LatLong source = filter_source(image, irradiance_source_shininess);
    for (const glm::ivec2 p : places(irradiance_cells)) {
        const glm::dvec3 expected = filtered(source, vertex_direction(irradiance_cells, p.x, p.y), cosine_lobe);
        worst =
            std::max(worst, relative_difference(vertex_value(set.irradiance, irradiance_cells, p.x, p.y), expected));
    }
    return worst;
}

TEST(Radiance, EveryLevelIsTheSumOfTheLayout) {
    const LatLong image = random_picture(128, 1);
    EXPECT_LT(largest_error(prefilter_of().filter(image, {}), image), tolerance);
}

TEST(Radiance, LanesAgreeWithDouble) {
    LatLong image = random_picture(64, 2);
    set_texel(image, 100, 5, {2e5, 1e5, 3e4});
    for (const int lanes : all_lanes) {
        EXPECT_LT(largest_error(prefilter_of(lanes).filter(image, {}), image), tolerance) << lanes << " lanes";
    }
}

TEST(Radiance, SmallAndOddPictures) {
    for (const int height : {1, 3, 4, 125}) {
        const LatLong image = random_picture(height, 3);
        EXPECT_LT(largest_error(prefilter_of().filter(image, {}), image), tolerance) << height << " rows";
    }
}

TEST(Radiance, ConstantPictureStaysAsItIs) {
    const glm::dvec3 radiance(0.3, 1.0, 70.0);
    const FilteredSet set = prefilter_of().filter(picture(32, [&](int, int) { return radiance; }), {});
    for (int level = 0; level < radiance_levels; ++level) {
        const int cells = level_cells(level);
        for (int j = 0; j <= cells; ++j) {
            for (int i = 0; i <= cells; ++i) {
                // A quotient of two sums of the same weights, each rounded some dozens of times.
                ASSERT_LT(relative_difference(vertex_value(level_of(set, level), cells, i, j), radiance), 3e-6)
                    << "level " << level << " vertex " << i << ", " << j;
            }
        }
    }
    EXPECT_LT(relative_difference(set.mean, radiance), 1e-6);
    EXPECT_LT(relative_difference(set.sh[0], radiance * std::sqrt(4.0 * pi)), 1e-6);
}

/// Integral over the sphere of the bilinear octahedral map, with `steps` points a cell side.
glm::dvec3 energy(const std::vector<float>& grid, int cells, int steps) {
    glm::dvec3 sum(0.0);
    double area = 0.0;
    const int points = cells * steps;
    for (int py = 0; py < points; ++py) {
        for (int px = 0; px < points; ++px) {
            const int i = px / steps;
            const int j = py / steps;
            const double fx = (px % steps + 0.5) / steps;
            const double fy = (py % steps + 0.5) / steps;
            const glm::dvec3 value = glm::mix(
                glm::mix(vertex_value(grid, cells, i, j), vertex_value(grid, cells, i + 1, j), fx),
                glm::mix(vertex_value(grid, cells, i, j + 1), vertex_value(grid, cells, i + 1, j + 1), fx), fy);
            // The unnormalised direction v on the octahedron sweeps dw = dx dy / |v|^3.
            const double x = std::abs(2.0 * (px + 0.5) / points - 1.0);
            const double y = std::abs(2.0 * (py + 0.5) / points - 1.0);
            const double z = 1.0 - x - y;
            const glm::dvec3 v = z >= 0.0 ? glm::dvec3(x, y, z) : glm::dvec3(1.0 - y, 1.0 - x, z);
            const double weight = 1.0 / std::pow(glm::dot(v, v), 1.5);
            sum += weight * value;
            area += weight;
        }
    }
    return sum * (4.0 * pi / area);
}

TEST(Radiance, SunKeepsItsEnergyAtEveryLevel) {
    // The promise: a peak of 2e5 keeps its energy within 0.5 % at every level.
    LatLong image = picture(256, [](int, int) { return glm::dvec3(0.5); });
    set_texel(image, 371, 77, {2e5, 2e5, 2e5});
    const glm::dvec3 whole = mean_radiance(image) * 4.0 * pi;
    const FilteredSet set = prefilter_of().filter(image, {});
    for (int level = 0; level < radiance_levels; ++level) {
        const int cells = level_cells(level);
        const glm::dvec3 kept = energy(level_of(set, level), cells, 4);
        EXPECT_LT(relative_difference(kept, whole), 0.005) << "level " << level;
        EXPECT_LT(relative_difference(grid_mean(level_of(set, level), cells) * 4.0 * pi, kept), 1e-3);
    }
    EXPECT_LT(relative_difference(energy(set.irradiance, irradiance_cells, 4), whole), 0.005);
}

TEST(Radiance, TurningThePictureTurnsTheMaps) {
    // A quarter turn takes vertices to vertices: (x, y) to (-y, x). Texel x moves up by a quarter: phi falls.
    const LatLong image = random_picture(64, 4);
    const FilteredSet set = prefilter_of().filter(image, {});
    const FilteredSet quarter = prefilter_of().filter(turned(image, image.width / 4), {});
    for (int level = 0; level < radiance_levels; ++level) {
        const int cells = level_cells(level);
        for (const glm::ivec2 p : places(cells)) {
            const glm::dvec3 before = vertex_value(level_of(set, level), cells, p.x, p.y);
            // Down a quarter in phi: (x, y) goes to (y, -x).
            const glm::dvec3 after = vertex_value(level_of(quarter, level), cells, p.y, cells - p.x);
            EXPECT_LT(relative_difference(after, before), 3e-6) << "level " << level << " at " << p.x << ", " << p.y;
        }
    }
}

TEST(Radiance, FoldedBorderHasOneValuePerDirection) {
    const FilteredSet set = prefilter_of().filter(random_picture(32, 5), {});
    for (int level = 0; level < radiance_levels; ++level) {
        const std::vector<float>& grid = level_of(set, level);
        const int cells = level_cells(level);
        for (const int side : {0, cells}) {
            for (int t = 0; t <= cells; ++t) {
                EXPECT_EQ(vertex_value(grid, cells, side, t), vertex_value(grid, cells, side, cells - t));
                EXPECT_EQ(vertex_value(grid, cells, t, side), vertex_value(grid, cells, cells - t, side));
            }
        }
        EXPECT_EQ(vertex_value(grid, cells, 0, 0), vertex_value(grid, cells, cells, cells));
    }
}

TEST(Irradiance, OfOneTexelIsItsCosine) {
    LatLong image = black_picture(64);
    const int x = 21;
    const int y = 24;
    set_texel(image, x, y, {1000.0, 2000.0, 3000.0});
    const glm::dvec3 light = texel_direction(128, 64, x + 0.5, y + 0.5);
    const double solid_angle = texel_solid_angle(128, 64, y);
    const FilteredSet set = prefilter_of().filter(image, {});
    for (const glm::ivec2 p : places(irradiance_cells)) {
        const double cosine = glm::dot(light, vertex_direction(irradiance_cells, p.x, p.y));
        const double expected = 1000.0 * solid_angle * std::max(0.0, cosine) / pi;
        // The texel is 0.05 wide, once doubled 0.07; it is shaded by its middle's cosine.
        EXPECT_NEAR(vertex_value(set.irradiance, irradiance_cells, p.x, p.y).x, expected,
                    0.005 * 1000.0 * solid_angle / pi);
    }
}

nlohmann::json vectors() {
    return nlohmann::json::parse(std::ifstream(CLSHADE_TEST_DATA "/vectors.json"));
}

TEST(Radiance, OfOneTexelIsTheLobe) {
    // models.md section 6, pmrem_kernel: p_n(c), c the cosine between R and the light. One texel of a fine picture
    // stands for the light; vertices of a level lie at all distances from it.
    LatLong image = black_picture(128);
    set_texel(image, 77, 60, {1e4, 1e4, 1e4});
    const FilteredSet set = prefilter_of().filter(image, {});
    int tested = 0;
    for (const nlohmann::json& vector : vectors()) {
        if (vector.at("model") != "pmrem_kernel") {
            continue;
        }
        ++tested;
        const double n = vector.at("inputs").at("n");
        const double c = vector.at("inputs").at("c");
        const double expected = vector.at("output");
        EXPECT_NEAR((n + 2.0) / (8.0 * pi) * power_lobe(n)(c), expected, 1e-8 * expected);
        int level = 0;
        while (level_shininess(level) > n) {
            ++level;
        }
        ASSERT_EQ(level_shininess(level), n);
        const int cells = level_cells(level);
        const LatLong source = filter_source(image, n);
        const glm::dvec3 power = mean_radiance(source) * 4.0 * pi;
        // The source's lit texels, seen from the vertex whose cosine to their middle is nearest to c.
        glm::dvec3 light(0.0);
        for (int y = 0; y < source.height; ++y) {
            for (int x = 0; x < source.width; ++x) {
                light += vertex_value(source.rgb, source.width - 1, x, y).x *
                         texel_solid_angle(source.width, source.height, y) *
                         texel_direction(source.width, source.height, x + 0.5, y + 0.5);
            }
        }
        light = glm::normalize(light);
        glm::ivec2 nearest(0);
        double best = 2.0;
        for (int j = 0; j <= cells; ++j) {
            for (int i = 0; i <= cells; ++i) {
                const double distance = std::abs(glm::dot(light, vertex_direction(cells, i, j)) - c);
                if (distance < best) {
                    best = distance;
                    nearest = {i, j};
                }
            }
        }
        const double cosine = glm::dot(light, vertex_direction(cells, nearest.x, nearest.y));
        const double lobe = (n + 2.0) / (8.0 * pi) * power_lobe(n)(cosine);
        if (lobe > 1e-9 * (n + 2.0)) { // within reach
            // Normalised by its own sum over texels in place of the integral: 5 texels a deviation, 0.3 % at most.
            const double value = vertex_value(level_of(set, level), cells, nearest.x, nearest.y).x;
            EXPECT_NEAR(value / (power.x * lobe), 1.0, 0.01) << "n " << n << " c " << c;
        }
    }
    EXPECT_GE(tested, 3);
}

TEST(Radiance, ZonalCoefficientsOfALevel) {
    // models.md section 6, pmrem_zonal: filtering multiplies band l by a_l. So the filtered sine of a picture that is a
    // zonal harmonic is that harmonic times a_l; here along z.
    const auto legendre = [](int band, double z) {
        return band == 1 ? z : band == 2 ? 1.5 * z * z - 0.5 : 2.5 * z * z * z - 1.5 * z;
    };
    const int height = 256;
    int tested = 0;
    for (const nlohmann::json& vector : vectors()) {
        if (vector.at("model") != "pmrem_zonal") {
            continue;
        }
        const double n = vector.at("inputs").at("n");
        int level = 0;
        while (level_shininess(level) > n) {
            ++level;
        }
        const int cells = level_cells(level);
        for (int band = 1; band <= 3; ++band) {
            ++tested;
            const LatLong image = picture(height, [&](int /*x*/, int y) {
                return glm::dvec3(2.0 + legendre(band, std::cos(pi * (y + 0.5) / height)));
            });
            const FilteredSet set = prefilter_of().filter(image, {});
            const double expected = vector.at("output").at(static_cast<std::size_t>(band));
            for (const glm::ivec2 p : places(cells)) {
                const double z = vertex_direction(cells, p.x, p.y).z;
                // Texels of a fifth of a deviation: the harmonic is sampled within a few parts in a thousand.
                EXPECT_NEAR(vertex_value(level_of(set, level), cells, p.x, p.y).x - 2.0, expected * legendre(band, z),
                            0.006)
                    << "n " << n << " band " << band;
            }
        }
    }
    EXPECT_GE(tested, 3);
}

TEST(Radiance, ProgressRunsFromNothingToAll) {
    std::vector<double> told;
    PrefilterReport report;
    const FilteredSet set = prefilter_of().filter(
        random_picture(64, 6), [&](double share) { told.push_back(share); }, &report);
    check_sizes(set);
    ASSERT_GE(told.size(), 15U); // one for every map at least
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GT(told.front(), 0.0);
    EXPECT_EQ(told.back(), 1.0);
    EXPECT_FALSE(report.from_cache);
    EXPECT_GT(report.kernel_milliseconds, 0.0);
    EXPECT_GT(report.milliseconds, report.kernel_milliseconds);
}

TEST(Radiance, RefusesLanesThereAreNot) {
    EXPECT_THROW(static_cast<void>(prefilter_of(3)), std::invalid_argument);
}

TEST(Radiance, RefusesWhatIsNotTwiceAsWideAsHigh) {
    LatLong image = black_picture(4);
    image.width = 4;
    image.height = 8;
    EXPECT_THROW(static_cast<void>(prefilter_of().filter(image, {})), std::invalid_argument);
}

} // namespace
} // namespace clshade::tests
