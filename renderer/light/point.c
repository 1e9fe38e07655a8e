/* Light sources that shine from a point in all directions. */
#include "light/source.h"

const LightOps light_point = {
    .name = "point", .properties = LIGHT_SHADOWLESS, .shine = point_shine, .meet = point_meet};
