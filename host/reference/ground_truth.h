// How far the real-time approximation of an environment's light (rule 11 of host/gbuffer/frame.h: split sums, bands of
// spherical harmonics, pre-integrated absorption) is from the truth: the picture times the material's whole BRDF,
// summed up over all directions. Neither is blamed on the device: both are the reference's.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/reference/environment_light.h"

#include <cstdint>
#include <string>
#include <vector>

namespace clshade::reference {

/// One pixel. Radiance of the surface, without coverage, lights and emission.
struct GroundTruthSample {
    int x = 0;
    int y = 0;
    std::string model;      ///< model_key of the material
    double shininess = 0.0; ///< of the sharpest lobe that reflects; -1 without any
    EnvironmentLight approximated;
    EnvironmentLight truth;
    double mean_luminance = 0.0; ///< of the environment
};

/// Integrates at `samples` pixels, drawn without repetition (all where there are fewer), in the order of rows; the same
/// seed draws the same ones. Only surfaces that face the eye count: from behind (interpolated normals) both sides are
/// what their clamps make of it, and no truth. The integral runs over the picture's texels, halved to 512 rows where it
/// is finer, and over parts of texels where a lobe is too narrow for them. Takes up to 0.5 s a pixel. Throws UsageError
/// if the frame has no environment or only one that was pre-filtered before.
[[nodiscard]] std::vector<GroundTruthSample> ground_truth(const Frame& frame, int samples, std::uint64_t seed,
                                                          int threads);

/// Relative errors of luminance, |approximated - truth| over the truth, or over 1e-3 of the environment's mean where
/// that is more.
struct GroundTruthErrors {
    double mean = 0.0;
    double bias = 0.0; ///< mean of the signed errors: above 0 where the approximation is too bright
    double p50 = 0.0;
    double p99 = 0.0;
    double max = 0.0;
};

struct GroundTruthSummary {
    std::string model;
    int decade = -1; ///< floor of log10 of the shininess, 0 below 10; -1: no lobe
    std::size_t count = 0;
    GroundTruthErrors total;
    GroundTruthErrors diffuse;
    GroundTruthErrors specular;
};

/// Per model and decade of shininess, in the order of the models' names.
[[nodiscard]] std::vector<GroundTruthSummary> summarise(const std::vector<GroundTruthSample>& samples);

/// "no lobe", "0..10", "10..100", ...
[[nodiscard]] std::string decade_name(int decade);

} // namespace clshade::reference
