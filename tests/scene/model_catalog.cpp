#include "host/scene/model_catalog.h"

#include "tests/scene/support.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace clshade {
namespace {

bool is_lobe(const ModelInfo& info) {
    return info.kind == "specular" || info.kind == "diffuse";
}

/// What a parameter needs at the least.
std::string example_of(std::string_view parameter) {
    if (parameter == "metal") {
        return "'gold'";
    }
    if (parameter == "ambient") {
        return "'fit'";
    }
    return parameter == "tangent" ? "[1, 0, 0]" : "1";
}

/// A scene whose default material has the model with the given parameters, beside another lobe.
std::string scene_with(const ModelInfo& info, const std::set<std::string_view>& parameters) {
    std::string lobe = "model = '" + std::string(info.name) + "'";
    for (const std::string_view parameter : parameters) {
        lobe += ", " + std::string(parameter) + " = " + example_of(parameter);
    }
    const std::string other = info.kind == "diffuse" ? "specular = {}\n" : "diffuse = {}\n";
    return head + "[material.default]\n" + other + std::string(info.kind) + " = { " + lobe + " }\n";
}

std::set<std::string_view> parameters_of(const ModelInfo& info) {
    std::set<std::string_view> names;
    for (const ParameterInfo& parameter : info.parameters) {
        EXPECT_TRUE(names.insert(parameter.name).second) << info.name << " lists " << parameter.name << " twice";
    }
    return names;
}

TEST(ModelCatalog, TheParserTakesExactlyTheParametersOfASpecularModel) {
    constexpr std::array<std::string_view, 7> all{"f0",          "ior",   "shininess", "shininess_u",
                                                  "shininess_v", "metal", "tangent"};
    for (const ModelInfo& info : model_catalog()) {
        if (info.kind != "specular") {
            continue;
        }
        std::set<std::string_view> known = parameters_of(info);
        known.erase("ior"); // instead of f0
        EXPECT_EQ(error_of(scene_with(info, known)), "") << info.name;
        for (const std::string_view parameter : all) {
            if (parameter != "ior" && !known.contains(parameter)) {
                std::set<std::string_view> more = known;
                more.insert(parameter);
                EXPECT_NE(error_of(scene_with(info, more)), "") << info.name << " took " << parameter;
            }
        }
    }
}

TEST(ModelCatalog, ParametersWithoutADefaultMustBeWritten) {
    for (const ModelInfo& info : model_catalog()) {
        if (!is_lobe(info)) {
            continue;
        }
        for (const ParameterInfo& parameter : info.parameters) {
            std::set<std::string_view> rest = parameters_of(info);
            rest.erase("ior");
            rest.erase(parameter.name);
            const bool needed = parameter.fallback.starts_with("must be written");
            EXPECT_EQ(error_of(scene_with(info, rest)).empty(), !needed) << info.name << " without " << parameter.name;
        }
    }
}

TEST(ModelCatalog, KnowsEveryModelOfTheScene) {
    std::set<std::string_view> names;
    for (const ModelInfo& info : model_catalog()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name << " is listed twice";
    }
    for (const SpecularModel model : all_specular_models) {
        EXPECT_EQ(names.count(name_of(model)), model == SpecularModel::none ? 0U : 1U) << name_of(model);
    }
    for (const DiffuseModel model : all_diffuse_models) {
        EXPECT_EQ(names.count(name_of(model)), model == DiffuseModel::none ? 0U : 1U) << name_of(model);
    }
    EXPECT_EQ(names.size(), 4U + 7U + 1U);
}

TEST(ModelCatalog, ListsSpecularThenDiffuseThenStack) {
    std::vector<std::string_view> kinds;
    for (const ModelInfo& info : model_catalog()) {
        if (kinds.empty() || kinds.back() != info.kind) {
            kinds.push_back(info.kind);
        }
    }
    EXPECT_THAT(kinds, testing::ElementsAre("specular", "diffuse", "stack"));
}

TEST(ModelCatalog, DocumentsEveryModelAndParameter) {
    for (const ModelInfo& info : model_catalog()) {
        EXPECT_THAT(std::string(info.source), testing::HasSubstr("models.md section")) << info.name;
        EXPECT_FALSE(info.summary.empty() || info.advice.empty()) << info.name;
        EXPECT_THAT(std::string(info.environment), testing::HasSubstr("models.md section")) << info.name;
        EXPECT_FALSE(info.parameters.empty()) << info.name;
        for (const ParameterInfo& parameter : info.parameters) {
            EXPECT_FALSE(parameter.name.empty() || parameter.unit.empty() || parameter.range.empty() ||
                         parameter.fallback.empty() || parameter.source.empty())
                << info.name << " " << parameter.name;
        }
    }
}

TEST(ModelCatalog, TheStackHasTheKeysOfAMaterial) {
    const ModelInfo& layers = model_catalog().back();
    EXPECT_EQ(layers.name, "layers");
    EXPECT_EQ(parameters_of(layers),
              (std::set<std::string_view>{"layer", "fresnel", "absorption_model", "absorption", "absorption_ibl",
                                          "transmittance_ibl", "ids", "names", "preset"}));
    EXPECT_THAT(error_of(head, {}, "layers"), testing::HasSubstr("unknown model")); // no lobe
}

const ParameterInfo& find_key(std::span<const ParameterInfo> keys, std::string_view name) {
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const ParameterInfo& parameter) { return parameter.name == name; });
    EXPECT_NE(found, keys.end()) << name;
    return *found;
}

template <typename Enum, std::size_t size>
void expect_choices(const ParameterInfo& key, const std::array<Enum, size>& all) {
    for (const Enum each : all) {
        EXPECT_THAT(std::string(key.range), testing::ContainsRegex("\\b" + std::string(name_of(each)) + "\\b"));
    }
}

TEST(ModelCatalog, NamesEveryChoice) {
    const std::span<const ParameterInfo> stack = model_catalog().back().parameters;
    expect_choices(find_key(stack, "fresnel"), all_fresnel_models);
    expect_choices(find_key(stack, "absorption_model"), all_absorption_models);
    expect_choices(find_key(stack, "absorption_ibl"), all_ambient_absorptions);
    expect_choices(find_key(stack, "transmittance_ibl"), all_ambient_transmittances);
    expect_choices(find_key(environment_keys(), "up"), all_up_axes);
    expect_choices(find_key(environment_keys(), "diffuse"), all_ambient_sources);
    for (const ModelInfo& info : model_catalog()) {
        if (info.name.starts_with("oren_nayar")) {
            expect_choices(find_key(info.parameters, "ambient"), all_ambient_diffuses);
        }
    }
}

TEST(ModelCatalog, TheParserTakesExactlyTheKeysOfAnEnvironment) {
    std::set<std::string_view> names;
    for (const ParameterInfo& key : environment_keys()) {
        EXPECT_FALSE(key.unit.empty() || key.range.empty() || key.fallback.empty() || key.source.empty()) << key.name;
        names.insert(key.name);
    }
    EXPECT_EQ(names,
              (std::set<std::string_view>{"image", "intensity", "up", "rotation_degrees", "diffuse", "background"}));
    EXPECT_EQ(error_of("version = 1\n[environment]\nimage = 'a'\nintensity = 1\nup = 'z'\nrotation_degrees = 1\n"
                       "diffuse = 'sh2'\n[output]\nbackground = true\n"),
              "");
}

} // namespace
} // namespace clshade
