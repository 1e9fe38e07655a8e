// Writing: converts a scene-linear picture to any format that OpenImageIO writes. Formats of 8 and 16 bits go through
// the display transform. The file is encoded in memory and then written, because few format libraries detect a full
// disk.
#include "bridge.hpp"
#include "encode.hpp"
#include "endings.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <OpenImageIO/imageio.h>
#include <OpenImageIO/thread.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace bridge
{
namespace
{

enum class Depth { Eight, Sixteen, Half, Float };

std::string endings_to_write();
void check_ending(const std::string &path, const OIIO::ImageOutput &out, int channels);

std::string ending(const std::string &path)
{
    size_t slash = path.rfind('/'), dot = path.rfind('.');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash))
        return "";
    return path.substr(dot + 1);
}

// bits: what the caller asks for, 0 for the format's own.
Depth depth_of(const std::string &format, int bits)
{
    static const std::set<std::string> floats = {"hdr", "fits", "zfile", "pfm"};
    static const std::set<std::string> sixteen = {"tiff", "dpx", "png", "jpeg2000", "sgi", "iff", "rla"};
    const bool is_half = format == "openexr";
    if (bits && (is_half || floats.count(format)))
        throw Failure(RETEX_EUNSUPPORTED, "this format keeps floats: it has no depth to choose");
    if (bits == 16 && !sixteen.count(format))
        throw Failure(RETEX_EUNSUPPORTED, "this format has 8 bits; try .png or .tif");
    if (is_half)
        return Depth::Half;
    if (floats.count(format))
        return Depth::Float;
    if (bits ? bits == 16 : format == "tiff" || format == "dpx")
        return Depth::Sixteen;
    return Depth::Eight;
}

template <typename Value> Value quantise(float v)
{
    const float top = float(Value(~Value(0)));
    if (!(v > 0)) // NaN too
        return 0;
    return v >= 1 ? Value(~Value(0)) : Value(v * top + 0.5f);
}

