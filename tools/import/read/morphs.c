/* Morph targets of glTF meshes, at the weights of the file: a vertex is moved by the sum of the targets' displacements
 * times their weights, and so is its normal (glTF 2.0, Meshes: Morph Targets). Assimp keeps each target as a whole
 * mesh. Of FBX, whose weights Assimp does not read in all cases, meshes keep their basic shape. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/base/tell.h"
#include "import/read/read.h"

static void add(struct aiVector3D *sum, const struct aiVector3D *to, const struct aiVector3D *from, float weight)
{
    sum->x += weight * (to->x - from->x);
    sum->y += weight * (to->y - from->y);
    sum->z += weight * (to->z - from->z);
}

static void normalize(struct aiVector3D *v)
{
    const float length = sqrtf(v->x * v->x + v->y * v->y + v->z * v->z);
    if (length > 0)
        *v = (struct aiVector3D){v->x / length, v->y / length, v->z / length};
}

/* Adds to `vectors` what the targets displace; of: where a mesh has such vectors. Returns 0 without memory. */
static int displace(const struct aiMesh *mesh, struct aiVector3D *vectors,
                    const struct aiVector3D *(*of)(const struct aiAnimMesh *))
{
    const unsigned count = mesh->mNumVertices;
    struct aiVector3D *basic = malloc(sizeof *basic * (count + 1));
    if (!basic)
        return 0;
    memcpy(basic, vectors, sizeof *basic * count);
    for (unsigned i = 0; i < mesh->mNumAnimMeshes; i++) {
        const struct aiAnimMesh *target = mesh->mAnimMeshes[i];
        const struct aiVector3D *moved = target->mNumVertices == count ? of(target) : NULL;
        const float weight = isfinite(target->mWeight) ? target->mWeight : 0;
        for (unsigned k = 0; moved && weight != 0 && k < count; k++)
            add(&vectors[k], &moved[k], &basic[k], weight);
    }
    free(basic);
    return 1;
}

static const struct aiVector3D *positions(const struct aiAnimMesh *target)
{
    return target->mVertices;
}

static const struct aiVector3D *normals(const struct aiAnimMesh *target)
{
    return target->mNormals;
}

static int has_weights(const struct aiMesh *mesh)
{
    for (unsigned i = 0; i < mesh->mNumAnimMeshes; i++)
        if (mesh->mAnimMeshes[i]->mWeight != 0)
            return 1;
    return 0;
}

int morphs_apply(Import *import, RetexError *err)
{
    for (unsigned i = 0; i < import->scene->mNumMeshes; i++) {
        struct aiMesh *mesh = import->scene->mMeshes[i];
        if (mesh->mNumAnimMeshes && !import->is_gltf)
            import_leave_out(import, LEFT_MORPHS);
        if (!import->is_gltf || !has_weights(mesh))
            continue;
        if (!displace(mesh, mesh->mVertices, positions) || (mesh->mNormals && !displace(mesh, mesh->mNormals, normals)))
            return retex_fail(err, RETEX_ENOMEM, "out of memory");
        for (unsigned k = 0; mesh->mNormals && k < mesh->mNumVertices; k++)
            normalize(&mesh->mNormals[k]);
    }
    return RETEX_OK;
}
