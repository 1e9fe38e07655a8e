/* Variants of a glTF file, by KHR_materials_variants: each names materials in the place of those that some of the
 * meshes have. The scene gets the materials of none, or those of --variant. In the former case, what variants change of
 * colours and finishes alone is offered as targets of one render, and a table has all such variants. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <retex/set.h>

#include "import/base/mesh.h"
#include "import/base/tell.h"
#include "import/scene/images.h"
#include "import/scene/scene.h"
#include "import/scene/surface.h"

enum { COMBINATIONS = 8 /* of finishes, of retex-render --finish */, CELL_SIZE = 320 };

/* What a variant makes of some surfaces. */
typedef struct Look {
    char image[CELL_SIZE]; /* of the table, "" = the original */
    int finish;            /* 0 = the original's */
    int is_apart;          /* it changes more than a colour and a finish */
} Look;

typedef struct Part {
    const VariantSurfaces *surfaces;
    int index; /* of its material, of Assimp's */
    ImportMaterial *material;
    Look *looks;                        /* by variant */
    char *finishes[RETEX_FINISHES_MAX]; /* their texts; the first is the original's */
    char names[RETEX_FINISHES_MAX][NAME_SIZE];
    int nfinishes, is_target;
} Part;

typedef struct Table {
    Import *import;
    Variants *variants;
    Part *parts;
    int nparts;
} Table;

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "out of memory");
}

/* Assimp's material of that place in the file, or -1. */
static int find_material(const Import *import, int place)
{
    for (unsigned i = 0; i < import->scene->mNumMaterials; i++)
        if (place >= 0 && import->materials[i].place == place)
            return (int)i;
    return -1;
}

/* ---- looks ---- */

static int is_same_map(const Map *a, const Map *b)
{
    return strcmp(a->source, b->source) == 0 &&
           (!a->source[0] || (a->uv_set == b->uv_set && memcmp(&a->place, &b->place, sizeof a->place) == 0));
}

/* A new texture shows what a pigment is where the surface is opaque and does not shine. */
static int is_paint(const Surface *s)
{
    return s->alpha == ALPHA_IGNORE && s->opacity == 1 && s->transmission <= 0 && !s->unlit &&
           largest(s->emission) <= 0;
}

/* Bumps are the material's, not the finish's. */
static int has_same_bumps(const Surface *a, const Surface *b)
{
    return is_same_map(&a->normal_map, &b->normal_map) && a->normal_scale == b->normal_scale &&
           a->has_heights == b->has_heights && a->bump.is_there == b->bump.is_there &&
           a->bump.distance == b->bump.distance && a->bump.strength == b->bump.strength;
}

/* Maps of a finish need UV that the surfaces have. */
static int fits(const Surface *s, const ImportMaterial *of)
{
    const Map *const maps[] = {&s->base_map,      &s->roughness_map,           &s->metallic_map,
                               &s->clearcoat_map, &s->clearcoat_roughness_map, &s->clearcoat_normal_map,
                               &s->sheen_map};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (maps[i]->source[0] && maps[i]->uv_set != of->uv_set && (i == 0 || maps[i]->uv_set != of->second_uv))
            return 0;
    return 1;
}

/* Options of a texture that place it as glTF does: scaled, turned, moved. */
static void print_options(char text[CELL_SIZE], const Affine *place)
{
    const double(*m)[4] = place->m, sx = hypot(m[0][0], m[1][0]);
    const double sy = sx > 0 ? (m[0][0] * m[1][1] - m[0][1] * m[1][0]) / sx : 0,
                 angle = atan2(m[1][0], m[0][0]) * 180 / PI;
    text[0] = '\0';
    if (memcmp(place, &affine_identity, sizeof *place) != 0)
        snprintf(text, CELL_SIZE, ":scale=%.9g,%.9g:rotate=%.9g:offset=%.9g,%.9g ", sx, sy, angle, m[0][3], m[1][3]);
}

static int set_image(Import *import, const Surface *s, Look *look, RetexError *err)
{
    const ImageUse use = {.source = s->base_map.source,
                          .factor = {s->base[0], s->base[1], s->base[2]},
                          .opacity_factor = 1,
                          .alpha = ALPHA_IGNORE};
    char file[NAME_SIZE + 32], before[CELL_SIZE];
    if (!s->base_map.source[0]) {
        snprintf(look->image, sizeof look->image, "rgb(%.6g,%.6g,%.6g)", (double)s->base[0], (double)s->base[1],
                 (double)s->base[2]);
        return RETEX_OK;
    }
    const int code = images_use(import, &use, file, err);
    print_options(before, &s->base_map.place);
    if (file[0])
        snprintf(look->image, sizeof look->image, "%.200s%s", before, file);
    look->is_apart = !file[0];
    return code;
}

static int is_same_color(const Surface *a, const Surface *b)
{
    return is_same_map(&a->base_map, &b->base_map) && memcmp(a->base, b->base, sizeof a->base) == 0;
}