// A file in memory.
class MemoryFile
{
  public:
    MemoryFile() : fd_(memfd_create("retex-picture", MFD_CLOEXEC))
    {
        if (fd_ < 0)
            throw Failure(RETEX_EIO, std::string("cannot make a file in memory: ") + std::strerror(errno));
    }
    ~MemoryFile()
    {
        ::close(fd_);
    }
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;
    std::string path() const
    {
        return "/proc/self/fd/" + std::to_string(fd_);
    }
    long size() const
    {
        struct stat status;
        return fstat(fd_, &status) != 0 ? 0 : long(status.st_size);
    }
    bool empty() const
    {
        return size() == 0;
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

void MemoryFile::copy_to(const Sink &sink) const
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

// A temporary file with a name, for formats whose library requires a file of its ending (JPEG 2000).
class TemporaryFile
{
  public:
    explicit TemporaryFile(const std::string &end)
    {
        const char *folder = std::getenv("TMPDIR");
        path = std::string(folder && *folder ? folder : "/tmp") + "/retex-XXXXXX." + end;
        std::lock_guard<std::mutex> lock(mutex());
        int fd = mkstemps(&path[0], int(end.size()) + 1);
        if (fd < 0)
            throw Failure(RETEX_EIO, std::string("cannot make a temporary file: ") + std::strerror(errno));
        ::close(fd);
        all().push_back(this);
    }
    ~TemporaryFile()
    {
        std::lock_guard<std::mutex> lock(mutex());
        unlink(path.c_str());
        all().erase(std::find(all().begin(), all().end(), this));
    }
    // Remove all temporary files; the process is about to end.
    static void remove_all()
    {
        std::unique_lock<std::mutex> lock(mutex(), std::try_to_lock);
        for (const TemporaryFile *one : all())
            unlink(one->path.c_str());
        lock.release(); // never unlocked, so that no other file is created
    }
    TemporaryFile(const TemporaryFile &) = delete;
    TemporaryFile &operator=(const TemporaryFile &) = delete;
    std::string path;

  private:
    static std::mutex &mutex()
    {
        static std::mutex one;
        return one;
    }
    static std::vector<const TemporaryFile *> &all()
    {
        static std::vector<const TemporaryFile *> list;
        return list;
    }
};

void copy_file(const std::string &path, MemoryFile &memory_file)
{
    std::unique_ptr<FILE, int (*)(FILE *)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    std::vector<char> buffer(1 << 20);
    for (size_t got; file && (got = std::fread(buffer.data(), 1, buffer.size(), file.get())) > 0;)
        memory_file.append(buffer.data(), got);
    if (!file || std::ferror(file.get()) || memory_file.empty())
        throw Failure(RETEX_EIO, "cannot write: OpenImageIO wrote nothing");
}

std::unique_ptr<OIIO::ImageOutput> find_writer(const std::string &path)
{
    std::string end = ending(path);
    if (end.empty())
        throw Failure(RETEX_EINVAL, "cannot tell the picture's format: the name has no ending, such as .png or .exr");
    auto out = has_known_ending(end) ? OIIO::ImageOutput::create(path) : nullptr;
    if (!out) {
        OIIO::geterror(); // clears OpenImageIO's error
        throw Failure(RETEX_EINVAL, "no picture format that can be written has the ending ." + end +
                                        "; these have: " + endings_to_write());
    }
    return out;
}

// Channels of the file: formats without alpha, and those that have no grey.
int stored_channels(const std::string &format, bool has_alpha, int channels)
{
    static const std::set<std::string> colored = {"hdr", "webp", "gif", "heif", "iff", "avif", "jxl"};
    return (channels == 4 && !has_alpha) || (channels == 1 && colored.count(format)) ? 3 : channels;
}

// Formats that get unassociated colours unchanged. Others need or keep colours multiplied by alpha.
bool keeps_unassociated(const std::string &format)
{
    return format == "png" || format == "tiff" || format == "targa" || format == "avif" || format == "jxl";
}

bool is_encoded(Depth depth)
{
    return depth == Depth::Eight || depth == Depth::Sixteen;
}

std::string text(const char *given)
{
    return given ? given : "";
}

// The transform of pixels before they are stored.
Transform encoding(const RetexWriteParams &params, Depth depth)
{
    if (params.colorspace && *params.colorspace)
        return transform_to(params.colorspace);
    check_configuration();
    return is_encoded(depth) ? transform_to_display(text(params.display), text(params.view)) : Transform{};
}

bool encodes_srgb(const RetexWriteParams &params, Depth depth)
{
    if (params.colorspace && *params.colorspace)
        return colorspace_is_srgb(params.colorspace);
    return is_encoded(depth) && display_is_srgb(text(params.display), text(params.view));
}

} // namespace
} // namespace bridge

// The conversion of a picture to its file.
struct RetexBridgePlan {
    std::string path, format;
    int width, height, channels; // of the picture
    int stored;                  // channels of the file
    bridge::Depth depth;
    bridge::Transform encode;
    // Whether colours are multiplied by alpha before they are encoded, or after.
    bool multiply_light, multiply_codes;
    int quality;
    bool names_colorspace;
};

