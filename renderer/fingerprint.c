/* The fingerprint of a render: a digest of all that its rows depend on. --resume accepts only rows with the same
 * fingerprint. */
#include <elf.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/edit.h>
#include "base/digest.h"
#include "retex-render.h"

/* Add the build ID, which the linker computes from all that the program consists of. */
static void digest_build_id(uint64_t *digest, const unsigned char *note, size_t bytes)
{
    ElfW(Nhdr) header;
    while (bytes >= sizeof header) {
        memcpy(&header, note, sizeof header);
        const size_t name = (header.n_namesz + 3) & ~(size_t)3, id = (header.n_descsz + 3) & ~(size_t)3;
        if (name + id > bytes - sizeof header)
            return;
        if (header.n_type == NT_GNU_BUILD_ID && name == 4 && !memcmp(note + sizeof header, "GNU", 4))
            *digest = digest_bytes(*digest, note + sizeof header + name, header.n_descsz);
        note += sizeof header + name + id, bytes -= sizeof header + name + id;
    }
}

static int digest_program(struct dl_phdr_info *program, size_t size, void *digest)
{
    (void)size;
    for (int k = 0; k < program->dlpi_phnum; k++) {
        const ElfW(Phdr) *part = &program->dlpi_phdr[k];
        if (part->p_type == PT_NOTE)
            digest_build_id(digest, (const unsigned char *)(program->dlpi_addr + part->p_vaddr), part->p_memsz);
    }
    return 1; /* the program itself is the first; no libraries */
}

static uint64_t digest_file(uint64_t digest, const char *path)
{
    unsigned char buffer[65536];
    size_t got;
    FILE *file = fopen(path, "rb");
    if (!file) /* removed after it was read: the texture in memory counts */
        return digest_text(digest, path);
    while ((got = fread(buffer, 1, sizeof buffer, file)) > 0)
        digest = digest_bytes(digest, buffer, got);
    fclose(file);
    return digest;
}

static uint64_t digest_texture(uint64_t d, const RetexTextureSpec *s)
{
    char *options = NULL;
    d = digest_text(d, s->target);
    d = digest_bytes(d, s->color, sizeof s->color);
    d = digest_number(d, (uint64_t)s->constant);
    for (int k = -1; k < s->nlayers; k++) {
        RetexTextureSpec layer = *s;
        if (k >= 0)
            retex_texture_layer_get(&layer, s, k);
        if (retex_edit_options_text(&layer, &options, NULL)) /* no memory: as if nothing else had been said */
            options = NULL;
        d = digest_text(d, options ? options : "");
        free(options);
    }
    for (int k = 0; k < RETEX_TEXTURE_FILES; k++) {
        char *file;
        if (retex_texture_file(&file, s, k, NULL)) /* as above */
            d = digest_text(d, s->image);
        else if (file)
            d = digest_file(d, file);
        free(file);
    }
    return d;
}

uint64_t render_fingerprint(const Arguments *a, const Scene *scene)
{
    const RenderParams *r = &a->render;
    const int numbers[] = {
        r->width,        r->height,       r->crop[0],     r->crop[1],        r->crop[2],     r->crop[3],
        r->spp,          r->plain,        r->gaussian,    r->paper,          r->orders,      r->sharp,
        r->broad,        r->clusters,     r->extra,       r->stored,         r->max_depth,   (int)r->seed,
        r->strict_paper, r->denoise_data, a->sdl.ambient, r->caustics_guide, a->sdl.caustics};
    uint64_t d = digest_text(DIGEST_BEGIN, RETEX_VERSION);
    dl_iterate_phdr(digest_program, &d);
    d = digest_bytes(d, &r->noise, sizeof r->noise);
    d = digest_bytes(d, &r->unit, sizeof r->unit);
    d = digest_number(d, scene->digest);
    d = digest_text(d, a->sdl.camera ? a->sdl.camera : "");
    d = digest_bytes(d, numbers, sizeof numbers);
    for (int k = 0; k < a->ndeclares; k++)
        d = digest_text(d, a->declares[k]);
    for (int t = 0; t < scene->ntargets; t++) {
        d = digest_text(d, scene->targets[t].name);
        d = digest_text(d, scene->targets[t].idents);
    }
    for (int l = 0; l < scene->nlamps; l++) {
        const Lamp *lamp = &scene->lamps[l];
        d = digest_text(d, lamp->name);
        d = digest_text(d, lamp->idents);
        d = digest_bytes(d, &lamp->value, sizeof lamp->value);
        d = digest_bytes(d, &lamp->weight, sizeof lamp->weight);
    }
    for (int t = 0; t < scene->ntargets; t++)
        for (int k = 0; k < scene->targets[t].nfinishes; k++)
            d = digest_text(digest_number(d, (uint64_t)t), scene->targets[t].finishes[k].name);
    d = digest_number(d, (uint64_t)scene->shown);
    d = digest_bytes(d, &r->light_share, sizeof r->light_share);
    for (int k = 0; k < a->nreplacements; k++)
        d = digest_texture(d, &a->replacements[k]);
    return d;
}
