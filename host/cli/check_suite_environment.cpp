// The part of the suite that is lit by an environment.
#include "host/cli/check_suite.h"
#include "host/scene/model_catalog.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace clshade::cli {

namespace {

constexpr int studio_rows = 128;
constexpr int random_stacks = 4;

using Lobes = std::vector<SpecularModel>;

SuiteCase case_of(const Lobes& lobes, DiffuseModel diffuse, AmbientSource source) {
    SuiteCase suite_case;
    suite_case.shape.layers = lobes;
    suite_case.shape.diffuse = diffuse;
    suite_case.environment = source;
    suite_case.label = fmt::format("environment.{}", name_of(source));
    return suite_case;
}

// By the environment alone: nothing hides its errors.
SuiteCase alone(SuiteCase suite_case) {
    suite_case.lights = false;
    suite_case.label += ".alone";
    return suite_case;
}

SuiteCase with_background(SuiteCase suite_case) {
    suite_case.background = true;
    suite_case.label += ".background";
    return suite_case;
}

SuiteCase with_aov(SuiteCase suite_case) {
    suite_case.environment_aov = true;
    suite_case.label += ".aov";
    return suite_case;
}

// One after the other, over and over.
AmbientSource source_of(std::size_t i) {
    return all_ambient_sources.at(i % all_ambient_sources.size());
}

void add_lobes(std::vector<SuiteCase>& suite) {
    for (const SpecularModel lobe : all_specular_models) {
        if (lobe == SpecularModel::none) {
            continue;
        }
        suite.push_back(alone(case_of({lobe}, DiffuseModel::none, AmbientSource::sh2)));
        // The base's own weight of the diffuse part depends on the lobe.
        suite.push_back(case_of({lobe}, DiffuseModel::lambert, AmbientSource::sh2));
        SuiteCase exact = case_of({lobe}, DiffuseModel::lambert, AmbientSource::sh2);
        exact.shape.fresnel = FresnelModel::exact;
        suite.push_back(exact);
    }
    // Exponents that are constants: the levels are known before the kernel is built.
    SuiteCase constants = case_of({SpecularModel::blinn_phong}, DiffuseModel::oren_nayar, AmbientSource::sh2);
    constants.shape.some_constant = true;
    constants.label += ".constants";
    suite.push_back(constants);
}

void add_diffuses(std::vector<SuiteCase>& suite) {
    for (const DiffuseModel diffuse : all_diffuse_models) {
        if (diffuse != DiffuseModel::none) {
            suite.push_back(alone(case_of({SpecularModel::none}, diffuse, AmbientSource::sh3)));
        }
    }
    for (const AmbientSource source : all_ambient_sources) {
        suite.push_back(with_aov(case_of({SpecularModel::blinn_phong}, DiffuseModel::lambert, source)));
    }
    // Forms that differ in what they make of each band meet every source, the others one.
    std::size_t i = 0;
    for (const AmbientDiffuse ambient : all_ambient_diffuses) {
        const bool everywhere = ambient == AmbientDiffuse::precise || ambient == AmbientDiffuse::order1;
        for (const AmbientSource source : all_ambient_sources) {
            if (everywhere || source == source_of(i)) {
                SuiteCase suite_case = case_of({SpecularModel::none}, DiffuseModel::oren_nayar, source);
                suite_case.shape.ambient = ambient;
                suite_case.label += fmt::format(".{}", name_of(ambient));
                suite.push_back(suite_case);
            }
        }
        ++i;
    }
}

void add_stacks(std::vector<SuiteCase>& suite) {
    using enum SpecularModel;
    std::size_t i = 0;
    for (const FresnelModel fresnel : all_fresnel_models) {
        for (const AmbientAbsorption absorption : all_ambient_absorptions) {
            for (const AmbientTransmittance transmittance : all_ambient_transmittances) {
                SuiteCase suite_case = case_of({blinn_phong, blinn_phong}, DiffuseModel::lambert, source_of(i));
                suite_case.shape.fresnel = fresnel;
                suite_case.shape.absorption = i % 2 == 0 ? AbsorptionModel::approximated : AbsorptionModel::original;
                suite_case.shape.absorption_ibl = absorption;
                suite_case.shape.transmittance_ibl = transmittance;
                suite_case.label += fmt::format(".{}.{}", name_of(absorption), name_of(transmittance));
                suite.push_back(i % 3 == 0 ? alone(suite_case) : suite_case);
                ++i;
            }
        }
        for (const Lobes& lobes : {Lobes{blinn_phong, blinn_phong_spectral},
                                   Lobes{blinn_phong_anisotropic, blinn_phong_exact, none, blinn_phong}}) {
            SuiteCase suite_case = case_of(lobes, DiffuseModel::oren_nayar, AmbientSource::sh2);
            suite_case.shape.fresnel = fresnel;
            suite_case.shape.absorption = AbsorptionModel::original;
            suite.push_back(suite_case);
        }
    }
    SuiteCase deep = case_of(Lobes(most_layers, blinn_phong), DiffuseModel::lambert, AmbientSource::sh2);
    deep.shape.absorption = AbsorptionModel::approximated;
    suite.push_back(with_aov(deep));
}

void add_backgrounds(std::vector<SuiteCase>& suite) {
    const SuiteCase both = case_of({SpecularModel::blinn_phong}, DiffuseModel::lambert, AmbientSource::irradiance_map);
    suite.push_back(with_background(both));
    suite.push_back(with_aov(with_background(alone(both))));
}

// Half of them with constants baked in, as under lights.
void add_random_stacks(std::vector<SuiteCase>& suite, std::uint64_t seed) {
    for (std::size_t i = 1; i <= random_stacks; ++i) {
        const StackShape shape = random_shape(seed * 1000 + i); // others than those under lights
        SuiteCase suite_case = case_of(shape.layers, shape.diffuse, source_of(i));
        suite_case.shape = shape;
        suite_case.shape.some_constant = i % 2 == 0;
        suite_case.label += fmt::format(".random{}", i);
        suite.push_back(i % 3 == 0 ? alone(suite_case) : suite_case);
    }
}

void add_presets(std::vector<SuiteCase>& suite) {
    std::size_t i = 0;
    for (const PresetInfo& preset : preset_catalog()) {
        SuiteCase suite_case = case_of({SpecularModel::blinn_phong}, DiffuseModel::lambert, source_of(i++));
        suite_case.preset = preset.name;
        suite_case.label += fmt::format(".{}", preset.name);
        suite.push_back(suite_case);
    }
}

} // namespace

std::vector<SuiteCase> environment_suite(std::uint64_t seed) {
    std::vector<SuiteCase> suite;
    add_lobes(suite);
    add_diffuses(suite);
    add_stacks(suite);
    add_backgrounds(suite);
    add_random_stacks(suite, seed);
    add_presets(suite);
    return suite;
}

LatLong suite_environment() {
    return built_in_studio(studio_rows);
}

} // namespace clshade::cli
