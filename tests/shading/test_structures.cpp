// Frames of every structure: views, spaces, planes, parameters, materials by id, input that is not finite.
#include "host/shading/frame_layout.h"
#include "tests/shading/agreement.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace clshade {
namespace {

constexpr int width = 101;
constexpr int height = 37;

/// The frame with `count` more planes, all zero; the first of them is returned in `first`.
Frame with_planes(Frame frame, int count, PlaneIndex& first) {
    PlaneSlab planes(frame.planes.width(), frame.planes.height(), frame.planes.count() + count);
    for (int p = 0; p < frame.planes.count(); ++p) {
        for (int y = 0; y < height; ++y) {
            std::copy(frame.planes.row(p, y).begin(), frame.planes.row(p, y).end(), planes.row(p, y).begin());
        }
    }
    first = frame.planes.count();
    for (int i = 0; i < count; ++i) {
        frame.plane_names.push_back("extra" + std::to_string(i));
    }
    frame.planes = std::move(planes);
    return frame;
}

Frame base_frame(std::uint64_t seed = 21) {
    return random_frame(width, height, SpecularModel::blinn_phong, DiffuseModel::lambert, seed);
}

void for_each_pixel(const std::function<void(int, int)>& visit) {
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            visit(x, y);
        }
    }
}

/// Depth along the axis (or along the ray) of the position plane, written into plane `depth`.
void fill_depth(Frame& frame, PlaneIndex depth, bool along_ray) {
    for_each_pixel([&](int x, int y) {
        const glm::dvec3 p(frame.planes.at(frame.roles.position[0], x, y),
                           frame.planes.at(frame.roles.position[1], x, y),
                           frame.planes.at(frame.roles.position[2], x, y));
        const glm::dvec3 from_eye = p - frame.view.eye;
        frame.planes.at(depth, x, y) =
            static_cast<float>(along_ray ? glm::length(from_eye) : glm::dot(from_eye, frame.view.view_axis));
    });
}

void expect_device_agrees(Frame& frame, const std::string& what) {
    const reference::Image expected = reference::shade(frame, {}, 2);
    for (const int lanes : {1, 16}) {
        expect_agreement(shade(frame, lanes), expected, frame, what + ", " + std::to_string(lanes) + " lanes");
    }
}

TEST(Structures, DepthAlongTheAxisReplacesPosition) {
    PlaneIndex depth = no_plane;
    Frame frame = with_planes(base_frame(), 1, depth);
    fill_depth(frame, depth, false);
    frame.roles.depth = depth;
    frame.roles.position = {no_plane, no_plane, no_plane};
    expect_device_agrees(frame, "planar depth");
}

TEST(Structures, DepthAlongTheRayReplacesPosition) {
    PlaneIndex depth = no_plane;
    Frame frame = with_planes(base_frame(), 1, depth);
    fill_depth(frame, depth, true);
    frame.roles.depth = depth;
    frame.depth_kind = DepthKind::ray;
    frame.roles.position = {no_plane, no_plane, no_plane};
    expect_device_agrees(frame, "ray depth");
}

TEST(Structures, SentinelDepthWithCoverageTakesTheEyeFromThePixel) {
    PlaneIndex depth = no_plane;
    Frame frame = with_planes(base_frame(), 1, depth);
    fill_depth(frame, depth, false);
    frame.roles.depth = depth;
    for_each_pixel([&](int x, int y) {
        if ((x + y) % 3 == 0) {
            frame.planes.at(depth, x, y) = x % 2 == 0 ? 1e10F : std::numeric_limits<float>::infinity();
            for (const PlaneIndex plane : frame.roles.position) {
                frame.planes.at(plane, x, y) = 0.0F;
            }
        }
    });
    const reference::Image expected = reference::shade(frame, {}, 2);
    EXPECT_EQ(expected.counts.nonfinite, 0U);
    expect_device_agrees(frame, "sentinel depth");
}

