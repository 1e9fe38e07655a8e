// Safe access (retex/access.h) for names from untrusted authors.
#ifndef OIIO_PLUGINS_OWN_FOLDER_HPP
#define OIIO_PLUGINS_OWN_FOLDER_HPP

#include <string>

#include <retex/access.h>

#include "set_input.hpp"

namespace plugins
{

// Whether access is safe: the name has `safe` with a value other than 0, or the environment sets it. A name cannot
// override the environment.
bool wants_safe(const Arguments &arguments);

// The folder of a scene or a pack. With safe access, files are read only below it.
class OwnFolder
{
  public:
    OwnFolder(const std::string &path, bool safe);
    OwnFolder(const OwnFolder &) = delete;
    OwnFolder &operator=(const OwnFolder &) = delete;

    // Resolve the name of a file or folder to read later: the name itself, or with safe access the path below the
    // folder. Throws Failure if it does not exist there.
    std::string find(const std::string &name, bool wants_folder = false) const;
    const RetexAccess *access() const
    {
        return &access_;
    }

  private:
    std::string folder_, root_; // root_ is folder_ with links resolved
    const char *roots_[1];
    RetexAccess access_ = RETEX_ACCESS_INIT;
};

} // namespace plugins
#endif