/* One of the finishes of the part; apart where there are too many. */
static int set_finish(Import *import, Part *part, int other, const char *variant, Look *look, RetexError *err)
{
    char *text, name[NAME_SIZE + NAME_SIZE + 8];
    const int code = materials_finish(import, other, part->material, &text, err);
    for (look->finish = 0; !code && look->finish < part->nfinishes; look->finish++)
        if (strcmp(part->finishes[look->finish], text) == 0)
            break;
    look->is_apart |= look->finish == RETEX_FINISHES_MAX;
    if (code || look->finish < part->nfinishes || look->is_apart) {
        free(text);
        return code;
    }
    snprintf(name, sizeof name, "%s %s finish", part->material->name, variant);
    part->finishes[part->nfinishes] = text;
    return names_make(&import->names, name, "Finish", part->names[part->nfinishes++]) ? RETEX_OK : no_memory(err);
}

static int set_look(Table *t, Part *part, int variant, const Surface *own, RetexError *err)
{
    const int other = find_material(t->import, part->surfaces->others[variant]);
    Look *look = &part->looks[variant];
    Surface s;
    if (other == part->index)
        return RETEX_OK;
    look->is_apart = other < 0;
    int code = look->is_apart ? RETEX_OK : surface_read(t->import, other, &s, err);
    if (code || look->is_apart)
        return code;
    look->is_apart = !is_paint(own) || !is_paint(&s) || !has_same_bumps(own, &s) || !fits(&s, part->material);
    if (!look->is_apart && !is_same_color(own, &s))
        code = set_image(t->import, &s, look, err);
    return code || look->is_apart ? code : set_finish(t->import, part, other, t->variants->names[variant], look, err);
}

/* Colours of vertices multiply a pigment, but no new texture. */
static int is_colored(const Import *import, int material)
{
    for (unsigned i = 0; i < import->scene->mNumMeshes; i++)
        if ((int)import->scene->mMeshes[i]->mMaterialIndex == material && mesh_has_colors(import->scene->mMeshes[i]))
            return 1;
    return 0;
}

static int set_looks(Table *t, Part *part, RetexError *err)
{
    Surface own;
    const int colored = is_colored(t->import, part->index);
    int code = surface_read(t->import, part->index, &own, err);
    if (!code)
        code = materials_finish(t->import, part->index, part->material, &part->finishes[part->nfinishes++], err);
    for (int v = 0; v < t->variants->count && !code; v++) {
        code = set_look(t, part, v, &own, err);
        part->looks[v].is_apart |= colored && (part->looks[v].image[0] || part->looks[v].finish);
    }
    return code;
}

/* ---- the table ---- */

static int changes(const Look *look)
{
    return look->image[0] || look->finish;
}

static void find_apart(Table *t)
{
    for (int v = 0; v < t->variants->count; v++)
        for (int k = 0; k < t->nparts; k++)
            t->variants->is_apart[v] |= t->parts[k].looks[v].is_apart;
}

/* As many targets and finishes as one render has; variants that need more are apart. */
static void choose_targets(Table *t)
{
    int ntargets = 0, combinations = 1;
    for (int k = 0; k < t->nparts; k++) {
        Part *part = &t->parts[k];
        int used = 0, varies = 0;
        for (int v = 0; v < t->variants->count; v++)
            if (!t->variants->is_apart[v])
                used |= changes(&part->looks[v]), varies |= part->looks[v].finish > 0;
        const int count = varies ? part->nfinishes : 1;
        part->is_target = used && ntargets < RETEX_MAX_TARGETS && combinations * count <= COMBINATIONS;
        if (!used)
            continue;
        ntargets += part->is_target;
        combinations *= part->is_target ? count : 1;
        for (int v = 0; v < t->variants->count && !part->is_target; v++)
            t->variants->is_apart[v] |= (char)changes(&part->looks[v]);
    }
}

/* A target whose variants all have gone apart, for another one's sake, is none. */
static void drop_unused(Table *t)
{
    for (int k = 0; k < t->nparts; k++) {
        int used = 0;
        for (int v = 0; v < t->variants->count; v++)
            used |= !t->variants->is_apart[v] && changes(&t->parts[k].looks[v]);
        t->parts[k].is_target &= used;
    }
}

static int has_finishes(const Table *t, const Part *part)
{
    int varies = 0;
    for (int v = 0; v < t->variants->count; v++)
        varies |= !t->variants->is_apart[v] && part->looks[v].finish > 0;
    return part->is_target && varies;
}

static void print_finishes(const Table *t, FILE *out)
{
    for (int k = 0; k < t->nparts; k++)
        for (int f = 1; f < t->parts[k].nfinishes && has_finishes(t, &t->parts[k]); f++)
            fprintf(out, "#declare %s =%s", t->parts[k].names[f], t->parts[k].finishes[f] + 1);
}

