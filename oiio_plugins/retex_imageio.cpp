// retex.imageio: lets programs that read pictures through OpenImageIO open packs, as in `room.retex?Floor=oak.jpg`. See
// retex-oiio(7).
#include <OpenImageIO/imageio.h>

#include <retex/retex.h>

#include "pack_source.hpp"

namespace
{

bool is_pack(const void *data, size_t bytes)
{
    return retex_pack_probe(data, bytes);
}

const plugins::Format format = {"retex", is_pack, plugins::open_pack};

} // namespace

OIIO_PLUGIN_EXPORTS_BEGIN

OIIO_EXPORT extern const int retex_imageio_version;
OIIO_EXPORT extern const char *retex_input_extensions[];
OIIO_EXPORT const char *retex_imageio_library_version();
OIIO_EXPORT OIIO::ImageInput *retex_input_imageio_create();

const int retex_imageio_version = OIIO_PLUGIN_VERSION;
const char *retex_input_extensions[] = {"retex", nullptr};

const char *retex_imageio_library_version()
{
    return "retex " RETEX_VERSION;
}

OIIO::ImageInput *retex_input_imageio_create()
{
    try {
        return plugins::create_input(format);
    } catch (...) {
        return nullptr;
    }
}

OIIO_PLUGIN_EXPORTS_END
