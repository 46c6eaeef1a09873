#include "host/cli/verb.h"

#include "host/base/suggest.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace clshade::cli {

namespace {

constexpr std::string_view shade_details =
    R"(Sequences: # (four digits), #### or %04d in INPUT and OUTPUT stands for the frame number. Without --frames every
frame found on disk is shaded. A frame that fails does not stop the others.

Without --scene: albedo role (else 0.5), f0 role (else 0.04), roughness or shininess role (else shininess 64), and
three lights over the camera's shoulders. `clshade inspect INPUT` tells which channels play which role.

OUTPUT.exr holds R, G, B (radiance), A (coverage) and what --aov and --keep ask for; OUTPUT.png is a preview for the
screen. An output is written under a temporary name and renamed when it is complete.

Examples:
  clshade shade in.exr -o out.exr
  clshade shade in.exr -o preview.png --set material.default.specular.shininess=200
  clshade shade in.####.exr -o out.####.exr --scene look.toml --frames 1-100x2 -u
  clshade shade in.#.exr -o out.#.exr --chunk 2/8 --progress openjd --json report.json)";

constexpr std::string_view check_details =
    R"(With INPUT: shades it on the device and with the scalar double-precision reference and compares every pixel, grouped
by the material's pair of models. Without INPUT: a seeded random G-buffer for every pair of specular and diffuse model.

A value agrees when |device - reference| <= REL * |reference| + ABS. A pair passes when at least PERCENTILE percent of
its pixels agree and the hard limits of its models hold. Ends with 3 when any pair fails.

Examples:
  clshade check
  clshade check in.exr --scene look.toml --dump difference.exr
  clshade check --device 1 --lanes 8 --json check.json)";

constexpr std::string_view bench_details =
    R"(All contestants run in turns in one process; ratios are taken inside each round and the median is printed, so that a
drifting machine does not matter. A ratio below 1 means that the kernel is faster than its rival.

Examples:
  clshade bench
  clshade bench --filter 'blinn_phong\.lambert' --size 1920x1080
  clshade bench --json today.json --compare baseline.json --regress 10
  clshade bench --tune)";

constexpr std::string_view inspect_details =
    R"(Works on any EXR that can be read, whether or not it can be shaded. Pixels are read only for the camera (position,
depth, normal) and for the material ids.

Examples:
  clshade inspect in.exr
  clshade inspect in.exr --scene look.toml --json roles.json)";

constexpr std::string_view demo_details =
    R"(Makes DIR/gbuffer.0001.exr ... (multi-layer EXR with camera), DIR/scene.toml, DIR/shaded.0001.exr and .png ...

Example:
  clshade demo && clshade inspect clshade-demo/gbuffer.0001.exr)";

constexpr std::string_view devices_details =
    R"(The index, any part of 'platform/name' that fits one device only, or cpu | gpu is what --device takes.)";

constexpr std::string_view models_details = R"(Examples:
  clshade models
  clshade models oren_nayar)";

constexpr std::array<Verb, 8> table{{
    {"shade", "INPUT -o OUTPUT [--scene S.toml] [--frames 1-100x2] [flags]", "shades one G-buffer or a sequence",
     shade_details, declare_shade},
    {"check", "[INPUT] [--scene S.toml] [flags]", "compares every pixel of the device with the scalar reference",
     check_details, declare_check},
    {"bench", "[--filter REGEX] [--size WxH] [flags]", "times every kernel, with the limit and the rivals beside it",
     bench_details, declare_bench},
    {"inspect", "INPUT [flags]", "shows what is in the file, which channel plays which role, and why", inspect_details,
     declare_inspect},
    {"prefilter", "ENV -o SET", "environment image to irradiance and radiance maps (not built yet)", "",
     declare_prefilter},
    {"demo", "[DIR] [flags]", "writes a synthetic G-buffer sequence and a scene, then shades them", demo_details,
     declare_demo},
    {"devices", "[flags]", "lists the OpenCL devices that can run clshade", devices_details, declare_devices},
    {"models", "[NAME] [flags]", "lists the shading models with parameters, ranges and sources", models_details,
     declare_models},
}};

} // namespace

std::span<const Verb> verbs() {
    return table;
}

const Verb& find_verb(std::string_view name) {
    std::vector<std::string> names;
    for (const Verb& verb : table) {
        if (verb.name == name) {
            return verb;
        }
        names.emplace_back(verb.name);
    }
    names.emplace_back("help");
    throw UsageError(fmt::format("unknown verb '{}'{}; see `clshade help`", name, did_you_mean(name, names)));
}

} // namespace clshade::cli
