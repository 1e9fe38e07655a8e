// See scene_options.hpp.
#include "scene_options.hpp"

#include <algorithm>

#include <OpenImageIO/strutil.h>

#include "failure.hpp"
#include "own_folder.hpp"

namespace plugins
{
namespace
{

const char *const known = "targets, lamps, light_share, finishes, show, spp, noise, size, width, height, crop, seed, "
                          "max_depth, filter, layout, clusters, orders, strict_paper, plain, aov, denoise, "
                          "no_denoise_data, caustics_guide, include, declare.NAME, caustics, no_caustics, ambient, "
                          "no_ambient, lenient, strict, safe and threads";

int whole(const std::string &name, const std::string &value, int low, int high)
{
    OIIO::string_view text = value;
    int number = 0;
    if (!OIIO::Strutil::parse_int(text, number) || !text.empty() || number < low || number > high)
        throw Failure(name + ": expected a whole number from " + std::to_string(low) + " to " + std::to_string(high) +
                      ", not '" + value + "'");
    return number;
}

std::vector<std::string> list(const std::string &name, const std::string &value)
{
    std::vector<std::string> items = OIIO::Strutil::splits(value, ",");
    for (const std::string &item : items)
        if (item.empty())
            throw Failure(name + ": an empty name in '" + value + "'");
    return items;
}

// Convert `Floor,Wall=Brick+Plaster` to arguments of -t or -l: `Floor`, `Wall=Brick,Plaster`.
std::vector<std::string> selections(const std::string &name, const std::string &value, int most)
{
    std::vector<std::string> items = list(name, value);
    for (std::string &item : items)
        std::replace(item.begin(), item.end(), '+', ',');
    if (items.size() > size_t(most))
        throw Failure(name + ": more than " + std::to_string(most));
    return items;
}

void set_lamps(SceneOptions &options, const std::string &value)
{
    options.each_lamp = value == "each";
    if (!options.each_lamp)
        options.lamps = selections("lamps", value, LAMPS_MAX);
}

void set_option(SceneOptions &options, const std::string &name, const std::string &value)
{
    RetexError err{};
    if (name == "targets") {
        options.targets = selections(name, value, RETEX_MAX_TARGETS);
    } else if (name == "lamps") {
        set_lamps(options, value);
    } else if (name == "finishes") {
        options.finishes = selections(name, value, RETEX_MAX_TARGETS);
    } else if (name == "show") {
        options.shown = list(name, value);
    } else if (name == "include") {
        options.includes = list(name, value);
    } else if (name == "width") {
        options.width = whole(name, value, 1, RETEX_MAX_SIZE);
    } else if (name == "height") {
        options.height = whole(name, value, 1, RETEX_MAX_SIZE);
    } else if (name == "threads") {
        options.render.nthreads = whole(name, value, 0, 256);
    } else if (name == "safe") {
        whole(name, value, 0, 1); // only checks the value; wants_safe applies it
    } else if (name == "denoise") {
        options.denoise = whole(name, value, 0, 1);
    } else if (name == "no-denoise-data") {
        options.no_denoise_data = whole(name, value, 0, 1);
    } else if (job_set_option(&options.render, &options.sdl, name.c_str(), value.c_str(), &err)) {
        throw Failure(err.code == RETEX_ENOTFOUND ? "there is no option '" + name + "'; there are " + known
                                                  : std::string(err.message));
    }
}

void check(const SceneOptions &options, const Arguments &arguments)
{
    if (options.render.paper && arguments.count("clusters"))
        throw Failure("layout paper has no clusters: one of them");
    if (options.render.paper && arguments.count("lamps"))
        throw Failure("layout paper keeps no lamps apart");
    if (options.render.paper && arguments.count("finishes"))
        throw Failure("layout paper keeps no finishes apart");
    if (!options.shown.empty() && options.finishes.empty())
        throw Failure("show chooses among finishes, of which there are none");
    if (options.render.width && (options.width || options.height))
        throw Failure("size says it all: no width or height beside it");
    if (options.denoise && options.no_denoise_data)
        throw Failure("denoise reads what no_denoise_data leaves out: one of them");
    if (options.denoise && options.render.spp < 2)
        throw Failure("denoise needs two samples a pixel at least: one does not tell how noisy it is");
}

} // namespace

SceneOptions parse_scene_options(const std::string &path, const Arguments &arguments, int threads)
{
    static const std::string declare = "declare.";
    SceneOptions options;
    options.render.nthreads = threads;
    for (const auto &argument : arguments) {
        std::string name = argument.first;
        if (name.compare(0, declare.size(), declare) == 0) {
            RetexError err{};
            std::string text = name.substr(declare.size()) + "=" + argument.second;
            if (job_check_declare(text.c_str(), &err))
                throw Failure(std::string(name) + ": " + err.message);
            options.declares.push_back(text);
            continue;
        }
        std::replace(name.begin(), name.end(), '_', '-');
        set_option(options, name, argument.second);
    }
    check(options, arguments);
    options.sdl.safe = wants_safe(arguments);
    options.sdl.accept_damaged = retex_access_damage_accepted();
    OwnFolder own(path, options.sdl.safe);
    for (std::string &folder : options.includes)
        folder = own.find(folder, true);
    bool keeps = options.keeps_light() && !options.render.plain;
    options.render.denoise_data = options.denoise || (keeps && !options.no_denoise_data);
    return options;
}

} // namespace plugins
