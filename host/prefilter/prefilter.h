// Pre-filtering an environment on a device, and the tables that turn what is filtered into reflected light: what
// host/environment/filter_layout.h and rule 11 of host/gbuffer/frame.h ask for.
#pragma once

#include "host/device/device.h"
#include "host/device/program.h"
#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"

#include <glm/glm.hpp>

#include <functional>
#include <string>
#include <vector>

namespace clshade {

/// A reflectance curve as kernels evaluate it: per channel sum_k coefficients[k] x^k at x = metal_argument(c, bend) of
/// kernels/spectral.cl, clamped to [0, 1].
struct ReflectanceCurve {
    double bend = 0.0;
    std::vector<glm::dvec3> coefficients;
};

/// What a filtering cost.
struct PrefilterReport {
    bool from_cache = false;
    double milliseconds = 0.0;        ///< all of it: reading the cache, or filtering and storing
    double kernel_milliseconds = 0.0; ///< on the device
    double build_milliseconds = 0.0;
};

/// Results are kept on disk in the program cache's folder, under a hash of the picture, the layout and the kernels;
/// doubtful entries are made anew. Refers to the device.
class Prefilter {
  public:
    /// `lanes` as for Shader (1, 4, 8, 16).
    Prefilter(Device& device, SourceSet kernels, ProgramCache cache, int lanes);

    /// `progress` is called with the share that is done, 0 to 1, now and then; may be empty. Throws RuntimeFailure.
    [[nodiscard]] FilteredSet filter(const LatLong& image, const std::function<void(double)>& progress,
                                     PrefilterReport* report = nullptr);
    /// Scale and bias of rule 11.
    [[nodiscard]] AmbientTables ambient_tables();
    /// A metal's own table: RGB interleaved, vertices as the ambient tables'. `linear`: with the linear normaliser.
    [[nodiscard]] std::vector<float> spectral_table(const ReflectanceCurve& curve, bool linear);

  private:
    Device* device_;
    SourceSet kernels_;
    ProgramCache cache_;
    int lanes_;
};

} // namespace clshade
