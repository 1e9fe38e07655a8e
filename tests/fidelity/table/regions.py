"""The regions of a picture, from noise-free data of its scene.

GUIDE has the AOVs of first hits at pixel centres and the irradiance, with grey targets; DIRECT the irradiance of light
that comes straight from its source. A pixel belongs to the first of these that it fits:

  glass-mirror   the first hit is sharper than roughness 0.1: glass, mirrors, polished metal
  silhouette     next to it objects, normals (by 25 degrees) or surfaces (by 2 % of the distance) part
  caustic        indirect light exceeds its median around, on the same surface, by 15 % of the median of all light;
                 looked for where glass gathers light, for elsewhere it finds corners lit by what is near
  shadow-edge    direct light changes by 8 % or more of all light from one pixel to the next, within a pixel of
                 this one, on a surface that hardly turns
  smooth         the rest
"""
import numpy as np

import pictures

NAMES = ["smooth", "silhouette", "glass-mirror", "caustic", "shadow-edge"]
FALSE_COLOURS = [(0.25, 0.25, 0.28), (1, 1, 1), (0.2, 0.5, 1), (1, 0.75, 0.1), (0.9, 0.15, 0.25)]
ROUGHNESS, TURN, STEP = 0.1, np.cos(np.radians(25)), 0.02
AROUND, EXCESS = 24, 0.15
CAUSTICS = ["glass-caustics"]  # scenes where caustics are looked for
EDGE, FLAT = 0.08, np.cos(np.radians(6))
NEIGHBOURS = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]


def shifted(image, dy, dx):
    """What lies that far off, edges repeated."""
    padded = np.pad(image, [(abs(dy),) * 2, (abs(dx),) * 2] + [(0, 0)] * (image.ndim - 2), mode="edge")
    height, width = image.shape[:2]
    return padded[abs(dy) + dy:abs(dy) + dy + height, abs(dx) + dx:abs(dx) + dx + width]


def wider(mask):
    return np.logical_or.reduce([mask] + [shifted(mask, *n) for n in NEIGHBOURS])


def median_around(image, surface, normal, radius):
    """Median of the pixels of the same surface, facing the same way, in a square; of a large one, some of them."""
    step = max(1, radius // 6)
    stack = [image]
    for dy in range(-radius, radius + 1, step):
        for dx in range(-radius, radius + 1, step):
            same = (shifted(surface, dy, dx) == surface) & ((shifted(normal, dy, dx) * normal).sum(axis=2) > TURN)
            stack.append(np.where(same, shifted(image, dy, dx), np.nan))
    return np.nanmedian(np.array(stack), axis=0)


def of_scene(work, scene):
    """Height x width of indices into NAMES, from GUIDE, WORK/guides/SCENE.exr, and DIRECT, SCENE-direct.exr there."""
    guide_path, direct_path = f"{work}/guides/{scene}.exr", f"{work}/guides/{scene}-direct.exr"
    guide, direct = pictures.parts(guide_path), pictures.parts(direct_path)
    for part in ("irradiance", "normal", "position", "depth", "object", "roughness"):
        if part not in guide:
            pictures.fail(f"{guide_path} has no part {part}")
    if "irradiance" not in direct or direct["irradiance"].shape != guide["irradiance"].shape:
        pictures.fail(f"{direct_path} has no irradiance of the size of {guide_path}")
    surface, normal = guide["object"][..., 0], guide["normal"][..., :3]
    position, depth = guide["position"][..., :3], guide["depth"][..., 0]
    hit = surface > 0
    specular = hit & (guide["roughness"][..., 0] < ROUGHNESS)

    # Where surfaces part: another object, a fold, or a place off the plane of this one.
    length = np.linalg.norm(normal, axis=2, keepdims=True)
    normal = normal / np.maximum(length, 1e-6)
    parted, flat = np.zeros_like(hit), np.ones_like(hit)
    for n in NEIGHBOURS:
        turn = (normal * shifted(normal, *n)).sum(axis=2)
        off = np.abs((normal * (shifted(position, *n) - position)).sum(axis=2))
        both = hit & shifted(hit, *n)
        flat &= ~both | (turn > FLAT)
        with np.errstate(invalid="ignore"):
            parted |= (surface != shifted(surface, *n)) | (both & ((turn < TURN) | (off > STEP * depth)))

    # Light: without the little noise that it has, and of its own surface.
    whole = median_around(guide["irradiance"][..., :3].mean(axis=2), surface, normal, 1)
    straight = median_around(direct["irradiance"][..., :3].mean(axis=2), surface, normal, 1)
    indirect = whole - straight
    excess = indirect - median_around(indirect, surface, normal, AROUND)
    caustic = (scene in CAUSTICS) & hit & (excess > EXCESS * median_around(whole, surface, normal, AROUND))
    change = np.zeros_like(whole)
    for n in NEIGHBOURS:
        same = shifted(surface, *n) == surface
        distance = np.hypot(*n)
        change = np.maximum(change, np.where(same, np.abs(shifted(straight, *n) - straight) / distance, 0))
    edge = hit & flat & (change > EDGE * np.maximum(whole, 1e-6))

    # Single pixels are noise, not a caustic or a shadow.
    few = [sum(shifted(mask, *n).astype(int) for n in NEIGHBOURS) < 3 for mask in (caustic, edge)]
    regions = np.zeros(hit.shape, dtype=int)
    regions[wider(edge & ~few[1])] = NAMES.index("shadow-edge")
    regions[caustic & ~few[0]] = NAMES.index("caustic")
    regions[parted] = NAMES.index("silhouette")
    regions[specular] = NAMES.index("glass-mirror")
    return regions


def paint(regions, path):
    pictures.write(path, np.array(FALSE_COLOURS)[regions])

