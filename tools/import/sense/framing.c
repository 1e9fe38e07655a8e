/* Views of a scene that are none of the model's cameras: the best of all, or from where one says; and others to choose
 * from. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/sense/sense.h"
#include "import/space/space.h"
#include "import/space/views.h"

typedef struct Framing {
    double at[3], to[3], angle;
} Framing;

/* ---- a place that is given ---- */

static int take_point(const char **text, double point[3])
{
    for (int k = 0; k < 3; k++) {
        char *end;
        point[k] = strtod(*text, &end);
        if (end == *text || !(fabs(point[k]) < 1e15) || (k < 2 && *end != ','))
            return 0;
        *text = end + (k < 2);
    }
    return 1;
}

/* X,Y,Z:X,Y,Z[:ANGLE]. Returns 0 where it is not that. */
static int take_place(const char *text, Framing *framing)
{
    char *end;
    framing->angle = 70;
    if (!take_point(&text, framing->at) || *text++ != ':' || !take_point(&text, framing->to))
        return 0;
    if (!*text)
        return 1;
    if (*text++ != ':')
        return 0;
    framing->angle = strtod(text, &end);
    return end != text && !*end;
}

int framing_is_asked(const Import *import, int *is_asked, RetexError *err)
{
    const char *asked = import->options->camera;
    Framing framing;
    *is_asked = 0;
    if (!asked)
        return RETEX_OK;
    *is_asked =
        sense_camera_is(import, "inside") || sense_camera_is(import, "outside") || sense_camera_is(import, "cutaway");
    if (*is_asked || !strchr(asked, ':') || !take_place(asked, &framing))
        return RETEX_OK;
    *is_asked = 1;
    if (!(framing.angle >= 1 && framing.angle <= 170))
        return retex_fail(err, RETEX_EINVAL, "--camera %s: expected an angle from 1 to 170 degrees", asked);
    if (memcmp(framing.at, framing.to, sizeof framing.at) == 0)
        return retex_fail(err, RETEX_EINVAL, "--camera %s: the camera is where it looks at", asked);
    return RETEX_OK;
}

/* ---- views ---- */

/* In the scene's lengths. From outside one looks at the middle of the model. */
static Framing framing_of(const Import *import, const ViewChoice *choice)
{
    const Room *room = &import->sense->room;
    const View *view = &choice->view;
    const double scale = import->sense->scale;
    double low[3], high[3];
    Framing framing = {.angle = view->angle};
    space_standing_bounds(room->space, low, high);
    for (int k = 0; k < 3; k++) {
        const double ahead = view->eye[k] + 2 * room->metre * view->ahead[k];
        framing.at[k] = view->eye[k] * scale;
        framing.to[k] = (choice->from == VIEWS_INSIDE ? ahead : low[k] + (high[k] - low[k]) / 2) * scale;
    }
    return framing;
}

static View view_of(const Import *import, const Framing *framing)
{
    double eye[3], ahead[3];
    for (int k = 0; k < 3; k++) {
        eye[k] = framing->at[k] / import->sense->scale;
        ahead[k] = framing->to[k] - framing->at[k];
    }
    return view_level(eye, ahead, framing->angle);
}

/* What a view shows, for people. */
static void describe(const ViewChoice *choice, char *text, size_t size)
{
    const Content *c = &choice->content;
    snprintf(text, size, "from %s%s; %.0f %% of it is furniture, %.0f %% floor, %d object%s seen",
             choice->from == VIEWS_INSIDE ? "inside" : "outside",
             choice->from == VIEWS_OUTSIDE && c->behind > 0.02 ? ", on the side that shows most" : "",
             100 * c->furniture, 100 * c->floor, c->things, c->things == 1 ? " is" : "s are");
}

static void print_view(FILE *out, const char *before, const Framing *f)
{
    fprintf(out, "%scamera {\n", before);
    vector_print(out, "  location ", f->at, "\n");
    fprintf(out, "  right x * 4/3\n  up y\n  angle %g\n", f->angle);
    vector_print(out, "  look_at ", f->to, "\n");
    fprintf(out, "}\n");
}

/* The views from the second on, to choose from; and a line that tells them. */
static int declare_others(Import *import, const Views *views, FILE *out, RetexError *err)
{
    char told[VIEWS_MOST * NAME_SIZE] = "";
    for (int i = 1; i < views->count; i++) {
        const Framing f = framing_of(import, &views->list[i]);
        char name[NAME_SIZE], shown[160], before[NAME_SIZE + 20];
        snprintf(name, sizeof name, "View_%d", i + 1);
        if (!names_make(&import->names, name, "View", name))
            return retex_fail(err, RETEX_ENOMEM, "out of memory");
        describe(&views->list[i], shown, sizeof shown);
        fprintf(out, "// the view is %s\n", shown);
        snprintf(before, sizeof before, "#declare %s = ", name);
        print_view(out, before, &f);
        const size_t length = strlen(told);
        snprintf(told + length, sizeof told - length, "%s%s %s", i == 1 ? "" : ", ", name,
                 views->list[i].from == VIEWS_INSIDE ? "from inside" : "from outside");
    }
    if (views->count > 1)
        import_tell(import, IMPORT_INFO, "other views: %s; --camera of retex-render takes one", told);
    return RETEX_OK;
}

