#include "host/images/manifest_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace clshade {

namespace {

namespace fs = std::filesystem;

/// An image must not make its reader open files elsewhere.
bool stays_in_folder(const fs::path& name) {
    const bool climbs = std::any_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
    return !name.empty() && !name.is_absolute() && !climbs && name.native().find('\0') == std::string::npos;
}

/// The file's text, or why there is none.
struct Content {
    std::string text;
    std::string trouble;
};

Content read_text(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) {
        return {{}, "is not there; put it beside the image"};
    }
    if (!fs::is_regular_file(status)) { // a pipe would keep us waiting
        return {{}, "is no file"};
    }
    const std::uintmax_t size = fs::file_size(file, error);
    if (!error && size > most_manifest_bytes) {
        return {{}, fmt::format("has {} bytes and at most {} are read", size, most_manifest_bytes)};
    }
    std::ifstream stream(file, std::ios::binary);
    std::string text(error ? 0 : static_cast<std::size_t>(size), '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (error || !stream) {
        return {{}, "cannot be read; check its permissions"};
    }
    return {std::move(text), {}};
}

} // namespace

void read_manifest_files(const fs::path& image, ImageLayout& layout) {
    constexpr std::string_view start = "cryptomatte/";
    constexpr std::string_view end = "/manif_file";
    std::map<std::string, std::string> manifests;
    for (const auto& [attribute, value] : layout.strings) {
        if (!attribute.starts_with(start) || !attribute.ends_with(end)) {
            continue;
        }
        std::string manifest = attribute.substr(0, attribute.size() - end.size()) + "/manifest";
        if (layout.strings.count(manifest) != 0 || value.empty()) {
            continue;
        }
        Content content;
        if (stays_in_folder(value)) {
            content = read_text(image.parent_path() / value);
        } else {
            content.trouble =
                "lies outside the image's folder and is not read; move it there and name it without a path";
        }
        if (content.trouble.empty()) {
            manifests.emplace(std::move(manifest), std::move(content.text));
        } else {
            layout.warnings.push_back(fmt::format("Cryptomatte manifest '{}' {}", value, content.trouble));
        }
    }
    layout.strings.merge(manifests);
}

} // namespace clshade
