// The demo's planes obey what G-buffers promise: geometry agrees with the camera, edges are premultiplied.
#include "host/demo/demo_gbuffer.h"
#include "host/gbuffer/camera.h"
#include "host/scene/scene_file.h"

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace clshade {
namespace {

constexpr int width = 256;
constexpr int height = 144;

/// One frame, rendered once for all tests of this file.
class DemoGBuffer : public testing::Test {
  protected:
    static const DemoFrame& frame() {
        static const DemoFrame rendered = render_demo_frame(width, height, 1, 3, 2);
        return rendered;
    }
    static int plane(const std::string& name) {
        const auto& names = frame().plane_names;
        const auto found = std::find(names.begin(), names.end(), name);
        EXPECT_NE(found, names.end()) << name;
        return static_cast<int>(found - names.begin());
    }
    static float at(const std::string& name, int x, int y) { return frame().planes.at(plane(name), x, y); }
    static glm::dvec3 at3(const std::string& layer, const char* suffixes, int x, int y) {
        const auto component = [&](int i) { return at(layer + "." + suffixes[i], x, y); };
        return {component(0), component(1), component(2)};
    }
};

TEST_F(DemoGBuffer, NamesEveryPlaneOnce) {
    EXPECT_EQ(static_cast<std::size_t>(frame().planes.count()), frame().plane_names.size());
    const std::set<std::string> names(frame().plane_names.begin(), frame().plane_names.end());
    EXPECT_EQ(names.size(), frame().plane_names.size());
    EXPECT_EQ(frame().planes.width(), width);
    EXPECT_EQ(frame().planes.height(), height);
}

TEST_F(DemoGBuffer, PositionDepthAndCameraAgree) {
    const Window window{0, 0, width - 1, height - 1};
    const View view = view_from_camera(frame().camera, window, window, 1.0);
    int checked = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto depth = static_cast<double>(at("Depth.Z", x, y));
            if (depth > 6e4) {
                continue;
            }
            const glm::dvec3 direction = view.direction + (x + 0.5) * view.direction_dx + (y + 0.5) * view.direction_dy;
            const glm::dvec3 expected = view.eye + depth * direction;
            // Single precision at distances of about 17: a few units of 2e-6.
            ASSERT_LT(glm::length(at3("Position", "XYZ", x, y) - expected), 2e-5) << x << ' ' << y;
            ++checked;
        }
    }
    EXPECT_GT(checked, width * height / 3);
}

TEST_F(DemoGBuffer, NormalsFitThePositions) {
    int checked = 0;
    int agreeing = 0;
    for (int y = 1; y + 1 < height; ++y) {
        for (int x = 1; x + 1 < width; ++x) {
            const float id = at("MaterialID.V", x, y);
            const bool inside = id > 0.0F && at("UV.A", x, y) == 1.0F && at("MaterialID.V", x + 1, y) == id &&
                                at("MaterialID.V", x - 1, y) == id && at("MaterialID.V", x, y + 1) == id &&
                                at("MaterialID.V", x, y - 1) == id;
            if (!inside) {
                continue;
            }
            const glm::dvec3 right = at3("Position", "XYZ", x + 1, y) - at3("Position", "XYZ", x - 1, y);
            const glm::dvec3 down = at3("Position", "XYZ", x, y + 1) - at3("Position", "XYZ", x, y - 1);
            const glm::dvec3 across = glm::normalize(glm::cross(down, right)); // towards the camera
            const glm::dvec3 normal = glm::normalize(at3("Normal", "XYZ", x, y));
            ++checked;
            agreeing += glm::dot(across, normal) > 0.98 ? 1 : 0;
        }
    }
    EXPECT_GT(checked, width * height / 4);
    // Two neighbouring objects of one material and the rounded edges make differences that say nothing of the normal.
    EXPECT_GT(agreeing, checked * 9 / 10);
}

TEST_F(DemoGBuffer, BackgroundIsEmpty) {
    int empty = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (at("UV.A", x, y) > 0.0F) {
                continue;
            }
            ++empty;
            for (int p = 0; p < frame().planes.count(); ++p) {
                const bool is_depth = p == plane("Depth.Z");
                ASSERT_EQ(frame().planes.at(p, x, y), is_depth ? 1e10F : 0.0F) << frame().plane_names[std::size_t(p)];
            }
        }
    }
    EXPECT_GT(empty, width * height / 10);
}

