/* A camera whose rays start from the faces of meshes, along their normals, as POV-Ray takes them: its rows of faces are
 * one below those of the picture, and the first two rows are the same. */
#include "camera/camera.h"

typedef struct Corners {
    Vec3 p[3], normal; /* in the mesh's space; of unit length, on the side that POV-Ray takes */
} Corners;

static int face_corners(const Mesh *mesh, const MeshFace *face, Corners *c)
{
    for (int k = 0; k < 3; k++)
        c->p[k] = mesh->vertices[face->vertex[k]];
    c->normal = vec_cross(vec_sub(c->p[2], c->p[0]), vec_sub(c->p[1], c->p[0]));
    const double length = vec_length(c->normal);
    c->normal = vec_scale(c->normal, 1 / length);
    return length > 0;
}

/* ---- preparation ---- */

/* POV-Ray leaves faces without area out of its count. */
static int list_faces(Arena *arena, CameraMesh *m)
{
    Corners corners;
    int *faces = arena_alloc(arena, ((size_t)m->mesh->nfaces + 1) * sizeof *faces);
    m->nfaces = 0, m->faces = faces;
    for (int k = 0; faces && k < m->mesh->nfaces; k++)
        if (face_corners(m->mesh, &m->mesh->faces[k], &corners))
            faces[m->nfaces++] = k;
    return faces != NULL;
}

static int column_of(double u, int columns)
{
    return (int)fmin(fmax(u * columns, 0), columns - 1);
}

/* The cells of the table that the bounds of a face's UV cover: first and last column, first and last row. */
static int face_cells(const Mesh *mesh, const MeshFace *face, int columns, int cells[4])
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    if (!mesh_face_has_uvs(face))
        return 0;
    for (int k = 0; k < 3; k++) {
        const Vec2 uv = mesh->uvs[face->uv[k]];
        low[0] = fmin(low[0], uv.u), high[0] = fmax(high[0], uv.u);
        low[1] = fmin(low[1], uv.v), high[1] = fmax(high[1], uv.v);
    }
    for (int k = 0; k < 2; k++)
        cells[2 * k] = column_of(low[k], columns), cells[2 * k + 1] = column_of(high[k], columns);
    return 1;
}

static size_t count_entries(const CameraMesh *m, int columns)
{
    size_t entries = 0;
    int c[4];
    for (int k = 0; k < m->nfaces; k++)
        if (face_cells(m->mesh, &m->mesh->faces[m->faces[k]], columns, c))
            entries += (size_t)(c[1] - c[0] + 1) * (size_t)(c[3] - c[2] + 1);
    return entries;
}

/* A table of the faces by UV: those of a cell are listed one after the other, in their order in the mesh. */
static int index_uvs(Arena *arena, MeshCamera *camera)
{
    const CameraMesh *m = &camera->meshes[0];
    int columns = (int)fmin(sqrt(m->nfaces) + 1, 1024);
    while (columns > 1 && count_entries(m, columns) > 16 * ((size_t)m->nfaces + 64))
        columns /= 2;
    const int ncells = columns * columns;
    int *starts = arena_alloc(arena, ((size_t)ncells + 2) * sizeof *starts);
    int *entries = arena_alloc(arena, (count_entries(m, columns) + 1) * sizeof *entries);
    if (!starts || !entries)
        return 0;
    /* first count, by the cell after next; then fill in, which moves each start to where the next cell's must be */
    for (int fill = 0; fill < 2; fill++) {
        for (int k = 0; k < m->nfaces; k++) {
            int c[4];
            if (!face_cells(m->mesh, &m->mesh->faces[m->faces[k]], columns, c))
                continue;
            for (int y = c[2]; y <= c[3]; y++)
                for (int x = c[0]; x <= c[1]; x++)
                    if (fill)
                        entries[starts[y * columns + x + 1]++] = m->faces[k];
                    else
                        starts[y * columns + x + 2]++;
        }
        for (int k = 0; k < ncells && !fill; k++)
            starts[k + 2] += starts[k + 1];
    }
    camera->columns = columns, camera->starts = starts, camera->entries = entries;
    return 1;
}

