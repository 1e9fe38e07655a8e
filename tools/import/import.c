/* A model becomes a scene: Assimp reads it, NAME.pov and NAME-meshes.inc are written. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <retex/version.h>

#include "import/base/files.h"
#include "import/base/look_text.h"
#include "import/base/mesh.h"
#include "import/base/tell.h"
#include "import/base/world.h"
#include "import/gltf/gltf.h"
#include "import/import.h"
#include "import/read/read.h"
#include "import/scene/images.h"
#include "import/scene/scene.h"
#include "import/sense/sense.h"

#define FARTHEST 1e15 /* from the origin */

static void note_left_out(Import *import)
{
    const struct aiScene *scene = import->scene;
    if (scene->mNumAnimations)
        import_leave_out(import, LEFT_ANIMATION);
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        if (scene->mMeshes[i]->mNumBones)
            import_leave_out(import, LEFT_SKIN);
}

/* ---- nodes ---- */

typedef struct Bounds {
    double low[3], high[3];
    int any;
} Bounds;

static void add_bounds(Import *import, const struct aiNode *node, const Affine *world, void *context)
{
    const Affine placed = affine_mirror_z(world);
    const Bounds *bounds = context;
    if (!affine_is_finite(&placed)) {
        import_leave_out(import, LEFT_NOWHERE);
        return;
    }
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const Bounds *b = node->mMeshes[i] < import->scene->mNumMeshes ? &bounds[node->mMeshes[i]] : NULL;
        if (!b || !b->any)
            continue;
        for (int corner = 0; corner < 8; corner++) {
            const double p[3] = {corner & 1 ? b->high[0] : b->low[0], corner & 2 ? b->high[1] : b->low[1],
                                 corner & 4 ? b->high[2] : b->low[2]};
            double q[3];
            affine_point(&placed, p, q);
            for (int k = 0; k < 3; k++) {
                import->low[k] = fmin(import->low[k], q[k]);
                import->high[k] = fmax(import->high[k], q[k]);
            }
        }
    }
}

/* Of all that is placed. */
static int find_bounds(Import *import, RetexError *err)
{
    Bounds *bounds = calloc(import->scene->mNumMeshes + 1, sizeof *bounds);
    if (!bounds)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (unsigned i = 0; i < import->scene->mNumMeshes; i++)
        bounds[i].any = mesh_bounds(import->scene->mMeshes[i], bounds[i].low, bounds[i].high);
    for (int k = 0; k < 3; k++)
        import->low[k] = INFINITY, import->high[k] = -INFINITY;
    const int done = import_visit_nodes(import, add_bounds, bounds);
    free(bounds);
    if (!done)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (int k = 0; k < 3; k++) {
        if (import->low[k] > import->high[k])
            return retex_fail(err, RETEX_EFORMAT, "%s: there are no surfaces in it", import->options->model);
        if (!(fmax(-import->low[k], import->high[k]) < FARTHEST))
            return retex_fail(err, RETEX_EFORMAT, "%s: its surfaces reach farther than %g", import->options->model,
                              FARTHEST);
    }
    return RETEX_OK;
}

static void write_object(Import *import, const struct aiNode *node, const Affine *world, void *context)
{
    FILE *out = context;
    Affine placed = affine_mirror_z(world);
    const int is_visible = affine_is_finite(&placed) && affine_thicken(&placed);
    char plain[NAME_SIZE];
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const unsigned index = node->mMeshes[i];
        if (import->is_dropped[import->walked++] || !is_visible)
            continue;
        if (index >= import->scene->mNumMeshes || !import->meshes[index][0])
            continue;
        const ImportMaterial *material = &import->materials[import->scene->mMeshes[index]->mMaterialIndex];
        fprintf(out, "object { %s %s { %s }", import->meshes[index], material->is_solid ? "material" : "texture",
                material->name);
        affine_print(out, &placed);
        fprintf(out, " } // %s\n", import_plain(node->mName.data, plain));
        import->objects++;
    }
}

/* ---- the files ---- */

static FILE *open_output(const Import *import, const char *what, char path[PATH_MAX], RetexError *err)
{
    if (snprintf(path, PATH_MAX, "%s/%s%s", import->options->folder, import->options->name, what) >= PATH_MAX) {
        retex_fail(err, RETEX_EIO, "the name of the output is too long");
        return NULL;
    }
    FILE *out = fopen(path, "wb");
    if (!out)
        retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(errno));
    return out;
}

static int close_output(FILE *out, const char *path, RetexError *err)
{
    const int failed = ferror(out);
    if (fclose(out) != 0 || failed)
        return retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(errno ? errno : EIO));
    return RETEX_OK;
}

static int write_meshes(Import *import, RetexError *err)
{
    char path[PATH_MAX];
    FILE *out = open_output(import, "-meshes.inc", path, err);
    if (!out)
        return RETEX_EIO;
    fprintf(out, "// Meshes of %s.pov.\n", import->options->name);
    const int code = meshes_write(import, out, err), closed = close_output(out, path, code ? NULL : err);
    return code ? code : closed;
}

