// Reading: converts any picture that OpenImageIO reads to R,G,B,A floats, scene-linear Rec.709, unassociated alpha.
#include "open.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/parallel.h>
#include <strings.h>
#include <sys/stat.h>

namespace bridge
{

int guarded(const char *path, RetexError *err, const std::function<void()> &body)
{
    int code = RETEX_EINTERNAL;
    char message[sizeof err->message] = "an unknown failure in OpenImageIO or OpenColorIO";
    try {
        body();
        return RETEX_OK;
    } catch (const Failure &failure) {
        code = failure.code;
        std::snprintf(message, sizeof message, "%s", failure.what());
    } catch (const std::bad_alloc &) {
        code = RETEX_ENOMEM;
        std::snprintf(message, sizeof message, "not enough memory");
    } catch (const std::length_error &) { // from a decoder that asks for an impossibly large array
        code = RETEX_ENOMEM;
        std::snprintf(message, sizeof message, "not enough memory");
    } catch (const std::exception &e) {
        code = RETEX_EFORMAT;
        std::snprintf(message, sizeof message, "%s", e.what());
    } catch (...) {
    }
    if (err) {
        *err = RetexError{};
        err->code = code;
        std::snprintf(err->file, sizeof err->file, "%s", path ? path : "");
        std::snprintf(err->message, sizeof err->message, "%s", message);
        for (size_t n = std::strlen(err->message); n > 0 && err->message[n - 1] == '\n';)
            err->message[--n] = '\0';
    }
    return code;
}

void apply_transform(const Transform &transform, float *rgba, int width, int height)
{
    if (!transform)
        return;
    OIIO::parallel_for_chunked(0, height, 16, [&](int64_t first, int64_t last) {
        transform(rgba + size_t(first) * width * 4, long(last - first) * width);
    });
}

namespace
{

// Frees the caller's image unless it is released.
class OwnedImage
{
  public:
    OwnedImage(const RetexBridgeHost *host, int width, int height) : host_(host)
    {
        RetexError why{};
        int code = host->image_alloc(&image, width, height, 4, &why);
        if (code)
            throw Failure(code, why.message);
    }
    ~OwnedImage()
    {
        host_->image_free(&image);
    }
    OwnedImage(const OwnedImage &) = delete;
    OwnedImage &operator=(const OwnedImage &) = delete;
    RetexImage release()
    {
        RetexImage out = image;
        image = RetexImage{};
        return out;
    }
    void swap(OwnedImage &other)
    {
        std::swap(image, other.image);
    }
    RetexImage image{};

