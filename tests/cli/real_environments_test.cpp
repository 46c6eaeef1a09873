// Environments of others, end to end: seen as OpenEXR and Blender see them.
#include "tests/cli/gbuffers.h"
#include "tests/cli/run_program.h"

#include <ImfRgbaFile.h>
#include <glm/glm.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace clshade::tests {
namespace {

/// Of a test picture's plane.
constexpr std::size_t pixel_index(int x, int y) {
    return static_cast<std::size_t>(y) * test_width + static_cast<std::size_t>(x);
}

std::filesystem::path shared(const std::string& name) {
    return std::filesystem::path(CLSHADE_SHARED_DATA) / name;
}

/// A lat-long picture as OpenEXR itself reads it.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Imf::Rgba> texels;

    [[nodiscard]] const Imf::Rgba& at(int x, int y) const {
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

Picture read_with_openexr(const std::filesystem::path& file) {
    Imf::RgbaInputFile input(file.c_str());
    const Imath::Box2i window = input.dataWindow();
    Picture picture{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}};
    picture.texels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    input.setFrameBuffer(picture.texels.data(), 1, static_cast<std::size_t>(picture.width));
    input.readPixels(window.min.y, window.max.y);
    return picture;
}

/// OpenEXR's own place of a texel on the sphere (ImfEnvmap.h): +Y up, +Z in the middle, +X a quarter to the left.
glm::dvec3 openexr_direction(const Picture& picture, double x, double y) {
    const double azimuth = std::numbers::pi * (1.0 - 2.0 * x / picture.width);
    const double polar = std::numbers::pi * y / picture.height;
    return {std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
}

/// The picture as the sharpest level shows it along d: exponent 8192 of models.md section 6.
glm::dvec3 blurred(const Picture& picture, const glm::dvec3& d) {
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const glm::dvec3 w = openexr_direction(picture, x + 0.5, y + 0.5);
            const double c = glm::dot(w, d);
            if (c > 0.98) {
                const double weight =
                    std::pow(0.5 * (1.0 + c), 4096.0) * std::sin(std::numbers::pi * (y + 0.5) / picture.height);
                const Imf::Rgba& texel = picture.at(x, y);
                sum += weight * glm::dvec3(texel.r, texel.g, texel.b);
                weights += weight;
            }
        }
    }
    return sum / weights;
}

// Every pixel is a mirror that shows one direction, the directions going over the sphere as the picture does: what
// comes out is the picture, letters and all.
TEST(RealEnvironments, OrientationLatLongInAMirror) {
    const std::filesystem::path file = shared("conformance/tiled/OrientationLatLong_mip.exr");
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << "the conformance files are not part of the repository";
    }
    const Picture picture = read_with_openexr(file);
    const glm::dvec3 eye(0.0, 0.0, 5.0);
    const auto direction = [&](int x, int y) {
        return openexr_direction(picture, (x + 0.5) * picture.width / test_width,
                                 (y + 0.5) * picture.height / test_height);
    };
    std::vector<TestPlane> planes;
    const std::array<const char*, 3> axes{"X", "Y", "Z"};
    for (std::size_t c = 0; c < axes.size(); ++c) {
        const int axis = static_cast<int>(c);
        // All at the origin but for a trifle, since (0, 0, 0) stands for no position.
        planes.push_back(
            {std::string("Position.") + axes.at(c), [axis](int, int) { return axis == 2 ? 1e-6F : 0.0F; }});
        planes.push_back({std::string("Normal.") + axes.at(c), [&, axis](int x, int y) {
                              return static_cast<float>(glm::normalize(direction(x, y) + glm::normalize(eye))[axis]);
                          }});
    }
    const TemporaryFolder folder;
    write_gbuffer(folder / "in.exr", planes);
    write_bytes(
        folder / "scene.toml",
        "version = 1\n[environment]\nimage = \"" + file.string() +
            "\"\n[material.default]\nspecular = { f0 = 1.0, shininess = 65536 }\ndiffuse = { model = \"none\" }\n");
    RunSettings settings;
    settings.folder = folder.path();
    const Outcome run =
        run_clshade({"shade", "in.exr", "-o", "out.exr", "-d", "float", "--scene", "scene.toml"}, settings);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Decoded image = decode(folder / "out.exr");
    int compared = 0;
    double range = 0.0;
    for (int y = 0; y < test_height; y += 4) {
        for (int x = 0; x < test_width; x += 2) {
            const glm::dvec3 d = direction(x, y);
            if (d.z < -0.8) {
                continue; // nearly behind the mirror: grazing, where the lobe is not narrow
            }
            const auto i = pixel_index(x, y);
            // Of F0 = 1 a narrow lobe of this model reflects N.E: solid angles of L are 4 E.H times those of H, and
            // the normaliser has only 4 (models.md section 1).
            const double ne = std::sqrt(0.5 * (1.0 + d.z));
            const glm::dvec3 expected = ne * blurred(picture, d);
            const glm::dvec3 seen(image.plane("R")[i], image.plane("G")[i], image.plane("B")[i]);
            // The level is bilinear on a grid of 384 cells: on the edge of a letter a percent of the contrast, which is
            // 1; and the linear normaliser is 0.2 % from the exact one.
            EXPECT_LT(glm::length(seen - expected), 0.03)
                << x << " " << y << ": " << seen.r << " " << seen.g << " " << seen.b << ", expected " << expected.r
                << " " << expected.g << " " << expected.b;
            range = std::max(range, glm::length(expected));
            ++compared;
        }
    }
    EXPECT_GT(compared, 150);
    EXPECT_GT(range, 0.5);
}

TEST(RealEnvironments, BlenderSawTheSameBackground) {
    const std::filesystem::path room = shared("blender/room_360p_float_zips_1spp.exr");
    if (!std::filesystem::exists(room)) {
        GTEST_SKIP() << "the renders are not part of the repository";
    }
    nlohmann::json about;
    about = nlohmann::json::parse(bytes_of(shared("blender/room_360p_float_zips_1spp.json")));
    const TemporaryFolder folder;
    write_bytes(
        folder / "scene.toml",
        "version = 1\n[environment]\nimage = \"" + shared("hdri/aerodynamics_workshop_1k.hdr").string() +
            "\"\nup = \"z\"\nintensity = " + about["environment"]["strength"].dump() +
            "\n[output]\nbackground = true\n[camera]\nmatrix_world = " + about["camera"]["matrix_world"].dump() +
            "\nfov_y_degrees = " + about["camera"]["fov_y_deg"].dump() + "\n");
    RunSettings settings;
    settings.folder = folder.path();
    const Outcome run =
        run_clshade({"shade", room.string(), "-o", "out.exr", "-d", "float", "--scene", "scene.toml"}, settings);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Decoded image = decode(folder / "out.exr");
    const Decoded render = decode(room);
    std::vector<double> errors;
    for (std::size_t i = 0; i < image.plane("R").size(); ++i) {
        if (render.plane("ViewLayer.Depth.Z")[i] < 6e4F) {
            continue;
        }
        for (const char* channel : {"R", "G", "B"}) {
            const auto seen = static_cast<double>(render.plane(std::string("ViewLayer.Combined.") + channel)[i]);
            errors.push_back(std::abs(static_cast<double>(image.plane(channel)[i]) - seen) / seen);
        }
    }
    ASSERT_GT(errors.size(), 5000U);
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 1e-4);
    EXPECT_LT(errors[errors.size() * 99 / 100], 1e-3);
}

} // namespace
} // namespace clshade::tests
