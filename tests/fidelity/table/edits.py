"""Adjusted, laid and layered textures, as Markdown: edits.py WORK HEAD SETTINGS >MD; or --textures WORK; or
--pictures WORK

--textures writes the textures, for each case WORK/NAME.exr, what numpy makes of them, and WORK/cases.txt: a name, the
options that lay numpy's picture, and the arguments of retex-combine that ask for the edit. --pictures prints the names
and arguments of the page's pictures. PSNR is of sRGB-encoded colours, clipped to 0..1. What numpy does follows the
definitions of retex-edit(5), and shares nothing with the library.
"""
import sys

import numpy as np
import OpenImageIO as oiio

import pictures

BRICK, WALNUT = "scenes/textures/brick.jpg", "scenes/textures/walnut-herringbone.jpg"
LENGTH, SIDE, JOINT = 0.6, 0.1, 0.008  # of a plank with its joint, and of the joint, in metres
ODD = 0.0077  # a joint of no whole number of texels
GREY = (128 / 255 + 0.055) ** 2.4 / 1.055 ** 2.4


def decoded(y):
    return np.where(y <= 0.04045, y / 12.92, ((y + 0.055) / 1.055) ** 2.4)


def read(path):
    """A picture of 8 bits: colours, scene-linear, and alpha."""
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", 1)
    file = oiio.ImageInput.open(path, config)
    pixels = file.read_image("float").astype(np.float64)
    file.close()
    return decoded(pixels[..., :3]), pixels[..., 3:]


def write_floats(path, picture):
    pixels = np.ascontiguousarray(picture.astype(np.float32))
    file = oiio.ImageOutput.create(path)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, "float")
    if not file or not file.open(path, spec) or not file.write_image(pixels) or not file.close():
        pictures.fail(f"cannot write {path}")


# ---- adjustments ----

def luminance(c):
    return c @ np.array([0.2126, 0.7152, 0.0722])


