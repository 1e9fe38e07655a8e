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
    for (int i = 0; i < set.nfootprints; i++) {
        const RetexFootprint &f = set.footprints[i];
        if (f.uv == part)
            return {"uv", f.target};
        if (f.spread == part)
            return {"spread", f.target};
        if (f.albedo == part)
            return {"albedo", f.target};
    }
    return {"", -1};
}

Role role_of(const RetexSet &set, int part)
{
    if (part == 0)
        return {"picture", -1};
    for (int i = 0; i < set.nterms; i++) {
        const RetexTerm &term = set.terms[i];
        const int target = retex_term_is_light(&term) || retex_term_hits(&term) ? term.target : -1;
        if (term.radiance == part)
            return {"radiance", target};
        if (retex_term_image(&term) == part)
            return {"gain", target};
    }
    Role footprint = footprint_role(set, part);
    if (*footprint.name)
        return footprint;
    for (int i = 0; i < set.nmixtures; i++)
        for (int k = 0; k < set.mixtures[i].nshares; k++)
            if (set.mixtures[i].shares[k].weight == part)
                return {"share", set.footprints[set.mixtures[i].shares[k].footprint].target};
    for (int t = 0; t < set.ntargets; t++)
        if (set.targets[t].original == part)
            return {"original", t};
    return {"data", -1};
}

} // namespace

OIIO::ImageSpec part_spec(const RetexSet &set, int index)
{
    const RetexPart &part = set.parts[index];
    OIIO::ImageSpec spec(part.image.width, part.image.height, int(std::strlen(part.letters)),
                         part.type == RETEX_HALF ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    // All parts have the same display window, as in a set. Channel A of a mean UV is not alpha.
    spec.full_width = set.width;
    spec.full_height = set.height;
    spec.alpha_channel = spec.z_channel = -1;
    for (int c = 0; c < spec.nchannels; c++)
        spec.channelnames[c] = (index ? part.name + std::string(".") : std::string()) + part.letters[c];
    spec.attribute("oiio:subimagename", part.name);
    Role role = role_of(set, index);
    spec.attribute("retex:role", role.name);
    if (role.target >= 0)
        spec.attribute("retex:target", set.targets[role.target].name);
    if (spec.nchannels == 3)
        spec.attribute("oiio:ColorSpace", "Linear");
    // The same attributes as in the set's file.
    static const float rec709[8] = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    bool color = retex_set_part_is_color(&set, index);
    spec.attribute("colorInteropID", color ? "lin_rec709_scene" : "data");
    if (color)
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709);
    return spec;
}

void describe_picture(OIIO::ImageSpec &spec, const RetexSet &set, const std::string &manifest)
{
    std::string targets;
    for (int t = 0; t < set.ntargets; t++)
        targets += (t ? "," : "") + std::string(set.targets[t].name);
    spec.attribute("retex:scene", set.scene);
    spec.attribute("retex:layout", set.layout);
    if (!targets.empty())
        spec.attribute("retex:targets", targets);
    spec.attribute("retex:spp", set.spp);
    spec.attribute("retex:max_depth", set.max_depth);
    spec.attribute("retex:seed", unsigned(set.seed));
    if (*set.generator)
        spec.attribute("Software", set.generator);
    if (!manifest.empty())
        spec.attribute("retex", manifest);
}

std::string manifest_of(const RetexSet &set)
{
    RetexError err{};
    char *text = nullptr;
    must(retex_set_manifest(&set, nullptr, &text, &err), err);
    std::unique_ptr<char, void (*)(void *)> owned(text, std::free);
    return text;
}

} // namespace plugins
