/* Meshes that Draco compressed. Its library is of C++: draco_mesh.cpp alone includes its headers. */
#ifndef RETEX_IMPORT_DRACO_MESH_H
#define RETEX_IMPORT_DRACO_MESH_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct DracoMesh DracoMesh;

/* NULL: `why` says what is wrong with the bytes. */
DracoMesh *draco_mesh_open(const unsigned char *bytes, size_t size, char why[160]);
size_t draco_mesh_vertices(const DracoMesh *mesh);
size_t draco_mesh_triangles(const DracoMesh *mesh);
/* Three indices for each triangle, of 32 bits, as glTF stores them. Returns 0 where one is not below the number of
 * vertices. */
int draco_mesh_indices(const DracoMesh *mesh, unsigned char *to);
/* The attribute with that number: for each vertex `width` numbers of glTF's component type, from 5120 to 5126, from
 * `to` on, `stride` bytes from one vertex to the next. Returns 0 where there is none, or it has no such numbers. */
int draco_mesh_attribute(const DracoMesh *mesh, size_t number, size_t type, size_t width, size_t stride,
                         unsigned char *to);
void draco_mesh_close(DracoMesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
