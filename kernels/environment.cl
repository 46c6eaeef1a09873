// Light from all around (models.md sections 6, 7 and 9; pixel rule 11): lookups in the pre-filtered maps, the ambient
// BRDF, spherical harmonics, and what the layers of a stack take on the way.
#ifndef CLSHADE_ENVIRONMENT_CL
#define CLSHADE_ENVIRONMENT_CL

#include "anisotropic.cl"
#include "diffuse.cl"
#include "exponential_integral.cl"
#include "layers.cl"
#include "lookup.cl"
#include "radiance.cl"

// Where maps begin, in records: colour records of levels 0 to 13, then the irradiance map, then what materials need.
#define IRRADIANCE_RECORD 405504.0f
#define IRRADIANCE_CELLS 48.0f
#define LAST_LEVEL 13.0f
// Where the ambient tables begin, in pair records.
#define AMBIENT_EXACT 0.0f
#define AMBIENT_LINEAR 8192.0f
#define AMBIENT_COSINES 128.0f
#define AMBIENT_EXPONENTS 64.0f
#define AMBIENT_OCTAVES 13.0f

// All that does not vary between pixels.
typedef struct {
    __constant const EnvironmentConstants* constants;
    __global const float* maps;    // colour records
    __global const float* ambient; // pair records
    __global const float* picture; // four floats a texel; only for a background
} environment;

// A place on the octahedral square, 0..1.
typedef struct {
    real x, y;
} octahedral;

// What a pixel sees of the environment, whatever its material.
typedef struct {
    octahedral mirror; // of R
    rgb band0;         // E/pi: e0,
    rgb band1;         // e1,
    rgb diffuse;       // and all of it
} surroundings;

static inline vec3 turn3(__constant const float* rows, vec3 d) {
    return make_vec3(fma(splat(rows[0]), d.x, fma(splat(rows[1]), d.y, rows[2] * d.z)),
                     fma(splat(rows[4]), d.x, fma(splat(rows[5]), d.y, rows[6] * d.z)),
                     fma(splat(rows[8]), d.x, fma(splat(rows[9]), d.y, rows[10] * d.z)));
}

// The upper hemisphere fills the diamond in the middle of the square, the lower one folds out to its corners. d may have
// any length.
static inline octahedral octahedral_of(vec3 d) {
    const real scale = 0.5f * inverse(fabs(d.x) + fabs(d.y) + fabs(d.z));
    const real x = d.x * scale; // -0.5..0.5
    const real y = d.y * scale;
    const mask below = d.z < splat(0.0f);
    const real folded_x = copysign(0.5f - fabs(y), x);
    const real folded_y = copysign(0.5f - fabs(x), y);
    octahedral o;
    o.x = 0.5f + choose(below, folded_x, x);
    o.y = 0.5f + choose(below, folded_y, y);
    return o;
}

static inline octahedral octahedral_in(environment around, vec3 world) {
    return octahedral_of(turn3(around.constants->world_to_image, world));
}

static inline rgb three(__constant const float* v) {
    return make_rgb(splat(v[0]), splat(v[1]), splat(v[2]));
}

static inline rgb add_scaled(__constant const float* v, real s, rgb sum) {
    return make_rgb(fma(splat(v[0]), s, sum.r), fma(splat(v[1]), s, sum.g), fma(splat(v[2]), s, sum.b));
}

// A map of its own, `cells` a side.
static inline tap tap_of_map(octahedral o, float cells, float first) {
    return tap_at(o.x * cells, o.y * cells, splat(cells), splat(cells), splat(first));
}

static inline rgb map_at(environment around, octahedral o, float cells, float first) {
    return fetch_colour(around.maps, tap_of_map(o, cells, first));
}

// E/pi of direction n by SH band 1.
static inline rgb linear_at(environment around, vec3 n) {
    __constant const EnvironmentConstants* c = around.constants;
    return add_scaled(c->band1[0], n.x, add_scaled(c->band1[1], n.y, scale_rgb(three(c->band1[2]), n.z)));
}

static inline rgb quadratic_at(environment around, vec3 n) {
    __constant const EnvironmentConstants* c = around.constants;
    rgb sum = scale_rgb(three(c->band2[0]), n.x * n.x);
    sum = add_scaled(c->band2[1], n.y * n.y, sum);
    sum = add_scaled(c->band2[2], n.z * n.z, sum);
    sum = add_scaled(c->band2[3], n.x * n.y, sum);
    sum = add_scaled(c->band2[4], n.y * n.z, sum);
    return add_scaled(c->band2[5], n.z * n.x, sum);
}

