#include "host/gbuffer/frame.h"

namespace clshade {

namespace {

void add_colour(std::vector<std::string>& names, const std::string& layer) {
    for (const char* component : {".R", ".G", ".B"}) {
        names.push_back(layer + component);
    }
}

} // namespace

std::vector<std::string> output_plane_names(const Frame& frame, const AovSelection& aovs) {
    std::vector<std::string> names{"R", "G", "B", "A"};
    if (aovs.diffuse) {
        add_colour(names, "diffuse");
    }
    if (aovs.specular) {
        add_colour(names, "specular");
    }
    if (aovs.lights) {
        for (const Light& light : frame.lights) {
            add_colour(names, "light." + light.name);
        }
    }
    return names;
}

} // namespace clshade
