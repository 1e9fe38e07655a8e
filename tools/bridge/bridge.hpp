// Common to the bridge's files: error handling, and colour transforms without OpenColorIO's headers.
#ifndef RETEX_BRIDGE_HPP
#define RETEX_BRIDGE_HPP

#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

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

// Throw Failure if a JPEG or PNG file is truncated, or a checksum of a PNG is wrong.
void check_whole(const RetexBridgeFile &file);

// Open a file for reading. Throws Failure.
std::unique_ptr<FILE, int (*)(FILE *)> open_file(const RetexBridgeFile &file);

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

// Transform all rows of an RGBA block, on OpenImageIO's threads.
void apply_transform(const Transform &transform, float *rgba, int width, int height);

// The built-in OpenColorIO configuration, used unless $OCIO is set.
extern const char *const own_configuration;

} // namespace bridge
#endif
