// AmbientBRDF: how much of a constant environment a lobe reflects (models.md section 6).
#pragma once

#include "host/reference/lazy_table.h"
#include "host/reference/spectral.h"

#include <glm/glm.hpp>

#include <vector>

namespace clshade::reference {

/// Which normaliser a lobe has (models.md sections 1 and 2).
enum class Normaliser { exact, linear };

/// For Schlick's Fresnel term: reflected radiance is F0 scale + bias in an environment of radiance 1.
struct AmbientBrdf {
    double scale = 0.0; ///< Norm int NH^n min(1, NL/NE) (1 - Fc) dw, Fc = (1 - EH)^5
    double bias = 0.0;  ///< Norm int NH^n min(1, NL/NE) Fc dw
};

/// By integration; n >= 0, N.E in 1e-4..1. Better than 1e-9, relative.
[[nodiscard]] AmbientBrdf ambient_brdf(double n, double ne, Normaliser normaliser);

/// Bilinear in the table of host/environment/filter_layout.h, as rule 11 of host/gbuffer/frame.h says. The table is
/// made where it is read, once for the whole program.
[[nodiscard]] AmbientBrdf ambient_brdf_of_table(double n, double ne, Normaliser normaliser);

/// The same for a metal's own reflectance curve: Norm int NH^n min(1, NL/NE) R(EH) dw per channel.
class MetalAmbient {
  public:
    explicit MetalAmbient(const SpectralMetal& metal);

    /// By integration.
    [[nodiscard]] glm::dvec3 integrated(double n, double ne, Normaliser normaliser) const;
    /// Bilinear in the metal's table.
    [[nodiscard]] glm::dvec3 of_table(double n, double ne, Normaliser normaliser) const;
    /// R at a cosine: cubic between 2049 values in air, within 1e-9 of the spectrum's sum.
    [[nodiscard]] glm::dvec3 reflectance(double cosine) const;

  private:
    std::vector<glm::dvec3> curve_;
    LazyTable<glm::dvec3> vertices_; ///< for the exact normaliser
};

} // namespace clshade::reference
