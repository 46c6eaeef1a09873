// Pre-filters a lat-long picture (host/environment/filter_layout.h): sums over all texels that a lobe reaches, no
// samples drawn and nothing clamped, so a sun keeps its energy whatever its peak.
//
// Lat-long texels and octahedral vertices share three symmetries: columns the other way round (phi to -phi), half a
// turn (phi + pi), and rows upside down (z to -z). So a work-item filters eight directions at once, (+-x, +-y, +-z):
// the weights, which are most of the work, are the same for all, only the texels differ. Lanes are neighbouring columns.
#include "filter_types.h"
#include "lanes.cl"
#include "math.cl"
#include "vectors.cl"

// Lanes from any address. Not vload: PoCL takes 300 ms longer to compile the kernel with it.
#if LANES == 1
#define LOAD(pointer) (*(pointer))
#else
typedef struct __attribute__((packed)) {
    real lanes;
} unaligned_lanes;
#define LOAD(pointer) (((__global const unaligned_lanes*)(pointer))->lanes)
#endif

#if LANES == 1
#define REVERSED(v) (v)
#define SUM(v) (v)
#elif LANES == 4
#define REVERSED(v) (v).s3210
#define SUM(v) sum_of_4(v)
#elif LANES == 8
#define REVERSED(v) (v).s76543210
#define SUM(v) sum_of_8(v)
#else
#define REVERSED(v) (v).sfedcba9876543210
#define SUM(v) sum_of_8((v).lo + (v).hi)
#endif

static inline float sum_of_4(float4 v) {
    const float2 pairs = v.lo + v.hi;
    return pairs.lo + pairs.hi;
}

static inline float sum_of_8(float8 v) {
    return sum_of_4(v.lo + v.hi);
}

// Large structures by value must not become calls: with the sums in memory a level takes five times as long.
#define INLINED static inline __attribute__((always_inline))

// The lobe without its factor, from h = (1 - R.w)/2 and cos2 = 1 - h, each without cancellation: the power
// cos2^(n/2), or the cosine 1 - 2 h.
static inline real lobe(int cosine, real h, real cos2, float half_exponent) {
    if (cosine) {
        return larger(fma(splat(-2.0f), h, splat(1.0f)), splat(0.0f));
    }
    return exp2_clamped(half_exponent * log2_cosine_squared(cos2, h));
}

// A column in 0..width-1, from one that is less than two turns below or one above.
static inline int wrapped(int column, int width) {
    column = column < 0 ? column + width : column;
    column = column < 0 ? column + width : column;
    return column >= width ? column - width : column;
}

// The columns of one row that a lobe reaches, as whole groups of lanes. The same columns seen from the mirrored
// direction run backwards; both have a twin half a turn on.
typedef struct {
    int first;    // from the direction's own column
    int count;    // columns that count; lanes beyond it are masked
    int groups;   // of lanes
    int direct;   // where the first group starts in a row
    int turned;   // half a turn on
    int mirrored; // where the last of the mirrored groups starts: it stands first in the row
    int both;
} column_run;

// `left`: what the reach leaves for along sin^2(dphi/2).
static inline column_run columns_within(float left, float along, int column, int width) {
    // |dphi/2| <= asin x, which is at most x + (pi/2 - 1) x^3 on 0..1.
    const float x2 = left / max(along, 1e-12f);
    const float x = sqrt(min(x2, 1.0f));
    const int side = (int)((float)width * INV_PI_F * (x + 0.5707964f * x * x * x)) + 1;
    const bool whole = x2 >= 1.0f || 2 * side + 1 >= width;
    column_run run;
    run.first = whole ? -(width / 2) : -side;
    run.count = whole ? width : 2 * side + 1;
    run.groups = (run.count + LANES - 1) / LANES;
    run.direct = wrapped(column + run.first, width);
    run.turned = wrapped(run.direct + width / 2, width);
    run.mirrored = wrapped(width - column - run.first - run.groups * LANES, width);
    run.both = wrapped(run.mirrored + width / 2, width);
    return run;
}

// Sums of weighted texels for the four directions of one height.
typedef struct {
    rgb direct;   // (x, y)
    rgb turned;   // (-x, -y)
    rgb mirrored; // (x, -y)
    rgb both;     // (-x, y)
} four_sums;

INLINED four_sums no_sums(void) {
    const rgb none = grey(splat(0.0f));
    const four_sums sums = {none, none, none, none};
    return sums;
}

INLINED four_sums add_sums(four_sums sums, four_sums row, float area) {
    const rgb scale = grey(splat(area));
    sums.direct = multiply_add_rgb(row.direct, scale, sums.direct);
    sums.turned = multiply_add_rgb(row.turned, scale, sums.turned);
    sums.mirrored = multiply_add_rgb(row.mirrored, scale, sums.mirrored);
    sums.both = multiply_add_rgb(row.both, scale, sums.both);
    return sums;
}

INLINED rgb add_texels(rgb sum, real weight, __global const float* texels, int plane) {
    return make_rgb(fma(weight, LOAD(texels), sum.r), fma(weight, LOAD(texels + plane), sum.g),
                    fma(weight, LOAD(texels + 2 * plane), sum.b));
}

