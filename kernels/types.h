/* Constants that cross the border between host and kernels. Included by both sides; host/shading asserts the layout.
 * Only float and int members, so that every compiler lays them out alike. World space throughout.
 *
 * A point such as the eye or a lamp stands as a sum hi + lo of two floats: (hi - p) + lo is then good to one rounding
 * of the difference, where a single float would move the eye by up to half an ulp of its distance from the origin,
 * which a lobe with an exponent of thousands would show. */
#ifndef CLSHADE_TYPES_H
#define CLSHADE_TYPES_H

#define LIGHT_DISTANT 0
#define LIGHT_POINT 1
#define LIGHT_SPOT 2

typedef struct LightConstants {
    int type;                 /* LIGHT_DISTANT, ... */
    float cone_angle;         /* spot: half-angle [rad] */
    float cone_inverse_width; /* spot: 1 / (cone_angle softness) [1/rad]; large for a hard edge */
    float unused;
    float direction[4];   /* distant: unit vector to the light; spot: unit axis, the way the light travels */
    float position_hi[4]; /* point, spot */
    float position_lo[4];
    float power[4]; /* distant: irradiance E_0; point, spot: intensity, E_0 = power / distance^2 */
} LightConstants;

typedef struct FrameConstants {
    float eye_hi[4];
    float eye_lo[4];
    float view_axis[4];        /* unit, the way the camera looks */
    float camera_to_world[12]; /* three rows of four */
    float origin[4];           /* origin(x, y) = origin + x origin_dx + y origin_dy, x and y at pixel centres */
    float origin_dx[4];
    float origin_dy[4];
    float direction[4]; /* likewise; direction . view_axis = 1 */
    float direction_dx[4];
    float direction_dy[4];
    int light_count;
    int pitch; /* floats from one row of pixels to the next */
    int unused[2];
} FrameConstants;

/* Light from all around (pixel rule 11). The intensity is multiplied in already, here and in the maps. */
typedef struct EnvironmentConstants {
    float world_to_image[12]; /* three rows of four */
    float band0[4];           /* E/pi of SH band 0 */
    float band1[3][4];        /* band1[0] N.x + band1[1] N.y + band1[2] N.z, world space */
    float band2[6][4];        /* factors of x^2, y^2, z^2, xy, yz, zx, world space */
    float intensity[4];       /* for the picture behind the objects, which is kept as it is */
    int picture_width;
    int picture_height;
    int unused[2];
} EnvironmentConstants;

/* Counters written by the kernel, in this order. */
#define COUNT_NONFINITE 0
#define COUNT_CLAMPED 1
#define COUNT_FRACTIONAL_IDS 2
#define COUNT_NO_TANGENT 3
#define COUNT_SIZE 4

#endif
