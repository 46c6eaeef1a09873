// Who may know whom: the table of the top CMakeLists.txt, held against every #include line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

using Names = std::set<std::string>;

// Components and what each may include beside itself, written out in full (no rule is inherited).
const std::map<std::string, Names> allowed{
    {"base", {}},
    {"scene", {"base"}},
    {"environment", {"base", "scene"}},
    {"gbuffer", {"base", "scene", "environment"}},
    {"reference", {"base", "scene", "environment", "gbuffer"}},
    {"demo", {"base", "scene", "environment", "gbuffer"}},
    {"device", {"base"}},
    {"prefilter", {"base", "scene", "environment", "device", "kernels"}},
    {"images", {"base", "scene", "environment", "gbuffer"}},
    {"shading", {"base", "scene", "environment", "gbuffer", "device", "prefilter", "kernels"}},
    {"batch", {"base", "scene", "environment", "gbuffer", "images", "device", "prefilter", "shading"}},
    {"bench",
     {"base", "scene", "environment", "gbuffer", "device", "prefilter", "shading", "reference", "images", "batch"}},
    {"kernels", {}},
    {"cli",
     {"base", "scene", "environment", "gbuffer", "reference", "demo", "device", "prefilter", "images", "shading",
      "batch", "bench"}},
};

// Libraries that only some components may see.
struct Fence {
    std::regex header;
    Names components;
};
const std::vector<Fence>& fences() {
    static const std::vector<Fence> all{
        {std::regex("CL/.*"), {"device"}},
        // bench: its rivals read and write with the libraries as they come
        {std::regex("OpenEXR/.*|Imath/.*|Imf.*|half\\.h|openexr.*|OpenImageIO/.*"), {"images", "bench"}},
        {std::regex("toml\\+\\+/.*|toml\\+\\+\\.h|toml\\.hpp"), {"scene"}},
        {std::regex("CLI/.*"), {"cli"}},
    };
    return all;
}

struct Include {
    fs::path file; // relative to the repository
    int line = 0;
    std::string header;
    bool quoted = false;
};

struct SourceFile {
    fs::path path; // relative to the repository
    std::string component;
    int lines = 0;
    std::vector<Include> includes;
};

// "host/scene/x.h" -> "scene", "bench/simd/x.h" -> "bench", "kernels/x.h" -> "kernels"; else empty.
std::string component_of(const fs::path& path) {
    std::vector<std::string> parts;
    for (const fs::path& part : path) {
        parts.push_back(part.string());
    }
    if (parts.size() >= 3 && parts[0] == "host") {
        return parts[1];
    }
    const bool top = parts.size() >= 2 && (parts[0] == "bench" || parts[0] == "kernels");
    return top ? parts[0] : std::string();
}

SourceFile read(const fs::path& root, const fs::path& path) {
    static const std::regex directive(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)re");
    SourceFile source;
    source.path = fs::relative(path, root);
    source.component = component_of(source.path);
    std::ifstream stream(path);
    std::string line;
    std::smatch match;
    while (std::getline(stream, line)) {
        ++source.lines;
        if (std::regex_match(line, match, directive)) {
            source.includes.push_back({source.path, source.lines, match[2], match[1] == "\""});
        }
    }
    return source;
}

std::vector<SourceFile> sources() {
    const fs::path root = CLSHADE_SOURCE_DIR;
    const Names extensions{".h", ".hpp", ".cpp", ".cl", ".inc"};
    std::vector<SourceFile> all;
    for (const char* folder : {"host", "bench", "kernels"}) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
            if (entry.is_regular_file() && extensions.contains(entry.path().extension().string())) {
                all.push_back(read(root, entry.path()));
            }
        }
    }
    return all;
}

std::string place(const Include& include) {
    return include.file.string() + ":" + std::to_string(include.line) + ": " + include.header;
}

// What is wrong with one include; empty: nothing.
std::string fault_of(const SourceFile& source, const Include& include) {
    const std::string target = component_of(include.header);
    if (!target.empty() && target != source.component) {
        const auto rule = allowed.find(source.component);
        if (rule == allowed.end() || !rule->second.contains(target)) {
            return place(include) + ": " + source.component + " must not know " + target;
        }
    }
    for (const Fence& fence : fences()) {
        if (std::regex_match(include.header, fence.header) && !fence.components.contains(source.component)) {
            return place(include) + ": " + source.component + " must not see this library";
        }
    }
    return {};
}

