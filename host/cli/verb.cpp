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
frame found on disk is shaded. A frame that fails does not stop the others: it is named, and the exit code is 4.

Frames are read, shaded and written side by side: as many as --threads keeps busy and --max-mem holds. A frame that
does not fit is shaded in bands of rows. The bytes of an output depend on neither. The kernel is built once a run.

An output is written under a temporary name, forced to the medium, stamped as complete and renamed. -u skips frames
whose output is complete and undamaged by its stamp, comes of the same scene and flags, and is newer than G-buffer,
scene, cameras, environment and program. SIGINT and SIGTERM discard the frames in hand within a second (exit code 130,
143); -u goes on from there, after a power cut and kill -9 as well. Any number of processes may share folders and the
kernel cache. --json lists every frame with hashes, bytes, times and warnings.

Cameras by frame: [camera.frames.101] in the scene gives frame 101 its own, keys missing there come from [camera]; file =
"camera.%04d.json" (or .toml) under [camera] names a side file for each frame with matrix_world and fov_x_degrees,
fov_y_degrees or orthographic_height, at top level or under `camera`. Listed frames win; a missing side file is an error.

Without --scene: albedo role (else 0.5), f0 role (else 0.04), roughness or shininess role (else shininess 64), a key
light over the camera's left shoulder and the built-in studio around. `clshade inspect INPUT` tells which channels play
which role.

[environment] of a scene lights it from all around: image = "FILE" is a lat-long .hdr or .exr, or a folder that
`clshade prefilter` wrote; without image it is the built-in studio. It is pre-filtered once, which takes about a second,
and kept on disk for later runs. background = true under [output] shows it behind the objects, where alpha becomes 1.
`clshade models environment` lists the keys.

Materials are stacks of one to eight layers and claim pixels by `ids` (material_id plane) or `names` (Cryptomatte); the
rest goes to material.default. `clshade models` lists lobes, diffuse models, stack keys and presets. --model takes any of
the models by itself; one that needs keys of its own (blinn_phong_anisotropic, blinn_phong_spectral) gets them by --set.

OUTPUT.exr holds R, G, B (radiance), A (coverage) and what --aov and --keep ask for; the AOVs of all lights and of the
environment add up to what is reflected. OUTPUT.png is a preview for the screen.

--dump-kernel: of a sequence the first frame's program lies in DIR, further ones with other planes or materials in
DIR/2, DIR/3, ...; start reading at shade.cl and materials.cl.

Examples:
  clshade shade in.exr -o out.exr
  clshade shade in.exr -o preview.png --set material.default.specular.shininess=200
  clshade shade in.exr -o out.exr --set material.default.preset=skin
  clshade shade in.exr -o out.exr --model blinn_phong_spectral --set material.default.specular.metal=copper
  clshade shade in.exr -o out.exr --model blinn_phong_anisotropic --set material.default.specular.shininess_u=20 \
      --set material.default.specular.shininess_v=400
  clshade shade in.exr -o out.exr --set environment.image=studio.hdr --set environment.rotation_degrees=90
  clshade shade in.exr -o out.exr --scene look.toml --aov diffuse,specular,environment
  clshade shade in.exr -o out.exr --scene look.toml --dump-kernel kernel
  clshade shade in.####.exr -o out.####.exr --scene look.toml --frames 1-100x2 -u
  clshade shade in.%04d.exr -o out.%04d.exr --set camera.file=camera.%04d.json --runstats
  clshade shade in.#.exr -o out.#.exr --chunk 2/8 -u --progress openjd --json report.json)";

constexpr std::string_view check_details =
    R"(With INPUT: shades it on the device and with the scalar double-precision reference and compares every pixel, grouped
by what the material is made of. Without INPUT: a seeded random G-buffer for every lobe with every diffuse model, single
layers with exact Fresnel, stacks of two to eight layers, random stacks (--seed) and every preset; then the same in an
environment, which the reference filters by itself, with and without lights.

A row is called after its stack: LOBE.DIFFUSE, or layersN.LOBES.DIFFUSE.FRESNEL.ABSORPTION with the lobes from the top
down; @NAME tells a preset, a random stack or an environment with what it does (environment.SOURCE...). Long names are
shortened in the table, whole in --json.