def hue(c, degrees):
    """In Oklab: Ottosson, 'A perceptual color space for image processing' (2020)."""
    to_lms = np.array([[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
                       [0.0883024619, 0.2817188376, 0.6299787005]])
    to_lab = np.array([[0.2104542553, 0.7936177850, -0.0040720468], [1.9779984951, -2.4285922050, 0.4505937099],
                       [0.0259040371, 0.7827717662, -0.8086757660]])
    lab = np.cbrt(c @ to_lms.T) @ to_lab.T
    chroma = np.hypot(lab[..., 1], lab[..., 2])
    angle = np.arctan2(lab[..., 2], lab[..., 1]) + np.radians(degrees)
    lab = np.stack([lab[..., 0], chroma * np.cos(angle), chroma * np.sin(angle)], axis=-1)
    return (lab @ np.linalg.inv(to_lab).T) ** 3 @ np.linalg.inv(to_lms).T


def blur(c, deviation):
    for axis in (0, 1):
        frequency = np.fft.fftfreq(c.shape[axis])
        gauss = np.exp(-2 * (np.pi * frequency * deviation * c.shape[1]) ** 2)
        shape = [1, 1, 1]
        shape[axis] = -1
        c = np.fft.ifft(np.fft.fft(c, axis=axis) * gauss.reshape(shape), axis=axis).real
    return c


def saturation(c, s):
    grey = luminance(c)[..., None]
    return grey + s * (c - grey)


def invert(c):
    return decoded(1 - pictures.encoded(c))


def colorize(c, *color):
    y = luminance(c)[..., None]
    return np.array(color) * y / y.mean()


ADJUSTMENTS = [
    ("hue", "hue=40", [lambda c: hue(c, 40)]),
    ("saturation", "saturation=0.3", [lambda c: saturation(c, 0.3)]),
    ("gain", "gain=1,.8,.5", [lambda c: c * np.array([1, 0.8, 0.5])]),
    ("gamma", "gamma=1.4", [lambda c: c ** (1 / 1.4)]),
    ("contrast", "contrast=1.5", [lambda c: 0.18 * (c / 0.18) ** 1.5]),
    ("blur", "blur=0.01", [lambda c: blur(c, 0.01)]),
    ("wide-blur", "blur=0.02", [lambda c: blur(c, 0.02)]),
    ("invert", "invert=yes", [invert]),
    ("tint", "tint=rgb(.5,.9,1)", [lambda c: c * np.array([0.5, 0.9, 1])]),
    ("colorize", "colorize=rgb(.6,.2,.1)", [lambda c: colorize(c, 0.6, 0.2, 0.1)]),
    ("several", "hue=40:gain=1.2:blur=0.01:contrast=1.2:saturation=1.5",
     [lambda c: hue(c, 40), lambda c: c * 1.2, lambda c: blur(c, 0.01), lambda c: 0.18 * (c / 0.18) ** 1.2,
      lambda c: saturation(c, 1.5)]),
]


def adjusted(picture, steps):
    for step in steps:
        picture = np.clip(step(picture), 0, 1)
    return picture


# ---- laying: what is seen where, x to the right and y up, in metres ----

def plank():
    """Wood of 592 x 92 millimetres, of a texel each, and a half."""
    rng = np.random.default_rng(3)
    noise = blur(rng.random((138, 888, 1)), 0.004) * 40 - 19.5
    grain = blur(np.repeat(rng.random((138, 1, 1)), 888, axis=1), 0.001) + 0.02 * noise
    return np.clip(0.25 + 0.5 * (grain - 0.5), 0, 1) * np.array([1, 0.75, 0.5])


def look_up(image, x, y, width, height):
    """Bilinear, clamped."""
    rows, columns = image.shape[:2]
    x, y = np.clip(x / width * columns - 0.5, 0, columns - 1), np.clip((1 - y / height) * rows - 0.5, 0, rows - 1)
    x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
    x1, y1 = np.minimum(x0 + 1, columns - 1), np.minimum(y0 + 1, rows - 1)
    a, b = (x - x0)[..., None], (y - y0)[..., None]
    return (image[y0, x0] * (1 - a) + image[y0, x1] * a) * (1 - b) + (image[y1, x0] * (1 - a) + image[y1, x1] * a) * b


def lying(wood, x, y, joint=JOINT):
    width, height = LENGTH - joint, SIDE - joint
    inside = ((x < width) & (y < height))[..., None]
    return np.where(inside, look_up(wood, x, y, width, height), GREY)


def standing(wood, x, y):
    width, height = LENGTH - JOINT, SIDE - JOINT
    inside = ((x < height) & (y < width))[..., None]
    return np.where(inside, look_up(wood, y, height - x, width, height), GREY)


def straight(wood, x, y):
    return lying(wood, x % LENGTH, y % SIDE)


def odd(wood, x, y):
    return lying(wood, x % LENGTH, y % SIDE, ODD)


def brick(wood, x, y):
    return straight(wood, np.where(np.floor(y / SIDE) % 2 == 1, x - LENGTH / 2, x), y)


def basket(wood, x, y):
    stands = (np.floor(x / LENGTH) + np.floor(y / LENGTH)) % 2 == 1
    x, y = x % LENGTH, y % LENGTH
    return np.where(stands[..., None], standing(wood, x % SIDE, y), lying(wood, x, y % SIDE))


def herringbone(wood, x, y):
    seen = np.zeros(x.shape + (3,))
    for a in range(-30, 31):
        for b in range(-6, 7):
            right, up = a * SIDE + b * (LENGTH + SIDE), a * SIDE + b * (SIDE - LENGTH)
            if not (-2 * LENGTH < right < x.max() and -2 * LENGTH < up < y.max() + LENGTH):
                continue
            left, low = x - right, y - up
            here = (left >= 0) & (left < LENGTH) & (low >= 0) & (low < SIDE)
            if here.any():
                seen[here] = lying(wood, left[here], low[here])
            left, low = left - LENGTH, low - SIDE + LENGTH
            here = (left >= 0) & (left < SIDE) & (low >= 0) & (low < LENGTH)
            if here.any():
                seen[here] = standing(wood, left[here], low[here])
    return seen


BONDS = [("grout", "straight", straight, LENGTH, SIDE), ("brick", "brick", brick, LENGTH, 2 * SIDE),
         ("basket", "basket", basket, 2 * LENGTH, 2 * LENGTH),
         ("herringbone", "herringbone", herringbone, 2 * LENGTH, 2 * LENGTH), ("odd", "straight", odd, LENGTH, SIDE)]


def sampled(pattern, width, height, density, samples=4):
    """The mean of a pattern over texels."""
    columns, rows = round(width * density), round(height * density)
    total = 0
    for i in range(samples):
        for j in range(samples):
            x, y = (np.arange(columns) + (i + 0.5) / samples) / columns * width, (
                np.arange(rows) + (j + 0.5) / samples) / rows * height
            total = total + pattern(*np.meshgrid(x, y[::-1]))
    return total / samples ** 2


# ---- layers ----

def logo():
    """A ring and a bar on nothing, with soft edges: colours and alpha."""
    y, x = (np.mgrid[0:256, 0:256] - 127.5) / 128
    ring = np.clip((0.15 - np.abs(np.hypot(x, y) - 0.7)) * 40, 0, 1)
    bar = np.clip((0.12 - np.abs(y + 0.2)) * 40, 0, 1) * (np.abs(x) < 0.5)
    alpha = np.maximum(ring, bar)[..., None]
    return np.where(ring[..., None] > 0, np.array([0.7, 0.1, 0.1]), np.array([0.1, 0.3, 0.6])), alpha


TAN = [0.6444797, 0.45641103, 0.26225066]


def layered(image, alpha, x, y):
    """The logo, 1 m wide, turned by 20 degrees, its middle at 1, 1."""
    c, s = np.cos(np.radians(20)), np.sin(np.radians(20))
    u, v = c * (x - 1) - s * (y - 1) + 0.5, s * (x - 1) + c * (y - 1) + 0.5
    inside = ((u >= 0) & (u <= 1) & (v >= 0) & (v <= 1))[..., None]
    a = np.where(inside, look_up(alpha, u, v, 1, 1), 0)
    premultiplied = look_up(image * alpha, u, v, 1, 1) * inside
    return premultiplied + (1 - a) * np.array(TAN)


# ---- what is compared ----

def write_textures(work):
    cases = []
    bricks, _ = read(BRICK)
    write_floats(f"{work}/plain.exr", bricks)
    cases.append(f"plain width=1.2 --texture:width=1.2 Floor={BRICK}")
    for name, options, steps in ADJUSTMENTS:
        write_floats(f"{work}/{name}.exr", adjusted(bricks, steps))
        cases.append(f"{name} width=1.2 --texture:width=1.2:{options} Floor={BRICK}")
    pictures.write(f"{work}/plank.png", pictures.encoded(plank()))
    wood, _ = read(f"{work}/plank.png")
    for name, repeat, pattern, width, height in BONDS:
        write_floats(f"{work}/{name}.exr",
                     sampled(lambda x, y, pattern=pattern: pattern(wood, x, y), width, height, 1500))
        joint = ODD if name == "odd" else JOINT
        cases.append(f"{name} width={width:g},{height:g} --texture:width={LENGTH - joint:g},{SIDE - joint:g}:"
                     f"grout={joint}:repeat={repeat} Floor={work}/plank.png")
    image, alpha = logo()
    pictures.write(f"{work}/logo.png", np.dstack([pictures.encoded(image), alpha]),
                   ("oiio:UnassociatedAlpha", 1))
    image, alpha = read(f"{work}/logo.png")
    write_floats(f"{work}/logo.exr", sampled(lambda x, y: layered(image, alpha, x, y), 2, 2, 512))
    cases.append(f"logo width=2:wrap=clamp:at=1,1 --texture Floor=rgb({','.join(map(str, TAN))}) "
                 f"--texture:over:at=1,1:width=1:rotate=20 Floor={work}/logo.png")
    with open(f"{work}/cases.txt", "w") as file:
        file.write("\n".join(cases) + "\n")


PICTURES = [
    ("bond", "Planks of one image, 60 x 10 cm, in a herringbone with joints of 3 mm; mirrored and shifted at random",
     "--texture:width=60cm,10cm:repeat=herringbone:grout=3mm:groutcolor=#3a2a1c:vary=flip,shift,5 Floor={work}/plank.png"),
    ("tiles", "Tiles of three images by turns, turned at random, and a wall of bricks in another colour",
     "--texture:width=50cm,50cm:grout=6mm:groutcolor=#c8c4bc:tiles=scenes/textures/travertine.jpg,scenes/textures/fans.jpg:"
     "vary=turn,3 Floor=scenes/textures/terrazzo.jpg --texture:width=1m:colorize=#7d8f86 Wall=" + BRICK),
    ("logo", "A logo on the floor as it was rendered, and a darker wall with less colour",
     "--texture:over:at=-170cm,1.2m:width=1m:rotate=20 Floor={work}/logo.png "
     "--texture:width=1m:saturation=0.4:gain=0.6:contrast=1.2 Wall=scenes/textures/damask.jpg"),
]


SIZES = r"""## Sizes, views, presets

`--size 320x180` makes a smaller picture, every pixel the mean of what it covers, and `--crop` a part. A pack with levels,
`retex-pack --levels`, makes thumbnails in a tenth to a fifth of the time. `--exposure`, `--auto-exposure` and
`--white-balance` develop the picture, `--view Filmic` and `--view Neutral` keep highlights that the plain view burns out.
`--save-preset` writes textures, lamps, finishes and these to a small JSON file, which other rooms take, and
retex-serve:

    retex-combine room.exr --texture:width=60cm,10cm:repeat=herringbone:grout=3mm Floor=plank.png --exposure 0.7 \
        --view Filmic --save-preset planks.json -o planks.jpg
    retex-combine kitchen.exr --preset planks.json --size 640x -o kitchen.jpg
"""


def psnr(a, b):
    x, y = (pictures.encoded(pictures.colours(path)) for path in (a, b))
    return -10 * np.log10(max(((x - y) ** 2).mean(), 1e-12))


def main():
    if sys.argv[1] == "--textures":
        write_textures(sys.argv[2])
        return
    if sys.argv[1] == "--pictures":
        for name, _, arguments in PICTURES:
            print(name, arguments.format(work=sys.argv[2]))
        return
    work, head, settings = sys.argv[1:]
    spp, truth_spp, height, _ = settings.split()
    print(f"""# Adjusting, laying and layering textures

An image is often nearly the right one. Its colours are adjusted, its repeats are laid with joints and in bonds, and pictures
lie on it, by options of the texture, without another program and without another file. retex-edit(5) describes all of them;
they are the same in all tools, in tables, URLs, Python, the plugin, pages, and `retex-render --replace`.

{head}
""")
    for name, text, arguments in PICTURES:
        print(f"{text}:\n\n    retex-combine room.exr {arguments.format(work='.')} -o {name}.jpg\n")
        print(f"![{text}](pictures/edits-{name}.jpg)\n")
    with open(f"{work}/cases.txt") as file:
        cases = [line.split(maxsplit=2) for line in file]
    print(SIZES)
    print(f"""## Compared with the same made beforehand

A floor of even light, {int(height) * 16 // 9} x {height} pixels, seen from above and at a grazing angle. PSNR of the edit
against a picture that numpy made by the definitions, with 4 x 4 samples a texel of planks with joints of 8 mm, laid as a plain
texture.

| edit | from above | grazing |
|---|---|---|""")
    for name, _, arguments in cases:
        if name != "plain":
            said = arguments.split()[-2].replace("--texture:", "").replace("width=1.2:", "")
            found = [psnr(f"{work}/{view}-{name}-set.exr", f"{work}/{view}-{name}-made.exr")
                     for view in ("above", "grazing")]
            print(f"| `{said}` | {found[0]:.1f} | {found[1]:.1f} |")
    print(f"""
A repeat and its joint keep whole texels, so that none is softer than another. Planks above have 1.5 texels a millimetre, and
joints of 12; where a joint is no whole number, as in the last bond, the image in each repeat stretches by up to a texel, and
the pattern is as sharp while numpy's is interpolated. A blur of more than 16 texels is made of four boxes, whose step differs
from a Gaussian's by .6 % at most; that of a hundredth of the image is a Gaussian.

## Compared with rendering

The grazing view again. `same seed`: the edit against `retex-render --replace` with the same {spp} paths a pixel. `set`,
`rendered`: both against {truth_spp} paths of another seed.

| texture | same seed | set | rendered |
|---|---|---|---|""")
    for name, _, _ in cases:
        if name in ("plain", "grout", "brick", "herringbone", "logo"):
            base = f"{work}/grazing-{name}"
            found = [psnr(f"{base}-{a}.exr", f"{base}-{b}.exr")
                     for a, b in (("set", "own"), ("set", "truth"), ("own", "truth"))]
            print(f"| {name} | {found[0]:.1f} | {found[1]:.1f} | {found[2]:.1f} |")
    print("""
A render looks textures up at points, and its noise is in the first column: a set has the mean over each footprint, and is
nearer to the truth.

## Limits

- Bonds, varied and several images are laid into one image of at most 67 million texels. Beyond that it becomes coarser, or
  fewer repeats differ.
- The ratio of the sides is rounded to small whole numbers in a herringbone and in a basket.
- Layers lie once: a pattern of them is a texture. Maps of finishes and normals do not go with them, nor with `tiles`.
- Adjustments work on 8 or 16 bits as the image has them, and on floats; they are made once when the image is read.""")


if __name__ == "__main__":
    main()
