/* A view of a scene that is told by numbers: it takes the place of the scene's camera. */
#ifndef RENDERER_CAMERA_VIEW_H
#define RENDERER_CAMERA_VIEW_H

#include "camera/camera.h"

typedef struct CameraView {
    Vec3 eye, at;
    double angle; /* from the left to the right of the picture, in degrees; 0: that of the camera that it replaces */
} CameraView;

/* X,Y,Z:X,Y,Z[:ANGLE]. RETEX_ENOTFOUND where the text is no such thing but may be the name of a camera. */
int camera_view_read(CameraView *view, const char *text, RetexError *err);
/* A perspective camera of that view, of the other one's sky and handedness. aspect: of the picture, width by height. */
Camera camera_look(const Camera *camera, const CameraView *view, double aspect);
/* The angle of a camera's picture as CameraView has it; of one that is not flat, POV-Ray's default. */
double camera_angle(const Camera *camera);

#endif
