#include "bench/prefilter_rival.h"

#include "host/environment/filter_layout.h"
#include "host/environment/sh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace clshade {

namespace {

constexpr double pi = std::numbers::pi;
/// n theta^2/8 beyond which filter_layout.h lets texels be left out.
constexpr double reach_exponent = 21.0;
/// Vertices that a thread takes at a time: few enough for an even end, the last of a level among them.
constexpr std::size_t chunk = 64;

/// A picture in planes, with what its rows and columns need.
class Sky {
  public:
    explicit Sky(const LatLong& image) : width_(image.width), height_(image.height) {
        const std::size_t texels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
        for (std::size_t c = 0; c < 3; ++c) {
            planes_[c].resize(texels);
            for (std::size_t i = 0; i < texels; ++i) {
                planes_[c][i] = image.rgb[3 * i + c];
            }
        }
        for (int y = 0; y < height_; ++y) {
            row_sine_.push_back(static_cast<float>(std::sin(pi * (y + 0.5) / height_)));
            row_cosine_.push_back(static_cast<float>(std::cos(pi * (y + 0.5) / height_)));
            row_area_.push_back(static_cast<float>(texel_solid_angle(width_, height_, y)));
        }
        for (int x = 0; x < width_; ++x) {
            const double azimuth = pi * (1.0 - 2.0 * (x + 0.5) / width_);
            column_sine_.push_back(static_cast<float>(std::sin(azimuth)));
            column_cosine_.push_back(static_cast<float>(std::cos(azimuth)));
        }
    }

    [[nodiscard]] rivals::SkySource view() const {
        return {width_,
                height_,
                planes_[0].data(),
                planes_[1].data(),
                planes_[2].data(),
                row_sine_.data(),
                row_cosine_.data(),
                row_area_.data(),
                column_sine_.data(),
                column_cosine_.data()};
    }

  private:
    int width_;
    int height_;
    std::array<std::vector<float>, 3> planes_;
    std::vector<float> row_sine_, row_cosine_, row_area_, column_sine_, column_cosine_;
};

rivals::SkyLobe power_lobe(double shininess, int cells) {
    const double angle = std::min(pi, std::sqrt(8.0 * reach_exponent / shininess));
    return {static_cast<float>(0.5 * shininess), static_cast<float>(std::pow(std::sin(0.5 * angle), 2.0)), false,
            cells};
}

constexpr rivals::SkyLobe cosine_lobe{0.0F, 0.5F, true, irradiance_cells};

} // namespace

FilteredSet PrefilterRival::filter(const LatLong& image) {
    FilteredSet set;
    set.name = image.name;
    LatLong source = filter_source(image, sharpest_shininess);
    std::optional<Sky> sky;
    const auto make = [&](const rivals::SkyLobe& lobe, std::vector<float>& map) {
        const auto side = static_cast<std::size_t>(lobe.cells) + 1;
        map.resize(side * side * 3);
        const rivals::SkySource view = sky->view();
        pool_.run(side * side, chunk,
                  [&](std::size_t begin, std::size_t end) { kernels_->filter(view, lobe, map.data(), begin, end); });
    };
    for (int level = 0; level < radiance_levels; ++level) {
        const double shininess = level_shininess(level);
        const int height = source_height(image.width, image.height, shininess);
        while (source.height > height) {
            source = halved(source);
            sky.reset();
        }
        if (!sky) {
            sky.emplace(source);
        }
        make(power_lobe(shininess, level_cells(level)), set.radiance[static_cast<std::size_t>(level)]);
        if (shininess == irradiance_source_shininess) {
            make(cosine_lobe, set.irradiance);
        }
    }
    set.sh = sh_of(image);
    set.mean = mean_radiance(image);
    return set;
}

} // namespace clshade
