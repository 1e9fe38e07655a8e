/* See mesh.h. */
#include "import/base/mesh.h"

#include <math.h>

int mesh_is_finite(const struct aiVector3D *v)
{
    return isfinite(v->x) && isfinite(v->y) && isfinite(v->z);
}

int mesh_is_surface(const struct aiMesh *mesh, const struct aiFace *face)
{
    const struct aiVector3D *p[3];
    if (face->mNumIndices != 3)
        return 0;
    for (int k = 0; k < 3; k++) {
        if (face->mIndices[k] >= mesh->mNumVertices)
            return 0;
        p[k] = &mesh->mVertices[face->mIndices[k]];
        if (!mesh_is_finite(p[k]))
            return 0;
    }
    for (int k = 0; k < 3; k++) {
        const struct aiVector3D *a = p[k], *b = p[(k + 1) % 3];
        if (a->x == b->x && a->y == b->y && a->z == b->z)
            return 0;
    }
    return 1;
}

int mesh_has_surface(const struct aiMesh *mesh)
{
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        if (mesh_is_surface(mesh, &mesh->mFaces[i]))
            return 1;
    return 0;
}

int mesh_bounds(const struct aiMesh *mesh, double low[3], double high[3])
{
    int any = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        if (!mesh_is_surface(mesh, &mesh->mFaces[i]))
            continue;
        for (int k = 0; k < 3; k++) {
            const struct aiVector3D *v = &mesh->mVertices[mesh->mFaces[i].mIndices[k]];
            const double p[3] = {(double)v->x, (double)v->y, -(double)v->z};
            for (int j = 0; j < 3; j++) {
                low[j] = any ? fmin(low[j], p[j]) : p[j];
                high[j] = any ? fmax(high[j], p[j]) : p[j];
            }
            any = 1;
        }
    }
    return any;
}

int mesh_has_colors(const struct aiMesh *mesh)
{
    const struct aiColor4D *c = mesh->mColors[0];
    for (unsigned i = 0; c && i < mesh->mNumVertices; i++)
        if (c[i].r < 0.999f || c[i].g < 0.999f || c[i].b < 0.999f)
            return 1;
    return 0;
}

/* ---- */
