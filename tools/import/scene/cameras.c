/* Cameras: all of the model's are declared, one is used; where there is none, framing.c frames the scene. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/scene/scene.h"
#include "import/sense/sense.h"
#include "import/space/views.h"

static int count_cameras(const Import *import)
{
    return import->is_gltf ? import->gltf.ncameras : (int)import->scene->mNumCameras;
}

static const char *camera_name(const Import *import, int index)
{
    return import->is_gltf ? import->gltf.cameras[index].name : import->scene->mCameras[index]->mName.data;
}

/* Position, direction and up of a camera in the scene. Returns 0 where they are no numbers. */
static int place(const Import *import, int index, double at[3], double to[3], double up[3])
{
    const struct aiCamera *camera = import->is_gltf ? NULL : import->scene->mCameras[index];
    const Affine node = camera ? import->camera_places[index].world : import->gltf.cameras[index].place;
    const struct aiVector3D zero = {0, 0, 0}, ahead = {0, 0, -1}, above = {0, 1, 0};
    const struct aiVector3D *p = camera ? &camera->mPosition : &zero;
    const struct aiVector3D *d = camera ? &camera->mLookAt : &ahead;
    const struct aiVector3D *u = camera ? &camera->mUp : &above;
    if (camera && !import->camera_places[index].is_known)
        return 0;
    affine_point(&node, (double[3]){(double)p->x, (double)p->y, (double)p->z}, at);
    affine_vector(&node, (double[3]){(double)d->x, (double)d->y, (double)d->z}, to);
    affine_vector(&node, (double[3]){(double)u->x, (double)u->y, (double)u->z}, up);
    const double length = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    const double tall = sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
    at[2] = 0 - at[2], to[2] = 0 - to[2], up[2] = 0 - up[2];
    for (int k = 0; k < 3; k++) {
        to[k] = at[k] + (length > 0 ? to[k] / length : k == 2);
        up[k] = tall > 0 ? up[k] / tall : k == 1;
    }
    return isfinite(at[0] + at[1] + at[2] + to[0] + to[1] + to[2] + up[0] + up[1] + up[2]);
}

/* The picture's width by its height, and either the angle from left to right or the width of a parallel projection. */
typedef struct Lens {
    double aspect, angle, width;
} Lens;

static Lens lens_of(const Import *import, int index)
{
    Lens lens;
    if (import->is_gltf) {
        const GltfCamera *gltf = &import->gltf.cameras[index];
        lens.width = gltf->width;
        lens.aspect = gltf->width > 0 && gltf->height > 0 ? gltf->width / gltf->height : gltf->aspect;
        lens.angle = 2 * atan(tan(gltf->angle / 2) * (lens.aspect > 0 ? lens.aspect : 4.0 / 3));
    } else {
        const struct aiCamera *camera = import->scene->mCameras[index];
        lens.width = 2 * (double)camera->mOrthographicWidth;
        lens.aspect = (double)camera->mAspect;
        lens.angle = (double)camera->mHorizontalFOV;
    }
    if (!(lens.aspect > 0.01 && lens.aspect < 100))
        lens.aspect = 4.0 / 3;
    if (!(lens.angle > 0.001 && lens.angle < 3.1))
        lens.angle = PI / 3;
    return lens;
}

