// See set_input.hpp. No exception leaves a function that OpenImageIO calls.
#include "set_input.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <unistd.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>
#include <retex/set_file.h>

#include "failure.hpp"
#include "own_folder.hpp"

namespace plugins
{
namespace
{

// Decode %25, %26 and %3B to %, & and ;, because an & ends the value of an option, and a ; ends it in other texts of
// edits.
std::string unescaped(const std::string &text)
{
    static const std::map<std::string, char> codes = {{"%25", '%'}, {"%26", '&'}, {"%3B", ';'}, {"%3b", ';'}};
    std::string plain;
    for (size_t i = 0; i < text.size(); i++) {
        const auto code = codes.find(text.substr(i, 3));
        plain += code == codes.end() ? text[i] : code->second;
        i += code == codes.end() ? 0 : 2;
    }
    return plain;
}

// Replaces a name with options that cannot be opened. oiiotool reports any failed open as a missing file, so this
// source opens, and reports the error when pixels are read.
class Unreadable final : public Source
{
  public:
    explicit Unreadable(const std::string &why) : why_(why)
    {
    }
    int count() override
    {
        return 1;
    }
    OIIO::ImageSpec spec(int) override
    {
        OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::FLOAT);
        spec.attribute("retex:error", why_);
        return spec;
    }
    Pixels pixels(int) override
    {
        throw Failure(why_);
    }

  private:
    const std::string why_;
};

class SetInput final : public OIIO::ImageInput
{
  public:
    explicit SetInput(const Format &format) : format_(format)
    {
    }
    const char *format_name() const override
    {
        return format_.name;
    }
    int supports(OIIO::string_view feature) const override
    {
        return feature == "arbitrary_metadata";
    }
    bool valid_file(const std::string &name) const override
    {
        return guarded([&] { check_content(split(name)); }).empty();
    }
    bool open(const std::string &name, OIIO::ImageSpec &spec) override
    {
        return entry([&] {
            Name parts = split(name);
            close();
            source_ = open_source(parts);
            seek(0);
            spec = m_spec;
        });
    }
    bool close() override
    {
        source_.reset();
        current_ = -1;
        return true;
    }
    int current_subimage() const override
    {
        lock_guard lock(*this);
        return current_ < 0 ? 0 : current_;
    }
    // OpenImageIO counts subimages by seeking until that fails, so it is not an error.
    bool seek_subimage(int subimage, int miplevel) override
    {
        lock_guard lock(*this);
        bool there = false;
        bool done = entry([&] {
            there = source_ && miplevel == 0 && subimage >= 0 && (subimage == 0 || subimage < source_->count());
            if (there)
                seek(subimage);
        });
        return done && there;
    }
    bool read_native_scanline(int subimage, int miplevel, int y, int, void *data) override
    {
        lock_guard lock(*this);
        if (!seek_subimage(subimage, miplevel))
            return false;
        return entry([&] {
            const Pixels pixels = source_->pixels(subimage);
            if (y < 0 || y >= pixels.image.height)
                throw Failure("there is no line " + std::to_string(y) + " in subimage " + std::to_string(subimage));
            retex_image_stored_row(&pixels.image, pixels.type, y, data);
        });
    }

  private:
    struct Name {
        std::string path;
        Arguments arguments;
    };

    Name split(const std::string &name) const
    {
        Name parts;
        if (!OIIO::Strutil::get_rest_arguments(name, parts.path, parts.arguments))
            throw Failure(name + ": expected option=value and & between options behind the ?");
        if (!OIIO::Strutil::iequals(OIIO::Filesystem::extension(parts.path, false), format_.name))
            throw Failure(parts.path + ": no ." + format_.name + " file");
        for (auto &argument : parts.arguments)
            argument.second = unescaped(argument.second);
        return parts;
    }
    std::shared_ptr<Source> open_source(const Name &name) const
    {
        if (name.arguments.empty()) {
            check_content(name);
            return format_.open(name.path, name.arguments, host_threads());
        }
        read_begin(name);
        try {
            check_content(name);
            return format_.open(name.path, name.arguments, host_threads());
        } catch (const std::exception &e) {
            return std::make_shared<Unreadable>(e.what());
        }
    }
    static std::string read_begin(const Name &name)
    {
        char begin[64];
        RetexError err{};
        RetexAccess access = RETEX_ACCESS_INIT;
        int descriptor = -1;
        access.safe = wants_safe(name.arguments);
        must(retex_access_open(&access, name.path.c_str(), &descriptor, &err), err);
        std::unique_ptr<FILE, int (*)(FILE *)> file(fdopen(descriptor, "rb"), std::fclose);
        if (!file)
            ::close(descriptor);
        size_t got = file ? std::fread(begin, 1, sizeof begin, file.get()) : 0;
        if (!file || std::ferror(file.get()))
            throw Failure("cannot read " + name.path + ": " + std::strerror(errno));
        return std::string(begin, got);
    }
    // OpenImageIO tries every plugin on files of unknown type.
    void check_content(const Name &name) const
    {
        std::string begin = read_begin(name);
        if (!format_.probe(begin.data(), begin.size()))
            throw Failure(name.path + ": no ." + format_.name + " file" +
                          (begin.empty() ? ": it is empty" : " by what is in it"));
    }
    // The number of threads that the host allows OpenImageIO; 0 = all cores.
    int host_threads() const
    {
        return threads() > 0 ? threads() : OIIO::get_int_attribute("threads");
    }
    void seek(int subimage)
    {
        if (subimage == current_)
            return;
        m_spec = source_->spec(subimage);
        current_ = subimage;
    }
    bool entry(const std::function<void()> &body)
    {
        std::string why = guarded(body);
        if (!why.empty())
            errorfmt("{}", why);
        return why.empty();
    }

    const Format &format_;
    std::shared_ptr<Source> source_;
    int current_ = -1;
};

} // namespace

OIIO::ImageInput *create_input(const Format &format)
{
    return new SetInput(format);
}

} // namespace plugins
