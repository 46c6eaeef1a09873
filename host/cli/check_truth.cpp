#include "host/cli/check_truth.h"

#include "host/cli/memory_frame.h"
#include "host/cli/table.h"
#include "host/demo/preset_stage.h"
#include "host/environment/lat_long.h"
#include "host/gbuffer/environment_binding.h"
#include "host/scene/metal_table.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <utility>

namespace clshade::cli {

namespace {

constexpr int stage_size = 96;   // pixels a side: ten thousand to draw from
constexpr int studio_rows = 128; // texels of 1.4 degrees: the integral is a sum over them

constexpr std::array<double, 4> exponents{5.0, 50.0, 500.0, 5000.0}; // one in each decade
constexpr double stretch = 8.0;                                      // of the anisotropic lobe: n_u to n_v

struct NamedMaterial {
    std::string name;
    Material material;
};

Specular lobe(SpecularModel model, double f0, double shininess) {
    Specular specular;
    specular.model = model;
    specular.f0 = Parameter::of(f0);
    specular.shininess = Parameter::of(shininess);
    specular.shininess_u = Parameter::of(shininess / stretch);
    specular.shininess_v = Parameter::of(shininess);
    specular.tangent = Parameter::of(glm::dvec3(0.0, 0.0, 1.0)); // along the axis that the body is turned about
    if (model == SpecularModel::blinn_phong_spectral) {
        specular.metal = *built_in_metal("gold");
    }
    return specular;
}

Material single(const Specular& specular, DiffuseModel diffuse) {
    Material material;
    material.base() = specular;
    material.diffuse.model = diffuse;
    return material;
}

void add_lobes(std::vector<NamedMaterial>& all, double n) {
    constexpr double plastic = 0.04;
    for (const SpecularModel model : {SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact}) {
        const std::string lobe_name(name_of(model));
        all.push_back({lobe_name + ".lambert", single(lobe(model, plastic, n), DiffuseModel::lambert)});
        all.push_back({lobe_name + ".none, f0 1", single(lobe(model, 1.0, n), DiffuseModel::none)});
    }
    const SpecularModel stretched = SpecularModel::blinn_phong_anisotropic;
    all.push_back({fmt::format("{}.none, 1:{:g}", name_of(stretched), stretch),
                   single(lobe(stretched, 1.0, n), DiffuseModel::none)});
    const SpecularModel metal = SpecularModel::blinn_phong_spectral;
    all.push_back({fmt::format("{}.none, gold", name_of(metal)), single(lobe(metal, 1.0, n), DiffuseModel::none)});
}

// Rough surfaces: exponents as the deck shows them.
void add_diffuses(std::vector<NamedMaterial>& all) {
    all.push_back({"none.lambert", single(lobe(SpecularModel::none, 0.0, 0.0), DiffuseModel::lambert)});
    for (const double n : {2.0, 20.0}) {
        for (const AmbientDiffuse ambient : all_ambient_diffuses) {
            Material material = single(lobe(SpecularModel::none, 0.0, 0.0), DiffuseModel::oren_nayar);
            material.diffuse.shininess = Parameter::of(n);
            material.diffuse.ambient = ambient;
            all.push_back({fmt::format("none.oren_nayar, {}, n {:g}", name_of(ambient), n), material});
        }
    }
}

// A clear coat that absorbs over a rough base.
void add_stacks(std::vector<NamedMaterial>& all) {
    for (const FresnelModel fresnel : all_fresnel_models) {
        for (const AmbientAbsorption absorption : all_ambient_absorptions) {
            Material material;
            material.fresnel = fresnel;
            material.absorption_ibl = absorption;
            material.layers = {Layer{}, Layer{}};
            material.layers[0].specular = lobe(SpecularModel::blinn_phong, 0.04, 500.0);
            material.layers[0].absorption = Parameter::of(glm::dvec3(0.02, 0.06, 0.12));
            material.layers[1].specular = lobe(SpecularModel::blinn_phong, 0.1, 20.0);
            all.push_back({fmt::format("layers2, {}, {}", name_of(fresnel), name_of(absorption)), material});
        }
    }
}

std::vector<NamedMaterial> materials() {
    std::vector<NamedMaterial> all;
    for (const double n : exponents) {
        add_lobes(all, n);
    }
    add_diffuses(all);
    add_stacks(all);
    return all;
}

std::string percent(double value) {
    return fmt::format("{:.2f}", 100.0 * value);
}

nlohmann::json json_of(const reference::GroundTruthErrors& errors) {
    return {
        {"mean", errors.mean}, {"bias", errors.bias}, {"p50", errors.p50}, {"p99", errors.p99}, {"max", errors.max}};
}

} // namespace

std::vector<TruthCase> truth_cases(int threads) {
    const DemoFrame stage = render_preset_stage(stage_size, threads);
    const auto image = std::make_shared<const LatLong>(built_in_studio(studio_rows));
    Scene scene;
    scene.camera = stage.camera;
    scene.environment = Environment{};
    scene.environment->in_camera_space = true; // the key stands where it does in the default scene
    std::vector<TruthCase> cases;
    for (NamedMaterial& named : materials()) {
        scene.materials = {std::move(named.material)};
        TruthCase truth_case{std::move(named.name),
                             frame_from_planes(stage.planes, stage.plane_names, scene, "preset stage")};
        attach_environment(truth_case.frame, scene, image, nullptr);
        cases.push_back(std::move(truth_case));
    }
    return cases;
}

void append_samples(std::vector<reference::GroundTruthSample>& all, const Frame& frame, const TruthOptions& options,
                    const std::string& name) {
    for (reference::GroundTruthSample& sample :
         reference::ground_truth(frame, options.samples, options.seed, options.threads)) {
        if (!name.empty()) {
            sample.model = name;
        }
        all.push_back(std::move(sample));
    }
}

std::string truth_text(const std::vector<reference::GroundTruthSummary>& rows) {
    Table table({{"model", Align::left},
                 {"shininess"},
                 {"pixels"},
                 {"specular mean"},
                 {"p50"},
                 {"p99"},
                 {"diffuse mean"},
                 {"p50"},
                 {"p99"},
                 {"total mean"},
                 {"p50"},
                 {"p99"},
                 {"bias"}});
    for (const reference::GroundTruthSummary& row : rows) {
        std::vector<std::string> cells{shortened(row.model, 64), reference::decade_name(row.decade),
                                       std::to_string(row.count)};
        for (const reference::GroundTruthErrors& errors : {row.specular, row.diffuse, row.total}) {
            for (const double value : {errors.mean, errors.p50, errors.p99}) {
                cells.push_back(percent(value));
            }
        }
        cells.push_back(percent(row.total.bias));
        table.add_row(std::move(cells));
    }
    return "The real-time approximation of the environment's light against brute-force integration of environment "
           "times "
           "BRDF,\nboth in double precision. Relative errors of luminance in per cent; bias above 0: too bright.\n\n" +
           table.text();
}

nlohmann::json truth_json(const std::vector<reference::GroundTruthSummary>& rows) {
    nlohmann::json all = nlohmann::json::array();
    for (const reference::GroundTruthSummary& row : rows) {
        all.push_back({{"model", row.model},
                       {"shininess", reference::decade_name(row.decade)},
                       {"decade", row.decade},
                       {"samples", row.count},
                       {"specular", json_of(row.specular)},
                       {"diffuse", json_of(row.diffuse)},
                       {"total", json_of(row.total)}});
    }
    return all;
}

} // namespace clshade::cli
