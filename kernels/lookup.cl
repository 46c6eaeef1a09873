// Bilinear lookups in maps whose records hold a whole cell: the four corners that a pixel needs lie in one record, so
// that one load fetches them all (a cache line for colours). With 16 lanes the corners are weighed and added in vectors
// and brought back to one lane a pixel by shuffles, where gathers would cost three times as much.
//
// A colour record has 16 floats: r00 r10 r01 r11, g00 ..., b00 ..., unused. A pair record has 8: the corners of the
// first value, then of the second.
#ifndef CLSHADE_LOOKUP_CL
#define CLSHADE_LOOKUP_CL

#include "vectors.cl"

#if LANES == 16 && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define CLSHADE_SHUFFLES 1
#endif
#endif

// Which record, and how much of each corner: 00, 10 (right), 01 (below), 11.
typedef struct {
    integer record;
    real w00, w10, w01, w11;
} tap;

typedef struct {
    real first, second;
} pair;

// A place in a grid of `width` x `height` cells whose records start at `first`, 0 <= x <= width, 0 <= y <= height. Pixels
// without a surface may come with anything: their records are in range too.
static inline tap tap_at(real x, real y, real width, real height, real first) {
    const real column = LANES_FROM_INTEGER(INTEGER_FROM_LANES(within(x, width - 1.0f)));
    const real row = LANES_FROM_INTEGER(INTEGER_FROM_LANES(within(y, height - 1.0f)));
    const real fx = x - column;
    const real fy = y - row;
    tap t;
    t.record = INTEGER_FROM_LANES(fma(row, width, first + column)); // below 2^24: exact
    t.w11 = fx * fy;
    t.w10 = fx - t.w11;
    t.w01 = fy - t.w11;
    t.w00 = (1.0f - fy) - t.w10;
    return t;
}

static inline tap scale_tap(tap t, real s) {
    const tap scaled = {t.record, t.w00 * s, t.w10 * s, t.w01 * s, t.w11 * s};
    return scaled;
}

#if LANES == 1
#define LANE_OF(v, LANE) (v)
#define FOR_EACH_LANE(X) X(_)
#elif LANES == 4
#define LANE_OF(v, LANE) ((v).LANE)
#define FOR_EACH_LANE(X) X(s0) X(s1) X(s2) X(s3)
#elif LANES == 8
#define LANE_OF(v, LANE) ((v).LANE)
#define FOR_EACH_LANE(X) X(s0) X(s1) X(s2) X(s3) X(s4) X(s5) X(s6) X(s7)
#else
#define LANE_OF(v, LANE) ((v).LANE)
#define FOR_EACH_LANE(X)                                                                                               \
    X(s0) X(s1) X(s2) X(s3) X(s4) X(s5) X(s6) X(s7) X(s8) X(s9) X(sa) X(sb) X(sc) X(sd) X(se) X(sf)
#endif

#if LANES == 16 && defined(__AVX512F__) && defined(__has_builtin)
#if __has_builtin(__builtin_ia32_vpermi2varps512)
#define CLSHADE_PERMUTE 1
#endif
#endif

#ifdef CLSHADE_PERMUTE
// Of 128 floats those with the given numbers: four shuffles of two registers each.
static inline real permuted(__global const float* values, integer index) {
    __global const real* v = (__global const real*)values;
    const real low = choose((index & (integer)(32)) != (integer)(0), __builtin_ia32_vpermi2varps512(v[2], index, v[3]),
                            __builtin_ia32_vpermi2varps512(v[0], index, v[1]));
    const real high = choose((index & (integer)(32)) != (integer)(0), __builtin_ia32_vpermi2varps512(v[6], index, v[7]),
                             __builtin_ia32_vpermi2varps512(v[4], index, v[5]));
    return choose((index & (integer)(64)) != (integer)(0), high, low);
}
#endif

#ifdef CLSHADE_SHUFFLES

// Within each quarter of four lanes: the first two of a and b in turns, the last two in turns; the first halves of a
// and b, the last halves.
#define LOW_LANES(a, b)                                                                                                \
    __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
#define HIGH_LANES(a, b)                                                                                               \
    __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
#define LOW_HALVES(a, b)                                                                                               \
    __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
#define HIGH_HALVES(a, b)                                                                                              \
    __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)
// Quarters 0 and 2, or 1 and 3, of a and b.
#define EVEN_QUARTERS(a, b)                                                                                            \
    __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)
#define ODD_QUARTERS(a, b)                                                                                             \
    __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31)
// The four weights of a pixel side by side: quarter q of `of[i]` has those of pixel 4 q + i.
typedef struct {
    real of0, of1, of2, of3;
} pixel_weights;

static inline pixel_weights weights_by_pixel(tap t) {
    const real low_a = LOW_LANES(t.w00, t.w10);
    const real low_b = LOW_LANES(t.w01, t.w11);
    const real high_a = HIGH_LANES(t.w00, t.w10);
    const real high_b = HIGH_LANES(t.w01, t.w11);
    const pixel_weights w = {LOW_HALVES(low_a, low_b), HIGH_HALVES(low_a, low_b), LOW_HALVES(high_a, high_b),
                             HIGH_HALVES(high_a, high_b)};
    return w;
}

