// Results on disk: found again, told apart, and made anew when in doubt.
#include "host/shading/kernel_library.h"
#include "host/shading/shader.h"
#include "tests/device/temporary_folder.h"
#include "tests/prefilter/support.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace clshade::tests {
namespace {

namespace fs = std::filesystem;

class PrefilterCache : public ::testing::Test {
  protected:
    [[nodiscard]] Prefilter prefilter() const {
        return {cpu_device(), kernel_sources(), ProgramCache(folder_.path()), automatic_lanes(cpu_device().info())};
    }

    FilteredSet filter(const LatLong& image, bool expect_cached) {
        PrefilterReport report;
        FilteredSet set = prefilter().filter(image, {}, &report);
        EXPECT_EQ(report.from_cache, expect_cached);
        return set;
    }

    /// The largest file of the cache: a set's maps are larger than any program.
    [[nodiscard]] fs::path largest() const {
        fs::path found;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
            if (found.empty() || entry.file_size() > fs::file_size(found)) {
                found = entry.path();
            }
        }
        return found;
    }

    void expect_same(const FilteredSet& a, const FilteredSet& b) {
        EXPECT_EQ(a.radiance, b.radiance);
        EXPECT_EQ(a.irradiance, b.irradiance);
        EXPECT_EQ(a.sh, b.sh);
        EXPECT_EQ(a.mean, b.mean);
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.hash, b.hash);
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(PrefilterCache, FindsWhatItStored) {
    const LatLong image = random_picture(32, 1);
    const FilteredSet made = filter(image, false);
    EXPECT_EQ(made.hash, content_hash(image));
    EXPECT_EQ(made.name, "test");
    expect_same(filter(image, true), made);
}

TEST_F(PrefilterCache, AnotherPictureIsAnotherEntry) {
    LatLong image = random_picture(32, 1);
    const FilteredSet first = filter(image, false);
    set_texel(image, 3, 4, {9.0, 9.0, 9.0});
    EXPECT_NE(filter(image, false).radiance, first.radiance);
}

TEST_F(PrefilterCache, NameAndAxisAreThePictures) {
    LatLong image = random_picture(32, 1);
    EXPECT_FALSE(filter(image, false).up.has_value());
    image.name = "renamed";
    image.up = UpAxis::y;
    const FilteredSet again = filter(image, true);
    EXPECT_EQ(again.name, "renamed");
    EXPECT_EQ(again.up, UpAxis::y);
}

TEST_F(PrefilterCache, EntryCutShortIsMadeAnew) {
    const LatLong image = random_picture(32, 1);
    const FilteredSet made = filter(image, false);
    fs::resize_file(largest(), fs::file_size(largest()) / 2);
    expect_same(filter(image, false), made);
    expect_same(filter(image, true), made);
}

TEST_F(PrefilterCache, CorruptedEntryIsMadeAnew) {
    const LatLong image = random_picture(32, 1);
    const FilteredSet made = filter(image, false);
    {
        std::fstream file(largest(), std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(100000);
        file.put('x');
        file.put('y');
    }
    expect_same(filter(image, false), made);
}

TEST_F(PrefilterCache, AmbientTablesComeBackTheSame) {
    const AmbientTables made = prefilter().ambient_tables();
    const auto entries = std::distance(fs::directory_iterator(largest().parent_path()), fs::directory_iterator());
    const AmbientTables again = prefilter().ambient_tables();
    EXPECT_EQ(again.exact, made.exact);
    EXPECT_EQ(again.linear, made.linear);
    EXPECT_EQ(std::distance(fs::directory_iterator(largest().parent_path()), fs::directory_iterator()), entries);
}

TEST_F(PrefilterCache, CurvesAreToldApart) {
    const ReflectanceCurve half{1.0, {glm::dvec3(0.5)}};
    const ReflectanceCurve full{1.0, {glm::dvec3(1.0)}};
    const std::vector<float> first = prefilter().spectral_table(half, false);
    EXPECT_EQ(prefilter().spectral_table(half, false), first);
    EXPECT_NE(prefilter().spectral_table(full, false), first);
    EXPECT_NE(prefilter().spectral_table(half, true), first);
}

} // namespace
} // namespace clshade::tests
