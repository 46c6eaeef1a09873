// The scene of a run, and what an output says about it.
#pragma once

#include "host/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace clshade {

struct RunScene {
    Scene scene;
    std::string name;                               ///< file name, or "default"
    std::string hash;                               ///< of the file's text, the overrides and the tables
    std::string file;                               ///< empty for the default scene
    std::vector<std::filesystem::path> tables;      ///< n,k files of metals
    std::vector<std::filesystem::path> environment; ///< files of the environment; not in the hash
};

} // namespace clshade
