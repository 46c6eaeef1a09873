// Names that users type, from what the parts and views of a file say.
#include "host/images/channel_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace clshade {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct PartOf {
    std::string name;
    std::string view;
    std::vector<std::string> channels;
};

ImageLayout layout_of(const std::vector<PartOf>& parts, std::vector<std::string> views = {}) {
    ImageLayout layout;
    layout.views = std::move(views);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        PartInfo part;
        part.name = parts[i].name;
        part.view = parts[i].view;
        layout.parts.push_back(part);
        for (const std::string& name : parts[i].channels) {
            ChannelInfo channel;
            channel.file_name = name;
            channel.part = static_cast<int>(i);
            layout.channels.push_back(channel);
        }
    }
    name_channels(layout);
    return layout;
}

std::vector<std::string> names_of(const ImageLayout& layout) {
    std::vector<std::string> names;
    for (const ChannelInfo& channel : layout.channels) {
        names.push_back(channel.name);
    }
    return names;
}

std::vector<std::string> views_of(const ImageLayout& layout) {
    std::vector<std::string> views;
    for (const ChannelInfo& channel : layout.channels) {
        views.push_back(channel.view);
    }
    return views;
}

TEST(ChannelNames, OnePartKeepsItsNames) {
    const ImageLayout layout = layout_of({{"", "", {"A", "ViewLayer.Normal.X", "depth.Z", "pscale"}}});
    EXPECT_THAT(names_of(layout), ElementsAre("A", "ViewLayer.Normal.X", "depth.Z", "pscale"));
    EXPECT_THAT(layout.warnings, IsEmpty());
}

TEST(ChannelNames, NukeSplitByLayer) {
    const ImageLayout layout = layout_of({{"rgba.main", "main", {"R", "G"}},
                                          {"character.main", "main", {"Z", "red", "mask"}},
                                          {"depth.main", "main", {"Z"}},
                                          {"other.main", "main", {"mask", "custom"}}});
    EXPECT_THAT(names_of(layout), ElementsAre("R", "G", "character.Z", "character.red", "character.mask", "depth.Z",
                                              "other.mask", "other.custom"));
    EXPECT_THAT(layout.warnings, ElementsAre(HasSubstr("Z, mask")));
    EXPECT_THAT(layout.views, IsEmpty()) << "a single view is nothing to choose from";
}

TEST(ChannelNames, KarmaHasOnePartPerPlaneWithEqualChannels) {
    const ImageLayout layout = layout_of({{"C", "", {"R", "G", "B"}}, {"N", "", {"R", "G", "B"}}, {"Pz", "", {"R"}}});
    EXPECT_THAT(names_of(layout), ElementsAre("C.R", "C.G", "C.B", "N.R", "N.G", "N.B", "Pz.R"));
}

TEST(ChannelNames, AWholeSetInAPartIsThatPartsLayer) {
    const ImageLayout layout =
        layout_of({{"RGBA", "", {"R", "G", "B", "A"}}, {"N", "", {"X", "Y", "Z"}}, {"albedo", "", {"r", "g", "b"}}});
    EXPECT_THAT(names_of(layout),
                ElementsAre("R", "G", "B", "A", "N.X", "N.Y", "N.Z", "albedo.r", "albedo.g", "albedo.b"));
}

TEST(ChannelNames, ArnoldNamesTheChannelLikeThePart) {
    const ImageLayout layout = layout_of({{"RGBA", "", {"R"}}, {"id", "", {"id"}}, {"N", "", {"N.X", "N.Y"}}});
    EXPECT_THAT(names_of(layout), ElementsAre("R", "id", "N.X", "N.Y"));
}

TEST(ChannelNames, AnImageSpreadOverPartsStaysWhole) {
    const ImageLayout layout = layout_of({{"part0", "", {"R"}},
                                          {"part1", "", {"G"}},
                                          {"part2", "", {"B", "layer.R"}},
                                          {"part3", "", {"A", "layer.G"}},
                                          {"part4", "", {"layer.B"}}});
    EXPECT_THAT(names_of(layout), ElementsAre("R", "G", "B", "layer.R", "A", "layer.G", "layer.B"));
    EXPECT_THAT(layout.warnings, IsEmpty());
}

TEST(ChannelNames, LayersClaimedTwiceAreToldApart) {
    const ImageLayout layout = layout_of({{"one", "", {"N.X"}}, {"two", "", {"N.X", "P.X"}}});
    EXPECT_THAT(names_of(layout), ElementsAre("one.N.X", "two.N.X", "P.X"));
    EXPECT_THAT(layout.warnings, SizeIs(1));
}

TEST(ChannelNames, PartsOfTheSameNameStayUnique) {
    const ImageLayout layout = layout_of({{"a", "", {"Z"}}, {"a", "", {"Z"}}, {"", "", {"Z"}}, {"", "", {"Z"}}});
    EXPECT_THAT(names_of(layout), ElementsAre("a.Z", "part1.a.Z", "Z", "part3.Z"));
}

TEST(ChannelNames, DefaultViewLosesItsComponent) {
    const ImageLayout layout =
        layout_of({{"", "", {"VL.Depth.left.Z", "VL.Depth.right.Z", "R", "right.R", "mask.A", "VL.only.right.X"}}},
                  {"left", "right"});
    EXPECT_THAT(names_of(layout), ElementsAre("VL.Depth.Z", "VL.Depth.right.Z", "R", "right.R", "mask.A", "VL.only.X"));
    EXPECT_THAT(views_of(layout), ElementsAre("left", "right", "left", "right", "", "right"));
}

TEST(ChannelNames, ALayerThatAnotherViewNamesBelongsToTheDefaultView) {
    const ImageLayout layout = layout_of({{"", "", {"depth.Z", "depth.left.Z"}}}, {"right", "left"});
    EXPECT_THAT(names_of(layout), ElementsAre("depth.Z", "depth.left.Z"));
    EXPECT_THAT(views_of(layout), ElementsAre("right", "left"));
}

TEST(ChannelNames, ViewsOfParts) {
    const ImageLayout layout = layout_of({{"rgba.left", "left", {"R"}},
                                          {"rgba.right", "right", {"R"}},
                                          {"depth.left", "left", {"Z"}},
                                          {"depth.right", "right", {"Z"}}});
    EXPECT_THAT(layout.views, ElementsAre("left", "right"));
    EXPECT_THAT(names_of(layout), ElementsAre("R", "right.R", "depth.Z", "depth.right.Z"));
    EXPECT_THAT(views_of(layout), ElementsAre("left", "right", "left", "right"));
}

TEST(ChannelNames, EmptyAndDoubleNamesAreLeftOutWithAWarning) {
    const ImageLayout layout = layout_of({{"", "", {"", "R", "R", ""}}});
    EXPECT_THAT(names_of(layout), ElementsAre("R"));
    EXPECT_THAT(layout.warnings, SizeIs(3));
}

TEST(ChannelNames, OddDotsDoNotCrash) {
    const ImageLayout layout =
        layout_of({{"", "", {".", "..", ".R", "R.", "left.", ".left.R", "left..R"}}}, {"left", "right"});
    EXPECT_THAT(names_of(layout), SizeIs(7));
}

} // namespace
} // namespace clshade
