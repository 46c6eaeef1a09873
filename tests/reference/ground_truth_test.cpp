// Brute force against the split sum.
#include "host/base/error.h"
#include "host/gbuffer/random_gbuffer.h"
#include "host/reference/ground_truth.h"
#include "tests/reference/environment_pictures.h"
#include "tests/reference/tiny_frame.h"

#include <gtest/gtest.h>

#include <cmath>

namespace clshade::reference {
namespace {

/// One lobe on the tiny frame, seen at 45 degrees unless said otherwise, with no lights.
class GroundTruth : public testing::Test {
  protected:
    GroundTruth() {
        tiny_.frame.lights.clear();
        tiny_.frame.view.view_axis = {0.0, -std::sqrt(0.5), -std::sqrt(0.5)};
        tiny_.material().albedo.constant = {0.2, 0.4, 0.6};
    }
    void set_lobe(SpecularModel model, double f0, double n) {
        tiny_.material().base().specular = model;
        tiny_.material().base().f0.constant = glm::dvec3(f0);
        tiny_.material().base().shininess.constant = glm::dvec3(n);
    }
    [[nodiscard]] GroundTruthSample sample() const { return ground_truth(tiny_.frame, 10, 1, 1).at(0); }

    TinyFrame tiny_;
};

TEST_F(GroundTruth, OfLambertInAConstantEnvironmentIsTheAlbedo) {
    tiny_.frame.environment = environment_of(constant_picture({1.0, 2.0, 3.0}));
    tiny_.frame.environment->intensity = {1.0, 1.0, 0.5};
    const GroundTruthSample s = sample();
    expect_near(s.approximated.diffuse, {0.2, 0.8, 0.9}, 1e-12);
    expect_near(s.truth.diffuse, {0.2, 0.8, 0.9}, 1e-3); // 64 rows
    EXPECT_EQ(s.truth.specular, glm::dvec3(0.0));
    EXPECT_EQ(s.shininess, -1.0);
    EXPECT_EQ(s.model, "none.lambert");
}

TEST_F(GroundTruth, OfTheExactModelHasItsTwentyOutOfTwentyOne) {
    tiny_.frame.environment = environment_of(constant_picture(glm::dvec3(1.0)));
    set_lobe(SpecularModel::blinn_phong_exact, 0.5, 20.0);
    const GroundTruthSample s = sample();
    expect_near(s.truth.diffuse, 0.5 * 20.0 / 21.0 * glm::dvec3(0.2, 0.4, 0.6), 5e-4);
    expect_near(s.approximated.diffuse, s.truth.diffuse, 5e-4);
    // In a constant environment the split is no approximation: only the table's interpolation is (section 6: 0.008).
    expect_near(s.approximated.specular, s.truth.specular, 5e-3);
    EXPECT_EQ(s.shininess, 20.0);
}

TEST_F(GroundTruth, IsNearTheSplitSumInASmoothEnvironment) {
    tiny_.frame.environment = environment_of(picture_of(64, smooth_radiance));
    tiny_.frame.environment->world_to_image = rotation_about({1.0, 1.0, 0.0}, 0.8);
    tiny_.frame.environment->diffuse = AmbientSource::sh3;
    // The lobe at 45 degrees is not that at E = N = R: it leans, and the horizon cuts it. What that does falls with
    // its width, 2/sqrt n.
    for (const double n : {4.0, 60.0, 1000.0}) {
        set_lobe(SpecularModel::blinn_phong, 0.3, n);
        const GroundTruthSample s = sample();
        expect_near(s.approximated.diffuse, s.truth.diffuse, 2e-3); // all bands that there are
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(s.approximated.specular[i] / s.truth.specular[i], 1.0, 0.15 * std::sqrt(4.0 / n)) << n;
        }
    }
}

TEST_F(GroundTruth, CutsTexelsThatAreWiderThanTheLobe) {
    tiny_.frame.environment = environment_of(picture_of(64, smooth_radiance));
    set_lobe(SpecularModel::blinn_phong_exact, 1.0, 65536.0); // deviation 0.0078 rad in texels of 0.049
    const GroundTruthSample s = sample();
    const glm::dvec3 mirrored = smooth_radiance({0.0, -std::sqrt(0.5), std::sqrt(0.5)});
    // A mirror reflects N.E of it (section 12).
    expect_near(s.truth.specular, std::sqrt(0.5) * mirrored, 5e-3);
    // A fraction of a texel off: the same.
    tiny_.frame.environment->world_to_image = rotation_about({0.0, 0.0, 1.0}, 0.02);
    expect_near(sample().truth.specular, s.truth.specular, 1e-2);
}

TEST_F(GroundTruth, LeavesOutWhatIsSeenFromBehind) {
    tiny_.frame.environment = environment_of(constant_picture(glm::dvec3(1.0), 4));
    tiny_.frame.view.view_axis = {0.0, 0.0, 1.0};
    EXPECT_TRUE(ground_truth(tiny_.frame, 10, 1, 1).empty());
}

TEST_F(GroundTruth, SaysWhatIsMissing) {
    EXPECT_THROW(static_cast<void>(sample()), UsageError);
    tiny_.frame.environment = BoundEnvironment{};
    EXPECT_THROW(static_cast<void>(sample()), UsageError);
}

TEST(GroundTruthSamples, AreDrawnBySeedAndInOrder) {
    Frame frame = random_frame(40, 30, SpecularModel::blinn_phong, DiffuseModel::lambert, 3);
    frame.environment = environment_of(constant_picture(glm::dvec3(1.0), 4));
    const auto places = [&](std::uint64_t seed, int threads) {
        std::vector<int> found;
        for (const GroundTruthSample& s : ground_truth(frame, 50, seed, threads)) {
            found.push_back(s.y * 40 + s.x);
        }
        return found;
    };
    const std::vector<int> drawn = places(7, 2);
    EXPECT_EQ(drawn.size(), 50U);
    EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
    EXPECT_EQ(std::adjacent_find(drawn.begin(), drawn.end()), drawn.end());
    EXPECT_EQ(places(7, 1), drawn);
    EXPECT_NE(places(8, 2), drawn);
    EXPECT_TRUE(ground_truth(frame, 0, 1, 1).empty());
    const auto all = static_cast<int>(ground_truth(frame, 100000, 1, 2).size());
    EXPECT_GT(all, 600);
    EXPECT_LT(all, 1100); // of 1200: not the ones without a surface or seen from behind
}

TEST(GroundTruthSummary, CountsByModelAndDecade) {
    std::vector<GroundTruthSample> samples(4);
    for (GroundTruthSample& s : samples) {
        s.model = std::string("b");
        s.shininess = 500.0;
        s.truth.diffuse = glm::dvec3(1.0);
        s.truth.specular = glm::dvec3(2.0);
        s.mean_luminance = 1.0;
        s.approximated = s.truth;
    }
    samples[0].approximated.specular = glm::dvec3(2.6);
    samples[1].approximated.diffuse = glm::dvec3(0.4);
    samples[2].model = std::string("a");
    samples[2].truth = {}; // dark: errors over 1e-3 of the mean
    samples[2].approximated = {glm::dvec3(1e-4), glm::dvec3(0.0)};
    samples[3].shininess = -1.0;
    const std::vector<GroundTruthSummary> summary = summarise(samples);
    ASSERT_EQ(summary.size(), 3U);
    EXPECT_EQ(summary[0].model, "a");
    EXPECT_NEAR(summary[0].total.max, 0.1, 1e-12);
    EXPECT_EQ(summary[1].decade, -1);
    EXPECT_EQ(summary[1].total.max, 0.0);
    const GroundTruthSummary& group = summary[2];
    EXPECT_EQ(group.decade, 2);
    EXPECT_EQ(group.count, 2U);
    EXPECT_NEAR(group.total.mean, 0.2, 1e-12);
    EXPECT_NEAR(group.total.bias, 0.0, 1e-12);
    EXPECT_NEAR(group.specular.max, 0.3, 1e-12);
    EXPECT_NEAR(group.specular.p50, 0.0, 1e-12);
    EXPECT_NEAR(group.diffuse.bias, -0.3, 1e-12);
    EXPECT_EQ(decade_name(-1), "no lobe");
    EXPECT_EQ(decade_name(0), "0..10");
    EXPECT_EQ(decade_name(2), "100..1000");
}

} // namespace
} // namespace clshade::reference
