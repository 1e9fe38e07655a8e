/* Textures that are adjusted, laid and layered: a flat floor, seen from above and along it, drawn by the Renderer on webgl.mjs,
 * against retex-combine's pictures. */
import { test } from "./tap.mjs";
import { player } from "./player.mjs";
import { images, least, open, psnr, run, tool, write } from "./room.mjs";

/* Pictures without symmetry, one with transparent parts, of odd sizes. */
run("/usr/bin/python3", "-c", `import OpenImageIO as o, numpy as n
def put(name, rows):
  out = o.ImageOutput.create(name); spec = o.ImageSpec(rows.shape[1], rows.shape[0], rows.shape[2], "uint8"); spec.attribute("oiio:UnassociatedAlpha", 1)
  out.open(name, spec); out.write_image(rows.astype("uint8")); out.close()
wave = lambda size, base, *parts: n.stack([base[c] + sum(a[c] * n.sin(2 * n.pi * (u * x / size[0] + v * y / size[1]) + c + u) for u, v, a in parts) for c in range(3)], axis=2)
y, x = n.mgrid[0:16, 0:24]
put("wood.png", wave((24, 16), (140, 110, 90), (1, 0, (60, -40, 30)), (0, 1, (30, 50, -30)), (2, 1, (20, 10, 25))))
put("stone.png", wave((24, 16), (100, 150, 170), (1, 1, (60, 40, -30)), (0, 1, (30, -30, 50))))
y, x = n.mgrid[0:18, 0:18]
put("square.png", wave((18, 18), (150, 90, 120), (1, 0, (60, 40, 70)), (1, 2, (30, -30, 40))))
y, x = n.mgrid[0:15, 0:21]
put("logo.png", n.stack([240 - x * 9, 30 + y * 12, 90 + x * 7, 255 * n.sin(n.pi * (x + .5) / 21) * n.sin(n.pi * (y + .5) / 15) ** .5], axis=2))`);

const SCENE = (camera) => `#version 3.7; global_settings { assumed_gamma 1 } #default { finish { diffuse 1 ambient 0 } } light_source { <0, 1e5, 0> 1 parallel point_at 0 }
  camera { ${camera} angle 60 } #declare Floor = texture { pigment { checker rgb <.7, .5, .3> rgb .3 scale .5 } } plane { y, 0 texture { Floor } }`;
const rooms = {};

test("rooms are made", () => {
  for (const [name, camera] of [["above", "location <0, 2.4, -.01> look_at 0"], ["along", "location <0, .6, -2.4> look_at <0, 0, 1>"]]) {
    write(`${name}.pov`, SCENE(camera));
    tool("retex-render", "-q", "--size", "48x27", "--spp", "16", "--denoise", "-t", "Floor", `${name}.pov`, "-o", `${name}.exr`);
    tool("retex-pack", "-q", `${name}.exr`, "--web", name);
    rooms[name] = open(name);
  }
});

/* Edits as in links: the page gets what parseEdit makes of them, the tools options. */
const { parseEdit, readColor } = player();
function edits(text) {
  const textures = {}, args = [];
  for (const [name, said] of Object.entries(parseEdit(text).textures)) {
    const { source, tiles = "", ...options } = said, color = readColor(source), layer = /^over/.test(name);
    textures[name] = { ...options, tiles, tileImages: tiles ? images(tiles.split(",")) : [], image: color || images([source])[0] };
    const words = text.split(";").filter((part) => part.startsWith(`${name}.`)).map((part) => part.slice(name.length + 1));
    args.push(["--texture", ...(layer ? ["over"] : []), ...words].join(":"), `${name.replace(/^over\d?:/, "")}=${source}`);
  }
  return { textures, args };
}

