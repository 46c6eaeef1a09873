// What must hold of any environment: constant ones, turned ones, the picture behind the objects, pixels that are none.
#include "host/environment/sh.h"
#include "host/reference/sh_oren_nayar.h"
#include "tests/shading/environments.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace clshade {
namespace {

constexpr int width = 48;
constexpr int height = 32;

/// Normals at all angles to an eye along +z, seen from infinity; no lights.
Frame sphere_frame(const BoundMaterial& material) {
    Frame frame = random_frame(width, height, SpecularModel::blinn_phong, DiffuseModel::lambert, 3);
    frame.lights.clear();
    frame.roles.coverage = no_plane;
    frame.roles.position = {no_plane, no_plane, no_plane};
    frame.view = View{};
    frame.view.orthographic = true;
    frame.view.has_rays = true;
    frame.view.direction = frame.view.view_axis;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double z = (y + 0.5) / height;
            const double azimuth = 2.0 * std::numbers::pi * x / width;
            const double sine = std::sqrt(1.0 - z * z);
            const glm::dvec3 n(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
            for (int i = 0; i < 3; ++i) {
                frame.planes.at(frame.roles.normal[static_cast<std::size_t>(i)], x, y) = static_cast<float>(n[i]);
            }
        }
    }
    frame.materials = {material};
    return frame;
}

BoundMaterial plain_material(double f0, double shininess, DiffuseModel diffuse) {
    BoundMaterial material;
    material.name = "default";
    material.base().specular = SpecularModel::blinn_phong;
    material.base().f0 = constant_of(f0);
    material.base().shininess = constant_of(shininess);
    material.diffuse = diffuse;
    material.albedo = constant_of({0.8, 0.5, 0.2});
    material.diffuse_shininess = constant_of(6.0);
    return material;
}

/// N.E of the pixel's normal as the frame has it.
double cosine_at(const Frame& frame, int x, int y) {
    glm::dvec3 n(0.0);
    for (int i = 0; i < 3; ++i) {
        n[i] = static_cast<double>(frame.planes.at(frame.roles.normal[static_cast<std::size_t>(i)], x, y));
    }
    return glm::normalize(n).z;
}

TEST(EnvironmentRules, AConstantEnvironmentIsReflectedDiffuselyByAlbedoTimesD) {
    for (const AmbientSource source : all_ambient_sources) {
        Frame frame = sphere_frame(plain_material(0.0, 16.0, DiffuseModel::lambert));
        std::vector<BoundMaterial> materials = {plain_material(0.04, 16.0, DiffuseModel::lambert)};
        for (const AmbientDiffuse ambient : all_ambient_diffuses) {
            materials.push_back(plain_material(0.04, 16.0, DiffuseModel::oren_nayar));
            materials.back().ambient = ambient;
        }
        spread_materials(frame, materials);
        stand_in(frame, white_furnace(), source);
        // Sums over texel centres are as good as the square of their distance: 0.4 % of band 2 for 8 rows, and the
        // formula is what is looked at here.
        FilteredSet maps = *white_furnace().maps;
        maps.sh = sh_of(picture_of(1024, [](int, int) { return glm::dvec3(1.0); }));
        frame.environment->maps = std::make_shared<const FilteredSet>(std::move(maps));
        const ShadedImage image = shade(frame, 16, {.diffuse = true});
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const auto id = static_cast<std::size_t>(frame.planes.at(frame.roles.material_id, x, y));
                const glm::dvec3 albedo = materials[id].albedo.constant;
                const glm::dvec3 d =
                    id == 0 ? glm::dvec3(1.0)
                            : reference::sh_dc_factor(materials[id].ambient, 6.0, cosine_at(frame, x, y), albedo);
                for (int c = 0; c < 3; ++c) {
                    // Single precision: a dozen roundings.
                    ASSERT_NEAR(image.planes.at(4 + c, x, y), albedo[c] * 0.96 * d[c], 1e-6 * albedo[c])
                        << name_of(source) << ", material " << id << " at " << x << "," << y;
                }
            }
        }
    }
}

double bilinear(const std::vector<float>& table, double x, double n, int value) {
    const double row = std::min(64.0 * std::log2(n + 1.0) / 13.0, 64.0);
    const double column = 128.0 * x;
    const int i = std::min(static_cast<int>(column), 127);
    const int j = std::min(static_cast<int>(row), 63);
    const auto at = [&](int a, int b) {
        return static_cast<double>(table[(static_cast<std::size_t>(b) * 129 + static_cast<std::size_t>(a)) * 2 +
                                         static_cast<std::size_t>(value)]);
    };
    const double fx = column - i;
    const double fy = row - j;
    return (1.0 - fy) * ((1.0 - fx) * at(i, j) + fx * at(i + 1, j)) +
           fy * ((1.0 - fx) * at(i, j + 1) + fx * at(i + 1, j + 1));
}

