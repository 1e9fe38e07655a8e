// A scene as OpenImageIO sees it: the picture it renders to, then the other parts of its set.
#ifndef OIIO_PLUGINS_SCENE_SOURCE_HPP
#define OIIO_PLUGINS_SCENE_SOURCE_HPP

#include "set_input.hpp"

namespace plugins
{

// The scene is read here. A picture alone is rendered when its pixels are asked for; which parts a set has, and what
// its manifest says, only a render can tell: then it is now.
std::shared_ptr<Source> open_scene(const std::string &path, const Arguments &arguments, int threads);

} // namespace plugins
#endif
