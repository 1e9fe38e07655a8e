/* camera: applied in POV-Ray's fixed order, whatever the order written: right, direction, angle, up, sky, location,
 * look_at; transforms come last, in theirs. */
#include <string.h>
#include "sdl/build/builder.h"

typedef struct Reading {
    ParsedCamera camera;
    double angle;
    int had_angle, had_up, had_right, had_look_at, other_kind;
    Transform transform;
} Reading;

void camera_default(ParsedCamera *camera)
{
    *camera = (ParsedCamera){
        .camera = {CAMERA_PERSPECTIVE, {0, 0, 0}, {0, 0, 1}, {1.33, 0, 0}, {0, 1, 0}},
        .sky = {0, 1, 0},
        .look_at = {0, 0, 1},
    };
}

/* ---- reading ---- */

static int accept_kind(Sdl *sdl, Reading *r)
{
    static const char *const others[] = {"fisheye",  "ultra_wide_angle", "omnimax",      "panoramic", "spherical",
                                         "cylinder", "mesh_camera",      "user_defined", NULL};
    if (sdl_accept(sdl, "perspective")) {
        r->camera.camera.kind = CAMERA_PERSPECTIVE;
        return 1;
    }
    if (sdl_accept(sdl, "orthographic")) {
        r->camera.camera.kind = CAMERA_ORTHOGRAPHIC;
        return 1;
    }
    for (int i = 0; others[i]; i++)
        if (sdl_accept(sdl, others[i])) {
            sdl_unsupported(sdl, others[i], "a perspective camera is used");
            r->camera.camera.kind = CAMERA_PERSPECTIVE;
            r->other_kind = 1;
            if (strcmp(others[i], "cylinder") == 0)
                sdl_float(sdl);
            if (strcmp(others[i], "mesh_camera") == 0 || strcmp(others[i], "user_defined") == 0)
                sdl_skip_block(sdl);
            return 1;
        }
    return 0;
}

/* focal_blur and its like: everything is sharp. */
static int accept_blur(Sdl *sdl)
{
    static const char *const floats[] = {"blur_samples", "confidence", "variance", NULL};
    for (int i = 0; floats[i]; i++)
        if (sdl_accept(sdl, floats[i])) {
            sdl_float(sdl);
            sdl_optional_comma(sdl);
            optional_float(sdl, 0);
            return 1;
        }
    if (sdl_accept(sdl, "aperture")) {
        if (sdl_float(sdl) != 0)
            sdl_unsupported(sdl, "aperture", "everything is sharp");
    } else if (sdl_accept(sdl, "focal_point"))
        sdl_vector(sdl);
    else if (sdl_accept(sdl, "bokeh"))
        sdl_skip_block(sdl);
    else if (sdl_accept(sdl, "normal")) {
        sdl_unsupported(sdl, "normal of a camera", "the view is not disturbed");
        sdl_skip_block(sdl);
    } else
        return 0;
    return 1;
}

static void item(Sdl *sdl, Reading *r)
{
    Camera *c = &r->camera.camera;
    Transform by;
    if (accept_transform(sdl, &by))
        r->transform = transform_then(r->transform, by);
    else if (sdl_accept(sdl, "location"))
        c->location = sdl_vector(sdl);
    else if (sdl_accept(sdl, "direction"))
        c->direction = sdl_vector(sdl);
    else if (sdl_accept(sdl, "right"))
        c->right = sdl_vector(sdl), r->had_right = 1;
    else if (sdl_accept(sdl, "up"))
        c->up = sdl_vector(sdl), r->had_up = 1;
    else if (sdl_accept(sdl, "sky"))
        r->camera.sky = sdl_vector(sdl);
    else if (sdl_accept(sdl, "look_at"))
        r->camera.look_at = sdl_vector(sdl), r->had_look_at = 1;
    else if (sdl_accept(sdl, "angle")) {
        r->angle = optional_float(sdl, 0);
        r->had_angle = 1;
        sdl_optional_comma(sdl);
        optional_float(sdl, 0); /* the vertical angle of a spherical camera */
    } else if (!accept_kind(sdl, r) && !accept_blur(sdl))
        sdl_expected(sdl, "a camera modifier or }");
}

/* ---- applying ---- */

static void apply_angle(Sdl *sdl, Reading *r)
{
    Camera *c = &r->camera.camera;
    if (!r->had_angle || r->angle == 0)
        return;
    if (r->angle < 0)
        sdl_error(sdl, "a camera's angle cannot be negative");
    if (r->angle >= 180) {
        /* Fine for a fisheye, which we do not have: as wide as a perspective is of use. */
        sdl_warn(sdl, "the camera's angle of %g degrees is taken as 150", r->angle);
        r->angle = 150;
    }
    double length = vec_length(c->right) / tan(r->angle * PI / 360) / 2;
    c->direction = vec_scale(vec_normalize(c->direction), length);
}

