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

// The content of an opened name. All calls are thread-safe.
class Source
{
  public:
    virtual ~Source() = default;
    virtual int count() = 0; // number of parts
    virtual OIIO::ImageSpec spec(int index) = 0;
    virtual const RetexPart &part(int index) = 0; // includes its pixels
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
// Add the attributes that tell where a picture comes from. manifest may be "".
void describe_picture(OIIO::ImageSpec &spec, const RetexSet &set, const std::string &manifest);
// The manifest of a set whose checksums are all known.
std::string manifest_of(const RetexSet &set);

} // namespace plugins
#endif
