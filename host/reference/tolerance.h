// How far a device may be from the reference.
#pragma once

#include "host/gbuffer/frame.h"

#include <limits>

namespace clshade::reference {

/// Three levels, as in OpenImageIO's idiff. A channel with reference value b is within tolerance if
///   |a - b| <= rel |b| + abs + per_irradiance I + per_roundoff S,
/// with I and S the light level and the rounding shift of the pixel (RoundingScale); a pixel if all its channels are.
/// At least `percentile` per cent of the pixels must be within tolerance, and none beyond `hard` times it.
struct Tolerance {
    double rel = 0.0;
    double abs = 0.0;
    double per_irradiance = 0.0;
    double per_roundoff = 0.0;
    double percentile = 100.0;
    double hard = std::numeric_limits<double>::infinity();

    /// What --rel, --abs and --percentile ask for: nothing else is allowed for.
    [[nodiscard]] static Tolerance plain(double rel, double abs, double percentile) {
        return {.rel = rel, .abs = abs, .percentile = percentile};
    }
};

/// What single precision can reach for a material (models.md section 14), whatever the kernel does.
///
/// rel. Diffuse models alone: 2e-6. With a lobe: 1e-5, for NH^n = exp(n/2 log1p(-|N x H|^2)): where the lobe is above
/// 3e-7 of its peak the exponent is below 15, and four roundings (6e-8 each) of it are 3.6e-6; the polynomial power,
/// normaliser, Fresnel term and division bring about as much again (section 14 measures 2.4e-6). More factors, each
/// with its roundings, get 2e-5: several layers (each above adds two Fresnel factors and an absorption, ten roundings
/// or 6e-7 each: 4e-6 for seven), fresnel = exact (a quotient of differences under two square roots), the exponent of
/// the anisotropic lobe (another five roundings of an exponent below 15: 4.5e-6) and the sum over a metal's spectrum.
///
/// per_irradiance. 3e-7 of the light level: section 14's absolute tolerance, given there for E_0 = 1. It carries what
/// cancels to nearly nothing, such as B gamma of Oren-Nayar.
///
/// per_roundoff. No form of the power helps against N, E, L and H that are themselves rounded. An error d of the angle
/// t between N and H changes the lobe by n tan(t) d, relatively. Where the lobe is above 1e-3 of its peak,
/// n t^2/2 < 6.9, so n tan(t) < sqrt(13.8 n): 168 at n = 2048, 951 at n = 65536, which is 1e-5 and 5.7e-5 for
/// d = 2^-24. In that form the allowance would still be wrong at grazing angles, where E + L nearly cancel and the
/// error of H is 1/|L + E| times that of E and L, and where N.L/N.E is a quotient of two small numbers. So the
/// reference evaluates every pixel's own shift S for one rounding of N, E, L and the parameters. Single precision needs
/// about three roundings for each of them: subtraction or decoding, normalisation, and the products of the dot
/// products.
///
/// percentile and hard. S is a first-order bound with every sign against us, so practically all pixels lie far inside:
/// the same formulas in plain single precision, on 400,000 random pixels with n up to 65536, left 0.006 % of them
/// beyond one S, 1 pixel beyond 3 S (by 6 %), and 0.9 % beyond 0. One in 10,000 may pass 3 S where first order is not
/// enough (a seam such as N.L = 0, a cone's hard edge), but none four times: a wrong formula does.
///
/// Under an environment. rel 1e-4 and percentile 99.9: radiance is bilinear in maps of 48 to 384 cells a side, and the
/// place in a map rounds to 2^-24 of the side, which S knows, while the maps themselves are sums of up to 10,000 texels
/// under a power of 8192 in single precision. per_irradiance 1e-6: bands of spherical harmonics cancel, and a filter
/// may leave out texels that weigh 1e-9 of its lobe, which a sun brings to 1e-6 of the mean.
[[nodiscard]] Tolerance default_tolerance(const BoundMaterial& material, bool environment = false);

/// Of pixels without a surface: nothing may differ; with a background, what bilinear lookup in a picture can reach.
[[nodiscard]] Tolerance background_tolerance(bool background);

} // namespace clshade::reference
