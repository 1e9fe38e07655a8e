// Describes a set's parts to OpenImageIO.
#include "set_input.hpp"

#include <cstdlib>
#include <cstring>
#include <retex/set_file.h>

#include "failure.hpp"

namespace plugins
{
namespace
{

// The role of a part in its set, and its target.
struct Role {
    const char *name;
    int target; // or -1 = none
};

Role footprint_role(const RetexSet &set, int part)
{
    const RetexFootprint *f;
    for (int i = 0; (f = retex_set_footprint(&set, i)); i++) {
        if (f->uv == part)
            return {"uv", f->target};
        if (f->spread == part)
            return {"spread", f->target};
        if (f->albedo == part)
            return {"albedo", f->target};
    }
    return {"", -1};
}

Role role_of(const RetexSet &set, int part)
{
    if (part == 0)
        return {"picture", -1};
    const RetexTerm *term;
    for (int i = 0; (term = retex_set_term(&set, i)); i++) {
        const int target = retex_term_is_light(term) || retex_term_hits(term) ? term->target : -1;
        if (term->radiance == part)
            return {"radiance", target};
        if (retex_term_image(term) == part)
            return {"gain", target};
    }
    Role footprint = footprint_role(set, part);
    if (*footprint.name)
        return footprint;
    const RetexMixture *mixture;
    for (int i = 0; (mixture = retex_set_mixture(&set, i)); i++)
        for (int k = 0; k < mixture->nshares; k++)
            if (mixture->shares[k].weight == part)
                return {"share", retex_set_footprint(&set, mixture->shares[k].footprint)->target};
    const RetexTarget *target;
    for (int t = 0; (target = retex_set_target(&set, t)); t++)
        if (target->original == part)
            return {"original", t};
    return {"data", -1};
}

// All parts have the same display window, as in a set. Channel A of a mean UV is not alpha.
OIIO::ImageSpec image_spec(const RetexSetInfo &info, int width, int height, int channels, OIIO::TypeDesc type,
                           const char *name, const char *role)
{
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.full_width = info.width;
    spec.full_height = info.height;
    spec.alpha_channel = spec.z_channel = -1;
    spec.attribute("oiio:subimagename", name);
    spec.attribute("retex:role", role);
    if (channels == 3)
        spec.attribute("oiio:ColorSpace", "Linear");
    return spec;
}

// The same attributes as in the set's file.
void tag_color(OIIO::ImageSpec &spec, bool is_color)
{
    static const float rec709[8] = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    spec.attribute("colorInteropID", is_color ? "lin_rec709_scene" : "data");
    if (is_color)
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709);
}

} // namespace

OIIO::ImageSpec part_spec(const RetexSet &set, int index)
{
    const RetexPart &part = *retex_set_part(&set, index);
    Role role = role_of(set, index);
    OIIO::ImageSpec spec =
        image_spec(retex_set_info(&set), part.image.width, part.image.height, int(std::strlen(part.letters)),
                   part.type == RETEX_HALF ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT, part.name, role.name);
    for (int c = 0; c < spec.nchannels; c++)
        spec.channelnames[c] = (index ? part.name + std::string(".") : std::string()) + part.letters[c];
    if (role.target >= 0)
        spec.attribute("retex:target", retex_set_target(&set, role.target)->name);
    tag_color(spec, retex_set_part_is_color(&set, index));
    return spec;
}

OIIO::ImageSpec picture_spec(const RetexSetInfo &info, const std::string &targets, const std::string &manifest)
{
    OIIO::ImageSpec spec = image_spec(info, info.width, info.height, 3, OIIO::TypeDesc::FLOAT, "beauty", "picture");
    tag_color(spec, true);
    spec.attribute("retex:scene", info.scene);
    spec.attribute("retex:layout", info.layout);
    if (!targets.empty())
        spec.attribute("retex:targets", targets);
    spec.attribute("retex:spp", info.spp);
    spec.attribute("retex:max_depth", info.max_depth);
    spec.attribute("retex:seed", unsigned(info.seed));
    if (*info.generator)
        spec.attribute("Software", info.generator);
    if (!manifest.empty())
        spec.attribute("retex", manifest);
    return spec;
}

std::string targets_of(const RetexSet &set)
{
    std::string targets;
    const RetexTarget *target;
    for (int t = 0; (target = retex_set_target(&set, t)); t++)
        targets += (t ? "," : "") + std::string(target->name);
    return targets;
}

std::string manifest_of(const RetexSet &set)
{
    RetexError err{};
    char *text = nullptr;
    must(retex_set_manifest(&set, &text, &err), err);
    std::unique_ptr<char, void (*)(void *)> owned(text, std::free);
    return text;
}

} // namespace plugins
