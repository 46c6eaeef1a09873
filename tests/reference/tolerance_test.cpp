// Default tolerances: single precision reaches them, and they are tight enough to catch wrong formulas.
#include "host/gbuffer/random_gbuffer.h"
#include "host/reference/compare.h"
#include "tests/reference/single_precision.h"

#include <gtest/gtest.h>

#include <cmath>

namespace clshade::reference {
namespace {

struct Case {
    SpecularModel specular;
    DiffuseModel diffuse;
};

class DefaultTolerance : public testing::TestWithParam<Case> {
  protected:
    DefaultTolerance()
        : frame_(random_frame(256, 256, GetParam().specular, GetParam().diffuse, 7)),
          tolerance_(default_tolerance(frame_.materials.front())), image_(shade(frame_, {}, 2)),
          scale_(rounding_scale(frame_, 2)) {}

    [[nodiscard]] bool accepts(const PlaneSlab& device) const {
        return passes(compare(device, image_, scale_, tolerance_), tolerance_);
    }

    Frame frame_;
    Tolerance tolerance_;
    Image image_;
    RoundingScale scale_;
};

TEST_P(DefaultTolerance, IsReachedByPlainSinglePrecision) {
    EXPECT_TRUE(accepts(shade_in_single_precision(frame_, LobeForm::accurate)));
}

TEST_P(DefaultTolerance, RefusesFormsThatLoseDigits) {
    EXPECT_FALSE(accepts(shade_in_single_precision(frame_, LobeForm::power)));
    EXPECT_FALSE(accepts(shade_in_single_precision(frame_, LobeForm::log1p)));
}

TEST_P(DefaultTolerance, RefusesFiveRelativeTolerances) {
    PlaneSlab device = shade_in_single_precision(frame_, LobeForm::accurate);
    for (float& value : device.all()) {
        value *= 1.00005F;
    }
    EXPECT_FALSE(accepts(device));
}

TEST_P(DefaultTolerance, RefusesAnotherModel) {
    frame_.materials.front().base().specular = GetParam().specular == SpecularModel::blinn_phong
                                                   ? SpecularModel::blinn_phong_exact
                                                   : SpecularModel::blinn_phong;
    EXPECT_FALSE(accepts(shade_in_single_precision(frame_, LobeForm::accurate)));
}

INSTANTIATE_TEST_SUITE_P(Models, DefaultTolerance,
                         testing::Values(Case{SpecularModel::blinn_phong, DiffuseModel::lambert},
                                         Case{SpecularModel::blinn_phong_exact, DiffuseModel::oren_nayar}));

TEST(RoundingScale, GrowsWithTheExponentAndTowardsGrazing) {
    // One distant light of irradiance 1 that mirrors into an orthographic eye; N off by one lobe width,
    // at right angles to the plane of both.
    const auto shift_for = [](float n, double elevation) {
        Frame frame;
        frame.planes = PlaneSlab(1, 1, 4);
        frame.roles.normal = {0, 1, 2};
        const double off = 1.0 / std::sqrt(static_cast<double>(n));
        frame.planes.at(1, 0, 0) = static_cast<float>(std::sin(off));
        frame.planes.at(2, 0, 0) = static_cast<float>(std::cos(off));
        frame.view.orthographic = true;
        frame.view.view_axis = {-std::cos(elevation), 0.0, -std::sin(elevation)};
        Light light;
        light.direction = {std::cos(elevation), 0.0, -std::sin(elevation)};
        frame.lights = {light};
        BoundMaterial material;
        material.base().specular = SpecularModel::blinn_phong_exact;
        material.base().f0.constant = glm::dvec3(1.0);
        material.base().shininess.constant = glm::dvec3(static_cast<double>(n));
        frame.materials = {material};
        return rounding_scale(frame, 1).shift[0][0] / shade(frame, {}, 1).planes[0][0];
    };
    const double base = shift_for(1024.0F, 1.2);
    // Relative error of the lobe n tan(t) d: four times the n at t = 1/sqrt(n) doubles it.
    EXPECT_NEAR(shift_for(4096.0F, 1.2) / base, 2.0, 0.1);
    EXPECT_NEAR(shift_for(16384.0F, 1.2) / base, 4.0, 0.2);
    // H turns by (dE + dL) / |E + L|, and |E + L| = 2 sin(elevation): ten times smaller, nearly ten times the shift.
    EXPECT_GT(shift_for(1024.0F, 0.1) / base, 4.0);
    // Order of magnitude: n tan(t) = sqrt(n) = 32, N and H each off by about one roundoff.
    EXPECT_GT(base, 32.0 * 0x1p-24);
    EXPECT_LT(base, 32.0 * 0x1p-24 * 8.0);
}

} // namespace
} // namespace clshade::reference