// `forward` and `backward`: columns from the run's starts.
INLINED four_sums add_row(four_sums sums, real weight, real reversed, __global const float* texels, int plane,
                                column_run run, int forward, int backward) {
    sums.direct = add_texels(sums.direct, weight, texels + run.direct + forward, plane);
    sums.turned = add_texels(sums.turned, weight, texels + run.turned + forward, plane);
    sums.mirrored = add_texels(sums.mirrored, reversed, texels + run.mirrored + backward, plane);
    sums.both = add_texels(sums.both, reversed, texels + run.both + backward, plane);
    return sums;
}

static inline void store_vertex(__global float* result, int index, rgb sum, float scale) {
    result[3 * index] = SUM(sum.r) * scale;
    result[3 * index + 1] = SUM(sum.g) * scale;
    result[3 * index + 2] = SUM(sum.b) * scale;
}

// The four vertices (+-a, +-b) grid steps from the middle.
static inline void store_four(__global float* result, int cells, int a, int b, four_sums sums, float scale) {
    const int middle = (cells / 2) * (cells + 2);
    const int down = b * (cells + 1);
    store_vertex(result, middle + down + a, sums.direct, scale);
    store_vertex(result, middle - down - a, sums.turned, scale);
    store_vertex(result, middle - down + a, sums.mirrored, scale);
    store_vertex(result, middle + down - a, sums.both, scale);
}

// `rows`: of every row the sine of its middle's polar angle, then of every row its solid angle, in any unit.
INLINED void filter_direction(__global const float* texels, __global const float* rows,
                              __global const float* half_angles, FilterSource source, FilterDirection direction,
                              __global float* result) {
    const int width = source.width;
    const int height = source.height;
    const int plane = source.pitch * height;
    __global const float* sines = half_angles + source.middle;
    __global const float* cosines = sines + source.table;
    const int last_row = min(height - 1, direction.row + source.rows);

    four_sums upper = no_sums();
    four_sums lower = no_sums();
    real weights = splat(0.0f);
    for (int row = max(0, direction.row - source.rows); row <= last_row; ++row) {
        // h = sin^2(dtheta/2) + sin theta sin theta_R sin^2(dphi/2) does not cancel near R. Half-angles come from those
        // of whole texels and of the rest, so that their sines have a small relative error.
        const int step = row - direction.row;
        const float sine = sines[step] * direction.row_cos - cosines[step] * direction.row_sin;
        const float across = sine * sine;
        // 1 - h = cos^2((theta + theta_R)/2) + sin theta sin theta_R cos^2(dphi/2) likewise far from R, where wide lobes
        // still see a sun; the cosine is the sine of half the step from the row upside down.
        const int turn = height - 1 - row - direction.row;
        const float cosine = sines[turn] * direction.row_cos - cosines[turn] * direction.row_sin;
        const float opposite = cosine * cosine;
        const float along = rows[row] * direction.sine;
        const float area = rows[height + row];
        const column_run run = columns_within(max(source.reach - across, 0.0f), along, direction.column, width);
        __global const float* north = texels + row * source.pitch;
        __global const float* south = texels + (height - 1 - row) * source.pitch;
        // Row by row first: long sums in single precision would lose what small texels add.
        four_sums upper_row = no_sums();
        four_sums lower_row = no_sums();
        real row_weights = splat(0.0f);
        for (int group = 0; group < run.groups; ++group) {
            const int forward = group * LANES;
            const int backward = (run.groups - 1) * LANES - forward;
            const int k = run.first + forward;
            const real s = LOAD(sines + k) * direction.column_cos - LOAD(cosines + k) * direction.column_sin;
            const real c = LOAD(cosines + k) * direction.column_cos + LOAD(sines + k) * direction.column_sin;
            const real h = fma(along * s, s, splat(across));
            const real cos2 = fma(along * c, c, splat(opposite));
            const mask inside = LANE_INDEX < splat((float)(run.count - forward));
            const real weight = choose(inside, lobe(source.cosine, h, cos2, source.half_exponent), splat(0.0f));
            const real reversed = REVERSED(weight);
            row_weights += weight;
            upper_row = add_row(upper_row, weight, reversed, north, plane, run, forward, backward);
            lower_row = add_row(lower_row, weight, reversed, south, plane, run, forward, backward);
        }
        weights = fma(splat(area), row_weights, weights);
        upper = add_sums(upper, upper_row, area);
        lower = add_sums(lower, lower_row, area);
    }

    const int cells = source.cells;
    const float scale = 1.0f / SUM(weights);
    store_four(result, cells, direction.a, direction.b, upper, scale);
    // Directions below the horizon stand where the octahedron's sides fold out: at (1 - |y|, 1 - |x|).
    store_four(result, cells, cells / 2 - direction.b, cells / 2 - direction.a, lower, scale);
}

// One direction a work-item, `first` to `end`. One kernel for all lobes: each further one costs its compilation.
__kernel void filter_environment(__global const float* texels, __global const float* rows,
                                 __global const float* half_angles, __global const FilterSource* source,
                                 __global const FilterDirection* directions, __global float* result, int first,
                                 int end) {
    const int index = first + (int)get_global_id(0);
    if (index < end) {
        filter_direction(texels, rows, half_angles, *source, directions[index], result);
    }
}