static inline vec3 mirrored(vec3 n, real two_ne, vec3 e) {
    return make_vec3(fma(two_ne, n.x, -e.x), fma(two_ne, n.y, -e.y), fma(two_ne, n.z, -e.z));
}

static inline surroundings surroundings_of(environment around, surface s) {
    surroundings a;
    a.mirror = octahedral_in(around, mirrored(s.n, 2.0f * s.ne, s.e));
    a.band0 = three(around.constants->band0);
    a.band1 = linear_at(around, s.n);
    a.diffuse = add_rgb(a.band0, a.band1);
#if AMBIENT_SOURCE == AMBIENT_SH3
    a.diffuse = add_rgb(a.diffuse, quadratic_at(around, s.n));
#elif AMBIENT_SOURCE == AMBIENT_MAP
    a.diffuse = map_at(around, octahedral_in(around, s.n), IRRADIANCE_CELLS, IRRADIANCE_RECORD);
#endif
    return a;
}

// log2(8192/n) levels down.
static inline real level_of(real shininess) {
    const real n = larger(shininess, splat(1.0f));
    return larger(LAST_LEVEL - log2_positive(n), splat(0.0f));
}

// Levels 2 k and 2 k + 1 have 384/2^k = 3 q cells a side, q = 2^(7-k), up to k = 3; 6 (4^8 - 4^(8-k)) = 393216 - 24 q^2
// records lie before them. All further levels have 48.
static inline tap tap_of_level(octahedral o, integer level) {
    const integer k = min(level >> 1, (integer)(4));
    const real q = AS_REAL(((integer)(134) - k) << 23);
    const real cells = larger(3.0f * q, splat(48.0f));
    const real beyond = LANES_FROM_INTEGER(level - 2 * k);
    const real first = fma(beyond, cells * cells, fma(q * q, splat(-24.0f), splat(393216.0f)));
    return tap_at(o.x * cells, o.y * cells, cells, cells, first);
}

// The radiance that a lobe around R sees.
static inline void ask_radiance(blend_request* r, octahedral o, real shininess) {
    const real level = level_of(shininess);
    const integer sharper = INTEGER_FROM_LANES(within(level, splat(LAST_LEVEL - 1.0f)));
    const real part = level - LANES_FROM_INTEGER(sharper);
    ask_blend(r, scale_tap(tap_of_level(o, sharper), 1.0f - part), scale_tap(tap_of_level(o, sharper + 1), part));
}

static inline rgb radiance_at(environment around, octahedral o, real shininess) {
    blend_request r;
    ask_radiance(&r, o, shininess);
    return answer_blend(around.maps, &r);
}

// 64 log2(n+1)/13
static inline real ambient_row(real shininess) {
    const real n = smaller(shininess, splat(8191.0f));
    return smaller((AMBIENT_EXPONENTS / AMBIENT_OCTAVES) * log2_positive(n + 1.0f), splat(AMBIENT_EXPONENTS));
}

static inline tap ambient_tap(real cosine, real row, float first) {
    const real x = smaller(cosine, splat(1.0f)) * AMBIENT_COSINES;
    return tap_at(x, row, splat(AMBIENT_COSINES), splat(AMBIENT_EXPONENTS), splat(first));
}

// A function of N.E for one exponent.
static inline real ambient_curve_at(environment around, real cosine, ulong first) {
    return curve_at(around.ambient + first, smaller(cosine, splat(1.0f)) * AMBIENT_COSINES);
}

// An anisotropic lobe is an isotropic one, spread along the axis of the smaller exponent: five lookups, placed and
// weighed by Gauss and Hermite.
typedef struct {
    real shininess; // of a lookup
    vec3 step;      // of H
} streak;

static inline streak streak_of(tangent_frame f, real shininess_u, real shininess_v) {
    const mask along_t = shininess_u <= shininess_v;
    const real wide = inverse(larger(choose(along_t, shininess_u, shininess_v), splat(1.0f)));
    const real narrow = inverse(larger(choose(along_t, shininess_v, shininess_u), splat(1.0f)));
    const real variance = larger(narrow, 0.125f * wide);
    streak k;
    k.shininess = inverse(variance);
    k.step = scale3(choose3(along_t, f.t, f.b), square_root(larger(wide - variance, splat(0.0f))));
    return k;
}

