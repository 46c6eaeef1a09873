// Cryptomatte names looked up in manifests of every sort.
#include "host/gbuffer/cryptomatte.h"
#include "tests/gbuffer/layouts.h"
#include "tests/gbuffer/plans.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace clshade {
namespace {

using ::testing::AllOf;
using testing::blender_layout;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::layer;
using testing::layout_of;
using ::testing::Not;
using testing::plain_scene;
using testing::plan_error;
using testing::plan_of;
using testing::plane_of;

void add_cryptomatte(ImageLayout& layout, const std::string& key, const std::string& name,
                     const std::string& manifest) {
    const std::string prefix = "cryptomatte/" + key + "/";
    layout.strings[prefix + "name"] = name;
    layout.strings[prefix + "hash"] = "MurmurHash3_32";
    layout.strings[prefix + "conversion"] = "uint32_to_float32";
    layout.strings[prefix + "manifest"] = manifest;
}

/// As Blender writes it; "ball" is a material and an object.
ImageLayout crypto_layout() {
    ImageLayout layout = blender_layout();
    for (const std::string& name : layer("ViewLayer.CryptoObject00", "abgr")) {
        testing::add_channel(layout, name);
    }
    add_cryptomatte(layout, "c7dbf5e", "ViewLayer.CryptoMaterial",
                    R"({"gold":"f0666add","ball":"00000001","copper":"d3f38f37"})");
    add_cryptomatte(layout, "542cafa", "ViewLayer.CryptoObject", R"({"ball":"48ad8cda","floor":"5fa1cd0d"})");
    return layout;
}

/// `default` and one material for each list of names.
Scene scene_with(std::initializer_list<std::vector<std::string>> names) {
    Scene scene = plain_scene();
    for (const std::vector<std::string>& list : names) {
        Material material;
        material.name = fmt::format("m{}", scene.materials.size());
        material.names = list;
        material.names_where = {"scene.toml", static_cast<int>(scene.materials.size()), 9};
        scene.materials.push_back(material);
    }
    return scene;
}

std::string error_for(const ImageLayout& layout, const std::string& name) {
    return plan_error(layout, scene_with({{name}}));
}

/// The first claim of the first material with names.
struct Claimed {
    std::string channel;
    std::uint32_t bits = 0;
};
Claimed claimed(const ImageLayout& layout, const std::string& name) {
    const FramePlan plan = plan_of(layout, scene_with({{name}}));
    const CryptomatteClaim& claim = plan.frame.materials.at(1).cryptomatte.at(0);
    return {plane_of(plan, claim.plane), claim.bits};
}

TEST(CryptomatteIds, AreEightHexadecimalDigits) {
    EXPECT_EQ(parse_id("f0666add"), 0xf0666addU);
    EXPECT_EQ(parse_id("F0666ADD"), 0xf0666addU);
    EXPECT_EQ(parse_id("00000000"), 0U);
    for (const char* text : {"", "f0666ad", "0f0666add", "0xf0666a", "f0666adg", "+f0666ad", "-f0666ad", " f0666ad"}) {
        EXPECT_FALSE(parse_id(text).has_value()) << text;
    }
}

TEST(CryptomatteIds, AreFiniteNormalFloats) {
    EXPECT_EQ(float_bits_of_id(0xf0666addU), 0xf0666addU);
    EXPECT_EQ(float_bits_of_id(0x00000001U), 0x00800001U);      // denormal
    EXPECT_EQ(float_bits_of_id(0x80000000U), 0x80800000U);      // minus zero
    EXPECT_EQ(float_bits_of_id(0x7f812345U), 0x7f012345U);      // NaN
    EXPECT_EQ(float_bits_of_id(0xff800000U), 0xff000000U);      // minus infinity
    for (const std::uint32_t id : {0x00800001U, 0x7f012345U}) { // manifests may hold the id after that
        EXPECT_EQ(float_bits_of_id(id), id);
    }
}

TEST(CryptomatteNames, BecomeClaims) {
    const FramePlan plan = plan_of(crypto_layout(), scene_with({{"gold", "copper"}, {"floor"}}));
    const Frame& frame = plan.frame;
    EXPECT_THAT(frame.materials[0].cryptomatte, IsEmpty());
    ASSERT_EQ(frame.materials[1].cryptomatte.size(), 2U);
    EXPECT_EQ(frame.materials[1].cryptomatte[0].name, "gold");
    EXPECT_EQ(frame.materials[1].cryptomatte[0].bits, 0xf0666addU);
    EXPECT_EQ(frame.materials[1].cryptomatte[1].bits, 0xd3f38f37U);
    EXPECT_EQ(plane_of(plan, frame.materials[1].cryptomatte[0].plane), "ViewLayer.CryptoMaterial00.r");
    EXPECT_EQ(frame.materials[1].cryptomatte[0].plane, frame.materials[1].cryptomatte[1].plane);
    ASSERT_EQ(frame.materials[2].cryptomatte.size(), 1U);
    EXPECT_EQ(plane_of(plan, frame.materials[2].cryptomatte[0].plane), "ViewLayer.CryptoObject00.r");
    EXPECT_EQ(frame.roles.material_id, no_plane);
    EXPECT_THAT(frame.warnings, IsEmpty());
}

TEST(CryptomatteNames, ReadNothingUnlessUsed) {
    EXPECT_THAT(plan_of(crypto_layout(), plain_scene()).frame.plane_names, Not(Contains(HasSubstr("Crypto"))));
}

TEST(CryptomatteNames, IdsAndNamesGoTogether) {
    Scene scene = scene_with({{"gold"}});
    scene.materials[1].ids = {4};
    const FramePlan plan = plan_of(crypto_layout(), scene);
    EXPECT_EQ(plane_of(plan, plan.frame.roles.material_id), "ViewLayer.IndexMA.X");
    EXPECT_EQ(plan.frame.materials[1].cryptomatte.size(), 1U);
}

TEST(CryptomatteNames, InSeveralManifestsNeedAQualifier) {
    const ImageLayout layout = crypto_layout();
    EXPECT_EQ(error_for(layout, "ball"),
              "scene.toml:1:9: material 'm1', names: several Cryptomattes of picture.exr have "
              "the name 'ball'; write \"CryptoObject/ball\" or \"CryptoMaterial/ball\"");
    EXPECT_EQ(claimed(layout, "CryptoObject/ball").bits, 0x48ad8cdaU);
    EXPECT_EQ(claimed(layout, "CryptoMaterial/ball").channel, "ViewLayer.CryptoMaterial00.r");
    EXPECT_EQ(claimed(layout, "CryptoMaterial/ball").bits, 0x00800001U);
    EXPECT_EQ(claimed(layout, "ViewLayer.CryptoObject/ball").channel, "ViewLayer.CryptoObject00.r");
    EXPECT_EQ(claimed(layout, "CryptoMaterial/gold").bits, 0xf0666addU); // where it is not needed
}

TEST(CryptomatteNames, OfTwoViewLayersNeedTheViewLayer) {
    ImageLayout layout = blender_layout("A");
    const ImageLayout other = blender_layout("B");
    layout.channels.insert(layout.channels.end(), other.channels.begin(), other.channels.end());
    add_cryptomatte(layout, "1111111", "A.CryptoMaterial", R"({"gold":"f0666add"})");
    add_cryptomatte(layout, "2222222", "B.CryptoMaterial", R"({"gold":"f0666add"})");
    Scene scene = scene_with({{"gold"}});
    scene.gbuffer = testing::settings_with("normal", {"A.Normal"});
    EXPECT_THAT(plan_error(layout, scene), HasSubstr("\"A.CryptoMaterial/gold\" or \"B.CryptoMaterial/gold\""));
    scene.materials[1].names = {"CryptoMaterial/gold"};
    EXPECT_THAT(plan_error(layout, scene), HasSubstr("\"A.CryptoMaterial/gold\" or \"B.CryptoMaterial/gold\""));
    scene.materials[1].names = {"B.CryptoMaterial/gold"};
    const FramePlan plan = plan_of(layout, scene);
    EXPECT_EQ(plane_of(plan, plan.frame.materials[1].cryptomatte[0].plane), "B.CryptoMaterial00.r");
}

TEST(CryptomatteNames, MayHoldSlashesAndQuotes) {
    ImageLayout layout = layout_of({layer("N", "XYZ"), layer("crypto_material00", "RGBA")});
    add_cryptomatte(layout, "bda530a", "crypto_material",
                    R"({"\/shop\/mat1\/surface":"ff43f211","say \"hi\"":"33fa0e82","gr\u00fcn":"0247c000"})");
    EXPECT_EQ(claimed(layout, "/shop/mat1/surface").bits, 0xff43f211U);
    EXPECT_EQ(claimed(layout, "crypto_material//shop/mat1/surface").channel, "crypto_material00.R");
    EXPECT_EQ(claimed(layout, "say \"hi\"").bits, 0x33fa0e82U);
    EXPECT_EQ(claimed(layout, "gr\xc3\xbcn").bits, 0x0247c000U);
}

