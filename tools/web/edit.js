// ---- edits: the grammar of links, as in retex-edit(5) ----

import { lampText, parseLamp } from "./lamps.js";
import { numberOf, numberText, parseColor, readColor } from "./values.js";

export const REPEATS = ["straight", "mirror", "brick", "half-drop"], WRAPS = ["repeat", "mirror", "clamp", "black"];
export const BONDS = ["herringbone", "basket", "hexagon"], VARY = ["turn", "flip", "shift"];
const isShifted = (repeat) => repeat === "brick" || repeat === "half-drop";

/* One or two numbers that are allowed, and what stands for the second. */
function pairOf(text, isAllowed, second = (first) => first) {
  const [u, v = second(u), ...rest] = text.split(",").map(numberOf);
  return rest.length || ![u, v].every((x) => isFinite(x) && isAllowed(x)) ? undefined : [u, v];
}
const wordOf = (text, words) => words.find((word) => word === text.toLowerCase());
function wrapsOf(text) {
  const modes = text.split(",").map((mode) => wordOf(mode, WRAPS));
  return modes.length > 2 || modes.includes(undefined) ? undefined : modes[0] === modes[1] ? modes[0] : modes.join();
}

/* `count` numbers from `least` to `most`, or one for all. */
function numbersOf(text, count, least, most) {
  const numbers = text.split(",").map(numberOf), all = numbers.length === 1 ? Array(count).fill(numbers[0]) : numbers;
  return all.length === count && all.every((x) => x >= least && x <= most) ? all : undefined;
}
/* Metres in a unit of length, as a fraction. */
const UNITS = { mm: [1, 1000], cm: [1, 100], m: [1, 1], in: [254, 10000], ft: [3048, 10000] };
/* One or two lengths that are allowed: numbers, or, if all have a unit, a text in metres. */
function lengthsOf(text, isAllowed) {
  const parts = text.split(",").map((part) => /^(.*?)(mm|cm|m|in|ft)?$/is.exec(part.trim())), units = parts.filter((part) => part[2]).length;
  const lengths = parts.map(([, number, unit]) => (([top, bottom]) => (numberOf(number) * top) / bottom)(UNITS[(unit || "m").toLowerCase()]));
  if (lengths.length > 2 || (units && units < lengths.length) || !lengths.every((x) => isFinite(x) && isAllowed(x))) return undefined;
  return units && lengths.some(Boolean) ? lengths.map((x) => `${numberText(x)}m`).join() : lengths.length > 1 ? lengths : lengths[0];
}
/* Whether some of these are in metres, and some are not; nothing and 0 are neither. */
export function mixesUnits(lengths) {
  const said = lengths.filter((length) => [length].flat().some(Boolean));
  return said.some((length) => typeof length === "string") && said.some((length) => typeof length !== "string");
}
const numberIn = (least, most) => (text) => numbersOf(text, 1, least, most)?.[0];
const colorOf = (text) => (parseColor(text) ? text : undefined);
function varyOf(text) {
  const parts = text.toLowerCase().split(","), seed = parts.find((part) => /^\d{1,9}$/.test(part));
  if (!parts.every((part) => VARY.includes(part) || /^\d{1,9}$/.test(part))) return undefined;
  return [...VARY.filter((word) => parts.includes(word)), ...(Number(seed) ? [String(Number(seed))] : [])].join();
}
function tilesOf(text) {
  const tiles = text.split(",");
  return text.includes(":") || tiles.length > 8 || tiles.some((tile) => !tile || tile.length > 255) ? undefined : text;
}

/* Adjustments of colours, which follow the others in the order in which they are made: a value, and what changes nothing. */
export const ADJUSTMENTS = {
  hue: [numberIn(-1e6, 1e6), "0"],
  saturation: [numberIn(0, 1e3), "1"],
  gain: [(text) => numbersOf(text, 3, 0, 1e6), "1,1,1"],
  gamma: [numberIn(1e-3, 1e3), "1"],
  contrast: [numberIn(1e-3, 1e3), "1"],
  blur: [numberIn(0, 0.25), "0"],
  invert: [(text) => wordOf(text, ["yes", "no"])?.replace("no", ""), ""],
  tint: [colorOf, "#ffffff"],
  colorize: [colorOf, ""],
};

