// Render options in the name of a scene.
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
    SdlOptions sdl = SDL_OPTIONS_INIT; // its lists point to those below
    std::vector<std::string> targets, lamps, finishes, shown, includes, declares;
    int each_lamp = 0;
    int width = 0, height = 0; // 0 = from the other one and the scene's aspect ratio
    int denoise = 0, no_denoise_data = 0;

    // Whether a render makes a set, unless it is plain.
    bool keeps_light() const
    {
        return !targets.empty() || !lamps.empty() || each_lamp;
    }
};

// Parse options of retex-render without their dashes, where `_` may replace `-`, and targets=NAME[=IDENT+IDENT],NAME,
// lamps=each or the same of lamps, finishes=TARGET=NAME+NAME,TARGET=…, show=TARGET=NAME,…, include=FOLDER,
// FOLDER and declare.NAME=VALUE. path: the scene's path. threads: the default number of threads. Throws Failure.
SceneOptions parse_scene_options(const std::string &path, const Arguments &arguments, int threads);

} // namespace plugins
#endif
