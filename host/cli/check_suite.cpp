#include "host/cli/check_suite.h"

#include "host/cli/memory_frame.h"
#include "host/scene/model_catalog.h"
#include "host/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace clshade::cli {

namespace {

constexpr std::array<SpecularModel, 3> old_lobes{SpecularModel::none, SpecularModel::blinn_phong,
                                                 SpecularModel::blinn_phong_exact};
constexpr std::array<SpecularModel, 2> special_lobes{SpecularModel::blinn_phong_anisotropic,
                                                     SpecularModel::blinn_phong_spectral};
// The generator writes a diffuse part the same way under any lobe with Fresnel, so these three stand for all there.
constexpr std::array<DiffuseModel, 3> typical_diffuses{DiffuseModel::none, DiffuseModel::lambert,
                                                       DiffuseModel::oren_nayar};
constexpr int random_stacks = 8;

using Lobes = std::vector<SpecularModel>;

SuiteCase case_of(const Lobes& lobes, DiffuseModel diffuse, FresnelModel fresnel = FresnelModel::constant,
                  AbsorptionModel absorption = AbsorptionModel::none) {
    SuiteCase suite_case;
    suite_case.shape.layers = lobes;
    suite_case.shape.diffuse = diffuse;
    suite_case.shape.fresnel = fresnel;
    suite_case.shape.absorption = absorption;
    return suite_case;
}

void add_single_layers(std::vector<SuiteCase>& suite) {
    for (const SpecularModel lobe : old_lobes) {
        for (const DiffuseModel diffuse : all_diffuse_models) {
            if (lobe != SpecularModel::none || diffuse != DiffuseModel::none) { // neither: black
                suite.push_back(case_of({lobe}, diffuse));
            }
        }
    }
    for (const SpecularModel lobe : special_lobes) {
        for (const DiffuseModel diffuse : typical_diffuses) {
            suite.push_back(case_of({lobe}, diffuse));
        }
    }
    for (const SpecularModel lobe : all_specular_models) {
        if (lobe != SpecularModel::none) {
            suite.push_back(case_of({lobe}, DiffuseModel::lambert, FresnelModel::exact));
        }
    }
}

void add_stacks(std::vector<SuiteCase>& suite) {
    using enum SpecularModel;
    constexpr std::array absorptions{AbsorptionModel::none, AbsorptionModel::approximated, AbsorptionModel::original};
    for (const FresnelModel fresnel : {FresnelModel::constant, FresnelModel::exact}) {
        for (const AbsorptionModel absorption : absorptions) {
            suite.push_back(case_of({blinn_phong, blinn_phong}, DiffuseModel::lambert, fresnel, absorption));
        }
        // A coat over the lobes that have formulas of their own.
        suite.push_back(case_of({blinn_phong, blinn_phong_anisotropic}, DiffuseModel::lambert, fresnel,
                                AbsorptionModel::approximated));
        suite.push_back(
            case_of({blinn_phong, blinn_phong_spectral}, DiffuseModel::none, fresnel, AbsorptionModel::original));
        suite.push_back(case_of({blinn_phong_anisotropic, blinn_phong_exact, blinn_phong}, DiffuseModel::oren_nayar,
                                fresnel, AbsorptionModel::original));
    }
    // Skin's shape, with everything from planes.
    suite.push_back(case_of({blinn_phong, blinn_phong}, DiffuseModel::oren_nayar, FresnelModel::constant,
                            AbsorptionModel::approximated));
    suite.push_back(case_of({blinn_phong_exact, none, blinn_phong, blinn_phong_anisotropic, blinn_phong_spectral},
                            DiffuseModel::lambert, FresnelModel::constant, AbsorptionModel::approximated));
    suite.push_back(case_of(Lobes(most_layers, blinn_phong), DiffuseModel::lambert, FresnelModel::exact,
                            AbsorptionModel::original));
}

// Half of them with constants baked in, so that both kinds of parameters are always covered.
void add_random_stacks(std::vector<SuiteCase>& suite, std::uint64_t seed) {
    for (int i = 1; i <= random_stacks; ++i) {
        SuiteCase suite_case;
        suite_case.shape = random_shape(seed * random_stacks + static_cast<std::uint64_t>(i));
        suite_case.shape.some_constant = i % 2 == 0;
        suite_case.label = fmt::format("random{}", i);
        suite.push_back(suite_case);
    }
}

void add_presets(std::vector<SuiteCase>& suite) {
    for (const PresetInfo& preset : preset_catalog()) {
        SuiteCase suite_case;
        suite_case.preset = preset.name;
        suite_case.label = preset.name;
        suite.push_back(suite_case);
    }
}

} // namespace

std::vector<SuiteCase> check_suite(std::uint64_t seed) {
    std::vector<SuiteCase> suite;
    add_single_layers(suite);
    add_stacks(suite);
    add_random_stacks(suite, seed);
    add_presets(suite);
    const std::vector<SuiteCase> more = environment_suite(seed);
    suite.insert(suite.end(), more.begin(), more.end());
    return suite;
}

Frame frame_of(const SuiteCase& suite_case, int width, int height, std::uint64_t seed,
               const std::shared_ptr<const LatLong>& image, const std::shared_ptr<const FilteredSet>& maps) {
    const int share = suite_case.environment ? 2 : 1;
    Frame frame = random_frame(std::max(width / share, 1), std::max(height / share, 1), suite_case.shape, seed);
    if (!suite_case.preset.empty()) {
        // Presets hold constants only: what they are bound to does not matter, so they go onto this frame as they are.
        const std::string scene_text =
            fmt::format("version = 1\n[camera]\nmatrix_world = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\n"
                        "fov_y_degrees = 40\n[material.default]\npreset = \"{}\"\n"
                        "[[light]]\ntype = \"distant\"\ndirection = [0, 0, -1]\nirradiance = 1\n",
                        suite_case.preset);
        const Scene scene = parse_scene(scene_text, "preset " + suite_case.preset, {}, {});
        frame.materials = frame_from_planes(frame.planes, frame.plane_names, scene, frame.file).materials;
    }
    if (suite_case.environment) {
        add_random_environment(frame, image, *suite_case.environment, seed);
        frame.environment->background = suite_case.background;
        frame.environment->maps = maps;
    }
    if (!suite_case.lights) {
        frame.lights.clear();
    }
    return frame;
}

std::string name_of(const SuiteCase& suite_case, const Frame& frame) {
    const std::string key = model_key(frame.materials.front());
    return suite_case.label.empty() ? key : fmt::format("{}@{}", key, suite_case.label);
}

std::string layer_of(const SuiteCase& suite_case, const Frame& frame) {
    constexpr std::size_t longest = 200; // leaves room for "reference.R"
    const std::string name = name_of(suite_case, frame);
    return suite_case.label.empty() || (suite_case.environment && name.size() <= longest) ? name : suite_case.label;
}

} // namespace clshade::cli
