/* A program of somebody else: changes the textures of a set, and writes the picture.
 * outsider SET EDIT OUTPUT, where EDIT is as Floor=oak.jpg;Floor.scale=2 */
#include <retex/retex.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    RetexImage picture = {0};
    RetexEdit *edit = NULL;
    if (argc != 4) {
        fprintf(stderr, "usage: outsider SET EDIT OUTPUT\n");
        return 2;
    }
    int code = retex_edit_create(&edit, &err);
    if (code == RETEX_OK)
        code = retex_edit_parse(edit, argv[2], &err);
    if (code == RETEX_OK)
        code = retex_set_read(argv[1], &set, 0, &err);
    if (code == RETEX_OK)
        code = retex_sample(set, retex_edit_texture(edit, 0), retex_edit_count(edit), 0, &err);
    if (code == RETEX_OK)
        code = retex_combine(&picture, set, NULL, NULL, 0, &err);
    if (code == RETEX_OK)
        code = retex_image_write(&picture, argv[3], NULL, 0, &err);
    if (code != RETEX_OK)
        fprintf(stderr, "outsider: %s: %s\n", err.file, err.message);
    retex_image_free(&picture);
    retex_set_close(&set);
    retex_edit_close(&edit);
    return code == RETEX_OK ? 0 : 2;
}
