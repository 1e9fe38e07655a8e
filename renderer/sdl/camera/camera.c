/* camera. From version 3.5 on, what is written in it is applied in POV-Ray's fixed order: right, direction, angle, up,
 * sky, location, look_at, focal_point; transforms come last, in theirs. Older scenes have it applied as it is written.
 */
#include <string.h>
#include <retex/nearest.h>
#include "camera/view.h"
#include "sdl/camera/camera.h"
#include "sdl/object/object.h"
#include "shade/pigment.h"

#define BOKEH_SIZE 128

typedef struct Reading {
    ParsedCamera camera;
    double angle, direction_length; /* the length of direction as angle and look_at found it */
    Vec3 focal_point;
    int had_angle, had_up, had_right, had_look_at, had_focal_point;
    int as_written; /* as in version 3.1 and before */
    Transform transform;
} Reading;

static void camera_default(ParsedCamera *camera)
{
    *camera = (ParsedCamera){
        .camera = {.ops = &camera_perspective,
                   .sky = {0, 1, 0},
                   .direction = {0, 0, 1},
                   .right = {1.33, 0, 0},
                   .up = {0, 1, 0},
                   .angle = 90,
                   .lens.focal_distance = -1},
        .look_at = {0, 0, 1},
    };
}

static int is_flat(const Reading *r)
{
    return (r->camera.camera.ops->properties & CAMERA_FLAT) != 0;
}

/* ---- applying ---- */

static void apply_angle(Sdl *sdl, Reading *r)
{
    Camera *c = &r->camera.camera;
    if (!r->had_angle)
        return;
    if (r->angle < 0)
        sdl_error(sdl, "a camera's angle cannot be negative");
    c->angle = r->angle;
    if (r->angle == 0 || !is_flat(r) || (r->as_written && c->ops == &camera_orthographic))
        return;
    if (r->angle >= 180) {
        sdl_warn(sdl, "the camera's angle of %g degrees is taken as 150", r->angle);
        r->angle = 150;
    }
    r->direction_length = vec_length(c->right) / tan(r->angle * PI / 360) / 2;
    c->direction = vec_scale(vec_normalize(c->direction), r->direction_length);
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
    Vec3 side = vec_cross(r->camera.camera.sky, towards);
    if (vec_length(side) < 1e-10) {
        sdl_warn(sdl, "the camera looks along its sky vector: its right vector is kept");
        side = c->right;
    }
    side = vec_normalize(side);
    r->direction_length = direction;
    c->direction = vec_scale(towards, direction);
    c->up = vec_scale(vec_cross(towards, side), up);
    c->right = vec_scale(side, handedness > 0 ? right : -right);
}

/* Without right and up of its own, or with an angle, an orthographic camera shows what the perspective one would at the
 * distance of look_at. */
static void apply_orthographic(Reading *r)
{
    Camera *c = &r->camera.camera;
    if (c->ops != &camera_orthographic || ((r->had_up || r->had_right) && !r->had_angle && !r->as_written))
        return;
    double distance = vec_length(vec_sub(r->camera.look_at, c->location)), length = vec_length(c->direction);
    if (distance > 1e-10 && length > 1e-10) {
        c->right = vec_scale(c->right, distance / length);
        c->up = vec_scale(c->up, distance / length);
    }
}

static void apply_focal_point(Reading *r)
{
    CameraLens *lens = &r->camera.camera.lens;
    if (r->had_focal_point)
        lens->focal_distance = vec_length(vec_sub(r->focal_point, r->camera.camera.location));
}

static void apply_transform(Reading *r, const Transform *by)
{
    Camera *c = &r->camera.camera;
    c->location = transform_point(by, c->location);
    c->direction = transform_vector(by, c->direction);
    c->right = transform_vector(by, c->right);
    c->up = transform_vector(by, c->up);
}

/* ---- reading ---- */

