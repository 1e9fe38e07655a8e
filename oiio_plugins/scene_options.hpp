// What the name of a scene says about how to render it.
#ifndef OIIO_PLUGINS_SCENE_OPTIONS_HPP
#define OIIO_PLUGINS_SCENE_OPTIONS_HPP

#include <string>
#include <vector>

extern "C" {
#include "job/job.h"
}

#include "set_input.hpp"

namespace plugins
{

struct SceneOptions {
    RenderParams render = RENDER_PARAMS_INIT;
    SdlOptions sdl = SDL_OPTIONS_INIT; // without the lists below
    std::vector<std::string> targets, includes, declares;
    int width = 0, height = 0; // one alone: the other one by the scene's shape
    int denoise = 0, no_denoise_data = 0;
};

// Options of retex-render without their dashes, where `_` is as good as `-`; targets=NAME[=IDENT+IDENT],NAME,
// include=FOLDER,FOLDER and declare.NAME=VALUE. path: of the scene. threads: where the name does not say. Throws
// Failure.
SceneOptions parse_scene_options(const std::string &path, const Arguments &arguments, int threads);

} // namespace plugins
#endif
