// Fresnel reflectance of metals from complex indices of refraction (models.md section 4). The sum over the spectrum is
// done on the host (host/shading/metal_curve.cpp), which fits a polynomial per channel to it; a table would cost a
// gather per lane.
#ifndef CLSHADE_SPECTRAL_CL
#define CLSHADE_SPECTRAL_CL

#include "vectors.cl"

// The polynomials' argument: c = 0..1 to x = -1..1, denser near 0 where the reflectance of metals bends.
static inline real metal_argument(real c, float bend) {
    return fma(c * inverse(c + bend), splat(2.0f * (1.0f + bend)), splat(-1.0f));
}

// One step of Horner's scheme for three polynomials.
static inline rgb horner(rgb p, real x, float r, float g, float b) {
    return make_rgb(fma(p.r, x, splat(r)), fma(p.g, x, splat(g)), fma(p.b, x, splat(b)));
}

#endif
