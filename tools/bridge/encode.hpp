// Formats whose files the bridge makes itself, without OpenImageIO: portable float maps, which it only reads; AVIF, of
// which it knows neither quality nor colours; JPEG XL, which it does not know before 2.5.
#ifndef RETEX_BRIDGE_ENCODE_HPP
#define RETEX_BRIDGE_ENCODE_HPP

#include <cstddef>
#include <functional>
#include <string>

namespace bridge
{

// The destination of the encoded bytes.
using Sink = std::function<void(const void *data, size_t bytes)>;

// Samples of 8 bits of 3 or 4 channels, alpha unassociated; of a portable float map, floats of 1 or 3.
struct EncodedPicture {
    const void *samples;
    int width, height, channels;
    int quality;  // 1..100
    bool is_srgb; // otherwise nothing is said of its colours
};

struct Encoder {
    const char *format;
    bool has_alpha;
    void (*encode)(const EncodedPicture &picture, const Sink &sink); // throws Failure
};

// The one for files of that ending, or null.
const Encoder *find_encoder(const std::string &ending);

void encode_avif(const EncodedPicture &picture, const Sink &sink);
void encode_jxl(const EncodedPicture &picture, const Sink &sink);

} // namespace bridge
#endif