namespace bridge
{
namespace
{

std::unique_ptr<RetexBridgePlan> make_plan(const char *path, int width, int height, int channels,
                                           const RetexWriteParams &params)
{
    if (width < 1 || height < 1 || (channels != 1 && channels != 3 && channels != 4))
        throw Failure(RETEX_EINVAL, "only pictures of 1, 3 or 4 channels can be written");
    auto plan = std::make_unique<RetexBridgePlan>();
    const Encoder *own = find_encoder(ending(path));
    auto out = own ? nullptr : find_writer(path);
    if (out)
        check_ending(path, *out, channels);
    plan->path = path;
    plan->format = own ? own->format : out->format_name();
    plan->width = width;
    plan->height = height;
    plan->channels = channels;
    plan->stored = stored_channels(plan->format, own ? own->has_alpha : out->supports("alpha"), channels);
    plan->depth = depth_of(plan->format, params.depth);
    plan->quality = std::min(100, std::max(1, params.quality));
    plan->names_colorspace = params.colorspace && *params.colorspace;
    // A format without alpha gets the picture over black. WebP's writer divides by alpha in linear light.
    plan->multiply_light = channels == 4 && (plan->stored != 4 || plan->format == "webp");
    plan->multiply_codes = plan->stored == 4 && !keeps_unassociated(plan->format) && plan->format != "webp";
    plan->encode = encoding(params, plan->depth);
    return plan;
}

RetexBridgeStored describe_stored(const RetexBridgePlan &plan, const RetexWriteParams &params)
{
    RetexBridgeStored stored{};
    stored.channels = plan.stored;
    stored.bits = plan.depth == Depth::Eight ? 8 : plan.depth == Depth::Sixteen ? 16 : 32;
    stored.is_srgb = encodes_srgb(params, plan.depth) && plan.stored <= plan.channels && !plan.multiply_codes &&
                     !(plan.multiply_light && plan.stored == 4);
    if (plan.depth == Depth::Half && plan.names_colorspace)
        describe_colorspace(params.colorspace, stored);
    return stored;
}

// Convert pixels to the format's channels, with alpha applied or not.
template <typename Value, typename Convert>
void store(Value *out, const RetexBridgePlan &plan, const std::vector<float> &rgba, Convert convert)
{
    for (size_t i = 0; i < rgba.size(); i += 4) {
        float alpha = plan.multiply_codes ? rgba[i + 3] : 1;
        for (int c = 0; c < plan.stored; c++)
            *out++ = convert(c == 3 ? rgba[i + 3] : rgba[i + c] * alpha);
    }
}

void convert_pixels(const RetexBridgePlan &plan, const float *from, size_t pixels, void *samples)
{
    std::vector<float> rgba(pixels * 4);
    for (size_t i = 0; i < pixels; i++, from += plan.channels) {
        for (int c = 0; c < 4; c++)
            rgba[4 * i + c] = c < plan.channels ? from[c] : c == 3 ? 1.0f : from[0];
        for (int c = 0; plan.multiply_light && c < 3; c++)
            rgba[4 * i + c] *= rgba[4 * i + 3];
    }
    if (plan.encode)
        plan.encode(rgba.data(), long(pixels));
    // Clamp to 65504, the largest half, so that bright highlights do not become infinite.
    float limit = plan.depth == Depth::Half ? 65504.0f : 3e38f;
    if (plan.depth == Depth::Eight)
        store(static_cast<uint8_t *>(samples), plan, rgba, quantise<uint8_t>);
    else if (plan.depth == Depth::Sixteen)
        store(static_cast<uint16_t *>(samples), plan, rgba, quantise<uint16_t>);
    else
        store(static_cast<float *>(samples), plan, rgba, [limit](float v) { return v > limit ? limit : v; });
}

OIIO::TypeDesc sample_type(const RetexBridgePlan &plan)
{
    return plan.depth == Depth::Eight     ? OIIO::TypeDesc::UINT8
           : plan.depth == Depth::Sixteen ? OIIO::TypeDesc::UINT16
                                          : OIIO::TypeDesc::FLOAT;
}

OIIO::ImageSpec describe(const RetexBridgePlan &plan)
{
    OIIO::ImageSpec spec(plan.width, plan.height, plan.stored,
                         plan.depth == Depth::Half ? OIIO::TypeDesc(OIIO::TypeDesc::HALF) : sample_type(plan));
    spec.attribute("Software", "retex");
    if (!plan.names_colorspace)
        spec.attribute("oiio:ColorSpace", is_encoded(plan.depth) ? "sRGB" : "Linear");
    if (keeps_unassociated(plan.format))
        spec.attribute("oiio:UnassociatedAlpha", 1);
    if (plan.format == "jpeg") {
        spec.attribute("Compression", "jpeg:" + std::to_string(plan.quality));
        if (plan.quality >= 90)
            spec.attribute("jpeg:subsampling", "4:4:4");
    } else if (plan.format == "webp") {
        spec.attribute("Compression", "webp:" + std::to_string(plan.quality));
    } else if (plan.format == "tiff" || plan.format == "openexr") {
        spec.attribute("Compression", "zip");
    }
    return spec;
}

void write_picture(const RetexBridgePlan &plan, const void *samples, const Sink &sink)
{
    if (const Encoder *own = find_encoder(plan.format)) {
        own->encode({samples, plan.width, plan.height, plan.stored, plan.quality, !plan.names_colorspace}, sink);
        return;
    }
    MemoryFile memory_file;
    OIIO::ImageSpec spec = describe(plan);
    // TIFF strips are compressed by a pool with one thread less than the cores; a pool of 1 thread does not compress
    // them.
    if (plan.format == "tiff" && std::thread::hardware_concurrency() > 1 && OIIO::default_thread_pool()->size() < 2)
        OIIO::default_thread_pool()->resize(2);
    auto write_to = [&](const std::string &name) {
        auto out = find_writer(plan.path);
        const bool is_written = out->open(name, spec) && out->write_image(sample_type(plan), samples) && out->close();
        const std::string why = out->geterror();
        // some writers tell of a failure only so; that of TIFF fails to add a list of what nobody gave
        if (!is_written || (!why.empty() && why.find("Exif") == std::string::npos))
            throw Failure(RETEX_EIO, "cannot write: " + why.substr(0, why.find('\n')));
    };
    write_to(memory_file.path());
    if (memory_file.empty()) {
        TemporaryFile named(ending(plan.path));
        write_to(named.path);
        copy_file(named.path, memory_file);
    }
    if (plan.format == "iff") // whose last chunk says that it is padded, but OpenImageIO does not pad it
        memory_file.append("\0\0\0", size_t(-memory_file.size() & 3));
    memory_file.copy_to(sink);
}

// What keeps a picture of so many channels from being written with this ending, or "": a small one is written, and its
// first bytes are compared with those of the format. The library at hand may have no encoder, or take another.
std::string find_obstacle(const std::string &path, const OIIO::ImageOutput &out, int channels)
{
    enum { Side = 64, Beyond = 1024 }; // see stored.c
    static std::mutex mutex;
    static std::map<std::pair<std::string, int>, std::string> known;
    std::lock_guard<std::mutex> lock(mutex);
    const auto key = std::make_pair(lower(ending(path)), channels);
    const auto found = known.find(key);
    if (found != known.end())
        return found->second;
    RetexBridgePlan plan{};
    plan.path = "x." + key.first;
    plan.format = out.format_name();
    plan.width = plan.height = Side;
    plan.channels = channels;
    plan.stored = stored_channels(plan.format, out.supports("alpha"), channels);
    plan.depth = depth_of(plan.format, 0);
    plan.quality = 95;
    std::string begin, obstacle;
    try {
        std::vector<char> samples(size_t(Side) * Side * 4 * sizeof(float) + Beyond);
        write_picture(plan, samples.data(), [&](const void *data, size_t bytes) {
            begin.append(static_cast<const char *>(data), std::min(bytes, size_t(64)));
        });
        if (!begins_as(key.first, begin))
            obstacle = "cannot be written here: OpenImageIO writes something else";
    } catch (const Failure &failure) {
        obstacle = std::string("cannot be written here: ") + failure.what();
    }
    return known[key] = obstacle.substr(0, obstacle.find('\n'));
}

void check_ending(const std::string &path, const OIIO::ImageOutput &out, int channels)
{
    const std::string obstacle = find_obstacle(path, out, channels);
    if (!obstacle.empty())
        throw Failure(RETEX_EUNSUPPORTED, "a ." + lower(ending(path)) + " of " + std::to_string(channels) +
                                              " channels " + obstacle + "; these can: " + endings_to_write());
}

std::string endings_to_write()
{
    std::string list = ".png .jpg .pfm";
    for (const std::string &end : known_endings()) {
        const std::string path = "x." + end;
        const bool is_own = find_encoder(end) != nullptr;
        auto out = is_own ? nullptr : OIIO::ImageOutput::create(path);
        if (is_own || (out && find_obstacle(path, *out, 3).empty()))
            list += " ." + end;
    }
    OIIO::geterror();
    return list;
}

// Check the transform only if the user named a part of it; the built-in default is valid.
void check_picture(const char *path, const RetexWriteParams &params)
{
    const Encoder *own = find_encoder(ending(path));
    auto out = own ? nullptr : find_writer(path);
    if (out)
        check_ending(path, *out, 3);
    Depth depth = depth_of(own ? own->format : out->format_name(), params.depth);
    bool named = params.display || params.view || params.colorspace;
    if (named || std::getenv("OCIO"))
        encoding(params, depth);
}

} // namespace
} // namespace bridge

