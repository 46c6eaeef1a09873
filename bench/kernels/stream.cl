// The same bytes as a shading kernel and next to no arithmetic, with non-temporal stores: the limit that the device's
// memory sets. Output plane k gets (k + 1) times the sum of the input planes.
// LANES: floats per work-item (1, 4, 8, 16). PLANES_IN (1 to 16), PLANES_OUT (1 to 4): what the kernel it stands beside moves.
#ifndef LANES
#define LANES 16
#endif
#ifndef PLANES_IN
#define PLANES_IN 13
#endif
#ifndef PLANES_OUT
#define PLANES_OUT 4
#endif

#if LANES == 1
typedef float real;
#elif LANES == 4
typedef float4 real;
#elif LANES == 8
typedef float8 real;
#else
typedef float16 real;
#endif

#ifdef __has_builtin
#if __has_builtin(__builtin_nontemporal_store)
#define STORE(value, address) __builtin_nontemporal_store(value, address)
#endif
#endif
#ifndef STORE
#define STORE(value, address) (*(address) = (value))
#endif

// Written out by the preprocessor: a loop in a work-item can keep PoCL from vectorising over work-items.
#define READ(p) sum += in[(p) * in_stride + i];

/// `in_stride`, `out_stride`: from one plane to the next in units of LANES floats.
kernel void stream(global const real* restrict in, const uint in_stride, global real* restrict out,
                   const uint out_stride) {
    const size_t i = get_global_id(0);
    real sum = in[i];
#if PLANES_IN > 1
    READ(1)
#endif
#if PLANES_IN > 2
    READ(2)
#endif
#if PLANES_IN > 3
    READ(3)
#endif
#if PLANES_IN > 4
    READ(4)
#endif
#if PLANES_IN > 5
    READ(5)
#endif
#if PLANES_IN > 6
    READ(6)
#endif
#if PLANES_IN > 7
    READ(7)
#endif
#if PLANES_IN > 8
    READ(8)
#endif
#if PLANES_IN > 9
    READ(9)
#endif
#if PLANES_IN > 10
    READ(10)
#endif
#if PLANES_IN > 11
    READ(11)
#endif
#if PLANES_IN > 12
    READ(12)
#endif
#if PLANES_IN > 13
    READ(13)
#endif
#if PLANES_IN > 14
    READ(14)
#endif
#if PLANES_IN > 15
    READ(15)
#endif
    STORE(sum, out + i);
#if PLANES_OUT > 1
    STORE(sum * 2.0f, out + out_stride + i);
#endif
#if PLANES_OUT > 2
    STORE(sum * 3.0f, out + 2 * out_stride + i);
#endif
#if PLANES_OUT > 3
    STORE(sum * 4.0f, out + 3 * out_stride + i);
#endif
}
