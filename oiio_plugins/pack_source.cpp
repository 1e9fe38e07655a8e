// See pack_source.hpp. Only `PackSet` and `open_set` know how a set is read from its pack.
#include "pack_source.hpp"

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <vector>

#include <retex/retex.h>

#include "budget.hpp"
#include "cache.hpp"
#include "failure.hpp"
#include "own_folder.hpp"

namespace plugins
{
namespace
{

// Number of sets kept in memory, and of their pictures, which are small.
const size_t sets_kept = 3, pictures_kept = 8;

// ---- the set ----

// The set of a pack. The picture reads rows of the open file when it needs them; the first request for another part
// reads the whole set. Neither changes afterwards, so any thread may read.
class PackSet
{
  public:
    explicit PackSet(const std::string &path) : path_(path)
    {
        RetexError err{};
        must(retex_set_open(path.c_str(), &set_, nullptr, 0, &err), err);
    }
    ~PackSet()
    {
        retex_set_close(&set_);
        retex_set_close(&whole_);
    }
    PackSet(const PackSet &) = delete;
    PackSet &operator=(const PackSet &) = delete;

    const RetexSet &description() const // has no pixels
    {
        return *set_;
    }
    // The set with pixels and their checksums. With a lossy pack the checksums differ from those of the packed set.
    const RetexSet &whole(int threads)
    {
        std::call_once(reading_, [&] {
            RetexError err{};
            must(retex_set_read(path_.c_str(), &whole_, nullptr, threads, &err), err);
            must(retex_set_checksum(whole_, threads, &err), err);
            if (whole_->nparts != set_->nparts)
                throw Failure("the pack has changed while it was read");
        });
        return *whole_;
    }
    // The picture with these textures; without any, the picture as rendered, as far as the set has it.
    RetexImage picture(std::vector<RetexTextureSpec> specs, const Budget &budget, int threads)
    {
        for (RetexTextureSpec &spec : specs)
            spec.budget = budget.begin();
        RetexError err{};
        RetexImage picture{};
        RetexTexture *textures[RETEX_MAX_TARGETS];
        if (!set_->nterms && specs.empty()) {
            must(retex_image_copy(&picture, &whole(threads).parts[0].image, &err), err);
            return picture;
        }
        int code = retex_textures_load(textures, set_, specs.data(), int(specs.size()), threads, &err);
        if (!code)
            code = retex_image_alloc(&picture, set_->width, set_->height, 3, &err);
        if (!code)
            code = retex_retexture(set_, nullptr, textures, nullptr, keep_rows, &picture, threads, &err);
        retex_textures_close(textures);
        if (code)
            retex_image_free(&picture);
        must(code, err);
        return picture;
    }

  private:
    static int keep_rows(void *picture, int y0, int y1, const float *rows, RetexError *)
    {
        const RetexImage *image = static_cast<const RetexImage *>(picture);
        std::copy(rows, rows + 3 * size_t(image->width) * size_t(y1 - y0),
                  image->pixels + retex_image_index(image, 0, y0));
        return 0;
    }

