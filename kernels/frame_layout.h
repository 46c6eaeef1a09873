// What varies between programs but not between pixels: which planes a frame has, where they lie, what is written.
// This default is one distant light on thirteen planes; the host writes its own for every other structure
// (host/shading/frame_layout.cpp) and the kernels below are the same for all. An absent plane is -1.
#ifndef CLSHADE_FRAME_LAYOUT_H
#define CLSHADE_FRAME_LAYOUT_H

// Input planes.
#define PLANE_NORMAL_X 0
#define PLANE_NORMAL_Y 1
#define PLANE_NORMAL_Z 2
#define PLANE_POSITION_X 3
#define PLANE_POSITION_Y 4
#define PLANE_POSITION_Z 5
#define PLANE_DEPTH -1
#define PLANE_COVERAGE -1
#define PLANE_MATERIAL_ID -1
// Every plane whose NaN or Inf makes a pixel 0; the depth plane is looked at apart, since +Inf there is background.
#define FOR_EACH_CHECKED_PLANE(X) X(0) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8) X(9) X(10) X(11) X(12)

// What the values mean.
#define NORMAL_IN_CAMERA_SPACE 0
#define NORMAL_IS_UNORM 0
#define DEPTH_IS_RAY_LENGTH 0
#define VIEW_IS_ORTHOGRAPHIC 0
#define VIEW_HAS_RAYS 0

// Types of light that occur beside distant ones.
#define HAS_POINT_LIGHTS 0
#define HAS_SPOT_LIGHTS 0

// Light from all around: whether there is any, what diffuse surfaces see of it, whether it shows behind the objects.
#define AMBIENT_SH2 0
#define AMBIENT_SH3 1
#define AMBIENT_MAP 2
#define HAS_ENVIRONMENT 0
#define AMBIENT_SOURCE AMBIENT_SH2
#define HAS_BACKGROUND 0

// First output plane of each group beside R, G, B, A (planes 0 to 3).
#define OUTPUT_DIFFUSE -1
#define OUTPUT_SPECULAR -1
#define OUTPUT_LIGHTS -1
#define OUTPUT_ENVIRONMENT -1

#endif
