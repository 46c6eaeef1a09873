// Cryptomatte in files: names against the pixels they stand for, and manifests that lie beside the image.
#include "host/gbuffer/frame_builder.h"
#include "tests/images/fixtures.h"

#include <ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace clshade {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Materials of the Blender scene by pass index, from the JSON beside the render.
const std::map<int, std::string> suzanne_materials{{1, "gold"},
                                                   {2, "red_plastic"},
                                                   {3, "clay_orennayar"},
                                                   {4, "car_paint"},
                                                   {10, "dielectric_r002"},
                                                   {11, "dielectric_r015"},
                                                   {12, "dielectric_r035"},
                                                   {13, "dielectric_r060"},
                                                   {14, "dielectric_r100"},
                                                   {20, "copper_r005"},
                                                   {21, "copper_r030"},
                                                   {22, "copper_r070"},
                                                   {30, "checker_noise"},
                                                   {31, "glass"},
                                                   {1000, "emissive"}};

/// `default`, and a material for each name that claims it both ways.
Scene scene_of_names() {
    Scene scene;
    scene.materials.emplace_back();
    for (const auto& [index, name] : suzanne_materials) {
        Material material;
        material.name = name;
        material.names = {name};
        material.ids = {index};
        scene.materials.push_back(material);
    }
    return scene;
}

/// How often the two ways of claiming agree on pixels that have an index and coverage, and whether each ever did.
struct Agreement {
    int pixels = 0;
    int same = 0;
    std::map<std::string, int> by_name;
};

Agreement agreement_in(const std::filesystem::path& file) {
    const ImageLayout layout = read_layout(file);
    const Scene scene = scene_of_names();
    FramePlan plan = plan_frame(layout, assign_roles(layout, scene.gbuffer, ""), scene);
    allocate_planes(plan);
    read_planes(file, layout, plan, 2);
    const Frame& frame = plan.frame;
    Agreement agreement;
    for (int y = 0; y < frame.planes.height(); ++y) {
        for (int x = 0; x < frame.planes.width(); ++x) {
            const long index = std::lround(frame.planes.at(frame.roles.material_id, x, y));
            if (index == 0 || frame.planes.at(frame.roles.coverage, x, y) == 0.0F) {
                continue;
            }
            ++agreement.pixels;
            for (const BoundMaterial& material : frame.materials) {
                const bool by_id = !material.ids.empty() && material.ids.front() == index;
                const bool by_name =
                    !material.cryptomatte.empty() &&
                    std::bit_cast<std::uint32_t>(frame.planes.at(material.cryptomatte.front().plane, x, y)) ==
                        material.cryptomatte.front().bits;
                agreement.by_name[material.name] += by_name ? 1 : 0;
                agreement.same += by_id && by_name ? 1 : 0;
            }
        }
    }
    return agreement;
}

std::filesystem::path data_file(const std::string& name) {
    return std::filesystem::path(CLSHADE_TEST_DATA) / name;
}

TEST(Cryptomatte, ClaimsThePixelsOfTheMaterial) {
    const Agreement agreement = agreement_in(data_file("crypto_crop.exr"));
    // The index is that of one sample and rank 0 the id of the most coverage, but no two materials share a pixel here.
    EXPECT_GT(agreement.pixels, 3000);
    EXPECT_EQ(agreement.same, agreement.pixels);
    for (const char* name : {"dielectric_r002", "dielectric_r015", "copper_r005", "emissive"}) {
        EXPECT_GT(agreement.by_name.at(name), 100) << name;
    }
    EXPECT_EQ(agreement.by_name.at("gold"), 0); // not in this corner
}

TEST(Cryptomatte, ClaimsThePixelsOfEveryMaterialOfALargeFile) {
    const std::filesystem::path file =
        std::filesystem::path(CLSHADE_SHARED_DATA) / "blender/suzanne_720p_float_zip_crypto.exr";
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << file << " is not there";
    }
    const Agreement agreement = agreement_in(file);
    EXPECT_EQ(agreement.pixels, 318185); // counted by other means
    EXPECT_EQ(agreement.same, agreement.pixels);
    EXPECT_EQ(agreement.by_name.at("gold"), 30568);
    for (const auto& [index, name] : suzanne_materials) {
        EXPECT_GT(agreement.by_name.at(name), 13000) << name;
    }
}

TEST(Cryptomatte, OfArnoldHasNamesWithSlashes) {
    const std::filesystem::path file =
        std::filesystem::path(CLSHADE_SHARED_DATA) / "conformance/layers/psyop_multichannel.exr";
    if (!std::filesystem::exists(file)) {
        GTEST_SKIP() << file << " is not there";
    }
    const ImageLayout layout = read_layout(file);
    Scene scene;
    scene.materials.resize(4);
    scene.materials[1].names = {"/shop/mat1/standard_surface1"};
    scene.materials[2].names = {"crypto_object//obj/box:polygons:1"};
    scene.materials[3].names = {"ball_asset"};
    scene.gbuffer.roles = {{"normal", {"R", "G", "B"}, {}}}; // the file has none; any three will do
    FramePlan plan = plan_frame(layout, assign_roles(layout, scene.gbuffer, ""), scene);
    allocate_planes(plan);
    read_planes(file, layout, plan, 1);
    const std::vector<std::string> channels{"crypto_material00.R", "crypto_object00.R", "crypto_asset00.R"};
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const CryptomatteClaim& claim = plan.frame.materials[i + 1].cryptomatte.at(0);
        EXPECT_EQ(plan.frame.plane_names[static_cast<std::size_t>(claim.plane)], channels[i]);
        int pixels = 0;
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                pixels += std::bit_cast<std::uint32_t>(plan.frame.planes.at(claim.plane, x, y)) == claim.bits ? 1 : 0;
            }
        }
        EXPECT_GT(pixels, 50) << claim.name;
    }
}

