// A material's parameters at one pixel (rule 6 of host/gbuffer/frame.h), clamped, and how its interfaces meet.
#pragma once

#include "host/reference/anisotropic.h"
#include "host/reference/spectral.h"
#include "host/scene/scene.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace clshade::reference {

/// How a layer's upper interface meets what lies above it, per channel; see host/reference/layers.h.
struct Interface {
    glm::bvec3 present{false}; ///< it reflects and bends
    glm::bvec3 outer{false};   ///< met from air, m_{k-1} = 1
    glm::dvec3 above{1.0};     ///< m_{k-1}
    glm::dvec3 medium{1.0};    ///< m_k
    glm::dvec3 r{0.0};         ///< r_k: reflectance at normal incidence
};

class MetalAmbient;

struct LayerValues {
    SpecularModel specular = SpecularModel::none;
    glm::dvec3 f0{0.0};    ///< in air
    glm::dvec3 index{1.0}; ///< n_k, of f0
    double shininess = 0.0;
    double shininess_u = 0.0;
    double shininess_v = 0.0;
    glm::dvec3 tangent_read{0.0}; ///< t of rule 6: world space, any length
    TangentFrame frame;
    const SpectralMetal* metal = nullptr;        ///< spectral; belongs to the PreparedFrame
    const MetalAmbient* metal_ambient = nullptr; ///< the same, where the frame has an environment
    glm::dvec3 absorption{0.0};
    Interface interface;
};

/// One parameter set for one pixel. No memory is asked for: pixels are many.
struct MaterialValues {
    FresnelModel fresnel = FresnelModel::constant;
    AbsorptionModel absorption = AbsorptionModel::none;
    AmbientAbsorption absorption_ibl = AmbientAbsorption::deck;
    AmbientTransmittance transmittance_ibl = AmbientTransmittance::fresnel;
    DiffuseModel diffuse = DiffuseModel::none;
    AmbientDiffuse ambient = AmbientDiffuse::precise;
    glm::dvec3 albedo{0.0};
    double diffuse_shininess = 0.0;
    bool clamped = false;    ///< f0, albedo or absorption lay beyond its range by more than 1e-3
    bool no_tangent = false; ///< a tangent was missing or parallel to the normal

    /// Top first, never empty.
    [[nodiscard]] std::span<LayerValues> layers() { return {storage_.data(), count_}; }
    [[nodiscard]] std::span<const LayerValues> layers() const { return {storage_.data(), count_}; }
    [[nodiscard]] LayerValues& base() { return storage_[count_ - 1]; }
    [[nodiscard]] const LayerValues& base() const { return storage_[count_ - 1]; }
    /// 1 to most_layers, else std::out_of_range.
    void resize(std::size_t count) {
        static_cast<void>(storage_.at(count - 1));
        count_ = count;
    }

  private:
    std::array<LayerValues, most_layers> storage_;
    std::size_t count_ = 1;
};

} // namespace clshade::reference
