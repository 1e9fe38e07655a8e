/* Algebraic surfaces: a polynomial times the field strength, kept within a limit. The names are those of functions.inc,
 * where the parameters are described; p[3] is the field strength of all of them. */
#include "function/internal.h"

static double limited(double strength, double value, double limit)
{
    return fmin(limit, fmax(strength * value, -limit));
}

static double field(const double *p, double value)
{
    return limited(p[3], value, 10);
}

/* x and y of a plane curve: as they are, or, if the switch is on, in the plane through the y axis and the point, moved
 * by the offset and turned by the angle: a surface of revolution. */
typedef struct Plane {
    double x, y, x2, y2; /* with their squares */
} Plane;

static Plane plane_of(const double *p, const double *revolve /* switch, offset, angle in degrees */)
{
    double x = p[0], y = p[1];
    if (revolve[0] > 0) {
        const double angle = revolve[2] * (PI / 180), c = cos(angle), s = sin(angle);
        const double radius = sqrt(p[0] * p[0] + p[2] * p[2]) - revolve[1];
        x = radius * c - p[1] * s;
        y = radius * s + p[1] * c;
    }
    return (Plane){x, y, x * x, y * y};
}

#define MAY_BE_UNUSED __attribute__((unused))
#define SQUARES                                                                                                        \
    const double x MAY_BE_UNUSED = p[0], y MAY_BE_UNUSED = p[1], z MAY_BE_UNUSED = p[2];                               \
    const double x2 MAY_BE_UNUSED = x * x, y2 MAY_BE_UNUSED = y * y, z2 MAY_BE_UNUSED = z * z

/* A function that is one expression: of the revolved curve whose switch is parameter `at`; or of x, y and z. */
#define CURVE(name, at, value)                                                                                         \
    double internal_##name(const double *p)                                                                            \
    {                                                                                                                  \
        const Plane q = plane_of(p, p + at);                                                                           \
        return value;                                                                                                  \
    }
#define SURFACE(name, value)                                                                                           \
    double internal_##name(const double *p)                                                                            \
    {                                                                                                                  \
        SQUARES;                                                                                                       \
        return field(p, value);                                                                                        \
    }

/* ---- curves, which may be revolved ---- */

CURVE(algbr_cyl1, 5, -limited(p[3], -(q.x2 * fabs(q.x) - q.x2 + q.y2), p[4]))
CURVE(algbr_cyl2, 5, limited(p[3], -(2 * q.x2 * q.x2 - 3 * q.x2 * q.y + q.y2 - 2 * q.y2 * q.y + q.y2 * q.y2), p[4]))
CURVE(algbr_cyl3, 5, limited(p[3], -(q.x2 * q.x2 + q.x2 * q.y2 - 2 * q.x2 * q.y - q.x * q.y2 + q.y2), p[4]))
CURVE(devils_curve_2d, 6, field(p, -(q.x2 * (q.x2 - p[4] * p[4]) - q.y2 * (q.y2 - p[5] * p[5]))))
CURVE(folium_surface_2d, 6, field(p, -(q.y2 * (1 + (p[5] - 4 * p[4]) * q.x) + q.x2 * (1 + p[5]))))
CURVE(witch_of_agnesi_2d, 6, field(p, -(p[4] * p[4] * q.y + q.x2 * q.y - p[5])))

double internal_algbr_cyl4(const double *p)
{
    const Plane q = plane_of(p, p + 5);
    const double r2 = q.x2 + q.y2;
    return limited(p[3], -(r2 * r2 + 3 * q.x2 * q.y - q.y2 * q.y), p[4]);
}

double internal_kampyle_of_eudoxus_2d(const double *p)
{
    const Plane q = plane_of(p, p + 6);
    const double c2 = p[5] * p[5];
    return field(p, -(q.y2 - c2 * q.x2 * q.x2 + c2 * p[4] * p[5] * q.x2));
}

double internal_lemniscate_of_gerono_2d(const double *p)
{
    const Plane q = plane_of(p, p + 6);
    const double c2 = p[5] * p[5];
    return field(p, -(q.y2 - c2 * p[4] * p[4] * q.x2 + c2 * q.x2 * q.x2));
}

