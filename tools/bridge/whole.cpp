// What is damaged in a file, before OpenImageIO's decoder of its format has it. Most of these tell of less than their
// libraries know, or print it to standard error.
#include "bridge.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <set>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace bridge
{
namespace
{

// Reads bytes in order; -1 after the end.
class Reader
{
  public:
    explicit Reader(const RetexBridgeFile &file) : file_(open_file(file))
    {
    }
    int byte()
    {
        return getc_unlocked(file_.get());
    }
    // A big-endian number; -1 if the file ends before it.
    int64_t number(int bytes)
    {
        int64_t value = 0;
        for (int i = 0; i < bytes; i++) {
            int next = byte();
            if (next < 0)
                return -1;
            value = value << 8 | next;
        }
        return value;
    }
    // A little-endian number; -1 if the file ends before it.
    int64_t little(int bytes)
    {
        int64_t value = 0;
        for (int i = 0; i < bytes; i++) {
            int next = byte();
            if (next < 0)
                return -1;
            value |= int64_t(next) << 8 * i;
        }
        return value;
    }
    // The length of a text that ends with 0, and what it begins with; -1 if the file ends before it.
    int64_t text(std::string *begin = nullptr)
    {
        int64_t length = 0;
        for (int next; (next = byte()) != 0; length++) {
            if (next < 0)
                return -1;
            if (begin && length < 64)
                *begin += char(next);
        }
        return length;
    }
    bool skip(int64_t bytes)
    {
        while (bytes-- > 0)
            if (byte() < 0)
                return false;
        return true;
    }
    void rewind()
    {
        std::rewind(file_.get());
    }
    // All bytes of the file.
    Bytes all()
    {
        const off_t size = fseeko(file_.get(), 0, SEEK_END) == 0 ? ftello(file_.get()) : -1;
        if (size < 0)
            throw Failure(RETEX_EIO, std::string("cannot read: ") + std::strerror(errno));
        Bytes bytes{};
        bytes.resize(size_t(size));
        rewind();
        bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file_.get()));
        return bytes;
    }

  private:
    Stream file_;
};

// Whether a JPEG has all segments from after the start-of-image marker to the end-of-image marker. Data without markers
// are left to libjpeg, which reports them.
bool has_all_segments(Reader &in)
{
    enum { Stuffed = 0x00, Temporary = 0x01, Restart = 0xd0, RestartEnd = 0xd8, End = 0xd9, Scan = 0xda };
    for (bool scan = false;;) {
        int c = in.byte();
        if (c < 0)
            return false;
        if (c != 0xff && !scan)
            return true;
        if (c != 0xff)
            continue;
        while (c == 0xff)
            c = in.byte();
        if (c == End)
            return true;
        if (c == Stuffed || c == Temporary || (c >= Restart && c < RestartEnd))
            continue;
        int64_t length = in.number(2);
        if (length < 0 || !in.skip(length - 2))
            return false;
        scan = c == Scan;
    }
}

// Whether a list of channels, which OpenEXR reads up to an empty name, is as long as its attribute tells.
bool skip_channels(Reader &in, int64_t length)
{
    enum { Channel = 16 }; // what follows a name
    for (int64_t name; (name = in.text()) != 0; length -= name + 1 + Channel)
        if (name < 0 || !in.skip(Channel))
            return false;
    return length == 1;
}

// Whether all of an attribute is there, after its name. OpenEXR reads most types by their own size, not by the length
// that is told: if these differ, what follows is not what it is taken for.
bool skip_attribute(Reader &in)
{
    static const std::map<std::string, int64_t> sizes = {{"box2f", 16},
                                                         {"box2i", 16},
                                                         {"chromaticities", 32},
                                                         {"compression", 1},
                                                         {"deepImageState", 1},
                                                         {"double", 8},
                                                         {"envmap", 1},
                                                         {"float", 4},
                                                         {"int", 4},
                                                         {"keycode", 28},
                                                         {"lineOrder", 1},
                                                         {"m33d", 72},
                                                         {"m33f", 36},
                                                         {"m44d", 128},
                                                         {"m44f", 64},
                                                         {"rational", 8},
                                                         {"tiledesc", 9},
                                                         {"timecode", 8},
                                                         {"v2d", 16},
                                                         {"v2f", 8},
                                                         {"v2i", 8},
                                                         {"v3d", 24},
                                                         {"v3f", 12},
                                                         {"v3i", 12}};
    std::string type;
    if (in.text(&type) < 0)
        return false;
    const int64_t length = in.little(4);
    if (length < 0 || length > INT32_MAX)
        return false;
    if (type == "chlist")
        return skip_channels(in, length);
    const auto size = sizes.find(type);
    return (size == sizes.end() || size->second == length) && in.skip(length);
}

