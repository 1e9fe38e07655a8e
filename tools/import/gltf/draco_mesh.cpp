// Meshes that Draco compressed.
#include "import/gltf/draco_mesh.h"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>

#include <draco/compression/decode.h>

struct DracoMesh {
    std::unique_ptr<draco::Mesh> mesh;
};

namespace
{

// Numbers are stored with the low byte first, in glTF and on the machines that this runs on.
template <typename T>
bool put_numbers(const DracoMesh &from, const draco::PointAttribute &attribute, size_t width, size_t stride,
                 unsigned char *to)
{
    const uint32_t count = from.mesh->num_points();
    T numbers[16];
    if (!attribute.is_mapping_identity() && attribute.indices_map_size() < count)
        return false;
    for (uint32_t i = 0; i < count; i++, to += stride) {
        const draco::AttributeValueIndex place = attribute.mapped_index(draco::PointIndex(i));
        if (place.value() >= attribute.size() || !attribute.ConvertValue<T>(place, int8_t(width), numbers))
            return false;
        std::memcpy(to, numbers, width * sizeof(T));
    }
    return true;
}

} // namespace

DracoMesh *draco_mesh_open(const unsigned char *bytes, size_t size, char why[160])
{
    try {
        draco::DecoderBuffer buffer;
        draco::Decoder decoder;
        buffer.Init(reinterpret_cast<const char *>(bytes), size);
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (decoded.ok())
            return new DracoMesh{std::move(decoded).value()};
        std::snprintf(why, 160, "%s", decoded.status().error_msg());
    } catch (const std::bad_alloc &) {
        std::snprintf(why, 160, "out of memory: reading it takes more than --max-memory");
    } catch (const std::exception &e) {
        std::snprintf(why, 160, "%s", e.what());
    } catch (...) {
        std::snprintf(why, 160, "it is damaged");
    }
    return nullptr;
}

size_t draco_mesh_vertices(const DracoMesh *mesh)
{
    return mesh->mesh->num_points();
}

size_t draco_mesh_triangles(const DracoMesh *mesh)
{
    return mesh->mesh->num_faces();
}

int draco_mesh_indices(const DracoMesh *mesh, unsigned char *to)
{
    const uint32_t vertices = mesh->mesh->num_points(), triangles = mesh->mesh->num_faces();
    for (uint32_t i = 0; i < triangles; i++)
        for (const draco::PointIndex &corner : mesh->mesh->face(draco::FaceIndex(i))) {
            const uint32_t index = corner.value();
            if (index >= vertices)
                return 0;
            std::memcpy(to, &index, sizeof index);
            to += sizeof index;
        }
    return 1;
}

int draco_mesh_attribute(const DracoMesh *mesh, size_t number, size_t type, size_t width, size_t stride,
                         unsigned char *to)
{
    try {
        const draco::PointAttribute *attribute = mesh->mesh->GetAttributeByUniqueId(uint32_t(number));
        if (!attribute || width > 16)
            return 0;
        switch (type) {
        case 5120:
            return put_numbers<int8_t>(*mesh, *attribute, width, stride, to);
        case 5121:
            return put_numbers<uint8_t>(*mesh, *attribute, width, stride, to);
        case 5122:
            return put_numbers<int16_t>(*mesh, *attribute, width, stride, to);
        case 5123:
            return put_numbers<uint16_t>(*mesh, *attribute, width, stride, to);
        case 5125:
            return put_numbers<uint32_t>(*mesh, *attribute, width, stride, to);
        case 5126:
            return put_numbers<float>(*mesh, *attribute, width, stride, to);
        default:
            return 0;
        }
    } catch (...) {
        return 0;
    }
}

void draco_mesh_close(DracoMesh *mesh)
{
    delete mesh;
}
