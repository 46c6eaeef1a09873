// Folders of pre-filtered maps: there and back, and everything that can be wrong with them.
#include "host/images/environment_file.h"
#include "host/images/temporary_file.h"
#include "tests/images/fixtures.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <limits>
#include <random>
#include <stdexcept>

namespace clshade {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

namespace fs = std::filesystem;

/// Maps without any meaning, all values different.
FilteredSet example_set(unsigned seed = 1) {
    std::mt19937 random(seed);
    std::exponential_distribution<float> light(1.0F);
    const auto fill = [&](std::vector<float>& values, int cells) {
        values.resize(static_cast<std::size_t>(cells + 1) * static_cast<std::size_t>(cells + 1) * 3);
        std::generate(values.begin(), values.end(), [&] { return light(random); });
    };
    FilteredSet set;
    set.name = "studio \"3\".hdr";
    set.hash = seed == 1 ? "00112233445566778899aabbccddeeff" : "ffeeddccbbaa99887766554433221100";
    for (int level = 0; level < radiance_levels; ++level) {
        fill(set.radiance[static_cast<std::size_t>(level)], level_cells(level));
    }
    fill(set.irradiance, irradiance_cells);
    set.radiance[0][5] = 2e5F;
    set.radiance[0][6] = 1e-42F; // denormal
    set.radiance[0][7] = 0.0F;
    std::normal_distribution<double> number;
    for (glm::dvec3& value : set.sh) {
        value = {number(random), number(random) * 1e-9, number(random) * 1e6};
    }
    set.mean = {0.1, 1.0 / 3.0, 123456.789012345678};
    set.up = UpAxis::y;
    return set;
}

AmbientTables example_tables() {
    AmbientTables tables;
    for (std::size_t i = 0; i < std::size_t{2} * (ambient_cosines + 1) * (ambient_exponents + 1); ++i) {
        tables.exact.push_back(static_cast<float>(i) * 1e-4F);
        tables.linear.push_back(static_cast<float>(i) * 2e-4F);
    }
    return tables;
}

void write_example(const fs::path& folder, unsigned seed = 1) {
    write_filtered_set(folder, example_set(seed), example_tables());
}

void expect_same(const FilteredSet& a, const FilteredSet& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.hash, b.hash);
    for (std::size_t level = 0; level < a.radiance.size(); ++level) {
        EXPECT_TRUE(a.radiance[level] == b.radiance[level]) << level;
    }
    EXPECT_TRUE(a.irradiance == b.irradiance);
    EXPECT_EQ(a.sh, b.sh);
    EXPECT_EQ(a.mean, b.mean);
    EXPECT_EQ(a.up, b.up);
}

std::string failure(const fs::path& set) {
    return failure_of([&] { static_cast<void>(read_filtered_set(set)); });
}

/// Writes an EXR anew with something changed.
void change(const fs::path& file, const std::function<void(OutputImage&, PlaneSlab&)>& action) {
    Picture picture = read_picture(file);
    OutputImage image;
    image.data_window = picture.layout.parts[0].data_window;
    image.display_window = picture.layout.display_window;
    image.attributes = picture.layout.strings;
    for (std::size_t i = 0; i < picture.layout.channels.size(); ++i) {
        image.channels.push_back(
            {picture.layout.channels[i].name, &picture.plan.frame.planes, static_cast<int>(i), true});
    }
    action(image, picture.plan.frame.planes);
    ExrSettings settings;
    settings.half = false;
    write_exr(file, image, settings);
}

TEST(FilteredSetFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    FilteredSet set = example_set();
    write_filtered_set(folder / "maps", set, example_tables());
    EXPECT_TRUE(is_filtered_set(folder / "maps"));
    expect_same(read_filtered_set(folder / "maps"), set);
    EXPECT_THAT(folder.names(), ElementsAre("maps"));
    for (const std::optional<UpAxis> up : {std::optional(UpAxis::z), std::optional<UpAxis>()}) {
        set.up = up;
        write_filtered_set(folder / "maps", set, example_tables());
        expect_same(read_filtered_set(folder / "maps"), set);
    }
}

