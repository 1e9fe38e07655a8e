#include "sdl/statements.h"
#include "sdl/lang/parser.h"
#include "sdl/sdl.h"

int sdl_parse_file(Scene **scene, const char *path, const SdlOptions *options, RetexError *err)
{
    return sdl_read(scene, path, options, &scene_builder, err);
}
