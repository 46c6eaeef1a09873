// Device against reference for one frame, by stacks of models.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/compare.h"
#include "host/shading/shader.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace clshade::cli {

/// --rel, --abs, --percentile; what is absent comes from the models' defaults.
struct ToleranceOverride {
    std::optional<double> rel;
    std::optional<double> abs;
    std::optional<double> percentile;

    /// With --rel or --abs nothing else is allowed for: no rounding scale, no hard limit, the other of the two is 0.
    [[nodiscard]] bool is_plain() const { return rel || abs; }
    [[nodiscard]] reference::Tolerance apply(const reference::Tolerance& defaults) const;
};

/// The verdict on the pixels of one stack of models.
struct CheckResult {
    std::string model; ///< model_key; "no_surface" for the pixels without one: 0, or the background
    reference::Tolerance tolerance;
    reference::Comparison comparison;
    bool pass = false;
    std::string trouble;  ///< why not, beyond the numbers: "alpha differs", ...
    nlohmann::json worst; ///< x, y, inputs, device, reference; null if no pixel was compared
};

/// What the reference knows of a frame. Its rounding scale is found also where --rel and --abs leave it no say: it
/// tells which channels are too dark for relative errors.
struct Expectation {
    reference::Image image;
    reference::RoundingScale scale;
};

[[nodiscard]] Expectation expect(const Frame& frame, const AovSelection& aovs, int threads);

/// Compares what the device made of `frame` with the reference: radiance, alpha and, where both have it, the
/// environment's own AOV. One result per model_key that claims a pixel, in the order of the materials.
[[nodiscard]] std::vector<CheckResult> check_frame(const Frame& frame, const ShadedImage& shaded,
                                                   const Expectation& expectation, const ToleranceOverride& wanted);

/// Heading and one row per result: model, pixels, errors, tolerance, pass.
[[nodiscard]] std::string check_table(const std::vector<CheckResult>& results);
/// The worst pixel in words: where, inputs, both values.
[[nodiscard]] std::string worst_text(const CheckResult& result);
[[nodiscard]] nlohmann::json json_of(const CheckResult& result);

} // namespace clshade::cli
