#include "host/scene/model_catalog.h"

#include "tests/scene/support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace clshade {
namespace {

/// A scene whose default material has the model, with a lobe beside it so that diffuse models find a shininess.
std::string scene_with(const ModelInfo& info) {
    const std::string other = info.kind == "diffuse" ? "specular = {}\n" : "diffuse = {}\n";
    return head + "[material.default]\n" + other + std::string(info.kind) + ".model = '" + std::string(info.name) +
           "'\n";
}

TEST(ModelCatalog, TheParserTakesExactlyWhatIsAvailable) {
    for (const ModelInfo& info : model_catalog()) {
        const std::string message = error_of(scene_with(info));
        if (info.available) {
            EXPECT_EQ(message, "") << info.name;
        } else {
            EXPECT_THAT(message, testing::HasSubstr("is not built yet")) << info.name;
        }
    }
}

TEST(ModelCatalog, KnowsEveryModelOfTheScene) {
    std::set<std::string_view> names;
    for (const ModelInfo& info : model_catalog()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name << " is listed twice";
    }
    for (int i = 1; i <= static_cast<int>(SpecularModel::blinn_phong_exact); ++i) {
        EXPECT_EQ(names.count(name_of(static_cast<SpecularModel>(i))), 1U) << i;
    }
    for (int i = 1; i <= static_cast<int>(DiffuseModel::oren_nayar_shininess); ++i) {
        EXPECT_EQ(names.count(name_of(static_cast<DiffuseModel>(i))), 1U) << i;
    }
    EXPECT_EQ(names.count("blinn_phong_anisotropic") + names.count("blinn_phong_spectral"), 2U);
}

TEST(ModelCatalog, ListsAvailableModelsFirstInEachKind) {
    std::string_view kind;
    bool available = true;
    std::set<std::string_view> kinds;
    for (const ModelInfo& info : model_catalog()) {
        if (info.kind != kind) {
            EXPECT_TRUE(kinds.insert(info.kind).second) << "kinds are mixed at " << info.name;
            kind = info.kind;
            available = true;
        }
        EXPECT_TRUE(available || !info.available) << info.name;
        available = info.available;
    }
    EXPECT_EQ(kinds, (std::set<std::string_view>{"specular", "diffuse"}));
}

TEST(ModelCatalog, DocumentsEveryModel) {
    for (const ModelInfo& info : model_catalog()) {
        EXPECT_THAT(std::string(info.source), testing::HasSubstr("models.md section")) << info.name;
        EXPECT_FALSE(info.summary.empty() || info.advice.empty()) << info.name;
        EXPECT_FALSE(info.parameters.empty()) << info.name;
    }
}

} // namespace
} // namespace clshade
