// ---- numbers and colours, and how they are said ----

import { COLORS } from "colors";

export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

export const srgbDecode = (y) => (y <= 0.04045 ? y / 12.92 : ((y + 0.055) / 1.055) ** 2.4);
const colorNames = new Map(Array.from(COLORS.matchAll(/([a-z]+)(\w{6})/g), ([, name, code]) => [name, code]));

/* Text as a finite number; NaN if it is none. */
export const numberOf = (text) => (/^\s*[-+]?(\d+(\.\d*)?|\.\d+)(e[-+]?\d+)?\s*$/i.test(text) && isFinite(text) ? Number(text) + 0 : NaN);

/* A colour, scene-linear; null if the text is none and may be the address of a picture. */
export function readColor(text) {
  const word = text.trim().toLowerCase(), wrong = (expected) => new Error(`'${text}' is no colour: expected ${expected}.`);
  const call = /^(s?rgb)\s*\((.*)$/s.exec(word), digits = /^#([^./]*)$/.exec(word)?.[1] ?? colorNames.get(word.replace("grey", "gray"));
  if (call) {
    const numbers = call[2].endsWith(")") ? call[2].slice(0, -1).split(",").map(numberOf) : [], encoded = call[1] === "srgb";
    if (numbers.length !== 3 || !numbers.every((x) => x >= 0 && x <= (encoded ? 1 : 1e30)))
      throw wrong(encoded ? "srgb(r,g,b) with three numbers from 0 to 1" : "rgb(r,g,b) with three numbers of 0 or more");
    return encoded ? numbers.map(srgbDecode) : numbers;
  }
  if (digits === undefined) return null;
  if (!/^([0-9a-f]{3}){1,2}$/i.test(digits)) throw wrong("#rgb or #rrggbb");
  return digits.replace(/^(.)(.)(.)$/, "$1$1$2$2$3$3").match(/../g).map((x) => srgbDecode(parseInt(x, 16) / 255));
}

/* The same, and null if the text is wrong. */
export function parseColor(text) {
  try {
    return readColor(text);
  } catch {
    return null;
  }
}

/* The fewest digits that mean the same, as printf has them; single: as a float. */
export function numberText(x, single) {
  const as = single ? Math.fround : Number;
  const digits = [6, 7, 8, 9, 15, 16, 17].find((n) => (single || n > 9) && as(x.toPrecision(n)) === as(x)), [fraction, power] = x.toExponential(digits - 1).split("e");
  if (power >= -4 && power < digits) return String(Number(x.toPrecision(digits)));
  return `${fraction.replace(/(?<![.0])0+$|\.0*$/, "")}e${power[0]}${power.slice(1).padStart(2, "0")}`;
}