TEST(CryptomatteNames, AWholeNameBeatsAQualifiedOne) {
    ImageLayout layout = crypto_layout();
    layout.strings["cryptomatte/542cafa/manifest"] = R"({"CryptoMaterial/gold":"11112222"})";
    EXPECT_EQ(claimed(layout, "CryptoMaterial/gold").bits, 0x11112222U);
}

TEST(CryptomatteNames, UnknownOnesGetASuggestion) {
    const ImageLayout layout = crypto_layout();
    EXPECT_EQ(error_for(layout, "godl"), "scene.toml:1:9: material 'm1', names: no Cryptomatte manifest of picture.exr "
                                         "has the name 'godl'; did you mean 'gold'?");
    EXPECT_THAT(error_for(layout, "Gold"), HasSubstr("did you mean 'gold'?"));
    EXPECT_THAT(error_for(layout, "CryptoMaterial/cooper"), HasSubstr("did you mean 'CryptoMaterial/copper'?"));
    EXPECT_THAT(error_for(layout, "quite different"), HasSubstr("it has ball, floor, ball, copper, gold"));
    EXPECT_THAT(error_for(layout, ""), HasSubstr("no Cryptomatte manifest of picture.exr has the name ''"));
    EXPECT_THAT(error_for(blender_layout(), "gold"),
                AllOf(HasSubstr("material 'm1'"), HasSubstr("picture.exr has no Cryptomatte")));
}

