#include "host/environment/environment_input.h"

#include "host/environment/sh.h"

#include <fmt/format.h>

namespace clshade {

std::string EnvironmentInput::description() const {
    const glm::dvec3 colour = mean();
    const std::string size =
        image ? fmt::format("{}x{} pixels", image->width, image->height) : std::string("pre-filtered");
    return fmt::format("{}, mean radiance ({:.4g}, {:.4g}, {:.4g})", size, colour.r, colour.g, colour.b);
}

glm::dvec3 EnvironmentInput::mean() const {
    return image ? mean_radiance(*image) : maps->mean;
}

} // namespace clshade
