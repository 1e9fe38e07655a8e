// See budget.hpp.
#include "budget.hpp"

#include <string>

#include "failure.hpp"

namespace plugins
{

Budget::Budget(bool safe)
{
    RetexError err{};
    must(retex_limits_environment(&limits_, &err), err);
    if (safe)
        retex_limits_safe(&limits_);
    must(retex_budget_create(&budget_, &err), err);
    retex_budget_set_limits(budget_, &limits_);
}

Budget::~Budget()
{
    retex_budget_close(&budget_);
}

RetexBudget *Budget::begin() const
{
    retex_budget_set_seconds(budget_, limits_.seconds);
    return budget_;
}

void Budget::check_size(int width, int height) const
{
    if (limits_.pixels && long(width) * height > limits_.pixels)
        throw Failure("the picture is too large: " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels, more than the " + std::to_string(limits_.pixels) + " of --max-pixels");
}

} // namespace plugins