// Sums of each quarter of a, b, c and d: quarter q of the result has those of quarter q.
static inline real sum_quarters(real a, real b, real c, real d) {
    const real ab = LOW_LANES(a, b) + HIGH_LANES(a, b);
    const real cd = LOW_LANES(c, d) + HIGH_LANES(c, d);
    return LOW_HALVES(ab, cd) + HIGH_HALVES(ab, cd);
}

static inline real colour_record(__global const float* maps, uint offset) {
    return *(__global const real*)((__global const char*)maps + offset);
}

// From four vectors with red, green and blue of four pixels each to one of every channel.
static inline rgb gather_quarters(real a, real b, real c, real d) {
    const real red_blue_ab = EVEN_QUARTERS(a, b); // r0 b0 r1 b1
    const real red_blue_cd = EVEN_QUARTERS(c, d);
    const real green_ab = ODD_QUARTERS(a, b);
    const real green_cd = ODD_QUARTERS(c, d);
    return make_rgb(EVEN_QUARTERS(red_blue_ab, red_blue_cd), EVEN_QUARTERS(green_ab, green_cd),
                    ODD_QUARTERS(red_blue_ab, red_blue_cd));
}

// Weights and records of 16 pixels in memory: from there a load brings a pixel's weights to all quarters, and its record
// number to an address. Out of registers both are shuffles, of which the processor does one a cycle; the empty assembly
// line keeps the compiler from going back to them (2.4 times the one-light kernel instead of 2.9).
#if defined(__x86_64__) || defined(__aarch64__)
#define KEEP_IN_MEMORY(x) __asm__("" : "+m"(x))
#else
#define KEEP_IN_MEMORY(x)
#endif

typedef struct {
    float4 weights[16]; // of pixel 4 q + i at [4 i + q]
    uint offset[16];    // of the record, in bytes
} staged_tap;

static inline void stage(staged_tap* to, tap t, int log2_bytes) {
    const pixel_weights w = weights_by_pixel(t);
    real* rows = (real*)to->weights;
    rows[0] = w.of0;
    rows[1] = w.of1;
    rows[2] = w.of2;
    rows[3] = w.of3;
    *(integer*)to->offset = t.record << log2_bytes;
    KEEP_IN_MEMORY(*to);
}

// Lookups are asked for early and answered late: each takes long, and what stands between hides it.
typedef struct {
    staged_tap t;
} colour_request;

typedef struct {
    staged_tap t, u;
} blend_request;

typedef struct {
    staged_tap t;
} pair_request;

static inline void ask_colour(colour_request* r, tap t) {
    stage(&r->t, t, 6);
}

// The sum of two taps.
static inline void ask_blend(blend_request* r, tap t, tap u) {
    stage(&r->t, t, 6);
    stage(&r->u, u, 6);
}

static inline void ask_pair(pair_request* r, tap t) {
    stage(&r->t, t, 5);
}

static inline real weighed_record(__global const float* maps, const staged_tap* t, int quarter, int i) {
    const float4 w = t->weights[4 * i + quarter];
    return colour_record(maps, t->offset[4 * quarter + i]) * (float16)(w, w, w, w);
}

static inline real weighed_records(__global const float* maps, const staged_tap* t, const staged_tap* u, int quarter,
                                   int i) {
    const float4 w = t->weights[4 * i + quarter];
    return fma(colour_record(maps, t->offset[4 * quarter + i]), (float16)(w, w, w, w),
               weighed_record(maps, u, quarter, i));
}

static inline real answer_quarter(__global const float* maps, const staged_tap* t, int q) {
    return sum_quarters(weighed_record(maps, t, q, 0), weighed_record(maps, t, q, 1), weighed_record(maps, t, q, 2),
                        weighed_record(maps, t, q, 3));
}

static inline real blend_quarter(__global const float* maps, const staged_tap* t, const staged_tap* u, int q) {
    return sum_quarters(weighed_records(maps, t, u, q, 0), weighed_records(maps, t, u, q, 1),
                        weighed_records(maps, t, u, q, 2), weighed_records(maps, t, u, q, 3));
}

static inline rgb answer_colour(__global const float* maps, const colour_request* r) {
    return gather_quarters(answer_quarter(maps, &r->t, 0), answer_quarter(maps, &r->t, 1),
                           answer_quarter(maps, &r->t, 2), answer_quarter(maps, &r->t, 3));
}

static inline rgb answer_blend(__global const float* maps, const blend_request* r) {
    return gather_quarters(blend_quarter(maps, &r->t, &r->u, 0), blend_quarter(maps, &r->t, &r->u, 1),
                           blend_quarter(maps, &r->t, &r->u, 2), blend_quarter(maps, &r->t, &r->u, 3));
}

