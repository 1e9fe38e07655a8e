/* The player's whole picture, shaders included: a room that retex-pack wrote, drawn by the Renderer on webgl.mjs, against
 * retex-combine's pictures of its set. */
import { readdirSync, writeFileSync } from "node:fs";
import { near, same, test } from "./tap.mjs";
import { player } from "./player.mjs";
import { compile } from "./glsl.mjs";
import { folder, images, least, open, psnr, run, scenes, tool, write } from "./room.mjs";
import { WebGLTexture } from "./webgl.mjs";

const { isRelit, readFolder } = player();

const TEXTURES = `${scenes}/textures`;
let whole;

test("a room is made", () => {
  tool("retex-render", "-q", "--size", "48x27", "--spp", "32", "--denoise", "-t", "Floor", "-t", "Wall", `${scenes}/living-room/living-room.pov`, "-o", "s.exr");
  tool("retex-pack", "-q", "s.exr", "--web", "room");
  whole = open("room");
});

const cases = [
  ["originals", {}, [], 38],
  ["a floor", { Floor: "walnut-herringbone.jpg" }, [], 37],
  ["a floor that is turned, moved, scaled and flipped", { Floor: ["fans.jpg", { scale: [3, 2], rotate: 30, offset: [0.2, 0.5], flip: "u" }] },
    ["scale=3,2:rotate=30:offset=0.2,0.5:flip=u"], 36],
  ["both", { Floor: "terrazzo.jpg", Wall: "damask.jpg" }, [], 36],
  ["colours", { Floor: [0.8, 0.1, 0.1], Wall: [0.2, 0.3, 0.7] }, [], 38],
  ["black beyond a wall's picture", { Wall: ["brick.jpg", { scale: [0.5, 0.5], offset: [0.2, 0.1], wrap: "black" }] }, ["scale=0.5:offset=0.2,0.1:wrap=black"], 35],
];
for (const [name, edits, options, decibels] of cases)
  test(`drawn as retex-combine does: ${name}`, () => {
    const textures = {}, args = [];
    Object.entries(edits).forEach(([target, edit], i) => {
      const isColor = typeof edit[0] === "number", [file, placed] = Array.isArray(edit) && !isColor ? edit : [edit, {}];
      textures[target] = { ...placed, image: isColor ? edit : images([`${TEXTURES}/${file}`])[0] };
      args.push(["--texture", ...(options[i] ? [options[i]] : [])].join(":"), `${target}=${isColor ? `rgb(${edit})` : `${TEXTURES}/${file}`}`);
    });
    tool("retex-combine", "-q", "s.exr", ...args, "-o", "expected.png");
    least(psnr(whole.draw(textures), images(["expected.png"])[0]), decibels, name);
  });

test("left of the split are the original textures, right of it the new ones", () => {
  tool("retex-combine", "-q", "s.exr", "-o", "before.png");
  tool("retex-combine", "-q", "s.exr", "--texture", "Floor=rgb(0.1,0.2,0.7)", "-o", "after.png");
  const [before, after] = images(["before.png", "after.png"]), picture = whole.draw({ Floor: { image: [0.1, 0.2, 0.7] } }, { split: 20 });
  least(psnr(picture, before, [0, 20]), 36, "left");
  least(psnr(picture, after, [20, 48]), 36, "right");
});

test("tints and the light multiply linear colours", () => {
  const white = whole.draw({ Floor: { image: [0.5, 0.4, 0.3], tint: "#bc80ff" } }), direct = whole.draw({ Floor: { image: [0.5, 0.4, 0.3].map((x, k) =>
    x * [((188 / 255 + 0.055) / 1.055) ** 2.4, ((128 / 255 + 0.055) / 1.055) ** 2.4, 1][k]) } });
  near([...white.values], [...direct.values], 1e-6, "tint");
  const linear = (y) => (y <= 0.04045 ? y / 12.92 : ((y + 0.055) / 1.055) ** 2.4), lamp = [2 ** -1.4, 0.5, 2 ** -0.6];
  const plain = whole.draw({}), dim = whole.draw({}, { light: { exposure: -1, warmth: -1 } });
  plain.values.forEach((y, i) => i % 4 < 3 && y < 0.999 && near(linear(dim.values[i]), linear(y) * lamp[i % 4], 1e-6, `value ${i}`));
});

