// What both plugins are to OpenImageIO: a file of a set's parts, one after another.
#ifndef OIIO_PLUGINS_SET_INPUT_HPP
#define OIIO_PLUGINS_SET_INPUT_HPP

#include <map>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>

#include <retex/set.h>

namespace plugins
{

// What was said behind the `?` of a name, in the order of the alphabet.
using Arguments = std::map<std::string, std::string>;

// What a name stands for. Any thread may ask.
class Source
{
  public:
    virtual ~Source() = default;
    virtual int count() = 0; // of parts
    virtual OIIO::ImageSpec spec(int index) = 0;
    virtual const RetexPart &part(int index) = 0; // with its pixels
};

struct Format {
    const char *name; // and the ending of its files
    // Whether these are the first bytes of such a file.
    bool (*probe)(const void *data, size_t bytes);
    // threads: 0 = all cores. Throws Failure.
    std::shared_ptr<Source> (*open)(const std::string &path, const Arguments &arguments, int threads);
};

OIIO::ImageInput *create_input(const Format &format);

// Describe a part; the subimage's name, its channels and what it is in the set.
OIIO::ImageSpec part_spec(const RetexSet &set, int index);
// Say of a picture where it comes from. manifest may be "".
void describe_picture(OIIO::ImageSpec &spec, const RetexSet &set, const std::string &manifest);
// The manifest of a set all of whose checksums are known.
std::string manifest_of(const RetexSet &set);

} // namespace plugins
#endif
