#include "host/reference/ground_truth.h"

#include "host/base/error.h"
#include "host/reference/angles.h"
#include "host/reference/brdf.h"
#include "host/reference/picture.h"
#include "host/reference/rows.h"
#include "host/reference/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <tuple>
#include <utility>

namespace clshade::reference {

namespace {

constexpr int most_rows = 512;
constexpr double texels_per_lobe = 4.0; // in a lobe's deviation
constexpr double lobe_end = 30.0;       // -n log N.H from which a lobe is dark
constexpr int most_parts = 32;          // of a texel's side

double luminance(const glm::dvec3& rgb) {
    return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)); // Rec.709
}

/// Exponent of a layer's lobe where it is narrowest; -1 where nothing reflects.
double sharpest_exponent(const LayerValues& layer) {
    if (!glm::any(layer.interface.present)) {
        return -1.0;
    }
    return layer.specular == SpecularModel::blinn_phong_anisotropic ? std::max(layer.shininess_u, layer.shininess_v)
                                                                    : layer.shininess;
}

double sharpest_exponent(const MaterialValues& material) {
    double sharpest = -1.0;
    for (const LayerValues& layer : material.layers()) {
        sharpest = std::max(sharpest, sharpest_exponent(layer));
    }
    return sharpest;
}

/// Sums environment times BRDF for one pixel.
class Integrator {
  public:
    Integrator(const Picture& picture, const BoundEnvironment& environment)
        : picture_(&picture), intensity_(environment.intensity),
          image_to_world_(glm::transpose(environment.world_to_image)) {}

    [[nodiscard]] EnvironmentLight integrate(const MaterialValues& material, const glm::dvec3& normal,
                                             const glm::dvec3& eye) const {
        EnvironmentLight sum;
        for (int y = 0; y < picture_->height; ++y) {
            const double theta = polar_angle_of_row(y, picture_->height);
            const double dw = solid_angle_of_texel(picture_->width, picture_->height, y);
            for (int x = 0; x < picture_->width; ++x) {
                const glm::dvec3 d = image_to_world_ * direction_of(theta, azimuth_of_column(x, picture_->width));
                const Angles angles = angles_between(normal, eye, d);
                if (angles.nl < -2.0 * std::numbers::pi / picture_->height) {
                    continue; // all of the texel below the horizon
                }
                const int parts = parts_of_texel(material, angles);
                if (parts > 1) {
                    add_parts(material, normal, eye, x, y, parts, sum);
                } else {
                    add(material, angles, picture_->at(x, y) * dw, sum);
                }
            }
        }
        sum.diffuse *= intensity_;
        sum.specular *= intensity_;
        return sum;
    }

  private:
    static void add(const MaterialValues& material, const Angles& angles, const glm::dvec3& irradiance,
                    EnvironmentLight& sum) {
        const Reflected reflected = reflect(material, angles);
        sum.diffuse += reflected.diffuse * irradiance;
        sum.specular += reflected.specular * irradiance;
    }

    /// Into how many parts a texel's sides must be cut for every lobe that is bright there. A lobe of deviation 1/sqrt
    /// n in H is 2/sqrt n wide in L along the plane of E and L, and 2 EH/sqrt n across.
    [[nodiscard]] int parts_of_texel(const MaterialValues& material, const Angles& angles) const {
        if (angles.nh <= 0.0) {
            return 1;
        }
        const double size = std::numbers::pi / picture_->height;
        // H turns by dL/|L + E| = dL/(2 EH): the brightest place in the texel is that much nearer to N than its centre.
        const double eh = std::max(angles.eh, 0.05);
        const double nearer = 0.5 * std::numbers::sqrt2 * size / (2.0 * eh);
        const double log_nh = std::log(std::cos(std::max(std::acos(std::min(angles.nh, 1.0)) - nearer, 0.0)));
        double parts = 1.0;
        for (const LayerValues& layer : material.layers()) {
            const double n = sharpest_exponent(layer);
            const double here = layer.specular == SpecularModel::blinn_phong_anisotropic
                                    ? anisotropic_exponent(angles, layer.frame, layer.shininess_u, layer.shininess_v)
                                    : n;
            if (n > 0.0 && -here * log_nh < lobe_end) {
                const double deviation = 2.0 / std::sqrt(n) * eh;
                parts = std::max(parts, std::ceil(size * texels_per_lobe / deviation));
            }
        }
        return static_cast<int>(std::min(parts, static_cast<double>(most_parts)));
    }

    void add_parts(const MaterialValues& material, const glm::dvec3& normal, const glm::dvec3& eye, int x, int y,
                   int parts, EnvironmentLight& sum) const {
        const int width = picture_->width * parts;
        const int height = picture_->height * parts;
        for (int j = y * parts; j < (y + 1) * parts; ++j) {
            const double theta = polar_angle_of_row(j, height);
            const double dw = solid_angle_of_texel(width, height, j);
            for (int i = x * parts; i < (x + 1) * parts; ++i) {
                const glm::dvec3 d = direction_of(theta, azimuth_of_column(i, width));
                const Angles angles = angles_between(normal, eye, image_to_world_ * d);
                if (angles.nl > 0.0) {
                    add(material, angles, radiance_along(*picture_, d) * dw, sum);
                }
            }
        }
    }

    const Picture* picture_;
    glm::dvec3 intensity_;
    glm::dmat3 image_to_world_;
};

struct Place {
    int x;
    int y;
};

