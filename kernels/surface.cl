// From planes to a surface: validity, coverage, normal, eye vector, position (the pixel rules 1 to 5).
#ifndef CLSHADE_SURFACE_CL
#define CLSHADE_SURFACE_CL

#include "frame_layout.h"
#include "types.h"
#include "vectors.cl"

// Depths from here on are background sentinels: 1e10, 65504, Inf and others occur.
#define DEPTH_SENTINEL 6e4f
// Further than any lamp reaches, and its square is a float.
#define FARTHEST 1e15f
// N.E is never taken smaller: interpolated normals turn away from the eye on visible pixels (models.md section 0).
#define SMALLEST_NE 1e-4f
#define SHORTEST_NORMAL 1e-6f

// The planes of the pixels at hand.
typedef struct {
    __global const float* planes;
    ulong stride;
    ulong pixel; // first of the group, counted in the planes at hand (a band of the picture, or all of it)
} inputs;

typedef struct {
    mask alive;         // finite, covered, with a normal
    mask nonfinite;     // a plane holds NaN or Inf
    real coverage;      // 0..1
    real unpremultiply; // 1 / coverage: planes that were averaged over coverage are multiplied by it
    vec3 n;             // unit normal
    vec3 e;             // unit vector to the eye
    vec3 position;      // world space; only for lights at a place
    real raw_ne;        // N.E
    real ne;            // the same, at least SMALLEST_NE
    real inverse_ne;
} surface;

static inline real load_input(inputs in, int plane) {
    return load_plane(in.planes, in.stride, plane, in.pixel);
}

static inline vec3 splat3(__constant const float* v) {
    return make_vec3(splat(v[0]), splat(v[1]), splat(v[2]));
}

// 0 where every checked plane is finite, NaN elsewhere.
static inline real finite_taint(inputs in) {
    real taint = splat(0.0f);
#define ADD_TAINT(PLANE)                                                                                               \
    prefetch_plane(in.planes, in.stride, PLANE, in.pixel);                                                             \
    taint = fma(load_input(in, PLANE), splat(0.0f), taint);
    FOR_EACH_CHECKED_PLANE(ADD_TAINT)
#undef ADD_TAINT
    return taint;
}

#if VIEW_HAS_RAYS
// Pixel centres of a group; a group never crosses a row.
typedef struct {
    real x, y;
} pixel_centre;

static inline pixel_centre centre_of(ulong pixel, __constant const FrameConstants* frame) {
    const uint row = (uint)(pixel / (ulong)frame->pitch);
    const uint column = (uint)(pixel - (ulong)row * (ulong)frame->pitch);
    pixel_centre centre;
    centre.x = LANE_INDEX + ((float)column + 0.5f);
    centre.y = splat((float)row + 0.5f);
    return centre;
}

static inline vec3 affine(__constant const float* at, __constant const float* dx, __constant const float* dy,
                          pixel_centre c) {
    return make_vec3(fma(c.x, splat(dx[0]), fma(c.y, splat(dy[0]), splat(at[0]))),
                     fma(c.x, splat(dx[1]), fma(c.y, splat(dy[1]), splat(at[1]))),
                     fma(c.x, splat(dx[2]), fma(c.y, splat(dy[2]), splat(at[2]))));
}
#endif

#if VIEW_HAS_RAYS
// The way the pixel looks, of any length.
static inline vec3 ray_of(ulong pixel, __constant const FrameConstants* frame) {
    return affine(frame->direction, frame->direction_dx, frame->direction_dy, centre_of(pixel, frame));
}
#endif

#if VIEW_HAS_RAYS && PLANE_DEPTH >= 0
static inline vec3 position_from_depth(vec3 ray, real depth, pixel_centre centre,
                                       __constant const FrameConstants* frame) {
    const real reach = smaller(depth, splat(FARTHEST)); // a sentinel may be Inf
#if DEPTH_IS_RAY_LENGTH
    const vec3 along = scale3(ray, reach * inverse_sqrt(dot3(ray, ray)));
#else
    const vec3 along = scale3(ray, reach);
#endif
#if VIEW_IS_ORTHOGRAPHIC
    return add3(affine(frame->origin, frame->origin_dx, frame->origin_dy, centre), along);
#else
    return add3(splat3(frame->eye_hi), along);
#endif
}
#endif

