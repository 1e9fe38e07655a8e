/* The grammar of links: the cases of tests/data/edits.txt, which the library is tested with too, and what only the player
 * has. Colours are compared as the shaders get them. */
import { readFileSync } from "node:fs";
import { fails, near, random, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

const { srgbDecode, readColor, parseColor, parseEdit, editText } = player();

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
});

/* ---- edits ---- */

/* What a text says, with colours as numbers. */
function saidBy(text) {
  const { textures, light } = parseEdit(text);
  const colored = Object.entries(textures).map(([name, t]) => [name, { ...t, source: parseColor(t.source)?.map(Math.fround).join() ?? t.source }]);
  return editText({ textures: Object.fromEntries(colored), light });
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
  const state = { textures: Object.assign(Object.create(null), { Floor: { source: "a.jpg", scale: [2, 3], tint: "#fda" } }), light: { exposure: 0.5, warmth: -1 } };
  same(parseEdit("warmth=-1;Floor.tint=#fda&Floor=a.jpg;exposure=.5;Floor.scale=2,3"), state);
  same(editText(state), "Floor=a.jpg;Floor.scale=2,3;Floor.tint=#fda;exposure=0.5;warmth=-1");
  same(parseEdit("exposure=a.jpg;exposure.scale=2").textures.exposure, { source: "a.jpg", scale: [2, 2] });
  for (const text of ["exposure=1;exposure=2", "Floor=a;Floor.tint=rde"]) await fails(() => parseEdit(text), /twice|tint/, text);
  same(editText({}), "");
});

test("random states come back from their texts", () => {
  const next = random(3), of = (list) => list[next(0, list.length - 1)];
  const number = () => (next(-1000, 1000) / 100 || 1) * (next(0, 5) ? 1 : 10 ** next(-30, 30));
  const word = () => Array.from({ length: next(1, 6) }, () => of([..."aZ.;&%25 Eé#()/:_\n"])).join("");
  for (let k = 0; k < 2000; k++) {
    const textures = Object.create(null);
    for (let n = next(0, 3); n > 0; n--)
      textures[word()] = { source: `./${word()}=`, scale: [number(), number()], rotate: number(), offset: [number(), number()], flip: of(["u", "v", "uv"]),
        wrap: of(["clamp", "mirror,repeat"]), repeat: "mirror", tint: of(["tan", "#123"]) };
    const state = { textures, light: { exposure: number() } }, text = editText(state);
    same(parseEdit(text), state, text);
    same(editText(parseEdit(text)), text);
  }
});
