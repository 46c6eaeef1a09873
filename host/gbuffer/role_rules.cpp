#include "host/gbuffer/role_rules.h"

#include <array>

namespace clshade {

namespace {

using enum Match;

// Names are matched whole, never as a part of a word: "Denoising Normal" (camera space) and "Denoising Depth" must not
// be found. Left out on purpose:
//  - V-Ray "normals", "VRayBumpNormals": a frame per pixel, not world space;
//  - Blender "GlossCol", "Glossy Color", File Output "specular", Unreal and Unity "Specular": not F0;
//  - Blender "Mist"; Unity "Smoothness" and V-Ray glossiness, which need a conversion; every object id.
constexpr std::array rules{
    // Normal
    RoleRule{Role::normal, "Normal", anywhere, true, 0, "Blender pass, OIDN or Nuke layer", "", Caution::none},
    RoleRule{Role::normal, "Ns", anywhere, false, 0, "pbrt shading normal", "", Caution::camera_space},
    RoleRule{Role::normal, "__Nworld", anywhere, false, 0, "RenderMan world-space normal", "", Caution::none},
    RoleRule{Role::normal, "BumpNormals", anywhere, false, 0, "Redshift bump normals", "", Caution::none},
    RoleRule{Role::normal, "N", anywhere, false, 1, "Arnold, Karma or File Output name", "", Caution::none},
    RoleRule{Role::normal, "WorldNormal", unreal, false, 1, "Unreal pass", "", Caution::left_handed},
    RoleRule{Role::normal, "Normals", anywhere, false, 1, "Redshift or Unity name", "", Caution::maybe_left_handed},
    RoleRule{Role::normal, "sh_normal", anywhere, false, 1, "Mitsuba shading normal", "", Caution::none},
    RoleRule{Role::normal, "normW", anywhere, false, 1, "Falcor name", "", Caution::none},
    RoleRule{Role::normal, "nrm", anywhere, true, 1, "OIDN name", "", Caution::none},
    RoleRule{Role::normal, "hitN", anywhere, false, 2, "Karma ray normal", "", Caution::none},
    RoleRule{Role::normal, "Nn", anywhere, false, 2, "RenderMan normal", "", Caution::camera_space},
    RoleRule{Role::normal, "geo_normal", anywhere, false, 3, "Mitsuba geometric normal", "", Caution::none},
    // Position
    RoleRule{Role::position, "Position", anywhere, true, 0, "Blender pass or Mitsuba name", "", Caution::none},
    RoleRule{Role::position, "__Pworld", anywhere, false, 0, "RenderMan world-space position", "", Caution::none},
    RoleRule{Role::position, "P", anywhere, false, 1, "Arnold, Karma or File Output name", "", Caution::none},
    RoleRule{Role::position, "WorldPosition", unreal, false, 1, "Redshift or Unreal name", "", Caution::none},
    RoleRule{Role::position, "posW", anywhere, false, 1, "Falcor name", "", Caution::none},
    RoleRule{Role::position, "hitP", anywhere, false, 2, "Karma ray position", "", Caution::none},
    // Depth
    RoleRule{Role::depth, "Depth", anywhere, true, 0, "Blender pass, Nuke or Redshift layer", "", Caution::none},
    RoleRule{Role::depth, "__depth", anywhere, false, 0, "RenderMan depth", "", Caution::none},
    RoleRule{Role::depth, "Z", anywhere, false, 1, "Arnold, Redshift or File Output name", "", Caution::none},
    RoleRule{Role::depth, "z", whole, false, 1, "RenderMan depth", "", Caution::none},
    RoleRule{Role::depth, "Pz", anywhere, false, 1, "Karma depth", "", Caution::none},
    RoleRule{Role::depth, "hitPz", anywhere, false, 2, "Karma ray depth", "", Caution::none},
    RoleRule{Role::depth, "WorldDepth", unreal, false, 1, "Unreal pass", "", Caution::left_handed},
    RoleRule{Role::depth, "SceneDepth", unreal, false, 2, "Unreal pass", "", Caution::left_handed},
    RoleRule{Role::depth, "VRayZDepth", anywhere, false, 3, "V-Ray element", "", Caution::unchecked_depth},
    RoleRule{Role::depth, "T", suffix, false, 4, "Mitsuba depth", "", Caution::ray_distance},
    // Diffuse albedo
    RoleRule{Role::albedo, "DiffCol", anywhere, false, 0, "Blender pass", "", Caution::none},
    RoleRule{Role::albedo, "Diffuse Color", anywhere, false, 0, "Blender pass", "", Caution::none},
    RoleRule{Role::albedo, "diffuse_albedo", anywhere, false, 0, "Arnold name", "", Caution::none},
    RoleRule{Role::albedo, "DiffuseFilter", anywhere, false, 0, "Redshift name", "", Caution::none},
    RoleRule{Role::albedo, "VRayDiffuseFilter", anywhere, false, 0, "V-Ray element", "", Caution::none},
    RoleRule{Role::albedo, "albedo", anywhere, true, 1, "common name", "", Caution::none},
    RoleRule{Role::albedo, "alb", anywhere, true, 2, "OIDN name", "", Caution::none},
    RoleRule{Role::albedo, "diffuseOpacity", anywhere, false, 2, "Falcor name", "", Caution::none},
    RoleRule{Role::albedo, "basecolor", anywhere, true, 3, "base colour", "", Caution::base_colour},
    RoleRule{Role::albedo, "BaseColor", unreal, false, 3, "Unreal pass", "", Caution::base_colour},
    RoleRule{Role::albedo, "denoise_albedo", anywhere, false, 4, "Arnold denoiser input", "",
             Caution::includes_specular},
    // Specular colour at normal incidence
    RoleRule{Role::f0, "f0", anywhere, true, 0, "AOV name", "", Caution::none},
    RoleRule{Role::f0, "specRough", anywhere, false, 1, "Falcor name", "", Caution::none},
    // Roughness, metallic, shininess, tangent
    RoleRule{Role::roughness, "roughness", anywhere, true, 0, "AOV name", "", Caution::none},
    RoleRule{Role::roughness, "Roughness", unreal, false, 1, "Unreal pass", "", Caution::none},
    RoleRule{Role::roughness, "specRough", anywhere, false, 2, "Falcor name", "A", Caution::none},
    RoleRule{Role::metallic, "metallic", anywhere, true, 0, "AOV name", "", Caution::none},
    RoleRule{Role::metallic, "metalness", anywhere, true, 1, "AOV name", "", Caution::none},
    RoleRule{Role::metallic, "Metallic", unreal, false, 1, "Unreal pass", "", Caution::none},
    RoleRule{Role::metallic, "Metal", anywhere, false, 1, "Unity name", "", Caution::none},
    RoleRule{Role::shininess, "shininess", anywhere, true, 0, "AOV name", "", Caution::none},
    RoleRule{Role::tangent, "tangent", anywhere, true, 0, "AOV name", "", Caution::none},
    RoleRule{Role::tangent, "tangentW", anywhere, false, 1, "Falcor name", "", Caution::none},
    // Material ids, never object ids
    RoleRule{Role::material_id, "IndexMA", anywhere, false, 0, "Blender pass", "", Caution::none},
    RoleRule{Role::material_id, "Material Index", anywhere, false, 0, "Blender pass", "", Caution::none},
    RoleRule{Role::material_id, "VRayMtlID", anywhere, false, 0, "V-Ray element", "", Caution::none},
    RoleRule{Role::material_id, "matid", anywhere, true, 1, "AOV name", "", Caution::none},
    RoleRule{Role::material_id, "material_id", anywhere, true, 1, "AOV name", "", Caution::none},
    RoleRule{Role::material_id, "MaterialID", anywhere, true, 1, "AOV name", "", Caution::none},
    RoleRule{Role::material_id, "mtlData", anywhere, false, 2, "Falcor name", "X", Caution::none},
    // Coverage. The alpha of UV and of colour AOVs is coverage even on an opaque film, where the picture's alpha is 1.
    // A File Output "albedo" (no view layer before it) is a pass with alpha 1, hence behind the picture's alpha.
    RoleRule{Role::coverage, "coverage", anywhere, true, 0, "AOV name", "", Caution::none},
    RoleRule{Role::coverage, "UV", anywhere, false, 1, "Blender pass", "A", Caution::none},
    RoleRule{Role::coverage, "uv", whole, false, 2, "File Output of Blender's UV pass", "Z", Caution::none},
    RoleRule{Role::coverage, "f0", anywhere, true, 3, "alpha of a colour AOV", "A", Caution::none},
    RoleRule{Role::coverage, "basecolor", anywhere, true, 4, "alpha of a colour AOV", "A", Caution::none},
    RoleRule{Role::coverage, "albedo", prefixed, true, 5, "alpha of a colour AOV", "A", Caution::none},
    RoleRule{Role::coverage, "Combined", anywhere, false, 6, "alpha of the picture", "A", Caution::beauty_alpha},
    RoleRule{Role::coverage, "", whole, false, 7, "alpha of the picture", "A", Caution::beauty_alpha},
    RoleRule{Role::coverage, "rgba", anywhere, true, 8, "alpha of the picture", "A", Caution::beauty_alpha},
    RoleRule{Role::coverage, "beauty", anywhere, true, 8, "alpha of the picture", "A", Caution::beauty_alpha},
    RoleRule{Role::coverage, "Image", anywhere, false, 8, "alpha of the picture", "A", Caution::beauty_alpha},
    RoleRule{Role::coverage, "albedo", whole, true, 9, "alpha of the albedo", "A", Caution::beauty_alpha},
    // Emission: used only where the scene maps it
    RoleRule{Role::emission, "Emit", anywhere, false, 0, "Blender pass", "", Caution::none},
    RoleRule{Role::emission, "emission", anywhere, true, 0, "Blender pass or Arnold name", "", Caution::none},
    RoleRule{Role::emission, "emissive", anywhere, true, 1, "AOV name", "", Caution::none},
};

constexpr std::array<std::string_view, 3> prefixes{"FinalImage", "MovieRenderQueue_", "FinalImageMovieRenderQueue_"};

} // namespace

std::span<const RoleRule> role_rules() {
    return rules;
}

std::span<const std::string_view> unreal_prefixes() {
    return prefixes;
}

} // namespace clshade
