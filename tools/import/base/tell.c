/* See tell.h. */
#include "import/base/tell.h"

#include <stdarg.h>

void import_tell(const Import *import, char kind, const char *fmt, ...)
{
    char text[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    import->options->tell(import->options->context, kind, text);
}

const char *import_plain(const char *text, char plain[NAME_SIZE])
{
    int n = 0;
    for (; *text && n + 1 < NAME_SIZE; text++)
        plain[n++] = (unsigned char)*text < 32 || *text == 127 ? '?' : *text;
    plain[n] = '\0';
    return plain;
}

/* ---- losses ---- */

enum { MOST_LINES = 16 };

void import_leave_out(Import *import, LeftOut what)
{
    static const char *const texts[] = {
        [LEFT_NORMAL_MAP] = "normal maps with a third set of UV are left out",
        [LEFT_FINISH_MAP] = "of images of the finish with a third set of UV, the mean is taken",
        [LEFT_EMISSION_MAP] = "images of emission with a third set of UV are left out",
        [LEFT_SPECULAR_MAP] = "images of the reflectance are left out",
        [LEFT_VERTEX_COLORS] = "colours of vertices are left out where a surface transmits light",
        [LEFT_SHEEN_ROUGHNESS_MAP] = "of images of the roughness of sheen, the mean is taken",
        [LEFT_ANIMATION] = "animations are left out",
        [LEFT_SKIN] = "skins are left out: meshes stay as they were bound",
        [LEFT_MORPHS] = "shape keys are left out: meshes keep their basic shape",
        [LEFT_AMBIENT_LIGHT] = "ambient lights are left out",
        [LEFT_OTHER_UV] = "of meshes without the set of UV that their images ask for, the first one is taken",
        [LEFT_NO_UV] = "images on meshes without UV show one colour",
        [LEFT_NOWHERE] = "objects whose place is no number are left out",
        [LEFT_LINES] = "points and lines are left out",
        [LEFT_SAME_NAME] = "cameras and lights that cannot be told from others of the same name are left out",
    };
    if (import->left_out >> what & 1)
        return;
    import->left_out |= 1ul << what;
    import_tell(import, IMPORT_WARNING, "%s", texts[what]);
}

int losses_of_image(Import *import, const char *source)
{
    return names_add(&import->lost_images, source) != 0 && ++import->nlost_images <= MOST_LINES;
}

int losses_check(Import *import, RetexError *err)
{
    const unsigned long others = 1ul << LEFT_NOWHERE | 1ul << LEFT_SAME_NAME | 1ul << LEFT_AMBIENT_LIGHT;
    const int images = import->nlost_images, has_others = (import->left_out & others) != 0;
    char count[64] = "";
    if (images > MOST_LINES)
        import_tell(import, IMPORT_WARNING, "%d more image%s lost", images - MOST_LINES,
                    images == MOST_LINES + 1 ? " is" : "s are");
    if (import->options->partial || (!images && !has_others))
        return RETEX_OK;
    if (images)
        snprintf(count, sizeof count, "%d image%s%s", images, images == 1 ? "" : "s", has_others ? ", and " : "");
    const int is_one = images == 1 && !has_others;
    return retex_fail(err, RETEX_EFORMAT, "%s: %s%s%s lost, see above; --partial makes the scene without %s",
                      import->options->model, count, has_others ? "objects, cameras or lights" : "",
                      is_one ? " is" : " are", is_one ? "it" : "them");
}
