// Lanes: every shading function is written once over `real`, which is a vector of LANES neighbouring pixels on devices
// that want explicit SIMD (PoCL does not vectorise work-items reliably) and a plain float on GPUs.
#ifndef CLSHADE_LANES_CL
#define CLSHADE_LANES_CL

#ifndef LANES
#define LANES 1
#endif

// Calls would pass structs of lanes through the stack; and PoCL's code generator misaligns it in some of them.
#if defined(__clang__)
#pragma clang diagnostic ignored "-Wkeyword-macro"
#undef inline
#define inline inline __attribute__((always_inline))
#endif

#if LANES == 1
typedef float real;
typedef int integer;
#define AS_REAL as_float
#define AS_INTEGER as_int
#define LANES_FROM_INTEGER convert_float
#define INTEGER_FROM_LANES convert_int // towards zero
#define LANE_INDEX 0.0f
#elif LANES == 4
typedef float4 real;
typedef int4 integer;
#define AS_REAL as_float4
#define AS_INTEGER as_int4
#define LANES_FROM_INTEGER convert_float4
#define INTEGER_FROM_LANES convert_int4 // towards zero
#define LANE_INDEX (float4)(0, 1, 2, 3)
#elif LANES == 8
typedef float8 real;
typedef int8 integer;
#define AS_REAL as_float8
#define AS_INTEGER as_int8
#define LANES_FROM_INTEGER convert_float8
#define INTEGER_FROM_LANES convert_int8 // towards zero
#define LANE_INDEX (float8)(0, 1, 2, 3, 4, 5, 6, 7)
#elif LANES == 16
typedef float16 real;
typedef int16 integer;
#define AS_REAL as_float16
#define AS_INTEGER as_int16
#define LANES_FROM_INTEGER convert_float16
#define INTEGER_FROM_LANES convert_int16 // towards zero
#define LANE_INDEX (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#else
#error "LANES must be 1, 4, 8 or 16"
#endif

// Comparisons give 1 for a true scalar and -1 for a true lane: masks are only ever combined with &, | and negated, tested
// with any_lane and spent in choose, all of which read both alike.
typedef integer mask;

#ifdef __has_builtin
#if __has_builtin(__builtin_nontemporal_store)
#define CLSHADE_NONTEMPORAL 1
#endif
#if __has_builtin(__builtin_reduce_or)
#define CLSHADE_REDUCE 1
#endif
#if LANES > 1 && __has_builtin(__builtin_prefetch)
#define CLSHADE_PREFETCH 1
#endif
#endif

#define FALSE_MASK ((mask)(0))

static inline mask negated(mask m) {
    return !m;
}

// a where the mask holds, b elsewhere.
static inline real choose(mask m, real a, real b) {
    return select(b, a, m);
}

// The smaller and the larger. Not fmin and fmax: those must drop a NaN, which costs two more instructions; here a NaN
// in the first argument goes through.
static inline real smaller(real x, real limit) {
    return x > limit ? limit : x;
}

static inline real larger(real x, real limit) {
    return x < limit ? limit : x;
}

// The same with the limit for a NaN: for numbers that become addresses.
static inline real within(real x, real limit) {
    const real low = x < limit ? x : limit;
    return low < 0.0f ? 0.0f : low;
}

static inline int any_lane(mask m) {
#if LANES > 1 && defined(CLSHADE_REDUCE)
    return __builtin_reduce_or(m) != 0; // one test of a mask register where any() shuffles
#else
    return any(m << 31);
#endif
}

// A scalar in every lane.
static inline real splat(float value) {
    return (real)(value);
}

// Number of lanes that are set; only for rare branches.
static inline uint count_lanes(mask m) {
#if LANES == 1
    return m ? 1u : 0u;
#else
    int lane[LANES];
    *(mask*)lane = m;
    uint count = 0;
    for (int i = 0; i < LANES; ++i) {
        count += lane[i] ? 1u : 0u;
    }
    return count;
#endif
}

// Planes are padded to whole groups of lanes and aligned, so a group is one aligned load.
static inline real load_plane(__global const float* planes, ulong stride, int plane, ulong pixel) {
    return *(__global const real*)(planes + (ulong)plane * stride + pixel);
}

// Asks for what the same plane holds eight cache lines ahead. Processors follow few streams by themselves and a frame
// has a dozen or more: without it a frame of 3840x2160 takes 1.15 times as long.
static inline void prefetch_plane(__global const float* planes, ulong stride, int plane, ulong pixel) {
#ifdef CLSHADE_PREFETCH
    __builtin_prefetch((const void*)(ulong)(planes + (ulong)plane * stride + pixel + 128), 0, 3);
#endif
}

// Results are not read again: past the caches, which saves reading the lines first (10-18 % of a one-light frame).
static inline void store_plane(__global float* planes, ulong stride, int plane, ulong pixel, real value) {
    __global real* target = (__global real*)(planes + (ulong)plane * stride + pixel);
#ifdef CLSHADE_NONTEMPORAL
    __builtin_nontemporal_store(value, target);
#else
    *target = value;
#endif
}

#endif
