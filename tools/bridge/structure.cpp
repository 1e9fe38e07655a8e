// Files whose own decoder in OpenImageIO notices too little: what their headers promise is looked up in the file.
// Trailing bytes are no damage: many programs add some.
#include "bridge.hpp"

#include <algorithm>

#include <libdeflate.h>

namespace bridge
{
namespace
{

const char *const truncated = "the file is truncated";
const char *const damaged = "the file is damaged: its parts do not fit together";

uint32_t number(const Bytes &data, size_t at, int bytes, bool big)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes && at + size_t(i) < data.size(); i++)
        value |= uint32_t(data[at + size_t(i)]) << 8 * (big ? bytes - 1 - i : i);
    return value;
}

// Icons: a table of pictures, which are PNG files or bitmaps.
std::string check_ico(const RetexBridgeHost *host, long max_pixels, const Bytes &data)
{
    enum { HEADER = 6, ENTRY = 16, BITMAP_HEADER = 40 };
    const size_t count = number(data, 4, 2, false);
    if (data.size() < HEADER + ENTRY * count || count == 0)
        return truncated;
    for (size_t i = 0; i < count; i++) {
        const size_t at = number(data, HEADER + ENTRY * i + 12, 4, false);
        if (at > data.size() || data.size() - at < BITMAP_HEADER)
            return truncated; // sizes in the table are often wrong
        if (number(data, at, 4, true) == 0x89504e47) {
            RetexDamage damage = "";
            host->png_is_damaged(data.data() + at, data.size() - at, max_pixels, damage);
            if (damage[0])
                return damage;
            continue;
        }
        const uint32_t bits = number(data, at + 14, 2, false), width = number(data, at + 4, 4, false);
        if (number(data, at, 4, false) != BITMAP_HEADER || width == 0 || width > 65536 ||
            (bits != 1 && bits != 4 && bits != 8 && bits != 16 && bits != 24 && bits != 32))
            return damaged;
        if (bits != 32 && width % 8 != 0) // OpenImageIO 2.4 would write beyond its memory
            throw Failure(RETEX_EUNSUPPORTED, "an icon with a mask, whose width is no multiple of 8: it is not read");
    }
    return "";
}

// Film scans: the pixels of the first element must be in the file. Rows may be padded, which is not asked for here.
std::string check_dpx(const Bytes &data)
{
    enum {
        OFFSET = 4,
        WIDTH = 772,
        HEIGHT = 776,
        DESCRIPTOR = 800,
        BITS = 803,
        PACKING = 804,
        CODING = 806,
        DATA = 808
    };
    const bool big = number(data, 0, 4, true) == 0x53445058;
    if (data.size() < 2048)
        return truncated;
    const uint32_t kind = number(data, DESCRIPTOR, 1, big), bits = number(data, BITS, 1, big);
    const uint64_t width = number(data, WIDTH, 4, big), height = number(data, HEIGHT, 4, big);
    const uint64_t samples = width * (kind == 50 || kind == 101 || kind == 102  ? 3
                                      : kind == 51 || kind == 52 || kind == 103 ? 4
                                      : kind == 100                             ? 2
                                                                                : 1);
    const bool is_filled = number(data, PACKING, 2, big) != 0;
    uint32_t at = number(data, DATA, 4, big);
    if (at == 0xffffffff || at == 0)
        at = number(data, OFFSET, 4, big);
    const uint64_t row = is_filled && bits == 10   ? (samples + 2) / 3 * 4
                         : is_filled && bits == 12 ? samples * 2
                                                   : samples * bits / 8;
    if (number(data, CODING, 2, big) != 0 || width > 65536 || height > 65536)
        return ""; // runs
    return at + row * height <= data.size() ? "" : truncated;
}

// Whether runs fill so many bytes for each channel, and end with the data.
bool has_runs(const unsigned char *at, const unsigned char *end, size_t pixels, int channels)
{
    for (int c = 0; c < channels; c++)
        for (size_t filled = 0; filled < pixels;) {
            if (at == end)
                return false;
            const size_t count = size_t(*at & 0x7f) + 1, bytes = *at & 0x80 ? 1 : count;
            if (count > pixels - filled || size_t(end - at) < bytes + 1)
                return false;
            at += bytes + 1;
            filled += count;
        }
    return true;
}

