/* Models, through the whole of retex-import: it must end with a scene that retex-render renders, or with one line of
 * error and no folder. The first line of an input is the ending of the model's name. Assimp may crash, for the tool
 * answers for that; reports of sanitizers count where they name the tool's own code. */
#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/scene.h>

#include "lib_fuzz.h"

enum { MOST_ARGUMENTS = 16, TEXT = 1 << 16 };

static char tools[PATH_MAX], folder[PATH_MAX];

/* A card with a camera, lights and a material with maps. Its one image is missing in all but one place. */
static const char model[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2,3]}],\"nodes\":[{\"mesh\":0,"
    "\"name\":\"card\",\"scale\":[2,1,1]},{\"camera\":0,\"translation\":[0.5,0.5,3]},{\"mesh\":0,\"rotation\":[0,0.6,0,"
    "0.8]},{\"translation\":[1,2,3],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],\"cameras\":[{\"type\":"
    "\"perspective\",\"perspective\":{\"yfov\":0.6,\"aspectRatio\":1.3,\"znear\":0.1}}],\"meshes\":[{\"name\":\"card\","
    "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2,\"material\":0}]}],\"materials\":"
    "[{\"name\":\"wood\",\"alphaMode\":\"MASK\",\"emissiveFactor\":[0.1,0.2,0.3],\"emissiveTexture\":{\"index\":0},"
    "\"normalTexture\":{\"index\":0,\"scale\":0.5},\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,"
    "\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.25,0.5],\"rotation\":0.5,\"scale\":[2,3]}}},"
    "\"metallicFactor\":0.5,\"metallicRoughnessTexture\":{\"index\":0}},\"extensions\":{\"KHR_materials_transmission\":"
    "{\"transmissionFactor\":0.5},\"KHR_materials_volume\":{\"attenuationDistance\":2,\"attenuationColor\":[0.5,1,0.2]}"
    ","
    "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4},\"KHR_materials_ior\":{\"ior\":1.4}}}],\"textures\":["
    "{\"source\":0}],\"images\":[{\"uri\":\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAFklE"
    "QVQI12P4z8DAwMDAxAADDAwMAA0JAQPdXd8xAAAAAElFTkSuQmCC\"}],\"extensionsUsed\":[\"KHR_lights_punctual\"],"
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"intensity\":50,\"spot\":{"
    "\"innerConeAngle\":0.2,\"outerConeAngle\":0.6}}]}},\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
    "\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},{\"bufferView\":0,\"componentType\":5126,\"count\":"
    "3,"
    "\"type\":\"VEC2\"},{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}],\"bufferViews\":[{"
    "\"buffer\":0,\"byteOffset\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6}],\"buffers\":[{"
    "\"byteLength\":42,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAABAAIA\"}]}";

static void seed(const char *ending, const void *bytes, size_t size)
{
    const size_t head = strlen(ending) + 1;
    char *input = malloc(head + size);
    if (!input)
        abort();
    sprintf(input, "%s\n", ending);
    memcpy(input + head, bytes, size);
    fuzz_seed(input, head + size);
    free(input);
}

/* Assimp's writers stop at nested metadata: take it from the nodes, or give it back. */
static void exchange_metadata(struct aiNode *node, struct aiMetadata **kept)
{
    struct aiMetadata *own = node->mMetaData;
    node->mMetaData = *kept;
    *kept++ = own;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        exchange_metadata(node->mChildren[i], kept++);
}

/* The same model in all formats that Assimp writes. */
static void begin(void)
{
    static const char *const formats[][2] = {{"obj", "obj"},  {"ply", "ply"},     {"plyb", "ply"}, {"stl", "stl"},
                                             {"stlb", "stl"}, {"collada", "dae"}, {"3ds", "3ds"},  {"fbx", "fbx"},
                                             {"fbxa", "fbx"}, {"glb2", "glb"},    {"x", "x"},      {"glb", "glb"}};
    char *slash;
    const ssize_t length = readlink("/proc/self/exe", tools, sizeof tools - 64);
    tools[length > 0 ? length : 0] = '\0';
    for (int i = 0; i < 3 && (slash = strrchr(tools, '/')); i++)
        *slash = '\0';
    strcat(tools, "/bin");
    seed("gltf", model, sizeof model - 1);
    fuzz_words(model, sizeof model - 1);
    const struct aiScene *scene = aiImportFileFromMemory(model, sizeof model - 1, 0, "gltf");
    struct aiMetadata *metadata[8] = {NULL}; /* of the root and those below it */
    if (scene)
        exchange_metadata(scene->mRootNode, metadata);
    for (size_t i = 0; scene && i < sizeof formats / sizeof *formats; i++) {
        const struct aiExportDataBlob *blob = aiExportSceneToBlob(scene, formats[i][0], 0);
        if (blob)
            seed(formats[i][1], blob->data, blob->size);
        if (blob && blob->size < TEXT && !memchr(blob->data, 0, blob->size))
            fuzz_words(blob->data, blob->size);
        aiReleaseExportBlob(blob);
    }
    if (scene)
        exchange_metadata(scene->mRootNode, metadata);
    aiReleaseImport(scene);
}

