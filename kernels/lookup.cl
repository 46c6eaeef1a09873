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

static inline real colour_record(__global const float* maps, int record) {
    return *(__global const real*)(maps + (ulong)(uint)record * 16);
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
// number to an address. Out of registers both are shuffles, of which the processor does one a cycle; and a loop over
// quarters keeps the compiler from taking them back into registers (2.4 times the one-light kernel instead of 2.9).
typedef struct {
    float4 weights[16]; // of pixel 4 q + i at [4 i + q]
    int record[16];
} staged_tap;

static inline void stage(staged_tap* to, tap t) {
    const pixel_weights w = weights_by_pixel(t);
    real* rows = (real*)to->weights;
    rows[0] = w.of0;
    rows[1] = w.of1;
    rows[2] = w.of2;
    rows[3] = w.of3;
    *(integer*)to->record = t.record;
}

static inline real weighed_record(__global const float* maps, const staged_tap* t, int quarter, int i) {
    const float4 w = t->weights[4 * i + quarter];
    return colour_record(maps, t->record[4 * quarter + i]) * (float16)(w, w, w, w);
}

static inline rgb fetch_colour(__global const float* maps, tap t) {
    staged_tap a;
    stage(&a, t);
    real sums[4];
    __attribute__((opencl_unroll_hint(1))) for (int q = 0; q < 4; ++q) {
        sums[q] = sum_quarters(weighed_record(maps, &a, q, 0), weighed_record(maps, &a, q, 1),
                               weighed_record(maps, &a, q, 2), weighed_record(maps, &a, q, 3));
    }
    return gather_quarters(sums[0], sums[1], sums[2], sums[3]);
}

static inline real weighed_records(__global const float* maps, const staged_tap* t, const staged_tap* u, int quarter,
                                   int i) {
    const float4 w = t->weights[4 * i + quarter];
    return fma(colour_record(maps, t->record[4 * quarter + i]), (float16)(w, w, w, w),
               weighed_record(maps, u, quarter, i));
}

// The sum of two taps.
static inline rgb fetch_colours(__global const float* maps, tap t, tap u) {
    staged_tap a;
    staged_tap b;
    stage(&a, t);
    stage(&b, u);
    real sums[4];
    __attribute__((opencl_unroll_hint(1))) for (int q = 0; q < 4; ++q) {
        sums[q] = sum_quarters(weighed_records(maps, &a, &b, q, 0), weighed_records(maps, &a, &b, q, 1),
                               weighed_records(maps, &a, &b, q, 2), weighed_records(maps, &a, &b, q, 3));
    }
    return gather_quarters(sums[0], sums[1], sums[2], sums[3]);
}

// Two pixels' records in one vector.
static inline real pair_records(__global const float* maps, int a, int b) {
    const float8 low = *(__global const float8*)(maps + (ulong)(uint)a * 8);
    const float8 high = *(__global const float8*)(maps + (ulong)(uint)b * 8);
    return (float16)(low, high);
}

// Quarters of w twice each: 2 Q and 2 Q + 1 for the two pixels of a vector.
#define SPREAD_PAIR_0(a) __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7)
#define SPREAD_PAIR_1(a) __builtin_shufflevector(a, a, 8, 9, 10, 11, 8, 9, 10, 11, 12, 13, 14, 15, 12, 13, 14, 15)
#define PAIR_TAP(HALF, I, A, B) (pair_records(maps, t.record.A, t.record.B) * SPREAD_PAIR_##HALF(w.of##I))

static inline pair fetch_pair(__global const float* maps, tap t) {
    const pixel_weights w = weights_by_pixel(t);
    // Quarters: first value of pixels 0-3, second of 0-3, first of 4-7, second of 4-7; then the same from 8 on.
    const real low = sum_quarters(PAIR_TAP(0, 0, s0, s4), PAIR_TAP(0, 1, s1, s5), PAIR_TAP(0, 2, s2, s6),
                                  PAIR_TAP(0, 3, s3, s7));
    const real high = sum_quarters(PAIR_TAP(1, 0, s8, sc), PAIR_TAP(1, 1, s9, sd), PAIR_TAP(1, 2, sa, se),
                                   PAIR_TAP(1, 3, sb, sf));
    const pair p = {EVEN_QUARTERS(low, high), ODD_QUARTERS(low, high)};
    return p;
}

#else

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

// The sum over four corners.
static inline float weigh(float4 corners, float w00, float w10, float w01, float w11) {
    return fma(corners.s0, w00, fma(corners.s1, w10, fma(corners.s2, w01, corners.s3 * w11)));
}

static inline rgb fetch_colour(__global const float* maps, tap t) {
    rgb colour;
#define FETCH_LANE(LANE)                                                                                               \
    {                                                                                                                  \
        __global const float4* record = (__global const float4*)maps + (ulong)(uint)LANE_OF(t.record, LANE) * 4;       \
        const float w00 = LANE_OF(t.w00, LANE);                                                                        \
        const float w10 = LANE_OF(t.w10, LANE);                                                                        \
        const float w01 = LANE_OF(t.w01, LANE);                                                                        \
        const float w11 = LANE_OF(t.w11, LANE);                                                                        \
        LANE_OF(colour.r, LANE) = weigh(record[0], w00, w10, w01, w11);                                                \
        LANE_OF(colour.g, LANE) = weigh(record[1], w00, w10, w01, w11);                                                \
        LANE_OF(colour.b, LANE) = weigh(record[2], w00, w10, w01, w11);                                                \
    }
    FOR_EACH_LANE(FETCH_LANE)
#undef FETCH_LANE
    return colour;
}

// The sum of two taps.
static inline rgb fetch_colours(__global const float* maps, tap t, tap u) {
    return add_rgb(fetch_colour(maps, t), fetch_colour(maps, u));
}

static inline pair fetch_pair(__global const float* maps, tap t) {
    pair p;
#define FETCH_LANE(LANE)                                                                                               \
    {                                                                                                                  \
        __global const float4* record = (__global const float4*)maps + (ulong)(uint)LANE_OF(t.record, LANE) * 2;       \
        const float w00 = LANE_OF(t.w00, LANE);                                                                        \
        const float w10 = LANE_OF(t.w10, LANE);                                                                        \
        const float w01 = LANE_OF(t.w01, LANE);                                                                        \
        const float w11 = LANE_OF(t.w11, LANE);                                                                        \
        LANE_OF(p.first, LANE) = weigh(record[0], w00, w10, w01, w11);                                                 \
        LANE_OF(p.second, LANE) = weigh(record[1], w00, w10, w01, w11);                                                \
    }
    FOR_EACH_LANE(FETCH_LANE)
#undef FETCH_LANE
    return p;
}

#endif

#endif
