/* Emitting meshes: all that sampling needs to know of their faces, computed once. */
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>
#include "light/mesh_light.h"
#include "shade/pigment.h"
#include "shade/texture.h"

#define CLOSED 1e-3 /* a mesh is closed if the sum of its faces' area vectors is below this share of its area */

static const Texture *face_texture(const Primitive *p, int face)
{
    int t = p->shape.textures ? p->shape.mesh->faces[face].texture : -1;
    return t < 0 ? p->texture : p->shape.textures->list[t];
}

/* Faces that blend textures are not sampled: paths find them. */
static int is_sampled(const Primitive *p, int face)
{
    return texture_is_sampled(face_texture(p, face)) && !mesh_face_blends(p->shape.mesh, face);
}

/* The radiance of one side, if it is uniform. */
static int find_emission(const Texture *texture, int target, Rgb *emission)
{
    const Rgbft *c = &texture->pigment->color;
    if (target >= 0 || texture->tree || texture->pigment->kind != PIGMENT_COLOR || texture->finish->retex.emission_map)
        return 0;
    *emission = rgb_mul(rgb_scale(texture->finish->emission, pigment_opacity(texture->pigment, *c)),
                        rgb(not_negative(c->r), not_negative(c->g), not_negative(c->b)));
    return 1;
}

/* Returns 0 for a face without area. */
static int fill_face(MeshLightFace *f, const Primitive *p, int face)
{
    const int *index = p->shape.mesh->faces[face].vertex;
    Vec3 corners[3];
    Surface surface;
    double density;
    for (int k = 0; k < 3; k++)
        corners[k] = transform_point(&p->transform, p->shape.mesh->vertices[index[k]]);
    shape_sample(p, face, 0.5, 0.5, &surface, &density);
    *f = (MeshLightFace){.corner = corners[0],
                         .edge1 = vec_sub(corners[1], corners[0]),
                         .edge2 = vec_sub(corners[2], corners[0]),
                         .normal = surface.geometric_normal,
                         .inverse_area = density,
                         .radiance = rgb_luminance(texture_emission(face_texture(p, face))),
                         .face = face,
                         .target = surface.target,
                         .texture = surface.texture};
    f->uniform = find_emission(surface.texture, surface.target, &f->emission[0]);
    surface_turn(&surface, 1);
    f->uniform &= find_emission(surface.texture, surface.target, &f->emission[1]);
    return density > 0 && isfinite(density);
}

/* The area vectors of all faces of a closed mesh add up to 0. */
static int is_closed(const Primitive *p)
{
    Vec3 sum = {0, 0, 0};
    double area = 0;
    for (int k = 0; k < p->shape.mesh->nfaces; k++) {
        Surface surface;
        double density, face = mesh_face_area(p, k);
        shape_sample(p, k, 0.5, 0.5, &surface, &density);
        sum = vec_mad(sum, surface.geometric_normal, face);
        area += face;
    }
    return vec_length(sum) < CLOSED * area;
}

static int count_faces(const Primitive *p)
{
    int count = 0;
    for (int k = 0; k < p->shape.mesh->nfaces; k++)
        count += is_sampled(p, k);
    return count;
}

/* Where no face has luminance (negative colours), faces are chosen by area. */
static void sum_shares(MeshLight *light)
{
    double sum = 0;
    for (int k = 0; k < light->count; k++) {
        MeshLightFace *f = &light->faces[k];
        light->area += 1 / f->inverse_area;
        light->power += fmaxf(0, f->radiance) / f->inverse_area;
    }
    for (int k = 0; k < light->count; k++) {
        MeshLightFace *f = &light->faces[k];
        double area = 1 / f->inverse_area;
        f->share = light->power > 0 ? fmaxf(0, f->radiance) * area / light->power : area / light->area;
        light->sums[k + 1] = sum += f->share;
    }
    light->sums[light->count] = 1;
}

int mesh_light_create(MeshLight **out, const Primitive *p, RetexError *err)
{
    *out = NULL;
    int most = count_faces(p);
    if (most == 0)
        return RETEX_OK;
    MeshLight *light = *out = calloc(1, sizeof *light);
    if (light) {
        light->faces = malloc((size_t)most * sizeof *light->faces);
        light->sums = calloc((size_t)most + 1, sizeof *light->sums);
        light->of_face = malloc((size_t)p->shape.mesh->nfaces * sizeof *light->of_face);
    }
    if (!light || !light->faces || !light->sums || !light->of_face) {
        mesh_light_close(out);
        return retex_fail(err, RETEX_ENOMEM, "out of memory for an emitter's faces");
    }
    for (int k = 0; k < p->shape.mesh->nfaces; k++) {
        light->of_face[k] = -1;
        if (is_sampled(p, k) && fill_face(&light->faces[light->count], p, k))
            light->of_face[k] = light->count++;
    }
    if (light->count == 0) {
        mesh_light_close(out);
        return RETEX_OK;
    }
    light->closed = is_closed(p);
    sum_shares(light);
    return RETEX_OK;
}

void mesh_light_close(MeshLight **light)
{
    if (!*light)
        return;
    free((*light)->faces);
    free((*light)->sums);
    free((*light)->of_face);
    free(*light);
    *light = NULL;
}

/* The face whose share of the power holds u. */
static int find_face(const MeshLight *light, float u)
{
    int low = 0, high = light->count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (light->sums[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Faces are a fan about their first corners. Each half of the unit square, on either side of its diagonal, goes to half
 * of the fan by an affine map: two faces that make a parallelogram get the square itself, so that evenly spread numbers
 * are evenly spread points. For one face this is the map of Heitz, 'A low-distortion map between triangle and square'
 * (2019). */
MeshLightPoint mesh_light_point(const MeshLight *light, int face, float u1, float u2)
{
    RETEX_ASSERT(face < light->count); /* of the light's faces, not of the mesh's, of which some do not emit */
    const float along = fmaxf(u1, u2);
    float across = u1 >= u2 ? u2 / (2 * fmaxf(u1, 0x1p-25f)) : 1 - u1 / (2 * u2);
    double share = 1;
    if (face < 0) {
        face = find_face(light, across);
        const double first = light->sums[face];
        share = light->faces[face].share;
        across = (float)((across - first) / (light->sums[face + 1] - first));
    }
    const MeshLightFace *f = &light->faces[face];
    RETEX_ASSERT(light->of_face[f->face] == face);
    return (MeshLightPoint){f, along, across, share * f->inverse_area};
}

void mesh_light_surface(const MeshLightPoint *point, const Primitive *p, Surface *surface)
{
    const MeshLightFace *f = point->face;
    const double along = point->along, across = point->across, b1 = along * (1 - across), b2 = along * across;
    *surface = (Surface){.primitive = p,
                         .face = f->face,
                         .texture = f->texture,
                         .target = f->target,
                         .position = vec_mad(vec_mad(f->corner, f->edge1, b1), f->edge2, b2),
                         .geometric_normal = f->normal,
                         .shading_normal = f->normal,
                         .b1 = b1,
                         .b2 = b2};
}
