// See own_folder.hpp.
#include "own_folder.hpp"

#include <cstdlib>
#include <memory>

#include "failure.hpp"

namespace plugins
{

bool wants_safe(const Arguments &arguments)
{
    auto said = arguments.find("safe");
    return retex_access_safe_requested() || (said != arguments.end() && said->second != "0");
}

OwnFolder::OwnFolder(const std::string &path, bool safe)
{
    size_t slash = path.rfind('/');
    folder_ = slash == std::string::npos ? "" : path.substr(0, slash + 1);
    std::unique_ptr<char, void (*)(void *)> resolved(realpath(folder_.empty() ? "." : folder_.c_str(), nullptr),
                                                     std::free);
    root_ = resolved ? resolved.get() : "";
    roots_[0] = root_.c_str();
    access_.accept_damaged = retex_access_damage_accepted();
    if (!safe)
        return;
    access_.safe = 1;
    access_.roots = roots_;
    access_.nroots = resolved ? 1 : 0;
}

std::string OwnFolder::find(const std::string &name, bool wants_folder) const
{
    if (!access_.safe)
        return name;
    switch (retex_access_check(&access_, folder_.c_str(), name.c_str())) {
    case RETEX_ACCESS_ABSENT:
        throw Failure("cannot read " + name + ": No such file or directory");
    case RETEX_ACCESS_OUTSIDE:
        throw Failure(name + " is outside the folder of the file that is read, the only one that may be (--safe)");
    case RETEX_ACCESS_IRREGULAR:
        if (!wants_folder)
            throw Failure(name + " is a folder, a device or a pipe: only files are read (--safe)");
        break;
    case RETEX_ACCESS_ALLOWED:
        break;
    }
    return name.compare(0, 1, "/") == 0 ? name : folder_ + name;
}

} // namespace plugins