  private:
    const RetexBridgeHost *host_;
};

// The file's channels for R, G, B and A; -1 = none. Three equal ones: grey.
struct Channels {
    int rgba[4] = {-1, -1, -1, -1};
    bool cmyk = false;
};

// 0..3 if the channel's name without its layer is red, green, blue or alpha; otherwise -1.
int channel_role(const std::string &name)
{
    size_t dot = name.rfind('.');
    const char *last = name.c_str() + (dot == std::string::npos ? 0 : dot + 1);
    static const char *const words[4][2] = {{"R", "red"}, {"G", "green"}, {"B", "blue"}, {"A", "alpha"}};
    for (int role = 0; role < 4; role++)
        if (strcasecmp(last, words[role][0]) == 0 || strcasecmp(last, words[role][1]) == 0)
            return role;
    return -1;
}

Channels find_channels(const OIIO::ImageSpec &spec)
{
    Channels found;
    int n = spec.nchannels;
    // Names without a layer come first: in a file of many layers they are the picture itself.
    for (bool plain : {true, false})
        for (int i = 0; i < n && i < int(spec.channelnames.size()); i++) {
            const std::string &name = spec.channelnames[i];
            if (plain && name.find('.') != std::string::npos)
                continue;
            int role = channel_role(name);
            if (role >= 0 && found.rgba[role] < 0)
                found.rgba[role] = i;
        }
    if (n == 4 && spec.channelnames[0] == "C" && spec.channelnames[3] == "K") {
        found = Channels{{0, 1, 2, 3}, true};
        return found;
    }
    if (found.rgba[3] < 0)
        found.rgba[3] = spec.alpha_channel;
    if (found.rgba[0] < 0 && found.rgba[1] < 0 && found.rgba[2] < 0) {
        int alpha = found.rgba[3];
        int colors = n - (alpha >= 0 ? 1 : 0);
        for (int c = 0, i = 0; c < 3 && colors > 0; c++, i++) {
            if (i == alpha)
                i++;
            found.rgba[c] = colors >= 3 ? i : alpha == 0 ? 1 : 0;
        }
    } else if (n == 1) {
        int only = 0;
        found.rgba[0] = found.rgba[1] = found.rgba[2] = only;
        found.rgba[3] = -1;
    }
    return found;
}

// Read the file's channels into image in the order R,G,B,A. Values are as stored, integers scaled to 0..1.
void read_channels(OpenPicture &in, const OIIO::ImageSpec &spec, const Channels &channels, RetexImage &image)
{
    int first = spec.nchannels, last = 0;
    for (int c : channels.rgba)
        if (c >= 0) {
            first = std::min(first, c);
            last = std::max(last, c + 1);
        }
    if (last <= first)
        throw Failure(RETEX_EFORMAT, "the picture has no colour channels");
    int count = last - first;
    size_t pixels = size_t(image.width) * image.height;
    std::vector<float> wide; // zeros, as the image; only if the file's channels do not fit into R,G,B,A in place
    float *data = image.pixels;
    int stride = 4;
    if (count > 4) {
        stride = count;
        wide.resize(pixels * count);
        data = wide.data();
    }
    in.check_read(
        in->read_image(0, 0, first, last, OIIO::TypeDesc::FLOAT, data, OIIO::stride_t(stride * sizeof(float))));
    in.blank_lost(data, 0, spec.height, stride);
    OIIO::parallel_for(0, image.height, [&](int y) {
        for (size_t i = size_t(y) * image.width, end = i + image.width; i < end; i++) {
            float value[4];
            for (int c = 0; c < 4; c++)
                value[c] = channels.rgba[c] < 0 ? (c == 3 ? 1.0f : 0.0f) : data[i * stride + channels.rgba[c] - first];
            if (channels.cmyk) {
                for (int c = 0; c < 3; c++)
                    value[c] = (1 - value[c]) * (1 - value[3]);
                value[3] = 1;
            }
            std::copy(value, value + 4, image.pixels + 4 * i);
        }
    });
}

void unassociate(RetexImage &image)
{
    OIIO::parallel_for(0, image.height, [&](int y) {
        float *p = image.pixels + size_t(y) * image.width * 4;
        for (int x = 0; x < image.width; x++, p += 4)
            if (p[3] > 0 && p[3] != 1)
                for (int c = 0; c < 3; c++)
                    p[c] /= p[3];
    });
}

// How the values of a file become scene-linear Rec.709.
struct Decoding {
    Transform transform;
    bool is_by_channel = true;
    std::string problem; // why what the file states is not followed, or ""
};

bool is_grey(const Channels &channels)
{
    return channels.rgba[0] == channels.rgba[1] && channels.rgba[1] == channels.rgba[2];
}

// By the user's colour space, else by what the file states, else by the file's type.
Decoding choose_decoding(const RetexBridgeHost *host, const RetexBridgeFile &file, const OIIO::ImageSpec &spec,
                         const Chunks &chunks, const Channels &channels)
{
    const char *colorspace = file.colorspace;
    bool named = colorspace && *colorspace, integer = !spec.format.is_floating_point();
    if (named && strcasecmp(colorspace, "sRGB") != 0)
        return {transform_from(colorspace), false, ""};
    Decoding decoding;
    if (!named) {
        check_configuration();
        const OIIO::ParamValue *icc = spec.find_attribute("ICCProfile");
        StatedColors stated =
            stated_colors(host, chunks, icc ? icc->data() : nullptr, icc ? icc->type().size() : 0, is_grey(channels));
        if (stated.are_stated && !stated.are_srgb)
            return {stated.transform, stated.are_by_channel, ""};
        if (!stated.problem.empty())
            decoding.problem = std::string(file.path) + ": " + stated.problem + "; its colours are taken as " +
                               (integer ? "sRGB" : "scene-linear");
        if (!integer && !stated.are_stated)
            return decoding;
    }
    decoding.transform = spec.format.basetype == OIIO::TypeDesc::UINT8    ? transform_from_srgb_levels(256)
                         : spec.format.basetype == OIIO::TypeDesc::UINT16 ? transform_from_srgb_levels(65536)
                                                                          : transform_from("sRGB");
    return decoding;
}

void warn(const RetexBridgeFile &file, const Decoding &decoding, const std::string &damage)
{
    if (file.warn && !decoding.problem.empty())
        file.warn(file.warn_context, decoding.problem.c_str());
    if (file.warn && !damage.empty())
        file.warn(file.warn_context,
                  (std::string(file.path) + ": " + damage + "; it is read as far as possible").c_str());
}

// Maps a pixel of the upright picture to the file's pixel, for EXIF orientations 1..8.
struct Upright {
    Upright(int width_, int height_, int orientation_) : width(width_), height(height_), orientation(orientation_)
    {
        if (orientation < 2 || orientation > 8)
            orientation = 1;
    }
    bool turned() const // rows and columns are swapped
    {
        return orientation >= 5;
    }
    size_t source(int x, int y) const
    {
        int sx = turned() ? y : x, sy = turned() ? x : y;
        if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8)
            sx = width - 1 - sx;
        if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7)
            sy = height - 1 - sy;
        return size_t(sy) * width + sx;
    }
    int width, height, orientation; // of the file
};