TEST_F(DemoGBuffer, EdgesArePremultiplied) {
    int edges = 0;
    int centre_misses = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto c = static_cast<double>(at("UV.A", x, y));
            ASSERT_TRUE(c >= 0.0 && c <= 1.0);
            // A mean of unit normals is at most as long as the coverage; 1e-5 for sixteen roundings.
            ASSERT_LE(glm::length(at3("Normal", "XYZ", x, y)), c + 1e-5);
            ASSERT_LE(at("Albedo.R", x, y), c + 1e-5);
            ASSERT_LE(at("F0.R", x, y), c + 1e-5);
            ASSERT_LE(at("Roughness.V", x, y), c + 1e-5);
            if (c > 0.0 && c < 1.0) {
                ++edges;
                const bool miss = at("Depth.Z", x, y) == 1e10F;
                centre_misses += miss ? 1 : 0;
                ASSERT_EQ(at("MaterialID.V", x, y) == 0.0F, miss) << "ids are one sample, never a mean";
            }
        }
    }
    EXPECT_GT(edges, 100);
    EXPECT_GT(centre_misses, 20);
}

TEST_F(DemoGBuffer, IdsAreWholeAndAllMaterialsAreSeen) {
    std::set<float> ids;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            ids.insert(at("MaterialID.V", x, y));
        }
    }
    EXPECT_EQ(ids, (std::set<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST_F(DemoGBuffer, ParametersVary) {
    float low = 1.0F;
    float high = 0.0F;
    std::set<float> f0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (at("UV.A", x, y) == 1.0F) {
                low = std::min(low, at("Roughness.V", x, y));
                high = std::max(high, at("Roughness.V", x, y));
                f0.insert(at("F0.R", x, y));
            }
        }
    }
    EXPECT_LT(low, 0.2F);
    EXPECT_GT(high, 0.7F);
    EXPECT_GT(f0.size(), 100U);
    EXPECT_GT(*f0.rbegin(), 0.8F);
}

TEST(Demo, BytesDoNotDependOnThreads) {
    const DemoFrame one = render_demo_frame(80, 45, 2, 3, 1);
    const DemoFrame four = render_demo_frame(80, 45, 2, 3, 4);
    EXPECT_TRUE(std::equal(one.planes.all().begin(), one.planes.all().end(), four.planes.all().begin(),
                           four.planes.all().end()));
}

TEST(Demo, TheCameraMovesAlongAnArc) {
    const auto eye = [](int index, int count) {
        return glm::dvec3(render_demo_frame(16, 9, index, count, 1).camera.matrix_world[3]);
    };
    const glm::dvec3 first = eye(1, 3);
    const glm::dvec3 middle = eye(2, 3);
    const glm::dvec3 last = eye(3, 3);
    EXPECT_LT(first.x, -1.0);
    EXPECT_NEAR(last.x, -first.x, 1e-12);
    EXPECT_NEAR(middle.x, 0.0, 1e-12);
    EXPECT_NEAR(first.z, middle.z, 1e-12);
    EXPECT_EQ(eye(1, 1), middle) << "a single frame is taken from the middle";
}

TEST(Demo, TheSceneFileFitsThePlanes) {
    const Scene scene = parse_scene(demo_scene_toml(), "demo.toml", {}, {});
    EXPECT_FALSE(scene.camera.has_value()) << "the camera is in the headers";
    EXPECT_FALSE(scene.automatic_material);
    std::set<LightType> types;
    for (const Light& light : scene.lights) {
        types.insert(light.type);
    }
    EXPECT_EQ(types.size(), 3U);
    std::set<SpecularModel> specular;
    std::set<DiffuseModel> diffuse;
    for (const Material& material : scene.materials) {
        specular.insert(material.base().model);
        diffuse.insert(material.diffuse.model);
        for (const auto id : material.ids) {
            EXPECT_TRUE(id >= 1 && id <= 10) << id;
        }
    }
    EXPECT_EQ(specular.size(), 3U);
    EXPECT_EQ(diffuse, (std::set<DiffuseModel>{DiffuseModel::lambert, DiffuseModel::oren_nayar}));
}

} // namespace
} // namespace clshade