/* The statements about a texture, in the order of the canonical text: what reads a value, undefined if there is none; and
 * the text that needs no statement. */
export const OPTIONS = {
  scale: [(text) => pairOf(text, (x) => x !== 0), "1,1"],
  rotate: [(text) => [numberOf(text)].find(isFinite), "0"],
  offset: [(text) => pairOf(text, () => true), "0,0"],
  flip: [(text) => wordOf(text, ["u", "v", "uv", "vu"])?.replace("vu", "uv"), ""],
  wrap: [wrapsOf, "repeat"],
  repeat: [(text) => wordOf(text, [...REPEATS, ...BONDS]), "straight"],
  width: [(text) => lengthsOf(text, (x) => x > 0), ""],
  colorspace: [(text) => (text.includes(":") ? undefined : text), ""],
  finish: [(text) => (text === "none" ? "" : text), ""],
  normal: [(text) => (text.includes(":") || text.startsWith(",") ? undefined : text.replace(/,(gl|dx)$/i, (up) => up.toLowerCase())), ""],
  grout: [(text) => (text.includes(",") ? undefined : lengthsOf(text, (x) => x >= 0)), "0"],
  groutcolor: [colorOf, ""],
  vary: [varyOf, ""],
  tiles: [tilesOf, ""],
  at: [(text) => (text.includes(",") ? lengthsOf(text, () => true) : undefined), ""],
  ...ADJUSTMENTS,
};
/* Statements about the light of the whole picture, in the order of the canonical text: what a state calls it, what reads a
 * value, and what null means. A view of the tools may be one that pages do not have. */
export const PICTURE = "picture:", VIEWS = ["Standard", "Filmic", "Neutral", "Raw"];
const LIGHT = {
  [PICTURE + "auto-exposure"]: ["autoExposure", (text) => ({ yes: true, no: false })[text.toLowerCase()], false],
  [PICTURE + "exposure"]: ["exposure", numberIn(-30, 30), 0],
  [PICTURE + "view"]: ["view", (text) => (new TextEncoder().encode(text).length < 128 ? text : undefined), null],
  [PICTURE + "white-balance"]: ["whiteBalance", numberIn(1000, 25000), null],
  warmth: ["warmth", numberIn(-Infinity, Infinity), 0],
};
const lightText = (value) => (typeof value === "boolean" ? (value ? "yes" : "no") : textOf(value));
/* What the light of a room is said to be, of what is said: undefined where nothing is. */
export function checkedLight(said) {
  const light = {};
  for (const [name, read, none] of Object.values(LIGHT)) {
    if (said[name] === undefined) continue;
    const value = said[name] === null ? none : read(typeof said[name] === "boolean" ? lightText(said[name]) : String(said[name]));
    if (value === undefined) throw new Error(`The light's ${name} cannot be ${JSON.stringify(said[name])}.`);
    light[name] = value;
  }
  if (light.view) {
    const view = light.view;
    light.view = VIEWS.find((name) => name.toLowerCase() === view.toLowerCase());
    if (!light.view) throw new Error(`Pages have no view '${view}': expected ${VIEWS.slice(0, -1).join(", ")} or ${VIEWS.at(-1)}.`);
  }
  return light;
}

const LAMP = "light:", FINISH = "finish:";

