#include "host/scene/model_catalog.h"

#include <array>

namespace clshade {

namespace {

constexpr ParameterInfo f0{"f0", "1", "0..1, one or three numbers", "0.04; a scene without materials: the f0 role"};
constexpr ParameterInfo ior{"ior", "1", "1 or more, one or three numbers", "not used; sets f0 = ((n-1)/(n+1))^2"};
constexpr ParameterInfo shininess{"shininess", "1", "0..65536",
                                  "64; a scene without materials: the roughness or shininess role"};
constexpr ParameterInfo albedo{"albedo", "1", "0..1, one or three numbers",
                               "0.5; a scene without materials: the albedo role"};
constexpr ParameterInfo diffuse_shininess{"shininess", "1", "0..65536 (sigma^2 = 2/shininess)",
                                          "the specular shininess of the same material"};
constexpr ParameterInfo shininess_u{"shininess_u", "1", "0..65536", "along the tangent; none"};
constexpr ParameterInfo shininess_v{"shininess_v", "1", "0..65536", "across the tangent; none"};
constexpr ParameterInfo metal{"metal", "1", "a metal's name or an n,k table file", "none"};

constexpr std::array blinn_phong{f0, ior, shininess};
constexpr std::array anisotropic{f0, ior, shininess_u, shininess_v};
constexpr std::array spectral{metal, shininess};
constexpr std::array lambert{albedo};
constexpr std::array oren_nayar{albedo, diffuse_shininess};

constexpr std::array<ModelInfo, 11> models{{
    {"blinn_phong", "specular", true,
     "Blinn-Phong with a linear normaliser and a Gaussian Schlick Fresnel; diffuse weight 1 - F0",
     "Gotanda 2012, \"Approximated Blinn-Phong\"; models.md section 2",
     "The model games ship; within 1 % of the exact normaliser for a shininess of 9 and more. Below n = 9 it is too "
     "dark "
     "(46 % at n = 0): use blinn_phong_exact there.",
     blinn_phong},
    {"blinn_phong_exact", "specular", true,
     "Blinn-Phong with the closed-form normaliser and exact Schlick Fresnel; diffuse weight 1 - Schlick(F0, N.L)",
     "Gotanda 2012, \"Physically based Blinn-Phong\"; models.md section 1",
     "Right for every shininess, below n = 9 as well; never reflects more than it receives. Costs one more exponential "
     "per pixel.",
     blinn_phong},
    {"blinn_phong_anisotropic", "specular", false, "Highlights stretched along or across a tangent",
     "Gotanda 2010, anisotropic Blinn-Phong; models.md section 3", "Not built yet. For brushed metal and hair.",
     anisotropic},
    {"blinn_phong_spectral", "specular", false, "Fresnel from the complex index of refraction of a metal",
     "Gotanda 2010, spectral Fresnel; models.md section 4",
     "Not built yet. Until then give the metal's colour as f0 of blinn_phong.", spectral},
    {"lambert", "diffuse", true, "The same brightness from every side", "Lambert 1760; models.md sections 1 and 2",
     "Smooth plastics, paints, anything with shininess above about 200.", lambert},
    {"oren_nayar", "diffuse", true, "tri-Ace's improved Oren-Nayar: one division per light, no trigonometry",
     "Gotanda 2012, \"Improved Oren-Nayar\"; models.md section 8.6",
     "The first choice for rough surfaces (shininess below 30): closest to the full model with albedo around 0.4, "
     "positive and reciprocal.",
     oren_nayar},
    {"oren_nayar_full", "diffuse", true, "Oren and Nayar's full model with interreflection",
     "Oren and Nayar 1994; Gotanda 2012; models.md section 8.1",
     "The reference for the others; slow, and up to 5 % too bright at grazing view with albedo 1.", oren_nayar},
    {"oren_nayar_qualitative", "diffuse", true, "Oren and Nayar's qualitative model, with angles",
     "Oren and Nayar 1994; Gotanda 2012; models.md section 8.2",
     "What most renderers call Oren-Nayar; for comparison. Darker than the full model away from the light.",
     oren_nayar},
    {"oren_nayar_simplified_1", "diffuse", true, "The qualitative model without trigonometry",
     "Gotanda 2012, first simplification; models.md section 8.3",
     "Equal to oren_nayar_qualitative; shows what the algebra saves.", oren_nayar},
    {"oren_nayar_simplified_2", "diffuse", true, "The same with the cosine multiplied in",
     "Gotanda 2012, second simplification; models.md section 8.4",
     "Equal to oren_nayar_qualitative; the form to use of it in single precision.", oren_nayar},
    {"oren_nayar_shininess", "diffuse", true, "The simplified model with coefficients straight from the shininess",
     "Gotanda 2012, shininess parameter; models.md section 8.5",
     "As oren_nayar_qualitative, but finite down to shininess 0; one map may drive specular and diffuse.", oren_nayar},
}};

} // namespace

std::span<const ModelInfo> model_catalog() {
    return models;
}

} // namespace clshade