TEST(EnvironmentRules, AMirrorInAConstantEnvironmentIsScalePlusBias) {
    const AmbientTables tables = test_prefilter().ambient_tables();
    for (const double n : {0.0, 30.0, 8191.0, 20000.0}) {
        Frame frame = sphere_frame(plain_material(1.0, n, DiffuseModel::none));
        std::vector<BoundMaterial> materials(2, frame.materials[0]);
        materials[1].base().specular = SpecularModel::blinn_phong_exact;
        spread_materials(frame, materials);
        stand_in(frame, white_furnace());
        const ShadedImage image = shade(frame, 16);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const bool exact = frame.planes.at(frame.roles.material_id, x, y) == 1.0F;
                const auto& table = exact ? tables.exact : tables.linear;
                const double cosine = cosine_at(frame, x, y);
                const double expected = bilinear(table, cosine, n, 0) + bilinear(table, cosine, n, 1);
                for (int c = 0; c < 3; ++c) {
                    // The map's sum of weights and the table's place round.
                    ASSERT_NEAR(image.planes.at(c, x, y), expected, 5e-6 * expected) << n << " at " << x << "," << y;
                }
            }
        }
    }
}

/// The planes of a vector turned by a matrix.
void turn_planes(Frame& frame, const std::array<PlaneIndex, 3>& planes, const glm::dmat3& turn) {
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            glm::dvec3 v(0.0);
            for (int i = 0; i < 3; ++i) {
                v[i] = static_cast<double>(frame.planes.at(planes[static_cast<std::size_t>(i)], x, y));
            }
            v = turn * v;
            for (int i = 0; i < 3; ++i) {
                frame.planes.at(planes[static_cast<std::size_t>(i)], x, y) = static_cast<float>(v[i]);
            }
        }
    }
}

TEST(EnvironmentRules, TurningEnvironmentAndFrameTogetherChangesNothing) {
    const glm::dmat3 turn = glm::dmat3(glm::rotate(glm::dmat4(1.0), 1.1, glm::normalize(glm::dvec3(0.4, -0.7, 0.5))));
    for (const AmbientSource source : all_ambient_sources) {
        StackShape shape;
        shape.diffuse = DiffuseModel::oren_nayar;
        shape.ambient = source == AmbientSource::sh2 ? AmbientDiffuse::order1 : AmbientDiffuse::precise;
        shape.largest_shininess = 512.0; // a rounding of N moves a sharper mirror image by more
        Frame frame = random_frame(width, height, shape, 8);
        surround(frame, source, 8);
        frame.lights.clear();
        const ShadedImage before = shade(frame, 16);
        turn_planes(frame, frame.roles.normal, turn);
        turn_planes(frame, frame.roles.position, turn);
        frame.view.eye = turn * frame.view.eye;
        frame.view.view_axis = turn * frame.view.view_axis;
        frame.environment->world_to_image = frame.environment->world_to_image * glm::transpose(turn);
        EXPECT_LE(largest_difference(before, shade(frame, 16), 0.1), 2e-5) << name_of(source);
    }
}

// Columns moved by a quarter of the picture are the environment turned by a quarter about its axis: SH, irradiance and
// every level turn with it, since the octahedral grid is the same after a quarter turn.
TEST(EnvironmentRules, MapsOfATurnedPictureAreTheTurnedMaps) {
    const LatLong straight = built_in_studio(64);
    const LatLong shifted = picture_of(64, [&](int x, int y) {
        const std::size_t from = static_cast<std::size_t>(y * 128 + (x + 128 - 32) % 128) * 3;
        return glm::dvec3(straight.rgb[from], straight.rgb[from + 1], straight.rgb[from + 2]);
    });
    const glm::dmat3 quarter(glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(-1.0, 0.0, 0.0), glm::dvec3(0.0, 0.0, 1.0));
    const FilteredStudio one = filtered(straight);
    const FilteredStudio other = filtered(shifted);
    for (const AmbientSource source : all_ambient_sources) {
        StackShape shape;
        shape.largest_shininess = 8192.0;
        Frame frame = random_frame(width, height, shape, 14);
        frame.lights.clear();
        stand_in(frame, other, source);
        const ShadedImage turned_picture = shade(frame, 16);
        stand_in(frame, one, source);
        frame.environment->world_to_image = quarter;
        EXPECT_LE(largest_difference(turned_picture, shade(frame, 16), 0.1), 2e-5) << name_of(source);
    }
}

/// Texels of a few rows that have nothing to do with each other.
LatLong noise(int rows) {
    std::uint32_t state = 12345;
    return picture_of(rows, [&state](int, int) {
        glm::dvec3 value(0.0);
        for (int c = 0; c < 3; ++c) {
            state = state * 1664525U + 1013904223U;
            value[c] = static_cast<double>(state >> 16U) / 65536.0;
        }
        return value;
    });
}