std::vector<Place> places_to_compare(const PreparedFrame& prepared) {
    const Frame& frame = prepared.frame();
    std::vector<Place> places;
    for (int y = 0; y < frame.planes.height(); ++y) {
        for (int x = 0; x < frame.planes.width(); ++x) {
            if (!all_finite(prepared, x, y)) {
                continue;
            }
            const std::optional<Surface> surface = read_surface(frame, x, y);
            if (surface && glm::dot(surface->normal, surface->eye) > 0.0) {
                places.push_back({x, y});
            }
        }
    }
    return places;
}

/// The first steps of Fisher and Yates' shuffle; then in the order of rows.
std::vector<Place> drawn(std::vector<Place> places, int samples, std::uint64_t seed) {
    const std::size_t count = std::min(places.size(), static_cast<std::size_t>(std::max(samples, 0)));
    std::mt19937_64 random(seed); // its numbers are the same everywhere; a distribution's would not be
    for (std::size_t i = 0; i < count; ++i) {
        std::swap(places[i], places[i + random() % (places.size() - i)]);
    }
    places.resize(count);
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); });
    return places;
}

Picture picture_to_integrate(const LatLong& image) {
    Picture picture(image);
    while (picture.height > most_rows && picture.even()) {
        picture = halved(picture);
    }
    return picture;
}

const BoundEnvironment& environment_to_integrate(const Frame& frame) {
    if (!frame.environment) {
        throw UsageError(fmt::format("{}: the scene has no environment to integrate; add [environment]", frame.file));
    }
    if (!frame.environment->image) {
        throw UsageError(
            fmt::format("{}: the environment is a set that was pre-filtered before; the ground truth needs "
                        "its picture: name that as the scene's [environment] image",
                        frame.file));
    }
    return *frame.environment;
}

/// The smallest of the sorted errors that so many per cent do not exceed.
double percentile_of(const std::vector<double>& sorted, double percentile) {
    const auto count = static_cast<double>(sorted.size());
    const double rank = std::ceil(percentile / 100.0 * (1.0 - 1e-12) * count);
    return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

/// `part` picks what is compared.
template <class Part>
GroundTruthErrors errors_of(const std::vector<const GroundTruthSample*>& samples, const Part& part) {
    std::vector<double> errors;
    GroundTruthErrors result;
    for (const GroundTruthSample* sample : samples) {
        const double truth = luminance(part(sample->truth));
        const double difference = luminance(part(sample->approximated)) - truth;
        const double floor = std::max(truth, 1e-3 * sample->mean_luminance);
        const double error = difference == 0.0 ? 0.0 : difference / floor;
        errors.push_back(std::abs(error));
        result.mean += std::abs(error) / static_cast<double>(samples.size());
        result.bias += error / static_cast<double>(samples.size());
    }
    std::sort(errors.begin(), errors.end());
    result.p50 = percentile_of(errors, 50.0);
    result.p99 = percentile_of(errors, 99.0);
    result.max = errors.back();
    return result;
}

int decade_of(double shininess) {
    return shininess < 0.0 ? -1 : static_cast<int>(std::floor(std::log10(std::max(shininess, 1.0))));
}

} // namespace

std::vector<GroundTruthSample> ground_truth(const Frame& frame, int samples, std::uint64_t seed, int threads) {
    const BoundEnvironment& environment = environment_to_integrate(frame);
    const PreparedEnvironment approximation(environment);
    const PreparedFrame prepared(frame);
    const Picture picture = picture_to_integrate(*environment.image);
    const Integrator integrator(picture, environment);
    const std::vector<Place> places = drawn(places_to_compare(prepared), samples, seed);
    std::vector<GroundTruthSample> result(places.size());
    const auto integrate = [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const auto [x, y] = places[at];
        const Surface surface = read_surface(frame, x, y).value();
        const MaterialValues material = read_material(prepared, surface, x, y);
        GroundTruthSample& sample = result[at];
        sample.x = x;
        sample.y = y;
        sample.model = model_key(frame.materials[static_cast<std::size_t>(surface.material)]);
        sample.shininess = sharpest_exponent(material);
        sample.approximated = environment_light(material, approximation, surface.normal, surface.eye);
        sample.truth = integrator.integrate(material, surface.normal, surface.eye);
        sample.mean_luminance = luminance(approximation.mean());
    };
    for_each_row(static_cast<int>(places.size()), threads, integrate);
    return result;
}

std::vector<GroundTruthSummary> summarise(const std::vector<GroundTruthSample>& samples) {
    std::map<std::pair<std::string, int>, std::vector<const GroundTruthSample*>> groups;
    for (const GroundTruthSample& sample : samples) {
        groups[{sample.model, decade_of(sample.shininess)}].push_back(&sample);
    }
    std::vector<GroundTruthSummary> summaries;
    for (const auto& [key, group] : groups) {
        GroundTruthSummary& summary = summaries.emplace_back();
        summary.model = key.first;
        summary.decade = key.second;
        summary.count = group.size();
        summary.total = errors_of(group, [](const EnvironmentLight& light) { return light.diffuse + light.specular; });
        summary.diffuse = errors_of(group, [](const EnvironmentLight& light) { return light.diffuse; });
        summary.specular = errors_of(group, [](const EnvironmentLight& light) { return light.specular; });
    }
    return summaries;
}

std::string decade_name(int decade) {
    if (decade < 0) {
        return "no lobe";
    }
    const double first = decade == 0 ? 0.0 : std::pow(10.0, decade);
    return fmt::format("{:.0f}..{:.0f}", first, std::pow(10.0, decade + 1));
}

} // namespace clshade::reference