static void write_head(const Import *import, FILE *out)
{
    const char *slash = strrchr(import->options->model, '/'), *name = import->options->name;
    char plain[NAME_SIZE];
    fprintf(out,
            "// Made of %s by retex-import %s.\n"
            "//   retex-render %s.pov --list-targets\n"
            "//   povray %s.pov         (in this folder)\n\n"
            "#version 3.7;\n\n"
            "global_settings {\n"
            "  assumed_gamma 1\n"
            "  max_trace_level 12\n"
            "  radiosity { count 200 error_bound 0.5 recursion_limit 2 }\n"
            "}\n"
            "#default { finish { ambient 0 } }\n"
            "#ifdef (Retex) global_settings { " LOOK_EXPOSURE LOOK_EXPOSURE_FORMAT
            " } #end // stops, by which pictures are brighter\n\n",
            import_plain(slash ? slash + 1 : import->options->model, plain), RETEX_VERSION, name, name, 0.0);
    if (import->variants.command)
        fprintf(out, "// The variants of %s-variants.csv, in this folder:\n//   %s\n\n", name,
                import->variants.command);
}

static int write_scene(Import *import, RetexError *err)
{
    char path[PATH_MAX], *materials = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&materials, &size);
    const int is_ready = memory && names_make(&import->names, LOOK_ADDED_SKY, "", (char[NAME_SIZE]){0}) &&
                         names_make(&import->names, LOOK_ADDED_LAMP, "", (char[NAME_SIZE]){0});
    int code = is_ready ? materials_write(import, memory, err) : retex_fail(err, RETEX_ENOMEM, "out of memory");
    if (!code)
        code = variants_write(import, memory, err);
    if (!code)
        code = materials_write_names(import, memory, err);
    if (memory && fclose(memory) != 0 && !code)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory");
    if (!code)
        code = doubles_find_objects(import, err);
    if (!code)
        code = doubles_drop(import, err);
    if (!code)
        code = cutaway_find(import, err);
    if (!code)
        code = write_meshes(import, err);
    FILE *out = code ? NULL : open_output(import, ".pov", path, err);
    if (!out) {
        free(materials);
        return code ? code : RETEX_EIO;
    }
    write_head(import, out);
    code = cameras_write(import, out, err);
    if (!code)
        code = targets_write(import, out, err);
    if (!code)
        code = lights_write(import, out, err);
    if (!code) {
        fwrite(materials, 1, size, out);
        fprintf(out, "// ---- objects ----\n\n#include \"%s-meshes.inc\"\n\n", import->options->name);
        if (!import_visit_nodes(import, write_object, out))
            code = retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    free(materials);
    const int closed = close_output(out, path, code ? NULL : err);
    return code ? code : closed;
}

/* Without it, the look is at pictures as they are. */
static void make_look_folder(const ImportOptions *options)
{
    static const char *const folders[] = {LOOK_FOLDER, LOOK_FOLDER "/textures"};
    for (int i = 0; i < 2; i++) {
        char path[PATH_MAX];
        if (snprintf(path, sizeof path, "%s/%s", options->folder, folders[i]) < (int)sizeof path)
            mkdir(path, 0777);
    }
}

static void tell_summary(const Import *import)
{
    int materials = 0, meshes = 0;
    for (unsigned i = 0; i < import->scene->mNumMaterials; i++)
        materials += import->materials[i].is_used;
    for (unsigned i = 0; i < import->scene->mNumMeshes; i++)
        meshes += import->meshes[i][0] != '\0';
    import_tell(import, IMPORT_INFO, "%d material%s, %d mesh%s, %ld object%s, %ld triangle%s", materials,
                materials == 1 ? "" : "s", meshes, meshes == 1 ? "" : "es", import->objects,
                import->objects == 1 ? "" : "s", import->triangles, import->triangles == 1 ? "" : "s");
}

int import_model(const ImportOptions *options, RetexError *err)
{
    ImportOptions own = *options;
    Import import = {.options = &own, .own_options = &own};
    char folder[PATH_MAX];
    int code = files_begin(&import, err);
    if (!code && options->list_variants)
        return assimp_is_gltf(options->model) ? gltf_list_variants(&import, err) : RETEX_OK;
    snprintf(folder, sizeof folder, "%s/textures", options->folder);
    if (!code && mkdir(folder, 0777) != 0)
        code = retex_fail(err, RETEX_EIO, "cannot make the folder %s: %s", folder, strerror(errno));
    if (!code && own.looks)
        make_look_folder(&own);
    if (!code)
        code = assimp_read(&import, err);
    if (!code)
        code = morphs_apply(&import, err);
    if (!code && import.is_gltf)
        code = gltf_read(&import, err);
    if (!code)
        code = sense_find(&import, err);
    if (!code)
        code = places_find(&import, err);
    if (!code && import.is_3ds)
        tds_read(&import);
    if (!code)
        code = find_bounds(&import, err);
    if (!code)
        code = write_scene(&import, err);
    if (!code) {
        note_left_out(&import);
        code = losses_check(&import, err);
    }
    if (!code) {
        tell_summary(&import);
        variants_tell(&import);
    }
    rmdir(folder); /* where no image is in it */
    /* the process ends now, and with it what Assimp has */
    free(import.cutaway);
    sense_free(&import);
    images_free(&import);
    gltf_free(&import.gltf);
    gltf_variants_free(&import.variants);
    names_free(&import.names);
    names_free(&import.files);
    names_free(&import.lost_images);
    free(import.light_places);
    free(import.camera_places);
    free(import.is_dropped);
    free(import.materials);
    free(import.meshes);
    return code;
}