TEST(Structures, SentinelDepthWithoutCoverageIsBackground) {
    PlaneIndex depth = no_plane;
    Frame frame = with_planes(base_frame(), 1, depth);
    fill_depth(frame, depth, false);
    frame.roles.depth = depth;
    frame.roles.coverage = no_plane;
    for (int x = 0; x < width; ++x) {
        frame.planes.at(depth, x, 5) = 1e10F;
    }
    expect_device_agrees(frame, "background depth");
    const ShadedImage image = shade(frame, 16);
    for (int x = 0; x < width; ++x) {
        EXPECT_EQ(image.planes.at(3, x, 5), 0.0F);
    }
}

TEST(Structures, OrthographicView) {
    Frame frame = base_frame();
    frame.view.orthographic = true;
    const glm::dvec3 right = frame.view.camera_to_world[0];
    const glm::dvec3 up = frame.view.camera_to_world[1];
    frame.view.origin = frame.view.eye - right + up;
    frame.view.origin_dx = 2.0 / width * right;
    frame.view.origin_dy = -2.0 / height * up;
    frame.view.direction = frame.view.view_axis;
    frame.view.direction_dx = frame.view.direction_dy = glm::dvec3(0.0);
    expect_device_agrees(frame, "orthographic, position");

    PlaneIndex depth = no_plane;
    frame = with_planes(std::move(frame), 1, depth);
    fill_depth(frame, depth, false);
    frame.roles.depth = depth;
    frame.roles.position = {no_plane, no_plane, no_plane};
    expect_device_agrees(frame, "orthographic, depth");
}

TEST(Structures, EyeWithoutRays) {
    Frame frame = base_frame();
    frame.view.has_rays = false;
    expect_device_agrees(frame, "eye only");
}

TEST(Structures, CameraSpaceNormals) {
    Frame frame = base_frame();
    const glm::dmat3 to_camera = glm::transpose(frame.view.camera_to_world);
    for_each_pixel([&](int x, int y) {
        const glm::dvec3 n(frame.planes.at(frame.roles.normal[0], x, y), frame.planes.at(frame.roles.normal[1], x, y),
                           frame.planes.at(frame.roles.normal[2], x, y));
        const glm::dvec3 turned = to_camera * n;
        for (int i = 0; i < 3; ++i) {
            frame.planes.at(frame.roles.normal[static_cast<std::size_t>(i)], x, y) = static_cast<float>(turned[i]);
        }
    });
    frame.normal_space = NormalSpace::camera;
    expect_device_agrees(frame, "camera-space normals");
}

TEST(Structures, UnormNormalsArePremultiplied) {
    Frame frame = base_frame();
    for_each_pixel([&](int x, int y) {
        const float coverage = frame.planes.at(frame.roles.coverage, x, y);
        for (const PlaneIndex plane : frame.roles.normal) {
            float& value = frame.planes.at(plane, x, y);
            value = coverage > 0.0F ? (value / coverage * 0.5F + 0.5F) * coverage : 0.0F;
        }
    });
    frame.normal_encoding = NormalEncoding::unorm;
    expect_device_agrees(frame, "unorm normals");
}

