// A pack as a source of subimages: its picture and then the other parts of its set; or, for a name with textures, only
// the picture with these textures.
#ifndef OIIO_PLUGINS_PACK_SOURCE_HPP
#define OIIO_PLUGINS_PACK_SOURCE_HPP

#include "set_input.hpp"

namespace plugins
{

// arguments: TARGET=IMAGE or TARGET=rgb(r,g,b), and TARGET.OPTION=VALUE with the options of --texture.
std::shared_ptr<Source> open_pack(const std::string &path, const Arguments &arguments, int threads);

} // namespace plugins
#endif