constexpr const char* manifest_key = "cryptomatte/1234567/manifest";

/// A file whose manifest is said to be in `sidecar`.
void write_with_sidecar(const std::filesystem::path& file, const std::string& sidecar) {
    Part part = make_part({0, 0, 7, 7}, {{"crypto00.R", Imf::FLOAT, 0}});
    part.header.insert("cryptomatte/1234567/name", Imf::StringAttribute("crypto"));
    part.header.insert("cryptomatte/1234567/manif_file", Imf::StringAttribute(sidecar));
    write_parts(file, {part});
}

TEST(ManifestFiles, AreReadFromBesideTheImage) {
    const TemporaryFolder folder;
    write_with_sidecar(folder / "a.exr", "a.json");
    write_bytes(folder / "a.json", R"({"gold":"f0666add"})");
    const ImageLayout layout = read_layout(folder / "a.exr");
    EXPECT_EQ(layout.strings.at(manifest_key), R"({"gold":"f0666add"})");
    EXPECT_THAT(layout.warnings, IsEmpty());
    std::filesystem::create_directory(folder / "manifests");
    write_with_sidecar(folder / "b.exr", "manifests/b.json");
    write_bytes(folder / "manifests/b.json", "");
    EXPECT_EQ(read_layout(folder / "b.exr").strings.at(manifest_key), "");
}

TEST(ManifestFiles, GiveWayToAManifestInTheHeader) {
    const TemporaryFolder folder;
    Part part = make_part({0, 0, 7, 7}, {{"crypto00.R", Imf::FLOAT, 0}});
    part.header.insert("cryptomatte/1234567/manif_file", Imf::StringAttribute("gone.json"));
    part.header.insert(manifest_key, Imf::StringAttribute("{}"));
    write_parts(folder / "a.exr", {part});
    const ImageLayout layout = read_layout(folder / "a.exr");
    EXPECT_EQ(layout.strings.at(manifest_key), "{}");
    EXPECT_THAT(layout.warnings, IsEmpty());
}

TEST(ManifestFiles, MissingOnesAreAWarning) {
    const TemporaryFolder folder;
    write_with_sidecar(folder / "a.exr", "gone.json");
    const ImageLayout layout = read_layout(folder / "a.exr");
    EXPECT_EQ(layout.strings.count(manifest_key), 0U);
    EXPECT_THAT(layout.warnings, ElementsAre("Cryptomatte manifest 'gone.json' is not there; put it beside the image"));
}

TEST(ManifestFiles, NeverLieElsewhere) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "inside");
    write_bytes(folder / "outside.json", "{}");
    for (const std::string& name :
         {(folder / "outside.json").string(), std::string("../outside.json"), std::string("x/../../outside.json"),
          std::string(".."), std::string("../inside/../outside.json")}) {
        write_with_sidecar(folder / "inside/a.exr", name);
        const ImageLayout layout = read_layout(folder / "inside/a.exr");
        EXPECT_EQ(layout.strings.count(manifest_key), 0U) << name;
        EXPECT_THAT(layout.warnings, ElementsAre(AllOf(HasSubstr("'" + name + "'"), HasSubstr("outside")))) << name;
    }
}

TEST(ManifestFiles, AreFilesOfSensibleSize) {
    const TemporaryFolder folder;
    write_with_sidecar(folder / "a.exr", "a.json");
    const auto warning = [&] {
        const ImageLayout layout = read_layout(folder / "a.exr");
        EXPECT_EQ(layout.strings.count(manifest_key), 0U);
        return layout.warnings.empty() ? std::string("none") : layout.warnings.front();
    };
    std::filesystem::create_directory(folder / "a.json");
    EXPECT_THAT(warning(), HasSubstr("is no file"));
    std::filesystem::remove(folder / "a.json");
    ASSERT_EQ(mkfifo((folder / "a.json").c_str(), 0600), 0); // reading it would wait for ever
    EXPECT_THAT(warning(), HasSubstr("is no file"));
    std::filesystem::remove(folder / "a.json");
    constexpr std::uintmax_t most = std::uintmax_t{64} << 20U;
    write_bytes(folder / "a.json", "{}");
    std::filesystem::resize_file(folder / "a.json", most + 1);
    EXPECT_THAT(warning(), HasSubstr("at most 67108864"));
    std::filesystem::resize_file(folder / "a.json", most);
    EXPECT_EQ(read_layout(folder / "a.exr").strings.at(manifest_key).size(), most);
}

TEST(ManifestFiles, ThatMayNotBeReadAreAWarning) {
    const TemporaryFolder folder;
    write_with_sidecar(folder / "a.exr", "a.json");
    write_bytes(folder / "a.json", "{}");
    std::filesystem::permissions(folder / "a.json", std::filesystem::perms::none);
    std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
    EXPECT_EQ(as_common_user([&] {
                  const ImageLayout layout = read_layout(folder / "a.exr");
                  const bool said = layout.warnings.size() == 1 &&
                                    layout.warnings.front().find("cannot be read") != std::string::npos;
                  return said && layout.strings.count(manifest_key) == 0 ? 0 : 1;
              }),
              0);
}

} // namespace
} // namespace clshade