/* Layers: over:TARGET, over2:TARGET and so on. The target and the number, from 1; 0: it is no layer. */
export const layerOf = (key) => { const [, number, target] = /^over([2-4]?):(.*)$/s.exec(key) || []; return target === undefined ? [key, 0] : [target, Number(number || 1)]; };
export const layerKey = (target, layer) => `over${layer > 1 ? layer : ""}:${target}`;
export const NOT_OF_LAYERS = ["wrap", "repeat", "grout", "groutcolor", "vary", "tiles", "finish", "normal"];
function byTargetAndLayer(a, b) {
  const [x, i] = layerOf(a), [y, j] = layerOf(b);
  return x < y ? -1 : x > y ? 1 : i - j;
}

export const hasGrout = ({ grout }) => parseFloat(grout) > 0;

/* What options of laying need, and what they exclude. of: who has them, for messages. */
export function checkLaying(of, said) {
  const bond = BONDS.includes(said.repeat), laid = hasGrout(said) ? "grout" : said.vary ? "vary" : said.tiles ? "tiles" : "";
  const what = bond || isShifted(said.repeat) ? `repeat ${said.repeat}` : laid;
  if (what && (said.wrap || "repeat").split(",").some((mode) => mode !== "repeat")) throw new Error(`${of} ${what} needs wrap repeat.`);
  if (what && said.repeat === "mirror") throw new Error(`${of} ${what} cannot be used with repeat mirror.`);
  if ((bond || hasGrout(said)) && !said.width) throw new Error(`${of} ${what} needs width.`);
}

/* The option that a key ends with. */
const optionOf = (key) => Object.keys(OPTIONS).find((word) => key.endsWith(`.${word}`));

/* What the text of an edit says, as getState() has it. A target without a scale has the tools', not a picture's own. */
export function parseEdit(text) {
  const textures = Object.create(null), light = {}, lamps = Object.create(null), finishes = Object.create(null);
  const decode = (part) => part.replace(/%(25|26|2e|3b)/gi, (_, code) => String.fromCharCode(parseInt(code, 16)));
  for (const statement of text ? text.split(/[;&]/) : []) {
    const equals = statement.indexOf("="), key = statement.slice(0, Math.max(equals, 0)), word = optionOf(key);
    const target = decode(word ? key.slice(0, -word.length - 1) : key), value = decode(statement.slice(equals + 1));
    if (!target || !value) throw new Error(`'${statement}': expected TARGET=IMAGE, TARGET.OPTION=VALUE, light:LAMP=VALUE, finish:TARGET=NAME or picture:KEY=VALUE.`);
    if (key.startsWith(LAMP)) {
      const lamp = decode(key.slice(LAMP.length));
      if (!lamp) throw new Error(`'${statement}': expected the name of a lamp.`);
      if (lamp in lamps) throw new Error(`${key} is given twice.`);
      lamps[lamp] = lampText(parseLamp(value));
      continue;
    }
    if (key.startsWith(FINISH)) {
      const finished = decode(key.slice(FINISH.length));
      if (!finished) throw new Error(`'${statement}': expected the name of a target.`);
      if (finished in finishes) throw new Error(`${key} is given twice.`);
      finishes[finished] = value;
      continue;
    }
    if (key.startsWith(PICTURE) || (key === "warmth" && isFinite(numberOf(value)))) {
      const [name, read] = LIGHT[key] || [];
      if (!name) throw new Error(`'${statement}': expected picture: and exposure, white-balance, auto-exposure or view.`);
      if (name in light) throw new Error(`${key} is given twice.`);
      if ((light[name] = read(value)) === undefined) throw new Error(`${key} cannot be '${value}'.`);
      continue;
    }
    const said = (textures[target] ||= {}), name = word || "source";
    if (name in said) throw new Error(`${key} is given twice.`);
    if (name === "source") readColor(value);
    said[name] = word ? OPTIONS[word][0](value) : value;
    if (said[name] === undefined) throw new Error(`${key} cannot be '${value}'.`);
  }
  for (const [key, said] of Object.entries(textures)) {
    if (mixesUnits([said.width, said.grout, said.at])) throw new Error(`${key}: all lengths have a unit, or none.`);
    if (typeof said.at === "string" && !said.width) throw new Error(`${key}: at with lengths needs width.`);
    const [target, layer] = layerOf(key);
    for (let k = 1; k <= layer; k++) if (!textures[layerKey(target, k)]?.source) throw new Error(`Layer ${k} on ${target} has no image.`);
    if (!layer) continue;
    if (readColor(said.source)) throw new Error(`${key} must be an image, not a colour.`);
    const other = Object.keys(said).find((word) => NOT_OF_LAYERS.includes(word));
    if (other) throw new Error(`${key} lies there once: it has no ${other}.`);
  }
  for (const [target, said] of Object.entries(textures)) {
    if (!said.source) throw new Error(`${target} has options, but no texture.`);
    checkLaying(`${target}:`, said);
    if ("finish" in said && "normal" in said) throw new Error(`${target}: finish and normal exclude each other.`);
    if (said.finish || !parseColor(said.source)) said.scale ||= [1, 1];
  }
  if (Object.keys(textures).filter((key) => !layerOf(key)[1]).length > 8) throw new Error("There are textures for more than 8 targets.");
  return { textures, light, lamps, finishes };
}

