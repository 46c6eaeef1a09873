#include "bench/contest.h"

#include "bench/device_rivals.h"
#include "host/reference/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace clshade {

namespace {

/// Larger of the two, NaN as infinite.
double worse(double worst, double difference) {
    if (std::isnan(difference)) {
        return std::numeric_limits<double>::infinity();
    }
    return std::max(worst, difference);
}

/// How far the output planes are from (k + 1) times the sum of the input planes, in float rounding of a sum whose order
/// is free.
double stream_difference(const Frame& frame, int planes_in, const PlaneSlab& output, int planes_out) {
    double worst = 0.0;
    for (int y = 0; y < output.height(); ++y) {
        for (int x = 0; x < output.width(); ++x) {
            double sum = 0.0;
            double size = 0.0;
            for (int p = 0; p < planes_in; ++p) {
                const auto value = static_cast<double>(frame.planes.at(p, x, y));
                sum += value;
                size += std::abs(value);
            }
            for (int p = 0; p < planes_out; ++p) {
                const double expected = (p + 1) * sum;
                worst = worse(worst,
                              std::abs(static_cast<double>(output.at(p, x, y)) - expected) / (1e-3 + (p + 1) * size));
            }
        }
    }
    return worst;
}

RivalEntry impossible(BenchStatus status, std::string reason) {
    RivalEntry entry;
    entry.status = status;
    entry.reason = std::move(reason);
    return entry;
}

} // namespace

double picture_difference(const PlaneSlab& device, const std::function<double(int, int, int)>& other) {
    double worst = 0.0;
    for (int p = 0; p < 3; ++p) {
        for (int y = 0; y < device.height(); ++y) {
            for (int x = 0; x < device.width(); ++x) {
                const auto a = static_cast<double>(device.at(p, x, y));
                const double b = other(p, x, y);
                worst = worse(worst, std::abs(a - b) / (1e-3 + std::abs(b)));
            }
        }
    }
    return worst;
}

std::string rival_id(Rival rival, const BenchRow& row, int planes_in, int planes_out) {
    const bool streams = rival == Rival::stream_opencl || rival == Rival::stream_cpp;
    return fmt::format("{} {} {}", name_of(rival), streams ? std::to_string(planes_in) : row.name, planes_out);
}

RivalEntry RivalMaker::make(Rival rival, const BenchRow& row, int planes_in, int planes_out) {
    const bool on_host = rival == Rival::stream_cpp || rival == Rival::openmp_simd || rival == Rival::hand_simd ||
                         rival == Rival::reference;
    if (on_host && device_->info().kind != DeviceKind::cpu) {
        return impossible(BenchStatus::skipped, "runs on the host, which is another machine part than this device");
    }
    switch (rival) {
    case Rival::stream_opencl:
        return stream_opencl(planes_in, planes_out);
    case Rival::stream_cpp:
        return stream_cpp(planes_in, planes_out);
    case Rival::openmp_simd:
    case Rival::hand_simd:
        return host_shading(rival, planes_out);
    case Rival::naive_opencl:
        return naive();
    case Rival::reference:
        return reference(row.scene);
    }
    return impossible(BenchStatus::error, "unknown rival");
}

RivalEntry RivalMaker::stream_opencl(int planes_in, int planes_out) {
    const auto rival = std::make_shared<StreamRival>(*device_, *frame_, planes_in, planes_out, lanes_);
    RivalEntry entry;
    entry.run = [rival] { return rival->run(); };
    entry.difference = [rival, planes_in, planes_out, frame = frame_](const PlaneSlab&) {
        return stream_difference(*frame, planes_in, rival->output(), planes_out);
    };
    return entry;
}

RivalEntry RivalMaker::stream_cpp(int planes_in, int planes_out) {
    host();
    RivalEntry entry;
    entry.run = [rival = host_, planes_in, planes_out] { return rival->stream(planes_in, planes_out); };
    entry.difference = [rival = host_, planes_in, planes_out, frame = frame_](const PlaneSlab&) {
        return stream_difference(*frame, planes_in, rival->output(), planes_out);
    };
    return entry;
}

RivalEntry RivalMaker::host_shading(Rival rival, int planes_out) {
    host();
    const std::vector<rivals::DistantLight> lights = distant_lights(*frame_);
    RivalEntry entry;
    if (rival == Rival::openmp_simd) {
        entry.run = [host = host_, lights, planes_out] { return host->openmp_simd(lights, planes_out); };
    } else {
        entry.run = [host = host_, lights, planes_out] { return host->hand_simd(lights, planes_out); };
    }
    entry.difference = [host = host_](const PlaneSlab& picture) {
        return picture_difference(picture, [&host](int p, int x, int y) { return host->output().at(p, x, y); });
    };
    return entry;
}

RivalEntry RivalMaker::naive() {
    if (!NaiveRival::supported(*device_)) {
        return impossible(BenchStatus::unsupported, "the device has no images");
    }
    const auto rival = std::make_shared<NaiveRival>(*device_, *frame_);
    RivalEntry entry;
    entry.slow = device_->info().kind == DeviceKind::cpu;
    entry.run = [rival] { return rival->run(); };
    entry.difference = [rival](const PlaneSlab& picture) {
        const std::span<const float> pixels = rival->output();
        const auto width = static_cast<std::size_t>(picture.width());
        return picture_difference(picture, [&](int p, int x, int y) {
            return pixels[(static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) * 4 +
                          static_cast<std::size_t>(p)];
        });
    };
    return entry;
}

RivalEntry RivalMaker::reference(const BenchScene& scene) {
    // The frame's scene is another row's by the time this runs: it is put back first, outside the clock.
    const auto image = std::make_shared<reference::Image>();
    RivalEntry entry;
    entry.slow = true;
    entry.run = [image, scene, frame = frame_] {
        apply_scene(*frame, scene);
        const auto start = std::chrono::steady_clock::now();
        *image = reference::shade(*frame, {}, 1);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    entry.difference = [image](const PlaneSlab& picture) {
        const auto width = static_cast<std::size_t>(picture.width());
        return picture_difference(picture, [&](int p, int x, int y) {
            return image->planes[static_cast<std::size_t>(p)]
                                [static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
        });
    };
    return entry;
}

HostRivals& RivalMaker::host() {
    if (!host_) {
        host_ = std::make_shared<HostRivals>(*frame_, threads_);
    }
    return *host_;
}

} // namespace clshade
