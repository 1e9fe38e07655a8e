// See endings.hpp.
#include "endings.hpp"

#include <algorithm>
#include <cctype>
#include <set>

namespace bridge
{
namespace
{

struct Format {
    std::set<std::string> endings;
    size_t at; // of the marks
    std::vector<std::string> marks;
};

// A string with zero bytes.
template <size_t N> std::string bytes(const char (&text)[N])
{
    return std::string(text, N - 1);
}

const std::vector<Format> &formats()
{
    static const std::vector<Format> all = {
        {{"png"}, 0, {"\x89PNG\r\n\x1a\n"}},
        {{"jpg", "jpe", "jpeg", "jif", "jfif", "jfi"}, 0, {"\xff\xd8\xff"}},
        {{"tif", "tiff", "tx", "env", "sm", "vsm"},
         0,
         {bytes("II*\0"), bytes("MM\0*"), bytes("II+\0"), bytes("MM\0+")}},
        {{"exr", "sxr", "mxr"}, 0, {"\x76\x2f\x31\x01"}},
        {{"hdr", "rgbe"}, 0, {"#?RADIANCE", "#?RGBE"}},
        {{"bmp", "dib"}, 0, {"BM"}},
        {{"tga", "tpic"}, 2, {"\x02", "\x03", "\x0a", "\x0b"}}, // the type of a picture: no mark is at the beginning
        {{"webp"}, 8, {"WEBP"}},
        {{"avif"}, 4, {"ftypavif"}},
        {{"jxl"}, 0, {"\xff\x0a"}},
        {{"heic"}, 4, {"ftypheic", "ftypheix"}},
        {{"heif"}, 4, {"ftypheic", "ftypheix", "ftypmif1"}},
        {{"jp2"}, 0, {bytes("\0\0\0\x0cjP  \r\n\x87\n")}},
        {{"j2k", "j2c"}, 0, {"\xff\x4f\xff\x51"}},
        {{"dpx"}, 0, {"SDPX", "XPDS"}},
        {{"gif"}, 0, {"GIF87a", "GIF89a"}},
        {{"ppm"}, 0, {"P3", "P6"}},
        {{"pgm"}, 0, {"P2", "P5"}},
        {{"pnm"}, 0, {"P2", "P3", "P5", "P6"}},
        {{"sgi", "rgb", "rgba", "bw", "int", "inta"}, 0, {bytes("\x01\xda")}},
        {{"ico"}, 0, {bytes("\0\0\1\0")}},
        {{"iff"}, 0, {"FOR4"}},
        {{"rla"}, 26, {"\xff\xfe"}}, // the revision
        {{"fits"}, 0, {"SIMPLE  ="}},
        {{"zfile"}, 0, {"\x2f\x08\x67\xab", "\xab\x67\x08\x2f", "\x1f\x8b"}},
    };
    return all;
}

const Format *find_format(const std::string &ending)
{
    const auto &all = formats();
    auto found =
        std::find_if(all.begin(), all.end(), [&](const Format &one) { return one.endings.count(ending) != 0; });
    return found == all.end() ? nullptr : &*found;
}

} // namespace

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

bool has_known_ending(const std::string &ending)
{
    return find_format(lower(ending)) != nullptr;
}

std::vector<std::string> known_endings()
{
    static const std::vector<std::string> shown = {"tif",  "exr", "hdr", "bmp", "tga", "webp", "avif",
                                                   "jxl",  "heic", "jp2", "j2k", "dpx", "gif", "ppm",
                                                   "pnm",  "sgi",  "ico", "iff", "rla", "fits"};
    return shown;
}

bool begins_as(const std::string &ending, const std::string &begin)
{
    const Format *format = find_format(ending);
    return format && std::any_of(format->marks.begin(), format->marks.end(), [&](const std::string &mark) {
               return begin.compare(format->at, mark.size(), mark) == 0;
           });
}

} // namespace bridge