// Whether an OpenEXR file has all attributes of its headers: OpenEXR makes room for them before it reads them. A header
// is names, each with an attribute, to an empty name; of several parts the last header is empty.
bool has_all_attributes(Reader &in)
{
    enum { Magic = 4, SeveralParts = 0x1000 };
    in.skip(Magic);
    const int64_t version = in.little(4);
    for (int attributes = 0; version >= 0;) {
        const int64_t name = in.text();
        if (name == 0 && (attributes == 0 || !(version & SeveralParts)))
            return true;
        attributes = name > 0 ? attributes + 1 : 0;
        if (name < 0 || (name > 0 && !skip_attribute(in)))
            return false;
    }
    return false;
}

// A place in an open file: all copies of a descriptor share one, which OpenImageIO has.
struct Place {
    int descriptor;
    off_t at;
};

ssize_t read_place(void *cookie, char *to, size_t bytes)
{
    auto *place = static_cast<Place *>(cookie);
    const ssize_t got = pread(place->descriptor, to, bytes, place->at);
    place->at += got > 0 ? got : 0;
    return got;
}

int move_place(void *cookie, off64_t *at, int from)
{
    auto *place = static_cast<Place *>(cookie);
    struct stat status;
    if (from == SEEK_END && fstat(place->descriptor, &status) != 0)
        return -1;
    const off64_t to = *at + (from == SEEK_CUR ? place->at : from == SEEK_END ? status.st_size : 0);
    if (to < 0)
        return -1;
    *at = place->at = to;
    return 0;
}

int close_place(void *cookie)
{
    delete static_cast<Place *>(cookie);
    return 0;
}

} // namespace

Stream open_stream(const RetexBridgeFile &file)
{
    const int copy = fcntl(file.descriptor, F_DUPFD_CLOEXEC, 3);
    Stream stream(copy < 0 ? nullptr : fdopen(copy, "rb"), std::fclose);
    if (!stream) {
        const int why = errno;
        if (copy >= 0)
            close(copy);
        throw Failure(RETEX_EIO, std::string("cannot read: ") + std::strerror(why));
    }
    std::rewind(stream.get());
    return stream;
}

Stream open_file(const RetexBridgeFile &file)
{
    const cookie_io_functions_t calls = {read_place, nullptr, move_place, close_place};
    std::unique_ptr<Place> place(new Place{file.descriptor, 0});
    Stream stream(file.format ? fopencookie(place.get(), "rb", calls) : std::fopen(file.path, "rb"), std::fclose);
    if (!stream)
        throw Failure(RETEX_EIO, std::string("cannot read: ") + std::strerror(errno));
    if (file.format)
        place.release(); // the stream deletes it
    return stream;
}

const char *format_by_content(const RetexBridgeFile &file)
{
    static const struct {
        const char *format;
        std::string mark;
    } marks[] = {{"png", "\x89PNG\r\n\x1a\n"},
                 {"jpeg", "\xff\xd8\xff"},
                 {"gif", "GIF8"},
                 {"tiff", {"II*\0", 4}},
                 {"tiff", {"MM\0*", 4}},
                 {"tiff", {"II+\0", 4}},
                 {"tiff", {"MM\0+", 4}},
                 {"dpx", "SDPX"},
                 {"dpx", "XPDS"},
                 {"ico", {"\0\0\1\0", 4}},
                 {"zfile", "\x1f\x8b\b"},
                 {"zfile", "\xab\x67\b\x2f"},
                 {"zfile", "\x2f\b\x67\xab"},
                 {"openexr", "\x76\x2f\x31\x01"}};
    auto stream = open_file(file);
    std::string begin(16, '\0');
    begin.resize(std::fread(&begin[0], 1, begin.size(), stream.get()));
    for (const auto &one : marks)
        if (begin.compare(0, one.mark.size(), one.mark) == 0)
            return one.format;
    if (begin.compare(0, 4, "RIFF") == 0 && begin.compare(8, 4, "WEBP") == 0)
        return "webp";
    return begin.compare(0, 4, "FOR4") == 0 && begin.compare(8, 4, "CIMG") == 0 ? "iff" : nullptr;
}

std::string find_damage(const RetexBridgeHost *host, const RetexBridgeFile &file)
{
    const char *found = format_by_content(file);
    const std::string format = found ? found : "";
    Reader in(file);
    RetexDamage damage = "";
    if (format == "jpeg") {
        in.skip(2);
        return has_all_segments(in) ? "" : "the file is truncated";
    }
    if (format == "openexr")
        return has_all_attributes(in) ? "" : "its header is damaged or truncated";
    if (format == "png") {
        const Bytes bytes = in.all();
        host->png_is_damaged(bytes.data(), bytes.size(), file.max_pixels, damage);
        return damage;
    }
    static const std::set<std::string> structured = {"dpx", "ico", "iff", "webp", "zfile"};
    return structured.count(format) ? check_structure(host, format, file.max_pixels, in.all()) : "";
}

std::string find_jpeg_damage(const RetexBridgeHost *host, const RetexBridgeFile &file)
{
    const Bytes bytes = Reader(file).all();
    RetexDamage damage = "";
    host->jpeg_is_damaged(bytes.data(), bytes.size(), damage);
    return damage;
}

std::string find_targa_damage(const RetexBridgeFile &file)
{
    return check_targa(Reader(file).all());
}

} // namespace bridge
