// See failure.hpp.
#include "failure.hpp"

#include <clocale>
#include <new>

#include <locale.h>

namespace plugins
{
namespace
{

// Sets the thread's locale to C during its lifetime.
class PlainNumbers
{
  public:
    PlainNumbers()
    {
        static const locale_t plain = newlocale(LC_ALL_MASK, "C", locale_t(0));
        before_ = plain ? uselocale(plain) : locale_t(0);
    }
    ~PlainNumbers()
    {
        if (before_)
            uselocale(before_);
    }
    PlainNumbers(const PlainNumbers &) = delete;
    PlainNumbers &operator=(const PlainNumbers &) = delete;

  private:
    locale_t before_;
};

} // namespace

void must(int code, const RetexError &err)
{
    if (!code)
        return;
    std::string place = err.file;
    if (!place.empty() && err.line)
        place += ":" + std::to_string(err.line) + (err.column ? ":" + std::to_string(err.column) : "");
    throw Failure(place.empty() ? err.message : place + ": " + err.message);
}

std::string guarded(const std::function<void()> &body)
{
    try {
        PlainNumbers plain;
        body();
        return "";
    } catch (const std::bad_alloc &) {
        return "not enough memory";
    } catch (const std::exception &e) {
        return *e.what() ? e.what() : "an unknown failure";
    } catch (...) {
        return "an unknown failure";
    }
}

} // namespace plugins