double internal_piriform_2d(const double *p)
{
    const Plane q = plane_of(p, p + 7);
    const double c2 = p[6] * p[6];
    return field(p, -(q.y2 - p[4] * c2 * q.x2 * q.x - p[5] * c2 * q.x2 * q.x2));
}

double internal_strophoid_2d(const double *p)
{
    const Plane q = plane_of(p, p + 7);
    const double c2 = p[6] * p[6];
    return field(p, -((p[5] - q.x) * q.y2 - c2 * p[4] * q.x2 - c2 * q.x2 * q.x));
}

/* ---- surfaces ---- */

SURFACE(crossed_trough, x2 * z2 - y)
SURFACE(cubic_saddle, z + y2 * y - x2 * x)
SURFACE(devils_curve, -(x2 * x2 + 2 * x2 * z2 - 0.36 * x2 - y2 * y2 + 0.25 * y2 + z2 * z2))
SURFACE(folium_surface, (y2 + z2) * (1 + (p[5] - 4 * p[4]) * x) + x2 * (1 + p[5]))
SURFACE(glob, 0.5 * x2 * x2 * x + 0.5 * x2 * x2 - (y2 + z2))
SURFACE(kummer_surface_v1, -(x2 * x2 + y2 * y2 + z2 * z2 - x2 - y2 - z2 - x2 * y2 - x2 * z2 - y2 * z2 + 1))
SURFACE(kummer_surface_v2, -(x2 * x2 + y2 * y2 + z2 * z2 + p[4] * (x2 + y2 + z2) + p[5] * (x2 * y2 + x2 * z2 + y2 * z2)
        + p[6] * x * y * z - 1))
SURFACE(lemniscate_of_gerono, -(x2 * x2 - x2 + y2 + z2))
SURFACE(mitre, y2 * (1 - y2 - z2) - 4 * x2 * (x2 + y2 + z2))
SURFACE(nodal_cubic, 6 * y * z - y2 * y - z2 * z)
SURFACE(paraboloid, y - x2 - z2)
SURFACE(pillow, x2 * x2 + y2 * y2 + z2 * z2 - (x2 + y2 + z2))
SURFACE(quartic_paraboloid, y - x2 * x2 - z2 * z2)
SURFACE(quartic_saddle, y + z2 * z2 - x2 * x2)
SURFACE(steiners_roman, -(x2 * y2 + x2 * z2 + y2 * z2 + x * y * z))
SURFACE(umbrella, y * z2 - x2)
SURFACE(witch_of_agnesi, -(p[4] * (y - 1) + (x2 + z2) * y))

double internal_bicorn(const double *p)
{
    SQUARES;
    const double a = p[4], across = x2 + z2, b = across + 2 * a * y - a * a;
    return field(p, y2 * (a * a - across) - b * b);
}

double internal_bifolia(const double *p)
{
    SQUARES;
    const double r2 = x2 + y2 + z2;
    return field(p, -(r2 * r2 - p[4] * (x2 + z2) * y));
}

double internal_boy_surface(const double *p)
{
    SQUARES;
    const double w = 1 - z, r2 = x2 + y2, root = sqrt(2.0);
    const double cubic = 64 * w * w * w * z2 * z;
    const double quadratic = -48 * w * w * z2 * (3 * r2 + 2 * z2);
    const double linear = 12 * w * z * (27 * r2 * r2 - 24 * z2 * r2 + 36 * root * y * z * (y2 - 3 * x2) + 4 * z2 * z2);
    const double rest =
        (9 * r2 - 2 * z2) * (-81 * r2 * r2 - 72 * z2 * r2 + 108 * root * x * z * (x2 - 3 * y2) + 4 * z2 * z2);
    return field(p, p[4] * (cubic + quadratic + linear + rest));
}

double internal_cushion(const double *p)
{
    SQUARES;
    const double bend = x2 - z;
    return field(p, z2 * x2 - z2 * z2 - 2 * z * x2 + 2 * z2 * z + x2 - z2 - bend * bend - y2 * y2 - 2 * x2 * y2 -
                        y2 * z2 + 2 * y2 * z + y2);
}

double internal_odd(const double *p)
{
    return internal_cushion(p);
}