// R of the half vector N + z step.
static inline octahedral streak_mirror(environment around, surface s, streak k, float z) {
    const vec3 h = make_vec3(fma(k.step.x, splat(z), s.n.x), fma(k.step.y, splat(z), s.n.y), fma(k.step.z, splat(z), s.n.z));
    return octahedral_in(around, mirrored(h, 2.0f * dot3(h, s.e) * inverse(dot3(h, h)), s.e));
}

// What one of the lookups sees: in a map for one exponent, or (cells = 0) between levels.
static inline rgb streak_tap(environment around, surface s, streak k, float z, float cells, float first) {
    const octahedral o = streak_mirror(around, s, k, z);
    return cells > 0.0f ? map_at(around, o, cells, first) : radiance_at(around, o, k.shininess);
}

static inline rgb streak_at(environment around, surface s, streak k, float cells, float first) {
    rgb sum = scale_rgb(streak_tap(around, s, k, 0.0f, cells, first), splat(0.53333333f));
    for (int side = 0; side < 2; ++side) {
        const float sign = side == 0 ? 1.0f : -1.0f;
        const rgb near = streak_tap(around, s, k, sign * 1.3556262f, cells, first);
        const rgb far = streak_tap(around, s, k, sign * 2.8569700f, cells, first);
        sum = multiply_add_rgb(grey(splat(0.22207592f)), near, sum);
        sum = multiply_add_rgb(grey(splat(0.011257411f)), far, sum);
    }
    return sum;
}

// The exponent whose scale and bias stand for an anisotropic lobe's: sqrt((n_u + 2)(n_v + 2)) - 2.
static inline real isotropic_shininess(real shininess_u, real shininess_v) {
    return larger(square_root((shininess_u + 2.0f) * (shininess_v + 2.0f)) - 2.0f, splat(0.0f));
}

// E/pi for Lambert.
static inline rgb ambient_lambert(surroundings a) {
    return larger_rgb(a.diffuse, 0.0f);
}

// SH Oren-Nayar (section 9): factors of band 0 and of the rest.
typedef struct {
    real band0, rest;
} ambient_factors;

// E/pi for Oren-Nayar.
static inline rgb ambient_oren_nayar(surroundings a, ambient_factors f) {
    const rgb rest = scale_rgb(subtract_rgb(a.diffuse, a.band0), f.rest);
    return larger_rgb(multiply_add_rgb(a.band0, grey(f.band0), rest), 0.0f);
}

static inline rgb ambient_oren_nayar_full(surroundings a, rgb band0, real rest) {
    const rgb others = scale_rgb(subtract_rgb(a.diffuse, a.band0), rest);
    return larger_rgb(multiply_add_rgb(a.band0, band0, others), 0.0f);
}

// S = f + (f - 1)(1 - x), f = 1 - 1/(2 + 0.65 n) (9.4), which is A of the improved model.
static inline real linear_factor(oren_nayar_terms o, real x) {
    return fma(o.a - 1.0f, 1.0f - x, o.a);
}

static inline real sine_of_cosine(real x) {
    return square_root(larger((1.0f - x) * (1.0f + x), splat(0.0f)));
}

// K(x) = (2 s/pi) ((acos x - s x)/2 + x (1 + s + s^2)/(3 (1 + s)) - 1/3), s = sqrt(1 - x^2) (9.1). A smooth function of
// the angle, fitted as P(x) + s Q(x): maximum error 2e-8, and no arc cosine.
static inline real ambient_k(real cosine) {
    const real x = smaller(cosine, splat(1.0f));
    const real s = sine_of_cosine(x);
    real p = splat(0.0821081549f);
    p = fma(p, x, splat(-0.140223131f));
    p = fma(p, x, splat(-0.0592732467f));
    p = fma(p, x, splat(0.210684747f));
    p = fma(p, x, splat(-0.0932965502f));
    real q = splat(-0.0199106429f);
    q = fma(q, x, splat(0.0619516596f));
    q = fma(q, x, splat(0.105859727f));
    q = fma(q, x, splat(-0.528991938f));
    q = fma(q, x, splat(0.381089926f));
    return fma(s, q, p);
}

