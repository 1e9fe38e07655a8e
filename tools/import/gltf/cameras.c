/* Cameras of a glTF file: of its nodes, with their angles of view as they are written, and what extras say of the
 * lens. */
#include <math.h>
#include <stdlib.h>

#include "import/gltf/json.h"
#include "import/gltf/parts.h"

static void take_lens(const json_t *node, GltfCamera *to)
{
    const json_t *extras = gltf_extras(node), *shift = json_object_get(extras, "shift");
    for (size_t k = 0; k < 2; k++) {
        const double by = json_number_value(json_array_get(shift, k));
        to->shift[k] = fmin(fmax(by, -100), 100);
    }
    to->lens_radius = fmax(gltf_number(extras, "lens_radius", 0), 0);
    to->focus_distance = fmax(gltf_number(extras, "focus_distance", 0), 0);
}

/* Hidden ones too: what is hidden is not seen, but may see. */
static int take_camera(Import *import, const json_t *json, const GltfNode *at, void *context)
{
    const json_t *node = at->json;
    Gltf *gltf = &import->gltf;
    size_t *capacity = context;
    const json_t *index = json_object_get(node, "camera"), *cameras = json_object_get(json, "cameras");
    const json_t *camera = json_is_integer(index) ? json_array_get(cameras, (size_t)json_integer_value(index)) : NULL;
    const json_t *perspective = json_object_get(camera, "perspective");
    const json_t *orthographic = json_object_get(camera, "orthographic");
    if (!camera)
        return 1;
    if ((size_t)gltf->ncameras == *capacity) {
        GltfCamera *more = realloc(gltf->cameras, (2 * *capacity + 4) * sizeof *more);
        if (!more)
            return 0;
        gltf->cameras = more;
        *capacity = 2 * *capacity + 4;
    }
    GltfCamera *to = &gltf->cameras[gltf->ncameras++];
    *to = (GltfCamera){.place = at->place};
    gltf_node_name(json, node, camera, to->name);
    to->angle = gltf_number(perspective, "yfov", 0);
    to->aspect = gltf_number(perspective, "aspectRatio", 0);
    to->width = 2 * gltf_number(orthographic, "xmag", 0);
    to->height = 2 * gltf_number(orthographic, "ymag", 0);
    take_lens(node, to);
    return 1;
}

int gltf_take_cameras(Import *import, const json_t *json)
{
    size_t capacity = 0;
    return gltf_visit_nodes(import, json, take_camera, &capacity);
}
