// What is dear to make and asked for again and again: OpenImageIO opens one name up to twelve times to read it once.
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

// Tells one state of a file from another; "absent" where there is none.
inline std::string file_stamp(const std::string &path)
{
    struct stat s;
    if (stat(path.c_str(), &s) != 0)
        return "absent";
    return std::to_string(s.st_dev) + "." + std::to_string(s.st_ino) + "." + std::to_string(s.st_size) + "." +
           std::to_string(s.st_mtim.tv_sec) + "." + std::to_string(s.st_mtim.tv_nsec);
}

// The values last used, few of them, each made once however many threads ask for it. A value lives on while it is used.
// make may use other keys and other caches, never its own key again.
template <typename Value> class Cache
{
  public:
    using Pointer = std::shared_ptr<Value>;

    explicit Cache(size_t most) : most_(most)
    {
    }
    // stamp: the state of what the value is made of; with another one the value is made anew. Whatever make throws goes
    // to the caller, and the next one tries again.
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
    std::list<std::shared_ptr<Slot>> slots_; // the last used first
};

} // namespace plugins
#endif