TEST(Architecture, FindsTheSources) {
    Names components;
    std::size_t includes = 0;
    for (const SourceFile& source : sources()) {
        components.insert(source.component);
        includes += source.includes.size();
    }
    for (const auto& [name, targets] : allowed) {
        EXPECT_TRUE(components.contains(name)) << "no sources of component " << name;
    }
    EXPECT_GT(includes, 300U);
}

TEST(Architecture, EveryFolderIsInTheTable) {
    for (const SourceFile& source : sources()) {
        EXPECT_TRUE(allowed.contains(source.component)) << source.path << ": component '" << source.component << "'";
    }
}

TEST(Architecture, IncludesObeyTheTable) {
    for (const SourceFile& source : sources()) {
        for (const Include& include : source.includes) {
            EXPECT_EQ(fault_of(source, include), "");
        }
    }
}

// The test must be able to fail: the same check on lines that break each rule.
TEST(Architecture, TheCheckFindsViolations) {
    const auto fault = [](const std::string& component, const std::string& header) {
        const SourceFile source{"host/" + component + "/x.cpp", component, 1, {}};
        return fault_of(source, {source.path, 1, header, true});
    };
    EXPECT_NE(fault("reference", "kernels/types.h"), "");
    EXPECT_NE(fault("reference", "host/shading/shader.h"), "");
    EXPECT_NE(fault("scene", "host/gbuffer/frame.h"), "");
    EXPECT_NE(fault("shading", "host/images/image_reader.h"), "");
    EXPECT_NE(fault("shading", "CL/opencl.hpp"), "");
    EXPECT_NE(fault("shading", "OpenEXR/ImfInputFile.h"), "");
    EXPECT_NE(fault("batch", "ImfInputFile.h"), "");
    EXPECT_NE(fault("bench", "CLI/CLI.hpp"), "");
    EXPECT_NE(fault("cli", "OpenImageIO/imageio.h"), "");
    EXPECT_NE(fault("gbuffer", "toml++/toml.h"), "");
    EXPECT_NE(fault("bench", "kernels/types.h"), "");
    EXPECT_EQ(fault("cli", "host/images/image_reader.h"), "");
    EXPECT_EQ(fault("shading", "kernels/types.h"), "");
}

// Every path from the repository root, so that the table can be read off the include lines.
TEST(Architecture, HostIncludesAreWrittenFromTheRoot) {
    const fs::path root = CLSHADE_SOURCE_DIR;
    for (const SourceFile& source : sources()) {
        if (source.component == "kernels" || source.path.extension() == ".cl") {
            continue; // resolved among the embedded kernel files
        }
        for (const Include& include : source.includes) {
            if (include.quoted) {
                EXPECT_TRUE(fs::exists(root / include.header)) << place(include) << " is not a path from the root";
            }
        }
    }
}

TEST(Architecture, NoFileIsTooLong) {
    constexpr int most_lines = 500;
    for (const SourceFile& source : sources()) {
        EXPECT_LE(source.lines, most_lines) << source.path;
    }
}

// The same table stands in the build: a component's library links no more than the table allows.
TEST(Architecture, TheBuildLinksWhatTheTableAllows) {
    const std::regex link("clshade_([a-z]+)");
    for (const auto& [component, targets] : allowed) {
        if (component == "kernels" || component == "cli") {
            continue;
        }
        const fs::path folder = component == "bench" ? fs::path("bench") : fs::path("host") / component;
        std::ifstream stream(fs::path(CLSHADE_SOURCE_DIR) / folder / "CMakeLists.txt");
        ASSERT_TRUE(stream.is_open()) << folder;
        std::string line;
        while (std::getline(stream, line)) {
            if (line.find("PUBLIC") == std::string::npos && line.find("PRIVATE") == std::string::npos) {
                continue;
            }
            for (std::sregex_iterator it(line.begin(), line.end(), link), end; it != end; ++it) {
                const std::string other = (*it)[1];
                const bool is_component = allowed.contains(other) && other != component;
                EXPECT_TRUE(!is_component || targets.contains(other)) << folder << ": " << line;
            }
        }
    }
}

} // namespace
