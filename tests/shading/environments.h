// Shared by the tests of environments: pictures, filtered once by the device, and frames that stand in them.
#pragma once

#include "host/environment/lat_long.h"
#include "host/gbuffer/random_gbuffer.h"
#include "host/prefilter/prefilter.h"
#include "tests/shading/agreement.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace clshade {

struct FilteredStudio {
    std::shared_ptr<const LatLong> image;
    std::shared_ptr<const FilteredSet> maps;
};

inline Prefilter& test_prefilter() {
    static Prefilter prefilter(test_device(), kernel_sources(), ProgramCache::disabled(),
                               automatic_lanes(test_device().info()));
    return prefilter;
}

inline FilteredStudio filtered(LatLong image) {
    FilteredStudio made;
    made.image = std::make_shared<const LatLong>(std::move(image));
    made.maps = std::make_shared<const FilteredSet>(test_prefilter().filter(*made.image, {}));
    return made;
}

inline const FilteredStudio& filtered_studio() {
    static const FilteredStudio studio = filtered(built_in_studio(128));
    return studio;
}

/// A picture of `height` rows whose texels are what `value` says of column and row.
inline LatLong picture_of(int height, const std::function<glm::dvec3(int, int)>& value) {
    LatLong picture;
    picture.name = "made for a test";
    picture.height = height;
    picture.width = 2 * height;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const glm::dvec3 v = value(x, y);
            for (int c = 0; c < 3; ++c) {
                picture.rgb.push_back(static_cast<float>(v[c]));
            }
        }
    }
    return picture;
}

/// Radiance 1 from everywhere.
inline const FilteredStudio& white_furnace() {
    static const FilteredStudio furnace = filtered(picture_of(8, [](int, int) { return glm::dvec3(1.0); }));
    return furnace;
}

/// Puts the frame into an environment, unturned and as bright as it is.
inline void stand_in(Frame& frame, const FilteredStudio& place, AmbientSource diffuse = AmbientSource::sh2) {
    BoundEnvironment environment;
    environment.image = place.image;
    environment.maps = place.maps;
    environment.diffuse = diffuse;
    frame.environment = std::move(environment);
}

/// Puts the frame into an environment, turned at random.
inline void surround(Frame& frame, AmbientSource diffuse, std::uint64_t seed,
                     const FilteredStudio& place = filtered_studio()) {
    add_random_environment(frame, place.image, diffuse, seed);
    frame.environment->maps = place.maps;
}

/// What the reference says of a frame, to compare several pictures with.
struct ExpectedPicture {
    AovSelection aovs;
    reference::Image image;
    reference::RoundingScale scale;
    reference::Tolerance tolerance;
};

inline ExpectedPicture expected_of(const Frame& frame, const AovSelection& aovs) {
    return {aovs, reference::shade(frame, aovs, 2), reference::rounding_scale(frame, 2), tolerance_of(frame)};
}

/// At least 99.9 % of the pixels within 1e-4, none beyond four times that (reference/tolerance.h); of every material
/// by itself.
inline void expect_as_expected(const ShadedImage& device, const ExpectedPicture& expected, const Frame& frame,
                               const std::string& what) {
    for (int m = -1; m < static_cast<int>(frame.materials.size()); ++m) {
        std::vector<std::uint8_t> selected;
        for (const int material : expected.image.material) {
            selected.push_back(material == m ? 1 : 0);
        }
        if (std::count(selected.begin(), selected.end(), 1) == 0) {
            continue;
        }
        const reference::Tolerance tolerance =
            m < 0 ? reference::background_tolerance(frame.environment && frame.environment->background)
                  : expected.tolerance;
        const std::string whose = m < 0 ? "no surface" : model_key(frame.materials[static_cast<std::size_t>(m)]);
        for (int plane = 0; plane + 3 <= device.planes.count(); plane += plane == 0 ? 4 : 3) {
            const auto result =
                reference::compare(device.planes, expected.image, expected.scale, tolerance, selected, plane, 3);
            EXPECT_TRUE(reference::passes(result, tolerance))
                << what << ", " << whose << ", plane " << device.plane_names[static_cast<std::size_t>(plane)] << ": "
                << result.outside << " of " << result.pixels << " pixels outside, worst at " << result.worst.x << ","
                << result.worst.y << ": " << result.worst.device << " for " << result.worst.reference
                << describe_worst(frame, result.worst);
        }
    }
    for (int y = 0; y < expected.image.height; ++y) {
        for (int x = 0; x < expected.image.width; ++x) {
            const double alpha = expected.image.planes[3][static_cast<std::size_t>(y) * expected.image.width + x];
            EXPECT_EQ(device.planes.at(3, x, y), static_cast<float>(alpha)) << what << " alpha at " << x << "," << y;
        }
    }
    EXPECT_EQ(device.counts.nonfinite, expected.image.counts.nonfinite) << what;
    EXPECT_EQ(device.counts.clamped, expected.image.counts.clamped) << what;
    EXPECT_EQ(device.counts.no_tangent, expected.image.counts.no_tangent) << what;
}