/* A room whose light is as fine as JPEG files have it, so that what is developed shows. */
let fine;
for (const [text, decibels] of [["picture:exposure=1", 42], ["picture:white-balance=3000", 42], ["picture:white-balance=12000;picture:exposure=-2", 42], ["picture:view=Filmic", 42],
  ["picture:view=Filmic;picture:exposure=2", 42], ["picture:view=Neutral", 42], ["picture:view=Neutral;picture:exposure=1", 42], ["picture:view=raw", 42],
  ["picture:auto-exposure=yes", 42], ["picture:auto-exposure=yes;picture:exposure=-1;picture:white-balance=4000;picture:view=Filmic", 42]])
  test(`developed as retex-combine does: ${text}`, () => {
    if (!fine) tool("retex-pack", "-q", "--quality", "100", "s.exr", "--web", "fine");
    fine ||= open("fine");
    const { parseEdit, checkedLight } = player();
    write("p.json", JSON.stringify({ "retex-preset": 1, edit: text }));
    tool("retex-combine", "-q", "s.exr", "--preset", "p.json", "-o", "expected.png");
    const expected = images(["expected.png"])[0], light = checkedLight(parseEdit(text).light);
    least(psnr(fine.draw({}, { light }), expected), decibels, text);
  });

test("the automatic exposure is that of the new picture, also of what the split hides", () => {
  tool("retex-combine", "-q", "s.exr", "--auto-exposure", "--texture", "Floor=rgb(0.02,0.02,0.02)", "-o", "expected.png");
  const picture = fine.draw({ Floor: { image: [0.02, 0.02, 0.02] } }, { light: { autoExposure: true }, split: 30 });
  least(psnr(picture, images(["expected.png"])[0], [30, 48]), 40, "right of the split");
});

test("lamps have their own light: the picture is that of the set with the lamp in that colour", () => {
  const program = (...args) => tool("../tests/bin/make_lamps", ...args), colors = [[0.25, 1, 0], [1, 1, 1]];
  program("s.exr", "lamps.exr");
  program("s.exr", "green.exr", "0.25,1,0");
  tool("retex-pack", "-q", "lamps.exr", "--web", "lamps");
  const { room, draw } = open("lamps"), floor = { Floor: { image: [0.8, 0.1, 0.1] } };
  same(room.parameters, [{ name: "Lamp", value: [1, 0.5, 2] }, { name: "Window", value: [1, 1, 1] }]);
  for (const set of ["lamps", "green"]) tool("retex-combine", "-q", `${set}.exr`, "--texture", "Floor=rgb(0.8,0.1,0.1)", "-o", `${set}.png`);
  const [rendered, green] = images(["lamps.png", "green.png"]);
  least(psnr(draw(floor), rendered), 36, "as rendered");
  least(psnr(draw(floor, { colors }), green), 36, "green");
  tool("retex-combine", "-q", "lamps.exr", "-o", "before.png");
  const half = draw(floor, { colors, split: 20 });
  least(psnr(half, images(["before.png"])[0], [0, 20]), 36, "left of the split: original textures, lamps as rendered");
  least(psnr(half, green, [20, 48]), 36, "right of it");
  const partial = open("lamps", { classes: (c) => c.target === 0 || c.kind === "interreflection" });
  const before = psnr(partial.draw(floor), green);
  least(psnr(partial.draw(floor, { colors }), green), before + 2, "nearer, while not all is loaded");
});

