// The kernels against the reference: every model at every lane width, bands, every kind of view and plane.
#include "tests/shading/agreement.h"

#include <cstring>
#include <string>
#include <tuple>
#include <vector>

namespace clshade {
namespace {

constexpr int width = 203; // neither a multiple of the lanes nor of a work-group
constexpr int height = 61;

class EveryModel : public testing::TestWithParam<std::tuple<SpecularModel, DiffuseModel>> {};

// The widths differ in lanes.cl alone: all four for the first choice of diffuse model, the extremes for the others.
TEST_P(EveryModel, AgreesWithTheReferenceAtEveryLaneWidth) {
    const auto [specular, diffuse] = GetParam();
    if (specular == SpecularModel::none && diffuse == DiffuseModel::none) {
        return;
    }
    Frame frame = random_frame(width, height, specular, diffuse, 7);
    const reference::Image expected = reference::shade(frame, {}, 2);
    const bool every_width = diffuse == DiffuseModel::oren_nayar;
    for (const int lanes : every_width ? std::vector<int>{1, 4, 8, 16} : std::vector<int>{1, 16}) {
        expect_agreement(shade(frame, lanes), expected, frame, std::to_string(lanes) + " lanes");
    }
}

std::string name_of_pair(const testing::TestParamInfo<std::tuple<SpecularModel, DiffuseModel>>& pair) {
    return std::string(name_of(std::get<0>(pair.param))) + "_over_" + std::string(name_of(std::get<1>(pair.param)));
}

INSTANTIATE_TEST_SUITE_P(NewerLobes, EveryModel,
                         testing::Combine(testing::Values(SpecularModel::blinn_phong_anisotropic,
                                                          SpecularModel::blinn_phong_spectral),
                                          testing::Values(DiffuseModel::none, DiffuseModel::oren_nayar)),
                         name_of_pair);

INSTANTIATE_TEST_SUITE_P(Pairs, EveryModel,
                         testing::Combine(testing::Values(SpecularModel::none, SpecularModel::blinn_phong,
                                                          SpecularModel::blinn_phong_exact),
                                          testing::ValuesIn(all_diffuse_models)),
                         name_of_pair);

TEST(Shader, BandsGiveTheSameBytesAsTheWhole) {
    Frame frame = random_frame(width, height, SpecularModel::blinn_phong, DiffuseModel::oren_nayar, 3);
    const AovSelection aovs = {.diffuse = true, .specular = true, .lights = true};
    const ShadedImage whole = shade(frame, 16, aovs);
    const ShadedImage bands = shade(frame, 16, aovs, 2048);
    ASSERT_EQ(whole.planes.all().size(), bands.planes.all().size());
    EXPECT_EQ(std::memcmp(whole.planes.data(), bands.planes.data(), whole.planes.all().size_bytes()), 0);
    EXPECT_EQ(whole.counts.clamped, bands.counts.clamped);
}

TEST(Shader, TwoRunsGiveTheSameBytes) {
    Frame frame = random_frame(width, height, SpecularModel::blinn_phong, DiffuseModel::lambert, 5);
    const ShadedImage first = shade(frame, 16);
    const ShadedImage second = shade(frame, 16);
    EXPECT_EQ(std::memcmp(first.planes.data(), second.planes.data(), first.planes.all().size_bytes()), 0);
}

TEST(Shader, AovsAgreeWithTheReferenceAndAddUp) {
    Frame frame = random_frame(width, height, SpecularModel::blinn_phong_exact, DiffuseModel::oren_nayar, 11);
    const AovSelection aovs = {.diffuse = true, .specular = true, .lights = true};
    const reference::Image expected = reference::shade(frame, aovs, 2);
    const ShadedImage image = shade(frame, 16, aovs);
    EXPECT_EQ(image.plane_names, output_plane_names(frame, aovs));
    expect_agreement(image, expected, frame, "AOVs");
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const float total = image.planes.at(c, x, y);
                EXPECT_NEAR(image.planes.at(4 + c, x, y) + image.planes.at(7 + c, x, y), total, 2e-6F * (1.0F + total));
            }
        }
    }
}

TEST(Shader, RefusesAnUnknownLaneWidth) {
    EXPECT_THROW(Shader(test_device(), kernel_sources(), ProgramCache::disabled(), {.aovs = {}, .lanes = 3}),
                 std::exception);
}

} // namespace
} // namespace clshade