// The records of pixels i of two neighbouring quarters in one vector.
static inline real weighed_pair(__global const float* maps, const staged_tap* t, int side, int i) {
    __global const char* bytes = (__global const char*)maps;
    const float8 low = *(__global const float8*)(bytes + t->offset[8 * side + i]);
    const float8 high = *(__global const float8*)(bytes + t->offset[8 * side + 4 + i]);
    const float4 v = t->weights[4 * i + 2 * side];
    const float4 w = t->weights[4 * i + 2 * side + 1];
    return (float16)(low, high) * (float16)(v, v, w, w);
}

static inline real pair_half(__global const float* maps, const staged_tap* t, int side) {
    // Quarters: first value of four pixels, second of the same, first of the next four, second of those.
    return sum_quarters(weighed_pair(maps, t, side, 0), weighed_pair(maps, t, side, 1), weighed_pair(maps, t, side, 2),
                        weighed_pair(maps, t, side, 3));
}

static inline pair answer_pair(__global const float* maps, const pair_request* r) {
    const real low = pair_half(maps, &r->t, 0);
    const real high = pair_half(maps, &r->t, 1);
    const pair p = {EVEN_QUARTERS(low, high), ODD_QUARTERS(low, high)};
    return p;
}

#else

// The sum over the four corners of a value.
static inline float weigh(__global const float4* corners, float w00, float w10, float w01, float w11) {
    return fma(corners->s0, w00, fma(corners->s1, w10, fma(corners->s2, w01, corners->s3 * w11)));
}

#define RECORD(LANE, SIZE) ((__global const float4*)maps + (ulong)(uint)LANE_OF(t.record, LANE) * SIZE)
#define WEIGH(LANE, corners)                                                                                           \
    weigh(corners, LANE_OF(t.w00, LANE), LANE_OF(t.w10, LANE), LANE_OF(t.w01, LANE), LANE_OF(t.w11, LANE))

static inline rgb colour_at(__global const float* maps, tap t) {
    rgb colour;
#define FETCH_LANE(LANE)                                                                                               \
    LANE_OF(colour.r, LANE) = WEIGH(LANE, RECORD(LANE, 4));                                                            \
    LANE_OF(colour.g, LANE) = WEIGH(LANE, RECORD(LANE, 4) + 1);                                                        \
    LANE_OF(colour.b, LANE) = WEIGH(LANE, RECORD(LANE, 4) + 2);
    FOR_EACH_LANE(FETCH_LANE)
#undef FETCH_LANE
    return colour;
}

static inline pair pair_at(__global const float* maps, tap t) {
    pair p;
#define FETCH_LANE(LANE)                                                                                               \
    LANE_OF(p.first, LANE) = WEIGH(LANE, RECORD(LANE, 2));                                                             \
    LANE_OF(p.second, LANE) = WEIGH(LANE, RECORD(LANE, 2) + 1);
    FOR_EACH_LANE(FETCH_LANE)
#undef FETCH_LANE
    return p;
}

typedef struct {
    tap t;
} colour_request;

typedef struct {
    tap t, u;
} blend_request;

typedef struct {
    tap t;
} pair_request;

static inline void ask_colour(colour_request* r, tap t) {
    r->t = t;
}

// The sum of two taps.
static inline void ask_blend(blend_request* r, tap t, tap u) {
    r->t = t;
    r->u = u;
}

static inline void ask_pair(pair_request* r, tap t) {
    r->t = t;
}

static inline rgb answer_colour(__global const float* maps, const colour_request* r) {
    return colour_at(maps, r->t);
}

static inline rgb answer_blend(__global const float* maps, const blend_request* r) {
    return add_rgb(colour_at(maps, r->t), colour_at(maps, r->u));
}

static inline pair answer_pair(__global const float* maps, const pair_request* r) {
    return pair_at(maps, r->t);
}

#endif

// One lookup by itself.
static inline rgb fetch_colour(__global const float* maps, tap t) {
    colour_request r;
    ask_colour(&r, t);
    return answer_colour(maps, &r);
}

// A function of one variable as 128 lines: values at 0, 1, ..., 127 of x, then their slopes. 0 <= x <= 128.
#define CURVE_LINES 128

static inline real curve_at(__global const float* curve, real x) {
    const integer line = INTEGER_FROM_LANES(within(x, splat(CURVE_LINES - 1.0f)));
    const real part = x - LANES_FROM_INTEGER(line);
#ifdef CLSHADE_PERMUTE
    return fma(permuted(curve + CURVE_LINES, line), part, permuted(curve, line));
#else
    real value;
#define FETCH_LANE(LANE)                                                                                               \
    LANE_OF(value, LANE) = fma(curve[CURVE_LINES + LANE_OF(line, LANE)], LANE_OF(part, LANE), curve[LANE_OF(line, LANE)]);
    FOR_EACH_LANE(FETCH_LANE)
#undef FETCH_LANE
    return value;
#endif
}

#endif
