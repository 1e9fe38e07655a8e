// The ImageInput of both plugins: a file whose subimages are the parts of a set.
#ifndef OIIO_PLUGINS_SET_INPUT_HPP
#define OIIO_PLUGINS_SET_INPUT_HPP

#include <map>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>

#include <retex/set.h>

namespace plugins
{

// The options after the `?` of a name, sorted by name.
using Arguments = std::map<std::string, std::string>;

// An image, and the type in which its rows are given.
struct Pixels {
    const RetexImage &image;
    RetexPixelType type;
};

// The content of an opened name. All calls are thread-safe.
class Source
{
  public:
    virtual ~Source() = default;
    virtual int count() = 0; // number of parts
    virtual OIIO::ImageSpec spec(int index) = 0;
    virtual Pixels pixels(int index) = 0;
};

struct Format {
    const char *name; // also the ending of its files
    // Whether a file of this format can begin with these bytes.
    bool (*probe)(const void *data, size_t bytes);
    // threads: 0 = all cores. Throws Failure.
    std::shared_ptr<Source> (*open)(const std::string &path, const Arguments &arguments, int threads);
};

OIIO::ImageInput *create_input(const Format &format);

// Describe a part: the subimage's name, its channels and its role in the set.
OIIO::ImageSpec part_spec(const RetexSet &set, int index);
// Describe a set's picture, and where it comes from. targets: their names, with commas between. Both texts may be "".
OIIO::ImageSpec picture_spec(const RetexSetInfo &info, const std::string &targets, const std::string &manifest);
std::string targets_of(const RetexSet &set);
// The manifest of a set whose checksums are all known.
std::string manifest_of(const RetexSet &set);

} // namespace plugins
#endif
