// A scene as a source of subimages: the rendered picture, then the other parts of its set.
#ifndef OIIO_PLUGINS_SCENE_SOURCE_HPP
#define OIIO_PLUGINS_SCENE_SOURCE_HPP

#include "set_input.hpp"

namespace plugins
{

// Read the scene. A picture alone is rendered when its pixels are read. A set is rendered here, because its parts and
// its manifest are known only after the render.
std::shared_ptr<Source> open_scene(const std::string &path, const Arguments &arguments, int threads);

} // namespace plugins
#endif
