// How failures travel inside the plugins, and what keeps them from leaving.
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

// Throw what a call of libretex or the renderer says went wrong: "FILE:LINE:COLUMN: message". Nothing where it is 0.
void must(int code, const RetexError &err);

// Run body with numbers read and written as in C, whatever the host's language. "" or, where body throws, why.
std::string guarded(const std::function<void()> &body);

} // namespace plugins
#endif