TEST(CryptomatteNames, TwoMaterialsMayNotShareAnId) {
    const ImageLayout layout = crypto_layout();
    const std::string error = plan_error(layout, scene_with({{"copper", "gold"}, {"CryptoMaterial/gold"}}));
    EXPECT_EQ(error, "scene.toml:2:9: material 'm2', names: material 'm1' claims the same Cryptomatte id by 'gold' as "
                     "'CryptoMaterial/gold' does here; let one material have it");
    // Within one material, saying it twice is harmless; and ids of different Cryptomattes are different things.
    EXPECT_EQ(plan_of(layout, scene_with({{"gold", "CryptoMaterial/gold"}})).frame.materials[1].cryptomatte.size(), 1U);
    EXPECT_EQ(plan_error(layout, scene_with({{"CryptoObject/ball"}, {"CryptoMaterial/ball"}})), "no error");
    ImageLayout collision = layout;
    collision.strings["cryptomatte/c7dbf5e/manifest"] = R"({"gold":"f0666add","brass":"f0666add"})";
    EXPECT_THAT(plan_error(collision, scene_with({{"gold"}, {"brass"}})),
                AllOf(HasSubstr("'gold'"), HasSubstr("'brass'"), HasSubstr("same Cryptomatte id")));
}

TEST(DamagedManifests, AreErrorsForTheirNamesAndWarningsElse) {
    for (const char* damaged :
         {"", "{", R"({"gold":"f0666add")", "[1, 2]", "null", "\"gold\"", "12345678", "{\"gold\":{\"a\":\"f0666add\"}}",
          "{\"g\xff\":\"00000001\"}", "{\"gold\":\"f0666add\"} trailing"}) {
        ImageLayout layout = crypto_layout();
        layout.strings["cryptomatte/c7dbf5e/manifest"] = damaged;
        EXPECT_THAT(error_for(layout, "gold"),
                    AllOf(HasSubstr("has the name 'gold'"),
                          HasSubstr("Cryptomatte 'ViewLayer.CryptoMaterial' cannot be used: its manifest is no JSON")))
            << damaged;
        EXPECT_THAT(plan_of(layout, scene_with({{"floor"}})).frame.warnings,
                    ElementsAre(HasSubstr("'ViewLayer.CryptoMaterial' cannot be used")))
            << damaged;
        EXPECT_THAT(plan_of(layout, plain_scene()).frame.warnings, IsEmpty());
    }
    const std::string deep(100000, '[');
    ImageLayout layout = crypto_layout();
    layout.strings["cryptomatte/c7dbf5e/manifest"] = deep;
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("no JSON"));
    layout.strings["cryptomatte/c7dbf5e/manifest"] = "{\"gold\":" + deep + std::string(100000, ']') + "}";
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("no JSON"));
}

TEST(DamagedManifests, IdsMustBeWhole) {
    for (const char* id : {"\"f0666ad\"", "\"0xf0666add\"", "\"\"", "12345678", "1.5", "-1", "null", "true"}) {
        ImageLayout layout = crypto_layout();
        layout.strings["cryptomatte/c7dbf5e/manifest"] = std::string(R"({"copper":"d3f38f37","gold":)") + id + "}";
        EXPECT_THAT(error_for(layout, "gold"),
                    AllOf(HasSubstr("the manifest of 'ViewLayer.CryptoMaterial' in picture.exr gives 'gold' the id"),
                          HasSubstr("not 8 hexadecimal digits")))
            << id;
        EXPECT_EQ(claimed(layout, "copper").bits, 0xd3f38f37U);
    }
}

