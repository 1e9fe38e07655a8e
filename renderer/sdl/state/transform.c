/* Transforms: translate, rotate, scale, matrix, transform. */
#include <string.h>
#include "sdl/state/builder.h"

int transform_is_identity(const Transform *t)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            if (t->m[i][j] != (i == j))
                return 0;
    return 1;
}

static Transform matrix(Sdl *sdl)
{
    double values[12];
    sdl_expect(sdl, "<");
    for (int i = 0; i < 12; i++) {
        values[i] = sdl_float(sdl);
        sdl_optional_comma(sdl);
    }
    sdl_expect(sdl, ">");
    Transform t;
    if (!transform_matrix(values, &t))
        sdl_error(sdl, "this matrix flattens space: it has no inverse");
    return t;
}

static Vec3 scale_vector(Sdl *sdl)
{
    Vec3 by = sdl_vector(sdl);
    if (by.x == 0 || by.y == 0 || by.z == 0)
        sdl_warn(sdl, "scale by 0 is taken as scale by 1");
    return by;
}

static Transform checked(Sdl *sdl, Transform t)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            if (!isfinite(t.m[i][j]) || !isfinite(t.inverse[i][j])) {
                sdl_warn(sdl, "a transform with values that are not finite is left out");
                return transform_identity();
            }
    return t;
}

/* After `transform`: an identifier, or a block of transforms, in which `inverse` turns the whole around. */
Transform parse_transform(Sdl *sdl)
{
    const Transform *known = accept_ident(sdl, VALUE_TRANSFORM);
    if (known)
        return *known;
    Transform all = transform_identity(), by;
    int inverse = 0;
    statement_begin(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "inverse"))
            inverse = 1;
        else if ((known = accept_ident(sdl, VALUE_TRANSFORM)))
            all = transform_then(all, *known);
        else if (accept_transform(sdl, &by))
            all = transform_then(all, by);
        else
            sdl_expected(sdl, "a transform");
        sdl_optional_comma(sdl);
    }
    statement_end(sdl);
    return inverse ? transform_inverse(all) : all;
}

int accept_transform(Sdl *sdl, Transform *by)
{
    if (sdl_peek(sdl)->kind != TOKEN_WORD)
        return 0;
    if (sdl_accept(sdl, "translate"))
        *by = transform_translate(sdl_vector(sdl));
    else if (sdl_accept(sdl, "rotate"))
        *by = transform_rotate(sdl_vector(sdl));
    else if (sdl_accept(sdl, "scale"))
        *by = transform_scale(scale_vector(sdl));
    else if (sdl_accept(sdl, "matrix"))
        *by = matrix(sdl);
    else if (sdl_accept(sdl, "transform"))
        *by = parse_transform(sdl);
    else
        return 0;
    *by = checked(sdl, *by);
    return 1;
}