/* Of one target and of two, on colours and pictures, where a texture is clear, and left of the split. */
test("maps of finishes: drawn as retex-combine draws them", () => {
  tool("retex-render", "-q", "--size", "40x30", "--spp", "64", "--denoise", "--finish", "Floor=original,Gloss,matt", "--finish", "Wall=original,satin",
    new URL("../cli/finishes.pov", import.meta.url).pathname, "-o", "shiny.exr");
  tool("retex-pack", "-q", "shiny.exr", "--web", "shiny");
  const { room, draw } = open("shiny"), { parameterColors } = player();
  run("/usr/bin/python3", "-c", `import OpenImageIO as o, numpy as n
def put(name, rows):
  out = o.ImageOutput.create(name); out.open(name, o.ImageSpec(rows.shape[1], rows.shape[0], rows.shape[2], "uint8")); out.write_image(rows.astype("uint8")); out.close()
y, x = n.mgrid[0:16, 0:24]
put("grey.png", n.repeat((((x // 6 + y // 4) % 2) * 200 + x)[:, :, None], 3, axis=2))
put("colors.png", n.stack([x * 10, y * 14, 0 * x], axis=2))
put("clear.png", n.stack([200 + 0 * x, x * 8, y * 12, ((x // 6 + y // 6) % 2) * 255], axis=2))
put("wood.png", n.stack([x * 10, 255 - x * 6, 40 + y * 12], axis=2))
import os
for folder, last in ("rough", 0), ("gloss", 0), ("arm", 1):
  os.mkdir(folder); os.link("wood.png", folder + "/wood_diff.png"); rows = n.repeat((((x // 6 + y // 4) % 2) * 120 + 4 * x)[:, :, None], 3, axis=2)
  for c in range(3): rows[:, :, c] = rows[:, :, c] if c == last else 90
  put(f"{folder}/wood_{folder}.png", rows)`);
  for (const [what, edits, decibels, chosen = {}, split = 0] of [
    ["a grey map, right of the split", { Floor: ["wood.png", "grey.png"] }, 34, {}, 10],
    ["two maps", { Floor: ["wood.png", "colors.png", "scale=2:rotate=20:offset=0.1,0.3", { scale: [2, 2], rotate: 20, offset: [0.1, 0.3] }], Wall: [[0.3, 0.5, 0.8], "grey.png"] }, 34],
    ["laid repeats", { Floor: ["wood.png", "grey.png", "width=2,1.5:repeat=brick:grout=.3:saturation=.4", { width: [2, 1.5], repeat: "brick", grout: 0.3, saturation: 0.4 }] }, 34],
    ["a folder with roughness", { Floor: ["rough"] }, 34],
    ["a folder with gloss", { Floor: ["gloss"] }, 34],
    ["a folder with roughness in green", { Floor: ["arm"] }, 34],
    ["a clear floor", { Floor: ["clear.png", "grey.png", "wrap=mirror", { wrap: "mirror" }] }, 34, { Floor: "matt", Wall: "satin" }]]) {
    const textures = {}, args = Object.entries(chosen).flatMap(([t, f]) => ["--finish", `${t}=${f}`]);
    for (const [target, [image, map, text = "scale=1", placed = {}]] of Object.entries(edits)) {
      const isColor = Array.isArray(image);
      if (!map) {
        const { color, rough, channel } = readFolder(readdirSync(`${folder}/${image}`).map((name) => ({ name: `${image}/${name}` })));
        textures[target] = { image: images([color.name])[0], map: images([rough.name])[0], channel, scale: [1, 1] };
        args.push("--texture", `${target}=${image}`);
        continue;
      }
      textures[target] = { image: isColor ? image : images([image])[0], map: images([map])[0], scale: [1, 1], ...placed };
      args.push(`--texture:finish=${map}:${text}`, `${target}=${isColor ? `rgb(${image})` : image}`);
    }
    tool("retex-combine", "-q", "shiny.exr", ...args, "-o", "expected.png");
    const numbers = room.targets.map((t) => (chosen[t.name] ? 1 + t.finishes.indexOf(chosen[t.name]) : t.finish));
    const colors = parameterColors(room, [], numbers.map((f, t) => (edits[room.targets[t].name] ? null : f)));
    const picture = draw(textures, { colors, finishes: numbers, split });
    least(psnr(picture, images(["expected.png"])[0], [split, 40]), decibels, what);
    if (!split) continue;
    tool("retex-combine", "-q", "shiny.exr", "-o", "before.png");
    least(psnr(picture, images(["before.png"])[0], [0, split]), 36, "left of it");
  }
});

/* A room with a bright lamp and a dim one, each with its edge of a shadow, and a third that is off. */
const LIT = `#version 3.7; global_settings { assumed_gamma 1 } #default { finish { diffuse .8 ambient 0 } } background { rgb <.1, .12, .15> }
  camera { location <0, 1.2, -3> look_at <0, .8, 0> angle 60 } #declare Floor = texture { pigment { checker rgb <.7, .5, .3> rgb .3 scale .4 } }
  #declare Wall = texture { pigment { rgb <.5, .6, .55> } } plane { y, 0 texture { Floor } } box { <-3, 0, 1.5> <3, 3, 1.6> texture { Wall } }
  sphere { <.4, .5, .3>, .5 pigment { rgb <.8, .2, .2> } } #declare Sun = light_source { <3, 5, -4> rgb <1, .9, .7> } light_source { Sun }
  #declare Bulb = light_source { <-1, 1.8, .2> rgb <.3, .2, .12> fade_distance 1 fade_power 2 } light_source { Bulb }
  #declare Spare = light_source { <1, 2, -1> 0 } light_source { Spare }`;
