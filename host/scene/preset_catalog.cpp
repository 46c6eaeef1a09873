#include "host/scene/model_catalog.h"

#include <array>

namespace clshade {

namespace {

// The red channel is the stack of the test vectors of models.md section 10.1: n1 = 1.47, n2 = 1.40, a' = 0.02, albedo
// 0.6. The absorption of green and blue stays within that section's 0..0.05.
constexpr std::string_view skin = R"([material.skin]
fresnel = "constant"
absorption_model = "approximated"

[[material.skin.layer]]             # oil and moisture
specular = { model = "blinn_phong", ior = 1.47, shininess = 128 }
absorption = [0.02, 0.028, 0.034]

[[material.skin.layer]]             # matte skin; 5.945 = 2 / 0.58^2, a slope deviation of 0.58
specular = { model = "blinn_phong", ior = 1.40, shininess = 12 }
diffuse = { model = "oren_nayar", albedo = [0.60, 0.40, 0.31], shininess = 5.945 }
)";

// f0 of the base is in air; under the coat, against n = 1.5 and through it, (0.25, 0.011, 0.0045) is left of it.
constexpr std::string_view car_paint = R"([material.car_paint]
fresnel = "constant"
absorption_model = "approximated"

[[material.car_paint.layer]]        # clear coat
specular = { model = "blinn_phong", ior = 1.5, shininess = 2048 }
absorption = [0.002, 0.006, 0.010]

[[material.car_paint.layer]]        # metal flakes in pigment
specular = { model = "blinn_phong", f0 = [0.42, 0.09, 0.07], shininess = 60 }
diffuse = { model = "lambert", albedo = [0.32, 0.015, 0.012] }
)";

// Wood fibre (cellulose) has nearly the lacquer's index: coated wood shows its own highlight hardly at all and looks
// deeper, as in nature.
constexpr std::string_view lacquered_wood = R"([material.lacquered_wood]
fresnel = "constant"
absorption_model = "approximated"

[[material.lacquered_wood.layer]]   # lacquer, warm
specular = { model = "blinn_phong", ior = 1.5, shininess = 512 }
absorption = [0.015, 0.05, 0.12]

[[material.lacquered_wood.layer]]   # wood
specular = { model = "blinn_phong", ior = 1.55, shininess = 16 }
diffuse = { model = "oren_nayar", albedo = [0.42, 0.25, 0.13], shininess = 8 }
)";

constexpr std::string_view brushed_metal = R"([material.brushed_metal]
# Stainless steel, turned about the world's Z axis: the grooves run round it, so that highlights are long along it.
# For a flat part write the tangent across its grooves, or tangent = "tangent" for a plane that holds it.
specular = { model = "blinn_phong_anisotropic", f0 = [0.67, 0.64, 0.60], shininess_u = 12, shininess_v = 700, tangent = [0, 0, 1] }
)";

// 1.54: index of silk and viscose fibres, the pile of velvet. A slope deviation of 1: facets in every direction.
constexpr std::string_view cloth = R"([material.cloth]
# Pile of fibres: a wide sheen that grows towards grazing angles over a very rough body.
specular = { model = "blinn_phong_exact", ior = 1.54, shininess = 2 }
diffuse = { model = "oren_nayar", albedo = [0.26, 0.03, 0.07], shininess = 2 }
)";

constexpr std::string_view gold = R"([material.gold]
specular = { model = "blinn_phong_spectral", metal = "gold", shininess = 256 }
)";

constexpr std::array<PresetInfo, 6> presets{{
    {"skin", "Matte skin under oil and moisture", "Gotanda 2012, \"Skin\"; models.md section 10.1", skin},
    {"car_paint", "Metallic paint under a clear coat", "models.md section 5; flakes as a coloured f0", car_paint},
    {"lacquered_wood", "Rough wood under a warm lacquer", "models.md sections 5 and 8.6", lacquered_wood},
    {"brushed_metal", "Turned stainless steel with long highlights", "models.md section 3", brushed_metal},
    {"cloth", "Velvet-like cloth: wide sheen over a very rough body", "models.md sections 1 and 8.6", cloth},
    {"gold", "Polished gold from its optical constants", "models.md section 4", gold},
}};

} // namespace

std::span<const PresetInfo> preset_catalog() {
    return presets;
}

} // namespace clshade
