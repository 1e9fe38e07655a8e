/* Which parts of a mesh of Assimp count. */
#ifndef RETEX_IMPORT_MESH_H
#define RETEX_IMPORT_MESH_H

#include <assimp/mesh.h>

int mesh_is_finite(const struct aiVector3D *v);
/* Whether there is a triangle with an area in it. */
int mesh_has_surface(const struct aiMesh *mesh);
/* Whether vertices have colours that show. */
int mesh_has_colors(const struct aiMesh *mesh);
/* A triangle with an area, whose indices and positions are numbers that there are. */
int mesh_is_surface(const struct aiMesh *mesh, const struct aiFace *face);
/* The bounds of a mesh, z mirrored. Returns 0 if it is empty. */
int mesh_bounds(const struct aiMesh *mesh, double low[3], double high[3]);

#endif
