// Shared by the bridge's files: how failures travel, and colour transforms without OpenColorIO's headers.
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

// Thrown inside, turned into a RetexError at the border.
struct Failure : std::runtime_error {
    Failure(int code_, const std::string &message) : std::runtime_error(message), code(code_)
    {
    }
    int code;
};

// Run body; whatever it throws ends here as a RetexError about path.
int guarded(const char *path, RetexError *err, const std::function<void()> &body);

// Fail where a JPEG or PNG file is cut off, or a checksum of a PNG is wrong.
void check_whole(const RetexBridgeFile &file);

// The file to read, from its beginning. Throws Failure.
std::unique_ptr<FILE, int (*)(FILE *)> open_file(const RetexBridgeFile &file);

// Works on pixels R,G,B,A in place, from any thread; empty = leave as they are.
using Transform = std::function<void(float *rgba, long pixels)>;

// From the colour space of that name to scene-linear Rec.709.
Transform transform_from(const std::string &colorspace);
// From scene-linear Rec.709 to the colour space of that name.
Transform transform_to(const std::string &colorspace);
// From scene-linear Rec.709 to what a display shows; "" = the configuration's default.
Transform transform_to_display(const std::string &display, const std::string &view);
// Whether that is plain sRGB of our own configuration; and the same of a colour space.
bool display_is_srgb(const std::string &display, const std::string &view);
bool colorspace_is_srgb(const std::string &colorspace);
// What can be told of a colour space's colours, into the fields of stored that are about them.
void describe_colorspace(const std::string &colorspace, RetexBridgeStored &stored);
// From values encoded with a plain power law (PNG's gAMA) to scene-linear.
Transform transform_from_gamma(float gamma);
// From sRGB of that many levels (256 or 65536), each level exact; for floats that are level / (levels - 1).
Transform transform_from_srgb_levels(int levels);
// Complain, with the reason, if $OCIO names a configuration that cannot be used.
void check_configuration();

// Apply to all rows of an RGBA block, on OpenImageIO's threads.
void apply_transform(const Transform &transform, float *rgba, int width, int height);

// The product's own OpenColorIO configuration, used unless $OCIO is set.
extern const char *const own_configuration;

} // namespace bridge
#endif
