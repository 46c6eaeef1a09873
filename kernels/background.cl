// The environment behind the objects (pixel rule 12): the picture itself, along the pixel's ray.
#ifndef CLSHADE_BACKGROUND_CL
#define CLSHADE_BACKGROUND_CL

#include "environment.cl"

#if HAS_BACKGROUND

// A texel of row y and column x, both beyond the picture by at most one: u wraps, beyond a pole the row nearest to it
// stands opposite.
static inline float4 texel_at(environment around, int x, int y) {
    const int width = around.constants->picture_width;
    const int height = around.constants->picture_height;
    const int beyond = y < 0 || y >= height;
    const int row = y < 0 ? 0 : (y >= height ? height - 1 : y);
    const int column = (x + (beyond ? width / 2 : 0) + width) % width;
    return *((__global const float4*)around.picture + (ulong)row * (ulong)width + (ulong)column);
}

// Bilinear between texel centres; x and y in texels.
static inline float4 picture_at(environment around, float x, float y) {
    const float left = floor(x - 0.5f);
    const float top = floor(y - 0.5f);
    const float fx = x - 0.5f - left;
    const float fy = y - 0.5f - top;
    const int column = (int)left;
    const int row = (int)top;
    const float4 upper = mix(texel_at(around, column, row), texel_at(around, column + 1, row), fx);
    const float4 lower = mix(texel_at(around, column, row + 1), texel_at(around, column + 1, row + 1), fx);
    return mix(upper, lower, fy);
}

// Radiance from direction d of the world, any length.
static inline rgb behind(environment around, vec3 world) {
    const vec3 d = turn3(around.constants->world_to_image, world);
    const real azimuth = angle_of(fabs(d.y), d.x);
    const real u = 0.5f - (0.5f * INV_PI_F) * choose(d.y < splat(0.0f), -azimuth, azimuth);
    const real v = INV_PI_F * angle_of(square_root(fma(d.x, d.x, d.y * d.y)), d.z);
    real x[1];
    real y[1];
    real r[1];
    real g[1];
    real b[1];
    x[0] = u * (float)around.constants->picture_width;
    y[0] = v * (float)around.constants->picture_height;
    for (int lane = 0; lane < LANES; ++lane) {
        const float4 colour = picture_at(around, ((float*)x)[lane], ((float*)y)[lane]);
        ((float*)r)[lane] = colour.s0;
        ((float*)g)[lane] = colour.s1;
        ((float*)b)[lane] = colour.s2;
    }
    return multiply_rgb(make_rgb(r[0], g[0], b[0]), three(around.constants->intensity));
}

#endif

#endif
