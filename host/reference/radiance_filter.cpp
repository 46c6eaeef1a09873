#include "host/reference/radiance_filter.h"

#include "host/environment/filter_layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace clshade::reference {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double farthest = 21.0; // filter_layout.h: n theta^2/8 from which texels may be left out
constexpr int block = 256;        // texels that are worked on together

/// Columns first .. last, which may lie beyond the picture's edges: u wraps.
struct Columns {
    int first = 0;
    int last = -1;
};

/// Columns of a row at polar angle theta within `reach` of a direction (angles in radians).
Columns columns_within(double theta, const glm::dvec3& direction, double reach, int width) {
    const Columns all{0, width - 1};
    const double a = direction.z * std::cos(theta);
    const double b = std::hypot(direction.x, direction.y) * std::sin(theta);
    const double limit = reach < pi ? std::cos(reach) : -1.0;
    if (a - b >= limit) {
        return all;
    }
    if (a + b < limit) {
        return {};
    }
    const double spread = std::acos((limit - a) / b) / (2.0 * pi) * width;
    const double centre = (0.5 - std::atan2(direction.y, direction.x) / (2.0 * pi)) * width - 0.5;
    const Columns found{static_cast<int>(std::ceil(centre - spread)), static_cast<int>(std::floor(centre + spread))};
    return found.last - found.first + 1 >= width ? all : found;
}

} // namespace

double radiance_lobe(double n, double c) {
    return (n + 2.0) / (8.0 * pi) * std::pow(0.5 * (1.0 + c), 0.5 * n);
}

double mip_of_shininess(double n, double n_max, double mip_max, double octaves) {
    return std::clamp(std::log2(n_max / std::max(n, 1.0)) / octaves, 0.0, mip_max);
}

FilterSource::FilterSource(const Picture& picture) : width_(picture.width), height_(picture.height) {
    for (int i = 0; i < 3; ++i) {
        std::vector<double>& plane = rgb_[static_cast<std::size_t>(i)];
        plane.reserve(picture.texels.size());
        for (const glm::dvec3& texel : picture.texels) {
            plane.push_back(texel[i]);
        }
    }
    for (int x = 0; x < width_; ++x) {
        cos_phi_.push_back(std::cos(azimuth_of_column(x, width_)));
        sin_phi_.push_back(std::sin(azimuth_of_column(x, width_)));
    }
}

/// `kernel(c, count)` turns cosines with the direction into weights, in place.
template <class Kernel>
glm::dvec3 FilterSource::mean_under(const glm::dvec3& direction, double reach, const Kernel& kernel) const {
    const double centre = std::atan2(std::hypot(direction.x, direction.y), direction.z);
    const int top = std::max(static_cast<int>((centre - reach) / pi * height_) - 1, 0);
    const int bottom = std::min(static_cast<int>((centre + reach) / pi * height_) + 1, height_ - 1);
    std::array<double, block> weights{};
    glm::dvec3 sum(0.0);
    double total = 0.0;
    for (int y = top; y <= bottom; ++y) {
        const double theta = polar_angle_of_row(y, height_);
        const double along_z = direction.z * std::cos(theta);
        const double along_x = direction.x * std::sin(theta);
        const double along_y = direction.y * std::sin(theta);
        const Columns columns = columns_within(theta, direction, reach, width_);
        glm::dvec3 row_sum(0.0);
        double row_total = 0.0;
        for (int at = columns.first; at <= columns.last;) {
            const int x = (at % width_ + width_) % width_;
            const int count = std::min({block, columns.last - at + 1, width_ - x});
            const double* c = cos_phi_.data() + x;
            const double* s = sin_phi_.data() + x;
            for (int i = 0; i < count; ++i) {
                weights[static_cast<std::size_t>(i)] = along_z + along_x * c[i] + along_y * s[i];
            }
            kernel(weights.data(), count);
            const std::size_t first =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
            for (int i = 0; i < count; ++i) {
                const std::size_t texel = first + static_cast<std::size_t>(i);
                const double weight = weights[static_cast<std::size_t>(i)];
                row_sum += weight * glm::dvec3(rgb_[0][texel], rgb_[1][texel], rgb_[2][texel]);
                row_total += weight;
            }
            at += count;
        }
        const double dw = std::sin(theta); // solid angle of the row's texels but for a factor that all rows share
        sum += row_sum * dw;
        total += row_total * dw;
    }
    return sum / total;
}

glm::dvec3 FilterSource::radiance(const glm::dvec3& direction, int squarings) const {
    const double n = std::exp2(squarings + 1.0);
    const auto lobe = [squarings](double* values, int count) {
        for (int i = 0; i < count; ++i) {
            values[i] = 0.5 + 0.5 * values[i];
        }
        if (squarings < 0) {
            for (int i = 0; i < count; ++i) {
                values[i] = std::sqrt(std::max(values[i], 0.0));
            }
        }
        for (int k = 0; k < squarings; ++k) {
            for (int i = 0; i < count; ++i) {
                values[i] *= values[i];
            }
        }
    };
    return mean_under(direction, std::sqrt(8.0 * farthest / n), lobe);
}

glm::dvec3 FilterSource::irradiance_over_pi(const glm::dvec3& normal) const {
    const auto cosine = [](double* values, int count) {
        for (int i = 0; i < count; ++i) {
            values[i] = std::max(values[i], 0.0);
        }
    };
    return mean_under(normal, 0.5 * pi, cosine);
}

Picture enlarged(Picture picture) {
    while (picture.height < smallest_source_height) {
        picture = doubled(picture);
    }
    return picture;
}

bool halves_for(const Picture& picture, double shininess) {
    const double deviation = 2.0 / std::sqrt(shininess);
    return picture.even() && pi / (0.5 * picture.height) <= deviation / texels_per_deviation;
}

} // namespace clshade::reference