TEST(FilteredSetFile, HasTheFilesThatTheHeaderSays) {
    const TemporaryFolder folder;
    write_example(folder / "maps");
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder / "maps")) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    EXPECT_THAT(names, ElementsAre("ambient_brdf.exr", "irradiance.exr", "radiance_n0001.exr", "radiance_n0002.exr",
                                   "radiance_n0004.exr", "radiance_n0008.exr", "radiance_n0016.exr",
                                   "radiance_n0032.exr", "radiance_n0064.exr", "radiance_n0128.exr",
                                   "radiance_n0256.exr", "radiance_n0512.exr", "radiance_n1024.exr",
                                   "radiance_n2048.exr", "radiance_n4096.exr", "radiance_n8192.exr", "sh.exr"));
    for (const std::string& name : names) { // every file can be understood alone
        const ImageLayout layout = read_layout(folder / "maps" / name);
        EXPECT_THAT(layout.strings.at("clshade/environment"), HasSubstr("studio \"3\".hdr")) << name;
        EXPECT_EQ(layout.strings.at("clshade/environment_hash"), "00112233445566778899aabbccddeeff") << name;
        EXPECT_THAT(layout.strings.at("clshade/axes"), HasSubstr("+z towards row 0")) << name;
        EXPECT_THAT(layout.strings.at("clshade/sh_basis"), HasSubstr("no Condon-Shortley sign")) << name;
        EXPECT_EQ(layout.strings.count("clshade/layout"), 1U) << name;
        EXPECT_EQ(layout.strings.count("clshade/scaling"), 1U) << name;
        EXPECT_EQ(layout.strings.at("clshade/up"), "y") << name;
        EXPECT_THAT(layout.strings.at("clshade/mean_radiance"), HasSubstr("123456.789")) << name;
        for (const ChannelInfo& channel : layout.channels) {
            EXPECT_EQ(channel.type, SampleType::float32) << name;
        }
    }
    EXPECT_THAT(read_layout(folder / "maps/radiance_n0064.exr").strings.at("clshade/lobe"), HasSubstr("n = 64,"));
    EXPECT_EQ(read_layout(folder / "maps/irradiance.exr").strings.at("clshade/scaling"), "E/pi");
    EXPECT_EQ(read_layout(folder / "maps/radiance_n0064.exr").strings.at("clshade/scaling"), "radiance");
}

TEST(FilteredSetFile, VerticesAndTablesLieAsTheLayoutSays) {
    const TemporaryFolder folder;
    const FilteredSet set = example_set();
    const AmbientTables tables = example_tables();
    write_filtered_set(folder / "maps", set, tables);
    const Picture level = read_picture(folder / "maps/radiance_n1024.exr", 1, {"R", "G", "B"});
    const int cells = level_cells(3);
    EXPECT_EQ(level.layout.parts[0].data_window, (Window{0, 0, cells, cells}));
    for (int c = 0; c < 3; ++c) { // vertex (5, 7): index 7 (cells + 1) + 5
        EXPECT_EQ(level.at(c, 5, 7), set.radiance[3][static_cast<std::size_t>((7 * (cells + 1) + 5) * 3 + c)]);
    }
    const Picture ambient =
        read_picture(folder / "maps/ambient_brdf.exr", 1, {"exact.scale", "exact.bias", "linear.scale", "linear.bias"});
    EXPECT_EQ(ambient.layout.parts[0].data_window, (Window{0, 0, 128, 64}));
    const std::size_t vertex = 129 * 40 + 17;
    EXPECT_EQ(ambient.at(0, 17, 40), tables.exact[2 * vertex]);
    EXPECT_EQ(ambient.at(1, 17, 40), tables.exact[2 * vertex + 1]);
    EXPECT_EQ(ambient.at(2, 17, 40), tables.linear[2 * vertex]);
    EXPECT_EQ(ambient.at(3, 17, 40), tables.linear[2 * vertex + 1]);
    const Picture sh = read_picture(folder / "maps/sh.exr", 1, {"R", "G", "B"});
    EXPECT_EQ(sh.layout.parts[0].data_window, (Window{0, 0, 8, 0}));
    EXPECT_EQ(sh.at(2, 4, 0), static_cast<float>(set.sh[4].b));
}

TEST(FilteredSetFile, ReplacesASetAndNothingElse) {
    const TemporaryFolder folder;
    write_example(folder / "maps", 1);
    write_example(folder / "maps", 2);
    expect_same(read_filtered_set(folder / "maps"), example_set(2));

    fs::create_directory(folder / "empty");
    write_example(folder / "empty");
    EXPECT_TRUE(is_filtered_set(folder / "empty"));

    fs::create_directory(folder / "photos");
    write_bytes(folder / "photos/cat.jpg", "a cat");
    EXPECT_THAT(failure_of([&] { write_example(folder / "photos"); }),
                AllOf(HasSubstr("photos"), HasSubstr("cat.jpg")));
    EXPECT_EQ(bytes_of_file(folder / "photos/cat.jpg"), "a cat");

    write_bytes(folder / "maps/notes.txt", "mine");
    EXPECT_THAT(failure_of([&] { write_example(folder / "maps", 1); }), HasSubstr("notes.txt"));
    EXPECT_EQ(bytes_of_file(folder / "maps/notes.txt"), "mine");
    expect_same(read_filtered_set(folder / "maps"), example_set(2));

    write_bytes(folder / "file", "text");
    EXPECT_THAT(failure_of([&] { write_example(folder / "file"); }), HasSubstr("no folder"));
    EXPECT_EQ(bytes_of_file(folder / "file"), "text");
    EXPECT_THAT(failure_of([&] { write_example(folder / "none/maps"); }), HasSubstr("does not exist"));
    EXPECT_THAT(folder.names(), ElementsAre("empty", "file", "maps", "photos"));
}

