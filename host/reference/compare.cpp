#include "host/reference/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace clshade::reference {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double dark = 1e-3; // of the light level: models.md section 14 measures lobes above it

/// Position of a float among all floats: neighbours differ by one, both zeros are 0.
std::int64_t ordinal(float value) {
    const auto bits = std::bit_cast<std::int32_t>(value);
    return bits >= 0 ? bits : -static_cast<std::int64_t>(bits & 0x7fffffff);
}

/// What a pixel may be off by, besides rel |b|.
struct Allowance {
    double irradiance = 0.0;
    double shift = 0.0;
};

Allowance allowance_at(const RoundingScale& scale, std::size_t pixel, int channel) {
    if (scale.irradiance.empty()) {
        return {};
    }
    return {scale.irradiance[pixel], scale.shift[static_cast<std::size_t>(channel)][pixel]};
}

double share_of(double error, double limit) {
    if (error == 0.0) {
        return 0.0;
    }
    return limit > 0.0 ? error / limit : infinity;
}

/// Value at a percentile (0..100) of the errors, which it reorders: the smallest that so many per cent do not exceed.
double percentile_of(std::vector<double>& errors, double percentile) {
    if (errors.empty()) {
        return 0.0;
    }
    // 1 - 1e-12: 99.9 % of 1000 is 999, although 0.999 is not exact.
    const double rank = std::ceil(percentile / 100.0 * (1.0 - 1e-12) * static_cast<double>(errors.size()));
    const auto at = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
    std::nth_element(errors.begin(), errors.begin() + at, errors.end());
    return errors[static_cast<std::size_t>(at)];
}

double root_mean(double sum, std::uint64_t count) {
    return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

/// Collects the errors of one comparison.
class Collector {
  public:
    explicit Collector(const Tolerance& tolerance) : tolerance_(&tolerance) {}

    void begin_pixel() {
        pixel_rel_ = 0.0;
        pixel_share_ = 0.0;
    }

    void add(int x, int y, int channel, float device, double reference, const Allowance& allowance) {
        const double a = static_cast<double>(device);
        const double error = std::isfinite(device) ? std::abs(a - reference) : infinity;
        const double limit = tolerance_->rel * std::abs(reference) + tolerance_->abs +
                             tolerance_->per_irradiance * allowance.irradiance +
                             tolerance_->per_roundoff * allowance.shift;
        const double share = share_of(error, limit);
        pixel_share_ = std::max(pixel_share_, share);
        if (share > result_.worst.share) {
            result_.worst = {x, y, channel, a, reference, share};
        }
        result_.max_abs = std::max(result_.max_abs, error);
        abs_sum_ += error * error;
        ++abs_count_;
        if (std::abs(reference) > std::max(tolerance_->abs, dark * allowance.irradiance)) {
            const double rel = error / std::abs(reference);
            pixel_rel_ = std::max(pixel_rel_, rel);
            rel_sum_ += rel * rel;
            ++rel_count_;
            result_.max_ulp = std::max(result_.max_ulp, ulp_distance(device, static_cast<float>(reference)));
        }
    }

    void end_pixel() {
        ++result_.pixels;
        result_.outside += pixel_share_ > 1.0 ? 1U : 0U;
        result_.beyond_hard += pixel_share_ > tolerance_->hard ? 1U : 0U;
        pixel_errors_.push_back(pixel_rel_);
    }

    Comparison finish() {
        result_.rms_abs = root_mean(abs_sum_, abs_count_);
        result_.rms_rel = root_mean(rel_sum_, rel_count_);
        result_.p50_rel = percentile_of(pixel_errors_, 50.0);
        result_.p99_rel = percentile_of(pixel_errors_, 99.0);
        result_.p999_rel = percentile_of(pixel_errors_, 99.9);
        result_.p9999_rel = percentile_of(pixel_errors_, 99.99);
        result_.max_rel = percentile_of(pixel_errors_, 100.0);
        return result_;
    }

  private:
    const Tolerance* tolerance_;
    Comparison result_;
    std::vector<double> pixel_errors_;
    double pixel_rel_ = 0.0;
    double pixel_share_ = 0.0;
    double abs_sum_ = 0.0;
    double rel_sum_ = 0.0;
    std::uint64_t abs_count_ = 0;
    std::uint64_t rel_count_ = 0;
};

} // namespace

double ulp_distance(float a, float b) {
    if (!std::isfinite(a) || !std::isfinite(b)) {
        return infinity;
    }
    return static_cast<double>(std::abs(ordinal(a) - ordinal(b)));
}

Comparison compare(const PlaneSlab& device, const Image& reference, const RoundingScale& scale,
                   const Tolerance& tolerance, std::span<const std::uint8_t> selected, int first_plane, int channels) {
    Collector collector(tolerance);
    for (int y = 0; y < reference.height; ++y) {
        for (int x = 0; x < reference.width; ++x) {
            const auto pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width) + static_cast<std::size_t>(x);
            if (!selected.empty() && selected[pixel] == 0) {
                continue;
            }
            collector.begin_pixel();
            for (int c = 0; c < channels; ++c) {
                const int plane = first_plane + c;
                collector.add(x, y, c, device.at(plane, x, y), reference.planes[static_cast<std::size_t>(plane)][pixel],
                              allowance_at(scale, pixel, c));
            }
            collector.end_pixel();
        }
    }
    return collector.finish();
}

bool passes(const Comparison& comparison, const Tolerance& tolerance) {
    const double allowed = (100.0 - tolerance.percentile) / 100.0 * static_cast<double>(comparison.pixels);
    // 1e-9: 100 - 99.99 is not exactly 0.01, and one pixel in 10,000 is meant to be allowed.
    return comparison.pixels > 0 && comparison.beyond_hard == 0 &&
           static_cast<double>(comparison.outside) <= allowed + 1e-9 * static_cast<double>(comparison.pixels);
}

} // namespace clshade::reference
