/* The kinds of camera there are. A new kind is a line here, and a file with its row of operations (camera/camera.h),
 * whose name is the keyword. */
#ifndef RENDERER_CAMERA_CAMERAS_H
#define RENDERER_CAMERA_CAMERAS_H

#include "scene/scene.h"

/* camera_NAME are the operations. */
#define CAMERA_TABLE(X)                                                                                                \
    X(cylinder_1)                                                                                                      \
    X(cylinder_2)                                                                                                      \
    X(cylinder_3)                                                                                                      \
    X(cylinder_4)                                                                                                      \
    X(fisheye)                                                                                                         \
    X(mesh_camera)                                                                                                     \
    X(omnimax)                                                                                                         \
    X(orthographic)                                                                                                    \
    X(panoramic)                                                                                                       \
    X(perspective)                                                                                                     \
    X(spherical)                                                                                                       \
    X(ultra_wide_angle)

#define X(name) extern const CameraOps camera_##name;
CAMERA_TABLE(X)
#undef X

#endif
