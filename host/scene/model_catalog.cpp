#include "host/scene/model_catalog.h"

#include <array>

namespace clshade {

namespace {

constexpr std::string_view materials = "interface of scene files";

constexpr ParameterInfo f0{"f0", "1", "0..1; one or three numbers or channels",
                           "0.04; a scene without materials: the f0 role", "models.md section 0"};
constexpr ParameterInfo ior{"ior", "1", "1 or more; one or three numbers or channels",
                            "not used; sets f0 = ((n-1)/(n+1))^2, in air", "models.md section 5"};
constexpr ParameterInfo shininess{"shininess", "1", "0..65536; a number or a channel",
                                  "64; a scene without materials: the roughness or shininess role",
                                  "models.md section 0"};
constexpr ParameterInfo shininess_u{"shininess_u", "1", "0..65536; a number or a channel",
                                    "must be written; exponent along the tangent", "models.md section 3"};
constexpr ParameterInfo shininess_v{"shininess_v", "1", "0..65536; a number or a channel",
                                    "must be written; exponent across the tangent", "models.md section 3"};
constexpr ParameterInfo tangent{"tangent", "1", "three numbers (world space, not all 0), or a role or layer",
                                "the tangent role", "models.md section 3"};
constexpr ParameterInfo metal{"metal", "nm, 1, 1", "gold, copper, or a file of lines wavelength_nm,n,k",
                              "must be written", "models.md section 4"};
constexpr ParameterInfo albedo{"albedo", "1", "0..1; one or three numbers or channels",
                               "0.5; a scene without materials: the albedo role", "models.md section 0"};
constexpr ParameterInfo diffuse_shininess{"shininess", "1", "0..65536 (sigma^2 = 2/shininess); a number or a channel",
                                          "the specular shininess of the same layer", "models.md section 8.7"};

constexpr ParameterInfo ambient{"ambient", "-",
                                "precise (closed form), fit (its polynomial), coarse, coarsest (one reciprocal), full "
                                "(of oren_nayar_full, depends on the albedo), order1 (exact linear part, bends towards "
                                "the eye)",
                                "precise; concerns light of an environment only", "models.md sections 9.1 to 9.5"};

constexpr std::array blinn_phong{f0, ior, shininess};
constexpr std::array anisotropic{f0, ior, shininess_u, shininess_v, tangent};
constexpr std::array spectral{metal, shininess};
constexpr std::array lambert{albedo};
constexpr std::array oren_nayar{albedo, diffuse_shininess, ambient};

constexpr std::array<ParameterInfo, 9> layers{{
    {"layer", "-", "one to eight tables of specular, absorption and, in the last, diffuse; top first",
     "specular and diffuse written straight into the material: one layer", "models.md section 5"},
    {"fresnel", "-", "constant, exact", "constant", "Gotanda 2012, \"Multiple Layers\"; models.md section 5"},
    {"absorption_model", "-", "approximated, original, none", "approximated",
     "Gotanda 2012, \"Multiple Layers\"; models.md section 5"},
    {"absorption", "1",
     "0 or more, of every layer but the last; one or three numbers or channels. approximated: a', physically up to "
     "0.5; original: alpha d",
     "0", "models.md section 5"},
    {"absorption_ibl", "-",
     "deck (integrated without the clamp at 0), clamped (with it), exponential (Beer-Lambert): what the media take "
     "from "
     "an environment's light",
     "deck", "Gotanda 2012, image-based lighting; models.md section 7"},
    {"transmittance_ibl", "-",
     "fresnel, none: whether the interface met from air weakens an environment's light for what lies below", "fresnel",
     "models.md section 7"},
    {"ids", "1", "whole numbers within +-16777216: values of the material_id plane",
     "none; a material other than default needs ids or names", materials},
    {"names", "-", "Cryptomatte names of the file's manifest", "none; see ids", materials},
    {"preset", "-", "a preset's name; keys written beside it override", "none", materials},
}};

constexpr std::string_view ambient_oren_nayar =
    "SH Oren-Nayar: the mean light times D, the rest times S; `ambient` chooses their form, the same for every "
    "Oren-Nayar model (models.md section 9).";

constexpr std::array<ModelInfo, 12> models{{
    {"blinn_phong", "specular",
     "Blinn-Phong with a linear normaliser and a Gaussian Schlick Fresnel; diffuse weight 1 - F0",
     "Gotanda 2012, \"Approximated Blinn-Phong\"; models.md section 2",
     "The model games ship; within 1 % of the exact normaliser for a shininess of 9 and more. Below n = 9 it is too "
     "dark (46 % at n = 0): use blinn_phong_exact there.",
     blinn_phong,
     "Reflects the filtered radiance times f0 scale + bias of AmbientBRDF with the linear normaliser; diffuse weight 1 "
     "- F0 (models.md section 6)."},
    {"blinn_phong_exact", "specular",
     "Blinn-Phong with the closed-form normaliser and exact Schlick Fresnel; diffuse weight 1 - Schlick(F0, N.L)",
     "Gotanda 2012, \"Physically based Blinn-Phong\"; models.md section 1",
     "Right for every shininess, below n = 9 as well; never reflects more than it receives. Costs one more exponential "
     "per pixel.",
     blinn_phong, "As blinn_phong with the exact normaliser; diffuse weight 20/21 (1 - F0) (models.md section 6)."},
    {"blinn_phong_anisotropic", "specular",
     "Highlights drawn out along a tangent: one exponent along it, one across; closed-form normaliser",
     "Gotanda 2010, anisotropic Blinn-Phong; Ashikhmin and Shirley 2000; models.md section 3",
     "Brushed metal, hair, satin, records. The highlight is long along the axis with the smaller exponent. Needs a "
     "tangent plane, or a constant tangent for turned or flat parts.",
     anisotropic,
     "AmbientBRDF of the mean exponent; five samples of the filtered radiance along the axis of the smaller exponent: "
     "an approximation, `check --ground-truth` measures its error (models.md section 6)."},
    {"blinn_phong_spectral", "specular",
     "Fresnel reflectance from a metal's complex index of refraction at 81 wavelengths, linear normaliser",
     "Gotanda 2010, spectral Fresnel; models.md section 4",
     "Metals, where colour shifts towards grazing view. f0 of blinn_phong is enough where that does not matter: it is "
     "off by at most 0.04 for gold and copper.",
     spectral, "Its own AmbientBRDF table, with the metal's reflectance in place of Schlick's (models.md section 6)."},
    {"lambert", "diffuse", "The same brightness from every side", "Lambert 1760; models.md sections 1 and 2",
     "Smooth plastics, paints, anything with shininess above about 200.", lambert,
     "E/pi times albedo, from spherical harmonics or the irradiance map (models.md section 6)."},
    {"oren_nayar", "diffuse", "tri-Ace's improved Oren-Nayar: one division per light, no trigonometry",
     "Gotanda 2012, \"Improved Oren-Nayar\"; models.md section 8.6",
     "The first choice for rough surfaces (shininess below 30): closest to the full model with albedo around 0.4, "
     "positive and reciprocal.",
     oren_nayar, ambient_oren_nayar},
    {"oren_nayar_full", "diffuse", "Oren and Nayar's full model with interreflection",
     "Oren and Nayar 1994; Gotanda 2012; models.md section 8.1",
     "The reference for the others; slow, and up to 5 % too bright at grazing view with albedo 1.", oren_nayar,
     ambient_oren_nayar},
    {"oren_nayar_qualitative", "diffuse", "Oren and Nayar's qualitative model, with angles",
     "Oren and Nayar 1994; Gotanda 2012; models.md section 8.2",
     "What most renderers call Oren-Nayar; for comparison. Darker than the full model away from the light.", oren_nayar,
     ambient_oren_nayar},
    {"oren_nayar_simplified_1", "diffuse", "The qualitative model without trigonometry",
     "Gotanda 2012, first simplification; models.md section 8.3",
     "Equal to oren_nayar_qualitative; shows what the algebra saves.", oren_nayar, ambient_oren_nayar},
    {"oren_nayar_simplified_2", "diffuse", "The same with the cosine multiplied in",
     "Gotanda 2012, second simplification; models.md section 8.4",
     "Equal to oren_nayar_qualitative; the form to use of it in single precision.", oren_nayar, ambient_oren_nayar},
    {"oren_nayar_shininess", "diffuse", "The simplified model with coefficients straight from the shininess",
     "Gotanda 2012, shininess parameter; models.md section 8.5",
     "As oren_nayar_qualitative, but finite down to shininess 0; one map may drive specular and diffuse.", oren_nayar,
     ambient_oren_nayar},
    {"layers", "stack",
     "One to eight layers, any lobe in any layer: each interface weakens and each medium tints what comes from below",
     "Weidlich and Wilkie 2009; Gotanda 2012, \"Multiple Layers\"; models.md section 5",
     "Varnish, clear coat, oil on skin, wet surfaces. constant and approximated are what the deck ships; exact and "
     "original cost more and are right towards grazing angles too. A layer with index 1 and no absorption changes "
     "nothing.",
     layers,
     "Each layer's lobe once, weakened by the interfaces above (transmittance_ibl) and by pre-integrated absorption "
     "(absorption_ibl) (models.md section 7)."},
}};

constexpr std::array<ParameterInfo, 6> environment{{
    {"image", "-", "a lat-long .hdr or .exr, or a folder that `clshade prefilter` wrote; relative to the scene file",
     "the built-in studio", materials},
    {"intensity", "1", "0 or more; one or three numbers: multiplies the picture", "1", materials},
    {"up", "-", "z, y: the axis of the world that row 0 of the picture lies at",
     "what the picture says of itself, else z", materials},
    {"rotation_degrees", "degrees", "any number: counter-clockwise about the up axis", "0", materials},
    {"diffuse", "-", "sh2 (bands 0, 1), sh3 (bands 0 to 2), irradiance_map: what diffuse surfaces see", "sh2",
     "models.md sections 6 and 9"},
    {"background", "-", "true, false; of [output]: the environment stands behind the objects", "false", materials},
}};

} // namespace

std::span<const ParameterInfo> environment_keys() {
    return environment;
}

std::span<const ModelInfo> model_catalog() {
    return models;
}

} // namespace clshade
