/* The scene language: a scene is parsed with small budgets and, where it is accepted, rendered at a few pixels. Its
 * file is fuzz.pov in the current folder, which has whatever scenes include. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "render/render.h"
#include "lib_fuzz.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

static void message(void *context, int level, const char *text)
{
    (void)level;
    *(long *)context += text[0] != 0; /* read, so that its memory is looked at */
}

static void render(Scene *scene)
{
    RenderParams params = RENDER_PARAMS_INIT;
    RenderStats stats = {0};
    RetexSet *set = NULL;
    params.width = 4;
    params.height = 3;
    params.spp = 2;
    params.max_depth = 5;
    params.nthreads = 1;
    params.aovs = RETEX_AOV_ALL & ~RETEX_AOV_BIT(IRRADIANCE);
    if (scene->nidents)
        scene_resolve_targets(scene, &scene->idents[0], 1, NULL);
    const char *const *lamps = NULL;
    int nlamps = 0;
    if (!scene_each_lamp(scene, 1, 1, &lamps, &nlamps, NULL))
        scene_resolve_lamps(scene, lamps, nlamps, NULL);
    if (render_scene(&set, scene, &params, &stats, NULL) == 0)
        for (int i = 0; i < 4 * 3 * 3; i++)
            fuzz_must(isfinite(retex_set_part(set, 0)->image.pixels[i]), "a picture is finite");
    retex_set_close(&set);
}

static int run(const unsigned char *bytes, size_t size)
{
    static long messages;
    SdlOptions options = SDL_OPTIONS_INIT;
    Scene *scene = NULL;
    FILE *file = fopen("fuzz.pov", "wb");
    fuzz_must(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0, "a file can be written");
    options.lenient = 1;
    options.max_steps = 200000;
    options.max_memory = (size_t)256 << 20;
    options.message = message;
    options.message_context = &messages;
    int code = sdl_read(&scene, "fuzz.pov", &options, &scene_builder, NULL);
    fuzz_must(!code == (scene != NULL), "a scene and a failure exclude each other");
    if (scene)
        render(scene);
    scene_close(&scene);
    return !code;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"scene", 1, NULL, run};
    return fuzz_main(&driver, argc, argv);
}
