// The limits of reading one name: RETEX_MAX_MEMORY, RETEX_MAX_TIME, RETEX_MAX_PIXELS and RETEX_MAX_STEPS of the
// environment, with the defaults of the tools, with or without --safe.
#ifndef OIIO_PLUGINS_BUDGET_HPP
#define OIIO_PLUGINS_BUDGET_HPP

#include <retex/budget.h>

namespace plugins
{

class Budget
{
  public:
    explicit Budget(bool safe); // throws Failure if a number in the environment is invalid
    ~Budget();
    Budget(const Budget &) = delete;
    Budget &operator=(const Budget &) = delete;

    // Start the time limit. Call for each operation, because a host may wait between them.
    RetexBudget *begin() const;
    long steps() const
    {
        return limits_.steps;
    }
    // Throws Failure if a picture has too many pixels.
    void check_size(int width, int height) const;

  private:
    RetexLimits limits_ = RETEX_LIMITS_INIT;
    RetexBudget *budget_ = nullptr;
};

} // namespace plugins
#endif
