"""Writes flat.glb into the current folder, for glb-to-floor.sh: a room with a window and furniture, one mesh with one image
for all of it, without camera and lamps, as models of web shops often are."""
import json
import struct
import zlib

SIZE = (5, 2.6, 4)
# Parts of the image, by number from the left: walls, floor, table, sofa, shelf.
COLORS = [(225, 220, 210), (190, 150, 100), (120, 80, 50), (60, 90, 130), (235, 235, 230)]
BOXES = [(2, (2.1, .7, 1.4), (3.5, .75, 2.2)), (2, (2.2, 0, 1.5), (2.3, .7, 1.6)), (2, (3.3, 0, 2), (3.4, .7, 2.1)),
         (3, (.1, 0, .8), (1, .45, 3)), (3, (.1, .45, .8), (.3, .85, 3)), (4, (3.6, 0, .05), (4.8, 1.7, .4))]


def png(width, height, pixel):
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    rows = b"".join(b"\0" + b"".join(bytes(pixel(i)) for i in range(width)) for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


faces = []  # the part of the image, and corners, counter-clockwise from where they are seen


def box(part, low, high, inwards=False, floor=None, without=()):
    for axis in range(3):
        for side in (0, 1):
            if (axis, side) in without:
                continue
            u, v = (axis + 1) % 3, (axis + 2) % 3
            corners = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = [0, 0, 0]
                corner[axis], corner[u], corner[v] = (low, high)[side][axis], (low, high)[a][u], (low, high)[b][v]
                corners.append(tuple(corner))
            if (side == 0) != inwards:
                corners.reverse()
            faces.append((floor if floor is not None and (axis, side) == (1, 0) else part, corners))


box(0, (0, 0, 0), SIZE, True, 1, {(0, 1)})
x = SIZE[0]  # the wall with the window, in four parts
for y0, y1, z0, z1 in ((0, .9, 0, 4), (2.1, 2.6, 0, 4), (.9, 2.1, 0, 1), (.9, 2.1, 3, 4)):
    faces.append((0, [(x, y0, z0), (x, y0, z1), (x, y1, z1), (x, y1, z0)]))
for part, low, high in BOXES:
    box(part, low, high)

positions, uvs, indices = [], [], []
for part, corners in faces:
    first = len(positions)
    positions += corners
    uvs += [((part + s) / len(COLORS), t) for s, t in ((.1, .9), (.9, .9), (.9, .1), (.1, .1))]
    indices += [first, first + 1, first + 2, first, first + 2, first + 3]
image = png(16 * len(COLORS), 16, lambda i: COLORS[i // 16])
parts = [b"".join(struct.pack("<3f", *p) for p in positions), b"".join(struct.pack("<2f", *p) for p in uvs),
         struct.pack(f"<{len(indices)}H", *indices), image]
views, data = [], b""
for part in parts:
    data += b"\0" * (-len(data) % 4)
    views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
    data += part
data += b"\0" * (-len(data) % 4)
text = json.dumps({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "flat"}],
    "meshes": [{"name": "flat", "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2,
                                                "material": 0}]}],
    "materials": [{"name": "atlas", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0,
                                                             "roughnessFactor": .7}}],
    "textures": [{"source": 0}], "images": [{"bufferView": 3, "mimeType": "image/png"}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3", "min": [0, 0, 0],
         "max": list(SIZE)},
        {"bufferView": 1, "componentType": 5126, "count": len(uvs), "type": "VEC2"},
        {"bufferView": 2, "componentType": 5123, "count": len(indices), "type": "SCALAR"}],
    "bufferViews": views, "buffers": [{"byteLength": len(data)}]}).encode()
text += b" " * (-len(text) % 4)
with open("flat.glb", "wb") as out:
    out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
    out.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)
