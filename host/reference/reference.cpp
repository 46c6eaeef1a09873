#include "host/reference/reference.h"

#include "host/reference/angles.h"
#include "host/reference/brdf.h"
#include "host/reference/environment_light.h"
#include "host/reference/lights.h"
#include "host/reference/rows.h"
#include "host/reference/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clshade::reference {

namespace {

bool fits_in_float(const glm::dvec3& v) {
    const auto fits = [](double c) { return std::abs(c) <= static_cast<double>(std::numeric_limits<float>::max()); };
    return fits(v.x) && fits(v.y) && fits(v.z);
}

Pixel unusable_pixel(const AovSelection& aovs, std::size_t lights) {
    Pixel pixel;
    if (aovs.lights) {
        pixel.lights.assign(lights, glm::dvec3(0.0));
    }
    return pixel;
}

/// Adds one source's share to the sums of rule 10.
void add(const glm::dvec3& diffuse, const glm::dvec3& specular, Pixel& pixel) {
    pixel.diffuse += diffuse;
    pixel.specular += specular;
}

/// Rule 10 for a pixel with a surface.
Pixel shade_surface(const PreparedFrame& prepared, const Surface& surface, int x, int y, const AovSelection& aovs) {
    const Frame& frame = prepared.frame();
    Pixel pixel = unusable_pixel(aovs, frame.lights.size());
    const MaterialValues material = read_material(prepared, surface, x, y);
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
        const Incident light = incident_light(frame.lights[i], surface.position);
        const Angles angles = angles_between(surface.normal, surface.eye, light.direction);
        const Reflected reflected = reflect(material, angles);
        const glm::dvec3 weight = light.irradiance * surface.coverage;
        add(reflected.diffuse * weight, reflected.specular * weight, pixel);
        if (aovs.lights) {
            pixel.lights[i] = (reflected.diffuse + reflected.specular) * weight;
        }
    }
    if (const PreparedEnvironment* environment = prepared.environment()) {
        const EnvironmentLight light = environment_light(material, *environment, surface.normal, surface.eye);
        add(light.diffuse * surface.coverage, light.specular * surface.coverage, pixel);
        pixel.environment = (light.diffuse + light.specular) * surface.coverage;
    }
    pixel.radiance = pixel.diffuse + pixel.specular + read_emission(frame, surface, x, y) * surface.coverage;
    pixel.alpha = surface.coverage;
    pixel.material = surface.material;
    pixel.clamped = material.clamped;
    pixel.fractional_id = surface.fractional_id;
    pixel.no_tangent = material.no_tangent;
    return pixel;
}

Pixel shade_with(const PreparedFrame& prepared, int x, int y, const AovSelection& aovs) {
    const Frame& frame = prepared.frame();
    Pixel pixel = unusable_pixel(aovs, frame.lights.size());
    if (!all_finite(prepared, x, y)) {
        pixel.nonfinite = true;
        return pixel;
    }
    if (const std::optional<Surface> surface = read_surface(frame, x, y)) {
        pixel = shade_surface(prepared, *surface, x, y, aovs);
    }
    const PreparedEnvironment* environment = prepared.environment();
    if (environment != nullptr && environment->bound().background) { // rule 12
        pixel.radiance += (1.0 - pixel.alpha) * environment->background(ray_direction(frame, x, y));
        pixel.alpha = 1.0;
    }
    if (!fits_in_float(pixel.radiance)) { // every part is non-negative, so no AOV is larger
        pixel = unusable_pixel(aovs, frame.lights.size());
        pixel.nonfinite = true;
    }
    return pixel;
}

/// Writes a pixel's outputs in the order of output_plane_names.
void store(const Pixel& pixel, const AovSelection& aovs, std::size_t at, std::vector<std::vector<double>>& planes) {
    // Planes are in the order of output_plane_names, that of the environment last: there only if the frame has one.
    std::size_t plane = 0;
    const auto put = [&](const glm::dvec3& v) {
        for (int i = 0; i < 3; ++i) {
            planes[plane++][at] = v[i];
        }
    };
    put(pixel.radiance);
    planes[plane++][at] = pixel.alpha;
    if (aovs.diffuse) {
        put(pixel.diffuse);
    }
    if (aovs.specular) {
        put(pixel.specular);
    }
    for (const glm::dvec3& light : pixel.lights) {
        put(light);
    }
    if (plane < planes.size()) {
        put(pixel.environment);
    }
}

void count(const Pixel& pixel, PixelCounts& counts) {
    counts.nonfinite += pixel.nonfinite ? 1U : 0U;
    counts.clamped += pixel.clamped ? 1U : 0U;
    counts.fractional_ids += pixel.fractional_id ? 1U : 0U;
    counts.no_tangent += pixel.no_tangent ? 1U : 0U;
}

std::size_t plane_count(const Frame& frame, const AovSelection& aovs) {
    return 4 + (aovs.diffuse ? 3U : 0U) + (aovs.specular ? 3U : 0U) + (aovs.lights ? 3 * frame.lights.size() : 0U) +
           (aovs.environment && frame.environment ? 3U : 0U);
}

} // namespace

Pixel shade_pixel(const Frame& frame, int x, int y, const AovSelection& aovs) {
    return shade_with(PreparedFrame(frame), x, y, aovs);
}

Image shade(const Frame& frame, const AovSelection& aovs, int threads) {
    Image image;
    image.width = frame.planes.width();
    image.height = frame.planes.height();
    const auto width = static_cast<std::size_t>(image.width);
    const std::size_t pixels = width * static_cast<std::size_t>(image.height);
    image.planes.assign(plane_count(frame, aovs), std::vector<double>(pixels, 0.0));
    image.material.assign(pixels, -1);

    const PreparedFrame prepared(frame);
    std::vector<PixelCounts> row_counts(static_cast<std::size_t>(image.height));
    const auto shade_row = [&](int y) {
        const auto row = static_cast<std::size_t>(y);
        for (int x = 0; x < image.width; ++x) {
            const Pixel pixel = shade_with(prepared, x, y, aovs);
            const std::size_t at = row * width + static_cast<std::size_t>(x);
            store(pixel, aovs, at, image.planes);
            image.material[at] = pixel.material;
            count(pixel, row_counts[row]);
        }
    };
    for_each_row(image.height, threads, shade_row);

    for (const PixelCounts& row : row_counts) {
        image.counts.nonfinite += row.nonfinite;
        image.counts.clamped += row.clamped;
        image.counts.fractional_ids += row.fractional_ids;
        image.counts.no_tangent += row.no_tangent;
    }
    return image;
}

} // namespace clshade::reference
