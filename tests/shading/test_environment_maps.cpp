// Maps as kernels look them up: records, maps for one exponent, when maps are made anew.
#include "host/shading/environment_layout.h"
#include "host/shading/environment_maps.h"
#include "tests/shading/environments.h"

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace clshade {
namespace {

/// The number that a kernel file defines a name as.
double defined(const std::string& name) {
    const SourceSet sources = kernel_sources();
    const std::string& text = sources.text("environment.cl");
    const std::string line = "#define " + name + " ";
    const std::size_t at = text.find(line);
    return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + line.size()));
}

TEST(EnvironmentMapRecords, KernelsAndHostMeanTheSamePlaces) {
    EXPECT_EQ(defined("IRRADIANCE_RECORD"), static_cast<double>(irradiance_record()));
    EXPECT_GE(irradiance_record(), level_record(radiance_levels));
    EXPECT_EQ(defined("IRRADIANCE_CELLS"), irradiance_cells);
    EXPECT_EQ(defined("LAST_LEVEL"), radiance_levels - 1);
    EXPECT_EQ(defined("AMBIENT_COSINES"), ambient_cosines);
    EXPECT_EQ(defined("AMBIENT_EXPONENTS"), ambient_exponents);
    EXPECT_EQ(defined("AMBIENT_OCTAVES"), ambient_octaves);
    EXPECT_EQ(defined("AMBIENT_LINEAR"), defined("AMBIENT_EXACT") + ambient_cosines * ambient_exponents);
}

TEST(EnvironmentMapRecords, AColourRecordHoldsTheFourCornersOfItsCell) {
    constexpr int cells_across = 3;
    constexpr int cells_down = 2;
    std::vector<float> vertices;
    for (int y = 0; y <= cells_down; ++y) {
        for (int x = 0; x <= cells_across; ++x) {
            for (int c = 0; c < 3; ++c) {
                vertices.push_back(static_cast<float>(100 * y + 10 * x + c));
            }
        }
    }
    std::vector<float> records(std::size_t{16} * cells_across * cells_down);
    fill_colour_records(records, vertices, cells_across, cells_down, {1.0, 2.0, 0.5});
    constexpr std::array<float, 3> factor = {1.0F, 2.0F, 0.5F};
    for (int y = 0; y < cells_down; ++y) {
        for (int x = 0; x < cells_across; ++x) {
            for (int k = 0; k < 12; ++k) { // r00 r10 r01 r11, g00 ...
                const int c = k / 4;
                const int down = k % 4 / 2;
                const auto vertex = static_cast<float>(100 * (y + down) + 10 * (x + k % 2) + c);
                EXPECT_EQ(records[static_cast<std::size_t>(16 * (y * cells_across + x) + k)],
                          vertex * factor[static_cast<std::size_t>(c)]);
            }
        }
    }
}

TEST(EnvironmentMapRecords, APairRecordHoldsTheFourCornersOfItsCell) {
    const std::vector<float> vertices = {0, 100, 1, 101, 2, 102, 3, 103, 4, 104, 5, 105}; // 2 x 1 cells
    std::vector<float> records(16);
    fill_pair_records(records, vertices, 2, 1);
    EXPECT_EQ(records, (std::vector<float>{0, 1, 3, 4, 100, 101, 103, 104, 1, 2, 4, 5, 101, 102, 104, 105}));
}

/// Bilinear in a level at a place 0..1 of the square.
double level_at_place(const std::vector<float>& level, int cells, double x, double y, int channel) {
    const int i = std::min(static_cast<int>(x * cells), cells - 1);
    const int j = std::min(static_cast<int>(y * cells), cells - 1);
    const double fx = x * cells - i;
    const double fy = y * cells - j;
    const auto at = [&](int a, int b) {
        return static_cast<double>(
            level[(static_cast<std::size_t>(b) * static_cast<std::size_t>(cells + 1) + static_cast<std::size_t>(a)) *
                      3 +
                  static_cast<std::size_t>(channel)]);
    };
    return (1.0 - fy) * ((1.0 - fx) * at(i, j) + fx * at(i + 1, j)) +
           fy * ((1.0 - fx) * at(i, j + 1) + fx * at(i + 1, j + 1));
}

