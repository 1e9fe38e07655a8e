// Safe access (retex/access.h) in names that a stranger may have written.
#ifndef OIIO_PLUGINS_OWN_FOLDER_HPP
#define OIIO_PLUGINS_OWN_FOLDER_HPP

#include <string>

#include <retex/access.h>

#include "set_input.hpp"

namespace plugins
{

// Whether a name asks for safe access, by safe and anything but 0, or the environment does, which a name cannot undo.
bool wants_safe(const Arguments &arguments);

// The folder that a scene or a pack lies in: with safe access all there is.
class OwnFolder
{
  public:
    OwnFolder(const std::string &path, bool safe);
    OwnFolder(const OwnFolder &) = delete;
    OwnFolder &operator=(const OwnFolder &) = delete;

    // A file of that name, or a folder, to be read later: the name itself, or with safe access one that stands for what
    // lies below. Throws Failure where there is none.
    std::string find(const std::string &name, bool wants_folder = false) const;
    const RetexAccess *access() const
    {
        return &access_;
    }

  private:
    std::string folder_, root_; // the second resolved
    const char *roots_[1];
    RetexAccess access_ = RETEX_ACCESS_INIT;
};

} // namespace plugins
#endif