const cases = [
  ["hue", "Floor=wood.png;Floor.width=1.8;Floor.hue=100", 46],
  ["saturation", "Floor=wood.png;Floor.width=1.8;Floor.saturation=1.7", 44],
  ["gain", "Floor=wood.png;Floor.width=1.8;Floor.gain=.5,1.4,.8", 53],
  ["gamma", "Floor=wood.png;Floor.width=1.8;Floor.gamma=1.8", 53],
  ["contrast", "Floor=wood.png;Floor.width=1.8;Floor.contrast=1.5", 50],
  ["invert", "Floor=wood.png;Floor.width=1.8;Floor.invert=yes", 53],
  ["tint", "Floor=wood.png;Floor.width=1.8;Floor.tint=#80c0ff", 53],
  ["colorize", "Floor=wood.png;Floor.width=1.8;Floor.colorize=#a07030", 55],
  ["a blur", "Floor=wood.png;Floor.width=1.8;Floor.blur=.06", 53],
  ["a wide blur, mirrored", "Floor=wood.png;Floor.width=1.4;Floor.blur=.25;Floor.wrap=mirror", 55],
  ["many, one after the other", "Floor=wood.png;Floor.width=1.8;Floor.invert=yes;Floor.gamma=1.5;Floor.blur=.03;Floor.colorize=#b08040;Floor.hue=-40;Floor.saturation=1.2", 54],
  ["a colour", "Floor=rgb(0.6,0.3,0.2);Floor.gamma=1.5;Floor.hue=60;Floor.saturation=.6", 53],
  ["grout", "Floor=wood.png;Floor.width=.5;Floor.grout=.06;Floor.groutcolor=#203040", 40, 37.5],
  ["grout of a colour", "Floor=rgb(0.6,0.3,0.2);Floor.width=.9,.6;Floor.grout=.2;Floor.groutcolor=tan", 45],
  ["bricks that vary", "Floor=wood.png;Floor.width=.5;Floor.repeat=brick;Floor.vary=turn,flip,shift,5", 45],
  ["half-drop", "Floor=wood.png;Floor.width=.5;Floor.repeat=half-drop;Floor.rotate=20", 46],
  ["squares that turn", "Floor=square.png;Floor.width=.6;Floor.vary=turn,3", 38],
  ["tiles", "Floor=wood.png;Floor.width=.6;Floor.tiles=stone.png,square.png;Floor.vary=flip,2", 42],
  ["herringbone", "Floor=wood.png;Floor.width=.8,.3;Floor.repeat=herringbone;Floor.grout=.05;Floor.vary=flip", 44, 41],
  ["herringbone of tall repeats", "Floor=wood.png;Floor.width=.3,.7;Floor.repeat=herringbone;Floor.scale=.8", 45],
  ["basket", "Floor=wood.png;Floor.width=.8,.38;Floor.repeat=basket;Floor.grout=.04", 43],
  ["hexagons", "Floor=wood.png;Floor.width=.6;Floor.repeat=hexagon;Floor.grout=.06;Floor.vary=turn", 39],
  ["layers on the original", "over:Floor=logo.png;over:Floor.at=.3,.2;over:Floor.width=1.4;over:Floor.rotate=20;over2:Floor=wood.png;over2:Floor.at=-.3,.4;over2:Floor.width=1.8;" +
    "over2:Floor.saturation=0;over2:Floor.flip=u;over3:Floor=logo.png;over3:Floor.at=0,-.1;over3:Floor.width=.7,.5;over3:Floor.hue=90", 46],
  ["layers on a texture", "Floor=stone.png;Floor.width=.5;Floor.repeat=brick;over:Floor=logo.png;over:Floor.at=.3,.2;over:Floor.width=1.4;over:Floor.rotate=20;over:Floor.gain=.7", 47, 42],
];
const drawings = cases.flatMap(([name, text, head, grazing]) => [["above", head], ["along", grazing]].filter(([, decibels]) => decibels).map(([view, decibels]) => ({ name, text, view, decibels })));
let expected; // all at once, for each run of Python takes half a second

test("the tools draw them", () => {
  drawings.forEach(({ text, view }, i) => tool("retex-combine", "-q", `${view}.exr`, ...edits(text).args, "-o", `expected-${i}.png`));
  expected = images(drawings.map((_, i) => `expected-${i}.png`));
});

drawings.forEach(({ name, text, view, decibels }, i) => test(`drawn as retex-combine does, ${view}: ${name}`, () =>
  least(psnr(rooms[view].draw(edits(text).textures), expected[i]), decibels, `${name}, ${view}`)));
