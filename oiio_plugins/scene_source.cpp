// See scene_source.hpp.
#include "scene_source.hpp"

#include <atomic>
#include <cmath>
#include <cstdlib>

#include <retex/denoise.h>
#include <retex/set_file.h>

#include "budget.hpp"
#include "cache.hpp"
#include "failure.hpp"
#include "own_folder.hpp"
#include "scene_options.hpp"

namespace plugins
{
namespace
{

const size_t scenes_kept = 3;

// Number of renders of this process, shown as `retex:renders` if $RETEX_OIIO_DEBUG is set.
std::atomic<int> renders{0};

// Refuse scenes as textures of scenes: a scene that is its own texture would wait for itself.
class NotNested
{
  public:
    NotNested()
    {
        if (inside())
            throw Failure("a scene cannot be a texture of a scene");
        inside() = true;
    }
    ~NotNested()
    {
        inside() = false;
    }
    NotNested(const NotNested &) = delete;
    NotNested &operator=(const NotNested &) = delete;

  private:
    static bool &inside()
    {
        static thread_local bool is = false;
        return is;
    }
};

std::vector<const char *> pointers(const std::vector<std::string> &texts)
{
    std::vector<const char *> all;
    for (const std::string &text : texts)
        all.push_back(text.c_str());
    return all;
}

void keep_warning(void *context, int level, const char *text)
{
    auto *warnings = static_cast<std::string *>(context);
    if (level > 0 && warnings->size() < 4000)
        *warnings += (warnings->empty() ? "" : "\n") + std::string(text);
}

using ScenePointer = std::unique_ptr<Scene, void (*)(Scene *)>;

void close_scene(Scene *scene)
{
    scene_close(&scene);
}

ScenePointer parse_scene(const std::string &path, const SceneOptions &options, std::string *warnings)
{
    RetexError err{};
    Scene *scene = nullptr;
    std::vector<const char *> targets = pointers(options.targets), lamps = pointers(options.lamps),
                              finishes = pointers(options.finishes), shown = pointers(options.shown),
                              includes = pointers(options.includes), declares = pointers(options.declares);
    SdlOptions sdl = options.sdl;
    sdl.nthreads = options.render.nthreads;
    sdl.include_paths = includes.data(), sdl.ninclude_paths = int(includes.size());
    sdl.declares = declares.data(), sdl.ndeclares = int(declares.size());
    sdl.message = keep_warning, sdl.message_context = warnings;
    warnings->clear();
    JobNames names{};
    names.targets = targets.data(), names.ntargets = int(targets.size());
    names.lamps = lamps.data(), names.nlamps = int(lamps.size()), names.each_lamp = options.each_lamp;
    names.finishes = finishes.data(), names.nfinishes = int(finishes.size());
    names.shown = shown.data(), names.nshown = int(shown.size());
    must(job_open_scene(&scene, path.c_str(), &sdl, &options.render, &names, &err), err);
    job_warn_dark(scene, &sdl);
    return {scene, close_scene};
}

// A scene that is read at once and rendered on demand.
class SceneJob
{
  public:
    SceneJob(const std::string &path, const Arguments &arguments, int threads)
        : budget_(wants_safe(arguments)), options_(parse_scene_options(path, arguments, threads)),
          scene_(nullptr, close_scene)
    {
        RetexError err{};
        options_.render.budget = options_.sdl.budget = budget_.begin();
        options_.sdl.max_steps = budget_.steps();
        scene_ = parse_scene(path, options_, &warnings_);
        if (options_.width || options_.height)
            settle_size(path);
        for (int t = 0; t < scene_->ntargets; t++)
            if (job_target_is_empty(scene_.get(), t))
                keep_warning(&warnings_, 1,
                             (std::string("target `") + scene_->targets[t].name + "` has no surface").c_str());
        must(job_check_size(scene_.get(), &options_.render, &err), err);
        describe();
    }
    ~SceneJob()
    {
        retex_set_close(&set_);
    }
    SceneJob(const SceneJob &) = delete;
    SceneJob &operator=(const SceneJob &) = delete;

    // Whether there is only a picture, whose description is known before it is rendered.
    bool is_picture() const
    {
        return (!options_.keeps_light() || options_.render.plain) && !options_.render.aovs;
    }
    // What is known of a picture alone before it is rendered.
    const RetexSetInfo &description() const
    {
        return description_;
    }
    const RetexSet &set()
    {
        NotNested guard;
        std::lock_guard<std::mutex> lock(mutex_);
        if (!set_)
            render();
        return *set_;
    }
    const std::string &manifest() const
    {
        return manifest_;
    }
    const std::string &warnings() const
    {
        return warnings_;
    }

