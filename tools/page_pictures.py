"""Figures of docs/how-it-works.md and docs/faq.md from sets: page_pictures.py FIGURE OUT INPUT...

light OUT SET          the radiance images of a set of one target, by kind, side by side
places OUT SET         places on the target: the AOV uv, the brightest sharp footprint, the number of sharp footprints
pixel OUT SET X Y PATHS...   one pixel as SVG: paths, as --trace-pixel prints them, and its footprints
denoise OUT SET DENOISED PICTURE   the target's sharp light before and after denoising, and a picture
stmap OUT SET TEXTURE  a UV map's look-up times the irradiance, as a compositor does it"""
import re
import sys

import numpy as np
import OpenImageIO as oiio


def read(path):
    """{part: {channel: plane}}"""
    parts, file, n = {}, oiio.ImageInput.open(path), 0
    while file.seek_subimage(n, 0):
        spec = file.spec()
        pixels = file.read_image(n, 0, 0, spec.nchannels, "float")
        for i, name in enumerate(spec.channelnames):
            part, _, channel = name.rpartition(".")
            parts.setdefault(part or "beauty", {})[channel] = pixels[:, :, i]
        n += 1
    return parts


def color(part):
    return np.stack([part[c] for c in "RGB"], axis=-1)


def place(part):
    """u and v, whatever their channels are called."""
    u, v = ("U", "V") if "U" in part else ("R", "G")
    return part[u], part[v]


def write(path, pictures, encode=True):
    """Side by side, with a gap."""
    height = pictures[0].shape[0]
    gap = np.ones((height, 6, 3))
    row = [p for picture in pictures for p in (np.clip(shown(picture) if encode else picture, 0, 1), gap)][:-1]
    pixels = np.ascontiguousarray(np.concatenate(row, axis=1) * 255 + 0.5).astype(np.uint8)
    spec = oiio.ImageSpec(pixels.shape[1], height, 3, "uint8")
    file = oiio.ImageOutput.create(path)
    file.open(path, spec)
    file.write_image(np.ascontiguousarray(pixels))
    file.close()


