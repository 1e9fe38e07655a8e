"""Maps of finishes, as Markdown: finish-maps.py WORK HEAD SETTINGS SCENES FLOORS >MD; or --textures WORK

Also writes WORK/finish-maps-FLOOR.jpg: a picture from a set above its new render. Errors are those
of pictures.squares.
"""
import sys

import numpy as np
import OpenImageIO as oiio

import pictures

# ---- the textures ----

SIZE, PLANKS, JOINT = 1024, 8, 6


def planks():
    """Wood of several tones, its grain along the planks, and joints between them; the map: varnish on the wood."""
    rng = np.random.default_rng(1)
    y, x = np.mgrid[0:SIZE, 0:SIZE]
    plank = x * PLANKS // SIZE
    ends = rng.integers(0, SIZE, PLANKS)
    across = x * PLANKS % SIZE / PLANKS
    joint = (across < JOINT) | ((y - ends[plank]) % SIZE < JOINT)
    grain = np.repeat(rng.normal(0, 0.06, (16, SIZE)), SIZE // 16, axis=0)
    tone = rng.uniform(0.75, 1.1, PLANKS)[plank] + grain
    wood = np.clip(tone[..., None] * np.array([0.62, 0.42, 0.26]), 0, 1)
    return np.where(joint[..., None], 0.12, wood), np.where(joint, 0.0, 1.0)


def inlay():
    """Stone with a fan of brass in each field; the map: brass where the pattern is bright."""
    stone, pattern = (read(f"scenes/textures/{name}.jpg") for name in ("travertine", "fans"))
    light = pattern.mean(axis=2)
    brass = light > np.quantile(light, 0.75)
    return np.where(brass[..., None], np.array([0.93, 0.77, 0.42]), stone), brass.astype(float)


def read(path):
    image = oiio.ImageBufAlgo.resize(oiio.ImageBuf(path), roi=oiio.ROI(0, SIZE, 0, SIZE, 0, 1, 0, 3))
    return np.asarray(image.get_pixels(oiio.FLOAT))[..., :3]


def write_textures(work):
    for name, (colour, finish) in (("planks", planks()), ("inlay", inlay())):
        pictures.write(f"{work}/{name}.png", colour)
        pictures.write(f"{work}/{name}-map.png", finish[..., None])


# ---- the figures ----

def score(work, scene, floor):
    """By region: the errors of the set and of the render of its own, their difference, and the expected error."""
    name = f"{work}/{scene}-{floor}"
    truth = f"{work}/truth/maps-{scene}-{floor}.exr"
    masks = [pictures.parts(f"{name}-mask-{k}.exr")["albedo"] for k in (1, 2)]
    seen = np.abs(masks[0] - masks[1]).max(axis=2) > 0.5
    errors = {kind: pictures.squares(f"{name}-{kind}.exr", truth) for kind in ("set", "own")}
    ours, own = (pictures.colours(f"{name}-{kind}.exr") for kind in ("set", "own"))
    expected = pictures.colours(f"{name}-error.exr")
    for region, pixels in (("floor", seen), ("rest", ~seen)):
        yield (region, pixels.mean(), pictures.decibels(errors["own"][pixels].mean()), pictures.decibels(errors["set"][pixels].mean()),
               np.sqrt(((ours - own)[pixels] ** 2).mean()), np.sqrt((expected[pixels] ** 2).mean()))


def show_pictures(work, floors):
    for floor in floors:
        pair = [pictures.encoded(pictures.colours(f"{work}/picture-{floor}-{kind}.exr")) for kind in ("ours", "new")]
        pictures.write(f"{work}/finish-maps-{floor}.jpg", np.vstack([pair[0], np.ones((4, pair[0].shape[1], 3)),
                                                                      pair[1]]))


def main():
    if sys.argv[1] == "--textures":
        write_textures(sys.argv[2])
        return
    work, head, settings, scenes, floors = sys.argv[1:]
    spp, truth_spp, _, _ = settings.split()
    show_pictures(work, floors.split())
    print(f"""# Maps of finishes

A texture says which finish is where: planks are varnished and their joints matt, a brass inlay shines in stone. The set is
rendered with the finishes, and the map is chosen later, with the texture whose placement it shares:

    retex-render --finish Floor=matt,polished -t Floor --denoise scenes/living-room/living-room.pov -o room.exr
    retex-combine room.exr --texture:finish=planks-map.png Floor=planks.png -o planks.jpg

{head}

## Planks with matt joints, and brass in stone

Above from one set, 64 samples, denoised; below rendered so, 256 samples, not denoised, so that noise is left in it.

![varnished planks with matt joints](pictures/finish-maps-planks.jpg)

![an inlay of brass in polished stone](pictures/finish-maps-inlay.jpg)

## Compared with rendering the map

PSNR against converged pictures, two of {truth_spp} samples each, whose noise does not count. `rendered`: by `--replace` with
the map, `set`: the map laid over a set, both with {spp} samples a pixel and the same paths. `floor`: pixels that see it
directly, `rest`: all others. `differ`: root mean square of the difference of both, scene-linear; `expected`: that of
`retex-combine --error`.

| scene | floor | region | rendered | set | set over rendered | differ | expected |
|---|---|---|---|---|---|---|---|""")
    for scene in scenes.split():
        for floor in floors.split():
            for region, _, own, ours, differ, expected in score(work, scene, floor):
                print(f"| {scene} | {floor} | {region} | {own:.2f} | {ours:.2f} | {ours - own:+.2f} | {differ:.4f} | "
                      f"{expected:.4f} |")
    print("""
## What a map does

- **Grey**: black is the first finish of `--finish`, white the last, between them the list in its order. **Colours**: red
  is the second finish, green the third, blue the fourth, and what is left of 1 the first; so black, red, green and blue
  are one each. The values count as they are, without any curve. `finish=none` uses no map.
- **A folder of maps** that has roughness, as Poly Haven and ambientCG make them, needs no option: each texel gets the two
  finishes whose own roughness is next to it. `retex-info` tells the roughness of finishes; metals have none.
- A map has the texture's placement, whatever its size: the larger of both counts, the other one is interpolated.
- Where the texture is transparent the finish shows that the picture has without a map (`--finish`, `--show`).
- Weights are multiplied with the colour before both are filtered, so that a pixel on a joint gets the mean of what is
  there, not the mean of the colours times the mean of the finishes.

## Limits

- A patchwork of two roughnesses gives two images of what it reflects, one sharp and one blurred, mixed by the map: that
  is what such a surface shows. It is not one image of a roughness between them: a grey of .5 between matt and polished is
  half of each. For a third roughness give `--finish` a third finish.
- The finish of a path is that of its first hit on the target; later hits of the same path have it, too. With one finish
  all over this is exact; with a map `--error` says how much it may be off.
- Light that only reflects at the target, without its colour, is told where by the mean map over the pixel's footprints.""")


if __name__ == "__main__":
    main()