/* After `mesh_camera`: rays for each pixel, distribution, the longest distance, meshes. */
static void parse_mesh_camera(Sdl *sdl, Reading *r)
{
    MeshCamera *mesh = sdl_alloc(sdl, sizeof *mesh);
    CameraMesh *meshes = NULL;
    int capacity = 0;
    sdl_expect(sdl, "{");
    mesh->rays = (int)fmin(fmax(sdl_float(sdl), 0), 1e6);
    sdl_optional_comma(sdl);
    mesh->distribution = (int)fmin(fmax(sdl_float(sdl), -1), 4);
    sdl_optional_comma(sdl);
    mesh->length = optional_float(sdl, 0);
    if (mesh->rays < 1 || mesh->distribution < 0 || mesh->distribution > 3 ||
        (mesh->distribution > 1 && mesh->rays != 1))
        sdl_error(sdl, "a mesh_camera has at least one ray for each pixel, and distribution 0 to 3; "
                       "2 and 3 have one ray");
    while (sdl_optional_comma(sdl), sdl_is(sdl, "mesh") || sdl_is(sdl, "mesh2")) {
        const Object *object = accept_object(sdl);
        if (object->kind != OBJECT_SHAPE || !object->shape.mesh)
            sdl_error(sdl, "a mesh_camera needs meshes with triangles");
        meshes = sdl_grow(sdl, meshes, mesh->nmeshes, &capacity, sizeof *meshes);
        meshes[mesh->nmeshes++] = (CameraMesh){.mesh = object->shape.mesh, .transform = object->transform};
    }
    mesh->smooth = sdl_accept(sdl, "smooth");
    sdl_expect(sdl, "}");
    mesh->meshes = meshes;
    if (mesh->nmeshes < (mesh->distribution == 0 ? mesh->rays : 1))
        sdl_error(sdl, "a mesh_camera needs a mesh, with distribution 0 one for each ray");
    if (mesh->smooth && mesh->distribution != 3)
        sdl_error(sdl, "smooth needs distribution 3");
    if (!(r->camera.camera.mesh = mesh_camera_create(sdl_arena(sdl), mesh)))
        sdl_error(sdl, "out of memory for a mesh_camera");
}

static const CameraOps *parse_type(Sdl *sdl)
{
    static const CameraOps *const types[] = {&camera_cylinder_1, &camera_cylinder_2, &camera_cylinder_3,
                                             &camera_cylinder_4};
    const double type = sdl_float(sdl);
    if (!(type >= 1 && type < 5))
        sdl_error(sdl, "a cylinder camera has type 1 to 4");
    return types[(int)type - 1];
}

static int accept_kind(Sdl *sdl, Reading *r)
{
    static const CameraOps *const kinds[] = {
#define X(name) &camera_##name,
        CAMERA_TABLE(X)
#undef X
    };
    const CameraOps **ops = &r->camera.camera.ops;
    if (sdl_accept(sdl, "cylinder")) {
        *ops = parse_type(sdl);
        return 1;
    }
    if (sdl_accept(sdl, "user_defined")) {
        sdl_unsupported_geometry(sdl, "user_defined", "a perspective camera is used");
        *ops = &camera_perspective;
        sdl_skip_block(sdl);
        return 1;
    }
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (sdl_accept(sdl, kinds[i]->name)) {
            *ops = kinds[i];
            if (*ops == &camera_mesh_camera)
                parse_mesh_camera(sdl, r);
            if (r->as_written)
                apply_orthographic(r);
            return 1;
        }
    return 0;
}

static void parse_bokeh(Sdl *sdl, Reading *r)
{
    sdl_expect(sdl, "{");
    while (sdl_accept(sdl, "pigment"))
        r->camera.bokeh = parse_pigment(sdl, default_pigment(sdl));
    sdl_expect(sdl, "}");
}

/* Focal blur. How many samples there are is said elsewhere; but without blur_samples everything is sharp. */
static int accept_blur(Sdl *sdl, Reading *r)
{
    if (sdl_accept(sdl, "blur_samples")) {
        double samples = sdl_float(sdl);
        sdl_optional_comma(sdl);
        r->camera.blur = fmax(samples, optional_float(sdl, 0)) > 0;
    } else if (sdl_accept(sdl, "confidence") || sdl_accept(sdl, "variance"))
        sdl_float(sdl);
    else if (sdl_accept(sdl, "aperture"))
        r->camera.aperture = sdl_float(sdl);
    else if (sdl_accept(sdl, "focal_point"))
        r->focal_point = sdl_vector(sdl), r->had_focal_point = 1;
    else if (sdl_accept(sdl, "bokeh"))
        parse_bokeh(sdl, r);
    else
        return 0;
    if (r->as_written)
        apply_focal_point(r), r->had_focal_point = 0;
    return 1;
}

