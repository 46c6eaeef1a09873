/* Constants of the pre-filter that cross the border between host and kernels; included by both sides. Only float and
 * int members, so that every compiler lays them out alike. */
#ifndef CLSHADE_FILTER_TYPES_H
#define CLSHADE_FILTER_TYPES_H

/* A lat-long source picture in planes of R, G and B, and the lobe that goes over it. A texel is as high as wide,
 * pi/height. */
typedef struct FilterSource {
    int width;
    int height;
    int pitch;           /* floats from row to row; a row is repeated: 2 width + 16 columns stand in it */
    int middle;          /* where the half-angle of no texel stands in the table of half-angles' sines */
    int table;           /* entries of that table; as many cosines follow */
    int rows;            /* rows within reach, up and down from R */
    float reach;         /* h = (1 - R.w)/2 beyond which texels may be left out; 1: none */
    float half_exponent; /* n/2 */
    int cosine;          /* the lobe is max(0, R.w) instead */
    int cells;           /* of the octahedral grid */
} FilterSource;

/* A direction R of the first octant (x, y, z >= 0 in the image frame): its vertex, and where it lies in the source. */
typedef struct FilterDirection {
    int a; /* grid steps from the middle of the octahedral grid, a + b <= cells/2 */
    int b;
    int column; /* of the nearest texel */
    int row;
    float column_cos; /* of half the angle from that column's middle to R */
    float column_sin;
    float row_cos; /* likewise of the row */
    float row_sin;
    float sine; /* of the polar angle of R */
} FilterDirection;

/* One vertex row of the AmbientBRDF tables: all that depends on the exponent alone. */
typedef struct AmbientRow {
    float half_exponent; /* n/2 */
    float reach;         /* polar angle of the half vector beyond which the lobe is left out [rad] */
    float factor;        /* what the sum is multiplied by */
} AmbientRow;

#endif
