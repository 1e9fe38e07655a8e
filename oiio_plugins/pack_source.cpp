// See pack_source.hpp. Only `PackSet` and `open_set` know how a set is read from its pack.
#include "pack_source.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
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

bool is_developed(const RetexDevelop &develop)
{
    return develop.exposure != 0 || develop.white_balance != 0 || develop.auto_exposure;
}

// ---- the set ----

// The set of a pack. The picture reads rows of the open file when it needs them; the first request for another part
// reads the whole set. Neither changes afterwards, so any thread may read.
class PackSet
{
  public:
    explicit PackSet(const std::string &path) : path_(path)
    {
        RetexError err{};
        must(retex_set_open(path.c_str(), &set_, 0, &err), err);
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
            must(retex_set_read(path_.c_str(), &whole_, threads, &err), err);
            must(retex_set_checksum(whole_, threads, &err), err);
            if (retex_set_info(whole_).nparts != retex_set_info(set_).nparts)
                throw Failure("the pack has changed while it was read");
        });
        return *whole_;
    }
    // The picture with these textures and parameters, developed; without any, the picture as rendered, as far as the
    // set has it.
    RetexImage picture(std::vector<RetexTextureSpec> specs, const std::vector<float> &parameters,
                       const RetexDevelop &develop, const Budget &budget, int threads)
    {
        for (RetexTextureSpec &spec : specs)
            spec.budget = budget.begin();
        RetexError err{};
        RetexImage picture{};
        RetexTexture *textures[RETEX_MAX_TARGETS];
        const RetexSetInfo info = retex_set_info(set_);
        if (!info.nterms && specs.empty() && parameters.empty() && !is_developed(develop)) {
            must(retex_image_copy(&picture, &retex_set_part(&whole(threads), 0)->image, &err), err);
            return picture;
        }
        int code = retex_textures_load(textures, set_, specs.data(), int(specs.size()), threads, &err);
        if (!code)
            code = retex_image_alloc(&picture, info.width, info.height, 3, &err);
        RetexCombineParams params = RETEX_COMBINE_INIT;
        params.parameters = parameters.empty() ? nullptr : parameters.data();
        params.develop = &develop;
        if (!code)
            code = retex_retexture(set_, textures, &params, keep_rows, &picture, threads, &err);
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

// Print warnings to standard error, because OpenImageIO has only errors. Textures are read while they are sampled.
void print_warning(void *, const char *text)
{
    std::fprintf(stderr, "retex: warning: %s\n", text);
}

struct EditCloser {
    void operator()(RetexEdit *edit) const
    {
        retex_edit_close(&edit);
    }
};
using Edit = std::unique_ptr<RetexEdit, EditCloser>;

Edit parse_edit(const Arguments &arguments)
{
    RetexError err{};
    RetexEdit *made = nullptr;
    must(retex_edit_create(&made, &err), err);
    Edit edit(made);
    for (const auto &argument : arguments) {
        if (argument.first != "safe")
            must(retex_edit_set(made, argument.first.c_str(), argument.second.c_str(), &err), err);
        else if (argument.second != "0" && argument.second != "1")
            throw Failure("safe: expected 0 or 1, not '" + argument.second + "'");
    }
    must(retex_edit_check(made, &err), err);
    return edit;
}

// The files that a texture is read from: of a folder, those that are used.
std::vector<std::string> files_of(const RetexTextureSpec &texture)
{
    std::vector<std::string> files;
    for (int k = 0; k < RETEX_TEXTURE_FILES; k++) {
        RetexError err{};
        char *file = nullptr;
        must(retex_texture_file(&file, &texture, k, &err), err);
        const std::unique_ptr<char, void (*)(void *)> owned(file, std::free);
        if (file)
            files.push_back(file);
    }
    return files;
}

// Gives a file that a texture names its place in the own folder.
template <size_t N> void find_file(char (&name)[N], const OwnFolder &own, bool may_be_folder)
{
    char meant[RETEX_MEANT_SIZE];
    const std::string file = own.find(name, may_be_folder);
    if (file.size() >= N)
        throw Failure(std::string(name) + ": the name is too long");
    if (file_stamp(file) == "absent")
        throw Failure("cannot read " + file + ": No such file or directory" + retex_color_meant(name, meant));
    std::copy_n(file.c_str(), file.size() + 1, name);
}

// Finds wrong names of targets and missing files when the name is opened, not when pixels are read.
std::vector<RetexTextureSpec> find_textures(RetexEdit *edit, const RetexSet &set, const OwnFolder &own)
{
    RetexError err{};
    RetexTargetNames names;
    retex_set_target_names(&names, &set);
    must(retex_edit_bind(edit, &names, &err), err);
    std::vector<RetexTextureSpec> textures;
    for (int i = 0; i < retex_edit_count(edit); i++) {
        RetexTextureSpec texture = *retex_edit_texture(edit, i);
        if (!texture.constant && texture.image[0])
            find_file(texture.image, own, true);
        for (int k = 0; k < texture.nlayers; k++)
            find_file(texture.layers[k].image, own, true);
        if (texture.finish[0] && std::string(texture.finish) != "none")
            find_file(texture.finish, own, false);
        for (int k = 0; k < RETEX_TILES_MAX && texture.tiles[k][0]; k++)
            find_file(texture.tiles[k], own, true);
        texture.access = own.access();
        files_of(texture); // refuses a folder without a base colour
        texture.warn = print_warning;
        textures.push_back(texture);
    }
    return textures;
}

// The values of the set's parameters; empty where the edit has no lamps.
std::vector<float> find_parameters(RetexEdit *edit, const RetexSet &set)
{
    RetexError err{};
    if (!retex_edit_lights(edit))
        return {};
    must(retex_edit_bind_lamps(edit, &set, &err), err);
    std::vector<float> values(3 * size_t(retex_set_info(&set).nparameters));
    must(retex_edit_parameters(edit, &set, values.data(), &err), err);
    return values;
}

RetexDevelop find_develop(const RetexEdit *edit)
{
    RetexError err{};
    RetexDevelop develop = RETEX_DEVELOP_INIT;
    must(retex_edit_develop(edit, &develop, &err), err);
    return develop;
}

// The edit as the rest of a name.
std::string text_of(const RetexEdit *edit)
{
    RetexError err{};
    char *made = nullptr;
    must(retex_edit_text(edit, '&', &made, &err), err);
    const std::unique_ptr<char, void (*)(void *)> text(made, std::free);
    return made;
}

// ---- the source ----

struct Picture {
    RetexImage image{};
    std::string manifest; // manifest of the set with this picture as part 0; "" for a picture with other textures
    ~Picture()
    {
        retex_image_free(&image);
    }
};

// The set's part 0 is the picture that the plugin shows, so that a copy of all parts is a valid set.
void make_manifest(Picture &picture, const RetexSet &set)
{
    RetexError err{};
    char *made = nullptr;
    must(retex_set_picture_manifest(&set, &picture.image, &made, 1, &err), err);
    const std::unique_ptr<char, void (*)(void *)> text(made, std::free);
    picture.manifest = made;
}

class PackSource final : public Source
{
  public:
    PackSource(const std::string &path, const Arguments &arguments, int threads)
        : own_(path, wants_safe(arguments)), budget_(own_.access()->safe), edit_(parse_edit(arguments)),
          threads_(threads), stamp_(file_stamp(path)), set_(open_set(path))
    {
        const RetexSetInfo info = retex_set_info(&set_->description());
        budget_.check_size(info.width, info.height);
        textures_ = find_textures(edit_.get(), set_->description(), own_);
        parameters_ = find_parameters(edit_.get(), set_->description());
        develop_ = find_develop(edit_.get());
        for (const RetexTextureSpec &texture : textures_)
            for (const std::string &file : files_of(texture))
                stamp_ += " " + file_stamp(file);
        shown_ = text_of(edit_.get());
        key_ = (own_.access()->safe ? "safe:" : "") + path + "?" + shown_;
    }
    int count() override
    {
        return !is_edited() ? retex_set_info(&set_->description()).nparts : 1;
    }
    OIIO::ImageSpec spec(int index) override
    {
        const RetexSet &set = set_->description();
        if (index > 0)
            return part_spec(set, index);
        OIIO::ImageSpec spec =
            picture_spec(retex_set_info(&set), targets_of(set), is_edited() ? "" : picture().manifest);
        if (is_edited())
            spec.attribute("retex:textures", shown_);
        return spec;
    }
    Pixels pixels(int index) override
    {
        if (index == 0)
            return {picture().image, RETEX_FLOAT};
        const RetexPart &part = *retex_set_part(&set_->whole(threads_), index);
        return {part.image, part.type};
    }

  private:
    bool is_edited() const
    {
        return !textures_.empty() || !parameters_.empty() || is_developed(develop_);
    }
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
        picture->image = set_->picture(textures_, parameters_, develop_, budget_, threads_);
        if (!is_edited())
            make_manifest(*picture, set_->whole(threads_));
        return picture;
    }

    const OwnFolder own_;
    const Budget budget_;
    const Edit edit_;
    const int threads_;
    std::string key_, stamp_, shown_;
    const std::shared_ptr<PackSet> set_;
    std::vector<RetexTextureSpec> textures_;
    std::vector<float> parameters_;
    RetexDevelop develop_ = RETEX_DEVELOP_INIT;
    std::mutex mutex_;
    std::shared_ptr<Picture> picture_;
};

} // namespace

std::shared_ptr<Source> open_pack(const std::string &path, const Arguments &arguments, int threads)
{
    return std::make_shared<PackSource>(path, arguments, threads);
}

} // namespace plugins