A value agrees when |device - reference| <= REL * |reference| + ABS. A row passes when at least PERCENTILE percent of
its pixels agree, the hard limits of its models hold, and both sides count the same pixels as non-finite and as without
a tangent. Ends with 3 when any row fails.

Device and reference share the approximations that real-time light from an environment rests on: split sums, few bands
of spherical harmonics, pre-integrated absorption. --ground-truth N tells what those cost: it integrates environment
times BRDF by brute force at N pixels of INPUT (without INPUT: N for each of a set of materials in the built-in studio),
prints the errors of the approximation and always ends with 0. --json has the table under `ground_truth`.

Examples:
  clshade check
  clshade check in.exr --scene look.toml --dump difference.exr
  clshade check --device 1 --lanes 8 --json check.json
  clshade check in.exr --scene look.toml --ground-truth 200)";

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
depth, normal) and for the material ids. Of the scene's environment it tells size, mean radiance and what was wrong with
it.

Examples:
  clshade inspect in.exr
  clshade inspect in.exr --scene look.toml --json roles.json)";

constexpr std::string_view prefilter_details =
    R"(Filters a lat-long picture (.hdr, .exr) for every shininess and writes the folder SET: radiance_n8192.exr to
radiance_n0001.exr and irradiance.exr (E/pi) on octahedral grids, sh.exr with bands 0 to 2, ambient_brdf.exr with scale
and bias. A scene takes SET in place of the picture: image = "SET" under [environment].

`shade` pre-filters by itself and keeps the result in the cache, as this verb does; the folder is for looking at and for
taking elsewhere. The table shows the mean of each map beside the picture's: filtering keeps energy, suns included.
NaN and Inf become black, negative channels 0; both are counted. With --max-mem a picture that would take more is halved
while it is read.

Examples:
  clshade prefilter studio.hdr -o studio_set
  clshade prefilter studio.hdr -o studio_set --runstats --json report.json)";

constexpr std::string_view demo_details =
    R"(Makes DIR/gbuffer.0001.exr ... (multi-layer EXR with camera), DIR/studio.exr (an environment), DIR/scene.toml,
DIR/shaded.0001.exr and .png ...

Example:
  clshade demo && clshade inspect clshade-demo/gbuffer.0001.exr)";

constexpr std::string_view devices_details =
    R"(The index, any part of 'platform/name' that fits one device only, or cpu | gpu is what --device takes.)";

constexpr std::string_view models_details =
    R"(Lists lobes, diffuse models, the keys that hold a stack of layers together, and presets: whole materials to start from.
`clshade models NAME` documents each parameter with unit, range, default and source, and prints a preset as TOML.

Thumbnails are shaded by this very program: a turned body in a studio of many small lights.

Examples:
  clshade models
  clshade models oren_nayar
  clshade models skin
  clshade models --thumbnails docs/presets)";

constexpr std::array<Verb, 8> table{{
    {"shade", "INPUT -o OUTPUT [--scene S.toml] [--frames 1-100x2] [flags]", "shades one G-buffer or a sequence",
     shade_details, declare_shade},
    {"check", "[INPUT] [--scene S.toml] [flags]", "compares every pixel of the device with the scalar reference",
     check_details, declare_check},
    {"bench", "[--filter REGEX] [--size WxH] [flags]", "times every kernel, with the limit and the rivals beside it",
     bench_details, declare_bench},
    {"inspect", "INPUT [flags]", "shows what is in the file, which channel plays which role, and why", inspect_details,
     declare_inspect},
    {"prefilter", "ENV -o SET [flags]", "environment picture to pre-filtered radiance, irradiance and SH maps",
     prefilter_details, declare_prefilter},
    {"demo", "[DIR] [flags]", "writes a synthetic G-buffer sequence, environment and scene, then shades them",
     demo_details, declare_demo},
    {"devices", "[flags]", "lists the OpenCL devices that can run clshade", devices_details, declare_devices},
    {"models", "[NAME] [flags]", "lists the shading models and presets with parameters, ranges and sources",
     models_details, declare_models},
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
