/* A model is read by Assimp, which reads files through functions of ours: those in the model's folder and in the
 * folders of -I, and no others. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>

#include "common/picture_kind.h"
#include "import/base/world.h"
#include "import/gltf/gltf.h"
#include "import/read/read.h"

/* ---- what Assimp calls to read files ---- */

static size_t read_file(struct aiFile *file, char *to, size_t size, size_t count)
{
    return fread(to, size, count, (FILE *)file->UserData);
}

static size_t write_file(struct aiFile *file, const char *from, size_t size, size_t count)
{
    (void)file, (void)from, (void)size, (void)count;
    return 0;
}

static size_t tell_file(struct aiFile *file)
{
    const long at = ftell((FILE *)file->UserData);
    return at < 0 ? 0 : (size_t)at;
}

static size_t file_size(struct aiFile *file)
{
    struct stat info;
    return fstat(fileno((FILE *)file->UserData), &info) == 0 ? (size_t)info.st_size : 0;
}

static aiReturn seek_file(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    const int whence = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return fseek((FILE *)file->UserData, (long)offset, whence) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
}

static void flush_file(struct aiFile *file)
{
    (void)file;
}

static int has_ending(const char *path, const char *ending)
{
    const size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *name, const char *mode)
{
    Import *import = (Import *)io->UserData;
    int descriptor = -1;
    RetexError err = {0};
    RetexAccess of_user = RETEX_ACCESS_INIT;
    of_user.safe = import->options->safe;
    const int is_model = strcmp(name, import->options->model) == 0;
    struct stat info;
    if (mode[0] != 'r')
        return NULL;
    if (retex_access_open(is_model ? &of_user : &import->access, name, &descriptor, &err)) {
        if (err.code == RETEX_EACCESS && (!import->denied[0] || picture_kind_of_name(import->denied)))
            snprintf(import->denied, sizeof import->denied, "%s", name);
        return NULL;
    }
    struct aiFile *file = calloc(1, sizeof *file);
    FILE *stream = fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) ? fdopen(descriptor, "rb") : NULL;
    if (!file || !stream) {
        free(file);
        close(descriptor);
        return NULL;
    }
    if (is_model && import->is_gltf)
        stream = gltf_prepare(import, stream);
    else if (has_ending(name, ".mtl"))
        stream = mtl_prepare(stream);
    if (!stream) {
        free(file);
        return NULL;
    }
    *file = (struct aiFile){read_file, write_file, tell_file, file_size, seek_file, flush_file, (aiUserData)stream};
    return file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    fclose((FILE *)file->UserData);
    free(file);
}

static struct aiFileIO *new_io(Import *import)
{
    struct aiFileIO *io = calloc(1, sizeof *io);
    if (io)
        *io = (struct aiFileIO){open_file, close_file, (aiUserData)import};
    return io;
}

/* ---- the model ---- */

int assimp_is_gltf(const char *path)
{
    return has_ending(path, ".gltf") || has_ending(path, ".glb");
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

static const struct aiScene *read_by_assimp(Import *import, unsigned flags)
{
    struct aiPropertyStore *properties = aiCreatePropertyStore();
    struct aiFileIO *io = new_io(import);
    const struct aiScene *scene = NULL;
    if (properties && io) {
        aiSetImportPropertyInteger(properties, AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
        aiSetImportPropertyInteger(properties, AI_CONFIG_PP_RVC_FLAGS, aiComponent_TANGENTS_AND_BITANGENTS);
        aiSetImportPropertyFloat(properties, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, (ai_real)import->options->smooth);
        scene = aiImportFileExWithProperties(import->options->model, flags, io, properties);
    }
    if (properties)
        aiReleasePropertyStore(properties);
    free(io);
    return scene;
}

/* Assimp's check refuses cameras and lights that share a name, though it can read them: see places.c. */
static int names_are_refused(void)
{
    return strstr(aiGetErrorString(), "aiScene::mLights") || strstr(aiGetErrorString(), "aiScene::mCameras");
}

int assimp_read(Import *import, RetexError *err)
{
    const ImportOptions *options = import->options;
    unsigned flags = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenUVCoords | aiProcess_RemoveComponent;
    set_world(import);
    import->is_gltf = assimp_is_gltf(options->model);
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
    if (import->denied[0] && (!import->scene || !picture_kind_of_name(import->denied))) /* images are found later */
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
