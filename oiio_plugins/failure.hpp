// Errors inside the plugins, and the guard that keeps exceptions from leaving them.
#ifndef OIIO_PLUGINS_FAILURE_HPP
#define OIIO_PLUGINS_FAILURE_HPP

#include <functional>
#include <stdexcept>
#include <string>

#include <retex/error.h>

namespace plugins
{

struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Throw the error of a call of libretex or the renderer, "FILE:LINE:COLUMN: message". Do nothing if the code is 0.
void must(int code, const RetexError &err);

// Run body with the C locale for numbers, whatever the host's locale. Return "", or the error if body throws.
std::string guarded(const std::function<void()> &body);

} // namespace plugins
#endif
