// Private to host/gbuffer: materials of a given shape for random_frame, and their values at a pixel.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/gbuffer/random_gbuffer.h"
#include "host/gbuffer/random_numbers.h"

#include <glm/glm.hpp>

#include <array>
#include <string>
#include <vector>

namespace clshade {

/// Adds planes to a frame under construction.
class PlaneNames {
  public:
    explicit PlaneNames(std::vector<std::string>& names) : names_(&names) {}
    PlaneIndex one(const std::string& name);
    /// "layer.X", "layer.Y", "layer.Z" for the suffixes "XYZ".
    std::array<PlaneIndex, 3> three(const std::string& layer, const char* suffixes);

  private:
    std::vector<std::string>* names_;
};

/// Binds what the shape needs to new planes, or to constants drawn from `random`.
[[nodiscard]] BoundMaterial random_material(const StackShape& shape, RandomGenerator& random, PlaneNames& names);

/// What the parameters of a layer are at a pixel.
struct LayerValues {
    glm::dvec3 f0{0.0};
    glm::dvec3 absorption{0.0};
    double shininess = 0.0;
    double shininess_u = 0.0;
    double shininess_v = 0.0;
};

/// Draws values for the planes of a layer above the base.
[[nodiscard]] LayerValues random_coat(RandomGenerator& random, double largest_shininess);

/// The value of a parameter at a pixel where its planes hold `drawn`: constants are what they are, and a single plane
/// holds the first component.
[[nodiscard]] glm::dvec3 value_of(const BoundParameter& parameter, const glm::dvec3& drawn);

/// Shininess of a lobe of the layer: of one of the two directions where they differ.
[[nodiscard]] double lobe_shininess(const BoundLayer& layer, const LayerValues& drawn, RandomGenerator& random);

} // namespace clshade
