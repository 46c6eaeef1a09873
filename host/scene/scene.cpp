#include "host/scene/scene.h"

#include <fmt/format.h>

namespace clshade {

std::string message_prefix(const SourceLocation& where) {
    if (where.file.empty()) {
        return {};
    }
    return where.line > 0 ? fmt::format("{}:{}:{}: ", where.file, where.line, where.column)
                          : fmt::format("{}: ", where.file);
}

std::string_view name_of(SpecularModel model) {
    switch (model) {
    case SpecularModel::none:
        return "none";
    case SpecularModel::blinn_phong:
        return "blinn_phong";
    case SpecularModel::blinn_phong_exact:
        return "blinn_phong_exact";
    case SpecularModel::blinn_phong_anisotropic:
        return "blinn_phong_anisotropic";
    case SpecularModel::blinn_phong_spectral:
        return "blinn_phong_spectral";
    }
    return {};
}

std::string_view name_of(FresnelModel model) {
    return model == FresnelModel::constant ? "constant" : "exact";
}

std::string_view name_of(AbsorptionModel model) {
    switch (model) {
    case AbsorptionModel::approximated:
        return "approximated";
    case AbsorptionModel::original:
        return "original";
    case AbsorptionModel::none:
        return "none";
    }
    return {};
}

std::string_view name_of(DiffuseModel model) {
    switch (model) {
    case DiffuseModel::none:
        return "none";
    case DiffuseModel::lambert:
        return "lambert";
    case DiffuseModel::oren_nayar:
        return "oren_nayar";
    case DiffuseModel::oren_nayar_full:
        return "oren_nayar_full";
    case DiffuseModel::oren_nayar_qualitative:
        return "oren_nayar_qualitative";
    case DiffuseModel::oren_nayar_simplified_1:
        return "oren_nayar_simplified_1";
    case DiffuseModel::oren_nayar_simplified_2:
        return "oren_nayar_simplified_2";
    case DiffuseModel::oren_nayar_shininess:
        return "oren_nayar_shininess";
    }
    return {};
}

std::string_view name_of(AmbientAbsorption absorption) {
    switch (absorption) {
    case AmbientAbsorption::deck:
        return "deck";
    case AmbientAbsorption::clamped:
        return "clamped";
    case AmbientAbsorption::exponential:
        return "exponential";
    }
    return {};
}

std::string_view name_of(AmbientTransmittance transmittance) {
    return transmittance == AmbientTransmittance::fresnel ? "fresnel" : "none";
}

std::string_view name_of(AmbientDiffuse ambient) {
    switch (ambient) {
    case AmbientDiffuse::precise:
        return "precise";
    case AmbientDiffuse::fit:
        return "fit";
    case AmbientDiffuse::coarse:
        return "coarse";
    case AmbientDiffuse::coarsest:
        return "coarsest";
    case AmbientDiffuse::full:
        return "full";
    case AmbientDiffuse::order1:
        return "order1";
    }
    return {};
}

std::string_view name_of(UpAxis up) {
    return up == UpAxis::z ? "z" : "y";
}

std::string_view name_of(AmbientSource source) {
    switch (source) {
    case AmbientSource::sh2:
        return "sh2";
    case AmbientSource::sh3:
        return "sh3";
    case AmbientSource::irradiance_map:
        return "irradiance_map";
    }
    return {};
}

std::string_view name_of(Conversion convert) {
    switch (convert) {
    case Conversion::none:
        return "none";
    case Conversion::ggx_roughness:
        return "ggx_roughness";
    case Conversion::smoothness:
        return "smoothness";
    case Conversion::oren_nayar_sigma:
        return "oren_nayar_sigma";
    case Conversion::index_of_refraction:
        return "index_of_refraction";
    }
    return {};
}

std::filesystem::path environment_path(const Scene& scene) {
    if (!scene.environment || scene.environment->image.empty()) {
        return {};
    }
    return std::filesystem::path(scene.file).parent_path() / scene.environment->image;
}

} // namespace clshade
