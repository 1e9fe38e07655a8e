// ---- how textures lie ----

import { ADJUSTMENTS, BONDS, OPTIONS, REPEATS, WRAPS, checkLaying, mixesUnits, textOf } from "./edit.js";
import { rint } from "./lay.js";
import { clamp } from "./values.js";

/* A file's name as people read it. */
export const wordsOf = (name) => name.replace(/\.\w+$/, "").replace(/[-_]+/g, " ");

export const plainTexture = () => ({
  source: null, label: "Original", image: null, scale: 1, rotate: 0, offset: [0, 0], flip: "", wrap: "repeat", repeat: "straight", width: "", grout: "", groutcolor: "",
  vary: "", at: "", tiles: "", adjust: {}, finish: "", normal: "", map: null, mapLabel: "", channel: null, tileImages: [], overs: [],
});

/* What the options of a texture may be. */
export const isPair = (x) => Array.isArray(x) && x.length === 2 && x.every(Number.isFinite);
const PLACING = {
  scale: (x) => (Number.isFinite(x) || isPair(x)) && ![x].flat().includes(0),
  rotate: Number.isFinite,
  offset: isPair,
  flip: (x) => /^(u|v|uv|)$/.test(x),
  wrap: (x) => { const modes = String(x).split(","); return modes.length < 3 && modes.every((m) => WRAPS.includes(m)); },
  repeat: (x) => [...REPEATS, ...BONDS].includes(x),
  label: (x) => typeof x === "string",
};
/* Those that are read as in links. */
export const LAYING = ["width", "grout", "groutcolor", "vary", "at"];

/* An option as links have it: "" is none. */
export function readOption(key, value) {
  const [read, unsaid] = OPTIONS[key], text = textOf(value === true ? "yes" : value === false ? "" : value), said = text === unsaid || !text ? "" : read(text);
  if (said === undefined) throw new Error(`A texture's ${key} cannot be ${JSON.stringify(value)}.`);
  return said;
}

/* What `options` change about how a texture lies and looks. Adjustments stay in the order in which they are made. */
export function placing(texture, options) {
  const placed = { adjust: { ...texture.adjust } };
  for (const key in PLACING) {
    placed[key] = options[key] ?? texture[key];
    if (!PLACING[key](placed[key])) throw new Error(`A texture's ${key} cannot be ${JSON.stringify(placed[key])}.`);
  }
  for (const key of LAYING) placed[key] = options[key] === undefined ? texture[key] : readOption(key, options[key] ?? "");
  for (const key of Object.keys(options)) {
    if (!(key in ADJUSTMENTS) || options[key] === undefined) continue;
    const said = readOption(key, options[key] ?? "");
    if (said === "") delete placed.adjust[key];
    else placed.adjust[key] = said;
  }
  checkLaying("A texture's", { ...placed, tiles: texture.tiles });
  if (mixesUnits([placed.width, placed.grout, placed.at])) throw new Error("A texture's lengths all have a unit, or none has.");
  if (typeof placed.at === "string" && placed.at && !placed.width) throw new Error("A texture's at with lengths needs width.");
  if (options.colorspace && options.colorspace !== "sRGB") throw new Error("A texture's colorspace is for the tools, not for this page.");
  return placed;
}

/* How an image of that size lies on a target: a matrix by columns, and an offset. period: how many of its repeats it has. With
 * a width, a whole number of repeats goes round surfaces that close. */
export function lie({ scale, rotate, offset, flip, width, at }, { uv_scale: unit, periodic }, wrap, size, period) {
  const before = scale.map((x) => bounded(x, 1e100)), after = [1, 1], quarters = rotate / 90, isWhole = quarters % 1 === 0, angle = (rotate % 360) * Math.PI / 180;
  const [c, s] = [Math.cos(angle), Math.sin(angle)].map((x) => (isWhole ? Math.round(x) : x)), turn = [[c, -s], [s, c]];
  if (width) {
    for (const axis of [0, 1]) {
      before[axis] *= unit[axis];
      after[axis] = bounded(1 / (width[axis] || width[0] * size[1] / size[0]), 1e100);
    }
    for (const axis of [0, 1]) {
      const of = quarters % 2 === 0 ? axis : 1 - axis, around = Math.abs(before[axis] * after[of] / (wrap[of] === "mirror" ? 2 : period[of]));
      if (periodic?.[axis] && isWhole && around < 1e15 && ["repeat", "mirror"].includes(wrap[of])) before[axis] *= Math.max(1, rint(around)) / around;
    }
  }
  const placed = offset.map((x, k) => (at ? x + 0.5 - [0, 1].reduce((sum, i) => sum + after[k] * turn[k][i] * before[i] * at[i] / (width ? unit[i] : 1), 0) : x));
  const row = (k) => [0, 1].map((i) => (flip.includes("uv"[k]) ? -1 : 1) / period[k] * turn[k][i] * bounded(after[k] * before[i], 1e6));
  const [u, v] = [row(0), row(1)];
  return {
    turn: [u[0], v[0], u[1], v[1]],
    offset: placed.map((x, k) => {
      const found = (flip.includes("uv"[k]) ? 1 - x : x) / period[k];
      return Math.abs(found) < 1e3 ? found : ["repeat", "mirror"].includes(wrap[k]) ? clamp(found, -1e15, 1e15) % 2 : clamp(found, -1e6, 1e6);
    }),
  };
}

/* Beyond a million all is an average, or one texel; and shaders have no larger numbers. */
const bounded = (x, most) => Math.sign(x) * clamp(Math.abs(x), 1 / most, most);
