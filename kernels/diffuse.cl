// Diffuse models: Lambert and the Oren-Nayar family (models.md section 8), as pi f_cos / albedo,
// that is pi L / rho of the formulas for E_0 = 1; the caller multiplies by albedo/pi. Only the full model is not linear in
// the albedo.
// sigma^2 = 2 / shininess is put into every quotient s2/(s2 + c) = 2/(2 + c shininess), which stays finite at
// shininess 0 (infinitely rough) and becomes Lambert, exactly, for shininess towards infinity.
#ifndef CLSHADE_DIFFUSE_CL
#define CLSHADE_DIFFUSE_CL

#include "lights.cl"

static inline real lambert(incidence i) {
    return i.nl;
}

// What of an Oren-Nayar model does not depend on the light.
typedef struct {
    real a, b;
} oren_nayar_terms;

// gamma = E.L - N.E N.L = sin(theta_i) sin(theta_r) cos(dphi).
static inline real gamma_of(incidence i, surface s) {
    return fma(-s.ne, i.nl, i.el);
}

// Section 8.6, the deck's improved model: A = 1 - 1/(2 + 0.65 n), B = 1/(2.22222 + 0.1 n); one division for both.
static inline oren_nayar_terms oren_nayar_terms_of(real n) {
    const real p = fma(n, splat(0.65f), splat(2.0f));
    const real q = fma(n, splat(0.1f), splat(2.22222f));
    const real r = inverse(p * q);
    const oren_nayar_terms t = {1.0f - q * r, p * r};
    return t;
}

// L = rho/pi (NL A + B gamma t), t = min(1, NL/NE) where gamma >= 0, else NL.
static inline real oren_nayar(incidence i, surface s, oren_nayar_terms o) {
    const real gamma = gamma_of(i, s);
    const real t = choose(gamma >= splat(0.0f), i.ratio, i.nl);
    return fma(i.nl, o.a, o.b * gamma * t);
}

// Section 8.5: A = 1 - 1/(2 + 0.33 n), B = 1/(2.22222 + 0.1 n) in the form of 8.4.
static inline oren_nayar_terms oren_nayar_shininess_terms_of(real n) {
    const real p = fma(n, splat(0.33f), splat(2.0f));
    const real q = fma(n, splat(0.1f), splat(2.22222f));
    const real r = inverse(p * q);
    const oren_nayar_terms t = {1.0f - q * r, p * r};
    return t;
}

// Sections 8.2 to 8.4: A = C1 = 1 - 0.5 s2/(s2 + 0.33), B = 0.45 s2/(s2 + 0.09).
static inline oren_nayar_terms oren_nayar_qualitative_terms_of(real n) {
    const real p = fma(n, splat(0.33f), splat(2.0f));
    const real q = fma(n, splat(0.09f), splat(2.0f));
    const real r = inverse(p * q);
    const oren_nayar_terms t = {1.0f - q * r, 0.9f * p * r};
    return t;
}

// Section 8.4: L = rho/pi (NL A + B max(0, gamma) min(1, NL/NE)).
static inline real oren_nayar_simplified_2(incidence i, surface s, oren_nayar_terms o) {
    const real gamma = larger(gamma_of(i, s), splat(0.0f));
    return fma(i.nl, o.a, o.b * gamma * i.ratio);
}

// Section 8.3: L = rho/pi NL (A + B max(0, gamma) / max(NL, NE)).
static inline real oren_nayar_simplified_1(incidence i, surface s, oren_nayar_terms o) {
    const real gamma = larger(gamma_of(i, s), splat(0.0f));
    const real quotient = gamma / larger(i.nl, s.ne);
    return i.nl * fma(o.b, quotient, o.a);
}

// Sines and cosines of the two polar angles, the larger angle as alpha, the smaller as beta.
typedef struct {
    real cos_alpha, sin_alpha, cos_beta, sin_beta;
    real cos_dphi; // 0 where either sine is below 1e-7
} polar_angles;

