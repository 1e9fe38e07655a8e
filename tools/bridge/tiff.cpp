// What libtiff says while it decodes the pixels of a file's first picture. OpenImageIO's reader drops most of it, and
// inflates strips itself without looking at the result.
#include "bridge.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstring>

#include <libdeflate.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

namespace bridge
{
namespace
{

// A file that libtiff reads, and what it said of it.
struct Source {
    int descriptor = -1;
    off_t at = 0, size = 0;
    bool reads_pixels = false;
    std::string damage;
};

tmsize_t read_bytes(thandle_t handle, void *data, tmsize_t bytes)
{
    auto &source = *static_cast<Source *>(handle);
    ssize_t got = pread(source.descriptor, data, size_t(bytes), source.at);
    source.at += std::max<ssize_t>(got, 0);
    return got;
}

tmsize_t write_bytes(thandle_t, void *, tmsize_t)
{
    return -1;
}

toff_t seek(thandle_t handle, toff_t offset, int whence)
{
    auto &source = *static_cast<Source *>(handle);
    source.at = off_t(offset) + (whence == SEEK_CUR ? source.at : whence == SEEK_END ? source.size : 0);
    return toff_t(source.at);
}

int close_nothing(thandle_t)
{
    return 0;
}

toff_t size_of(thandle_t handle)
{
    return toff_t(static_cast<Source *>(handle)->size);
}

// Keeps the first message about pixels. What libtiff says of the tags is no sign of damage, unless the file ends
// before their values: many programs write odd ones. Where they make the file unreadable, OpenImageIO tells. Returns 1,
// so that nobody else is told.
int keep_message(TIFF *, void *context, const char *, const char *format, va_list arguments)
{
    auto &source = *static_cast<Source *>(context);
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    const bool counts = source.reads_pixels || std::strstr(text, "IO error during reading");
    if (counts && source.damage.empty()) {
        source.damage = text;
        source.damage = source.damage.substr(0, source.damage.find('\n'));
    }
    return 1;
}

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF *)>;

Tiff open_tiff(Source &source)
{
    std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions *)> options(TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
    if (!options)
        throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_message, &source);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keep_message, &source);
    return Tiff(TIFFClientOpenExt("picture", "rm", &source, read_bytes, write_bytes, seek, close_nothing, size_of,
                                  nullptr, nullptr, options.get()),
                TIFFClose);
}

// The pixels of the file's first picture, in strips or tiles.
class Blocks
{
  public:
    explicit Blocks(TIFF *tiff)
        : tiff_(tiff), tiled_(TIFFIsTiled(tiff)), inflater_(nullptr, libdeflate_free_decompressor)
    {
        uint16_t planar = PLANARCONFIG_CONTIG, samples = 1;
        TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planar);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
        count = tiled_ ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
        bytes = tiled_ ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
        in_plane_ = std::max<uint32_t>(1, planar == PLANARCONFIG_SEPARATE && samples > 0 ? count / samples : count);
        TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    }
    // Whether the bytes of all blocks, which are not compressed, are in the file.
    bool are_inside(uint64_t file_size) const
    {
        for (uint32_t i = 0; i < count; i++) {
            const uint64_t at = TIFFGetStrileOffset(tiff_, i);
            const uint64_t need =
                may_be_short(i) ? std::min(uint64_t(bytes), TIFFGetStrileByteCount(tiff_, i)) : uint64_t(bytes);
            if (at > file_size || file_size - at < need)
                return false;
        }
        return true;
    }
    // Decode one; false = it is damaged.
    bool decode(uint32_t index)
    {
        if (!pixels_)
            pixels_.reset(new char[size_t(bytes)]);
        if (compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE)
            return inflate(index);
        return (tiled_ ? TIFFReadEncodedTile(tiff_, index, pixels_.get(), bytes)
                       : TIFFReadEncodedStrip(tiff_, index, pixels_.get(), bytes)) >= 0;
    }
    uint32_t count;
    tmsize_t bytes; // of one
    uint16_t compression = COMPRESSION_NONE;

  private:
    // libtiff does not look at the checksum. More data than pixels are no damage.
    bool inflate(uint32_t index)
    {
        const uint64_t stored = TIFFGetStrileByteCount(tiff_, index);
        if (!inflater_)
            inflater_.reset(libdeflate_alloc_decompressor());
        if (!inflater_ || stored > uint64_t(INT32_MAX))
            throw std::bad_alloc();
        coded_.resize(size_t(stored));
        const tmsize_t got = tiled_ ? TIFFReadRawTile(tiff_, index, coded_.data(), tmsize_t(stored))
                                    : TIFFReadRawStrip(tiff_, index, coded_.data(), tmsize_t(stored));
        size_t inflated = 0;
        const auto result = got < 0 ? LIBDEFLATE_BAD_DATA
                                    : libdeflate_zlib_decompress(inflater_.get(), coded_.data(), size_t(got),
                                                                 pixels_.get(), size_t(bytes), &inflated);
        return result == LIBDEFLATE_INSUFFICIENT_SPACE ||
               (result == LIBDEFLATE_SUCCESS && (may_be_short(index) || inflated == size_t(bytes)));
    }
    // The last strip of a plane.
    bool may_be_short(uint32_t index) const
    {
        return !tiled_ && (index + 1) % in_plane_ == 0;
    }

    TIFF *tiff_;
    bool tiled_;
    uint32_t in_plane_; // blocks
    std::unique_ptr<char[]> pixels_;
    std::vector<unsigned char> coded_;
    std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor *)> inflater_;
};

} // namespace

std::string find_tiff_damage(const RetexBridgeFile &file)
{
    auto stream = open_file(file);
    struct stat status;
    Source source;
    source.descriptor = fileno(stream.get());
    if (fstat(source.descriptor, &status) != 0)
        return "";
    source.size = status.st_size;
    Tiff tiff = open_tiff(source);
    if (!tiff)
        return "";
    Blocks blocks(tiff.get());
    if (!source.damage.empty())
        return "the file is truncated: " + source.damage;
    if (blocks.bytes <= 0)
        return "";
    if (blocks.compression == COMPRESSION_NONE)
        return blocks.are_inside(uint64_t(source.size)) ? "" : "the file is truncated";
    source.reads_pixels = true;
    for (uint32_t i = 0; i < blocks.count && source.damage.empty(); i++)
        if (!blocks.decode(i) && source.damage.empty())
            source.damage = "a strip or tile of its pixels cannot be decoded";
    source.reads_pixels = false; // closing says nothing of them
    return source.damage.empty() ? "" : "the file is damaged: " + source.damage;
}

} // namespace bridge
