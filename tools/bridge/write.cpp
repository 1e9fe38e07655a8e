// Writing: a scene-linear picture leaves in any format OpenImageIO writes, through the display transform where the
// format holds 8 or 16 bits. The file is made in memory and then written here, because few of the format libraries
// notice a full disk.
#include "bridge.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/parallel.h>
#include <fcntl.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace bridge
{
namespace
{

enum class Depth { Eight, Sixteen, Half, Float };

std::string ending(const std::string &path)
{
    size_t slash = path.rfind('/'), dot = path.rfind('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash))
        return "";
    return path.substr(dot + 1);
}

Depth depth_of(const std::string &format)
{
    if (format == "openexr")
        return Depth::Half;
    if (format == "hdr" || format == "fits" || format == "zfile")
        return Depth::Float;
    if (format == "tiff" || format == "dpx")
        return Depth::Sixteen;
    return Depth::Eight;
}

// The picture as RGBA, alpha unassociated.
std::vector<float> spread(const RetexImage &src)
{
    std::vector<float> rgba(size_t(src.width) * src.height * 4);
    OIIO::parallel_for(0, src.height, [&](int y) {
        const float *from = src.pixels + retex_image_index(&src, 0, y);
        float *to = rgba.data() + size_t(y) * src.width * 4;
        for (int x = 0; x < src.width; x++, from += src.channels, to += 4)
            for (int c = 0; c < 4; c++)
                to[c] = c < src.channels ? from[c] : c == 3 ? 1.0f : from[0];
    });
    return rgba;
}

template <typename Value> Value quantise(float v)
{
    const float top = float(Value(~Value(0)));
    if (!(v > 0)) // NaN too
        return 0;
    return v >= 1 ? Value(~Value(0)) : Value(v * top + 0.5f);
}

// Pixels as the format stores them: the wanted channels, with alpha applied or not.
template <typename Value, typename Convert>
std::vector<Value> store(const std::vector<float> &rgba, int channels, bool multiply, Convert convert)
{
    size_t pixels = rgba.size() / 4;
    std::vector<Value> out(pixels * channels);
    OIIO::parallel_for_chunked(0, int64_t(pixels), 65536, [&](int64_t first, int64_t last) {
        for (int64_t i = first; i < last; i++) {
            float alpha = multiply ? rgba[4 * i + 3] : 1;
            for (int c = 0; c < channels; c++)
                out[i * channels + c] = convert(c == 3 ? rgba[4 * i + 3] : rgba[4 * i + c] * alpha);
        }
    });
    return out;
}

[[noreturn]] void fail_write(int error)
{
    throw Failure(RETEX_EIO, std::string("cannot write: ") + std::strerror(error));
}

// A file without a name, in memory.
class Spool
{
  public:
    Spool() : fd_(memfd_create("retex-picture", MFD_CLOEXEC))
    {
        if (fd_ < 0)
            throw Failure(RETEX_EIO, std::string("cannot make a file in memory: ") + std::strerror(errno));
    }
    ~Spool()
    {
        ::close(fd_);
    }
    Spool(const Spool &) = delete;
    Spool &operator=(const Spool &) = delete;
    std::string path() const
    {
        return "/proc/self/fd/" + std::to_string(fd_);
    }
    bool empty() const
    {
        struct stat status;
        return fstat(fd_, &status) != 0 || status.st_size == 0;
    }
    void append(const void *data, size_t bytes)
    {
        for (const char *p = static_cast<const char *>(data), *end = p + bytes; p < end;) {
            ssize_t n = ::write(fd_, p, size_t(end - p));
            if (n < 0 && errno != EINTR)
                throw Failure(RETEX_EIO, std::string("cannot make a file in memory: ") + std::strerror(errno));
            p += std::max<ssize_t>(n, 0);
        }
    }
    void copy_to(const char *path) const;

  private:
    int fd_;
};

void Spool::copy_to(const char *path) const
{
    struct stat status;
    if (fstat(fd_, &status) != 0)
        fail_write(errno);
    int out = ::open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (out < 0)
        fail_write(errno);
    std::vector<char> buffer(1 << 20);
    int error = 0;
    for (off_t at = 0; at < status.st_size && !error;) {
        ssize_t got = pread(fd_, buffer.data(), buffer.size(), at);
        if (got <= 0)
            error = got < 0 ? errno : EIO;
        for (ssize_t done = 0; done < got && !error;) {
            ssize_t n = ::write(out, buffer.data() + done, size_t(got - done));
            if (n < 0 && errno != EINTR)
                error = errno;
            else if (n > 0)
                done += n;
        }
        at += std::max<ssize_t>(got, 0);
    }
    if (::close(out) != 0 && !error)
        error = errno; // network file systems say so only now
    if (error) {
        if (stat(path, &status) == 0 && S_ISREG(status.st_mode))
            unlink(path);
        fail_write(error);
    }
}

// Portable float map, which OpenImageIO reads but does not write: rows from the bottom.
void write_pfm(Spool &spool, int width, int height, int channels, const std::vector<float> &pixels)
{
    const uint16_t probe = 1;
    bool little = *reinterpret_cast<const uint8_t *>(&probe) == 1;
    std::string header = (channels == 1 ? "Pf\n" : "PF\n") + std::to_string(width) + " " + std::to_string(height) +
                         (little ? "\n-1.0\n" : "\n1.0\n");
    spool.append(header.data(), header.size());
    size_t row = size_t(width) * channels;
    for (int y = height; y-- > 0;)
        spool.append(pixels.data() + y * row, row * sizeof(float));
}

// A format whose library insists on a name with its ending (JPEG 2000): there close() and the file's size have to tell.
void write_directly(const char *path, const std::function<bool()> &write, OIIO::ImageOutput &out)
{
    struct stat status;
    bool written = write();
    int fd = written ? ::open(path, O_RDONLY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        written = fsync(fd) == 0 || errno == EINVAL;
        ::close(fd);
    }
    if (written && stat(path, &status) == 0 && status.st_size > 0)
        return;
    std::string why = out.geterror();
    if (stat(path, &status) == 0 && S_ISREG(status.st_mode))
        unlink(path);
    throw Failure(RETEX_EIO, "cannot write: " + (why.empty() ? "OpenImageIO wrote nothing" : why));
}

// The folder is looked at before the work, so that a slip of the pen costs nothing.
void check_folder(const std::string &path)
{
    size_t slash = path.rfind('/');
    std::string folder = slash == std::string::npos ? "." : slash == 0 ? "/" : path.substr(0, slash);
    struct stat status;
    if (stat(folder.c_str(), &status) != 0)
        throw Failure(RETEX_EIO, "cannot write: folder '" + folder + "': " + std::strerror(errno));
    if (!S_ISDIR(status.st_mode))
        throw Failure(RETEX_EIO, "cannot write: '" + folder + "' is not a folder");
}

std::unique_ptr<OIIO::ImageOutput> find_writer(const std::string &path)
{
    std::string end = ending(path);
    if (end.empty())
        throw Failure(RETEX_EINVAL, "cannot tell the picture's format: the name has no ending, such as .png or .exr");
    auto out = OIIO::ImageOutput::create(path);
    if (!out) {
        OIIO::geterror(); // takes it off OpenImageIO's list
        throw Failure(RETEX_EINVAL,
                      "no picture format has the ending ." + end + "; try .png, .jpg, .tif, .exr or .hdr");
    }
    return out;
}

// Formats that OpenImageIO hands colours to as they are, alpha apart. Others want or keep them multiplied by it.
bool keeps_unassociated(const std::string &format)
{
    return format == "png" || format == "tiff" || format == "targa";
}

// What the pixels are turned into before they are stored.
Transform encoding(const RetexWriteParams &params, Depth depth)
{
    if (params.colorspace && *params.colorspace)
        return transform_to(params.colorspace);
    check_configuration();
    if (depth == Depth::Half || depth == Depth::Float)
        return {};
    return transform_to_display(params.display ? params.display : "", params.view ? params.view : "");
}

OIIO::ImageSpec describe(const RetexImage &src, int channels, OIIO::TypeDesc type, const std::string &format,
                         const RetexWriteParams &params, Depth depth)
{
    OIIO::ImageSpec spec(src.width, src.height, channels, type);
    spec.attribute("Software", "retex");
    bool encoded = depth == Depth::Eight || depth == Depth::Sixteen;
    if (!params.colorspace || !*params.colorspace)
        spec.attribute("oiio:ColorSpace", encoded ? "sRGB" : "Linear");
    if (keeps_unassociated(format))
        spec.attribute("oiio:UnassociatedAlpha", 1);
    if (format == "jpeg") {
        int quality = std::min(100, std::max(1, params.quality));
        spec.attribute("Compression", "jpeg:" + std::to_string(quality));
        if (quality >= 90)
            spec.attribute("jpeg:subsampling", "4:4:4");
    } else if (format == "webp") {
        spec.attribute("Compression", "webp:" + std::to_string(std::min(100, std::max(1, params.quality))));
    } else if (format == "tiff" || format == "openexr") {
        spec.attribute("Compression", "zip");
    }
    return spec;
}

bool is_pfm(const std::string &path)
{
    return strcasecmp(ending(path).c_str(), "pfm") == 0;
}

// What a picture becomes in its file, and how OpenImageIO is told.
struct Stored {
    int channels;
    OIIO::TypeDesc type;
    std::vector<uint8_t> bytes;
    std::vector<uint16_t> words;
    std::vector<float> floats;
    const void *data() const
    {
        return !bytes.empty()   ? static_cast<const void *>(bytes.data())
               : !words.empty() ? static_cast<const void *>(words.data())
                                : floats.data();
    }
};

Stored make_stored(const RetexImage &src, int channels, Depth depth, const std::string &format, const Transform &encode)
{
    std::vector<float> rgba = spread(src);
    // Where alpha is lost the picture is shown over black; WebP's writer divides by it in linear light.
    if (src.channels == 4 && (channels != 4 || format == "webp"))
        for (size_t i = 0; i < rgba.size(); i += 4)
            for (int c = 0; c < 3; c++)
                rgba[i + c] *= rgba[i + 3];
    apply_transform(encode, rgba.data(), src.width, src.height);
    bool multiply = channels == 4 && !keeps_unassociated(format) && format != "webp";
    Stored stored;
    stored.channels = channels;
    if (depth == Depth::Eight) {
        stored.type = OIIO::TypeDesc::UINT8;
        stored.bytes = store<uint8_t>(rgba, channels, multiply, quantise<uint8_t>);
    } else if (depth == Depth::Sixteen) {
        stored.type = OIIO::TypeDesc::UINT16;
        stored.words = store<uint16_t>(rgba, channels, multiply, quantise<uint16_t>);
    } else {
        // Halves end at 65504: a bright highlight stays a number.
        float limit = depth == Depth::Half ? 65504.0f : 3e38f;
        stored.type = OIIO::TypeDesc::FLOAT;
        stored.floats = store<float>(rgba, channels, multiply, [limit](float v) { return v > limit ? limit : v; });
    }
    return stored;
}

void write_picture(const RetexImage &src, const char *path, const RetexWriteParams &params)
{
    if (src.width < 1 || src.height < 1 || (src.channels != 1 && src.channels != 3 && src.channels != 4))
        throw Failure(RETEX_EINVAL, "only pictures of 1, 3 or 4 channels can be written");
    bool pfm = is_pfm(path);
    auto out = pfm ? nullptr : find_writer(path);
    check_folder(path);
    std::string format = pfm ? "pfm" : out->format_name();
    Depth depth = pfm ? Depth::Float : depth_of(format);
    int channels = src.channels;
    if (channels == 4 && (pfm || !out->supports("alpha")))
        channels = 3;
    if (channels == 1 && (format == "hdr" || format == "webp"))
        channels = 3;
    Stored stored = make_stored(src, channels, depth, format, encoding(params, depth));
    Spool spool;
    if (pfm) {
        write_pfm(spool, src.width, src.height, channels, stored.floats);
        spool.copy_to(path);
        return;
    }
    OIIO::ImageSpec spec =
        describe(src, channels, depth == Depth::Half ? OIIO::TypeDesc::HALF : stored.type, format, params, depth);
    auto write_to = [&](const std::string &name) {
        return out->open(name, spec) && out->write_image(stored.type, stored.data()) && out->close();
    };
    if (!write_to(spool.path()))
        throw Failure(RETEX_EIO, "cannot write: " + out->geterror());
    if (spool.empty()) {
        out = find_writer(path); // a used one does not always open again
        write_directly(
            path, [&] { return write_to(path); }, *out);
    } else {
        spool.copy_to(path);
    }
}

} // namespace
} // namespace bridge

extern "C" __attribute__((visibility("default"))) RetexBridgeWrite retex_oiio_write;

int retex_oiio_write(const RetexImage *src, const char *path, const RetexWriteParams *params, RetexError *err)
{
    static const RetexWriteParams defaults = RETEX_WRITE_INIT;
    return bridge::guarded(path, err, [&] { bridge::write_picture(*src, path, params ? *params : defaults); });
}