void orient(const RetexBridgeHost *host, OwnedImage &picture, int orientation)
{
    const RetexImage &from = picture.image;
    Upright upright(from.width, from.height, orientation);
    if (upright.orientation == 1)
        return;
    OwnedImage to(host, upright.turned() ? from.height : from.width, upright.turned() ? from.width : from.height);
    for (int y = 0; y < to.image.height; y++)
        for (int x = 0; x < to.image.width; x++)
            std::copy_n(from.pixels + 4 * upright.source(x, y), 4,
                        to.image.pixels + retex_image_index(&to.image, x, y));
    picture.swap(to);
}

// Crop and pad (transparent) an EXR's data window to its display window.
void fit_window(const RetexBridgeHost *host, OwnedImage &picture, const OIIO::ImageSpec &spec)
{
    OwnedImage shown(host, spec.full_width, spec.full_height);
    const RetexImage &from = picture.image;
    RetexImage &to = shown.image;
    int dx = spec.x - spec.full_x, dy = spec.y - spec.full_y;
    int x0 = std::max(0, dx), x1 = std::min(to.width, dx + from.width);
    for (int y = std::max(0, dy); y < std::min(to.height, dy + from.height) && x0 < x1; y++)
        std::copy_n(from.pixels + retex_image_index(&from, x0 - dx, y - dy), size_t(x1 - x0) * 4,
                    to.pixels + retex_image_index(&to, x0, y));
    picture.swap(shown);
}

RetexImage read_picture(const RetexBridgeHost *host, const RetexBridgeFile &file)
{
    OpenPicture in(host, file);
    OIIO::ImageSpec spec = in->spec();
    std::string format = in->format_name();
    bool windowed = format == "openexr" && spec.full_width > 0 && spec.full_height > 0 &&
                    (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
                     spec.height != spec.full_height);
    if (windowed)
        check_size(spec.full_width, spec.full_height, file);

    Channels channels = find_channels(spec);
    Decoding decoding = choose_decoding(host, file, spec, in.chunks(), channels);
    OwnedImage picture(host, spec.width, spec.height);
    in.check_pixels();
    read_channels(in, spec, channels, picture.image);
    if (channels.rgba[3] >= 0 && !channels.cmyk && !spec.get_int_attribute("oiio:UnassociatedAlpha", 0))
        unassociate(picture.image);
    apply_transform(decoding.transform, picture.image.pixels, picture.image.width, picture.image.height);
    warn(file, decoding, in.damage());
    if (windowed)
        fit_window(host, picture, spec);
    orient(host, picture, spec.get_int_attribute("Orientation", 1));
    return picture.release();
}

