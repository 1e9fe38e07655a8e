"""Normal maps, as Markdown: normal-maps.py WORK HEAD SETTINGS SURFACES MAPS >MD; or --textures WORK

Also writes WORK/normal-maps-MAP.jpg: a picture from a set above its new render. Errors are those of
pictures.squares.
"""
import sys

import numpy as np

import pictures

# ---- the textures ----

SIZE, TILES, BEVEL = 1024, 2, 60


def encoded_normals(x, y):
    """A normal map, green up, of slopes to the right and up."""
    n = np.dstack([x, y, np.ones_like(x)])
    return n / np.linalg.norm(n, axis=2, keepdims=True) / 2 + 0.5


def write_textures(work):
    y, x = np.mgrid[0:SIZE, 0:SIZE]
    side = SIZE // TILES
    tone = 0.5 + 0.18 * ((x // side + 2 * (y // side)) % 3 - 1)
    across, down = x % side, y % side
    joint = np.minimum(np.minimum(across, side - 1 - across), np.minimum(down, side - 1 - down)) < 4
    pictures.write(f"{work}/tiles.png", np.where(joint, 0.35, tone)[..., None] * np.array([1.0, 0.92, 0.85]))

    def bevel(at):
        return np.where(at < BEVEL, -1.0, np.where(at >= side - BEVEL, 1.0, 0.0))

    slope = np.tan(np.radians(10))
    pictures.write(f"{work}/tiles-map.png", encoded_normals(slope * bevel(across), -slope * bevel(down)))
    a, b = (np.cos(2 * np.pi * k / SIZE) for k in (2 * x + y, 3 * y - x))
    along, up = 2 * a - b, -(a + 3 * b)
    slope = np.tan(np.radians(30)) / np.hypot(along, up).max()
    pictures.write(f"{work}/waves-map.png", encoded_normals(slope * along, slope * up))


# ---- the figures ----

def score(work, surface, normal_map):
    """Of pixels that see the surface: errors of the picture of its own, of the set, and of the set without the map; how
    far the former two differ, and how far they are expected to."""
    base, name = f"{work}/{surface}", f"{work}/{surface}-{normal_map}"
    truth = f"{work}/truth/normals-{surface.replace('=', '-')}-{normal_map}.exr"
    masks = [pictures.parts(f"{base}-mask-{k}.exr")["albedo"] for k in (1, 2)]
    seen = np.abs(masks[0] - masks[1]).max(axis=2) > 0.5
    errors = [pictures.squares(path, truth) for path in (f"{name}-own.exr", f"{name}-set.exr", f"{base}-flat.exr")]
    ours, own = (pictures.colours(f"{name}-{kind}.exr") for kind in ("set", "own"))
    expected = pictures.colours(f"{name}-error.exr")
    return ([pictures.decibels(error[seen].mean()) for error in errors] +
            [np.sqrt(((ours - own)[seen] ** 2).mean()), np.sqrt((expected[seen] ** 2).mean())])


def show_pictures(work, maps):
    for name in maps:
        pair = [pictures.encoded(pictures.colours(f"{work}/picture-{name}-{kind}.exr")) for kind in ("ours", "new")]
        pictures.write(f"{work}/normal-maps-{name}.jpg",
                       np.vstack([pair[0], np.ones((4, pair[0].shape[1], 3)), pair[1]]))


def main():
    if sys.argv[1] == "--textures":
        write_textures(sys.argv[2])
        return
    work, head, settings, surfaces, maps = sys.argv[1:]
    spp, truth_spp, _, _ = settings.split()
    show_pictures(work, maps.split())
    print(f"""# Normal maps

A texture says where its surface points: bevels of tiles, joints, folds of cloth. The set is rendered for it, and the map
is chosen later, with the texture whose placement it shares:

    retex-render --finish Wall=normals -t Wall --denoise scenes/living-room/living-room.pov -o room.exr
    retex-combine room.exr --texture:normal=tiles-map.png Wall=tiles.png -o tiles.jpg

{head}

## Bevelled tiles, and waves of up to 30 degrees

Above from one set, 64 samples, denoised; below rendered so, 256 samples, not denoised, so that noise is left in it.

![a wall of bevelled tiles](pictures/normal-maps-tiles.jpg)

![a wall with waves](pictures/normal-maps-waves.jpg)

## Compared with rendering the map

PSNR against converged pictures, two of {truth_spp} samples each, whose noise does not count, over the pixels that see the
surface. `rendered`: by `--replace` with the map, `set`: the map laid over a set, both with {spp} samples a pixel and the
same paths; `no map`: the same set without it. `differ`: root mean square of the difference of the first two, scene-linear;
`expected`: that of `retex-combine --error`. Slopes of the tiles' bevels are 10 degrees, 14 at corners.

| surface | finish | map | rendered | set | no map | differ | expected |
|---|---|---|---|---|---|---|---|""")
    for surface in surfaces.split():
        for name in maps.split():
            own, ours, flat, differ, expected = score(work, surface, name)
            target, finish = surface.split("=")
            print(f"| {target} | {finish} | {name} | {own:.2f} | {ours:.2f} | {flat:.2f} | {differ:.4f} | {expected:.4f} |")
    print("""
## How it works

- Light that is reflected diffusely is nearly linear in the normal. The set keeps it for three normals: that of the surface,
  and two that are tilted by 15 degrees to where u grows, and v. Each texel of the map is a sum of the three, with weights
  of either sign, which are multiplied with the colour before both are filtered. `Wall=normals` so takes three of the eight
  combinations of finishes that a set may have, and the memory and time of these.
- Only the diffuse lobe is tilted. Highlights and reflections stay where they are, in `--replace` and so in the figures
  above as well: a highlight of a tilted surface is elsewhere, and no sum of three is the one between. A glossy floor that is
  seen at a grazing angle, which mostly reflects, gains little from a normal map, and its reflections stay smooth.
- **Green points up**, as in OpenGL and glTF. Names such as `wall_nor_dx.png` and `Wall_NormalDX.png`, or the option
  `normal=wall.png,dx`, say that it points down. A folder of maps needs no option; the map whose green points up is preferred.
- Bumps rise towards the side that is seen, however triangles wind. Where normals of a mesh say that its back is seen they are
  dents, as in glTF, and as those of `retex_normal_map` in a scene are.
- Vectors turn with `rotate`, `flip` and negative scales, and mirrored repeats mirror theirs. Maps are taken to be made for
  the proportions in which the picture is laid: a `scale` that stretches it makes no slope flatter.
- The texture with its map is kept as four images of floats: with 4096 x 4096 texels 1.4 gigabytes, and with mirrored
  repeats two or four times that.

## Limits

- Bumps cast no shadows on each other, and nothing of the surface hides behind another part of it.
- The horizon: light from behind a slope is black, and a sum of three pictures goes on below 0. Where it is below 0 the
  picture is 0. Slopes of 10 degrees make little of it, those of 30 show it at the edges of windows and lamps.
- `--error` counts normals that differ within a footprint, not what the sum of three normals is off by: of the waves above
  it expects far too little.
- The normal of a path is that of its first hit on the target.
- A target has normals of one finish, and nothing else to choose from: `finish=` and `normal=` exclude each other.
- Pages of `retex-pack --web` do not show normal maps; the rest of such a set they show.""")


if __name__ == "__main__":
    main()