const lamp = (gain, color) => ({ gain, color });

test("single lamps: drawn as retex-combine draws them, alone, in mixtures and with new textures", () => {
  writeFileSync(`${folder}/lit.pov`, LIT);
  tool("retex-render", "-q", "--size", "40x30", "--spp", "64", "--denoise", "-t", "Floor", "-t", "Wall", "--lamps", "each", "lit.pov", "-o", "lit.exr");
  tool("retex-pack", "-q", "lit.exr", "--web", "lit");
  const { room, draw, renderer } = open("lit"), names = room.parameters.map((p) => p.name), { lampColor } = player();
  same([names, renderer.lacksLamps, isRelit(room, renderer.rendered)], [["Sun", "Bulb", "Spare"], false, true]);
  const colors = (values) => room.parameters.map((p) => (values[p.name] || values["*"] ? lampColor(values[p.name] || values["*"], p) : p.value));
  const [hue, blue] = [[1.2, 0.9, 1.3], [0.3, 0.8, 1.2]].map((color) => color.map((x) => x / (0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2])));
  const text = ({ gain, color }) => (color ? `${gain}*rgb(${color})` : `${gain}`), off = lamp(0);
  for (const [what, values, floor, decibels] of [["as rendered", {}, null, 37], ["the sun alone", { "*": off, Sun: lamp(1) }, null, 37], ["the bulb alone, brighter", { "*": off, Bulb: lamp(4) }, null, 36],
    ["the lamp that is off, alone", { "*": off, Spare: lamp(0.5) }, null, 37],
    ["a blue bulb, a dim sun, a new floor", { Bulb: lamp(3, blue), Sun: lamp(0.2) }, [0.1, 0.5, 0.2], 37], ["a mixture of all", { Sun: lamp(0.5, blue), Bulb: lamp(2), Spare: lamp(0.3, hue) }, [0.6, 0.3, 0.2], 37]]) {
    const lights = Object.entries(values).flatMap(([name, value]) => ["--light", `${name}=${text(value)}`]);
    tool("retex-combine", "-q", "lit.exr", ...lights, ...(floor ? ["--texture", `Floor=rgb(${floor})`] : []), "-o", "expected.png");
    least(psnr(draw(floor ? { Floor: { image: floor } } : {}, { colors: colors(values) }), images(["expected.png"])[0]), decibels, what);
  }
  tool("retex-combine", "-q", "lit.exr", "-o", "before.png");
  const before = images(["before.png"])[0], half = draw({ Floor: { image: [0.1, 0.2, 0.7] } }, { colors: colors({ Sun: lamp(0) }), split: 20 });
  least(psnr(half, before, [0, 20]), 36, "left of the split: as rendered");
  const partial = open("lit", { classes: (c) => c.target === 0 || c.kind === "interreflection" }), dark = colors({ Sun: lamp(0.1) });
  tool("retex-combine", "-q", "lit.exr", "--light", "Sun=0.1", "-o", "expected.png");
  const expected = images(["expected.png"])[0], rendered = psnr(partial.draw({}), expected);
  least(psnr(partial.draw({}, { colors: dark }), expected), rendered + 1, "nearer, while not all is loaded");
});

