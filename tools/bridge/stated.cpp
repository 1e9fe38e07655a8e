// What files state of their colours: ICC profiles, which Little CMS evaluates, and PNG's chunks. All of it leads to
// scene-linear Rec.709, with white as white.
#include "bridge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <memory>

#include <lcms2.h>

#include <retex/color.h>

namespace bridge
{
namespace
{

constexpr float rec709[8] = {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f};

// Whether a transform is sRGB's, to a third of an 8-bit level, or in dark channels of saturated colours to what the
// rounding of profiles does there. Such files, which are most of those with a profile, are decoded exactly and fast.
bool is_srgb(const Transform &transform)
{
    const float edges[] = {0, .02f, .04f, .1f, .25f, .5f, .75f, 1};
    std::vector<float> pixels, levels;
    for (float r : edges)
        for (float g : edges)
            for (float b : edges)
                levels.insert(levels.end(), {r, g, b, 1});
    pixels = levels;
    transform(pixels.data(), long(pixels.size() / 4));
    for (size_t i = 0; i < pixels.size(); i++)
        if (i % 4 != 3 && !(std::fabs(retex_srgb_encodef(pixels[i]) - levels[i]) < .33f / 255) &&
            !(std::fabs(pixels[i] - retex_srgb_decodef(levels[i])) < 4e-4f))
            return false;
    return true;
}

StatedColors problem(const std::string &what)
{
    StatedColors colors;
    colors.problem = what;
    return colors;
}

// ---- ICC profiles ----

// Little CMS without messages, and what is made in it.
struct Icc {
    cmsContext context = cmsCreateContext(nullptr, nullptr);
    cmsHPROFILE profile = nullptr, linear = nullptr;
    cmsHTRANSFORM transform = nullptr;
    Icc() = default;
    Icc(const Icc &) = delete;
    Icc &operator=(const Icc &) = delete;
    ~Icc()
    {
        if (transform)
            cmsDeleteTransform(transform);
        for (cmsHPROFILE p : {profile, linear})
            if (p)
                cmsCloseProfile(p);
        if (context)
            cmsDeleteContext(context);
    }
};

// The profile of scene-linear Rec.709, without limits.
cmsHPROFILE make_linear(cmsContext context)
{
    const cmsCIExyY white = {rec709[6], rec709[7], 1};
    const cmsCIExyYTRIPLE primaries = {{rec709[0], rec709[1], 1}, {rec709[2], rec709[3], 1}, {rec709[4], rec709[5], 1}};
    cmsToneCurve *line = cmsBuildGamma(context, 1), *lines[3] = {line, line, line};
    cmsHPROFILE profile = line ? cmsCreateRGBProfileTHR(context, &white, &primaries, lines) : nullptr;
    if (line)
        cmsFreeToneCurve(line);
    return profile;
}

std::string signature_text(cmsColorSpaceSignature space)
{
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
        text += char(space >> shift & 0xff);
    text.erase(text.find_last_not_of(' ') + 1);
    bool plain = std::all_of(text.begin(), text.end(), [](unsigned char c) { return c > 32 && c < 127; });
    return plain && !text.empty() ? text : "unknown";
}

StatedColors by_profile(const void *data, size_t bytes, bool is_grey)
{
    auto icc = std::make_shared<Icc>();
    if (!icc->context)
        throw std::bad_alloc();
    icc->profile = cmsOpenProfileFromMemTHR(icc->context, data, cmsUInt32Number(bytes));
    if (!icc->profile)
        return problem("its ICC profile is damaged");
    cmsColorSpaceSignature space = cmsGetColorSpace(icc->profile);
    if (space != cmsSigRgbData && !(space == cmsSigGrayData && is_grey))
        return problem("its ICC profile is for colours of another kind, " + signature_text(space));
    icc->linear = make_linear(icc->context);
    if (!icc->linear)
        throw std::bad_alloc();
    cmsUInt32Number floats = FLOAT_SH(1) | BYTES_SH(4),
                    rgba = floats | COLORSPACE_SH(PT_RGB) | CHANNELS_SH(3) | EXTRA_SH(1),
                    only_grey = floats | COLORSPACE_SH(PT_GRAY) | CHANNELS_SH(1) | EXTRA_SH(3);
    icc->transform = cmsCreateTransformTHR(icc->context, icc->profile, space == cmsSigRgbData ? rgba : only_grey,
                                           icc->linear, rgba, INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE);
    if (!icc->transform)
        return problem("its ICC profile is damaged");
    StatedColors colors;
    colors.are_stated = true;
    colors.transform = [icc](float *pixels, long count) {
        cmsDoTransform(icc->transform, pixels, pixels, cmsUInt32Number(count));
    };
    colors.are_srgb = is_srgb(colors.transform);
    return colors;
}

// ---- PNG ----

using Curve = float (*)(float);

// The camera's curve of Rec.709, Rec.601 and Rec.2020.
float decode_video(float v)
{
    return v < .0812429f ? v / 4.5f : std::pow((v + .0992968f) / 1.0992968f, 1 / .45f);
}

struct Primaries {
    int code;
    float chromaticities[8];
};

// By ITU-T H.273.
const Primaries primaries[] = {
    {1, {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f}},
    {4, {.67f, .33f, .21f, .71f, .14f, .08f, .31f, .316f}},
    {5, {.64f, .33f, .29f, .6f, .15f, .06f, .3127f, .329f}},
    {6, {.63f, .34f, .31f, .595f, .155f, .07f, .3127f, .329f}},
    {7, {.63f, .34f, .31f, .595f, .155f, .07f, .3127f, .329f}},
    {9, {.708f, .292f, .17f, .797f, .131f, .046f, .3127f, .329f}},
    {11, {.68f, .32f, .265f, .69f, .15f, .06f, .314f, .351f}},
    {12, {.68f, .32f, .265f, .69f, .15f, .06f, .3127f, .329f}},
    {22, {.63f, .34f, .295f, .605f, .155f, .077f, .3127f, .329f}},
};

// A curve for each channel, then the matrix from these primaries; curve empty = linear.
StatedColors by_curve(const RetexBridgeHost *host, Transform curve, const float chromaticities[8],
                      const std::string &name)
{
    double m[3][3];
    int converted = host->to_rec709(chromaticities, m);
    StatedColors colors;
    if (converted < 0)
        return problem(name + " has primaries that span no colour space");
    colors.are_stated = true;
    colors.are_by_channel = !converted;
    std::vector<double> matrix(&m[0][0], &m[0][0] + 9);
    colors.transform = !converted ? curve : [curve, matrix](float *rgba, long pixels) {
        if (curve)
            curve(rgba, pixels);
        for (float *p = rgba; p < rgba + 4 * pixels; p += 4) {
            const double r = p[0], g = p[1], b = p[2];
            for (int c = 0; c < 3; c++)
                p[c] = float(matrix[3 * c] * r + matrix[3 * c + 1] * g + matrix[3 * c + 2] * b);
        }
    };
    colors.are_srgb = colors.transform && is_srgb(colors.transform);
    return colors;
}

StatedColors by_cicp(const RetexBridgeHost *host, const std::vector<uint8_t> &data)
{
    if (data.size() != 4)
        return problem("its chunk cICP is damaged");
    Transform curve;
    const Primaries *found =
        std::find_if(std::begin(primaries), std::end(primaries), [&](const Primaries &p) { return p.code == data[0]; });
    switch (data[1]) {
    case 1:
    case 6:
    case 14:
    case 15:
        curve = per_channel(decode_video);
        break;
    case 4:
        curve = transform_from_gamma(2.2f);
        break;
    case 5:
        curve = transform_from_gamma(2.8f);
        break;
    case 8:
        break;
    case 13:
        curve = per_channel(retex_srgb_decodef);
        break;
    default:
        found = std::end(primaries);
    }
    if (found == std::end(primaries) || data[2] != 0 || data[3] != 1)
        return problem("its chunk cICP names colours that cannot be converted, " + std::to_string(data[0]) + "/" +
                       std::to_string(data[1]) + "/" + std::to_string(data[2]) + "/" + std::to_string(data[3]));
    return by_curve(host, curve, found->chromaticities, "its chunk cICP");
}

uint32_t number_at(const std::vector<uint8_t> &data, size_t at)
{
    return uint32_t(data[at]) << 24 | uint32_t(data[at + 1]) << 16 | uint32_t(data[at + 2]) << 8 | data[at + 3];
}

// gAMA and cHRM. Encoders write a gamma of 2.2 for sRGB.
StatedColors by_gamma(const RetexBridgeHost *host, const Chunks &chunks)
{
    auto gamma = chunks.find("gAMA"), primary = chunks.find("cHRM");
    float chromaticities[8], exponent = 2.2f;
    double matrix[3][3];
    std::copy_n(rec709, 8, chromaticities);
    if (gamma != chunks.end()) {
        if (gamma->second.size() != 4 || number_at(gamma->second, 0) == 0)
            return problem("its chunk gAMA is damaged");
        exponent = std::round(1e7f / float(number_at(gamma->second, 0))) / 100;
    }
    if (primary != chunks.end()) {
        if (primary->second.size() != 32)
            return problem("its chunk cHRM is damaged");
        for (size_t i = 0; i < 8; i++) // white comes first
            chromaticities[(i + 6) % 8] = float(number_at(primary->second, 4 * i)) * 1e-5f;
    }
    if (std::fabs(exponent - 2.2f) <= .05f && (gamma == chunks.end() || host->to_rec709(chromaticities, matrix) == 0))
        return by_curve(host, per_channel(retex_srgb_decodef), chromaticities, "its chunk cHRM");
    return by_curve(host, exponent == 1 ? Transform{} : transform_from_gamma(exponent), chromaticities,
                    "its chunk cHRM");
}

} // namespace

Chunks read_color_chunks(const RetexBridgeFile &file)
{
    Chunks chunks;
    Stream stream = open_file(file);
    uint8_t head[8] = {0};
    if (std::fread(head, 1, sizeof head, stream.get()) != sizeof head || std::memcmp(head, "\x89PNG\r\n\x1a\n", 8) != 0)
        return chunks;
    while (std::fread(head, 1, sizeof head, stream.get()) == sizeof head && std::memcmp(head + 4, "IDAT", 4) != 0) {
        uint32_t length = uint32_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
        std::string type(head + 4, head + 8);
        std::vector<uint8_t> data(std::min(length, 32u));
        if (std::fread(data.data(), 1, data.size(), stream.get()) != data.size() ||
            std::fseek(stream.get(), long(length - data.size()) + 4, SEEK_CUR) != 0)
            break;
        if (type == "cICP" || type == "iCCP" || type == "sRGB" || type == "gAMA" || type == "cHRM")
            chunks.emplace(type, data);
    }
    return chunks;
}

StatedColors stated_colors(const RetexBridgeHost *host, const Chunks &chunks, const void *profile, size_t profile_bytes,
                           bool is_grey)
{
    if (chunks.count("cICP"))
        return by_cicp(host, chunks.at("cICP"));
    if (profile)
        return by_profile(profile, profile_bytes, is_grey);
    if (chunks.count("iCCP")) // which libpng has refused
        return problem("its ICC profile is damaged, or not for its colours");
    if (!chunks.count("sRGB") && (chunks.count("gAMA") || chunks.count("cHRM")))
        return by_gamma(host, chunks);
    return {};
}

} // namespace bridge
