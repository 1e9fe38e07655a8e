// Opening a picture file: which decoder gets it, the limits on its size, and what is damaged in it.
#include "open.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include <strings.h>
#include <sys/stat.h>

namespace bridge
{
namespace
{

void check_file(const RetexBridgeFile &file)
{
    struct stat status;
    if ((file.format ? fstat(file.descriptor, &status) : stat(file.path, &status)) != 0)
        throw Failure(RETEX_EIO, std::string("cannot read: ") + std::strerror(errno));
    if (S_ISDIR(status.st_mode))
        throw Failure(RETEX_EIO, "cannot read: it is a folder");
    if (S_ISREG(status.st_mode) && status.st_size == 0)
        throw Failure(RETEX_EFORMAT, "cannot read: the file is empty");
}

// The first line of an error. Further lines are details of the library.
std::string first_line(std::string why)
{
    why = why.substr(0, why.find('\n'));
    return why.empty() ? "not a picture OpenImageIO can read" : why;
}

[[noreturn]] void fail_read(const std::string &why)
{
    throw Failure(RETEX_EFORMAT, "cannot read: " + first_line(why));
}

// Of files of strangers: decoders make room for whole tiles, and for all channels, whatever the size of the picture.
void check_storage(const OIIO::ImageSpec &spec)
{
    const int64_t pixels = int64_t(spec.width) * spec.height, tile = int64_t(spec.tile_width) * spec.tile_height,
                  most = std::max(int64_t(4096) * 4096, 4 * pixels);
    if (tile > most)
        throw Failure(RETEX_ELIMIT, "the picture is in tiles of " + std::to_string(spec.tile_width) + " x " +
                                        std::to_string(spec.tile_height) + " pixels, which are not read (--safe)");
    if (spec.nchannels > RETEX_MAX_CHANNELS)
        throw Failure(RETEX_ELIMIT, "the picture has " + std::to_string(spec.nchannels) +
                                        " channels, of which at most " + std::to_string(RETEX_MAX_CHANNELS) +
                                        " are read (--safe)");
}

} // namespace

void check_size(long width, long height, const RetexBridgeFile &file)
{
    if (width < 1 || height < 1)
        throw Failure(RETEX_EFORMAT, "the picture has no pixels");
    std::string size = std::to_string(width) + " x " + std::to_string(height);
    if (width > RETEX_MAX_SIZE || height > RETEX_MAX_SIZE)
        throw Failure(RETEX_ELIMIT, "the picture is too large: " + size + " pixels, at most " +
                                        std::to_string(RETEX_MAX_SIZE) + " a side");
    if (file.max_pixels > 0 && width * height > file.max_pixels)
        throw Failure(RETEX_ELIMIT, "the picture is too large: " + size + " pixels, more than " + file.limit);
}

OpenPicture::OpenPicture(const RetexBridgeHost *host, const RetexBridgeFile &file) : host_(host), file_(file)
{
    check_file(file);
    const std::string damage = find_damage(host, file);
    const char *format = format_by_content(file);
    // OpenImageIO's readers of these print errors, end the process, make room for what is not there, or (DPX and Zfile)
    // give what was in memory before in place of missing pixels
    static const std::set<std::string> refused = {"png", "ico", "iff", "openexr", "dpx", "zfile"};
    if (!damage.empty() && format && refused.count(format))
        throw Failure(RETEX_EFORMAT, "cannot read: " + damage);
    note(damage);
    chunks_ = read_color_chunks(file);
    OIIO::ImageSpec wish;
    wish.attribute("oiio:UnassociatedAlpha", 1); // avoids lossy conversions of 8-bit values
    if (file.format) {
        stream_ = open_stream(file);
        open_as(file.format, wish);
    } else {
        in_ = OIIO::ImageInput::open(file.path, &wish);
        if (!in_)
            fail_read(OIIO::geterror());
        check_decoder(wish);
    }
    in_->threads(file.nthreads);
    const OIIO::ImageSpec &spec = in_->spec();
    check_size(spec.width, spec.height, file);
    if (file.format)
        check_storage(spec);
    if (spec.deep)
        throw Failure(RETEX_EUNSUPPORTED, "a deep picture, which cannot be used here");
    if (spec.depth > 1)
        throw Failure(RETEX_EUNSUPPORTED, "a volume, not a picture");
}

void OpenPicture::open_as(const char *format, const OIIO::ImageSpec &wish)
{
    in_ = OIIO::ImageInput::create(format);
    if (!in_ || (stream_ && !in_->supports("ioproxy")))
        throw Failure(RETEX_EUNSUPPORTED, std::string("OpenImageIO cannot read ") + format + " from open files");
    if (stream_) {
        proxy_ = std::make_unique<OIIO::Filesystem::IOFile>(stream_.get(), OIIO::Filesystem::IOProxy::Read);
        in_->set_ioproxy(proxy_.get());
    }
    OIIO::ImageSpec spec;
    if (!in_->open(file_.path, spec, wish))
        fail_read(in_->geterror());
}

// OpenImageIO offers a file that its decoder refuses to all others, some of which take anything. Cameras' raw files
// look like TIFF.
void OpenPicture::check_decoder(const OIIO::ImageSpec &wish)
{
    const char *format = format_by_content(file_);
    const std::string taken = in_->format_name();
    if (format && taken != format && taken != "raw")
        open_as(format, wish);
}

// Remember that the file is damaged, where that is accepted; "" = it is not.
void OpenPicture::note(const std::string &damage)
{
    if (damage.empty())
        return;
    if (!file_.accept_damaged)
        throw Failure(RETEX_EFORMAT, "cannot read: " + damage + " (--accept-damaged reads it)");
    if (damage_.empty())
        damage_ = damage;
}

void OpenPicture::check_pixels()
{
    const std::string format = in_->format_name();
    if (format == "jpeg")
        note(find_jpeg_damage(host_, file_));
    else if (format == "tiff")
        note(find_tiff_damage(file_, lost_));
    else if (format == "targa")
        note(find_targa_damage(file_));
}

void OpenPicture::check_read(bool is_read)
{
    if (!is_read && !file_.accept_damaged)
        fail_read(in_->geterror());
    if (!is_read || in_->has_error())
        note("the file is damaged: " + first_line(in_->geterror()));
}

} // namespace bridge
