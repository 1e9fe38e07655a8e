/* The grammar of links: the cases of tests/data/edits.txt, which the library is tested with too, and what only the player
 * has. Colours are compared as the shaders get them. */
import { readFileSync } from "node:fs";
import { fails, near, random, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

const { srgbDecode, readColor, parseColor, parseEdit, editText, parseLamp, lampText, lampColor, kelvinColor, miredOf, kelvinOf, lampsOf, parameterColors, parsePreset } = player();

/* ---- colours ---- */

test("sRGB is decoded by the curve of IEC 61966-2-1", () => {
  const encode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
  for (let k = 0; k <= 255; k++) near(encode(srgbDecode(k / 255)), k / 255, 1e-7, `code ${k}`);
  same([0, 1].map(srgbDecode), [0, 1]);
  near([0.04045, 0.04045 + 1e-9].map(srgbDecode), [0.0031308, 0.0031308], 1e-7, "its two parts meet");
});

test("colours by codes, names and numbers", async () => {
  const orange = [1, ((128 / 255 + 0.055) / 1.055) ** 2.4, 0];
  for (const text of ["#Ff8000", " #ff8000 ", `srgb(1,${128 / 255},0)`, `rgb(1, ${orange[1]},0)`]) near(readColor(text), orange, 1e-12, text);
  same(readColor("#f80"), readColor("#ff8800"));
  same(readColor("NavajoWhite"), readColor("#ffdead"));
  same(readColor("rgb(0.5, .25,1e1)"), [0.5, 0.25, 10]);
  for (const text of ["rde", "b.jpg", "a#ffffff", "#1.png", "./red", "ffdead", "tan=", "", "blob:x"]) same(readColor(text), null, text);
  for (const text of ["#ff88", "#", "#ggg", "rgb(1,2)", "rgb(-1,0,0)", "srgb(0,255,0)", "rgb(1,2,3"]) {
    await fails(() => readColor(text), /^'.*' is no colour: expected /, text);
    same(parseColor(text), null, text);
  }
  await fails(() => readColor("rgb(1,2)"), "'rgb(1,2)' is no colour: expected rgb(r,g,b) with three numbers of 0 or more.");
  await fails(() => readColor("sRGB(1,2,3)"), "'sRGB(1,2,3)' is no colour: expected srgb(r,g,b) with three numbers from 0 to 1.");
});

/* ---- edits ---- */

const isColored = ["source", "groutcolor", "tint", "colorize"];

/* What a text says, with colours as numbers. */
function saidBy(text) {
  const { textures, light, lamps, finishes } = parseEdit(text);
  const colored = Object.entries(textures).map(([name, t]) => [name, Object.fromEntries(Object.entries(t).map(([key, value]) => [key, isColored.includes(key) ? parseColor(value)?.map(Math.fround).join() ?? value : value]))]);
  return editText({ textures: Object.fromEntries(colored), light, lamps, finishes });
}

test("the cases that the library has", async () => {
  let text, cases = 0;
  for (const line of readFileSync("tests/data/edits.txt", "utf8").split("\n")) {
    const rest = line.slice(2);
    if (line[0] === "<") text = rest;
    if (line[0] === ">") {
      same(saidBy(text), saidBy(rest), text);
      same(editText(parseEdit(rest)), rest, text);
    }
    if (line[0] === "!") await fails(() => parseEdit(text), /./, text);
    cases += line[0] === ">" || line[0] === "!";
  }
  if (cases < 90) throw new Error(`${cases} cases`);
});

test("a picture without a scale lies as the tools lay it", () => {
  same(Object.values(parseEdit("Floor=a.jpg;Wall=tan;Sofa=b;Sofa.scale=2").textures),
    [{ source: "a.jpg", scale: [1, 1] }, { source: "tan" }, { source: "b", scale: [2, 2] }]);
});

test("light and tints are statements too", async () => {
  const state = { textures: Object.assign(Object.create(null), { Floor: { source: "a.jpg", scale: [2, 3], tint: "#fda" } }), light: { exposure: 0.5, warmth: -1 }, lamps: Object.create(null), finishes: Object.create(null) };
  same(parseEdit("warmth=-1;Floor.tint=#fda&Floor=a.jpg;picture:exposure=.5;Floor.scale=2,3"), state);
  same(editText(state), "Floor=a.jpg;Floor.scale=2,3;Floor.tint=#fda;picture:exposure=0.5;warmth=-1");
  same(parseEdit("exposure=a.jpg;exposure.scale=2").textures.exposure, { source: "a.jpg", scale: [2, 2] });
  same(parseEdit("picture:view=filmic;picture:white-balance=4e3;picture:auto-exposure=YES;picture:exposure=-0").light, { view: "filmic", whiteBalance: 4000, autoExposure: true, exposure: 0 });
  for (const text of ["picture:exposure=1;picture:exposure=2", "warmth=1;warmth=2", "Floor=a;Floor.tint=rde"]) await fails(() => parseEdit(text), /twice|tint/, text);
  same(editText({}), "");
});

/* ---- lamps ---- */

test("black bodies are as Planck's law and the observer's own fit have them", () => {
  const g = (x, mean, below, above) => Math.exp(-((x - mean) ** 2) / (2 * (x < mean ? below : above) ** 2));
  for (const kelvin of [1000, 2700, 6504, 40000]) {
    let [X, Y, Z] = [0, 0, 0];
    for (let nm = 360; nm <= 830; nm++) { // steps of 1 nm
      const power = 1 / ((nm / 560) ** 5 * (Math.exp(1.438776877e7 / nm / kelvin) - 1));
      X += power * (1.056 * g(nm, 599.8, 37.9, 31) + 0.362 * g(nm, 442, 16, 26.7) - 0.065 * g(nm, 501.1, 20.4, 26.2));
      Y += power * (0.821 * g(nm, 568.8, 46.9, 40.5) + 0.286 * g(nm, 530.9, 16.3, 31.1));
      Z += power * (1.217 * g(nm, 437, 11.8, 36) + 0.681 * g(nm, 459, 26, 13.8));
    }
    const rgb = [3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.969266 * X + 1.8760108 * Y + 0.041556 * Z, 0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z]
      .map((c) => Math.max(c / Y, 0)), luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    near(kelvinColor(kelvin), rgb.map((c) => c / luminance), 2e-3, `${kelvin} K`);
  }
});

test("what a value makes of a lamp: numbers multiply, colours keep its luminance, or multiply light of several", () => {
  const lamp = { value: [5, 5.6, 6.3], kept: [5, 5.6, 6.3] }, off = { value: [0, 0, 0], kept: [1, 2, 3] };
  const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b, of = (text, which) => lampColor(parseLamp(text), which);
  same(of("2", lamp), [10, 11.2, 12.6]);
  same(of("0", lamp), [0, 0, 0]);
  same(of("1", off), [1, 2, 3]);
  near(luminance(of("tomato", lamp)), luminance(lamp.value), 1e-5);
  near(of("rgb(7,7,7)*2", lamp), Array(3).fill(2 * luminance(lamp.value)), 1e-9);
  near(of("rgb(1,1,2)", { ...lamp, several: true }), [5, 5.6, 12.6].map((x) => x / luminance([1, 1, 2])), 1e-5);
  same(of("3", { value: [1, 0.5, 2] }), [3, 1.5, 6]); // a set without terms of single lamps
});

test("a map of finishes is an option, of colours too, which then have a scale", () => {
  const text = "Floor=oak.jpg;Floor.finish=maps/a.png;Wall=tan;Wall.finish=b.png", state = parseEdit(text);
  same([state.textures.Floor.finish, state.textures.Wall.scale], ["maps/a.png", [1, 1]]);
  same([editText(state), editText(parseEdit("Floor=oak.jpg;Floor.finish=none"))], [text, "Floor=oak.jpg"]);
});

test("a normal map stays in states and links, which pages do not show", () => {
  const text = "Wall=oak.jpg;Wall.normal=maps/a.png,dx", state = parseEdit(text);
  same([state.textures.Wall.normal, editText(state)], ["maps/a.png,dx", text]);
});

/* Two targets of two and three finishes and one without, two lamps and light of none. */
function withFinishes() {
  const parameters = [], add = (lamp, value, finishes, name = `${lamp} ${finishes}`) => parameters.push({ name, lamp, value, kept: value, finishes });
  for (const [lamp, value] of [["Sun", [2, 4, 6]], ["", [1, 1, 1]], ["Spot", [0, 0, 0]]])
    for (const finishes of [[1, 0, 2], [0, 0, 0], [2, 0, 2], [2, 0, 3]]) add(lamp, value, finishes);
  parameters[9].kept = [3, 3, 3]; // of Spot, which is off
  return { targets: [{ name: "Floor", finishes: ["matt", "satin"], finish: 1 }, { name: "Rug" }, { name: "Wall", finishes: ["a", "b", "c"], finish: 2 }], parameters };
}

test("light has its lamp's colour with the finishes that are chosen, and none with others", () => {
  const room = withFinishes(), black = [0, 0, 0], white = [1, 1, 1], sun = [2, 4, 6];
  same(lampsOf(room).map((l) => [l.name, l.index]), [["Sun", 1], ["Spot", 9]]);
  same(parameterColors(room, [null, null], [1, 0, 2]), [sun, sun, black, black, white, white, black, black, black, black, black, black]);
  same(parameterColors(room, [null, null], [2, 0, 2]), [black, sun, sun, black, black, white, white, black, black, black, black, black]);
  same(parameterColors(room, [null, null], [2, 0, 3]), [black, sun, black, sun, black, white, black, white, black, black, black, black]);
  same(parameterColors(room, [null, null], [1, 0, 1]).map((c) => c[2]), [0, 6, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]);
  const lit = parameterColors(room, [parseLamp("0.5"), parseLamp("2")], [2, 0, 3]);
  same(lit, [black, [1, 2, 3], black, [1, 2, 3], black, white, black, white, black, [6, 6, 6], black, [6, 6, 6]]);
  same(parameterColors({ targets: room.targets, parameters: [{ name: "x", lamp: "Gone", value: black, finishes: [1, 0, 0] }] }, [], [1, 0, 1]), [white]);
});

test("where there are no finishes, all parameters are lamps", () => {
  const room = { targets: [{ name: "Floor" }], parameters: [{ name: "Sun", value: [2, 4, 6] }, { name: "Spot", value: [0, 0, 0], kept: [3, 3, 3] }] };
  same(lampsOf(room).map((l) => l.name), ["Sun", "Spot"]);
  same(parameterColors(room, [parseLamp("2"), null], [0]), [[4, 8, 12], [0, 0, 0]]);
  same([lampsOf({}), parameterColors({}, [], [])], [[], []]);
});

test("the slider of warmth knows its own colours, and no others", () => {
  for (const mired of [100, 155, 370, 550]) {
    same(miredOf(kelvinColor(kelvinOf(mired))), mired);
    same(miredOf(kelvinColor(kelvinOf(mired)).map((x) => 7 * x)), mired, "brighter");
  }
  same([kelvinOf(100), kelvinOf(370)], [10000, 2700]);
  same([[1, 0, 0], [0, 0, 1], [0, 1, 0]].map(miredOf), [null, null, null]);
});

test("random states come back from their texts", () => {
  const next = random(3), lamps = Object.create(null), finishes = Object.create(null), of = (list) => list[next(0, list.length - 1)];
  const number = () => (next(-1000, 1000) / 100 || 1) * (next(0, 5) ? 1 : 10 ** next(-30, 30));
  const word = () => Array.from({ length: next(1, 6) }, () => of([..."aZ.;&%25 Eé#()/:_\n"])).join("");
  for (let k = 0; k < 2000; k++) {
    const textures = Object.create(null);
    for (let n = next(0, 3); n > 0; n--)
      textures[word()] = { source: `./${word()}=`, scale: [number(), number()], rotate: number(), offset: [number(), number()], flip: of(["u", "v", "uv"]),
        wrap: of(["clamp", "mirror,repeat"]), repeat: "mirror", tint: of(["tan", "#123"]) };
    lamps[word()] = lampText({ gain: Math.min(Math.abs(number()), 1e30), color: next(0, 1) ? kelvinColor(next(1000, 40000)) : null });
    finishes[word()] = word();
    if (k % 5 === 0) for (const said of [lamps, finishes]) for (const name of Object.keys(said)) delete said[name];
    const state = { textures, light: { exposure: next(-3000, 3000) / 100, warmth: number(), view: word(), whiteBalance: next(1000, 25000), autoExposure: !next(0, 1) }, lamps, finishes }, text = editText(state);
    same(parseEdit(text), state, text);
    same(editText(parseEdit(text)), text);
  }
});

test("a preset with a name that is no address is refused by a sentence", async () => {
  const preset = (edit) => parsePreset(JSON.stringify({ "retex-preset": 1, edit }), "https://a.org/looks/b.json", "https://a.org/");
  same(preset("Floor=c d.jpg").textures.Floor.source, "looks/c%20d.jpg");
  for (const name of ["\ud800.jpg", "https://[", "http://"]) await fails(() => preset(`Floor=${name}`), `'${name}' is no address of an image.`, name);
});