TEST(FilteredSetFile, TakesNamesWithSlashesAndLinks) {
    const TemporaryFolder folder;
    write_example(folder / "maps/");
    EXPECT_TRUE(is_filtered_set(folder / "maps"));
    EXPECT_TRUE(is_filtered_set(folder / "maps/"));
    fs::create_directory_symlink(folder / "maps", folder / "link");
    write_example(folder / "link", 2);
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    expect_same(read_filtered_set(folder / "maps"), example_set(2));
    EXPECT_THAT(folder.names(), ElementsAre("link", "maps"));
}

TEST(FilteredSetFile, AFullDiskLeavesTheOldSet) {
    const TemporaryFolder folder;
    write_example(folder / "maps", 1);
    const int result = in_child([&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{100000, 100000}; // the largest map is 1.7 MB
        ::setrlimit(RLIMIT_FSIZE, &small);
        try {
            write_example(folder / "maps", 2);
        } catch (const RuntimeFailure& failure) {
            const std::string message = failure.what();
            return message.starts_with((folder / "maps/radiance_n8192.exr").string()) &&
                           message.find("free some space") != std::string::npos
                       ? 0
                       : 1;
        }
        return 2;
    });
    EXPECT_EQ(result, 0);
    EXPECT_THAT(folder.names(), ElementsAre("maps"));
    expect_same(read_filtered_set(folder / "maps"), example_set(1));
}