static inline real sine_of(real cosine) {
    return sqrt(larger((1.0f - cosine) * (1.0f + cosine), splat(0.0f)));
}

static inline polar_angles polar_angles_of(incidence i, surface s) {
    const real nl = smaller(i.nl, splat(1.0f));
    const real ne = smaller(s.ne, splat(1.0f));
    const real sin_i = sine_of(nl);
    const real sin_r = sine_of(ne);
    const mask light_lower = nl < ne; // the light stands at the larger angle
    polar_angles a;
    a.cos_alpha = choose(light_lower, nl, ne);
    a.sin_alpha = choose(light_lower, sin_i, sin_r);
    a.cos_beta = choose(light_lower, ne, nl);
    a.sin_beta = choose(light_lower, sin_r, sin_i);
    const mask tilted = (sin_i >= splat(1e-7f)) & (sin_r >= splat(1e-7f));
    const real cosine = gamma_of(i, s) / choose(tilted, sin_i * sin_r, splat(1.0f));
    a.cos_dphi = choose(tilted, smaller(larger(cosine, splat(-1.0f)), splat(1.0f)), splat(0.0f));
    return a;
}

// Section 8.2: L = rho/pi NL (A + B max(0, cos dphi) sin(alpha) tan(beta)).
static inline real oren_nayar_qualitative(incidence i, surface s, oren_nayar_terms o) {
    const polar_angles p = polar_angles_of(i, s);
    const real bend = larger(p.cos_dphi, splat(0.0f)) * p.sin_alpha * p.sin_beta / p.cos_beta;
    return i.nl * fma(o.b, bend, o.a);
}

// Section 8.1, the full model of 1994: L1 + L2.
typedef struct {
    real c1, c2, c3, l2; // C1, and the factors of C2, C3 and L2 that depend on roughness alone
} oren_nayar_full_terms;

static inline oren_nayar_full_terms oren_nayar_full_terms_of(real n) {
    oren_nayar_full_terms t;
    const real r = inverse(fma(n, splat(0.09f), splat(2.0f)));
    t.c1 = 1.0f - inverse(fma(n, splat(0.33f), splat(2.0f)));
    t.c2 = 0.9f * r;
    t.c3 = 0.25f * r;
    t.l2 = 0.34f * inverse(fma(n, splat(0.13f), splat(2.0f)));
    return t;
}

// Two parts, since L2 holds the albedo squared: albedo (first + albedo second).
typedef struct {
    real first, second;
} oren_nayar_full_value;

static inline oren_nayar_full_value oren_nayar_full(incidence i, surface s, oren_nayar_full_terms t) {
    const polar_angles p = polar_angles_of(i, s);
    const real alpha = angle_of(p.sin_alpha, p.cos_alpha);
    const real beta = angle_of(p.sin_beta, p.cos_beta);
    const real two_beta_over_pi = beta * (2.0f * INV_PI_F);
    const real tan_beta = p.sin_beta / p.cos_beta;
    // tan((alpha + beta)/2) = (sin alpha + sin beta) / (cos alpha + cos beta)
    const real tan_mean = (p.sin_alpha + p.sin_beta) / (p.cos_alpha + p.cos_beta);
    const real cube = two_beta_over_pi * two_beta_over_pi * two_beta_over_pi;
    const real c2 = t.c2 * (p.sin_alpha - choose(p.cos_dphi < splat(0.0f), cube, splat(0.0f)));
    const real product = alpha * two_beta_over_pi * (2.0f * INV_PI_F); // 4 alpha beta / pi^2
    const real c3 = t.c3 * product * product;
    const real l1 = t.c1 + p.cos_dphi * c2 * tan_beta + (1.0f - fabs(p.cos_dphi)) * c3 * tan_mean;
    const real l2 = t.l2 * (1.0f - p.cos_dphi * two_beta_over_pi * two_beta_over_pi);
    const real common = i.nl;
    const oren_nayar_full_value value = {common * l1, common * l2};
    return value;
}

#endif