double internal_dupin_cyclid(const double *p)
{
    SQUARES;
    const double major = p[4], minor2 = p[5] * p[5], dx = p[6], dy = p[7], i2 = p[8] * p[8];
    const double base = minor2 - dy * dy, outer = base - (dx + major) * (dx + major),
                 inner = base - (dx - major) * (dx - major), r2 = x2 + y2 + z2;
    const double middle = (base - dx * dx + major * major) * (2 * x * dx + 2 * y * dy - i2) - 4 * dy * minor2 * y;
    return field(p, -(outer * inner * r2 * r2 + 2 * i2 * middle * r2 +
                      4 * i2 * i2 * (dx * x + dy * y) * (dy * y + dx * x - i2) + 4 * i2 * i2 * major * major * y2 +
                      i2 * i2 * i2 * i2));
}

/* POV-Ray's fractions 2/3, 1/4 and 2/9 are divisions of whole numbers: 0. */
double internal_enneper(const double *p)
{
    SQUARES;
    const double depth = fabs(z) < 0.2 ? 0.2 : z;
    const double a = (y2 - x2) / (2 * depth) + 2 * z2 / 9, b = (y2 - x2) / (4 * depth);
    return field(p, 6 * b * b - a * a * a);
}

double internal_heart(const double *p)
{
    SQUARES;
    const double a = 2 * x2 + y2 + z2 - 1;
    return field(p, -(a * a * a - 0.1 * x2 * z2 * z - y2 * z2 * z));
}

double internal_hunt_surface(const double *p)
{
    SQUARES;
    const double a = x2 + y2 + z2 - 13, b = 3 * x2 + y2 - 4 * z2 - 12;
    return field(p, -(4 * a * a * a + 27 * b * b));
}

double internal_hyperbolic_torus(const double *p)
{
    SQUARES;
    const double sum = p[4] * p[4] + p[5] * p[5], difference = p[4] * p[4] - p[5] * p[5], a = x2 + y2 - z2;
    return field(p, -(a * a - 2 * sum * (x2 - z2) + 2 * difference * y2 + difference * difference));
}

double internal_kampyle_of_eudoxus(const double *p)
{
    SQUARES;
    const double c2 = p[5] * p[5];
    return field(p, -(y2 + z2 - c2 * x2 * x2 + c2 * p[4] * p[4] * x2));
}

double internal_klein_bottle(const double *p)
{
    SQUARES;
    const double above = x2 + y2 + z2 + 2 * y - 1, below = x2 + y2 + z2 - 2 * y - 1;
    return field(p, -(above * (below * below - 8 * z2) + 16 * x * z * below));
}

double internal_ovals_of_cassini(const double *p)
{
    SQUARES;
    const double major2 = p[4] * p[4], a = x2 + y2 + z2 + major2;
    return field(p, -(a * a - p[6] * major2 * (x2 + z2) - p[5] * p[5]));
}

double internal_parabolic_torus(const double *p)
{
    SQUARES;
    const double sum = p[4] * p[4] + p[5] * p[5], difference = p[4] * p[4] - p[5] * p[5];
    return field(p, -(x2 * x2 + 2 * x2 * y2 - 2 * x2 * z - sum * x2 + y2 * y2 - 2 * y2 * z + difference * y2 + z2 +
                      sum * z + difference * difference));
}

double internal_piriform(const double *p)
{
    SQUARES;
    return -field(p, -(x2 * x2 - x2 * x + y2 + z2));
}

double internal_quartic_cylinder(const double *p)
{
    SQUARES;
    const double b2 = p[5] * p[5];
    return field(p, -((x2 + z2) * y2 + b2 * (x2 + z2) - b2 * p[4] * p[4]));
}

double internal_strophoid(const double *p)
{
    SQUARES;
    const double c2 = p[6] * p[6];
    return field(p, -((p[5] - x) * (y2 + z2) - c2 * p[4] * x2 - c2 * x2 * x));
}

double internal_torus2(const double *p)
{
    SQUARES;
    const double sum = p[4] * p[4] + p[5] * p[5], difference = p[4] * p[4] - p[5] * p[5], r2 = x2 + y2 + z2;
    return field(p, -(r2 * r2 - 2 * sum * (x2 + z2) + 2 * difference * y2 + difference * difference));
}

double internal_torus_gumdrop(const double *p)
{
    SQUARES;
    const double r2 = y2 + z2;
    return field(p, -(4 * (x2 * x2 + r2 * r2) + 17 * x2 * r2 - 20 * (x2 + r2) + 17));
}
