#include "host/reference/picture.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace clshade::reference {

namespace {

constexpr double pi = std::numbers::pi;

std::size_t index_of(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

glm::dvec3 texel_of(const LatLong& image, int x, int y) {
    const float* rgb = image.rgb.data() + 3 * index_of(x, y, image.width);
    return {rgb[0], rgb[1], rgb[2]};
}

glm::dvec3 texel_of(const Picture& picture, int x, int y) {
    return picture.at(x, y);
}

/// A texel that may lie beyond an edge: u wraps, a row beyond a pole is the nearest one, half a turn on.
template <class Image>
glm::dvec3 texel_around(const Image& image, int x, int y) {
    if (y < 0 || y >= image.height) {
        x += image.width / 2;
        y = y < 0 ? 0 : image.height - 1;
    }
    return texel_of(image, (x % image.width + image.width) % image.width, y);
}

/// Bilinear at a place in texels, (0, 0) being the centre of the first one.
template <class Image>
glm::dvec3 between_texels(const Image& image, double px, double py) {
    const double fx = std::floor(px);
    const double fy = std::floor(py);
    const int x = static_cast<int>(fx);
    const int y = static_cast<int>(fy);
    const double u = px - fx;
    const double v = py - fy;
    const glm::dvec3 upper = texel_around(image, x, y) * (1.0 - u) + texel_around(image, x + 1, y) * u;
    const glm::dvec3 lower = texel_around(image, x, y + 1) * (1.0 - u) + texel_around(image, x + 1, y + 1) * u;
    return upper * (1.0 - v) + lower * v;
}

template <class Image>
glm::dvec3 along(const Image& image, const glm::dvec3& d) {
    const double u = 0.5 - std::atan2(d.y, d.x) / (2.0 * pi);
    const double v = std::atan2(std::hypot(d.x, d.y), d.z) / pi; // acos(d.z), good near the poles too
    return between_texels(image, u * image.width - 0.5, v * image.height - 0.5);
}

} // namespace

double azimuth_of_column(double x, int width) {
    return 2.0 * pi * (0.5 - (x + 0.5) / width);
}

double polar_angle_of_row(double y, int height) {
    return pi * (y + 0.5) / height;
}

glm::dvec3 direction_of(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double solid_angle_of_texel(int width, int height, int y) {
    // cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2)
    return 2.0 * pi / width * 2.0 * std::sin(polar_angle_of_row(y, height)) * std::sin(0.5 * pi / height);
}

Picture::Picture(int w, int h) : width(w), height(h), texels(index_of(0, h, w), glm::dvec3(0.0)) {}

Picture::Picture(const LatLong& image) : Picture(image.width, image.height) {
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            at(x, y) = texel_of(image, x, y);
        }
    }
}

glm::dvec3& Picture::at(int x, int y) {
    return texels[index_of(x, y, width)];
}

const glm::dvec3& Picture::at(int x, int y) const {
    return texels[index_of(x, y, width)];
}

Picture halved(const Picture& picture) {
    Picture half(picture.width / 2, picture.height / 2);
    for (int y = 0; y < half.height; ++y) {
        const double upper = solid_angle_of_texel(picture.width, picture.height, 2 * y);
        const double lower = solid_angle_of_texel(picture.width, picture.height, 2 * y + 1);
        for (int x = 0; x < half.width; ++x) {
            const glm::dvec3 above = picture.at(2 * x, 2 * y) + picture.at(2 * x + 1, 2 * y);
            const glm::dvec3 below = picture.at(2 * x, 2 * y + 1) + picture.at(2 * x + 1, 2 * y + 1);
            half.at(x, y) = (above * upper + below * lower) / (2.0 * (upper + lower));
        }
    }
    return half;
}

Picture doubled(const Picture& picture) {
    Picture twice(picture.width * 2, picture.height * 2);
    for (int y = 0; y < twice.height; ++y) {
        for (int x = 0; x < twice.width; ++x) {
            twice.at(x, y) = between_texels(picture, 0.5 * x - 0.25, 0.5 * y - 0.25);
        }
    }
    return twice;
}

glm::dvec3 radiance_along(const LatLong& image, const glm::dvec3& direction) {
    return along(image, direction);
}

glm::dvec3 radiance_along(const Picture& picture, const glm::dvec3& direction) {
    return along(picture, direction);
}

} // namespace clshade::reference
