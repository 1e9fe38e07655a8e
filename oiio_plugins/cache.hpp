// A cache of expensive results. OpenImageIO opens a name up to twelve times to read it once.
#ifndef OIIO_PLUGINS_CACHE_HPP
#define OIIO_PLUGINS_CACHE_HPP

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include <sys/stat.h>

namespace plugins
{

// Identifies the state of a file; "absent" if it does not exist.
inline std::string file_stamp(const std::string &path)
{
    struct stat s;
    if (stat(path.c_str(), &s) != 0)
        return "absent";
    return std::to_string(s.st_dev) + "." + std::to_string(s.st_ino) + "." + std::to_string(s.st_size) + "." +
           std::to_string(s.st_mtim.tv_sec) + "." + std::to_string(s.st_mtim.tv_nsec);
}

// Keeps a few values, those used last. Each value is computed once, also if several threads request it. A value lives
// while it is used. `make` may use other keys and other caches, but not its own key.
template <typename Value> class Cache
{
  public:
    using Pointer = std::shared_ptr<Value>;

    explicit Cache(size_t most) : most_(most)
    {
    }
    // stamp: the state of the value's sources; the value is computed again if it changes. An exception of `make` goes
    // to the caller, and the next call tries again.
    Pointer get(const std::string &key, const std::string &stamp, const std::function<Pointer()> &make)
    {
        std::shared_ptr<Slot> slot = find(key, stamp);
        std::lock_guard<std::mutex> lock(slot->making);
        if (!slot->value)
            slot->value = make();
        return slot->value;
    }

  private:
    struct Slot {
        std::string key, stamp;
        std::mutex making;
        Pointer value;
    };

    std::shared_ptr<Slot> find(const std::string &key, const std::string &stamp)
    {
        std::lock_guard<std::mutex> lock(mutex_);
        for (auto at = slots_.begin(); at != slots_.end(); ++at) {
            if ((*at)->key != key)
                continue;
            if ((*at)->stamp != stamp) {
                slots_.erase(at);
                break;
            }
            slots_.splice(slots_.begin(), slots_, at);
            return slots_.front();
        }
        auto slot = std::make_shared<Slot>();
        slot->key = key;
        slot->stamp = stamp;
        slots_.push_front(slot);
        if (slots_.size() > most_)
            slots_.pop_back();
        return slot;
    }

    const size_t most_;
    std::mutex mutex_;
    std::list<std::shared_ptr<Slot>> slots_; // most recently used first
};

} // namespace plugins
#endif