/* A row; name = NULL: of the columns. */
static void print_row(const Table *t, FILE *out, const char *name, int variant)
{
    fprintf(out, name ? "%s.png" : "output", name);
    for (int k = 0; k < t->nparts; k++)
        if (t->parts[k].is_target && !name)
            fprintf(out, ",%s", t->parts[k].material->name);
        else if (t->parts[k].is_target)
            fprintf(out, variant >= 0 && t->parts[k].looks[variant].image[0] ? ",\"%s\"" : ",",
                    variant >= 0 ? t->parts[k].looks[variant].image : "");
    for (int k = 0; k < t->nparts; k++) {
        const Part *part = &t->parts[k];
        if (!has_finishes(t, part))
            continue;
        const int finish = variant >= 0 ? part->looks[variant].finish : 0;
        fprintf(out, name ? ",%s%s" : ",finish:%s%s", name ? "" : part->material->name,
                !name    ? ""
                : finish ? part->names[finish]
                         : "original");
    }
    fputc('\n', out);
}

/* Files are named as the variants are, as far as all systems allow. */
static int write_table(const Table *t, RetexError *err)
{
    char path[PATH_MAX], name[NAME_SIZE];
    Names names = {0};
    const ImportOptions *options = t->import->options;
    if (snprintf(path, sizeof path, "%s/%s-variants.csv", options->folder, options->name) >= PATH_MAX)
        return retex_fail(err, RETEX_EIO, "the name of the output is too long");
    FILE *out = fopen(path, "wb");
    if (!out)
        return retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(errno));
    print_row(t, out, NULL, -1);
    int done = names_make(&names, "default", "default", name);
    if (done)
        print_row(t, out, name, -1);
    for (int v = 0; v < t->variants->count && done; v++)
        if (!t->variants->is_apart[v] && (done = names_make(&names, t->variants->names[v], "Variant", name)))
            print_row(t, out, name, v);
    names_free(&names);
    const int failed = ferror(out);
    if (fclose(out) != 0 || failed)
        return retex_fail(err, RETEX_EIO, "cannot write %s", path);
    return done ? RETEX_OK : no_memory(err);
}

static int write_command(const Table *t, RetexError *err)
{
    const char *name = t->import->options->name;
    size_t size;
    FILE *out = open_memstream(&t->variants->command, &size);
    if (!out)
        return no_memory(err);
    fprintf(out, "retex-render '%s.pov'", name);
    for (int k = 0; k < t->nparts; k++) {
        const Part *part = &t->parts[k];
        if (part->is_target)
            fprintf(out, " -t %s", part->material->name);
        if (!has_finishes(t, part))
            continue;
        fprintf(out, " --finish %s=original", part->material->name);
        for (int f = 1; f < part->nfinishes; f++)
            fprintf(out, ",%s", part->names[f]);
    }
    fprintf(out, " | retex-combine - --batch '%s-variants.csv'", name);
    return fclose(out) == 0 ? RETEX_OK : no_memory(err);
}

static int has_targets(const Table *t)
{
    int any = 0;
    for (int k = 0; k < t->nparts; k++)
        any |= t->parts[k].is_target;
    return any;
}

static int fill(Table *t, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < t->variants->nsurfaces && !code; k++) {
        const VariantSurfaces *surfaces = &t->variants->surfaces[k];
        const int index = find_material(t->import, surfaces->material);
        if (index < 0 || !t->import->materials[index].is_used)
            continue;
        Part *part = &t->parts[t->nparts++];
        *part = (Part){.surfaces = surfaces, .index = index, .material = &t->import->materials[index]};
        part->looks = calloc((size_t)t->variants->count, sizeof *part->looks);
        code = part->looks ? set_looks(t, part, err) : no_memory(err);
    }
    return code;
}

int variants_write(Import *import, FILE *out, RetexError *err)
{
    Table t = {.import = import, .variants = &import->variants};
    if (!import->variants.nsurfaces)
        return RETEX_OK;
    t.parts = calloc((size_t)import->variants.nsurfaces, sizeof *t.parts);
    import->variants.is_apart = calloc((size_t)import->variants.count, 1);
    int code = t.parts && import->variants.is_apart ? fill(&t, err) : no_memory(err);
    if (!code) {
        find_apart(&t);
        choose_targets(&t);
        drop_unused(&t);
    }
    if (!code && has_targets(&t)) {
        print_finishes(&t, out);
        code = write_table(&t, err);
        if (!code)
            code = write_command(&t, err);
    }
    for (int k = 0; k < t.nparts; k++) {
        free(t.parts[k].looks);
        for (int f = 0; f < t.parts[k].nfinishes; f++)
            free(t.parts[k].finishes[f]);
    }
    free(t.parts);
    return code;
}

void variants_tell(const Import *import)
{
    enum { MOST = 16 };
    const Variants *v = &import->variants;
    int apart = 0, joined = 0;
    for (int i = 0; i < v->count && v->is_apart; i++)
        apart += v->is_apart[i], joined += !v->is_apart[i];
    if (v->command)
        import_tell(import, IMPORT_INFO, "%d variant%s, from one render, in the scene's folder: %s", joined,
                    joined == 1 ? "" : "s", v->command);
    for (int i = 0, lines = 0; i < v->count && v->is_apart; i++)
        if (v->is_apart[i] && lines++ < MOST)
            import_tell(import, IMPORT_INFO, "the variant `%s` needs a scene of its own: --variant '%s'", v->names[i],
                        v->names[i]);
    if (apart > MOST)
        import_tell(import, IMPORT_INFO, "so do %d more", apart - MOST);
}