def shown(linear):
    """The sRGB curve."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * np.power(linear, 1 / 2.4) - 0.055)


def light(out, path):
    parts = read(path)
    kinds = [r"indep$", r"dep_\w+_sharp\d+$", r"dep_\w+_broad\d+$", r"dep_\w+_[am]\d+$"]
    write(out, [sum(color(part) for name, part in parts.items() if re.match(kind, name)) * gain
                for kind, gain in zip(kinds, (1, 0.6, 2, 2))])


def coordinates(u, v, seen):
    """Red and green go from 0 to 1 within each repeat of the texture."""
    return np.where(seen[..., None], np.stack([u % 1, v % 1, np.full_like(u, 0.35)], axis=-1), 0.15)


def places(out, path):
    parts = read(path)
    sharp = sorted(name for name in parts if re.match(r"uv_\w+_sharp\d+$", name))
    bright = np.stack([color(parts[name.replace("uv_", "dep_")]).sum(axis=-1) * (parts[name]["A"] > 0) for name in sharp])
    first = bright.argmax(axis=0)
    u, v = (np.take_along_axis(np.stack([place(parts[name])[i] for name in sharp]), first[None], 0)[0] for i in (0, 1))
    # The camera's first hit has a UV on every object: of the target are those whose place is a footprint's.
    count = (bright > 0.002).sum(axis=0)
    aov = parts["uv"]
    direct = np.isclose(parts["guide_cover_Floor"]["R"], 1, atol=0.02) if "guide_cover_Floor" in parts else aov["A"] > 0
    direct &= parts["guide_specular"]["R"] == 0 if "guide_specular" in parts else direct
    colors = np.array([[0.1, 0.1, 0.1], [0.22, 0.42, 0.75], [0.35, 0.75, 0.45], [0.95, 0.8, 0.25], [0.9, 0.3, 0.2]])
    write(out, [coordinates(*place(aov), direct), coordinates(u, v, count > 0), colors[np.minimum(count, 4)]], encode=False)


def paths_of(files):
    """Of each file that --trace-pixel wrote: the vertices as far as the first hit on the target, and that hit's UV with
    whether it was seen sharply. Paths without one are left out."""
    for name in files:
        vertices, specular = [], True
        for line in open(name, encoding="utf-8"):
            at = re.search(r" at (\S+) (\S+) (\S+) distance", line)
            uv = re.search(r"target \w+ uv (\S+) (\S+)", line)
            if at:
                vertices.append(tuple(map(float, at.groups())))
            if uv:
                yield vertices, (float(uv[1]), float(uv[2]), specular)
                break
            if line.startswith("  goes on") and " pdf 0 " not in line:
                specular = False


def pixel(out, path, x, y, *files):
    """Left the first paths from the side, right all hits on the texture and the footprints that the set keeps of them."""
    parts, x, y = read(path), int(x), int(y)
    paths = list(paths_of(files))
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" width="860" height="330" font-family="sans-serif" font-size="13">',
           '<rect width="860" height="330" fill="#fff"/>']
    # From the side: z to the right, y up.
    eye, scale = (0.3, 4.6, -9.2), 24
    at = lambda p: (30 + (p[2] + 9.2) * scale, 250 - p[1] * scale)
    svg.append('<g fill="none" stroke="#888"><path d="M20 250H420"/></g>'
               '<text x="20" y="270" fill="#555">floor</text><text x="395" y="110" fill="#555">wall</text>'
               '<path d="M381 250V120" stroke="#888"/><text x="22" y="128" fill="#555">camera</text>')
    for number, vertices in enumerate([vertices for vertices, hit in paths if hit[2]][:6]):
        line = [eye] + vertices
        points = " ".join("%.1f,%.1f" % at(v) for v in line)
        svg.append(f'<polyline points="{points}" fill="none" stroke="hsl({number * 57},65%,42%)" stroke-width="1.3"/>')
        svg += ['<circle cx="%.1f" cy="%.1f" r="3" fill="%s"/>' % (*at(v), "#c33" if v[1] < 1e-6 else "#777") for v in line[1:]]
    svg.append('<text x="20" y="25" font-weight="bold">six paths of one pixel, from the side</text>'
               '<text x="20" y="308" fill="#c33">red: hits on the floor</text>')
    # On the texture.
    kept = []
    for name in parts:
        kind = re.match(r"uv_(\w+_(sharp|broad)\d+)$", name)
        if kind and parts[name]["A"][y, x] > 0:
            u, v = (plane[y, x] for plane in place(parts[name]))
            spread = parts["spread_" + kind[1]]
            kept.append((kind[2], u, v, spread["R"][y, x], spread["G"][y, x], spread["B"][y, x]))
    points = [hit for _, hit in paths]
    inside = [p for p in points if p[2]] or points
    cu, cv = (np.median([p[i] for p in inside]) for i in (0, 1))
    reach = 1.25 * max(max(abs(p[0] - cu), abs(p[1] - cv)) for p in inside + [(k[1], k[2]) for k in kept if k[0] == "sharp"])
    to = lambda u, v: (650 + (u - cu) / reach * 195, 165 - (v - cv) / reach * 140)
    svg.append('<rect x="455" y="25" width="390" height="280" fill="#f6f4ef" stroke="#888"/>'
               '<clipPath id="c"><rect x="455" y="25" width="390" height="280"/></clipPath><g clip-path="url(#c)">')
    for kind, u, v, su, sv, c in kept:
        values, vectors = np.linalg.eigh([[su * su, c * su * sv], [c * su * sv, sv * sv]])
        ring = [np.array([u, v]) + 2 * vectors @ (np.sqrt(np.maximum(values, 0)) * (np.cos(t), np.sin(t)))
                for t in np.linspace(0, 2 * np.pi, 49)]
        corners = " ".join("%.1f,%.1f" % to(*p) for p in ring)
        fill, edge = ("#2b6cb0", "#2b6cb0") if kind == "sharp" else ("none", "#c08a2b")
        svg.append(f'<polygon points="{corners}" fill="{fill}" fill-opacity="0.18" stroke="{edge}" stroke-width="1.6"/>')
    for u, v, is_sharp in points:
        fill = "#1a4f8a" if is_sharp else "#b5651d"
        svg.append('<circle cx="%.1f" cy="%.1f" r="2.6" fill="%s"/>' % (*to(u, v), fill))
    svg.append('</g><text x="455" y="18" font-weight="bold">where on the texture: u right, v up</text>'
               '<text x="455" y="322" fill="#1a4f8a">dots: first hits of paths; ellipses: footprints that the set keeps</text></svg>')
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(svg) + "\n")


def denoise(out, noisy, denoised, picture):
    sharp = [sum(color(part) for name, part in read(path).items() if re.match(r"dep_\w+_sharp\d+$", name))
             for path in (noisy, denoised)]
    write(out, [shown(light * 0.6) for light in sharp] + [color(read(picture)["beauty"])], encode=False)


def stmap(out, path, texture):
    parts = read(path)
    image = oiio.ImageInput.open(texture)
    spec = image.spec()
    texels = image.read_image(0, 0, 0, 3, "float")
    linear = np.where(texels <= 0.04045, texels / 12.92, ((texels + 0.055) / 1.055) ** 2.4)
    u, v = place(parts["uv"])
    found = linear[((1 - v % 1) * spec.height).astype(int) % spec.height, (u % 1 * spec.width).astype(int) % spec.width]
    floor = parts["object"]["R"][..., None] == 1
    picture = np.where(floor, 0.9 * found * color(parts["irradiance"]) / np.pi, color(parts["beauty"]))
    write(out, [picture])


if __name__ == "__main__":
    globals()[sys.argv[1]](*sys.argv[2:])