// Frees the caller's memory unless it is released.
using OwnedPixels = std::unique_ptr<uint16_t, void (*)(void *)>;

OwnedPixels new_pixels(const RetexBridgeHost *host, int width, int height)
{
    OwnedPixels pixels(static_cast<uint16_t *>(host->alloc(sizeof(uint16_t) * 4 * width * height)), host->free);
    if (!pixels)
        throw std::bad_alloc();
    return pixels;
}

// Converts integers of a file to linear 16-bit integers; the table is indexed by the file's value.
std::vector<uint16_t> linear_levels(const Transform &decode, int levels)
{
    std::vector<float> ramp(size_t(levels) * 4);
    for (int i = 0; i < levels; i++)
        std::fill_n(ramp.begin() + 4 * i, 4, float(i) / float(levels - 1));
    if (decode)
        decode(ramp.data(), levels);
    std::vector<uint16_t> table(levels);
    for (int i = 0; i < levels; i++)
        table[i] = uint16_t(std::min(std::max(ramp[4 * i], 0.0f), 1.0f) * 65535.0f + 0.5f);
    return table;
}

// Convert one row of a file's integers to premultiplied R,G,B,A, from the selected channels.
template <typename Level>
void convert_row(const Level *from, int count, const Channels &channels, int first, const uint16_t *table, int width,
                 uint16_t *to)
{
    int r = channels.rgba[0] - first, g = channels.rgba[1] - first, b = channels.rgba[2] - first;
    if (channels.rgba[3] < 0) {
        for (int x = 0; x < width; x++, from += count, to += 4) {
            to[0] = table[from[r]];
            to[1] = table[from[g]];
            to[2] = table[from[b]];
            to[3] = 65535;
        }
        return;
    }
    int a = channels.rgba[3] - first;
    for (int x = 0; x < width; x++, from += count, to += 4) {
        uint32_t alpha = from[a] * uint32_t(65535 / Level(-1));
        to[0] = uint16_t((table[from[r]] * alpha + 32767) / 65535);
        to[1] = uint16_t((table[from[g]] * alpha + 32767) / 65535);
        to[2] = uint16_t((table[from[b]] * alpha + 32767) / 65535);
        to[3] = uint16_t(alpha);
    }
}

// Convert a few rows at a time, while they are in the processor's cache, if the file allows it.
template <typename Level>
void read_levels(OpenPicture &in, const OIIO::ImageSpec &spec, const Channels &channels, const Transform &decode,
                 uint16_t *pixels)
{
    int first = *std::min_element(channels.rgba, channels.rgba + 3), last = 1;
    if (channels.rgba[3] >= 0)
        first = std::min(first, channels.rgba[3]);
    for (int c : channels.rgba)
        last = std::max(last, c + 1);
    int count = last - first, strip = spec.tile_width ? spec.height : std::min(spec.height, 64);
    std::vector<uint16_t> table = linear_levels(decode, int(Level(-1)) + 1);
    std::vector<Level> rows(size_t(strip) * spec.width * count);
    OIIO::TypeDesc type = OIIO::BaseTypeFromC<Level>::value;
    for (int y = 0; y < spec.height; y += strip) {
        int end = std::min(y + strip, spec.height);
        if (y > 0)
            std::fill(rows.begin(), rows.end(), Level(0)); // where a damaged file gives no more
        bool read = spec.tile_width
                        ? in->read_image(0, 0, first, last, type, rows.data())
                        : in->read_scanlines(0, 0, spec.y + y, spec.y + end, 0, first, last, type, rows.data());
        in.check_read(read);
        in.blank_lost(rows.data(), y, end, count);
        OIIO::parallel_for_chunked(0, end - y, 16, [&](int64_t begin, int64_t stop) {
            for (int64_t i = begin; i < stop; i++)
                convert_row(rows.data() + size_t(i) * spec.width * count, count, channels, first, table.data(),
                            spec.width, pixels + 4 * size_t(y + i) * spec.width);
        });
    }
}