/* To the right and up, of length 1. */
static void frame(const double ahead[3], const double up[3], double side[3], double above[3])
{
    double length = 0;
    for (int k = 0; k < 3; k++)
        side[k] = up[(k + 1) % 3] * ahead[(k + 2) % 3] - up[(k + 2) % 3] * ahead[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        length += side[k] * side[k];
    for (int k = 0; k < 3; k++)
        side[k] /= length > 0 ? sqrt(length) : 1;
    for (int k = 0; k < 3; k++)
        above[k] = ahead[(k + 1) % 3] * side[(k + 2) % 3] - ahead[(k + 2) % 3] * side[(k + 1) % 3];
}

/* A shifted lens: direction, right and up as vectors, for look_at would turn the direction back. */
static void print_shifted(FILE *out, const Lens *lens, const double at[3], const double to[3], const double up[3],
                          const double shift[2])
{
    const double distance = lens->aspect / (2 * tan(lens->angle / 2));
    double ahead[3], side[3], above[3];
    for (int k = 0; k < 3; k++)
        ahead[k] = to[k] - at[k];
    frame(ahead, up, side, above);
    for (int k = 0; k < 3; k++) {
        side[k] *= lens->aspect;
        ahead[k] = ahead[k] * distance + shift[0] * side[k] + shift[1] * above[k];
    }
    vector_print(out, "  direction ", ahead, "\n");
    vector_print(out, "  right ", side, "\n");
    vector_print(out, "  up ", above, "\n");
}

/* A shifted parallel projection is one that is moved. */
static void move_orthographic(const Lens *lens, double at[3], double to[3], const double up[3], const double shift[2],
                              double scale)
{
    double ahead[3], side[3], above[3];
    for (int k = 0; k < 3; k++)
        ahead[k] = to[k] - at[k];
    frame(ahead, up, side, above);
    for (int k = 0; k < 3; k++) {
        const double by = lens->width * scale * (shift[0] * side[k] + shift[1] * above[k] / lens->aspect);
        at[k] += by, to[k] += by;
    }
}

/* A thin lens: POV-Ray's aperture is four times its radius. */
static void print_lens(const Import *import, FILE *out, const GltfCamera *camera, const double at[3],
                       const double to[3])
{
    const double scale = import->options->scale;
    double focus[3];
    for (int k = 0; k < 3; k++)
        focus[k] = at[k] + (to[k] - at[k]) * camera->focus_distance * scale;
    fprintf(out, "  aperture %.6g\n", 4 * camera->lens_radius * scale);
    vector_print(out, "  focal_point ", focus, "\n  blur_samples 64\n");
}

static int write_camera(const Import *import, int index, const char *name, FILE *out)
{
    static const GltfCamera plain;
    const GltfCamera *gltf = import->is_gltf ? &import->gltf.cameras[index] : &plain;
    const Lens lens = lens_of(import, index);
    const int is_shifted = lens.width == 0 && (gltf->shift[0] != 0 || gltf->shift[1] != 0);
    double at[3], to[3], up[3];
    if (!place(import, index, at, to, up))
        return 0;
    if (lens.width > 0)
        move_orthographic(&lens, at, to, up, gltf->shift, import->options->scale);
    fprintf(out, "#declare %s = camera {\n", name);
    if (lens.width > 0)
        fprintf(out, "  orthographic\n");
    vector_print(out, "  location ", at, "\n");
    if (is_shifted)
        print_shifted(out, &lens, at, to, up, gltf->shift);
    else
        vector_print(out, "  sky ", up, "\n");
    if (lens.width > 0) {
        const double width = lens.width * import->options->scale;
        fprintf(out, "  right x * %.7g\n  up y * %.7g\n", width, width / lens.aspect);
    } else if (!is_shifted)
        fprintf(out, "  right x * %.9g\n  up y\n  angle %.9g\n", lens.aspect, lens.angle * 180 / PI);
    if (!is_shifted)
        vector_print(out, "  look_at ", to, "\n");
    if (gltf->lens_radius > 0 && gltf->focus_distance > 0)
        print_lens(import, out, gltf, at, to);
    fprintf(out, "}\n");
    return 1;
}

/* Where a camera is that the scene has, in the Space's lengths. */
static View view_of(const Import *import, int index)
{
    const Lens lens = lens_of(import, index);
    const double scale = import->sense->scale;
    double at[3], to[3], up[3], ahead[3], side[3];
    View view = {.angle = lens.angle * 180 / PI, .aspect = lens.aspect};
    place(import, index, at, to, up);
    for (int k = 0; k < 3; k++) {
        ahead[k] = to[k] - at[k];
        view.eye[k] = at[k] / scale, view.ahead[k] = ahead[k];
    }
    frame(ahead, up, side, view.up);
    view.width = lens.width * import->options->scale / scale;
    return view;
}

typedef struct Cameras {
    char (*names)[NAME_SIZE]; /* "" = its place is no number */
    int count;
} Cameras;

/* How a camera may be named, the best first. */
static int answers_to(const Import *import, const Cameras *cameras, int index, const char *asked, int form)
{
    char *end;
    const long number = strtol(asked, &end, 10);
    return cameras->names[index][0] && (form == 0   ? strcmp(asked, camera_name(import, index)) == 0
                                        : form == 1 ? strcmp(asked, cameras->names[index]) == 0
                                                    : !*end && number == (long)index + 1);
}

/* The camera of the model that --camera asks for, the first of that name; else the first of all. Returns -1 where there
 * is none. */
static int choose(const Import *import, const Cameras *cameras, int *chosen, RetexError *err)
{
    enum { FORMS = 3 };
    const char *asked = import->options->camera;
    const int is_any = !asked || strcmp(asked, "auto") == 0;
    *chosen = -1;
    for (int i = cameras->count; i-- > 0 && is_any;)
        if (cameras->names[i][0])
            *chosen = i;
    for (int form = 0; form < FORMS && !is_any && *chosen < 0; form++)
        for (int i = cameras->count; i-- > 0;)
            if (answers_to(import, cameras, i, asked, form))
                *chosen = i;
    if (*chosen >= 0 || is_any)
        return RETEX_OK;
    return retex_fail(err, RETEX_ENOTFOUND, "--camera %s: the model has %d camera%s%s%.100s", asked, cameras->count,
                      cameras->count == 1 ? "" : "s", cameras->count ? ", the first is " : "",
                      cameras->count ? cameras->names[0] : "");
}

static int write_cameras(Import *import, Cameras *cameras, FILE *out, RetexError *err)
{
    char name[TEXT_SIZE + 8];
    int chosen, is_framed;
    for (int i = 0; i < cameras->count; i++) {
        snprintf(name, sizeof name, "Camera_%s", camera_name(import, i));
        if (!names_make(&import->names, name, "Camera", cameras->names[i]))
            return retex_fail(err, RETEX_ENOMEM, "out of memory");
        if (!write_camera(import, i, cameras->names[i], out))
            cameras->names[i][0] = '\0';
    }
    int code = framing_is_asked(import, &is_framed, err);
    if (code)
        return code;
    code = is_framed ? RETEX_OK : choose(import, cameras, &chosen, err);
    if (code)
        return code;
    if (is_framed || chosen < 0)
        return framing_write(import, out, err);
    place(import, chosen, import->eye, import->target, (double[3]){0});
    import->angle = lens_of(import, chosen).angle * 180 / PI;
    const char *used = cameras->names[chosen];
    if (cameras->count > 1)
        import_tell(import, IMPORT_INFO, "camera %d of %d is used, %s; --camera takes another one", chosen + 1,
                    cameras->count, used);
    const View view = import->sense && import->sense->space ? view_of(import, chosen) : (View){.angle = 0};
    return framing_write_own(import, used, view.angle > 0 ? &view : NULL, out, err);
}

int cameras_write(Import *import, FILE *out, RetexError *err)
{
    Cameras cameras = {.count = count_cameras(import)};
    cameras.names = calloc((size_t)cameras.count + 1, sizeof *cameras.names);
    if (!cameras.names)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    fprintf(out, "// ---- camera ----\n\n");
    const int code = write_cameras(import, &cameras, out, err);
    free(cameras.names);
    return code;
}
