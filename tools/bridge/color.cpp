// Colour transforms to and from scene-linear Rec.709, for names of colour spaces in the configuration of $OCIO or the
// built-in one. sRGB is computed here, not by OpenColorIO, whose curve has its break at a slightly different point than
// the standard's: 8-bit values must be the same after a round trip.
#include "bridge.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <sstream>
#include <vector>

#include <OpenColorIO/OpenColorIO.h>
#include <strings.h>

#include <retex/color.h>

#include "../libretex/picture/view.h"

namespace OCIO = OCIO_NAMESPACE;

namespace bridge
{
namespace
{

struct Configurations {
    OCIO::ConstConfigRcPtr own;
    OCIO::ConstConfigRcPtr user; // null unless $OCIO is set
    std::string problem;         // why $OCIO cannot be used
};

const Configurations &configurations()
{
    static const Configurations all = [] {
        OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE); // libraries must not print
        Configurations c;
        std::istringstream text(own_configuration);
        c.own = OCIO::Config::CreateFromStream(text);
        c.own->validate();
        const char *path = std::getenv("OCIO");
        if (path && *path) {
            try {
                c.user = OCIO::Config::CreateFromFile(path);
                c.user->validate();
            } catch (const std::exception &e) {
                c.user.reset();
                c.problem = "$OCIO is '" + std::string(path) + "', which cannot be used: " + e.what();
            }
        }
        return c;
    }();
    if (!all.problem.empty())
        throw Failure(RETEX_EIO, all.problem);
    return all;
}

Transform from_processor(const OCIO::ConstProcessorRcPtr &processor)
{
    if (processor->isNoOp())
        return {};
    // Lossless: the faster approximations of log and pow are wrong by more than an 8-bit step in dark colours.
    OCIO::ConstCPUProcessorRcPtr cpu = processor->getOptimizedCPUProcessor(OCIO::OPTIMIZATION_LOSSLESS);
    return [cpu](float *rgba, long pixels) {
        OCIO::PackedImageDesc desc(rgba, pixels, 1, 4);
        cpu->apply(desc);
    };
}

bool is_name(const char *a, const char *b)
{
    return strcasecmp(a, b) == 0;
}

// The configuration's scene-linear Rec.709 space; if it has none, the space of its scene_linear role.
std::string linear_name(const OCIO::ConstConfigRcPtr &config)
{
    for (const char *name : {"lin_rec709_scene", "Linear Rec.709 (sRGB)", "Linear Rec.709", "lin_rec709",
                             "lin_rec709_srgb", "lin_srgb", "Utility - Linear - Rec.709", "Utility - Linear - sRGB"})
        if (config->getColorSpace(name))
            return name;
    return OCIO::ROLE_SCENE_LINEAR;
}

std::string list_colorspaces(const OCIO::ConstConfigRcPtr &config)
{
    std::string names;
    for (int i = 0; i < config->getNumColorSpaces() && names.size() < 500; i++)
        names += (i ? ", " : "") + std::string(config->getColorSpaceNameByIndex(i));
    return names;
}

// The configuration that has the name: the user's if possible, otherwise the built-in one, so that `sRGB`, `linear`,
// `ACEScg` and `raw` exist with every $OCIO.
OCIO::ConstConfigRcPtr config_with(const std::string &name)
{
    const Configurations &all = configurations();
    if (all.user && all.user->getColorSpace(name.c_str()))
        return all.user;
    if (all.own->getColorSpace(name.c_str()))
        return all.own;
    throw Failure(RETEX_ENOTFOUND, "no colour space is called '" + name + "'; there are " +
                                       list_colorspaces(all.user ? all.user : all.own));
}

bool is_own_srgb(const OCIO::ConstConfigRcPtr &config, const std::string &name)
{
    return config == configurations().own && is_name(config->getColorSpace(name.c_str())->getName(), "sRGB");
}

// Two configurations are connected by ACES2065-1. If the user's has no such role, its scene-linear space is assumed to
// be Rec.709.
Transform between(const OCIO::ConstConfigRcPtr &config, const std::string &name, bool inward)
{
    const Configurations &all = configurations();
    if (config->getColorSpace(name.c_str())->isData())
        return {};
    std::string linear = linear_name(config);
    if (config != all.own && linear == OCIO::ROLE_SCENE_LINEAR && config->hasRole("aces_interchange")) {
        std::string ours = linear_name(all.own);
        return from_processor(inward
                                  ? OCIO::Config::GetProcessorFromConfigs(config, name.c_str(), all.own, ours.c_str())
                                  : OCIO::Config::GetProcessorFromConfigs(all.own, ours.c_str(), config, name.c_str()));
    }
    return from_processor(inward ? config->getProcessor(name.c_str(), linear.c_str())
                                 : config->getProcessor(linear.c_str(), name.c_str()));
}

// Whether the configuration defines how its colours relate to Rec.709. Otherwise its scene-linear space is taken for
// it.
bool knows_rec709(const OCIO::ConstConfigRcPtr &config)
{
    return config == configurations().own || linear_name(config) != OCIO::ROLE_SCENE_LINEAR ||
           config->hasRole("aces_interchange");
}

// Interop IDs of the Color Interop Forum and, with "ocio:", of OpenColorIO's configurations.
const char *const interop_ids[] = {
    "lin_rec709_scene",       "lin_ap1_scene",         "lin_ap0_scene",     "lin_p3d65_scene",  "lin_rec2020_scene",
    "lin_adobergb_scene",     "lin_ciexyzd65_scene",   "srgb_rec709_scene", "g22_rec709_scene", "g18_rec709_scene",
    "g24_rec709_scene",       "srgb_ap1_scene",        "g22_ap1_scene",     "srgb_p3d65_scene", "g22_adobergb_scene",
    "ocio:acescct_ap1_scene", "ocio:acescc_ap1_scene",
};

// The interop ID among the space's name and aliases.
std::string find_interop(const OCIO::ConstConfigRcPtr &config, const std::string &name)
{
    OCIO::ConstColorSpaceRcPtr space = config->getColorSpace(name.c_str());
    if (space->isData())
        return "data";
    for (const char *id : interop_ids) {
        OCIO::ConstColorSpaceRcPtr called = config->getColorSpace(id);
        if (called && std::strcmp(called->getName(), space->getName()) == 0)
            return id;
    }
    return "";
}

// The matrix of a transform, if it is linear. Probe values reveal curves and tables.
bool find_matrix(const Transform &transform, double matrix[3][3])
{
    const int sizes = 4;
    const float size[sizes] = {1, 0.01f, 0.3f, 8};
    std::vector<float> pixels((1 + 4 * sizes) * 4, 0.0f);
    for (int k = 0; k < 4 * sizes; k++) // three axes and grey
        for (int c = 0; c < 3; c++)
            pixels[4 * (1 + k) + c] = k % 4 == 3 || k % 4 == c ? size[k / 4] : 0;
    if (transform)
        transform(pixels.data(), long(pixels.size() / 4));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            matrix[i][j] = pixels[4 * (1 + j) + i];
    for (int k = -1; k < 4 * sizes; k++)
        for (int i = 0; i < 3; i++) {
            double expected = 0, scale = k < 0 ? 0 : size[k / 4];
            for (int j = 0; j < 3 && k >= 0; j++)
                expected += k % 4 == 3 || k % 4 == j ? matrix[i][j] * scale : 0;
            if (!(std::fabs(pixels[4 * (1 + k) + i] - expected) <= 1e-4 * scale + 1e-7))
                return false;
        }
    return true;
}

std::string list_displays(const OCIO::ConstConfigRcPtr &config)
{
    std::string names;
    for (int i = 0; i < config->getNumDisplays(); i++)
        names += (i ? ", " : "") + std::string(config->getDisplay(i));
    return names;
}

std::string list_views(const OCIO::ConstConfigRcPtr &config, const std::string &display)
{
    std::string names;
    for (int i = 0; i < config->getNumViews(display.c_str()); i++)
        names += (i ? ", " : "") + std::string(config->getView(display.c_str(), i));
    return names;
}

// The configuration's spelling of a name, ignoring case.
std::string find_display(const OCIO::ConstConfigRcPtr &config, const std::string &display)
{
    if (display.empty())
        return config->getDefaultDisplay();
    for (int i = 0; i < config->getNumDisplays(); i++)
        if (is_name(config->getDisplay(i), display.c_str()))
            return config->getDisplay(i);
    throw Failure(RETEX_ENOTFOUND, "no display is called '" + display + "'; there are " + list_displays(config));
}

std::string find_view(const OCIO::ConstConfigRcPtr &config, const std::string &display, const std::string &view)
{
    if (view.empty())
        return config->getDefaultView(display.c_str());
    for (int i = 0; i < config->getNumViews(display.c_str()); i++)
        if (is_name(config->getView(display.c_str(), i), view.c_str()))
            return config->getView(display.c_str(), i);
    throw Failure(RETEX_ENOTFOUND,
                  "display " + display + " has no view '" + view + "'; there are " + list_views(config, display));
}

} // namespace

