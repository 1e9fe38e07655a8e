// pov.imageio: lets programs that read pictures through OpenImageIO open scenes, as in
// `room.pov?spp=64&targets=Floor`. See retex-oiio(7).
#include <cstring>

#include <OpenImageIO/imageio.h>

#include <retex/retex.h>

#include "scene_source.hpp"

namespace
{

// A scene is text, which can begin with anything; the parser decides.
bool is_text(const void *data, size_t bytes)
{
    return bytes > 0 && !std::memchr(data, 0, bytes);
}

const plugins::Format format = {"pov", is_text, plugins::open_scene};

} // namespace

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT extern const int pov_imageio_version;
OIIO_EXPORT extern const char *pov_input_extensions[];
OIIO_EXPORT const char *pov_imageio_library_version();
OIIO_EXPORT OIIO::ImageInput *pov_input_imageio_create();

const int pov_imageio_version = OIIO_PLUGIN_VERSION;
const char *pov_input_extensions[] = {"pov", nullptr};

const char *pov_imageio_library_version()
{
    return "retex " RETEX_VERSION;
}

OIIO::ImageInput *pov_input_imageio_create()
{
    try {
        return plugins::create_input(format);
    } catch (...) {
        return nullptr;
    }
}

OIIO_PLUGIN_EXPORTS_END
