// Folders of pre-filtered maps: environment_file.h.
#include "host/base/error.h"
#include "host/images/environment_file.h"
#include "host/images/image_reader.h"
#include "host/images/image_writer.h"
#include "host/images/temporary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace clshade {

namespace {

namespace fs = std::filesystem;

// Attributes of every file.
constexpr const char* key_version = "clshade/maps";
constexpr const char* key_name = "clshade/environment";
constexpr const char* key_hash = "clshade/environment_hash";
constexpr const char* key_mean = "clshade/mean_radiance";
constexpr const char* key_up = "clshade/up";
constexpr const char* key_axes = "clshade/axes";
constexpr const char* key_basis = "clshade/sh_basis";
constexpr const char* key_scaling = "clshade/scaling";
constexpr const char* key_layout = "clshade/layout";
constexpr const char* key_lobe = "clshade/lobe"; ///< of octahedral maps
constexpr const char* key_sh = "clshade/sh";     ///< of sh.exr: 27 numbers, all digits
/// Of layout and attributes; files of another version are refused.
constexpr std::string_view version = "1";
constexpr std::string_view again = "run `clshade prefilter` again";

constexpr int ambient_width = ambient_cosines + 1;
constexpr int ambient_height = ambient_exponents + 1;
constexpr const char* irradiance_file = "irradiance.exr";
constexpr const char* sh_file = "sh.exr";
constexpr const char* ambient_file = "ambient_brdf.exr";
constexpr std::array<const char*, 3> rgb_channels{"R", "G", "B"};
constexpr std::array<const char*, 4> ambient_channels{"exact.scale", "exact.bias", "linear.scale", "linear.bias"};
using ChannelNames = std::span<const char* const>;

std::string level_file(int level) {
    return fmt::format("radiance_n{:04.0f}.exr", level_shininess(level));
}

/// All files of a set.
std::vector<std::string> file_names() {
    std::vector<std::string> names;
    names.reserve(radiance_levels + 3);
    for (int level = 0; level < radiance_levels; ++level) {
        names.push_back(level_file(level));
    }
    names.insert(names.end(), {irradiance_file, sh_file, ambient_file});
    return names;
}

// --- writing

/// Floats that lie interleaved, as an image of float channels.
struct Map {
    PlaneSlab planes;
    OutputImage image;
};

Map make_map(int width, int height, int channels) {
    Map map;
    map.planes = PlaneSlab(width, height, channels);
    map.image.data_window = {0, 0, width - 1, height - 1};
    map.image.display_window = map.image.data_window;
    return map;
}

void write_map(const fs::path& file, Map& map, ChannelNames channels) {
    for (std::size_t i = 0; i < channels.size(); ++i) {
        map.image.channels.push_back({channels[i], &map.planes, static_cast<int>(i), true});
    }
    ExrSettings settings;
    settings.half = false;
    write_exr(file, map.image, settings);
}

std::string numbers_of(std::span<const glm::dvec3> values) {
    std::string text;
    for (const glm::dvec3& value : values) {
        text += fmt::format("{}{:.17g} {:.17g} {:.17g}", text.empty() ? "" : " ", value.r, value.g, value.b);
    }
    return text;
}

constexpr const char* axes_text =
    "right-handed, +z towards row 0 of the lat-long picture, u = 0.5 - atan2(y, x)/(2 pi), "
    "v = acos(z)/pi; neither turned nor scaled";
constexpr const char* basis_text =
    "index l(l+1)+m: 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2; L_lm = sum of L Y_lm dw; no "
    "Condon-Shortley sign; radiance, not E/pi";
constexpr const char* irradiance_lobe = "max(0, c)/pi, c the cosine of the angle to the direction of the vertex";

std::string lobe_text(int level) {
    return fmt::format(
        "(n+2)/(8 pi) ((1+c)/2)^(n/2), n = {:g}, c the cosine of the angle to the direction of the vertex",
        level_shininess(level));
}

std::map<std::string, std::string> common_attributes(const FilteredSet& set) {
    return {
        {key_version, std::string(version)},
        {key_name, set.name},
        {key_hash, set.hash},
        {key_mean, numbers_of(std::span(&set.mean, 1))},
        {key_up, set.up ? std::string(name_of(*set.up)) : "unknown"},
        {key_axes, axes_text},
        {key_basis, basis_text},
    };
}

/// Of an octahedral map.
std::string layout_text(int cells) {
    return fmt::format("octahedral, vertices on the border: {0} x {0} vertices, {1} cells a side; vertex (i, j) has x "
                       "= 2 i/{1} - 1, y = 2 j/{1} - 1, z = 1 - |x| - |y|, the lower half folded outwards",
                       cells + 1, cells);
}

void write_octahedral(const fs::path& file, const std::vector<float>& values, int cells,
                      std::map<std::string, std::string> attributes) {
    Map map = make_map(cells + 1, cells + 1, static_cast<int>(rgb_channels.size()));
    const float* value = values.data();
    for (int y = 0; y <= cells; ++y) {
        for (int x = 0; x <= cells; ++x) {
            for (int c = 0; c < 3; ++c) {
                map.planes.at(c, x, y) = *value++;
            }
        }
    }
    map.image.attributes = std::move(attributes);
    map.image.attributes[key_layout] = layout_text(cells);
    write_map(file, map, rgb_channels);
}

void write_levels(const fs::path& folder, const FilteredSet& set) {
    for (int level = 0; level < radiance_levels; ++level) {
        auto attributes = common_attributes(set);
        attributes[key_scaling] = "radiance";
        attributes[key_lobe] = lobe_text(level);
        write_octahedral(folder / level_file(level), set.radiance[static_cast<std::size_t>(level)], level_cells(level),
                         std::move(attributes));
    }
    auto attributes = common_attributes(set);
    attributes[key_scaling] = "E/pi";
    attributes[key_lobe] = irradiance_lobe;
    write_octahedral(folder / irradiance_file, set.irradiance, irradiance_cells, std::move(attributes));
}

void write_sh(const fs::path& file, const FilteredSet& set) {
    Map map = make_map(static_cast<int>(set.sh.size()), 1, static_cast<int>(rgb_channels.size()));
    for (int i = 0; i < static_cast<int>(set.sh.size()); ++i) {
        for (int c = 0; c < 3; ++c) {
            map.planes.at(c, i, 0) = static_cast<float>(set.sh[static_cast<std::size_t>(i)][c]);
        }
    }
    map.image.attributes = common_attributes(set);
    map.image.attributes[key_layout] = "one texel a coefficient, in the order of clshade/sh_basis";
    map.image.attributes[key_scaling] = "radiance";
    map.image.attributes[key_sh] = numbers_of(set.sh);
    write_map(file, map, rgb_channels);
}

void write_ambient(const fs::path& file, const FilteredSet& set, const AmbientTables& ambient) {
    Map map = make_map(ambient_width, ambient_height, static_cast<int>(ambient_channels.size()));
    std::size_t next = 0;
    for (int y = 0; y < ambient_height; ++y) {
        for (int x = 0; x < ambient_width; ++x, next += 2) {
            map.planes.at(0, x, y) = ambient.exact[next];
            map.planes.at(1, x, y) = ambient.exact[next + 1];
            map.planes.at(2, x, y) = ambient.linear[next];
            map.planes.at(3, x, y) = ambient.linear[next + 1];
        }
    }
    map.image.attributes = common_attributes(set);
    map.image.attributes[key_layout] = fmt::format("vertex (i, j): N.E = max(i/{}, 1e-4), n = 2^({:g} j/{}) - 1",
                                                   ambient_cosines, ambient_octaves, ambient_exponents);
    map.image.attributes[key_scaling] =
        "specular = (F0 scale + bias) x radiance; exact and linear: the normaliser of the lobe; the same for every "
        "environment";
    write_map(file, map, ambient_channels);
}

void check_tables(const AmbientTables& ambient) {
    const std::size_t wanted = std::size_t{2} * ambient_width * ambient_height;
    if (ambient.exact.size() != wanted || ambient.linear.size() != wanted) {
        throw std::invalid_argument(fmt::format("ambient tables of {} and {} values instead of {}",
                                                ambient.exact.size(), ambient.linear.size(), wanted));
    }
}

/// Without a trailing slash, so that it has a name.
fs::path named(const fs::path& set) {
    fs::path path = set.lexically_normal();
    if (!path.has_filename()) {
        path = path.parent_path();
    }
    return path == "." || path == ".." || path.filename() == ".." ? fs::absolute(path).lexically_normal() : path;
}

/// A set may be replaced, an empty folder filled, nothing else touched.
void check_target(const fs::path& set) {
    std::error_code error;
    const fs::file_status status = fs::status(set, error);
    if (!fs::exists(status)) {
        const fs::path parent = set.parent_path().empty() ? fs::path(".") : set.parent_path();
        if (!fs::is_directory(parent, error)) {
            throw RuntimeFailure(
                fmt::format("{}: the folder {} does not exist; create it first", set.string(), parent.string()));
        }
        return;
    }
    if (!fs::is_directory(status)) {
        throw RuntimeFailure(fmt::format("{}: exists and is no folder; name another", set.string()));
    }
    const std::vector<std::string> names = file_names();
    const bool complete = is_filtered_set(set);
    for (const auto& entry : fs::directory_iterator(set, error)) {
        const std::string name = entry.path().filename().string();
        if (!complete || std::find(names.begin(), names.end(), name) == names.end()) {
            throw RuntimeFailure(fmt::format("{}: holds {}, which is {}; name another folder, or remove it",
                                             set.string(), name,
                                             complete ? "no part of a pre-filtered set" : "no whole pre-filtered set"));
        }
    }
    if (error) {
        throw RuntimeFailure(
            fmt::format("{}: cannot be read: {}; check the permissions", set.string(), error.message()));
    }
}

std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
    if (const std::size_t at = text.find(from); at != std::string::npos) {
        text.replace(at, from.size(), to);
    }
    return text;
}