void check_configuration()
{
    configurations();
}

Transform transform_from(const std::string &colorspace)
{
    OCIO::ConstConfigRcPtr config = config_with(colorspace);
    if (is_own_srgb(config, colorspace))
        return per_channel(retex_srgb_decodef);
    return between(config, colorspace, true);
}

Transform transform_to(const std::string &colorspace)
{
    OCIO::ConstConfigRcPtr config = config_with(colorspace);
    if (is_own_srgb(config, colorspace))
        return per_channel(retex_srgb_encodef);
    return between(config, colorspace, false);
}

Transform transform_to_display(const std::string &display, const std::string &view)
{
    const Configurations &all = configurations();
    OCIO::ConstConfigRcPtr config = all.user ? all.user : all.own;
    std::string shown_on = find_display(config, display);
    std::string shown_as = find_view(config, shown_on, view);
    if (config == all.own) {
        Transform last = transform_to(config->getDisplayViewColorSpaceName(shown_on.c_str(), shown_as.c_str()));
        RetexView curve = retex_view_find(shown_as.c_str());
        if (curve == RETEX_VIEW_STANDARD || curve == RETEX_VIEWS)
            return last;
        return [curve, last](float *rgba, long pixels) {
            retex_view_apply(curve, rgba, size_t(pixels), 4);
            last(rgba, pixels);
        };
    }
    OCIO::DisplayViewTransformRcPtr step = OCIO::DisplayViewTransform::Create();
    step->setDisplay(shown_on.c_str());
    step->setView(shown_as.c_str());
    std::string linear = linear_name(config);
    step->setSrc(linear.c_str());
    if (linear == OCIO::ROLE_SCENE_LINEAR && config->hasRole("aces_interchange")) {
        step->setSrc("aces_interchange");
        Transform first = from_processor(
            OCIO::Config::GetProcessorFromConfigs(all.own, linear_name(all.own).c_str(), config, "aces_interchange"));
        Transform second = from_processor(config->getProcessor(step));
        return [first, second](float *rgba, long pixels) {
            if (first)
                first(rgba, pixels);
            if (second)
                second(rgba, pixels);
        };
    }
    return from_processor(config->getProcessor(step));
}