RetexNarrowImage read_narrow(const RetexBridgeHost *host, const RetexBridgeFile &file)
{
    OpenPicture in(host, file);
    OIIO::ImageSpec spec = in->spec();
    Channels channels = find_channels(spec);
    bool wide = spec.format == OIIO::TypeDesc::UINT16, colors = true;
    for (int c = 0; c < 3; c++)
        colors = colors && channels.rgba[c] >= 0;
    bool associated = channels.rgba[3] >= 0 && !spec.get_int_attribute("oiio:UnassociatedAlpha", 0);
    if (associated || channels.cmyk || !colors || spec.nchannels > 4 ||
        (!wide && spec.format != OIIO::TypeDesc::UINT8))
        return RetexNarrowImage{};
    Decoding decoding = choose_decoding(host, file, spec, in.chunks(), channels);
    if (!decoding.is_by_channel)
        return RetexNarrowImage{};
    OwnedPixels pixels = new_pixels(host, spec.width, spec.height);
    in.check_pixels();
    if (wide)
        read_levels<uint16_t>(in, spec, channels, decoding.transform, pixels.get());
    else
        read_levels<uint8_t>(in, spec, channels, decoding.transform, pixels.get());

    warn(file, decoding, in.damage());
    Upright upright(spec.width, spec.height, spec.get_int_attribute("Orientation", 1));
    RetexNarrowImage image{spec.width, spec.height, nullptr};
    if (upright.orientation != 1) {
        if (upright.turned())
            std::swap(image.width, image.height);
        OwnedPixels turned = new_pixels(host, image.width, image.height);
        OIIO::parallel_for(0, image.height, [&](int y) {
            for (int x = 0; x < image.width; x++)
                std::copy_n(pixels.get() + 4 * upright.source(x, y), 4,
                            turned.get() + 4 * (size_t(y) * image.width + x));
        });
        pixels.swap(turned);
    }
    image.pixels = pixels.release();
    return image;
}

} // namespace
} // namespace bridge

extern "C" __attribute__((visibility("default"))) RetexBridgeAbi retex_oiio_abi;
extern "C" __attribute__((visibility("default"))) RetexBridgeRead retex_oiio_read;
extern "C" __attribute__((visibility("default"))) RetexBridgeReadNarrow retex_oiio_read_narrow;
extern "C" __attribute__((visibility("default"))) RetexBridgePrepare retex_oiio_prepare;

int retex_oiio_abi(void)
{
    return RETEX_BRIDGE_ABI;
}

int retex_oiio_read(const RetexBridgeHost *host, RetexImage *dst, const RetexBridgeFile *file, RetexError *err)
{
    return bridge::guarded(file->path, err, [&] { *dst = bridge::read_picture(host, *file); });
}

int retex_oiio_read_narrow(const RetexBridgeHost *host, RetexNarrowImage *dst, const RetexBridgeFile *file,
                           RetexError *err)
{
    return bridge::guarded(file->path, err, [&] { *dst = bridge::read_narrow(host, *file); });
}

// OpenImageIO looks for plugins when it is first asked for a decoder. A configuration, and the tables of its spaces,
// are files; OpenColorIO keeps what it has read of them.
int retex_oiio_prepare(const RetexBridgeFile *file, RetexError *err)
{
    return bridge::guarded(file->path, err, [&] {
        OIIO::ImageInput::create(file->format);
        if (!std::getenv("OCIO"))
            return;
        bridge::check_configuration();
        for (const char *name : {file->colorspace, "sRGB"})
            if (name && *name)
                try {
                    bridge::transform_from(name);
                } catch (const bridge::Failure &) { // reading tells, if it needs the space
                }
    });
}