// --- reading

[[noreturn]] void fail(const fs::path& file, std::string_view what) {
    throw RuntimeFailure(fmt::format("{}: {}; {}", file.string(), what, again));
}

/// A file of a set: its header, then its pixels.
struct MapFile {
    fs::path file;
    ImageLayout layout;

    [[nodiscard]] const std::string& text(const char* key) const {
        const auto found = layout.strings.find(key);
        if (found == layout.strings.end()) {
            fail(file, fmt::format("has no attribute {}: not written by `clshade prefilter`, or changed since", key));
        }
        return found->second;
    }
    void require(const char* key, std::string_view wanted) const {
        if (const std::string& found = text(key); found != wanted) {
            fail(file, fmt::format("the attribute {} says '{}' instead of '{}'", key, found, wanted));
        }
    }
};

MapFile open_map(const fs::path& file, int width, int height, ChannelNames channels) {
    MapFile map{file, read_layout(file)};
    if (const std::string& written = map.text(key_version); written != version) {
        fail(file, fmt::format("has maps of version {}, this clshade reads version {}", written, version));
    }
    map.require(key_axes, axes_text);
    map.require(key_basis, basis_text);
    if (map.layout.parts.size() != 1 || map.layout.parts[0].data_window != Window{0, 0, width - 1, height - 1}) {
        const Window& window = map.layout.parts[0].data_window;
        fail(file, fmt::format("has {}x{} vertices instead of {}x{}", window.width(), window.height(), width, height));
    }
    for (const char* name : channels) {
        const auto found = std::find_if(map.layout.channels.begin(), map.layout.channels.end(),
                                        [&](const ChannelInfo& channel) { return channel.name == name; });
        if (found == map.layout.channels.end() || found->type != SampleType::float32) {
            fail(file, fmt::format("has no channel {} of 32-bit floats", name));
        }
    }
    return map;
}