#define RETEX_EXPORTED extern "C" __attribute__((visibility("default")))
RETEX_EXPORTED RetexBridgeMakePlan retex_oiio_plan;
RETEX_EXPORTED RetexBridgeFreePlan retex_oiio_plan_free;
RETEX_EXPORTED RetexBridgeConvert retex_oiio_convert;
RETEX_EXPORTED RetexBridgeWrite retex_oiio_write;
RETEX_EXPORTED RetexBridgeCheck retex_oiio_check;
RETEX_EXPORTED RetexBridgeRemove retex_oiio_remove;

static const RetexWriteParams default_params = RETEX_WRITE_INIT;

int retex_oiio_plan(RetexBridgePlan **plan, RetexBridgeStored *stored, const char *path, int width, int height,
                    int channels, const RetexWriteParams *params, RetexError *err)
{
    return bridge::guarded(path, err, [&] {
        const RetexWriteParams &wishes = params ? *params : default_params;
        auto made = bridge::make_plan(path, width, height, channels, wishes);
        *stored = bridge::describe_stored(*made, wishes);
        *plan = made.release();
    });
}

void retex_oiio_plan_free(RetexBridgePlan **plan)
{
    delete *plan;
    *plan = nullptr;
}

int retex_oiio_convert(const RetexBridgePlan *plan, const float *rows, long pixels, void *samples, RetexError *err)
{
    return bridge::guarded(plan->path.c_str(), err, [&] {
        // A few rows at a time, which stay in the cache.
        const long some = 4096;
        size_t bytes = size_t(plan->stored) * bridge::sample_type(*plan).size();
        for (long done = 0; done < pixels; done += some)
            bridge::convert_pixels(*plan, rows + size_t(done) * plan->channels, size_t(std::min(some, pixels - done)),
                                   static_cast<char *>(samples) + size_t(done) * bytes);
    });
}

int retex_oiio_write(const RetexBridgePlan *plan, const void *samples, RetexBridgeSink *sink, void *context,
                     RetexError *err)
{
    RetexError sink_error{};
    int sink_code = 0;
    int code = bridge::guarded(plan->path.c_str(), err, [&] {
        bridge::write_picture(*plan, samples, [&](const void *data, size_t bytes) {
            sink_code = sink(context, data, bytes, &sink_error);
            if (sink_code)
                throw bridge::Failure(sink_code, sink_error.message);
        });
    });
    if (sink_code && err)
        *err = sink_error; // the sink's error already names the file
    return code;
}

int retex_oiio_check(const char *path, const RetexWriteParams *params, RetexError *err)
{
    return bridge::guarded(path, err, [&] { bridge::check_picture(path, params ? *params : default_params); });
}

void retex_oiio_remove(void)
{
    bridge::TemporaryFile::remove_all();
}
