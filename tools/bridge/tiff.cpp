// What libtiff says while it decodes the pixels of a file's first picture, and which pixels it cannot decode.
// OpenImageIO's reader drops most of the messages, inflates strips itself without looking at the result, and gives what
// memory held before in place of pixels that a strip or tile lacks.
#include "bridge.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstring>

#include <libdeflate.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>
#include <zlib.h>

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
        TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width_);
        TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height_);
        block_width_ = width_;
        TIFFGetFieldDefaulted(tiff, tiled_ ? TIFFTAG_TILELENGTH : TIFFTAG_ROWSPERSTRIP, &block_height_);
        if (tiled_)
            TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &block_width_);
        uint16_t photometric = PHOTOMETRIC_RGB, across = 1;
        TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
        if (photometric == PHOTOMETRIC_YCBCR)
            TIFFGetFieldDefaulted(tiff, TIFFTAG_YCBCRSUBSAMPLING, &across, &rows_together_);
        block_width_ = std::max<uint32_t>(1, block_width_);
        block_height_ = std::max<uint32_t>(1, tiled_ ? block_height_ : std::min(block_height_, height_));
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
        return is_deflated() ? inflate(index) : decode_by_libtiff(index);
    }
    // The pixels of a damaged block that are not in the file: all but the rows at the top that are decoded.
    Area find_lost(uint32_t index)
    {
        const uint32_t place = index % in_plane_, across = (width_ - 1) / block_width_ + 1;
        Area lost{place % across * block_width_, place / across * block_height_, block_width_, block_height_};
        const tmsize_t row = std::max<tmsize_t>(1, tiled_ ? TIFFTileRowSize(tiff_) : TIFFScanlineSize(tiff_));
        auto kept = uint32_t(std::min<tmsize_t>(count_decoded(index) / row, block_height_));
        kept -= kept % std::max<uint16_t>(1, rows_together_);
        lost.y += kept;
        lost.height -= kept;
        return lost;
    }
    uint32_t count;
    tmsize_t bytes; // of one
    uint16_t compression = COMPRESSION_NONE;

  private:
    bool is_deflated() const
    {
        return compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE;
    }
    // As they are in the file, to coded_; returns their number, or less than 0.
    tmsize_t read_coded(uint32_t index)
    {
        const uint64_t stored = TIFFGetStrileByteCount(tiff_, index);
        if (stored > uint64_t(INT32_MAX))
            throw std::bad_alloc();
        coded_.resize(size_t(stored));
        return tiled_ ? TIFFReadRawTile(tiff_, index, coded_.data(), tmsize_t(stored))
                      : TIFFReadRawStrip(tiff_, index, coded_.data(), tmsize_t(stored));
    }
    bool decode_by_libtiff(uint32_t index)
    {
        return (tiled_ ? TIFFReadEncodedTile(tiff_, index, pixels_.get(), bytes)
                       : TIFFReadEncodedStrip(tiff_, index, pixels_.get(), bytes)) >= 0;
    }
    // Bytes at the beginning of a block that OpenImageIO's reader gives, whatever memory held before. It lets libtiff
    // decode, or inflates by zlib.
    tmsize_t count_decoded(uint32_t index)
    {
        std::fill_n(pixels_.get(), bytes, char(0));
        decode_by_libtiff(index);
        const std::vector<char> decoded(pixels_.get(), pixels_.get() + bytes);
        std::fill_n(pixels_.get(), bytes, char(-1));
        decode_by_libtiff(index);
        const auto count =
            tmsize_t(std::mismatch(decoded.begin(), decoded.end(), pixels_.get()).first - decoded.begin());
        if (!is_deflated())
            return count;
        const tmsize_t got = read_coded(index);
        uLongf inflated = uLongf(bytes);
        if (got > 0)
            uncompress(reinterpret_cast<unsigned char *>(pixels_.get()), &inflated, coded_.data(), uLong(got));
        return got > 0 ? std::min(count, tmsize_t(inflated)) : 0;
    }
    // libtiff does not look at the checksum. More data than pixels are no damage, unless libtiff leaves pixels out,
    // which are in a run that goes on beyond the block.
    bool inflate(uint32_t index)
    {
        if (!inflater_)
            inflater_.reset(libdeflate_alloc_decompressor());
        if (!inflater_)
            throw std::bad_alloc();
        const tmsize_t got = read_coded(index);
        size_t inflated = 0;
        const auto result = got < 0 ? LIBDEFLATE_BAD_DATA
                                    : libdeflate_zlib_decompress(inflater_.get(), coded_.data(), size_t(got),
                                                                 pixels_.get(), size_t(bytes), &inflated);
        if (result == LIBDEFLATE_INSUFFICIENT_SPACE)
            return count_decoded(index) == bytes;
        return result == LIBDEFLATE_SUCCESS && (may_be_short(index) || inflated == size_t(bytes));
    }
    // The last strip of a plane.
    bool may_be_short(uint32_t index) const
    {
        return !tiled_ && (index + 1) % in_plane_ == 0;
    }

    TIFF *tiff_;
    bool tiled_;
    uint32_t in_plane_; // blocks
    uint32_t width_ = 1, height_ = 1, block_width_ = 1, block_height_ = 1;
    uint16_t rows_together_ = 1; // that have their chroma in common
    std::unique_ptr<char[]> pixels_;
    std::vector<unsigned char> coded_;
    std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor *)> inflater_;
};

} // namespace

std::string find_tiff_damage(const RetexBridgeFile &file, std::vector<Area> &lost)
{
    Stream stream(file.format ? nullptr : open_file(file).release(),
                  [](FILE *own) { return own ? std::fclose(own) : 0; });
    struct stat status;
    Source source;
    source.descriptor = stream ? fileno(stream.get()) : file.descriptor;
    if (fstat(source.descriptor, &status) != 0)
        return "";
    source.size = status.st_size;
    Tiff tiff = open_tiff(source);
    if (!tiff)
        return "";
    Blocks blocks(tiff.get());
    std::string damage;
    if (!source.damage.empty())
        damage = "the file is truncated: " + source.damage;
    if (blocks.bytes <= 0)
        return damage;
    if (blocks.compression == COMPRESSION_NONE)
        return !damage.empty() || blocks.are_inside(uint64_t(source.size)) ? damage : "the file is truncated";
    source.reads_pixels = true;
    for (uint32_t i = 0; i < blocks.count && (damage.empty() || file.accept_damaged); i++) {
        source.damage.clear();
        const bool is_whole = blocks.decode(i) && source.damage.empty();
        if (!is_whole && damage.empty())
            damage = "the file is damaged: " +
                     (source.damage.empty() ? "a strip or tile of its pixels cannot be decoded" : source.damage);
        if (!is_whole && file.accept_damaged)
            lost.push_back(blocks.find_lost(i));
    }
    source.reads_pixels = false; // closing says nothing of them
    return damage;
}

} // namespace bridge
