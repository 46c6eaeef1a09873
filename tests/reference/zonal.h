// Zonal coefficients of the filtered radiance's lobe (models.md section 6): what filtering leaves of a band of
// spherical harmonics.
#pragma once

namespace clshade::reference {

/// a_l = prod_{i<l} (k - i)/(k + 2 + i), k = n/2.
inline double zonal_coefficient(double n, int l) {
    const double k = 0.5 * n;
    double a = 1.0;
    for (int i = 0; i < l; ++i) {
        a *= (k - i) / (k + 2.0 + i);
    }
    return a;
}

} // namespace clshade::reference