/* A preset of retex-edit(5) as a state. Its pictures are meant from its address; the page's own folder, which a URL ends with,
 * is left out of theirs, so that links stay short. */
export function parsePreset(text, address, folder) {
  let preset;
  try {
    preset = JSON.parse(text);
  } catch {
    preset = null;
  }
  if (preset?.["retex-preset"] !== 1 || typeof preset.edit !== "string") throw new Error("it is no preset of version 1.");
  const from = (name) => {
    let href;
    try {
      ({ href } = new URL(/^[a-z][a-z\d+.-]*:/i.test(name) ? name : name.split("/").map(encodeURIComponent).join("/"), address));
    } catch {
      throw new Error(`'${name}' is no address of an image.`);
    }
    return href.startsWith(folder) ? href.slice(folder.length) : href;
  };
  const state = parseEdit(preset.edit);
  for (const said of Object.values(state.textures)) {
    if (!parseColor(said.source)) Object.assign(said, { label: said.source.replace(/^.*\//, "").replace(/-[\da-f]{8}(?=\.\w+$)/, ""), source: from(said.source) });
    if (said.finish) said.finish = from(said.finish);
    if (said.tiles) said.tiles = said.tiles.split(",").map(from).join();
  }
  return state;
}

export const textOf = (value) => [value].flat().map((x) => (typeof x === "number" ? numberText(x) : x)).join();

/* The text of an edit that says what a state does. */
export function editText({ textures = {}, light = {}, lamps = {}, finishes = {} }) {
  const encode = (part) => part.replace(/[%&;]/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase()}`);
  const statements = [];
  for (const target of Object.keys(textures).sort(byTargetAndLayer)) {
    const name = encode(target), option = optionOf(name);
    statements.push(`${option ? name.slice(0, -option.length - 1) + "%2E" + option : name}=${encode(textures[target].source)}`);
    const adjusted = Object.keys(textures[target]).filter((word) => word in ADJUSTMENTS);
    for (const word of [...Object.keys(OPTIONS).filter((w) => !(w in ADJUSTMENTS)), ...adjusted]) {
      const unsaid = OPTIONS[word][1], text = textOf(textures[target][word] ?? unsaid);
      if (text !== unsaid) statements.push(`${name}.${word}=${encode(text)}`);
    }
  }
  for (const lamp of Object.keys(lamps).sort()) statements.push(`${LAMP}${encode(lamp)}=${lamps[lamp]}`);
  for (const target of Object.keys(finishes).sort()) statements.push(`${FINISH}${encode(target)}=${encode(finishes[target])}`);
  for (const [key, [name]] of Object.entries(LIGHT)) if (light[name] != null) statements.push(`${key}=${encode(lightText(light[name]))}`);
  return statements.join(";");
}
