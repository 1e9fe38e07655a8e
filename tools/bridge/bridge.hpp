// Common to the bridge's files: error handling, and colour transforms without OpenColorIO's headers.
#ifndef RETEX_BRIDGE_HPP
#define RETEX_BRIDGE_HPP

#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "../libretex/picture/bridge_load.h"

namespace bridge
{

// An error inside the bridge. The public functions turn it into a RetexError.
struct Failure : std::runtime_error {
    Failure(int code_, const std::string &message) : std::runtime_error(message), code(code_)
    {
    }
    int code;
};

// Run body; turn any exception into a RetexError about path.
int guarded(const char *path, RetexError *err, const std::function<void()> &body);

using Bytes = std::vector<unsigned char>;

// Pixels of a picture as its file stores it; it may reach over the picture's edge.
struct Area {
    uint32_t x, y, width, height;
};

// What is damaged in a file, as far as its structure and checksums say, or "". All of them throw Failure.
std::string find_damage(const RetexBridgeHost *host, const RetexBridgeFile &file);
// What the libraries warn of while they decode all pixels, or "".
std::string find_jpeg_damage(const RetexBridgeHost *host, const RetexBridgeFile &file);
// lost: gets the areas of pixels that are not in the file, where damage is accepted.
std::string find_tiff_damage(const RetexBridgeFile &file, std::vector<Area> &lost);
std::string find_targa_damage(const RetexBridgeFile &file);
// The same of the bytes of a whole file.
std::string check_structure(const RetexBridgeHost *host, const std::string &format, long max_pixels, const Bytes &data);
std::string check_targa(const Bytes &data);
// OpenImageIO's name of the format that a file has by its first bytes, or null: it may be any other.
const char *format_by_content(const RetexBridgeFile &file);

using Stream = std::unique_ptr<FILE, int (*)(FILE *)>;

// Open a file for reading at a place of its own. Throws Failure.
Stream open_file(const RetexBridgeFile &file);
// Open an open file for OpenImageIO, which asks for its descriptor. Throws Failure.
Stream open_stream(const RetexBridgeFile &file);

// Transforms R,G,B,A pixels in place, from any thread; empty = identity.
using Transform = std::function<void(float *rgba, long pixels)>;

// From a named colour space to scene-linear Rec.709.
Transform transform_from(const std::string &colorspace);
// From scene-linear Rec.709 to a named colour space.
Transform transform_to(const std::string &colorspace);
// From scene-linear Rec.709 to a display and view; "" = the configuration's default.
Transform transform_to_display(const std::string &display, const std::string &view);
// Whether the display and view, or the colour space, is plain sRGB of the built-in configuration.
bool display_is_srgb(const std::string &display, const std::string &view);
bool colorspace_is_srgb(const std::string &colorspace);
// Set the fields of `stored` about colours (interop ID, chromaticities), as far as they are known.
void describe_colorspace(const std::string &colorspace, RetexBridgeStored &stored);
// From values encoded with a plain power law (PNG's gAMA) to scene-linear.
Transform transform_from_gamma(float gamma);
// From sRGB of that many levels (256 or 65536), each level exact; for floats that are level / (levels - 1).
Transform transform_from_srgb_levels(int levels);
// Throw Failure, with the reason, if $OCIO names a configuration that cannot be used.
void check_configuration();

// Each channel by itself.
template <typename Curve> Transform per_channel(Curve curve)
{
    return [curve](float *rgba, long pixels) {
        for (long i = 0; i < pixels; i++)
            for (int c = 0; c < 3; c++)
                rgba[4 * i + c] = curve(rgba[4 * i + c]);
    };
}

// What a file states of its colours.
struct StatedColors {
    bool are_stated = false;     // otherwise the type of the file decides
    bool are_srgb = false;       // they are sRGB as far as 8 bits show it
    bool are_by_channel = false; // the transform takes each channel by itself
    Transform transform;         // to scene-linear Rec.709
    std::string problem;         // why what is stated is not followed, or ""
};

// Chunks of a PNG by their names.
using Chunks = std::map<std::string, std::vector<uint8_t>>;
// The first bytes of the chunks that say something of colours; none of other files. To be called before a decoder has
// the file, because all copies of a descriptor share the file position.
Chunks read_color_chunks(const RetexBridgeFile &file);

// profile: the file's ICC profile, or null. is_grey: the pixels have three equal channels.
StatedColors stated_colors(const RetexBridgeHost *host, const Chunks &chunks, const void *profile,
                             size_t profile_bytes, bool is_grey);

// Transform all rows of an RGBA block, on OpenImageIO's threads.
void apply_transform(const Transform &transform, float *rgba, int width, int height);

// The built-in OpenColorIO configuration, used unless $OCIO is set.
extern const char *const own_configuration;

} // namespace bridge
#endif
