// ---- the values of lamps, as in retex-edit(5) ----

import { numberOf, numberText, readColor } from "./values.js";

const luminanceOf = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

/* The colour of a black body, of luminance 1: Planck's law seen by the CIE 1931 observer, in the fit of Wyman, Sloan and
 * Shirley. */
export function kelvinColor(kelvin) {
  const lobe = (x, [height, mean, below, above]) => height * Math.exp(-0.5 * ((x - mean) / (x < mean ? below : above)) ** 2);
  const xyz = [0, 0, 0];
  for (let x = 360; x <= 830; x += 5) {
    const power = (x / 560) ** -5 / Math.expm1(1.438776877e7 / (x * kelvin));
    OBSERVER.forEach((lobes, k) => lobes.forEach((l) => { xyz[k] += power * lobe(x, l); }));
  }
  const rgb = REC709.map((row) => Math.max(row.reduce((sum, m, k) => sum + m * xyz[k], 0), 0));
  return rgb.map((c) => Math.fround(c / luminanceOf(rgb)));
}
const OBSERVER = [[[1.056, 599.8, 37.9, 31], [0.362, 442, 16, 26.7], [-0.065, 501.1, 20.4, 26.2]],
  [[0.821, 568.8, 46.9, 40.5], [0.286, 530.9, 16.3, 31.1]], [[1.217, 437, 11.8, 36], [0.681, 459, 26, 13.8]]];
const REC709 = [[3.2404542, -1.5371385, -0.4985314], [-0.969266, 1.8760108, 0.041556], [0.0556434, -0.2040259, 1.0572252]];

/* A value: numbers multiply; colours and kelvins, which filter each other, are a colour of luminance 1, or null. */
export function parseLamp(text) {
  const wrong = (why = "numbers, colours and kelvins, as in 2.5, #ffd0a0, 3000K or 1.5*3000K") => new Error(`Light '${text}': expected ${why}.`);
  let gain = 1, color = null;
  for (const factor of text.split("*")) {
    const word = factor.trim(), isNumber = /^[-+.\d]/.test(word), isKelvin = isNumber && /k$/i.test(word);
    const number = numberOf(isKelvin ? word.slice(0, -1) : word);
    if (isNumber ? !(number >= 0 && number <= 1e30) : !word) throw wrong();
    if (isKelvin && (number < 1000 || number > 40000)) throw wrong("1000 to 40000 kelvins");
    const own = isKelvin ? kelvinColor(number) : isNumber ? null : readColor(word);
    if (!isNumber && !own) throw wrong();
    if (own) color = own.map((x, k) => Math.fround(x) * (color ? color[k] : 1));
    else gain *= number;
  }
  if (!(gain <= 1e30)) throw wrong();
  const luminance = color ? luminanceOf(color) : 1;
  if (!(luminance > 0)) return { gain: 0, color: null };
  if (color) color = color.map((x) => Math.fround(Math.abs(luminance - 1) > 1e-6 ? x / luminance : x));
  return { gain, color };
}

export const lampText = ({ gain, color }) =>
  [...(gain === 1 && color ? [] : [numberText(gain)]), ...(color ? [`rgb(${color.map((x) => numberText(x, true))})`] : [])].join("*");

export const isBlack = (color) => color.every((x) => x === 0);

/* What a value makes of a lamp of the room: its linear colour. */
export function lampColor({ gain, color }, { value, kept = value, several }) {
  const base = isBlack(value) ? kept : value;
  return base.map((x, k) => gain * (!color ? x : color[k] * (several ? x : luminanceOf(base))));
}

/* The parameters that are lamps, with their names. Where targets have finishes, light is kept by lamp, or as that of none,
 * and by finish: the value of a lamp is that of its light which met no such target. */
export const lampsOf = ({ parameters = [] }) => parameters.map((p, index) => ({ ...p, index, name: p.lamp ?? p.name }))
  .filter((p) => p.lamp !== "" && !p.finishes?.some(Boolean));

/* What colours parameters have: their lamp's, or white; black where light met a target with another finish than it has.
 * said: of the lamps what parseLamp makes of it, or null: as rendered; chosen: the number of each target's finish, from 1;
 * null: all. */
export function parameterColors(room, said, chosen) {
  const lamps = lampsOf(room), own = lamps.map((lamp, i) => (said[i] ? lampColor(said[i], lamp) : lamp.value));
  return (room.parameters ?? []).map(({ name, lamp = name, finishes = [] }) =>
    finishes.some((f, t) => f && chosen[t] !== null && f !== chosen[t]) ? [0, 0, 0] : own[lamps.findIndex((l) => l.name === lamp)] ?? [1, 1, 1]);
}

export const finishesAsRendered = ({ targets = [] }) => targets.map((t) => t.finish ?? 0);

/* Warmth is told in mireds, millionths by kelvin, which look even: the nearest of a colour, null where it is far from that
 * of any black body. */
const MIREDS = Array.from({ length: 91 }, (_, k) => 100 + 5 * k);
export const kelvinOf = (mired) => Math.round(1e5 / mired) * 10;
let bodies;
export function miredOf(color) {
  bodies ||= MIREDS.map((mired) => kelvinColor(kelvinOf(mired)));
  const far = bodies.map((body) => Math.hypot(...body.map((x, k) => x - color[k] / luminanceOf(color)))), least = Math.min(...far);
  return least < 0.2 ? MIREDS[far.indexOf(least)] : null;
}

/* Which one a name means: exactly, else ignoring case if that is unique; or -1. */
export function indexNamed(list, name) {
  const exact = list.findIndex((l) => l.name === name), alike = list.filter((l) => l.name.toLowerCase() === name.toLowerCase());
  return exact < 0 && alike.length === 1 ? list.indexOf(alike[0]) : exact;
}
