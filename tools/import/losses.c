/* What a scene would be without that the model has: images, objects and lights. It is made with --partial only. What
 * looks otherwise and is there, such as a surface without its anisotropy, is no loss. */
#include "import/internal.h"

enum { MOST_LINES = 16 };

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