TEST(Structures, ConstantsGreyPlanesConversionsAndEmission) {
    PlaneIndex extra = no_plane;
    Frame frame = with_planes(base_frame(), 4, extra);
    for_each_pixel([&](int x, int y) {
        const float coverage = frame.planes.at(frame.roles.coverage, x, y);
        const float t = static_cast<float>(x) / (width - 1);
        frame.planes.at(extra, x, y) = t * coverage;                                        // roughness 0..1
        frame.planes.at(extra + 1, x, y) = (1.0F - t) * coverage;                           // smoothness
        frame.planes.at(extra + 2, x, y) = static_cast<float>(y) / (height - 1) * coverage; // grey, sigma
        frame.planes.at(extra + 3, x, y) = (t - 0.2F) * 3.0F * coverage;                    // emission, partly negative
    });
    const auto plane = [](PlaneIndex index, Conversion convert, double scale, double offset) {
        BoundParameter parameter;
        parameter.planes = {index, index, index};
        parameter.convert = convert;
        parameter.scale = scale;
        parameter.offset = offset;
        return parameter;
    };
    BoundMaterial& material = frame.materials[0];
    material.diffuse = DiffuseModel::oren_nayar;
    material.base().f0 = BoundParameter{};
    material.base().f0.constant = {0.9, 0.6, 0.3};
    material.albedo = plane(extra + 2, Conversion::none, 0.5, 0.25);
    frame.emission = plane(extra + 3, Conversion::none, 1.0, 0.0);
    frame.has_emission = true;
    material.base().shininess = plane(extra, Conversion::ggx_roughness, 1.0, 0.0);
    material.diffuse_shininess = plane(extra + 2, Conversion::oren_nayar_sigma, 1.0, 0.0);
    expect_device_agrees(frame, "roughness and sigma");
    material.base().shininess = plane(extra + 1, Conversion::smoothness, 0.9, 0.05);
    material.diffuse_shininess = plane(extra + 2, Conversion::none, 40.0, 0.0);
    expect_device_agrees(frame, "smoothness, scaled");
    material.albedo = plane(extra + 2, Conversion::none, 3.0, -1.0);
    expect_device_agrees(frame, "albedo out of range");
    EXPECT_GT(shade(frame, 16).counts.clamped, 0U);
}

TEST(Structures, MaterialsById) {
    PlaneIndex id = no_plane;
    Frame frame = with_planes(base_frame(), 1, id);
    frame.roles.material_id = id;
    for_each_pixel([&](int x, int y) { frame.planes.at(id, x, y) = static_cast<float>((x / 3 + y / 5) % 6); });
    const BoundMaterial first = frame.materials[0];
    const auto add = [&](std::string name, std::vector<std::int64_t> ids, SpecularModel specular,
                         DiffuseModel diffuse) {
        BoundMaterial material = first;
        material.name = std::move(name);
        material.ids = std::move(ids);
        material.base().specular = specular;
        material.diffuse = diffuse;
        material.diffuse_shininess = BoundParameter{};
        material.diffuse_shininess.constant = glm::dvec3(6.0);
        frame.materials.push_back(material);
    };
    add("matte \"*/ \\", {1, 4}, SpecularModel::none, DiffuseModel::oren_nayar_full);
    add("exact", {2}, SpecularModel::blinn_phong_exact, DiffuseModel::oren_nayar_qualitative);
    add("mirror", {3}, SpecularModel::blinn_phong, DiffuseModel::none);
    BoundMaterial coated = frame.materials[2];
    coated.name = "coated";
    coated.ids = {5};
    coated.layers.insert(coated.layers.begin(), BoundLayer{});
    coated.layers[0].specular = SpecularModel::blinn_phong;
    coated.layers[0].f0.constant = glm::dvec3(0.04);
    coated.layers[0].shininess.constant = glm::dvec3(300.0);
    coated.layers[0].absorption.constant = {0.1, 0.02, 0.0};
    coated.absorption = AbsorptionModel::original;
    frame.materials.push_back(coated);
    expect_device_agrees(frame, "five materials");

    const AovSelection aovs = {.diffuse = true, .specular = true, .lights = true};
    expect_agreement(shade(frame, 8, aovs), reference::shade(frame, aovs, 2), frame, "five materials with AOVs");

    // Filtered ids; those of a box filter are halves, which go to the even id.
    for_each_pixel([&](int x, int y) {
        if (y % 2 == 1) {
            frame.planes.at(id, x, y) = 0.5F * static_cast<float>((x / 3) % 12) + (x % 3 == 0 ? 0.1F : 0.0F);
        }
    });
    EXPECT_GT(shade(frame, 16).counts.fractional_ids, 10U);
    expect_device_agrees(frame, "filtered ids");
}

