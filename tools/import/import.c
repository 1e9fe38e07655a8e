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

#include "import/internal.h"
#include "import/variants.h"

#define FARTHEST 1e15 /* from the origin */

/* ---- messages ---- */

void import_tell(const Import *import, char kind, const char *fmt, ...)
{
    char text[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    import->options->tell(import->options->context, kind, text);
}

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

const char *import_plain(const char *text, char plain[NAME_SIZE])
{
    int n = 0;
    for (; *text && n + 1 < NAME_SIZE; text++)
        plain[n++] = (unsigned char)*text < 32 || *text == 127 ? '?' : *text;
    plain[n] = '\0';
    return plain;
}

/* ---- the model ---- */

static int has_ending(const char *path, const char *ending)
{
    const size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

static int is_gltf(const char *path)
{
    return has_ending(path, ".gltf") || has_ending(path, ".glb");
}

void import_set_world(Import *import, char up)
{
    const double s = import->options->scale;
    const Affine y_up = {{{s, 0, 0, 0}, {0, s, 0, 0}, {0, 0, s, 0}}};
    const Affine z_up = {{{s, 0, 0, 0}, {0, 0, s, 0}, {0, -s, 0, 0}}};
    import->world = up == 'z' ? z_up : y_up;
}

/* Which of its axes is up is known of some formats; Assimp turns others so that y is. */
static void set_world(Import *import)
{
    const ImportOptions *options = import->options;
    import_set_world(import, options->up ? options->up : has_ending(options->model, ".stl") ? 'z' : 'y');
    import->axes_are_unknown = has_ending(options->model, ".obj") || has_ending(options->model, ".ply");
    import->has_metres = has_ending(options->model, ".gltf") || has_ending(options->model, ".glb") ||
                         has_ending(options->model, ".fbx") || has_ending(options->model, ".dae");
}

void import_set_scale(Import *import, double scale)
{
    const Affine larger = {{{scale, 0, 0, 0}, {0, scale, 0, 0}, {0, 0, scale, 0}}};
    import->own_options->scale *= scale;
    import->world = affine_multiply(&larger, &import->world);
    for (int i = 0; i < import->gltf.ncameras; i++)
        import->gltf.cameras[i].place = affine_multiply(&larger, &import->gltf.cameras[i].place);
    for (int i = 0; i < import->gltf.nlights; i++)
        import->gltf.lights[i].place = affine_multiply(&larger, &import->gltf.lights[i].place);
}

static const struct aiScene *read_by_assimp(Import *import, unsigned flags)
{
    struct aiPropertyStore *properties = aiCreatePropertyStore();
    struct aiFileIO *io = files_io(import);
    const struct aiScene *scene = NULL;
    if (properties && io) {
        aiSetImportPropertyInteger(properties, AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        aiSetImportPropertyInteger(properties, AI_CONFIG_PP_RVC_FLAGS, aiComponent_TANGENTS_AND_BITANGENTS);
        aiSetImportPropertyFloat(properties, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, (ai_real)import->options->smooth);
        scene = aiImportFileExWithProperties(import->options->model, flags, io, properties);
    }
    if (properties)
        aiReleasePropertyStore(properties);
    files_close_io(io);
    return scene;
}

/* Assimp's check refuses cameras and lights that share a name, though it can read them: see places.c. */
static int names_are_refused(void)
{
    return strstr(aiGetErrorString(), "aiScene::mLights") || strstr(aiGetErrorString(), "aiScene::mCameras");
}

static int read_model(Import *import, RetexError *err)
{
    const ImportOptions *options = import->options;
    unsigned flags = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenUVCoords | aiProcess_RemoveComponent;
    import->is_gltf = is_gltf(options->model);
    if (options->variant && !import->is_gltf)
        return retex_fail(err, RETEX_EINVAL, "%s: only glTF files have variants", options->model);
    import->is_fbx = has_ending(options->model, ".fbx");
    import->is_3ds = has_ending(options->model, ".3ds");
    if (!import->is_gltf)
        flags |= aiProcess_JoinIdenticalVertices;
    if (import->is_fbx)
        flags |= aiProcess_GlobalScale;
    if (options->smooth > 0)
        flags |= aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices;
    import->scene = read_by_assimp(import, flags | aiProcess_ValidateDataStructure);
    if (!import->scene && names_are_refused())
        import->scene = read_by_assimp(import, flags);
    if (import->denied[0])
        return retex_fail(err, RETEX_EACCESS,
                          "%s: the model names the file `%s`, which is outside of its folder; "
                          "-I DIR adds folders that may be read",
                          options->model, import->denied);
    if (import->gltf_refused[0])
        return gltf_explain(import, err);
    if (!import->scene && (strstr(aiGetErrorString(), "bad_alloc") || !*aiGetErrorString()))
        return retex_fail(err, RETEX_ENOMEM, "%s: out of memory: reading it takes more than --max-memory",
                          options->model);
    const int code = !import->scene && import->is_gltf ? gltf_explain(import, err) : RETEX_OK;
    if (code)
        return code;
    if (!import->scene && strstr(aiGetErrorString(), "No meshes remaining")) /* of those that are no points and lines */
        return retex_fail(err, RETEX_EFORMAT, "%s: there are no surfaces in it", options->model);
    if (!import->scene)
        return retex_fail(err, RETEX_EFORMAT, "%s: %.400s", options->model, aiGetErrorString());
    if (!import->scene->mRootNode || !import->scene->mNumMeshes || !import->scene->mNumMaterials)
        return retex_fail(err, RETEX_EFORMAT, "%s: there are no surfaces in it", options->model);
    return RETEX_OK;
}

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

typedef struct Place {
    const struct aiNode *node;
    Affine world;
} Place;

/* Without recursion, for files may nest deeply. */
int import_visit_nodes(Import *import, ImportVisit *visit, void *context)
{
    size_t count = 1, capacity = 256;
    Place *places = malloc(capacity * sizeof *places);
    if (!places)
        return 0;
    places[0] = (Place){import->scene->mRootNode, import->world};
    while (count) {
        const Place place = places[--count];
        const Affine own = affine_from(&place.node->mTransformation), world = affine_multiply(&place.world, &own);
        visit(import, place.node, &world, context);
        if (count + place.node->mNumChildren > capacity) {
            capacity = 2 * (count + place.node->mNumChildren);
            Place *more = realloc(places, capacity * sizeof *places);
            if (!more) {
                free(places);
                return 0;
            }
            places = more;
        }
        for (unsigned i = place.node->mNumChildren; i-- > 0;)
            places[count++] = (Place){place.node->mChildren[i], world};
    }
    free(places);
    return 1;
}

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
    const Affine placed = affine_mirror_z(world);
    char plain[NAME_SIZE];
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const unsigned index = node->mMeshes[i];
        if (import->is_dropped[import->walked++] || !affine_is_finite(&placed))
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
            "#default { finish { ambient 0 } }\n\n",
            import_plain(slash ? slash + 1 : import->options->model, plain), RETEX_VERSION, name, name);
    if (import->variants.command)
        fprintf(out, "// The variants of %s-variants.csv, in this folder:\n//   %s\n\n", name,
                import->variants.command);
}

static int write_scene(Import *import, RetexError *err)
{
    char path[PATH_MAX], *materials = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&materials, &size);
    int code = memory ? materials_write(import, memory, err) : retex_fail(err, RETEX_ENOMEM, "out of memory");
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
        return is_gltf(options->model) ? gltf_list_variants(&import, err) : RETEX_OK;
    snprintf(folder, sizeof folder, "%s/textures", options->folder);
    if (!code && mkdir(folder, 0777) != 0)
        code = retex_fail(err, RETEX_EIO, "cannot make the folder %s: %s", folder, strerror(errno));
    if (!code) {
        set_world(&import);
        code = read_model(&import, err);
    }
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
