#include "host/environment/sh.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace clshade {

namespace {

/// Of a column's azimuth p.
struct Azimuth {
    double cos1, sin1; ///< of p
    double cos2, sin2; ///< of 2 p
};

std::vector<Azimuth> azimuths(int width) {
    std::vector<Azimuth> columns(static_cast<std::size_t>(width));
    for (int x = 0; x < width; ++x) {
        const double p = std::numbers::pi * (1.0 - 2.0 * (x + 0.5) / width); // u = 0.5 - p/(2 pi)
        columns[static_cast<std::size_t>(x)] = {std::cos(p), std::sin(p), std::cos(2.0 * p), std::sin(2.0 * p)};
    }
    return columns;
}

/// Fourier sums of one row.
struct RowSums {
    glm::dvec3 constant{0.0}, cos1{0.0}, sin1{0.0}, cos2{0.0}, sin2{0.0};
};

glm::dvec3 texel(const float* rgb) {
    return {static_cast<double>(rgb[0]), static_cast<double>(rgb[1]), static_cast<double>(rgb[2])};
}

RowSums sum_row(const float* row, const std::vector<Azimuth>& columns) {
    RowSums sums;
    for (const Azimuth& column : columns) {
        const glm::dvec3 radiance = texel(row);
        sums.constant += radiance;
        sums.cos1 += column.cos1 * radiance;
        sums.sin1 += column.sin1 * radiance;
        sums.cos2 += column.cos2 * radiance;
        sums.sin2 += column.sin2 * radiance;
        row += 3;
    }
    return sums;
}

} // namespace

std::array<glm::dvec3, 9> sh_of(const LatLong& image) {
    // With d = (s cos p, s sin p, z) every Y_lm is a function of the row times 1, cos p, sin p, cos 2p or sin 2p:
    // x = s cos p, y = s sin p, xy = s^2 sin 2p / 2, x^2 - y^2 = s^2 cos 2p.
    const std::vector<Azimuth> columns = azimuths(image.width);
    std::array<glm::dvec3, 9> sums{};
    for (int y = 0; y < image.height; ++y) {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) * 3;
        const RowSums fourier = sum_row(image.rgb.data() + row, columns);
        const double theta = std::numbers::pi * (y + 0.5) / image.height;
        const double s = std::sin(theta);
        const double z = std::cos(theta);
        const double dw = texel_solid_angle(image.width, image.height, y);
        sums[0] += dw * fourier.constant;
        sums[1] += dw * s * fourier.sin1;
        sums[2] += dw * z * fourier.constant;
        sums[3] += dw * s * fourier.cos1;
        sums[4] += dw * 0.5 * s * s * fourier.sin2;
        sums[5] += dw * s * z * fourier.sin1;
        sums[6] += dw * (3.0 * z * z - 1.0) * fourier.constant;
        sums[7] += dw * s * z * fourier.cos1;
        sums[8] += dw * s * s * fourier.cos2;
    }
    // models.md section 6, with all digits: sqrt(1/4pi), sqrt(3/4pi), sqrt(15/4pi), sqrt(5/16pi), sqrt(15/16pi).
    const double pi = std::numbers::pi;
    const double y0 = std::sqrt(1.0 / (4.0 * pi));
    const double y1 = std::sqrt(3.0 / (4.0 * pi));
    const double y2 = std::sqrt(15.0 / (4.0 * pi));
    const std::array<double, 9> scale{y0, y1, y1, y1, y2, y2, std::sqrt(5.0 / (16.0 * pi)), y2, 0.5 * y2};
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] *= scale[i];
    }
    return sums;
}

glm::dvec3 mean_radiance(const LatLong& image) {
    glm::dvec3 sum(0.0);
    for (int y = 0; y < image.height; ++y) {
        const float* row = image.rgb.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) * 3;
        glm::dvec3 line(0.0);
        for (int x = 0; x < image.width; ++x) {
            line += texel(row + 3 * static_cast<std::ptrdiff_t>(x));
        }
        sum += texel_solid_angle(image.width, image.height, y) * line;
    }
    return sum / (4.0 * std::numbers::pi);
}

} // namespace clshade