// 9.1, closed form.
static inline ambient_factors ambient_precise(oren_nayar_terms o, real x) {
    const ambient_factors f = {fma(o.b, ambient_k(x), o.a), linear_factor(o, x)};
    return f;
}

// 9.1, its polynomial.
static inline ambient_factors ambient_fit(oren_nayar_terms o, real x) {
    const real k = (1.0f - x) * fma(fma(x, splat(-0.20825f), splat(-0.01409f)), x, splat(0.28695f));
    const ambient_factors f = {fma(o.b, k, o.a), linear_factor(o, x)};
    return f;
}

// 9.3: D = A + 0.2623 B (1 - x).
static inline ambient_factors ambient_coarse(oren_nayar_terms o, real x) {
    const ambient_factors f = {fma(0.2623f * o.b, 1.0f - x, o.a), linear_factor(o, x)};
    return f;
}

// 9.3: D = 1 - (0.3358 + 0.1977 x)/(1 + 0.4597 n).
static inline ambient_factors ambient_coarsest(oren_nayar_terms o, real n, real x) {
    const real d = 1.0f - fma(x, splat(0.1977f), splat(0.3358f)) * inverse(fma(n, splat(0.4597f), splat(1.0f)));
    const ambient_factors f = {d, linear_factor(o, x)};
    return f;
}

// 9.2: D of the full model = 1 - 1/(2 + 0.33 n) + B K_f(x) + 0.17 rho/(1 + 0.065 n).
static inline rgb ambient_full_constant(oren_nayar_terms o, real n, real x, rgb albedo) {
    const real k = (1.0f - x) * fma(fma(x, splat(-5.7874f), splat(6.1174f)), x, splat(0.39329f)) *
                   inverse(fma(x, splat(19.838f), splat(1.0f)));
    const real d = fma(o.b, k, 1.0f - inverse(fma(n, splat(0.33f), splat(2.0f))));
    const real bounce = 0.17f * inverse(fma(n, splat(0.065f), splat(1.0f)));
    return multiply_add_rgb(albedo, grey(bounce), grey(d));
}

// 9.5: exact order-1 terms in place of S. a_N = (2/3) A + (2 B s/pi) (s^3/3 + (asin x + s x (2 x^2 - 1))/(8 x) - pi/16),
// a_T = (B s/2) (2/3 - x + x^3/3 + x (1 + s^2)/4 + 1/4).
static inline rgb ambient_order1(environment around, surroundings a, surface s, oren_nayar_terms o) {
    const real x = smaller(s.ne, splat(1.0f));
    const real x2 = x * x;
    const real sine = sine_of_cosine(x);
    const real s2 = sine * sine;
    // (asin x + s x (2 x^2 - 1))/(8 x): x^2/3 + ... near 0, where the difference would cancel.
    const real direct = (0.5f * PI_F - angle_of(sine, x) + sine * x * fma(x2, splat(2.0f), splat(-1.0f))) *
                        inverse(8.0f * larger(x, splat(1e-2f)));
    const real series = x2 * fma(x2, splat(-0.1f), splat(0.33333333f));
    const real quotient = choose(x < splat(0.1f), fma(x2 * x2 * x2, splat(-1.0f / 56.0f), series), direct);
    const real along_n = fma((2.0f * INV_PI_F) * o.b * sine,
                             fma(s2 * sine, splat(0.33333333f), quotient - 0.0625f * PI_F), 0.66666667f * o.a);
    const real along_t = 0.5f * o.b * sine *
                         (fma(x2 * x, splat(0.33333333f), 0.91666667f - x) + 0.25f * x * (1.0f + s2));
    const vec3 across = make_vec3(fma(-s.raw_ne, s.n.x, s.e.x), fma(-s.raw_ne, s.n.y, s.e.y),
                                  fma(-s.raw_ne, s.n.z, s.e.z));
    const real length2 = dot3(across, across);
    const real inverse_length = choose(length2 < splat(1e-12f), splat(0.0f), inverse_sqrt(larger(length2, splat(1e-12f))));
    // The constants hold 2/3 of the vector, as E/pi has it.
    const rgb sideways = scale_rgb(linear_at(around, across), 1.5f * along_t * inverse_length);
    const ambient_factors f = ambient_precise(o, x);
    rgb sum = multiply_add_rgb(a.band0, grey(f.band0), sideways);
    sum = multiply_add_rgb(a.band1, grey(1.5f * along_n), sum);
    const rgb rest = subtract_rgb(subtract_rgb(a.diffuse, a.band0), a.band1);
    return larger_rgb(multiply_add_rgb(rest, grey(f.rest), sum), 0.0f);
}

