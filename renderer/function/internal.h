/* Private to renderer/function: the functions that functions.inc declares by `internal(N)`. */
#ifndef RENDERER_FUNCTION_INTERNAL_H
#define RENDERER_FUNCTION_INTERNAL_H

#include "function/function.h"

/* p: x, y, z and the parameters that functions.inc describes. */
typedef double InternalFunction(const double *p);

/* By number, name and count of arguments. internal_surfaces.c has polynomials of x, y and z, internal_solids.c the rest
 * but for noise. */
#define INTERNAL_SURFACES(X)                                                                                           \
    X(0, algbr_cyl1, 8)                                                                                                \
    X(1, algbr_cyl2, 8)                                                                                                \
    X(2, algbr_cyl3, 8)                                                                                                \
    X(3, algbr_cyl4, 8)                                                                                                \
    X(4, bicorn, 5)                                                                                                    \
    X(5, bifolia, 5)                                                                                                   \
    X(8, boy_surface, 5)                                                                                               \
    X(11, crossed_trough, 4)                                                                                           \
    X(12, cubic_saddle, 4)                                                                                             \
    X(13, cushion, 4)                                                                                                  \
    X(14, devils_curve, 4)                                                                                             \
    X(15, devils_curve_2d, 9)                                                                                          \
    X(16, dupin_cyclid, 9)                                                                                             \
    X(18, enneper, 4)                                                                                                  \
    X(20, folium_surface, 6)                                                                                           \
    X(21, folium_surface_2d, 9)                                                                                        \
    X(22, glob, 4)                                                                                                     \
    X(23, heart, 4)                                                                                                    \
    X(30, hunt_surface, 4)                                                                                             \
    X(31, hyperbolic_torus, 6)                                                                                         \
    X(33, kampyle_of_eudoxus, 6)                                                                                       \
    X(34, kampyle_of_eudoxus_2d, 9)                                                                                    \
    X(35, klein_bottle, 4)                                                                                             \
    X(36, kummer_surface_v1, 4)                                                                                        \
    X(37, kummer_surface_v2, 7)                                                                                        \
    X(38, lemniscate_of_gerono, 4)                                                                                     \
    X(39, lemniscate_of_gerono_2d, 9)                                                                                  \
    X(41, mitre, 4)                                                                                                    \
    X(42, nodal_cubic, 4)                                                                                              \
    X(43, odd, 4)                                                                                                      \
    X(44, ovals_of_cassini, 7)                                                                                         \
    X(45, paraboloid, 4)                                                                                               \
    X(46, parabolic_torus, 6)                                                                                          \
    X(48, pillow, 4)                                                                                                   \
    X(49, piriform, 4)                                                                                                 \
    X(50, piriform_2d, 10)                                                                                             \
    X(54, quartic_paraboloid, 4)                                                                                       \
    X(55, quartic_saddle, 4)                                                                                           \
    X(56, quartic_cylinder, 6)                                                                                         \
    X(65, steiners_roman, 4)                                                                                           \
    X(66, strophoid, 7)                                                                                                \
    X(67, strophoid_2d, 10)                                                                                            \
    X(71, torus2, 6)                                                                                                   \
    X(72, torus_gumdrop, 4)                                                                                            \
    X(73, umbrella, 4)                                                                                                 \
    X(74, witch_of_agnesi, 5)                                                                                          \
    X(75, witch_of_agnesi_2d, 9)
#define INTERNAL_SOLIDS(X)                                                                                             \
    X(6, blob, 8)                                                                                                      \
    X(7, blob2, 7)                                                                                                     \
    X(9, comma, 4)                                                                                                     \
    X(10, cross_ellipsoids, 7)                                                                                         \
    X(17, ellipsoid, 6)                                                                                                \
    X(19, flange_cover, 7)                                                                                             \
    X(24, helical_torus, 13)                                                                                           \
    X(25, helix1, 10)                                                                                                  \
    X(26, helix2, 10)                                                                                                  \
    X(27, hex_x, 4)                                                                                                    \
    X(28, hex_y, 4)                                                                                                    \
    X(32, isect_ellipsoids, 7)                                                                                         \
    X(40, mesh1, 8)                                                                                                    \
    X(47, ph, 3)                                                                                                       \
    X(51, poly4, 8)                                                                                                    \
    X(52, polytubes, 9)                                                                                                \
    X(53, quantum, 4)                                                                                                  \
    X(57, r, 3)                                                                                                        \
    X(60, rounded_box, 7)                                                                                              \
    X(61, sphere, 4)                                                                                                   \
    X(62, spikes, 8)                                                                                                   \
    X(63, spikes_2d, 7)                                                                                                \
    X(64, spiral, 9)                                                                                                   \
    X(68, superellipsoid, 5)                                                                                           \
    X(69, th, 3)                                                                                                       \
    X(70, torus, 5)
/* The last argument of all but the first is a generator. */
#define INTERNAL_NOISES(X)                                                                                             \
    X(29, hetero_mf, 9)                                                                                                \
    X(58, ridge, 9)                                                                                                    \
    X(59, ridged_mf, 9)                                                                                                \
    X(78, noise_generator, 4)

#define X(number, name, count) InternalFunction internal_##name;
INTERNAL_SURFACES(X)
INTERNAL_SOLIDS(X)
INTERNAL_NOISES(X)
#undef X

#endif
