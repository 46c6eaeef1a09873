// Environments: device against reference, lane widths, what is written beside the picture.
#include "tests/shading/environments.h"

#include <string>

namespace clshade {
namespace {

constexpr int width = 96;
constexpr int height = 48;

Frame random_environment_frame(const StackShape& shape, AmbientSource diffuse, std::uint64_t seed) {
    Frame frame = random_frame(width, height, shape, seed);
    surround(frame, diffuse, seed);
    return frame;
}

/// At least 99.9 % of the pixels within 1e-4: what the tolerance under an environment says.
void expect_environment_agreement(Frame& frame, int lanes, const std::string& what) {
    const AovSelection aovs{.diffuse = true, .specular = true, .lights = true, .environment = true};
    const ShadedImage device = shade(frame, lanes, aovs);
    const reference::Image expected = reference::shade(frame, aovs, 2);
    expect_agreement(device, expected, frame, what);
}

std::string name_of(const StackShape& shape) {
    Frame frame = random_frame(16, 16, shape, 1);
    return model_key(frame.materials[0]);
}

TEST(Environment, SingleLayersAgree) {
    std::uint64_t seed = 0;
    for (const SpecularModel specular : all_specular_models) {
        for (const DiffuseModel diffuse : {DiffuseModel::lambert, DiffuseModel::oren_nayar}) {
            StackShape shape;
            shape.layers = {specular};
            shape.diffuse = diffuse;
            Frame frame = random_environment_frame(shape, AmbientSource::sh2, ++seed);
            expect_environment_agreement(frame, 0, name_of(shape));
        }
    }
}

TEST(Environment, RandomStacksAgree) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const StackShape shape = random_shape(seed);
        Frame frame = random_environment_frame(shape, all_ambient_sources[seed % 3], seed);
        expect_environment_agreement(frame, 0, name_of(shape) + " seed " + std::to_string(seed));
    }
}

} // namespace
} // namespace clshade
