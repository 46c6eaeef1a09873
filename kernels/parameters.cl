// Material parameters: from planes or constants to the values the models take (pixel rule 6).
#ifndef CLSHADE_PARAMETERS_CL
#define CLSHADE_PARAMETERS_CL

#include "surface.cl"

#define LARGEST_SHININESS 65536.0f
// Albedo or F0 outside [0, 1] by more than this is counted.
#define CLAMP_SLACK 1e-3f

// A plane's value: as it is, divided by coverage if it was averaged over it, then scaled if the scene says so.
static inline real averaged(real value, surface s) {
    return value * s.unpremultiply;
}

static inline real scaled(real value, float scale, float offset) {
    return fma(value, splat(scale), splat(offset));
}

// A Cryptomatte id is a hash in the bits of a float (pixel rule 7).
static inline mask has_name(real id, uint bits) {
    return AS_INTEGER(id) == (integer)((int)bits);
}

// Ids are whole numbers in float planes (pixel rule 7). A filtered plane holds halves often: they go to the even
// number, as IEEE arithmetic rounds. From 2^23 on floats are whole, so that a sum with it has no fraction.
static inline real nearest_whole(real id) {
    const real big = choose(id < splat(0.0f), splat(-8388608.0f), splat(8388608.0f));
    return choose(fabs(id) < splat(8388608.0f), (id + big) - big, id);
}

static inline mask has_id(real whole_id, float wanted) {
    return whole_id == splat(wanted);
}

// Further than 0.01 from a whole number: the plane was filtered.
static inline mask is_fractional(real id, real whole_id) {
    return fabs(id - whole_id) > splat(0.01f);
}

// n = 2/r^4 - 2 for a GGX roughness r (alpha = r^2); r = 0 gives Inf, which the clamp takes to the largest shininess.
static inline real shininess_from_ggx_roughness(real r) {
    const real r2 = r * r;
    return 2.0f / (r2 * r2) - 2.0f;
}

static inline real shininess_from_smoothness(real smoothness) {
    return shininess_from_ggx_roughness(1.0f - smoothness);
}

// n = 2/sigma^2 (models.md section 8.7).
static inline real shininess_from_oren_nayar_sigma(real sigma) {
    return 2.0f / (sigma * sigma);
}

// F0 = ((n - 1) / (n + 1))^2 of an index of refraction; below 1 counts as 1.
static inline real f0_from_index(real n) {
    const real index = larger(n, splat(1.0f));
    const real amplitude = (index - 1.0f) / (index + 1.0f);
    return amplitude * amplitude;
}

static inline real clamp_shininess(real n) {
    return smaller(larger(n, splat(0.0f)), splat(LARGEST_SHININESS));
}

static inline real clamp_unit(real v) {
    return smaller(larger(v, splat(0.0f)), splat(1.0f));
}

static inline rgb clamp_unit_rgb(rgb v) {
    return make_rgb(clamp_unit(v.r), clamp_unit(v.g), clamp_unit(v.b));
}

// Where a colour leaves [0, 1] by more than rounding.
static inline mask outside_unit(rgb v) {
    const real low = smaller(v.r, smaller(v.g, v.b));
    const real high = larger(v.r, larger(v.g, v.b));
    return (low < splat(-CLAMP_SLACK)) | (high > splat(1.0f + CLAMP_SLACK));
}

// Where an absorption is negative by more than rounding.
static inline mask below_zero(rgb v) {
    return smaller(v.r, smaller(v.g, v.b)) < splat(-CLAMP_SLACK);
}

#endif