    const std::string path_;
    RetexSet *set_ = nullptr, *whole_ = nullptr;
    std::once_flag reading_;
};

std::shared_ptr<PackSet> open_set(const std::string &path)
{
    static Cache<PackSet> cache(sets_kept);
    return cache.get(path, file_stamp(path), [&] { return std::make_shared<PackSet>(path); });
}

// ---- textures ----

std::string target_names(const RetexSet &set)
{
    std::string names;
    for (int t = 0; t < set.ntargets; t++)
        names += (t ? ", " : "") + std::string(set.targets[t].name);
    return names.empty() ? "none" : names;
}

// Find wrong names and missing files when the name is opened, not when pixels are read.
void check_texture(const RetexSet &set, const RetexTextureSpec &texture)
{
    if (retex_set_find_target(&set, texture.target) < 0)
        throw Failure(std::string("the set has no target '") + texture.target + "'; there are: " + target_names(set));
    if (!texture.constant && file_stamp(texture.image) == "absent")
        throw Failure(std::string("cannot read ") + texture.image + ": No such file or directory");
}

// Print warnings to standard error, because OpenImageIO has only errors. Textures are read while they are sampled.
void print_warning(void *, const char *text)
{
    std::fprintf(stderr, "retex: warning: %s\n", text);
}

// The arguments are sorted, so a target comes before its options.
std::vector<RetexTextureSpec> parse_textures(const Arguments &arguments, const OwnFolder &own)
{
    std::vector<RetexTextureSpec> textures;
    for (const auto &argument : arguments) {
        const std::string &name = argument.first;
        if (name == "safe" && argument.second != "0" && argument.second != "1")
            throw Failure("safe: expected 0 or 1, not '" + argument.second + "'");
        if (name == "safe")
            continue;
        size_t dot = name.find('.');
        if (dot != std::string::npos && !arguments.count(name.substr(0, dot)))
            throw Failure(name + ": " + name.substr(0, dot) + " has no texture; expected " + name.substr(0, dot) +
                          "=IMAGE too");
        if (dot != std::string::npos)
            continue;
        std::string options, begin = name + ".";
        for (auto o = arguments.lower_bound(begin);
             o != arguments.end() && o->first.compare(0, begin.size(), begin) == 0; ++o) {
            if (o->second.find(':') != std::string::npos)
                throw Failure(o->first + ": no colon can be in '" + o->second + "'");
            options += (options.empty() ? "" : ":") + o->first.substr(begin.size()) + "=" + o->second;
        }
        RetexTextureSpec texture = RETEX_TEXTURE_SPEC_INIT;
        RetexError err{};
        must(retex_texture_spec_parse(&texture, options.c_str(), (name + "=" + argument.second).c_str(), &err), err);
        std::string image = texture.constant ? "" : own.find(texture.image);
        if (image.size() >= sizeof texture.image)
            throw Failure(std::string(texture.image) + ": the name is too long");
        std::copy_n(image.c_str(), image.size() + 1, texture.image);
        texture.access = own.access();
        texture.warn = print_warning;
        textures.push_back(texture);
    }
    return textures;
}

// ---- the source ----

struct Picture {
    RetexPart part{};
    std::string manifest; // manifest of the set with this picture as part 0; "" for a picture with other textures
    ~Picture()
    {
        retex_image_free(&part.image);
    }
};

// The set's part 0 is the picture that the plugin shows, so that a copy of all parts is a valid set.
void make_manifest(Picture &picture, const RetexSet &set)
{
    RetexError err{};
    RetexSet front = set;
    front.nparts = 1;
    front.parts = &picture.part;
    must(retex_set_checksum(&front, 1, &err), err);
    std::vector<RetexPart> parts(set.parts, set.parts + set.nparts);
    parts[0] = picture.part;
    front.nparts = set.nparts;
    front.parts = parts.data();
    picture.manifest = manifest_of(front);
}

class PackSource final : public Source
{
  public:
    PackSource(const std::string &path, const Arguments &arguments, int threads)
        : own_(path, wants_safe(arguments)), budget_(own_.access()->safe), textures_(parse_textures(arguments, own_)),
          threads_(threads), key_((own_.access()->safe ? "safe:" : "") + path), stamp_(file_stamp(path)),
          set_(open_set(path))
    {
        budget_.check_size(set_->description().width, set_->description().height);
        for (const RetexTextureSpec &texture : textures_) {
            check_texture(set_->description(), texture);
            stamp_ += texture.constant ? "" : " " + file_stamp(texture.image);
        }
        for (const auto &argument : arguments) {
            if (argument.first == "safe")
                continue;
            key_ += "&" + argument.first + "=" + argument.second;
            shown_ += (shown_.empty() ? "" : "&") + argument.first + "=" + argument.second;
        }
    }
    int count() override
    {
        return textures_.empty() ? set_->description().nparts : 1;
    }
    OIIO::ImageSpec spec(int index) override
    {
        OIIO::ImageSpec spec = part_spec(set_->description(), index);
        if (index > 0)
            return spec;
        spec.set_format(OIIO::TypeDesc::FLOAT);
        describe_picture(spec, set_->description(), textures_.empty() ? picture().manifest : "");
        if (!textures_.empty())
            spec.attribute("retex:textures", shown_);
        return spec;
    }
    const RetexPart &part(int index) override
    {
        return index ? set_->whole(threads_).parts[index] : picture().part;
    }

  private:
    const Picture &picture()
    {
        static Cache<Picture> cache(pictures_kept);
        std::lock_guard<std::mutex> lock(mutex_);
        if (!picture_)
            picture_ = cache.get(key_, stamp_, [&] { return make_picture(); });
        return *picture_;
    }
    std::shared_ptr<Picture> make_picture() const
    {
        auto picture = std::make_shared<Picture>();
        picture->part = set_->description().parts[0];
        picture->part.type = RETEX_FLOAT;
        picture->part.image = RetexImage{};
        picture->part.image = set_->picture(textures_, budget_, threads_);
        if (textures_.empty())
            make_manifest(*picture, set_->whole(threads_));
        return picture;
    }

    const OwnFolder own_;
    const Budget budget_;
    const std::vector<RetexTextureSpec> textures_;
    const int threads_;
    std::string key_, stamp_, shown_;
    const std::shared_ptr<PackSet> set_;
    std::mutex mutex_;
    std::shared_ptr<Picture> picture_;
};

} // namespace

std::shared_ptr<Source> open_pack(const std::string &path, const Arguments &arguments, int threads)
{
    return std::make_shared<PackSource>(path, arguments, threads);
}

} // namespace plugins
