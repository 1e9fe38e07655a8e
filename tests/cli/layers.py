"""Compare a file of retex-info --layers with its set, part by part, through OpenImageIO; for layers.t.

    layers.py SET.exr FLAT.exr
"""
import sys

import numpy
import OpenImageIO as oiio


def parts(path):
    """The channels of each part, by name."""
    file, found = oiio.ImageInput.open(path), {}
    while file.seek_subimage(len(found), 0):
        spec = file.spec()
        pixels = file.read_image(len(found), 0, 0, spec.nchannels, oiio.FLOAT)
        formats = spec.channelformats or (spec.format,) * spec.nchannels
        name = spec.getattribute("oiio:subimagename") or ""
        found[name] = {c: (pixels[..., i], str(formats[i])) for i, c in enumerate(spec.channelnames)}
    return found


whole, flat = parts(sys.argv[1]), parts(sys.argv[2])
assert len(flat) == 1
flat = flat.popitem()[1]
size = whole["beauty"]["R"][0].shape
wanted = {}
for name, channels in whole.items():
    pixels = [values for values, _ in channels.values()]
    is_original = name.startswith("original_")
    if name.startswith(("noise_", "guide_")) or is_original or pixels[0].shape != size:
        continue
    if name not in ("beauty", "depth", "uv") and not any(p.any() for p in pixels):
        continue
    for channel, (values, kind) in channels.items():
        if name.startswith("uv_") and channel.endswith(".A"):
            channel, values = name + ".B", (values > 0).astype(numpy.float32)
        wanted[channel] = values, kind
    if name.startswith("spread_") and name + ".B" not in channels:
        wanted[name + ".B"] = numpy.zeros(size, numpy.float32), kind
print("channels", "as expected" if set(wanted) == set(flat) else sorted(set(wanted) ^ set(flat)))
wrong = [c for c in wanted if c in flat and not numpy.array_equal(wanted[c][0], flat[c][0])]
print("values", wrong or "equal", "types", [c for c in wanted if c in flat and wanted[c][1] != flat[c][1]] or "equal")
print(*sorted({c.split(".")[0] for c in flat if "." in c}))
