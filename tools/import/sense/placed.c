/* All triangles that a scene places, in one Space. */
#include <math.h>
#include <stdlib.h>

#include "import/base/mesh.h"
#include "import/base/tell.h"
#include "import/base/world.h"
#include "import/sense/sense.h"
#include "import/space/space.h"

enum { MOST_TRIANGLES = 6000000 };

typedef struct Placed {
    SpaceTriangles triangles;
    uint32_t *materials;
    size_t nobjects;
    int is_counting; /* first all is counted, then taken */
} Placed;

/* Embree knows nothing of what is farther away. */
static int is_near(const SpaceTriangles *t, uint32_t base, const unsigned *corner)
{
    for (int i = 0; i < 9; i++)
        if (!(fabsf(t->vertices[base + corner[i / 3]][i % 3]) < 1e15f))
            return 0;
    return 1;
}

static void take_triangles(const struct aiMesh *mesh, const Affine *placed, Placed *to)
{
    SpaceTriangles *t = &to->triangles;
    const uint32_t base = (uint32_t)t->nvertices, tag = (uint32_t)to->nobjects;
    const double(*m)[4] = placed->m;
    const int is_turned = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                              m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                              m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
                          0;
    for (unsigned i = 0; i < mesh->mNumVertices; i++, t->nvertices++) {
        const struct aiVector3D *v = &mesh->mVertices[i];
        const double p[3] = {(double)v->x, (double)v->y, -(double)v->z};
        double q[3];
        affine_point(placed, p, q);
        for (int k = 0; k < 3; k++)
            t->vertices[t->nvertices][k] = (float)q[k];
    }
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const unsigned *corner = mesh->mFaces[i].mIndices;
        if (!mesh_is_surface(mesh, &mesh->mFaces[i]) || !is_near(t, base, corner))
            continue;
        t->corners[t->ntriangles][0] = base + corner[0];
        t->corners[t->ntriangles][1] = base + corner[is_turned ? 1 : 2];
        t->corners[t->ntriangles][2] = base + corner[is_turned ? 2 : 1];
        t->tags[t->ntriangles++] = tag;
    }
}

static void visit(Import *import, const struct aiNode *node, const Affine *world, void *context)
{
    const Affine placed = affine_mirror_z(world);
    Placed *to = context;
    for (unsigned i = 0; i < node->mNumMeshes && affine_is_finite(&placed); i++) {
        const unsigned index = node->mMeshes[i];
        const struct aiMesh *mesh = index < import->scene->mNumMeshes ? import->scene->mMeshes[index] : NULL;
        if (!mesh)
            continue;
        if (to->is_counting) {
            to->triangles.nvertices += mesh->mNumVertices;
            to->triangles.ntriangles += mesh->mNumFaces;
        } else {
            take_triangles(mesh, &placed, to);
            to->materials[to->nobjects] = mesh->mMaterialIndex;
        }
        to->nobjects++;
    }
}

int placed_collect(Import *import, Sense *sense, RetexError *err)
{
    Placed placed = {.is_counting = 1};
    SpaceTriangles *t = &placed.triangles;
    if (!import_visit_nodes(import, visit, &placed))
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    if (t->ntriangles > MOST_TRIANGLES || t->nvertices > 3 * (size_t)MOST_TRIANGLES || t->ntriangles == 0)
        return RETEX_OK;
    t->vertices = malloc(t->nvertices * sizeof *t->vertices);
    t->corners = malloc(t->ntriangles * sizeof *t->corners);
    t->tags = malloc(t->ntriangles * sizeof *t->tags);
    placed.materials = malloc((placed.nobjects + 1) * sizeof *placed.materials);
    int done = t->vertices && t->corners && t->tags && placed.materials;
    placed.is_counting = 0;
    placed.nobjects = t->nvertices = t->ntriangles = 0;
    done = done && import_visit_nodes(import, visit, &placed);
    if (!done || t->ntriangles == 0) {
        free(t->vertices);
        free(t->corners);
        free(t->tags);
        free(placed.materials);
        return done ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    sense->materials = placed.materials;
    sense->nobjects = (uint32_t)placed.nobjects;
    const int code = space_create(&sense->space, t, err);
    if (code != RETEX_ELIMIT)
        return code;
    import_tell(import, IMPORT_INFO, "so many triangles lie at one place that no room is looked for");
    return RETEX_OK;
}