static void apply_look_at(Sdl *sdl, Reading *r)
{
    Camera *c = &r->camera.camera;
    if (!r->had_look_at)
        return;
    double direction = vec_length(c->direction), right = vec_length(c->right), up = vec_length(c->up);
    double handedness = vec_dot(vec_cross(c->up, c->direction), c->right);
    Vec3 towards = vec_sub(r->camera.look_at, c->location);
    if (vec_length(towards) == 0)
        sdl_error(sdl, "the camera's location and look_at are the same point");
    towards = vec_normalize(towards);
    Vec3 side = vec_cross(r->camera.sky, towards);
    if (vec_length(side) < 1e-10) {
        sdl_warn(sdl, "the camera looks along its sky vector: its right vector is kept");
        side = c->right;
    }
    side = vec_normalize(side);
    c->direction = vec_scale(towards, direction);
    c->up = vec_scale(vec_cross(towards, side), up);
    c->right = vec_scale(side, handedness > 0 ? right : -right);
}

/* Without right and up of its own, or with an angle, an orthographic camera shows what the perspective one would at the
 * distance of look_at. */
static void apply_orthographic(Reading *r)
{
    Camera *c = &r->camera.camera;
    if (c->kind != CAMERA_ORTHOGRAPHIC || ((r->had_up || r->had_right) && !r->had_angle))
        return;
    double distance = vec_length(vec_sub(r->camera.look_at, c->location)), length = vec_length(c->direction);
    if (distance > 1e-10 && length > 1e-10) {
        c->right = vec_scale(c->right, distance / length);
        c->up = vec_scale(c->up, distance / length);
    }
}

/* What stands in for a camera of another kind, whose right and up may not have the measure of a picture's sides. */
static void apply_stand_in(Reading *r)
{
    Camera *c = &r->camera.camera;
    double aspect = vec_length(c->right) / vec_length(c->up);
    if (!r->other_kind || (aspect > 0.25 && aspect < 4))
        return;
    c->right = vec_scale(vec_normalize(c->right), 4.0 / 3);
    c->up = vec_normalize(c->up);
}

/* Numbers beyond what a ray can hold, as 1/0 makes them, would only show as an empty picture. */
static void check_finite(Sdl *sdl, const Camera *c)
{
    const Vec3 all[4] = {c->location, c->direction, c->right, c->up};
    for (int i = 0; i < 4; i++)
        if (!(fabs(all[i].x) < 1e18 && fabs(all[i].y) < 1e18 && fabs(all[i].z) < 1e18))
            sdl_error(sdl, "the camera's place or direction is not finite");
}

const ParsedCamera *parse_camera(Sdl *sdl)
{
    Reading r = {.camera = builder_of(sdl)->camera, .transform = transform_identity()};
    ParsedCamera *camera = sdl_alloc(sdl, sizeof *camera);
    sdl_expect(sdl, "{");
    const ParsedCamera *known = accept_ident(sdl, VALUE_CAMERA);
    if (known)
        r.camera = *known;
    while (!sdl_accept(sdl, "}"))
        item(sdl, &r), sdl_optional_comma(sdl);
    Camera *c = &r.camera.camera;
    apply_stand_in(&r);
    apply_angle(sdl, &r);
    apply_look_at(sdl, &r);
    apply_orthographic(&r);
    c->location = transform_point(&r.transform, c->location);
    c->direction = transform_vector(&r.transform, c->direction);
    c->right = transform_vector(&r.transform, c->right);
    c->up = transform_vector(&r.transform, c->up);
    check_finite(sdl, c);
    *camera = r.camera;
    return camera;
}

/* ---- in use ---- */

/* 640 wide. The default right of 1.33 means 4/3: POV-Ray's own size is 640 by 480. */
static void picture_size(Sdl *sdl, const Camera *c)
{
    Scene *scene = sdl_scene(sdl);
    double right = vec_length(c->right), up = vec_length(c->up);
    if (!(right > 0 && up > 0 && vec_length(c->direction) > 0))
        sdl_error(sdl, "the camera's direction, right and up must not be zero");
    double aspect = right / up;
    if (fabs(aspect - 1.33) < 0.005)
        aspect = 4.0 / 3;
    scene->width = 640;
    scene->height = (int)fmin(fmax(floor(640 / aspect + 0.5), 1), RETEX_MAX_SIZE);
}

void camera_use(Sdl *sdl, const ParsedCamera *camera)
{
    sdl_scene(sdl)->camera = camera->camera;
    picture_size(sdl, &camera->camera);
}
