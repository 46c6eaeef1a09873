// Reading scenes: TOML text to Scene, with the place of every mistake.
#pragma once

#include "host/scene/scene.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

/// Reads and validates a scene. `overrides` are "--set" assignments such as
/// "material.default.specular.shininess=32", applied to the TOML tree before validation so that they obey the same
/// rules; `model` (may be empty) is the argument of --model, short for the specular or diffuse model of `default`.
/// Throws UsageError "FILE:LINE:COL: ..." for syntax, unknown keys (with a suggestion), wrong types, values out of
/// range, NaN, duplicate ids or names, a stack that makes no sense, a bad table of a metal, a singular camera, a
/// background without [environment]; also UsageError if a file cannot be read. The environment's picture is not looked
/// for (environment_path says where it lies).
///
/// What is left out:
///   light.name: "light1", "light2", ... by place; color: 1; cone_softness: 0
///   environment.image: the built-in studio; intensity: 1; up: what the picture says, else z; rotation_degrees: 0;
///   diffuse: sh2.   output.background: false
///   fresnel: constant; absorption_model: approximated; absorption_ibl: deck; transmittance_ibl: fresnel; a layer's
///   absorption: 0
///   specular.model: blinn_phong; f0: 0.04; shininess: 64.   diffuse.model: lambert; albedo: 0.5;
///   diffuse.ambient: precise; diffuse.shininess: the base's specular shininess (which must then be written if the
///   specular model is "none"; an anisotropic lobe has none to give).   tangent: the tangent role.   shininess_u,
///   shininess_v, metal: none the table `specular` or `diffuse` of a layer: model "none" for that part
///   camera.matrix_world, where `file` or [camera.frames.N] give frames cameras of their own (frame_camera.h)
///   [material.default]: chosen from the roles of the G-buffer (Scene::automatic)
/// `preset` stands for the keys of that preset, lowest in rank: what the file writes beside it wins, and what --set and
/// --model say wins over both. Where a model is chosen, keys of lower rank that it lacks are dropped.
///
/// Paths of metal tables are relative to the folder of `file`.
/// Overrides: the value is TOML, or a bare word. Tables on the way are created; a list of tables is entered by index
/// from 0 or, for lights, by name ("light.key.irradiance=5", "light.0.irradiance=5",
/// "material.wax.layer.0.specular.shininess=64").
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides,
                               std::string_view model);

/// The same for text in memory; `file` names it in messages and says where paths start.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& file, std::span<const std::string> overrides,
                                std::string_view model);

/// The default scene with overrides (no --scene given). The direction of its light, "key", and the studio stay in
/// camera space; an environment whose `image` or `up` an override writes stands in the world. The studio has intensity
/// 0.5, a picture 1.
[[nodiscard]] Scene default_scene(std::span<const std::string> overrides, std::string_view model);

} // namespace clshade