/// All numbers of a text, which must hold exactly `values.size()` vectors.
void parse_numbers(const MapFile& map, const char* key, std::span<glm::dvec3> values) {
    const std::string& text = map.text(key);
    const char* next = text.data();
    const char* end = text.data() + text.size();
    for (glm::dvec3& value : values) {
        for (int c = 0; c < 3; ++c) {
            while (next != end && *next == ' ') {
                ++next;
            }
            const auto [after, error] = std::from_chars(next, end, value[c]);
            if (error != std::errc() || !std::isfinite(value[c])) {
                fail(map.file, fmt::format("the attribute {} is damaged", key));
            }
            next = after;
        }
    }
    if (next != end) {
        fail(map.file, fmt::format("the attribute {} is damaged", key));
    }
}

/// The channels of a map, interleaved.
std::vector<float> read_values(const MapFile& map, ChannelNames channels) {
    FramePlan plan;
    for (const char* name : channels) {
        const auto found = std::find_if(map.layout.channels.begin(), map.layout.channels.end(),
                                        [&](const ChannelInfo& channel) { return channel.name == name; });
        plan.channels.push_back(static_cast<int>(found - map.layout.channels.begin()));
    }
    const Window& window = map.layout.parts[0].data_window;
    plan.frame.data_window = window;
    plan.frame.planes = PlaneSlab(window.width(), window.height(), static_cast<int>(channels.size()));
    read_planes(map.file, map.layout, plan, 1);
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()) *
                   channels.size());
    for (int y = 0; y < window.height(); ++y) {
        for (int x = 0; x < window.width(); ++x) {
            for (int c = 0; c < static_cast<int>(channels.size()); ++c) {
                values.push_back(plan.frame.planes.at(c, x, y));
            }
        }
    }
    return values;
}

