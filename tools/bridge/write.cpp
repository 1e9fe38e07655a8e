// Writing: a scene-linear picture leaves in any format OpenImageIO writes, through the display transform where the
// format holds 8 or 16 bits. The file is made in memory and then handed on, because few of the format libraries notice
// a full disk.
#include "bridge.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/parallel.h>
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

// Where the bytes go.
using Sink = std::function<void(const void *data, size_t bytes)>;

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
    void copy_to(const Sink &sink) const;

  private:
    int fd_;
};

void Spool::copy_to(const Sink &sink) const
{
    std::vector<char> buffer(1 << 20);
    for (off_t at = 0;;) {
        ssize_t got = pread(fd_, buffer.data(), buffer.size(), at);
        if (got < 0 && errno != EINTR)
            throw Failure(RETEX_EIO, std::string("cannot read a file in memory: ") + std::strerror(errno));
        if (got == 0)
            return;
        if (got > 0) {
            sink(buffer.data(), size_t(got));
            at += got;
        }
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

// A file of our own with a name, for as long as it takes: a format whose library insists on its ending (JPEG 2000).
class NamedSpool
{
  public:
    explicit NamedSpool(const std::string &end)
    {
        const char *folder = std::getenv("TMPDIR");
        path = std::string(folder && *folder ? folder : "/tmp") + "/retex-XXXXXX." + end;
        int fd = mkstemps(&path[0], int(end.size()) + 1);
        if (fd < 0)
            throw Failure(RETEX_EIO, std::string("cannot make a temporary file: ") + std::strerror(errno));
        ::close(fd);
    }
    ~NamedSpool()
    {
        unlink(path.c_str());
    }
    NamedSpool(const NamedSpool &) = delete;
    NamedSpool &operator=(const NamedSpool &) = delete;
    std::string path;
};

void copy_file(const std::string &path, Spool &spool)
{
    std::unique_ptr<FILE, int (*)(FILE *)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    std::vector<char> buffer(1 << 20);
    for (size_t got; file && (got = std::fread(buffer.data(), 1, buffer.size(), file.get())) > 0;)
        spool.append(buffer.data(), got);
    if (!file || std::ferror(file.get()) || spool.empty())
        throw Failure(RETEX_EIO, "cannot write: OpenImageIO wrote nothing");
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

void write_picture(const RetexImage &src, const char *path, const RetexWriteParams &params, const Sink &sink)
{
    if (src.width < 1 || src.height < 1 || (src.channels != 1 && src.channels != 3 && src.channels != 4))
        throw Failure(RETEX_EINVAL, "only pictures of 1, 3 or 4 channels can be written");
    bool pfm = is_pfm(path);
    auto out = pfm ? nullptr : find_writer(path);
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
        spool.copy_to(sink);
        return;
    }
    OIIO::ImageSpec spec =
        describe(src, channels, depth == Depth::Half ? OIIO::TypeDesc::HALF : stored.type, format, params, depth);
    auto write_to = [&](const std::string &name) {
        if (!out->open(name, spec) || !out->write_image(stored.type, stored.data()) || !out->close())
            throw Failure(RETEX_EIO, "cannot write: " + out->geterror());
    };
    write_to(spool.path());
    if (spool.empty()) {
        NamedSpool named(ending(path));
        out = find_writer(path); // a used one does not always open again
        write_to(named.path);
        copy_file(named.path, spool);
    }
    spool.copy_to(sink);
}

// The transform is looked at only where someone has named a part of it: the built-in default is sound.
void check_picture(const char *path, const RetexWriteParams &params)
{
    Depth depth = is_pfm(path) ? Depth::Float : depth_of(find_writer(path)->format_name());
    bool named = params.display || params.view || params.colorspace;
    if (named || std::getenv("OCIO"))
        encoding(params, depth);
}

} // namespace
} // namespace bridge

extern "C" __attribute__((visibility("default"))) RetexBridgeWrite retex_oiio_write;
extern "C" __attribute__((visibility("default"))) RetexBridgeCheck retex_oiio_check;

static const RetexWriteParams default_params = RETEX_WRITE_INIT;

int retex_oiio_write(const RetexImage *src, const char *path, const RetexWriteParams *params, RetexBridgeSink *sink,
                     void *context, RetexError *err)
{
    RetexError sink_error{};
    int sink_code = 0;
    int code = bridge::guarded(path, err, [&] {
        bridge::write_picture(*src, path, params ? *params : default_params, [&](const void *data, size_t bytes) {
            sink_code = sink(context, data, bytes, &sink_error);
            if (sink_code)
                throw bridge::Failure(sink_code, sink_error.message);
        });
    });
    if (sink_code && err)
        *err = sink_error; // it names the file itself
    return code;
}

int retex_oiio_check(const char *path, const RetexWriteParams *params, RetexError *err)
{
    return bridge::guarded(path, err, [&] { bridge::check_picture(path, params ? *params : default_params); });
}