// Maya's IFF of 8 bits: all tiles must be there, and be filled by their runs.
std::string check_iff(const Bytes &data)
{
    enum { FORM = 0x464f5234, HEAD = 0x54424844, PIXELS = 0x54424d50, TILE = 0x52474241, CIMG = 0x43494d47 };
    uint32_t flags = 0, depth = 0, width = 0, height = 0;
    uint64_t covered = 0;
    for (size_t at = 12; at + 8 <= data.size();) {
        const uint32_t type = number(data, at, 4, true), size = number(data, at + 4, 4, true);
        if (data.size() - at - 8 < size)
            return truncated;
        const size_t content = at + 8;
        at = content + (uint64_t(size) + 3) / 4 * 4;
        if (type == HEAD) {
            width = number(data, content, 4, true), height = number(data, content + 4, 4, true);
            flags = number(data, content + 12, 4, true), depth = number(data, content + 16, 2, true);
            // where the picture lies: OpenImageIO writes beside its memory if that is not 0,0
            if (size >= 32 && (number(data, content + 24, 4, true) | number(data, content + 28, 4, true)))
                return "the picture does not lie at 0,0, which is not supported";
        } else if (type == FORM && number(data, content, 4, true) == PIXELS) {
            at = content + 4; // the tiles
        } else if (type == TILE) {
            const uint32_t x0 = number(data, content, 2, true), y0 = number(data, content + 2, 2, true),
                           x1 = number(data, content + 4, 2, true), y1 = number(data, content + 6, 2, true);
            if (size < 8 || x1 < x0 || y1 < y0 || x1 >= width || y1 >= height)
                return damaged;
            const size_t pixels = size_t(x1 - x0 + 1) * (y1 - y0 + 1);
            const int channels = (flags & 1 ? 3 : 0) + (flags & 2 ? 1 : 0), bytes = channels * (depth ? 2 : 1);
            const unsigned char *begin = data.data() + content + 8;
            covered += pixels;
            if (size - 8 < pixels * size_t(bytes) && !has_runs(begin, begin + size - 8, pixels, bytes))
                return damaged;
        }
    }
    return number(data, 8, 4, true) != CIMG || covered >= uint64_t(width) * height ? "" : truncated;
}

// RIFF: the chunks must fill the file that they say they are.
std::string check_webp(const Bytes &data)
{
    const uint64_t size = uint64_t(number(data, 4, 4, false)) + 8;
    if (data.size() < size)
        return truncated;
    uint64_t at = 12;
    while (at + 8 <= size)
        at += 8 + (uint64_t(number(data, size_t(at) + 4, 4, false)) + 1) / 2 * 2;
    return at == size || at == size + 1 ? "" : damaged;
}

// Shadow maps: floats after a header, in a gzip file or not. OpenImageIO does not look at its checksum.
std::string check_zfile(const Bytes &data)
{
    enum { HEADER = 136, WIDTH = 4, HEIGHT = 6 };
    if (number(data, 0, 2, true) != 0x1f8b) {
        const bool big = number(data, 0, 4, true) == 0x2f0867ab;
        const size_t pixels = size_t(number(data, WIDTH, 2, big)) * number(data, HEIGHT, 2, big);
        return data.size() < HEADER + 4 * pixels ? truncated : "";
    }
    const uint64_t size = data.size() < 18 ? 0 : number(data, data.size() - 4, 4, false);
    if (size == 0 || size / 1032 > data.size()) // deflate makes nothing smaller than that
        return truncated;
    std::unique_ptr<char[]> content(new char[size_t(size)]);
    std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor *)> inflater(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (!inflater)
        throw std::bad_alloc();
    return libdeflate_gzip_decompress(inflater.get(), data.data(), data.size(), content.get(), size_t(size), nullptr) ==
                   LIBDEFLATE_SUCCESS
               ? ""
               : "the file is damaged or truncated";
}

} // namespace

std::string check_structure(const RetexBridgeHost *host, const std::string &format, long max_pixels, const Bytes &data)
{
    if (format == "ico")
        return check_ico(host, max_pixels, data);
    if (format == "dpx")
        return check_dpx(data);
    if (format == "iff")
        return check_iff(data);
    if (format == "zfile")
        return check_zfile(data);
    return format == "webp" ? check_webp(data) : "";
}

std::string check_targa(const Bytes &data)
{
    enum { HEADER = 18, FOOTER = 26, EXTENSION_BYTES = 495 };
    static const std::string mark("TRUEVISION-XFILE.\0", 18);
    if (data.size() < HEADER + FOOTER || !std::equal(mark.begin(), mark.end(), data.end() - long(mark.size())))
        return "";
    const size_t footer = data.size() - FOOTER;
    const uint32_t extension = number(data, footer, 4, false);
    return extension == 0 || (extension < footer && number(data, extension, 2, false) == EXTENSION_BYTES) ? ""
                                                                                                          : damaged;
}

} // namespace bridge
