#!/usr/bin/python3
"""Makes a set of retex from the AOVs of any renderer: one target, its first hit, a diffuse surface.

    aovs_to_set.py --target Floor --object 1 --samples 4 AOVS.exr SET.exr

AOVS.exr has the layers beauty, albedo, reflectance, irradiance (R, G, B), uv (U, V) and object (one channel). They are
not filtered, and N times as large as the set in each direction (--samples N): N x N of their pixels are the samples of
one pixel. Without reflectance the albedo is taken for it.
docs/own-renderer.md explains each step. Needs python3-openimageio and python3-numpy."""
import argparse
import json
import zlib

import numpy as np
import OpenImageIO as oiio


def read_layers(path):
    """The layers of an OpenEXR file: {layer: {channel: height x width}}."""
    layers = {}
    file = oiio.ImageInput.open(path)
    part = 0
    while file and file.seek_subimage(part, 0):
        spec = file.spec()
        pixels = file.read_image(part, 0, 0, spec.nchannels, "float")
        for i, name in enumerate(spec.channelnames):  # by name: OpenEXR sorts channels
            layer, _, channel = name.rpartition(".")
            layers.setdefault(layer or spec.getattribute("name") or "beauty", {})[channel] = pixels[:, :, i]
        part += 1
    return layers


def statistics(layers, object_number, n):
    """The images of the set, by name: arrays of height x width x channels."""
    def samples(layer, channels):  # to height x width x samples x channels
        planes = np.stack([layers[layer][c] for c in channels], axis=-1).astype(np.float64)
        height, width = planes.shape[0] // n, planes.shape[1] // n
        blocks = planes[:height * n, :width * n].reshape(height, n, width, n, -1)
        return blocks.transpose(0, 2, 1, 3, 4).reshape(height, width, n * n, -1)

    hit = samples("object", layers["object"]) == object_number  # does the sample see the target?
    picture = samples("beauty", "RGB")
    # A diffuse surface of reflectance r gives back r E / pi of the irradiance E. Its texture's part of r is the albedo:
    # the rest, r / albedo, is the finish's. It is grey, and where the texture is black it is that of other samples.
    albedo = samples("albedo", "RGB")
    reflectance = samples("reflectance" if "reflectance" in layers else "albedo", "RGB")
    given, color = (np.where(hit, of, 0).sum(axis=3, keepdims=True) for of in (reflectance, albedo))
    finish = np.where(color > 0, given / np.maximum(color, 1e-30), given.sum() / color.sum() if color.any() else 1)
    light = np.where(hit, samples("irradiance", "RGB") / np.pi * finish, 0)
    dep = light.mean(axis=2)
    indep = np.where(hit, 0, picture).mean(axis=2)

    # Samples count by the light that they bring.
    weight = light @ np.array([[0.2126], [0.7152], [0.0722]])
    total = np.maximum(weight.sum(axis=2), 1e-30)
    uv = samples("uv", "UV")
    mean = (weight * uv).sum(axis=2) / total
    off = uv - mean[:, :, None]
    # The variance between the centres of n x n squares lacks that within the squares.
    whole = n * n / (n * n - 1) if n > 1 else 1
    variance = whole * (weight * off ** 2).sum(axis=2) / total
    covariance = whole * (weight * off[..., :1] * off[..., 1:]).sum(axis=2) / total
    spread = np.sqrt(variance)
    correlation = covariance / np.maximum(spread[..., :1] * spread[..., 1:], 1e-30)
    coverage = weight.sum(axis=2) ** 2 / np.maximum((weight ** 2).sum(axis=2), 1e-30) / (n * n)
    return {
        "beauty": picture.mean(axis=2), "indep": indep, "dep": dep,
        "uv": np.concatenate([mean, coverage], axis=-1),
        "spread": np.concatenate([spread, np.clip(correlation, -1, 1)], axis=-1),
        "albedo": (weight * albedo).sum(axis=2) / total,
    }


def write_set(path, target, images, samples):
    """Writes the parts with their checksums, and the manifest."""
    uv = images["uv"]
    seen = uv[uv[..., 2] > 0][:, :2]
    if not seen.size:
        raise SystemExit(f"aovs_to_set.py: no sample sees {target}")
    names = {"dep": f"dep_{target}_sharp1", "uv": f"uv_{target}_sharp1", "spread": f"spread_{target}_sharp1",
             "albedo": f"albedo_{target}_sharp1"}
    height, width = uv.shape[:2]
    parts, specs, arrays = [], [], []
    for key, image in images.items():
        name, letters = names.get(key, key), "RGA" if key == "uv" else "RGB"
        # Half is too coarse for coordinates: two texels of a 4K texture.
        array = image.astype(np.float32) if key in ("beauty", "uv") else np.minimum(image, 65504).astype(np.float16)
        planes = np.ascontiguousarray(array.transpose(2, 0, 1))
        parts.append({"name": name, "letters": letters, "type": "float" if array.itemsize == 4 else "half",
                      "width": width, "height": height, "crc32": f"{zlib.crc32(planes.tobytes()):08x}"})
        spec = oiio.ImageSpec(width, height, 3, parts[-1]["type"])
        spec.channelnames = tuple(letters if key == "beauty" else [f"{name}.{c}" for c in letters])
        spec.attribute("oiio:subimagename", name)
        spec.attribute("compression", "zip")
        specs.append(spec)
        arrays.append(np.ascontiguousarray(array))
    manifest = {
        "retex": 1, "crc32": "00000000", "kind": "set", "width": width, "height": height,
        "layout": "footprints", "filter": "box", "scene": "aovs", "generator": "aovs_to_set.py", "id": "00000000",
        "orders": 1, "spp": samples, "max_depth": 1, "seed": 0, "folded": 0, "strict_paper": False,
        "targets": [{"name": target, "idents": target, "periodic": [False, False],
                     "uv_min": seen.min(axis=0).tolist(), "uv_max": seen.max(axis=0).tolist(),
                     "mean_albedo": images["albedo"][uv[..., 2] > 0].mean(axis=0).tolist(),
                     "original": None, "original_min": [0, 0], "original_max": [1, 1],
                     "share": float((uv[..., 2] > 0).mean())}],
        "footprints": [{"target": 0, "hit": 1, "kind": "sharp", "uv": names["uv"], "spread": names["spread"],
                        "albedo": names["albedo"]}],
        "parameters": [],
        "terms": [{"role": "indep", "target": None, "radiance": "indep", "factors": []},
                  {"role": "sharp", "target": 0, "radiance": names["dep"], "factors": [{"footprint": 0}]}],
        "parts": parts,
    }
    text = json.dumps(manifest, separators=(",", ":"))
    text = text.replace("00000000", f"{zlib.crc32(text.encode()):08x}", 1)
    specs[0].attribute("retex", text)
    file = oiio.ImageOutput.create(path)
    if not file or not file.open(path, tuple(specs)):
        raise SystemExit(f"aovs_to_set.py: cannot write {path}")
    for i, array in enumerate(arrays):
        if i:
            file.open(path, specs[i], "AppendSubimage")
        file.write_image(array)
    file.close()


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    options.add_argument("aovs")
    options.add_argument("set")
    options.add_argument("--target", required=True)
    options.add_argument("--object", type=int, required=True, help="the target's number in the layer object")
    options.add_argument("--samples", type=int, default=1, help="samples a pixel in each direction")
    asked = options.parse_args()
    write_set(asked.set, asked.target, statistics(read_layers(asked.aovs), asked.object, asked.samples),
              asked.samples ** 2)