/* Runs a tool in the folder, its messages going into a file. Returns the status as of waitpid. */
static int run_tool(const char *name, const char *const *arguments, const char *messages)
{
    char path[PATH_MAX + 64];
    const char *argv[MOST_ARGUMENTS] = {name};
    int status = -1;
    snprintf(path, sizeof path, "%s/%s", tools, name);
    for (int i = 0; arguments[i] && i + 2 < MOST_ARGUMENTS; i++)
        argv[i + 1] = arguments[i];
    const pid_t pid = fork();
    if (pid == 0) {
        if (chdir(folder) != 0)
            _exit(127);
        const int to = open(messages, O_CREAT | O_TRUNC | O_WRONLY, 0600);
        dup2(to, STDOUT_FILENO), dup2(to, STDERR_FILENO);
        setenv("ASAN_OPTIONS", "log_path=report:detect_leaks=0:allocator_may_return_null=1", 1);
        setenv("UBSAN_OPTIONS", "log_path=report:print_stacktrace=1", 1);
        execv(path, (char **)argv);
        _exit(127);
    }
    if (pid > 0)
        waitpid(pid, &status, 0);
    return status;
}

static char *text_of(const char *name)
{
    static char text[TEXT];
    char path[PATH_MAX + 300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *in = fopen(path, "rb");
    text[in ? fread(text, 1, sizeof text - 1, in) : 0] = '\0';
    if (in)
        fclose(in);
    return text;
}

/* What a tool said is part of the report. */
static void must(int holds, const char *what, const char *messages)
{
    if (!holds)
        fprintf(stderr, "%s\n", text_of(messages));
    fuzz_must(holds, what);
}

static int count_lines(const char *text, const char *begin)
{
    int count = 0;
    for (const char *line = text; *line; line = strchr(line, '\n') + 1) {
        count += strncmp(line, begin, strlen(begin)) == 0;
        if (!strchr(line, '\n'))
            break;
    }
    return count;
}

/* Whether a report is on the tool's own code, which Assimp may have called, and not on Assimp: on what it does to read
 * the file, or on memory of its own into which the tool reads for it. */
static int is_ours(const char *report)
{
    static const char reading[] = "tools/import/read/assimp.c";
    const char *own = strstr(report, "tools/"), *assimp = strstr(report, "aiImportFile");
    return own && (!assimp || own < assimp) && strncmp(own, reading, strlen(reading)) != 0;
}

/* Everything that is left of a run: nothing but the model, messages and a whole scene. */
static void check_folder(int has_scene)
{
    int scenes = 0;
    DIR *all = opendir(folder);
    for (const struct dirent *entry; all && (entry = readdir(all));) {
        if (strncmp(entry->d_name, "report", 6) == 0)
            must(!is_ours(text_of(entry->d_name)), "no sanitizer has a report on the import", entry->d_name);
        scenes += strcmp(entry->d_name, "out") == 0;
        fuzz_must(strncmp(entry->d_name, "out.", 4) != 0, "no unfinished folder is left");
    }
    if (all)
        closedir(all);
    fuzz_must(scenes == has_scene, "there is a folder after a success, and none after an error");
}

static int run(const unsigned char *bytes, size_t size)
{
    char name[32] = "model.", path[PATH_MAX + 64];
    const unsigned char *line = memchr(bytes, '\n', size < 8 ? size : 8);
    const size_t head = line ? (size_t)(line - bytes) : 0;
    for (size_t i = 0; i < head; i++)
        snprintf(name + 6 + i, 2, "%c", bytes[i] > 32 && bytes[i] < 127 && bytes[i] != '/' ? bytes[i] : 'x');
    strcpy(folder, "/tmp/fuzz-import.XXXXXX");
    if (!mkdtemp(folder))
        return 0;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *out = fopen(path, "wb");
    if (out) {
        fwrite(bytes + (line ? head + 1 : 0), 1, size - (line ? head + 1 : 0), out);
        fclose(out);
    }
    const char *const import[] = {name, "-q", "--partial", "-o", "out", "--max-memory", "1G", "--max-time", "8", NULL};
    const char *const render[] = {"-q",      "--plain",     "--spp",        "1",  "--size", "4x3", "-o",
                                  "out.exr", "out/out.pov", "--max-memory", "1G", NULL};
    const int status = run_tool("retex-import", import, "said");
    must(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 2), "the tool ends with 0 or 2",
         "said");
    const int done = WEXITSTATUS(status) == 0;
    must(count_lines(text_of("said"), "retex-import: error: ") == !done, "an error is one line", "said");
    must(count_lines(text_of("said"), "") == count_lines(text_of("said"), "retex-import: error: ") +
                                                 count_lines(text_of("said"), "retex-import: warning: "),
         "nothing but errors and warnings is said", "said");
    check_folder(done);
    if (done)
        must(run_tool("retex-render", render, "said") == 0, "the scene renders", "said");
    snprintf(path, sizeof path, "rm -rf %s", folder);
    fuzz_must(system(path) == 0, "the folder is removed");
    return done;
}

int main(int argc, char **argv)
{
    return fuzz_main(&(FuzzDriver){"import", 1, begin, run}, argc, argv);
}