TEST(EnvironmentBackground, StandsBehindObjectsInEveryView) {
    for (const int rows : {1, 4}) { // poles and the seam fill most of so small a picture
        const FilteredStudio place = filtered(noise(rows));
        for (const bool orthographic : {false, true}) {
            StackShape shape;
            Frame frame = random_frame(width, height, shape, 19);
            surround(frame, AmbientSource::sh2, 19, place);
            frame.environment->background = true;
            frame.lights.resize(1);
            if (orthographic) {
                frame.view.orthographic = true;
                frame.view.direction = frame.view.view_axis;
                frame.view.direction_dx = frame.view.direction_dy = glm::dvec3(0.0);
            } else { // a wide view around a pole
                frame.environment->world_to_image = glm::transpose(frame.view.camera_to_world);
            }
            for (int x = 0; x < width; ++x) {
                for (int y = 0; y < height; y += 2) {
                    for (const PlaneIndex plane : frame.roles.normal) {
                        frame.planes.at(plane, x, y) = 0.0F;
                    }
                }
                frame.planes.at(frame.roles.coverage, x, 7) = 0.0F;
                frame.planes.at(frame.roles.coverage, x, 9) = 0.25F;
                frame.planes.at(0, x, 11) = std::numeric_limits<float>::quiet_NaN();
            }
            const std::string what = orthographic ? "orthographic" : "perspective";
            const ShadedImage image = shade(frame, 16, all_aovs);
            expect_as_expected(image, expected_of(frame, all_aovs), frame, what);
            for (int x = 0; x < width; ++x) {
                EXPECT_EQ(image.planes.at(3, x, 4), 1.0F);
                EXPECT_EQ(image.planes.at(3, x, 7), 1.0F);
                EXPECT_EQ(image.planes.at(3, x, 9), 1.0F);
                for (int plane = 0; plane < image.planes.count(); ++plane) {
                    EXPECT_EQ(image.planes.at(plane, x, 11), 0.0F) << what; // rule 1
                    EXPECT_TRUE(plane < 4 || image.planes.at(plane, x, 4) == 0.0F) << what << ": AOVs have none";
                }
            }
            EXPECT_TRUE(same_bytes(image, shade(frame, 16, all_aovs, 1024))) << what << ", bands";
        }
    }
}

TEST(EnvironmentPixels, ThatAreDeadMayHoldAnything) {
    constexpr std::array<float, 8> wild = {std::numeric_limits<float>::quiet_NaN(),
                                           std::numeric_limits<float>::infinity(),
                                           -std::numeric_limits<float>::infinity(),
                                           1e38F,
                                           -1e38F,
                                           1e-40F,
                                           -5.0F,
                                           0.0F};
    StackShape shape;
    shape.layers = {SpecularModel::blinn_phong, SpecularModel::blinn_phong_anisotropic,
                    SpecularModel::blinn_phong_exact};
    shape.diffuse = DiffuseModel::oren_nayar;
    shape.absorption = AbsorptionModel::original;
    shape.absorption_ibl = AmbientAbsorption::exponential;
    shape.ambient = AmbientDiffuse::order1;
    Frame frame = random_frame(width, height, shape, 6);
    surround(frame, AmbientSource::irradiance_map, 6);
    for (const int lanes : {1, 4, 8, 16}) {
        Frame clean = random_frame(width, height, shape, 6);
        clean.environment = frame.environment;
        const ShadedImage before = shade(clean, lanes, all_aovs);
        // Every third pixel is dead: by a normal or a coverage of zero and all else wild, or by one wild plane.
        const auto dead = [](int x, int y) { return (x + y) % 3 == 0; };
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (!dead(x, y)) {
                    continue;
                }
                const int kind = (x + 5 * y) % 4;
                for (int p = 0; p < frame.planes.count(); ++p) {
                    const bool of_normal =
                        p == frame.roles.normal[0] || p == frame.roles.normal[1] || p == frame.roles.normal[2];
                    const bool zero = (kind == 0 && of_normal) || (kind != 0 && p == frame.roles.coverage);
                    const auto pick = static_cast<std::size_t>(x * 7 + y * 3 + (kind == 2 ? 0 : p)) % wild.size();
                    frame.planes.at(p, x, y) = zero ? 0.0F : wild[pick];
                }
            }
        }
        const ShadedImage image = shade(frame, lanes, all_aovs);
        for (int plane = 0; plane < image.planes.count(); ++plane) {
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) {
                    const float expected = dead(x, y) ? 0.0F : before.planes.at(plane, x, y);
                    ASSERT_EQ(image.planes.at(plane, x, y), expected)
                        << lanes << " lanes, " << image.plane_names[static_cast<std::size_t>(plane)] << " at " << x
                        << "," << y;
                }
            }
        }
    }
}

} // namespace
} // namespace clshade