static int accept_vector(Sdl *sdl, Reading *r)
{
    Camera *c = &r->camera.camera;
    if (sdl_accept(sdl, "location"))
        c->location = sdl_vector(sdl);
    else if (sdl_accept(sdl, "direction"))
        c->direction = sdl_vector(sdl);
    else if (sdl_accept(sdl, "right"))
        c->right = sdl_vector(sdl), r->had_right = 1;
    else if (sdl_accept(sdl, "up"))
        c->up = sdl_vector(sdl), r->had_up = 1;
    else if (sdl_accept(sdl, "sky"))
        c->sky = sdl_vector(sdl);
    else if (sdl_accept(sdl, "look_at"))
        r->camera.look_at = sdl_vector(sdl), r->had_look_at = 1;
    else
        return 0;
    if (r->as_written)
        apply_look_at(sdl, r), r->had_look_at = 0;
    return 1;
}

/* The second angle is the vertical one of a spherical camera. */
static void parse_angle(Sdl *sdl, Reading *r)
{
    r->angle = optional_float(sdl, 0);
    r->had_angle = 1;
    sdl_optional_comma(sdl);
    r->camera.camera.vertical_angle = optional_float(sdl, r->angle / 2);
    if (r->camera.camera.vertical_angle < 0)
        sdl_error(sdl, "a camera's angle cannot be negative");
    if (r->as_written)
        apply_angle(sdl, r), r->had_angle = 0;
}

static void item(Sdl *sdl, Reading *r)
{
    Camera *c = &r->camera.camera;
    Transform by;
    if (accept_transform(sdl, &by)) {
        if (r->as_written)
            apply_transform(r, &by);
        else
            r->transform = transform_then(r->transform, by);
    } else if (sdl_accept(sdl, "angle"))
        parse_angle(sdl, r);
    else if (sdl_accept(sdl, "normal"))
        c->normal = &parse_normal(sdl, parsed_normal(c->normal))->normal;
    else if (!accept_vector(sdl, r) && !accept_kind(sdl, r) && !accept_blur(sdl, r))
        sdl_expected(sdl, "a camera modifier or }");
}

/* Numbers beyond what a ray can hold, as 1/0 makes them, would only show as an empty picture. */
static void check_finite(Sdl *sdl, const ParsedCamera *parsed)
{
    const Camera *c = &parsed->camera;
    const Vec3 all[5] = {c->location, c->direction, c->right, c->up,
                         vec3(parsed->aperture, c->lens.focal_distance, c->angle + c->vertical_angle)};
    for (int i = 0; i < 5; i++)
        if (!(fabs(all[i].x) < 1e18 && fabs(all[i].y) < 1e18 && fabs(all[i].z) < 1e18))
            sdl_error(sdl, "the camera's place or direction is not finite");
}

const ParsedCamera *parse_camera(Sdl *sdl)
{
    Reading r = {.camera = cameras_of(sdl)->camera, .transform = transform_identity(), .direction_length = 1};
    ParsedCamera *camera = sdl_alloc(sdl, sizeof *camera);
    r.as_written = sdl_version(sdl) < 3.5;
    sdl_expect(sdl, "{");
    const ParsedCamera *known = accept_ident(sdl, VALUE_CAMERA);
    if (known)
        r.camera = *known;
    while (!sdl_accept(sdl, "}"))
        item(sdl, &r), sdl_optional_comma(sdl);
    if (!r.as_written) {
        apply_angle(sdl, &r);
        apply_look_at(sdl, &r);
        if (!known) /* whose right and up have their size already */
            apply_orthographic(&r);
        apply_focal_point(&r);
        apply_transform(&r, &r.transform);
    }
    CameraLens *lens = &r.camera.camera.lens;
    if (lens->focal_distance < 0)
        lens->focal_distance = r.direction_length;
    if (lens->focal_distance == 0)
        lens->focal_distance = 1;
    if (r.camera.camera.ops == &camera_spherical && r.camera.camera.vertical_angle == 0)
        r.camera.camera.angle = 360, r.camera.camera.vertical_angle = 180;
    check_finite(sdl, &r.camera);
    *camera = r.camera;
    return camera;
}

/* ---- in use ---- */

/* 640 wide. The default right of 1.33 means 4/3: POV-Ray's own size is 640 by 480. */
static void picture_size(Sdl *sdl, const Camera *c)
{
    Scene *scene = sdl_scene(sdl);
    double right = vec_length(c->right), up = vec_length(c->up);
    if (!(right > 0 && up > 0 && (vec_length(c->direction) > 0 || c->ops == &camera_mesh_camera)))
        sdl_error(sdl, "the camera's direction, right and up must not be zero");
    double aspect = right / up;
    if (fabs(aspect - 1.33) < 0.005)
        aspect = 4.0 / 3;
    scene->width = 640;
    scene->height = (int)fmin(fmax(floor(640 / aspect + 0.5), 1), RETEX_MAX_SIZE);
}

