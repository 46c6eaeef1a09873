// One-pixel frames made by hand, for the pixel rules.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/reference.h"

#include <gtest/gtest.h>

#include <string>

namespace clshade::reference {

/// N = (0, 0, 1) under one distant light of irradiance 2 from straight above, seen orthographically from above;
/// white Lambert of albedo 0.5 and nothing else, all constant. Radiance 1/pi.
class TinyFrame {
  public:
    TinyFrame() {
        frame.file = "tiny";
        frame.planes = PlaneSlab(1, 1, 32);
        frame.roles.normal = planes({0.0F, 0.0F, 1.0F});
        frame.view.orthographic = true;
        Light sun;
        sun.name = "sun";
        sun.power = glm::dvec3(2.0);
        frame.lights = {sun};
        BoundMaterial material;
        material.name = "default";
        material.diffuse = DiffuseModel::lambert;
        material.albedo.constant = glm::dvec3(0.5);
        frame.materials = {material};
    }

    PlaneIndex plane(float value) {
        frame.planes.at(used_, 0, 0) = value;
        return used_++;
    }
    std::array<PlaneIndex, 3> planes(const glm::vec3& v) { return {plane(v.x), plane(v.y), plane(v.z)}; }
    BoundParameter grey(float value) {
        const PlaneIndex p = plane(value);
        BoundParameter parameter;
        parameter.planes = {p, p, p};
        return parameter;
    }
    BoundParameter colour(const glm::vec3& v) {
        BoundParameter parameter;
        parameter.planes = planes(v);
        return parameter;
    }
    void set(PlaneIndex p, float value) { frame.planes.at(p, 0, 0) = value; }
    BoundMaterial& material() { return frame.materials.front(); }

    /// A perspective camera at (1, 2, 8) that looks down, whose ray through the pixel is (0.5, 0, -1).
    void look_through_a_lens(bool rays) {
        frame.view.orthographic = false;
        frame.view.eye = {1.0, 2.0, 8.0};
        frame.view.has_rays = rays;
        if (rays) {
            frame.view.origin = frame.view.eye;
            frame.view.direction = {0.25, 0.5, -1.0};
            frame.view.direction_dx = {0.5, 0.0, 0.0};
            frame.view.direction_dy = {0.0, -1.0, 0.0};
        }
    }
    void add_bulb(const glm::dvec3& position, double power) {
        Light bulb;
        bulb.name = "bulb";
        bulb.type = LightType::point;
        bulb.position = position;
        bulb.power = glm::dvec3(power);
        frame.lights.push_back(bulb);
    }

    [[nodiscard]] Pixel shade(const AovSelection& aovs = {}) const { return shade_pixel(frame, 0, 0, aovs); }
    [[nodiscard]] double red() const { return shade().radiance.x; }
    /// A value of describe_pixel; fails the test if there is none of that name.
    [[nodiscard]] double described(const std::string& name) const {
        for (const auto& [key, value] : describe_pixel(frame, 0, 0)) {
            if (key == name) {
                return value;
            }
        }
        ADD_FAILURE() << "no " << name;
        return 0.0;
    }
    [[nodiscard]] glm::dvec3 described_vector(const std::string& name) const {
        return {described(name + ".X"), described(name + ".Y"), described(name + ".Z")};
    }

    Frame frame;

  private:
    PlaneIndex used_ = 0;
};

inline void expect_near(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-14) {
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(actual[i], expected[i], tolerance) << "component " << i;
    }
}

} // namespace clshade::reference