const MeshCamera *mesh_camera_create(Arena *arena, const MeshCamera *from)
{
    MeshCamera *camera = arena_copy(arena, from, sizeof *from);
    CameraMesh *meshes = arena_copy(arena, from->meshes, (size_t)from->nmeshes * sizeof *meshes);
    if (!camera || !meshes)
        return NULL;
    camera->meshes = meshes;
    for (int k = 0; k < camera->nmeshes; k++)
        if (!list_faces(arena, &meshes[k]))
            return NULL;
    return camera->distribution != 3 || index_uvs(arena, camera) ? camera : NULL;
}

/* ---- rays ---- */

static Vec3 weighted(const Vec3 p[3], const double weights[3])
{
    return vec_add(vec_add(vec_scale(p[0], weights[0]), vec_scale(p[1], weights[1])), vec_scale(p[2], weights[2]));
}

/* From a point of a face; location.z tells how far off it, and a negative direction.z to look backwards. */
static int from_face(const Camera *camera, const CameraMesh *m, int index, const double weights[3], Ray *ray)
{
    const MeshFace *face = &m->mesh->faces[index];
    Corners c;
    if (!face_corners(m->mesh, face, &c))
        return 0;
    Vec3 along = c.normal;
    if (camera->mesh->smooth && mesh_face_has_normals(face)) {
        Vec3 normals[3];
        for (int k = 0; k < 3; k++)
            normals[k] = m->mesh->normals[face->normal[k]];
        along = weighted(normals, weights);
    }
    ray->origin = transform_point(&m->transform, vec_mad(weighted(c.p, weights), along, camera->location.z));
    ray->direction = transform_normal(&m->transform, camera->direction.z < -1e-10 ? vec_neg(along) : along);
    if (camera->mesh->length > 0)
        ray->tmax = camera->mesh->length;
    return vec_length(ray->direction) > 0;
}

/* By the texture coordinates of the first mesh. */
static int by_uv(const Camera *camera, double u, double v, Ray *ray)
{
    const MeshCamera *mesh = camera->mesh;
    const CameraMesh *m = &mesh->meshes[0];
    const int cell = column_of(v, mesh->columns) * mesh->columns + column_of(u, mesh->columns);
    for (int k = mesh->starts[cell]; k < mesh->starts[cell + 1]; k++) {
        const MeshFace *face = &m->mesh->faces[mesh->entries[k]];
        const Vec2 a = m->mesh->uvs[face->uv[0]], b = m->mesh->uvs[face->uv[1]], c = m->mesh->uvs[face->uv[2]];
        const double area = (b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v);
        const double weights[3] = {((b.u - u) * (c.v - v) - (c.u - u) * (b.v - v)) / area,
                                   ((c.u - u) * (a.v - v) - (a.u - u) * (c.v - v)) / area,
                                   ((a.u - u) * (b.v - v) - (b.u - u) * (a.v - v)) / area};
        if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0)
            return from_face(camera, m, mesh->entries[k], weights, ray);
    }
    return 0;
}

static int mesh_ray(const Camera *camera, CameraPoint *at, Ray *ray)
{
    static const double middle[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    const MeshCamera *mesh = camera->mesh;
    const double x = fmin(fmax(at->x, 0), at->width - 1), y = fmin(fmax(at->y - 1, 0), at->height - 1);
    int which = 0;
    if (mesh->distribution == 3)
        return by_uv(camera, (x - 0.5) / at->width, 1 - (y + 0.5) / at->height, ray);
    long index = (long)floor(y) * at->width + (long)floor(x);
    if (mesh->distribution == 0 && at->sample) /* as many meshes as rays for each pixel */
        which = (int)(at->sample[0] * (float)mesh->rays);
    if (mesh->distribution == 1) /* the faces of all meshes in a row */
        for (; which < mesh->nmeshes && index >= mesh->meshes[which].nfaces; which++)
            index -= mesh->meshes[which].nfaces;
    if (mesh->distribution == 2) { /* a camera for each mesh, side by side */
        which = (int)(x * mesh->nmeshes / at->width);
        index = (long)floor(y) * (at->width / mesh->nmeshes) + (long)floor(x);
    }
    if (which >= mesh->nmeshes || index >= mesh->meshes[which].nfaces)
        return 0;
    const CameraMesh *m = &mesh->meshes[which];
    return from_face(camera, m, m->faces[index], middle, ray);
}

const CameraOps camera_mesh_camera = {.name = "mesh_camera", .properties = CAMERA_MESH, .ray = mesh_ray};
