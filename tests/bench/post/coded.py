"""A set as other programs would store it: coded.py SET.exr OUT.exr dwaa-all|dwaa|jpeg LEVEL

Writes OUT.exr, the set with what that loses, in EXR's lossless zip as retex-combine reads it, and prints the bytes that
the stored form takes, as JSON like that of stored.py.

dwaa-all   every part as DWAA of that level, UV as well
dwaa       radiance as DWAA, all other parts as they are
jpeg       radiance as JPEG of that quality, all other parts as they are: what the paper does. Each image is scaled to
           its largest value, encoded as sRGB and stored without subsampling of colours.
"""
import json
import os
import subprocess
import sys
import zlib

import numpy as np
import OpenImageIO as oiio

from stored import USES, exr_parts, uses


def read(path):
    file = oiio.ImageInput.open(path)
    parts = []
    while file.seek_subimage(len(parts), 0):
        spec = oiio.ImageSpec(file.spec())
        parts.append((spec, file.read_image(len(parts), 0, 0, spec.nchannels, spec.format)))
    file.close()
    return parts


def write(path, parts, compressions):
    specs = [spec for spec, _ in parts]
    for spec, compression in zip(specs, compressions):
        spec.attribute("compression", compression)
    file = oiio.ImageOutput.create(path)
    good = file.open(path, tuple(specs))
    for number, (spec, pixels) in enumerate(parts):
        good = good and (number == 0 or file.open(path, spec, "AppendSubimage")) and file.write_image(pixels)
    if not file.close() or not good:
        sys.exit(f"coded.py: {path}: {file.geterror()}")


def checksum(data):
    return f"{zlib.crc32(data):08x}"


def sign(parts):
    """The manifest with the checksums of these parts' values, as retex-set(5) says."""
    manifest = json.loads(parts[0][0].get_string_attribute("retex"))
    for about, (spec, pixels) in zip(manifest["parts"], parts):
        planes = pixels.reshape(spec.height, spec.width, spec.nchannels)
        about["crc32"] = checksum(b"".join(np.ascontiguousarray(planes[..., k]).tobytes()
                                           for k in (list(spec.channelnames).index(c) for c in channels(about, spec))))
        about.pop("bands", None)
    manifest["crc32"] = "00000000"
    text = json.dumps(manifest, separators=(",", ":"), ensure_ascii=False)
    parts[0][0].attribute("retex", text.replace("00000000", checksum(text.encode()), 1))


def channels(about, spec):
    """Names in the file of a part's channels, in the order of its checksum."""
    return [next(n for n in spec.channelnames if n.rpartition(".")[2] == letter) for letter in about["letters"]]


def srgb(x):
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 0.0031308) ** (1 / 2.4) - 0.055)


def linear(x):
    return np.where(x <= 0.04045, x / 12.92, ((np.maximum(x, 0.04045) + 0.055) / 1.055) ** 2.4)


def through_jpeg(pixels, quality, path):
    """What comes back, and the bytes of the file."""
    top = float(pixels.max())
    if top <= 0:
        return pixels, 0
    codes = np.rint(255 * srgb(np.clip(pixels.astype(np.float32) / top, 0, 1))).astype(np.uint8)
    spec = oiio.ImageSpec(codes.shape[1], codes.shape[0], 3, "uint8")
    spec.attribute("compression", f"jpeg:{quality}")
    spec.attribute("jpeg:subsampling", "4:4:4")
    file = oiio.ImageOutput.create(path)
    if not file.open(path, spec) or not file.write_image(codes) or not file.close():
        sys.exit(f"coded.py: {path}: {file.geterror()}")
    back = read(path)[0][1].astype(np.float32) / 255
    return (top * linear(back)).astype(pixels.dtype), os.path.getsize(path)


def main(path, out, method, level):
    told = subprocess.run(["retex-info", "--json", path], check=True, stdout=subprocess.PIPE).stdout
    manifest = json.loads(told)
    names, use_of = [part["name"] for part in manifest["parts"]], uses(manifest)
    parts, sizes = read(path), exr_parts(path)
    is_light = [use_of[name] == "radiance" for name in names]
    other = os.path.getsize(path) - sum(sizes)
    if method == "jpeg":
        for k, (spec, pixels) in enumerate(parts):
            if is_light[k] and spec.nchannels == 3:
                back, sizes[k] = through_jpeg(pixels, int(level), out + ".jpg")
                parts[k] = spec, back
        if os.path.exists(out + ".jpg"):
            os.remove(out + ".jpg")
    else:
        write(out, parts, [f"dwaa:{level}" if light or method == "dwaa-all" else "zip" for light in is_light])
        parts, sizes = read(out), exr_parts(out)
        other = os.path.getsize(out) - sum(sizes)
    sign(parts)
    write(out, parts, ["zip"] * len(parts))
    total = dict.fromkeys(USES, 0)
    for name, size in zip(names, sizes):
        total[use_of[name]] += size
    total["other"] += other
    print(json.dumps({"bytes": sum(total.values()), "uses": total}))


main(*sys.argv[1:])