/* ---- the scene's camera ---- */

/* What was chosen, and why. */
static void tell(const Import *import, const char *why, const Framing *f, const char *what, const char *more)
{
    import_tell(import, IMPORT_INFO, "%sthe view is %s, from %.4g,%.4g,%.4g to %.4g,%.4g,%.4g, %g degrees%s", why, what,
                f->at[0], f->at[1], f->at[2], f->to[0], f->to[1], f->to[2], f->angle, more);
}

static void tell_cutaway(const Import *import, const Framing *f)
{
    char more[120];
    snprintf(more, sizeof more, "; %ld triangle%s before the rooms %s left out", import->cutaway->count,
             import->cutaway->count == 1 ? "" : "s", import->cutaway->count == 1 ? "is" : "are");
    tell(import, "", f, "into the rooms from above", more);
}

static Framing frame_cutaway(const Cutaway *cutaway)
{
    Framing framing = {.angle = cutaway->angle};
    memcpy(framing.at, cutaway->eye, sizeof framing.at);
    memcpy(framing.to, cutaway->target, sizeof framing.to);
    return framing;
}

/* From the right in front and above, without having looked. */
static Framing frame_usual(const Import *import)
{
    static const double side[3] = {0.45, 0.35, -0.82};
    Framing framing = {.angle = 40};
    view_fit(import->low, import->high, side, framing.angle, framing.at, framing.to);
    return framing;
}

/* The scene's camera, which is none of the model's. */
static void use(Import *import, const Framing *framing, FILE *out)
{
    memcpy(import->eye, framing->at, sizeof import->eye);
    memcpy(import->target, framing->to, sizeof import->target);
    import->angle = framing->angle;
    import_tell(import, IMPORT_FRAMED, "%s", "");
    print_view(out, "", framing);
}

static int write_best(Import *import, const char *why, FILE *out, RetexError *err)
{
    const Sense *sense = import->sense;
    const ViewsFrom from = sense_camera_is(import, "inside")    ? VIEWS_INSIDE
                           : sense_camera_is(import, "outside") ? VIEWS_OUTSIDE
                                                                : VIEWS_EITHER;
    Views views = {.count = 0};
    int code = sense && sense->space ? views_find(&sense->room, sense->materials, from, NULL, &views, err) : RETEX_OK;
    if (code)
        return code;
    if (!views.count && from == VIEWS_INSIDE)
        return retex_fail(err, RETEX_ENOTFOUND, "--camera inside: %s: no place above a floor is free",
                          import->options->model);
    const Framing framing = views.count ? framing_of(import, &views.list[0]) : frame_usual(import);
    char shown[160] = "from outside";
    if (views.count)
        describe(&views.list[0], shown, sizeof shown);
    tell(import, why, &framing, shown, "");
    code = declare_others(import, &views, out, err);
    use(import, &framing, out);
    return code;
}

static int write_place(Import *import, const Framing *framing, FILE *out, RetexError *err)
{
    const Sense *sense = import->sense;
    Views views = {.count = 0};
    int code = RETEX_OK;
    if (sense && sense->space) {
        const View given = view_of(import, framing);
        code = views_find(&sense->room, sense->materials, VIEWS_EITHER, &given, &views, err);
    }
    if (!code)
        code = declare_others(import, &views, out, err);
    use(import, framing, out);
    return code;
}

/* Within a wall or another thing, or before one; or where there is nothing at all. */
static int sees_nothing(const Content *content)
{
    return content->nothing > 0.995 || (content->near > 0.9 && content->things < 3) ||
           (content->back > 0.5 && content->things < 5);
}

int framing_write_own(Import *import, const char *name, const View *view, FILE *out, RetexError *err)
{
    const int is_asked = import->options->camera && !sense_camera_is(import, "auto");
    Views views = {.count = 0};
    int code = RETEX_OK;
    if (view)
        code = views_find(&import->sense->room, import->sense->materials, VIEWS_EITHER, view, &views, err);
    if (!code && views.count > 1 && !is_asked && sees_nothing(&views.list[0].content)) {
        import_tell(import, IMPORT_INFO,
                    "the camera %s sees nothing, or a wall before it; --camera %s takes it all the same", name, name);
        return write_best(import, "", out, err);
    }
    if (!code && views.count)
        import_tell(import, IMPORT_DETAIL, "%d of %d other views show more than %s", views.better, views.candidates,
                    name);
    if (!code)
        code = declare_others(import, &views, out, err);
    fprintf(out, "camera { %s }\n\n", name);
    return code;
}

int framing_write(Import *import, FILE *out, RetexError *err)
{
    const char *asked = import->options->camera;
    Framing framing;
    int code = RETEX_OK;
    if (asked && strchr(asked, ':') && take_place(asked, &framing))
        code = write_place(import, &framing, out, err);
    else if (import->cutaway) {
        framing = frame_cutaway(import->cutaway);
        use(import, &framing, out);
        tell_cutaway(import, &framing);
    } else
        code =
            write_best(import, asked && !sense_camera_is(import, "auto") ? "" : "no camera in the model: ", out, err);
    fprintf(out, "\n");
    return code;
}
