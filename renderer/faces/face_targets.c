/* Marks the faces that targets select by themselves; see faces.h. */
#include <stdlib.h>
#include <string.h>
#include "faces/faces.h"
#include "shape/shape.h"

/* Of the scene's primitives: tables of their faces, while these are marked. */
typedef struct Marks {
    Scene *scene;
    int8_t **tables; /* by primitive; in the arena */
} Marks;

static int fail_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory for the faces of targets");
}

/* The first target that was asked for wins. What has one face is the target as a whole. */
static int mark(Marks *marks, int number, int face, int target, RetexError *err)
{
    Primitive *p = &marks->scene->primitives[number];
    const int count = faces_count(p);
    if (count == 1 && !p->shape.mesh) {
        if (p->target < 0 || target < p->target)
            p->target = target;
        if (p->interior_texture && (p->interior_target < 0 || target < p->interior_target))
            p->interior_target = target;
        return RETEX_OK;
    }
    if (!marks->tables[number]) {
        marks->tables[number] = arena_alloc(marks->scene->arena, (size_t)count);
        if (!marks->tables[number])
            return fail_memory(err);
        memset(marks->tables[number], -1, (size_t)count);
    }
    if (marks->tables[number][face] < 0)
        marks->tables[number][face] = (int8_t)target;
    return RETEX_OK;
}

static int mark_flat(Marks *marks, const FaceSelection *of, int target, RetexError *err)
{
    const Primitive *p = &marks->scene->primitives[of->number - 1];
    int *label = faces_flat(p), code = RETEX_OK;
    if (!label)
        return fail_memory(err);
    for (int face = 0; face < faces_count(p) && !code; face++)
        if (label[face] >= 0 && label[face] == label[of->face - 1])
            code = mark(marks, of->number - 1, face, target, err);
    free(label);
    return code;
}

static int mark_level(Marks *marks, const FaceLevel *level, int target, RetexError *err)
{
    const Scene *scene = marks->scene;
    const double size = faces_scene_size(scene);
    int code = RETEX_OK;
    for (int k = 0; k < scene->nprimitives; k++) {
        const Primitive *p = &scene->primitives[k];
        const FaceOwner owner = faces_owner(scene, p, size);
        for (int face = 0; face < faces_count(p) && !code; face++)
            if (faces_are_on_level(level, scene, &owner, face))
                code = mark(marks, k, face, target, err);
    }
    return code;
}

static int mark_selection(Marks *marks, const FaceSelection *of, int target, RetexError *err)
{
    FaceLevel level;
    int code = faces_check(marks->scene, of, err);
    if (!code && !of->level)
        return mark_flat(marks, of, target, err);
    if (!code)
        code = faces_level(&level, marks->scene, of, err);
    return code ? code : mark_level(marks, &level, target, err);
}

/* ---- the textures of marked faces ---- */

/* Bits of targets by texture: the primitive's own, the interior's, those of its parts. */
static void find_textures(const Primitive *p, const int8_t *table, unsigned char *targets)
{
    const int interior = p->interior_texture != NULL, parts = 1 + interior;
    const Mesh *mesh = p->shape.mesh;
    for (int face = 0; face < faces_count(p); face++) {
        const int own = mesh && p->shape.textures ? mesh->faces[face].texture : -1;
        if (table[face] < 0)
            continue;
        const unsigned char bit = (unsigned char)(1u << table[face]);
        targets[own < 0 ? 0 : parts + own] |= bit;
        if (interior && own < 0)
            targets[1] |= bit;
        for (int k = 0; own >= 0 && mesh->corner_textures && k < 2; k++)
            targets[parts + mesh->corner_textures[face][k]] |= bit;
    }
}

static int set_faces(Scene *scene, Primitive *p, const int8_t *table, RetexError *err)
{
    const Texture *texture;
    int count = 0, k = 0, target;
    while (primitive_texture(p, k, &target))
        k++;
    unsigned char *targets = calloc((size_t)k + 1, 1);
    FaceTargets *faces = arena_alloc(scene->arena, sizeof *faces);
    if (targets)
        find_textures(p, table, targets);
    for (int i = 0; targets && i < k; i++)
        count += __builtin_popcount(targets[i]);
    struct FaceTexture *list = arena_alloc(scene->arena, ((size_t)count + 1) * sizeof *list);
    if (!targets || !faces || !list) {
        free(targets);
        return fail_memory(err);
    }
    *faces = (FaceTargets){.of = table, .textures = list};
    for (int i = 0; i < k; i++)
        for (int t = 0; t < RETEX_MAX_TARGETS; t++)
            if (targets[i] >> t & 1 && (texture = primitive_texture(p, i, &target)))
                list[faces->count++] = (struct FaceTexture){texture, t};
    p->faces = faces;
    free(targets);
    return RETEX_OK;
}

int faces_mark(Scene *scene, RetexError *err)
{
    Marks marks = {scene, NULL};
    int code = RETEX_OK, any = 0;
    for (int t = 0; t < scene->ntargets; t++)
        any += scene->targets[t].nselections;
    if (!any)
        return RETEX_OK;
    marks.tables = calloc((size_t)scene->nprimitives + 1, sizeof *marks.tables);
    if (!marks.tables)
        return fail_memory(err);
    for (int t = 0; t < scene->ntargets; t++)
        for (int k = 0; k < scene->targets[t].nselections && !code; k++)
            code = mark_selection(&marks, &scene->targets[t].selections[k], t, err);
    for (int k = 0; k < scene->nprimitives && !code; k++)
        if (marks.tables[k])
            code = set_faces(scene, &scene->primitives[k], marks.tables[k], err);
    free(marks.tables);
    return code;
}