void camera_use(Sdl *sdl, const ParsedCamera *camera)
{
    Camera *c = &sdl_scene(sdl)->camera;
    *c = camera->camera;
    c->lens.aperture = camera->blur && !(c->ops->properties & CAMERA_MESH) ? camera->aperture : 0;
    cameras_of(sdl)->bokeh = c->lens.aperture != 0 ? camera->bokeh : NULL;
    picture_size(sdl, c);
}

/* ---- another one than the scene's ---- */

static const ParsedCamera *find_named(Sdl *sdl, const char *name)
{
    const ParsedCamera *camera = cameras_of(sdl)->cameras;
    while (camera && strcmp(camera->name, name) != 0)
        camera = camera->next;
    return camera;
}

static _Noreturn void no_such_camera(Sdl *sdl, const char *name)
{
    const Scene *scene = sdl_scene(sdl);
    const char *names[64];
    char meant[RETEX_MEANT_SIZE];
    int count = 0;
    for (int k = 0; k < scene->ncameras && count < 64; k++)
        names[count++] = scene->cameras[k].name;
    sdl_error(sdl, "no camera is declared as `%.100s`%s", name,
              retex_meant(retex_nearest_of(name, names, count), meant));
}

static void use_view(Sdl *sdl, const CameraView *view)
{
    const SdlOptions *options = sdl_options(sdl);
    Camera *camera = &sdl_scene(sdl)->camera;
    const double own = vec_length(camera->right) / vec_length(camera->up);
    *camera = camera_look(camera, view,
                          options->width > 0 && options->height > 0 ? (double)options->width / options->height : own);
    cameras_of(sdl)->bokeh = NULL;
    picture_size(sdl, camera);
}

static void list_named(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    int count = 0, k;
    for (const ParsedCamera *camera = cameras_of(sdl)->cameras; camera; camera = camera->next)
        count += find_named(sdl, camera->name) == camera;
    scene->cameras = sdl_alloc(sdl, (size_t)(count + 1) * sizeof *scene->cameras);
    scene->ncameras = k = count;
    for (const ParsedCamera *camera = cameras_of(sdl)->cameras; camera; camera = camera->next)
        if (find_named(sdl, camera->name) == camera)
            scene->cameras[--k] = (NamedCamera){camera->name, camera->camera};
}

void camera_choose(Sdl *sdl)
{
    const char *asked = sdl_options(sdl)->camera;
    CameraView view;
    list_named(sdl);
    if (!asked)
        return;
    const ParsedCamera *named = find_named(sdl, asked);
    if (named)
        camera_use(sdl, named);
    else if (camera_view_read(&view, asked, NULL))
        no_such_camera(sdl, asked);
    else
        use_view(sdl, &view);
}

void camera_finish(Sdl *sdl)
{
    const ParsedPigment *pigment = cameras_of(sdl)->bokeh;
    const Normal *normal = sdl_scene(sdl)->camera.normal;
    if (normal)
        gaps_report(sdl, &parsed_normal(normal)->gaps);
    if (!pigment)
        return;
    gaps_report(sdl, &pigment->gaps);
    float *weights = sdl_alloc(sdl, sizeof *weights * BOKEH_SIZE * BOKEH_SIZE);
    for (int k = 0; k < BOKEH_SIZE * BOKEH_SIZE; k++) {
        const Vec3 p = vec3((k % BOKEH_SIZE + 0.5) / BOKEH_SIZE, (k / BOKEH_SIZE + 0.5) / BOKEH_SIZE, 0);
        const Rgbft c = pigment_eval(&pigment->pigment, p, (Vec2){p.x, p.y});
        weights[k] = at_most(not_negative(0.297f * c.r + 0.589f * c.g + 0.114f * c.b), 1);
    }
    if (!(sdl_scene(sdl)->camera.lens.bokeh = bokeh_create(sdl_arena(sdl), weights, BOKEH_SIZE)))
        sdl_error(sdl, "out of memory for a bokeh");
}

void camera_begin(Sdl *sdl)
{
    builder_of(sdl)->camera = sdl_alloc(sdl, sizeof *builder_of(sdl)->camera);
    camera_default(&cameras_of(sdl)->camera);
}