// A direction of three planes in world space, not of unit length, encoded as the normal is.
static inline vec3 load_direction(inputs in, int x, int y, int z, real unpremultiply,
                                  __constant const FrameConstants* frame) {
    vec3 n = make_vec3(load_input(in, x), load_input(in, y), load_input(in, z));
#if NORMAL_IS_UNORM
    n = make_vec3(fma(n.x * unpremultiply, splat(2.0f), splat(-1.0f)),
                  fma(n.y * unpremultiply, splat(2.0f), splat(-1.0f)),
                  fma(n.z * unpremultiply, splat(2.0f), splat(-1.0f)));
#endif
#if NORMAL_IN_CAMERA_SPACE
    const vec3 c = n;
    n.x = dot3(c, splat3(frame->camera_to_world));
    n.y = dot3(c, splat3(frame->camera_to_world + 4));
    n.z = dot3(c, splat3(frame->camera_to_world + 8));
#endif
    return n;
}

static inline surface load_surface(inputs in, ulong first_pixel, __constant const FrameConstants* frame) {
    surface s;
    real taint = finite_taint(in);

#if PLANE_COVERAGE >= 0
    s.coverage = smaller(larger(load_input(in, PLANE_COVERAGE), splat(0.0f)), splat(1.0f));
    const mask covered = s.coverage > splat(0.0f);
    s.unpremultiply = inverse(choose(covered, s.coverage, splat(1.0f)));
#else
    s.coverage = splat(1.0f);
    s.unpremultiply = splat(1.0f);
    mask covered = negated(FALSE_MASK);
#endif

#if PLANE_DEPTH >= 0
    const real depth = load_input(in, PLANE_DEPTH);
    taint = fma(choose(depth == splat(INFINITY), splat(0.0f), depth), splat(0.0f), taint);
    const mask within = depth < splat(DEPTH_SENTINEL);
#if PLANE_COVERAGE < 0
    covered = within;
#endif
#endif

    // Normal.
    const vec3 raw = load_direction(in, PLANE_NORMAL_X, PLANE_NORMAL_Y, PLANE_NORMAL_Z, s.unpremultiply, frame);
    const real length2 = dot3(raw, raw);
    s.n = scale3(raw, inverse_sqrt(length2));

    taint = fma(length2, splat(0.0f), taint); // a squared length that overflows counts as non-finite
    s.nonfinite = taint != splat(0.0f);
    s.alive = covered & negated(s.nonfinite) & (length2 >= splat(SHORTEST_NORMAL * SHORTEST_NORMAL));

    // Position: from its plane where that can be believed, else from depth.
    s.position = make_vec3(splat(0.0f), splat(0.0f), splat(0.0f));
    mask placed = FALSE_MASK;
#if PLANE_POSITION_X >= 0
    s.position = make_vec3(load_input(in, PLANE_POSITION_X), load_input(in, PLANE_POSITION_Y),
                           load_input(in, PLANE_POSITION_Z));
#if PLANE_DEPTH >= 0
    placed = within;
#elif VIEW_HAS_RAYS
    placed = (s.position.x != splat(0.0f)) | (s.position.y != splat(0.0f)) | (s.position.z != splat(0.0f));
#else
    placed = negated(FALSE_MASK);
#endif
#endif
    // The vector to the eye: from the position where there is one, else back along the pixel's ray.
    const vec3 hi = splat3(frame->eye_hi);
    const vec3 lo = splat3(frame->eye_lo);
    vec3 to_eye = make_vec3((hi.x - s.position.x) + lo.x, (hi.y - s.position.y) + lo.y, (hi.z - s.position.z) + lo.z);
    const mask unplaced = s.alive & negated(placed);
    if (any_lane(unplaced)) { // with a position plane a rare case
#if VIEW_HAS_RAYS
        const pixel_centre centre = centre_of(first_pixel + in.pixel, frame);
        const vec3 ray = affine(frame->direction, frame->direction_dx, frame->direction_dy, centre);
        to_eye = choose3(unplaced, scale3(ray, splat(-1.0f)), to_eye);
#if PLANE_DEPTH >= 0
        s.position = choose3(unplaced, position_from_depth(ray, depth, centre, frame), s.position);
#endif
#else
        to_eye = choose3(unplaced, scale3(splat3(frame->view_axis), splat(-1.0f)), to_eye);
#endif
    }
#if VIEW_IS_ORTHOGRAPHIC
    s.e = scale3(splat3(frame->view_axis), splat(-1.0f));
#else
    s.e = scale3(to_eye, inverse_sqrt(dot3(to_eye, to_eye)));
#endif
    s.raw_ne = dot3(s.n, s.e);
    s.ne = larger(s.raw_ne, splat(SMALLEST_NE));
    s.inverse_ne = inverse(s.ne);
    return s;
}

#endif