inline constexpr AovSelection all_aovs{.diffuse = true, .specular = true, .lights = true, .environment = true};

/// Device against reference with all AOVs. `lanes` 0: the widest.
inline void expect_environment_agreement(Frame& frame, int lanes, const std::string& what) {
    expect_as_expected(shade(frame, lanes, all_aovs), expected_of(frame, all_aovs), frame, what);
}

/// The largest difference of any channel, in proportion to it or, where it is smaller, to `floor`.
inline double largest_difference(const ShadedImage& a, const ShadedImage& b, double floor) {
    double largest = 0.0;
    for (int plane = 0; plane < a.planes.count(); ++plane) {
        for (int y = 0; y < a.planes.height(); ++y) {
            for (int x = 0; x < a.planes.width(); ++x) {
                const auto p = static_cast<double>(a.planes.at(plane, x, y));
                const auto q = static_cast<double>(b.planes.at(plane, x, y));
                largest = std::max(largest, std::abs(p - q) / std::max(std::abs(p), floor));
            }
        }
    }
    return largest;
}

inline bool same_bytes(const ShadedImage& a, const ShadedImage& b) {
    return a.planes.all().size() == b.planes.all().size() &&
           std::memcmp(a.planes.data(), b.planes.data(), a.planes.all().size_bytes()) == 0;
}

inline BoundParameter constant_of(const glm::dvec3& value) {
    BoundParameter parameter;
    parameter.constant = value;
    return parameter;
}

inline BoundParameter constant_of(double value) {
    return constant_of(glm::dvec3(value));
}

/// One more plane for the frame, filled by `value` of a pixel.
inline PlaneIndex add_plane(Frame& frame, const std::string& name, const std::function<float(int, int)>& value) {
    const int count = frame.planes.count();
    PlaneSlab planes(frame.planes.width(), frame.planes.height(), count + 1);
    for (int p = 0; p < count; ++p) {
        std::copy(frame.planes.plane(p).begin(), frame.planes.plane(p).end(), planes.plane(p).begin());
    }
    for (int y = 0; y < planes.height(); ++y) {
        for (int x = 0; x < planes.width(); ++x) {
            planes.at(count, x, y) = value(x, y);
        }
    }
    frame.planes = std::move(planes);
    frame.plane_names.push_back(name);
    return count;
}

/// Gives the frame these materials, by id, in turns of three columns.
inline void spread_materials(Frame& frame, std::vector<BoundMaterial> materials) {
    const int count = static_cast<int>(materials.size());
    for (int i = 0; i < count; ++i) {
        auto& material = materials[static_cast<std::size_t>(i)];
        material.name += std::to_string(i);
        material.ids = {i};
    }
    frame.materials = std::move(materials);
    frame.roles.material_id =
        add_plane(frame, "id", [count](int x, int y) { return static_cast<float>((x / 3 + 7 * y) % count); });
}

} // namespace clshade
