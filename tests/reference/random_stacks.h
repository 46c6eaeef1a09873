// Random stacks of layers for property tests.
#pragma once

#include "tests/reference/stacks.h"

#include <cstdint>
#include <random>
#include <vector>

namespace clshade::reference {

/// Draws layers and directions; the same seed gives the same ones.
class StackGenerator {
  public:
    explicit StackGenerator(std::uint64_t seed);

    double between(double low, double high);
    bool chance(double probability) { return between(0.0, 1.0) < probability; }
    /// Unit vector above the surface, at least 1e-3 from the horizon.
    glm::dvec3 direction();
    /// 2^-4 to 2^16.
    double shininess();
    /// Per channel or grey, 1e-3 to 0.9.
    glm::dvec3 f0();
    SpecularModel lobe();
    /// A layer with the given lobe, without absorption; gold or copper if spectral.
    LayerValues layer(SpecularModel model);
    glm::dvec3 absorption();
    /// 1 to 8 layers of any lobes; above the base some have no interface (lobe none or f0 = 0, also in one channel
    /// only).
    std::vector<LayerValues> layers();

  private:
    std::mt19937_64 random_;
};

} // namespace clshade::reference
