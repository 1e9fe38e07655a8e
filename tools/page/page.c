/* See page.h. */
#include "page/page.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/output_file.h>

#include "common/beneath.h"
#include "common/output_folder.h"
#include "page/added.h"
#include "page/look.h"

#define INDEX "index.html"
static const char SOURCE[] = "src=\".\"";

/* The player's files, embedded by the build. */
typedef struct PlayerFile {
    const char *name;
    const unsigned char *data;
    size_t bytes;
} PlayerFile;
extern const PlayerFile retex_player_files[]; /* ends with {0} */

/* The page itself, whose room begins with its look, and offers the pictures of that. */
static int write_index(const char *path, const PlayerFile *file, RetexEdit *look, RetexError *err)
{
    const char *data = (const char *)file->data, *at = memmem(data, file->bytes, SOURCE, strlen(SOURCE));
    const int before = (int)(at + strlen(SOURCE) - data), after = (int)file->bytes - before;
    char *made = NULL, textures[4096];
    look_offer(textures, sizeof textures, look);
    const int bytes =
        asprintf(&made, "%.*s preset=\"" LOOK_FILE "\"%s%s%s%.*s", before, data, textures[0] ? " textures=\"" : "",
                 textures, textures[0] ? "\"" : "", after, data + before);
    if (bytes < 0)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a page");
    const int code = retex_file_write(path, made, (size_t)bytes, err);
    free(made);
    return code;
}

/* look: NULL: the page begins as rendered. */
static int write_player(const char *folder, RetexEdit *look, Added *added, RetexError *err)
{
    int code = 0;
    for (const PlayerFile *file = retex_player_files; file->name && !code; file++) {
        char path[PATH_MAX];
        snprintf(path, sizeof path, "%s/%s", folder, file->name);
        if (!added_note(added, path))
            code = retex_fail(err, RETEX_ENOMEM, "not enough memory for the names of files");
        else if (look && strcmp(file->name, INDEX) == 0)
            code = write_index(path, file, look, err);
        else
            code = retex_file_write(path, file->data, file->bytes, err);
    }
    return code;
}

typedef struct Notes {
    char text[2 + RETEX_WEB_SMALLER][2400];
    int count;
} Notes;

static void keep_note(void *context, const char *text)
{
    Notes *notes = context;
    if (notes->count < 2 + RETEX_WEB_SMALLER)
        snprintf(notes->text[notes->count++], sizeof notes->text[0], "%s", text);
}

static void manifest_of(char path[PATH_MAX], const Cli *cli, const char *folder)
{
    if (snprintf(path, PATH_MAX, "%s/room.json", folder) >= PATH_MAX - RETEX_NAME_MAX)
        cli_die(cli, "--web: the name of the folder is too long");
}

void page_announce(Cli *cli, const Page *page)
{
    char manifest[PATH_MAX];
    manifest_of(manifest, cli, page->folder);
    if (page->preset)
        cli_input(cli, page->preset, "a preset, as of retex-combine --save-preset");
    cli_reads(cli, "the preset", page->preset);
    cli_writes(cli, "--web", manifest);
}

static int refuse_link(const char *folder, const char *name, RetexError *err)
{
    return retex_fail(err, RETEX_EACCESS, "%s%s%s is a link: a page is written beside none", folder, *name ? "/" : "",
                      name);
}

/* A folder that is there may come from a stranger: nothing that is written into it may go elsewhere. */
static int check_links(const char *folder, RetexError *err)
{
    char found[PATH_MAX];
    const int top = beneath_open_top(folder, 0);
    if (top < 0)
        return errno == ELOOP ? refuse_link(folder, "", err) : RETEX_OK; /* it is made, or what is wrong is told then */
    const int is_linked = beneath_find_link(top, found);
    close(top);
    return is_linked > 0 ? refuse_link(folder, found, err) : RETEX_OK;
}

static int write_files(Cli *cli, const Page *page, const RetexSet *set, RetexEdit *look, Added *added,
                       RetexWebBytes *bytes, RetexError *err)
{
    char manifest[PATH_MAX];
    manifest_of(manifest, cli, page->folder);
    int code = check_links(page->folder, err);
    if (!code)
        code = output_make_folders(manifest, err);
    if (!code && page->preset)
        code = look_write(look, cli, page->folder, added, err);
    if (!code)
        code = write_player(page->folder, page->preset ? look : NULL, added, err);
    if (!code)
        code = retex_web_write(set, page->folder, &page->params, bytes, cli->threads, err);
    return code;
}

int page_write(Cli *cli, const Page *asked, const char *set_path, const RetexSet *set, RetexError *err)
{
    Notes notes = {0};
    Page page = *asked;
    RetexWebBytes bytes = {0};
    Added added = {0};
    RetexEdit *look = NULL, *old = NULL;
    const int existed = access(page.folder, F_OK) == 0;
    int had_look = 0;
    page.params.note = keep_note;
    page.params.note_context = &notes;
    int code = retex_edit_create(&look, err);
    if (!code)
        code = retex_edit_create(&old, err);
    if (!code && page.preset)
        code = look_read(look, cli, page.preset, set, err);
    if (!code) {
        had_look = look_old(old, page.folder);
        code = write_files(cli, &page, set, look, &added, &bytes, err);
    }
    if (!code && had_look)
        look_remove_old(old, page.preset ? look : NULL, page.folder);
    added_end(&added, !code);
    if (code && !existed)
        rmdir(page.folder);
    retex_edit_close(&look);
    retex_edit_close(&old);
    if (code)
        return code;
    cli_info(cli, "set %s: %.0f bytes", set_path, cli_file_size(set_path));
    cli_info(cli, "folder %s: %zu bytes, %zu until the picture, %zu until the first target", page.folder, bytes.all,
             bytes.still, bytes.first);
    for (int i = 0; i < notes.count; i++)
        cli_info(cli, "%s", notes.text[i]);
    return RETEX_OK;
}
