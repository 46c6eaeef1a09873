// What a file holds, in terms free of file formats: parts, channels, windows, camera attributes.
#pragma once

#include <glm/glm.hpp>

#include <map>
#include <string>
#include <vector>

namespace clshade {

/// Inclusive pixel bounds, y downwards, as in OpenEXR.
struct Window {
    int x_min = 0;
    int y_min = 0;
    int x_max = -1;
    int y_max = -1;

    [[nodiscard]] int width() const { return x_max - x_min + 1; }
    [[nodiscard]] int height() const { return y_max - y_min + 1; }
    bool operator==(const Window&) const = default;
};

enum class SampleType { half, float32, uint32 };

/// One channel of one part. `name` is what users write, unique over the file:
/// - Parts: the channel's own name, or "layer.channel" where the part's name is what tells channels apart (Nuke's
/// "split
///   by layer", Karma's one part per plane). layer = part name without the ".view" that Nuke appends. Not added to
///   names that have a layer already (unless two parts claim one), to the main picture (part "rgba"), to a channel
///   named like its part (Arnold's "id"), and to the single letters of an image spread over parts (R here, G there).
/// - Views (only in files with two or more; `view` then is "" for layers that all views share): the view's component
///   ("ViewLayer.Depth.left.Z") is dropped from the names of the default view, the first, and from others where the
///   shorter name is free. Where it is not, it stands next to last, also for channels whose view is told by their part:
///   "ViewLayer.Depth.Z" and "ViewLayer.Depth.right.Z", "R" and "right.R".
struct ChannelInfo {
    std::string name;      ///< unique over the file; includes the layer
    std::string file_name; ///< the channel's name inside its part
    int part = 0;
    std::string view; ///< "" or the stereo view this channel belongs to
    SampleType type = SampleType::half;
};

struct PartInfo {
    std::string name; ///< "" in single-part files
    std::string view;
    Window data_window;
    std::string compression; ///< "zip", "dwaa", ... lower case
    bool tiled = false;
};

/// Header of an image: everything the role detection and the camera need, nothing of its pixels.
struct ImageLayout {
    std::string file;
    Window display_window;
    double pixel_aspect = 1.0;
    std::vector<PartInfo> parts;
    std::vector<ChannelInfo> channels;
    std::vector<std::string> views; ///< of `multiView` or of the parts; empty for single-view files
    /// 4x4 float attributes of the header by name (worldToCamera, worldToNDC, ...), element [row][column] as stored in
    /// the file, that is for row vectors.
    std::map<std::string, glm::dmat4> matrices;
    std::map<std::string, double> numbers;      ///< scalar attributes (CameraFov, ...)
    std::map<std::string, std::string> strings; ///< string attributes (arnold/color_space, ...)
    std::vector<std::string> warnings;          ///< oddities met while reading the header, one line each
};

} // namespace clshade