/// Radiance, irradiance, scale, bias: finite and not negative.
void check_light(const MapFile& map, const std::vector<float>& values) {
    const auto bad =
        std::find_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value) || value < 0.0F; });
    if (bad != values.end()) {
        fail(map.file, fmt::format("holds the value {}", *bad));
    }
}

/// Reads the files of one set, all of which must be of one environment.
class SetReader {
  public:
    explicit SetReader(const fs::path& folder) : folder_(folder) {}

    [[nodiscard]] MapFile open(const std::string& name, int width, int height, ChannelNames channels) {
        MapFile map = open_map(folder_ / name, width, height, channels);
        if (first_.empty()) {
            first_ = name;
            hash_ = map.text(key_hash);
        } else if (map.text(key_hash) != hash_) {
            fail(map.file, fmt::format("belongs to another environment than {} (hash {} instead of {})", first_,
                                       map.text(key_hash), hash_));
        }
        return map;
    }
    [[nodiscard]] std::vector<float> octahedral(const std::string& name, int cells, const std::string& lobe) {
        const MapFile map = open(name, cells + 1, cells + 1, rgb_channels);
        map.require(key_lobe, lobe);
        std::vector<float> values = read_values(map, rgb_channels);
        check_light(map, values);
        return values;
    }

  private:
    fs::path folder_;
    std::string first_;
    std::string hash_;
};

std::optional<UpAxis> up_of(const MapFile& map) {
    const std::string& text = map.text(key_up);
    for (const UpAxis axis : {UpAxis::z, UpAxis::y}) {
        if (text == name_of(axis)) {
            return axis;
        }
    }
    if (text != "unknown") {
        fail(map.file, fmt::format("the attribute {} is '{}' instead of z, y or unknown", key_up, text));
    }
    return std::nullopt;
}

void read_sh(SetReader& reader, FilteredSet& set) {
    const MapFile map = reader.open(sh_file, static_cast<int>(set.sh.size()), 1, rgb_channels);
    set.name = map.text(key_name);
    set.hash = map.text(key_hash);
    set.up = up_of(map);
    parse_numbers(map, key_mean, std::span(&set.mean, 1));
    parse_numbers(map, key_sh, set.sh);
    const std::vector<float> pixels = read_values(map, rgb_channels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double value = set.sh[i / 3][static_cast<int>(i % 3)];
        if (pixels[i] != static_cast<float>(value)) {
            fail(map.file, fmt::format("pixel {} is not what the attribute {} says", i / 3, key_sh));
        }
    }
}

} // namespace

bool is_filtered_set(const fs::path& path) {
    const std::vector<std::string> names = file_names();
    return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
        std::error_code ignored;
        return fs::is_regular_file(path / name, ignored);
    });
}

void write_filtered_set(const fs::path& set, const FilteredSet& maps, const AmbientTables& ambient) {
    check_sizes(maps);
    check_tables(ambient);
    const fs::path target = named(set);
    check_target(target);
    StagedFolder folder(target, file_names());
    try {
        write_levels(folder.path(), maps);
        write_sh(folder.path() / sh_file, maps);
        write_ambient(folder.path() / ambient_file, maps, ambient);
        folder.commit();
    } catch (const RuntimeFailure& failure) { // name the files as they would have been
        throw RuntimeFailure(with_replaced(failure.what(), folder.path().string(), target.string()));
    }
}

FilteredSet read_filtered_set(const fs::path& set) {
    for (const std::string& name : file_names()) {
        std::error_code ignored;
        if (!fs::exists(set / name, ignored)) {
            throw RuntimeFailure(
                fmt::format("{}: is missing from the set; remove the set and {}", (set / name).string(), again));
        }
    }
    FilteredSet maps;
    SetReader reader(set);
    read_sh(reader, maps);
    for (int level = 0; level < radiance_levels; ++level) {
        maps.radiance[static_cast<std::size_t>(level)] =
            reader.octahedral(level_file(level), level_cells(level), lobe_text(level));
    }
    maps.irradiance = reader.octahedral(irradiance_file, irradiance_cells, irradiance_lobe);
    // Made anew for every device, so not taken from here; but a set is whole or it is none.
    const MapFile ambient = reader.open(ambient_file, ambient_width, ambient_height, ambient_channels);
    check_light(ambient, read_values(ambient, ambient_channels));
    return maps;
}

} // namespace clshade
