#include "bench/contest.h"

#include "bench/device_rivals.h"
#include "host/reference/reference.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
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

/// The result planes are the host's for as long as this lives.
class HostTurn {
  public:
    explicit HostTurn(PictureMemory& memory) : memory_(&memory) { memory_->result_buffer.download(); }
    ~HostTurn() {
        try {
            memory_->result_buffer.upload();
        } catch (const std::exception& failure) { // the next launch will fail and say so
            spdlog::debug("giving memory back to the device: {}", failure.what());
        }
    }
    HostTurn(const HostTurn&) = delete;
    HostTurn& operator=(const HostTurn&) = delete;
    HostTurn(HostTurn&&) = delete;
    HostTurn& operator=(HostTurn&&) = delete;

  private:
    PictureMemory* memory_;
};

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

void spoil(PictureMemory& memory) {
    const HostTurn turn(memory);
    std::fill_n(memory.result.data(), memory.result.all().size(), std::numeric_limits<float>::quiet_NaN());
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
    const auto rival =
        std::make_shared<StreamRival>(*device_, memory_, frame_->planes.stride(), planes_in, planes_out, lanes_);
    RivalEntry entry;
    entry.run = [rival] { return rival->run(); };
    entry.difference = [memory = memory_, planes_in, planes_out, frame = frame_](const PlaneSlab&) {
        const HostTurn turn(*memory);
        return stream_difference(*frame, planes_in, memory->result, planes_out);
    };
    return entry;
}

RivalEntry RivalMaker::stream_cpp(int planes_in, int planes_out) {
    host();
    RivalEntry entry;
    entry.run = [rival = host_, memory = memory_, planes_in, planes_out] {
        const HostTurn turn(*memory);
        return rival->stream(planes_in, planes_out);
    };
    entry.difference = [memory = memory_, planes_in, planes_out, frame = frame_](const PlaneSlab&) {
        const HostTurn turn(*memory);
        return stream_difference(*frame, planes_in, memory->result, planes_out);
    };
    return entry;
}

RivalEntry RivalMaker::host_shading(Rival rival, int planes_out) {
    host();
    RivalEntry entry;
    entry.run = [rival, host = host_, memory = memory_, lights = distant_lights(*frame_), planes_out] {
        const HostTurn turn(*memory);
        return rival == Rival::openmp_simd ? host->openmp_simd(lights, planes_out)
                                           : host->hand_simd(lights, planes_out);
    };
    entry.difference = [memory = memory_](const PlaneSlab& picture) {
        const HostTurn turn(*memory);
        return picture_difference(picture, [&memory](int p, int x, int y) { return memory->result.at(p, x, y); });
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
    entry.run = [image, scene, environment = frame_->environment, frame = frame_] {
        apply_scene(*frame, scene, environment);
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
        host_ = std::make_shared<HostRivals>(*frame_, memory_->result, threads_);
    }
    return *host_;
}

} // namespace clshade