TEST(FilteredSetFile, AnInterruptLeavesNothing) {
    const TemporaryFolder folder;
    const std::vector<std::string> names{"a", "b"};
    StagedFolder staged(folder / "maps", names);
    write_bytes(staged.path() / "a", "1");
    const TemporaryFile half_written(staged.path() / "b");
    EXPECT_THAT(folder.names(), SizeIs(1));
    remove_temporaries();
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(FilteredSetFile, AnUnfinishedFolderGoesWithItsOwner) {
    const TemporaryFolder folder;
    {
        const std::vector<std::string> names{"a"};
        StagedFolder staged(folder / "maps", names);
        write_bytes(staged.path() / "a", "1");
    }
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(FilteredSetFile, WritesOnlyWholeMaps) {
    const TemporaryFolder folder;
    FilteredSet set = example_set();
    set.irradiance.pop_back();
    EXPECT_THROW(write_filtered_set(folder / "maps", set, example_tables()), std::invalid_argument);
    AmbientTables tables = example_tables();
    tables.linear.clear();
    EXPECT_THROW(write_filtered_set(folder / "maps", example_set(), tables), std::invalid_argument);
    EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(FilteredSetFile, OtherThingsAreNoSets) {
    const TemporaryFolder folder;
    EXPECT_FALSE(is_filtered_set(folder / "none"));
    EXPECT_FALSE(is_filtered_set(folder.path()));
    write_bytes(folder / "a.exr", "text");
    EXPECT_FALSE(is_filtered_set(folder / "a.exr"));
}

TEST(FilteredSetFile, EveryFileIsMissed) {
    const TemporaryFolder folder;
    write_example(folder / "maps");
    for (const auto& entry : fs::directory_iterator(folder / "maps")) {
        fs::rename(entry.path(), folder / "aside");
        EXPECT_FALSE(is_filtered_set(folder / "maps")) << entry.path();
        EXPECT_THAT(failure(folder / "maps"), AllOf(HasSubstr(entry.path().string()), HasSubstr("is missing")));
        fs::rename(folder / "aside", entry.path());
    }
    EXPECT_TRUE(is_filtered_set(folder / "maps"));
    fs::remove(folder / "maps/irradiance.exr");
    EXPECT_THAT(failure_of([&] { static_cast<void>(read_lat_long(folder / "maps", 0, false)); }),
                HasSubstr("run `clshade prefilter` again"));
}

TEST(FilteredSetFile, DamagedFilesAreNamed) {
    const TemporaryFolder folder;
    write_example(folder / "maps");
    for (const char* name :
         {"radiance_n8192.exr", "radiance_n0001.exr", "irradiance.exr", "sh.exr", "ambient_brdf.exr"}) {
        const fs::path file = folder / "maps" / name;
        const std::string whole = bytes_of_file(file);
        for (const std::size_t size : {std::size_t{0}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
            write_bytes(file, whole.substr(0, size));
            EXPECT_THAT(failure(folder / "maps"), AllOf(HasSubstr(file.string()), Not(HasSubstr("\n")))) << size;
        }
        write_bytes(file, whole);
    }
    expect_same(read_filtered_set(folder / "maps"), example_set());
}

/// What is said of a good set after `action` on one of its files, which is then put right again.
std::string failure_after(const fs::path& set, const std::string& name, const std::function<void()>& action) {
    const std::string whole = bytes_of_file(set / name);
    action();
    std::string said = failure(set);
    write_bytes(set / name, whole);
    return said;
}

std::string failure_with(const fs::path& set, const std::string& name,
                         const std::function<void(OutputImage&, PlaneSlab&)>& action) {
    return failure_after(set, name, [&] { change(set / name, action); });
}

TEST(FilteredSetFile, BadValuesAreRefused) {
    const TemporaryFolder folder;
    const fs::path maps = folder / "maps";
    write_example(maps);
    for (const char* name : {"radiance_n0032.exr", "irradiance.exr", "ambient_brdf.exr"}) {
        for (const float value :
             {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e-6F}) {
            EXPECT_THAT(failure_with(maps, name, [&](OutputImage&, PlaneSlab& planes) { planes.at(1, 3, 4) = value; }),
                        AllOf(HasSubstr(name), HasSubstr("holds the value")))
                << value;
        }
    }
    EXPECT_THAT(failure_with(maps, "sh.exr", [](OutputImage&, PlaneSlab& planes) { planes.at(1, 3, 0) += 1.0F; }),
                AllOf(HasSubstr("sh.exr"), HasSubstr("pixel 3")));
    for (const char* text : {"", "1 2 3", "nan", "1 2 x"}) {
        EXPECT_THAT(failure_with(maps, "sh.exr",
                                 [&](OutputImage& image, PlaneSlab&) { image.attributes["clshade/sh"] = text; }),
                    AllOf(HasSubstr("sh.exr"), HasSubstr("clshade/sh is damaged")))
            << text;
    }
    for (const char* text : {"1 2 3 4", "1 2 inf", "1 2"}) {
        EXPECT_THAT(
            failure_with(maps, "sh.exr",
                         [&](OutputImage& image, PlaneSlab&) { image.attributes["clshade/mean_radiance"] = text; }),
            HasSubstr("clshade/mean_radiance is damaged"))
            << text;
    }
    expect_same(read_filtered_set(maps), example_set());
}

TEST(FilteredSetFile, MixedUpFilesAreTold) {
    const TemporaryFolder folder;
    const fs::path maps = folder / "maps";
    write_example(maps);
    write_example(folder / "other", 2);
    const auto failure_from = [&](const fs::path& from, const std::string& name) {
        return failure_after(maps, name,
                             [&] { fs::copy_file(from, maps / name, fs::copy_options::overwrite_existing); });
    };
    for (const char* name : {"radiance_n0008.exr", "irradiance.exr", "ambient_brdf.exr"}) {
        EXPECT_THAT(failure_from(folder / "other" / name, name),
                    AllOf(HasSubstr(name), HasSubstr("another environment than sh.exr")));
    }
    EXPECT_THAT(failure_from(maps / "radiance_n4096.exr", "radiance_n8192.exr"), // of the same size
                AllOf(HasSubstr("radiance_n8192.exr"), HasSubstr("n = 4096")));
    EXPECT_THAT(
        failure_from(maps / "radiance_n4096.exr", "radiance_n0001.exr"),
        AllOf(HasSubstr("radiance_n0001.exr"), HasSubstr(fmt::format("has {0}x{0} vertices instead of {1}x{1}",
                                                                     level_cells(1) + 1, level_cells(13) + 1))));
    expect_same(read_filtered_set(maps), example_set());
}

TEST(FilteredSetFile, OtherConventionsAreRefused) {
    const TemporaryFolder folder;
    const fs::path maps = folder / "maps";
    write_example(maps);
    for (const char* key : {"clshade/maps", "clshade/axes", "clshade/sh_basis", "clshade/up"}) {
        EXPECT_THAT(
            failure_with(maps, "sh.exr", [&](OutputImage& image, PlaneSlab&) { image.attributes[key] = "other"; }),
            AllOf(HasSubstr("sh.exr"), HasSubstr("other")))
            << key;
        EXPECT_THAT(failure_with(maps, "sh.exr", [&](OutputImage& image, PlaneSlab&) { image.attributes.erase(key); }),
                    AllOf(HasSubstr("sh.exr"), HasSubstr(key)))
            << key;
    }
    EXPECT_THAT(
        failure_with(maps, "irradiance.exr", [](OutputImage& image, PlaneSlab&) { image.channels[0].name = "X"; }),
        AllOf(HasSubstr("irradiance.exr"), HasSubstr("no channel")));
}

} // namespace
} // namespace clshade