test("shares of lamps are enlarged bilinearly, constant beyond the outermost centres, and add up", () => {
  const { lampShader } = player(), tiles = new WebGLTexture(), terms = new WebGLTexture(), [x0, y0, width, height, times] = [2, 1, 3, 2, 4], white = [1.5, 1.2, 0.9];
  tiles.store("RGBA8", 8, 4, 0);
  terms.store("RGBA32F", 16, 3, 0);
  tiles.images[0][0].values.forEach((_, i, all) => (all[i] = ((i * 37) % 101) / 101));
  for (const [row, lamp] of [[1, 0], [2, 1]]) {
    terms.put(0, 0, row, 3, 1, [x0, y0, width, height, times, 255, lamp, 0, ...white, 0], 4, (v) => v);
  }
  const shade = compile(lampShader({ parameters: [{}, {}] })).run({ tiles, terms, first: 1, end: 3, group: -1, colors: [[2, 3, 4], [10, 20, 30]] });
  const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4), tent = (a, b) => Math.max(0, 1 - Math.abs(a - b));
  for (let y = 0; y < height * times; y++)
    for (let x = 0; x < width * times; x++) {
      const [u, v] = [[x, width], [y, height]].map(([at, size]) => Math.min(Math.max((at + 0.5) / times - 0.5, 0), size - 1)), expected = [0, 0, 0];
      for (let j = 0; j < height; j++)
        for (let i = 0; i < width; i++)
          for (let k = 0; k < 3; k++)
            expected[k] += tent(u, i) * tent(v, j) * white[k] * linear(tiles.images[0][0].values[4 * ((y0 + j) * 8 + x0 + i) + k]) * [12, 23, 34][k];
      near(shade([x + 0.5, y + 0.5, 0, 1]).slice(0, 3), expected, 1e-9, `${x}, ${y}`);
    }
});

test("all light counts as much as all lamps have in common, a lamp what it has beyond", () => {
  const { shareLight } = player(), room = { parameters: [{ kept: [1, 2, 4] }, { kept: [3, 0, 1] }] };
  same(shareLight(room, [[1, 2, 4], [3, 0, 1]]), { common: [1, 1, 1], beyond: [[0, 0, 0], [0, 0, 0]] });
  same(shareLight(room, [[0.5, 4, 4], [3, 7, 0]]), { common: [0.5, 2, 0], beyond: [[0, 0, 4], [1.5, 7, 0]] });
  same(shareLight({ parameters: [{ kept: [0, 1, 1] }] }, [[5, 3, 0]]), { common: [1, 3, 0], beyond: [[5, 0, 0]] });
});

test("where all lamps are as rendered, all light is drawn, to the bit, with or without their file", () => {
  const pov = LIT.replace("light_source { Spare }", "");
  writeFileSync(`${folder}/kept.pov`, pov);
  tool("retex-render", "-q", "--size", "40x30", "--spp", "16", "--denoise", "-t", "Floor", "--lamps", "each", "kept.pov", "-o", "kept.exr");
  tool("retex-pack", "-q", "kept.exr", "--web", "kept");
  tool("retex-pack", "-q", "kept.exr", "--no-lamps", "--web", "none");
  const floor = { Floor: { image: [0.1, 0.5, 0.2] } }, kept = open("kept"), none = open("none").draw(floor).values;
  same(open("kept", { lit: false }).draw(floor).values, none);
  same(kept.draw(floor).values, none);
  const values = kept.room.parameters.map((p) => p.value), first = (times) => values.map((v, i) => v.map((x) => (i ? x : x * times)));
  for (const colors of [values.map((v) => v.map((x) => x * 1.001)), first(0.999), first(1.001)]) {
    const relit = kept.draw(floor, { colors }).values;
    if (!relit.some((x, i) => x !== none[i])) throw new Error("nothing changes");
    near([...relit], [...none], 0.002, "nearly the same");
  }
  for (const times of [0.5, 3]) {
    tool("retex-combine", "-q", "kept.exr", "--light", `Sun=${times}`, "--texture", "Floor=rgb(0.1,0.5,0.2)", "-o", "expected.png");
    least(psnr(kept.draw(floor, { colors: first(times) }), images(["expected.png"])[0]), 36, `the sun times ${times}`);
  }
});