void describe_colorspace(const std::string &colorspace, RetexBridgeStored &stored)
{
    OCIO::ConstConfigRcPtr config = config_with(colorspace);
    if (!knows_rec709(config))
        return;
    std::snprintf(stored.interop, sizeof stored.interop, "%s", find_interop(config, colorspace).c_str());
    stored.is_linear =
        std::strcmp(stored.interop, "data") != 0 && find_matrix(transform_to(colorspace), stored.from_rec709);
}

bool colorspace_is_srgb(const std::string &colorspace)
{
    return is_own_srgb(config_with(colorspace), colorspace);
}

bool display_is_srgb(const std::string &display, const std::string &view)
{
    const Configurations &all = configurations();
    if (all.user)
        return false;
    std::string shown_on = find_display(all.own, display);
    std::string shown_as = find_view(all.own, shown_on, view);
    return colorspace_is_srgb(all.own->getDisplayViewColorSpaceName(shown_on.c_str(), shown_as.c_str()));
}

Transform transform_from_gamma(float gamma)
{
    return per_channel([gamma](float v) { return v > 0 ? std::pow(v, gamma) : 0.0f; });
}

Transform transform_from_srgb_levels(int levels)
{
    auto table = std::make_shared<std::vector<float>>(levels);
    for (int i = 0; i < levels; i++) {
        (*table)[i] = float(retex_srgb_decode(i / double(levels - 1)));
    }
    float top = float(levels - 1);
    return per_channel([table, top](float v) {
        float level = v * top + 0.5f;
        return (*table)[level <= 0 ? 0 : level >= top ? size_t(top) : size_t(level)];
    });
}

} // namespace bridge