  private:
    // A scene may depend on the size of the picture, so it is read again when the size is known.
    void settle_size(const std::string &path)
    {
        double shape = double(scene_->width) / scene_->height;
        int width = options_.width ? options_.width : int(std::lround(options_.height * shape));
        int height = options_.height ? options_.height : int(std::lround(options_.width / shape));
        options_.render.width = options_.sdl.width = std::max(width, 1);
        options_.render.height = options_.sdl.height = std::max(height, 1);
        scene_ = parse_scene(path, options_, &warnings_);
    }
    void describe()
    {
        const RenderParams &r = options_.render;
        const char *slash = std::strrchr(scene_->path, '/');
        int width = r.width ? r.width : scene_->width, height = r.height ? r.height : scene_->height;
        if (r.crop[2] && (r.crop[0] + r.crop[2] > width || r.crop[1] + r.crop[3] > height))
            throw Failure("crop does not lie inside the picture of " + std::to_string(width) + "x" +
                          std::to_string(height));
        description_.width = r.crop[2] ? r.crop[2] : width;
        description_.height = r.crop[3] ? r.crop[3] : height;
        if (description_.width > RETEX_MAX_SIZE || description_.height > RETEX_MAX_SIZE)
            throw Failure("a picture may have " + std::to_string(RETEX_MAX_SIZE) + " pixels a side");
        name_ = std::string(slash ? slash + 1 : scene_->path).substr(0, RETEX_SCENE_MAX - 1);
        description_.layout = "plain", description_.scene = name_.c_str(), description_.generator = "";
        description_.spp = r.spp, description_.max_depth = r.max_depth, description_.seed = r.seed;
    }
    void render()
    {
        RetexError err{};
        RetexSet *rendered = nullptr;
        budget_.begin();
        must(render_scene(&rendered, scene_.get(), &options_.render, nullptr, &err), err);
        std::unique_ptr<RetexSet, void (*)(RetexSet *)> owned(rendered, [](RetexSet *set) { retex_set_close(&set); });
        renders++;
        if (options_.denoise) {
            RetexDenoiseParams params = RETEX_DENOISE_INIT;
            params.budget = budget_.begin();
            params.full_precision = 1;
            must(retex_denoise(rendered, &params, nullptr, options_.render.nthreads, &err), err);
        }
        if (!is_picture()) {
            must(retex_set_checksum(rendered, options_.render.nthreads, &err), err);
            manifest_ = manifest_of(*rendered);
        }
        set_ = owned.release();
        scene_.reset(); // not needed after the render
    }

    Budget budget_; // declared before all members that use it
    SceneOptions options_;
    ScenePointer scene_;
    std::string warnings_, manifest_, name_;
    RetexSetInfo description_{};
    std::mutex mutex_;
    RetexSet *set_ = nullptr;
};

class SceneSource final : public Source
{
  public:
    explicit SceneSource(const std::shared_ptr<SceneJob> &job) : job_(job)
    {
    }
    int count() override
    {
        return job_->is_picture() ? 1 : retex_set_info(&job_->set()).nparts;
    }
    OIIO::ImageSpec spec(int index) override
    {
        if (index > 0)
            return part_spec(job_->set(), index);
        OIIO::ImageSpec spec =
            job_->is_picture() ? picture_spec(job_->description(), "", job_->manifest())
                               : picture_spec(retex_set_info(&job_->set()), targets_of(job_->set()), job_->manifest());
        if (!job_->warnings().empty())
            spec.attribute("retex:warnings", job_->warnings());
        if (std::getenv("RETEX_OIIO_DEBUG"))
            spec.attribute("retex:renders", renders.load());
        return spec;
    }
    Pixels pixels(int index) override
    {
        const RetexPart &part = *retex_set_part(&job_->set(), index);
        return {part.image, part.type};
    }

  private:
    const std::shared_ptr<SceneJob> job_;
};

} // namespace

std::shared_ptr<Source> open_scene(const std::string &path, const Arguments &arguments, int threads)
{
    static Cache<SceneJob> cache(scenes_kept);
    NotNested guard;
    std::string key = (wants_safe(arguments) ? "safe:" : "") + path;
    for (const auto &argument : arguments)
        if (argument.first != "threads") // the number of threads does not change the picture
            key += "&" + argument.first + "=" + argument.second;
    return std::make_shared<SceneSource>(
        cache.get(key, file_stamp(path), [&] { return std::make_shared<SceneJob>(path, arguments, threads); }));
}

} // namespace plugins