TEST(EnvironmentMapRecords, AMapForOneExponentIsWhatLiesBetweenTwoLevels) {
    const FilteredSet& maps = *filtered_studio().maps;
    for (const double n : {0.0, 1.0, 1.5, 2.9, 70.0, 300.0, 4096.0, 5000.0, 8192.0, 65536.0}) {
        const std::vector<float> blend = blended_level(maps, n);
        const double mip = std::clamp(std::log2(8192.0 / std::max(n, 1.0)), 0.0, 13.0);
        const int sharper = std::min(static_cast<int>(mip), 12);
        const auto index = static_cast<std::size_t>(sharper);
        const int cells = level_cells(sharper);
        ASSERT_EQ(blend.size(),
                  std::size_t{3} * static_cast<std::size_t>(cells + 1) * static_cast<std::size_t>(cells + 1))
            << n;
        for (int k = 0; k < 500; ++k) { // places that no grid has
            const double x = std::fmod(0.37 + 0.618034 * k, 1.0);
            const double y = std::fmod(0.11 + 0.754878 * k, 1.0);
            const int c = k % 3;
            const double part = mip - sharper;
            const double expected = (1.0 - part) * level_at_place(maps.radiance[index], cells, x, y, c) +
                                    part * level_at_place(maps.radiance[index + 1], level_cells(sharper + 1), x, y, c);
            ASSERT_NEAR(level_at_place(blend, cells, x, y, c), expected, 2e-7 * expected) << n; // floats
        }
    }
}

/// A metal over red paint; the exponents of both are constant.
Frame two_materials() {
    Frame frame = random_frame(32, 16, SpecularModel::blinn_phong_spectral, DiffuseModel::none, 2);
    surround(frame, AmbientSource::irradiance_map, 2);
    frame.lights.clear();
    BoundMaterial paint = frame.materials[0];
    paint.base().specular = SpecularModel::blinn_phong;
    paint.base().f0 = constant_of(0.3);
    paint.base().shininess = constant_of(40.0);
    spread_materials(frame, {frame.materials[0], paint});
    return frame;
}

// One shader for a row of frames, as a program that shades many uses it, against a fresh one for each.
TEST(EnvironmentMaps, AreMadeAnewWhereAFrameNeedsOthers) {
    const FilteredStudio other = filtered(picture_of(16, [](int x, int y) { return glm::dvec3(x, y, x + y) * 0.05; }));
    const std::vector<std::pair<std::string, std::function<void(Frame&)>>> changes = {
        {"first", [](Frame&) {}},
        {"the same again", [](Frame&) {}},
        {"the materials in the other order",
         [](Frame& frame) {
             std::swap(frame.materials[0], frame.materials[1]);
             std::swap(frame.materials[0].ids, frame.materials[1].ids);
         }},
        {"first again", [](Frame&) {}},
        {"intensity", [](Frame& frame) { frame.environment->intensity *= 2.0; }},
        {"another place",
         [&other](Frame& frame) {
             frame.environment->image = other.image;
             frame.environment->maps = other.maps;
         }},
        {"another exponent", [](Frame& frame) { frame.materials[1].base().shininess = constant_of(41.0); }},
        {"an exponent from a plane",
         [](Frame& frame) { frame.materials[1].base().shininess = frame.materials[0].base().shininess; }},
        {"the metal's exponent constant",
         [](Frame& frame) { frame.materials[0].base().shininess = constant_of(300.0); }},
        {"another metal",
         [](Frame& frame) {
             for (ComplexIndex& sample : frame.materials[0].base().metal.samples) {
                 sample.k *= 1.3;
             }
         }},
        {"the exact normaliser", [](Frame& frame) { frame.materials[0].fresnel = FresnelModel::exact; }},
        {"a background", [](Frame& frame) { frame.environment->background = true; }},
        {"none again", [](Frame&) {}},
    };
    Shader shader(test_device(), kernel_sources(), ProgramCache::disabled(), {.aovs = {}, .lanes = 16});
    for (const auto& [what, change] : changes) {
        Frame frame = two_materials();
        change(frame);
        Frame again = two_materials();
        change(again);
        EXPECT_TRUE(same_bytes(shader.shade(frame), shade(again, 16))) << what;
    }
}

} // namespace
} // namespace clshade
