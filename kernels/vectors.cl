// Three-component values over lanes: directions (vec3) and linear RGB (rgb). Passed by value; they live in registers.
#ifndef CLSHADE_VECTORS_CL
#define CLSHADE_VECTORS_CL

#include "lanes.cl"
#include "math.cl"

typedef struct {
    real x, y, z;
} vec3;

typedef struct {
    real r, g, b;
} rgb;

static inline vec3 make_vec3(real x, real y, real z) {
    const vec3 v = {x, y, z};
    return v;
}

static inline rgb make_rgb(real r, real g, real b) {
    const rgb c = {r, g, b};
    return c;
}

static inline rgb grey(real value) {
    return make_rgb(value, value, value);
}

static inline real dot3(vec3 a, vec3 b) {
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}

static inline vec3 add3(vec3 a, vec3 b) {
    return make_vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline vec3 scale3(vec3 a, real s) {
    return make_vec3(a.x * s, a.y * s, a.z * s);
}

static inline vec3 choose3(mask m, vec3 a, vec3 b) {
    return make_vec3(choose(m, a.x, b.x), choose(m, a.y, b.y), choose(m, a.z, b.z));
}

// One rounding of each product's difference; a compensated form was measured to gain nothing, since the rounding of the
// half vector's own components is as large.
static inline vec3 cross3(vec3 a, vec3 b) {
    return make_vec3(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x)));
}

static inline rgb add_rgb(rgb a, rgb b) {
    return make_rgb(a.r + b.r, a.g + b.g, a.b + b.b);
}

static inline rgb multiply_rgb(rgb a, rgb b) {
    return make_rgb(a.r * b.r, a.g * b.g, a.b * b.b);
}

static inline rgb scale_rgb(rgb a, real s) {
    return make_rgb(a.r * s, a.g * s, a.b * s);
}

// a b + c, per channel.
static inline rgb multiply_add_rgb(rgb a, rgb b, rgb c) {
    return make_rgb(fma(a.r, b.r, c.r), fma(a.g, b.g, c.g), fma(a.b, b.b, c.b));
}

static inline rgb larger_rgb(rgb a, float limit) {
    return make_rgb(larger(a.r, splat(limit)), larger(a.g, splat(limit)), larger(a.b, splat(limit)));
}

static inline rgb subtract_rgb(rgb a, rgb b) {
    return make_rgb(a.r - b.r, a.g - b.g, a.b - b.b);
}

static inline rgb square_root_rgb(rgb a) {
    return make_rgb(square_root(a.r), square_root(a.g), square_root(a.b));
}

static inline rgb clamp_rgb(rgb a, float low, float high) {
    return make_rgb(smaller(larger(a.r, splat(low)), splat(high)), smaller(larger(a.g, splat(low)), splat(high)),
                    smaller(larger(a.b, splat(low)), splat(high)));
}

// 1 - a, per channel.
static inline rgb complement(rgb a) {
    return make_rgb(1.0f - a.r, 1.0f - a.g, 1.0f - a.b);
}

static inline rgb choose_rgb(mask m, rgb a, rgb b) {
    return make_rgb(choose(m, a.r, b.r), choose(m, a.g, b.g), choose(m, a.b, b.b));
}

#endif