TEST(DamagedManifests, MayBeMissing) {
    ImageLayout layout = crypto_layout();
    layout.strings.erase("cryptomatte/c7dbf5e/manifest");
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("it has no manifest"));
    layout.strings["cryptomatte/c7dbf5e/manif_file"] = "gone.json";
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("its manifest file 'gone.json' was not read"));
    layout = blender_layout();
    layout.strings["cryptomatte/"] = "x"; // attributes that only look like it
    layout.strings["cryptomatte/c7dbf5e"] = "x";
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("has no Cryptomatte"));
}

TEST(CryptomatteMethod, MustBeTheOneKnown) {
    ImageLayout layout = crypto_layout();
    layout.strings["cryptomatte/c7dbf5e/hash"] = "MurmurHash3_128";
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("hash 'MurmurHash3_128', and only MurmurHash3_32 is known"));
    layout = crypto_layout();
    layout.strings.erase("cryptomatte/c7dbf5e/conversion");
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("conversion '', and only uint32_to_float32 is known"));
    EXPECT_EQ(error_for(layout, "floor"), "no error"); // of the other Cryptomatte
}

/// A file with this layer of ids for the Cryptomatte "crypto".
ImageLayout layout_with_ids(const std::vector<std::string>& channels) {
    ImageLayout layout = layout_of({layer("N", "XYZ"), channels});
    add_cryptomatte(layout, "1234567", "crypto", R"({"gold":"f0666add"})");
    return layout;
}

TEST(CryptomatteChannels, ComeWithEverySuffix) {
    EXPECT_EQ(claimed(layout_with_ids({"crypto00.R", "crypto00.G", "crypto00.B", "crypto00.A"}), "gold").channel,
              "crypto00.R");
    EXPECT_EQ(claimed(layout_with_ids({"crypto00.a", "crypto00.b", "crypto00.g", "crypto00.r"}), "gold").channel,
              "crypto00.r");
    EXPECT_EQ(
        claimed(layout_with_ids({"crypto00.alpha", "crypto00.blue", "crypto00.green", "crypto00.red"}), "gold").channel,
        "crypto00.red");
    EXPECT_EQ(claimed(layout_with_ids({"beauty.crypto00.R", "crypto01.R"}), "gold").channel, "beauty.crypto00.R");
}

TEST(CryptomatteChannels, MustBeThere) {
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"crypto.R"}, {"crypto01.R"}, {"crypto00.G", "crypto00.B"}, {"xcrypto00.R"}}) {
        EXPECT_THAT(error_for(layout_with_ids(names), "gold"),
                    AllOf(HasSubstr("picture.exr has the manifest of Cryptomatte 'crypto' but not its ids"),
                          HasSubstr("'crypto00.R'")));
    }
    EXPECT_THAT(error_for(layout_with_ids({"a.crypto00.R", "b.crypto00.R"}), "gold"),
                HasSubstr("may be a.crypto00 or b.crypto00"));
    ImageLayout nameless = layout_with_ids({"00.R"});
    nameless.strings.erase("cryptomatte/1234567/name");
    EXPECT_THAT(error_for(nameless, "gold"),
                HasSubstr("manifest of Cryptomatte 'cryptomatte/1234567' but not its ids"));
}

TEST(CryptomatteChannels, MustHoldWholeFloats) {
    ImageLayout layout = layout_with_ids({"crypto00.R"});
    layout.channels.back().type = SampleType::half;
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("'crypto00.R' of picture.exr is stored as half"));
    layout.channels.back().type = SampleType::uint32;
    EXPECT_THAT(error_for(layout, "gold"), HasSubstr("holds whole numbers"));
    layout.channels.back().type = SampleType::float32;
    for (const char* compression : {"dwaa", "dwab", "pxr24"}) {
        layout.parts[0].compression = compression;
        EXPECT_THAT(error_for(layout, "gold"), HasSubstr(std::string("lossy ") + compression));
    }
    // DWA keeps channels whose names it does not know.
    layout = layout_with_ids({"crypto00.r"});
    layout.parts[0].compression = "dwaa";
    EXPECT_EQ(error_for(layout, "gold"), "no error");
}

TEST(CryptomatteChannels, AreThoseOfTheView) {
    ImageLayout layout = crypto_layout();
    layout.views = {"left", "right"};
    for (ChannelInfo& channel : layout.channels) {
        channel.view = "left";
    }
    testing::add_channel(layout, "ViewLayer.CryptoMaterial00.right.r", SampleType::float32, "right");
    EXPECT_EQ(claimed(layout, "gold").channel, "ViewLayer.CryptoMaterial00.r");
}

} // namespace
} // namespace clshade