// Section 7: what a medium leaves of light that goes down and up at N.E (specular), or comes from all around (diffuse).
static inline real ambient_specular_deck(real absorption, real inverse_ne) {
    return larger(fma(-2.0f * absorption, inverse_ne, splat(1.0f)), splat(0.0f));
}

// 1 - a' (2 + 1/NE)
static inline real ambient_diffuse_deck(real absorption, real inverse_ne) {
    return larger(fma(-absorption, 2.0f + inverse_ne, splat(1.0f)), splat(0.0f));
}

// c = 1 - a'/NE; (c - a')^2 / c where c > a'.
static inline real ambient_diffuse_clamped(real absorption, real inverse_ne) {
    const real c = fma(-absorption, inverse_ne, splat(1.0f));
    const real left = c - absorption;
    return choose(left > splat(0.0f), left * left * inverse(larger(c, splat(1e-20f))), splat(0.0f));
}

static inline real ambient_specular_exponential(real absorption, real inverse_ne) {
    return exp2_clamped((-2.0f * 1.44269504f) * absorption * inverse_ne);
}

// a' of the approximation for alpha d: (1 - exp(-2 alpha d))/2.
static inline real approximate_absorption(real depth) {
    const real t = 2.0f * depth;
    // 1 - exp(-t) without cancellation
    const real series = t * fma(t, fma(t, fma(t, splat(-0.041666668f), splat(0.16666667f)), splat(-0.5f)), splat(1.0f));
    return 0.5f * choose(t < splat(0.03f), series, 1.0f - exp2_clamped(-1.44269504f * t));
}

// 2 E_3(a') exp(-a'/NE)
static inline real ambient_diffuse_exponential(real absorption, real inverse_ne) {
    return 2.0f * exponential_integral_3(absorption) * exp2_clamped(-1.44269504f * absorption * inverse_ne);
}

static inline rgb ambient_specular_deck_rgb(rgb a, real inverse_ne) {
    return make_rgb(ambient_specular_deck(a.r, inverse_ne), ambient_specular_deck(a.g, inverse_ne),
                    ambient_specular_deck(a.b, inverse_ne));
}

static inline rgb ambient_diffuse_deck_rgb(rgb a, real inverse_ne) {
    return make_rgb(ambient_diffuse_deck(a.r, inverse_ne), ambient_diffuse_deck(a.g, inverse_ne),
                    ambient_diffuse_deck(a.b, inverse_ne));
}

static inline rgb ambient_diffuse_clamped_rgb(rgb a, real inverse_ne) {
    return make_rgb(ambient_diffuse_clamped(a.r, inverse_ne), ambient_diffuse_clamped(a.g, inverse_ne),
                    ambient_diffuse_clamped(a.b, inverse_ne));
}

static inline rgb ambient_specular_exponential_rgb(rgb a, real inverse_ne) {
    return make_rgb(ambient_specular_exponential(a.r, inverse_ne), ambient_specular_exponential(a.g, inverse_ne),
                    ambient_specular_exponential(a.b, inverse_ne));
}

static inline rgb ambient_diffuse_exponential_rgb(rgb a, real inverse_ne) {
    return make_rgb(ambient_diffuse_exponential(a.r, inverse_ne), ambient_diffuse_exponential(a.g, inverse_ne),
                    ambient_diffuse_exponential(a.b, inverse_ne));
}

static inline rgb approximate_absorption_rgb(rgb depth) {
    return make_rgb(approximate_absorption(depth.r), approximate_absorption(depth.g), approximate_absorption(depth.b));
}

// 1 where a layer above the base has an interface.
static inline real has_interface(real f0) {
    return choose(f0 > splat(0.0f), splat(1.0f), splat(0.0f));
}

static inline rgb has_interface_rgb(rgb f0) {
    return make_rgb(has_interface(f0.r), has_interface(f0.g), has_interface(f0.b));
}

// 1 where light meets the interface in air.
static inline real met_from_air(real above) {
    return choose(above == splat(0.0f), splat(1.0f), splat(0.0f));
}

static inline rgb met_from_air_rgb(rgb above) {
    return make_rgb(met_from_air(above.r), met_from_air(above.g), met_from_air(above.b));
}

#endif