TEST(Structures, MaterialsByCryptomatteNameInOrder) {
    PlaneIndex name = no_plane;
    Frame frame = with_planes(base_frame(), 2, name);
    const PlaneIndex id = name + 1;
    frame.roles.material_id = id;
    const std::array<std::uint32_t, 4> hashes = {0xf0666addU, 0x17ab1474U, 0x648c7d28U, 0x80000001U};
    for_each_pixel([&](int x, int y) {
        frame.planes.at(name, x, y) = std::bit_cast<float>(hashes[static_cast<std::size_t>(x / 4 + y) % hashes.size()]);
        frame.planes.at(id, x, y) = static_cast<float>(y % 3);
    });
    const BoundMaterial first = frame.materials[0];
    for (std::size_t k = 0; k < hashes.size(); ++k) {
        BoundMaterial material = first;
        material.name = "m" + std::to_string(k);
        material.base().f0 = BoundParameter{};
        material.base().f0.constant = glm::dvec3(0.1 + 0.2 * static_cast<double>(k));
        material.cryptomatte = {{material.name, name, hashes[k]}};
        if (k == 1) {
            material.ids = {2}; // claims pixels that the third and fourth name, too: the first in the list has them
        }
        frame.materials.push_back(material);
    }
    const reference::Image expected = reference::shade(frame, {}, 2);
    EXPECT_EQ(expected.material[0], 1);
    EXPECT_EQ(expected.material[2 * width + 4], 2);
    expect_device_agrees(frame, "by name and id");
}

TEST(Structures, EveryPlaneIsWatchedForNanAndInf) {
    Frame frame = base_frame();
    const reference::Image clean = reference::shade(frame, {}, 2);
    int x = 3;
    std::uint64_t expected = clean.counts.nonfinite;
    for (int p = 0; p < frame.planes.count(); ++p, x += 2) {
        frame.planes.at(p, x, 9) = std::numeric_limits<float>::quiet_NaN();
        frame.planes.at(p, x, 11) = std::numeric_limits<float>::infinity();
        frame.planes.at(p, x, 13) = -std::numeric_limits<float>::infinity();
    }
    for (const int lanes : {1, 4, 8, 16}) {
        const ShadedImage image = shade(frame, lanes);
        const reference::Image reference = reference::shade(frame, {}, 2);
        expect_agreement(image, reference, frame, "non-finite input");
        const auto read = planes_read(frame).size();
        EXPECT_EQ(image.counts.nonfinite, expected + 3 * read) << lanes << " lanes";
        for (int y = 9; y <= 13; y += 2) {
            for (int i = 3; i < x; i += 2) {
                for (int channel = 0; channel < 4; ++channel) {
                    EXPECT_EQ(image.planes.at(channel, i, y), 0.0F);
                }
            }
        }
    }
}

TEST(Structures, ResultsBeyondAFloatAreZeroAndCounted) {
    Frame frame = base_frame();
    const AovSelection aovs = {.diffuse = true, .specular = true, .lights = true};
    for (Light& light : frame.lights) {
        light.power = glm::dvec3(1e38);
    }
    const reference::Image expected = reference::shade(frame, aovs, 2);
    const ShadedImage image = shade(frame, 16, aovs);
    EXPECT_GT(expected.counts.nonfinite, 10U);
    EXPECT_GE(image.counts.nonfinite, expected.counts.nonfinite); // intermediate values of the device overflow earlier
    for_each_pixel([&](int x, int y) {
        bool black = true;
        for (int p = 0; p < image.planes.count(); ++p) {
            EXPECT_TRUE(std::isfinite(image.planes.at(p, x, y)));
            black = black && image.planes.at(p, x, y) == 0.0F;
        }
        EXPECT_TRUE(black || image.planes.at(3, x, y) > 0.0F) << "alpha tells a pixel that was set to 0";
    });
}

TEST(Structures, NoLightIsBlackWithAlpha) {
    Frame frame = base_frame();
    frame.lights.clear();
    expect_device_agrees(frame, "no light");
    EXPECT_NE(kernel_key(frame).find("unlit"), std::string::npos);
}

TEST(Structures, AbsurdNormalsCountAsNonFinite) {
    Frame frame = base_frame();
    frame.planes.at(frame.roles.normal[0], 4, 4) = 3e30F;
    expect_device_agrees(frame, "a normal of 3e30");
}

} // namespace
} // namespace clshade