test("light with more hits than terms have follows a new colour", () => {
  writeFileSync(`${folder}/closed.pov`, `#version 3.7; global_settings { assumed_gamma 1 max_trace_level 40 }
    #default { finish { diffuse 1 ambient 0 } } camera { location <0, 1, -1.8> look_at <0, 1, 1> angle 75 }
    light_source { <0.3, 1.8, -0.3>, rgb 0.15 } #declare Room = box { <-2, 0, -2>, <2, 2.2, 2> hollow pigment { rgb 0.5 } } object { Room }
    sphere { <0.7, 0.4, 0.8>, 0.4 pigment { rgb <0.2, 0.5, 0.7> } }`);
  tool("retex-render", "-q", "--size", "48x36", "--spp", "64", "-t", "Room", "closed.pov", "-o", "closed.exr");
  tool("retex-pack", "-q", "closed.exr", "--web", "closed");
  const { room, draw } = open("closed");
  for (const [a, decibels] of [[0.5, 44], [0.9, 29]]) { /* what levels of light lose grows with light: 29 dB are 3 % */
    tool("retex-combine", "-q", "closed.exr", "--texture", `Room=rgb(${a},${a},${a})`, "-o", "expected.png");
    least(psnr(draw({ Room: { image: [a, a, a] } }), images(["expected.png"])[0]), decibels, `albedo ${a}`);
  }
  const { further, ...without } = room;
  same(further.hits, 9);
  writeFileSync(`${folder}/closed/room.json`, JSON.stringify(without));
  const lost = psnr(open("closed").draw({ Room: { image: [0.9, 0.9, 0.9] } }), images(["expected.png"])[0]);
  if (!(lost < 22)) throw new Error(`without it there are ${lost} dB`);
});

test("a transparent part of a texture shows the original one", () => {
  const size = 2, rgba = Uint8Array.from([...Array(size * size)].flatMap(() => [255, 0, 0, 0])), clear = { naturalWidth: size, naturalHeight: size, rgba };
  const original = whole.draw({}), under = whole.draw({ Floor: { image: clear } });
  near([...under.values], [...original.values], 1e-9);
});

test("while not all is loaded, the picture is the still one and what new textures change", () => {
  const partial = open("room", { classes: (c) => c.target === 0 || c.kind === "interreflection" }), [still] = images([`room/${partial.room.picture.file}`]);
  least(psnr(partial.draw({}), still), 50, "original");
  tool("retex-combine", "-q", "s.exr", "--texture", "Floor=rgb(0.8,0.1,0.1)", "-o", "expected.png");
  least(psnr(partial.draw({ Floor: { image: [0.8, 0.1, 0.1] } }), images(["expected.png"])[0]), 28, "a new floor");
});

test("a curve has one white, or one for each channel", () => {
  const linear = (y) => (y <= 0.04045 ? y / 12.92 : ((y + 0.055) / 1.055) ** 2.4), { mixtureShader, valueCode } = player(), code = [40 / 255, 90 / 255, 230 / 255];
  for (const white of [1.5, [1.5, 1.2, 0.9]]) {
    const { run: values } = compile(`${mixtureShader(whole.room).split("uniform usampler2D records")[0]}
      uniform vec3 code; out vec4 result;
      void main() { result = vec4(${valueCode("code", { white, levels: 255 })}, 1.0); }`);
    code.forEach((y, k) => near(values({ code })([0, 0])[k], (white[k] ?? white) * linear(y), 1e-8, `channel ${k}`));
  }
  const { room, renderer } = whole, { lights } = room, at = [24, 24], before = renderer.lightOf(0, ...at);
  room.lights = lights.map((l) => ({ ...l, white: [l.white, 0, 0].flat().slice(0, 3).map((w, k) => (k ? 0 : w)) }));
  const red = renderer.lightOf(0, ...at);
  room.lights = lights;
  same([before > red, red > 0], [true, true], "light of a target");
});

test("levels of light are those of retex-web(5)", () => {
  const { mixtureShader } = player(), room = whole.room;
  const { run: values } = compile(`${mixtureShader(room).split("uniform usampler2D records")[0]}
    uniform vec3 code, white; uniform float levels; out vec4 result;
    void main() { result = vec4(light(code, white, levels), 1.0); }`);
  const linear = (y) => (y <= 0.04045 ? y / 12.92 : ((y + 0.055) / 1.055) ** 2.4);
  for (const [white, levels] of [[1, 255], [2.5, 200], [0.1, 120]])
    for (let level = 0; level <= 255; level++) {
      const expected = level <= levels ? white * linear(level / levels) : white * Math.exp(((level / levels - 1) * 255) / 48);
      const is = values({ code: [level / 255, level / 255, level / 255], white: [white, 2 * white, 3 * white], levels })([0, 0]);
      for (const k of [0, 1, 2]) near(is[k], (k + 1) * expected, expected * 1e-8, `level ${level} of ${levels}, channel ${k}`);
    }
});
