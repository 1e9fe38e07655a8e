/* How wide a texture is, by what people write into names: "oak 120cm.jpg", "tiles 60x60", "plank_1200x200mm". */

const CENTIMETRES = { mm: 0.1, cm: 1, m: 100, in: 2.54, inch: 2.54, '"': 2.54, ft: 30.48 };
const NUMBER = "(\\d{1,4}(?:[.,]\\d{1,3})?)", UNIT = '(mm|cm|m|inch|in|ft|")?';
const PAIR = new RegExp(`(?<![\\d.,a-z])${NUMBER} ?${UNIT} ?[x×] ?${NUMBER} ?${UNIT}(?![a-z\\d])`, "gi");
const SINGLE = new RegExp(`(?<![\\d.,a-z×])${NUMBER} ?(mm|cm|m|inch|in|ft|")(?![a-z\\d])`, "gi");
const number = (text) => Number(text.replace(",", "."));
const isPlausible = (cm) => cm >= 1 && cm <= 1000;

/* Sizes in pixels look like sizes in millimetres. */
const SCREENS = new Set(["1280x720", "1920x1080", "1920x1200", "2560x1440", "3840x2160", "640x480", "800x600", "1024x768"]);
const isPixels = (a, b) => SCREENS.has(`${a}x${b}`) || [a, b].every((n) => n >= 128 && (n & (n - 1)) === 0);

/* Width and height in cm, as one part of a path says them; null if it does not. */
function sizeIn(text) {
  for (const [, a, first, b, second] of text.matchAll(PAIR)) {
    const unit = (second || first || "").toLowerCase(), [wide, high] = [number(a), number(b)];
    if (!unit && isPixels(wide, high)) continue;
    const scale = unit ? CENTIMETRES[unit] : wide > 300 || high > 300 ? 0.1 : 1; // as tiles are sold
    if (isPlausible(wide * scale) && isPlausible(high * scale)) return [wide * scale, high * scale];
  }
  for (const [, a, unit] of text.matchAll(SINGLE)) {
    const wide = number(a) * CENTIMETRES[unit.toLowerCase()];
    if (isPlausible(wide)) return [wide, 0];
  }
  return null;
}

/* The width in cm of the picture, from its name or else the nearest folder that tells; null if none does. aspect: width
 * by height of the picture, which tells whether it lies or stands. */
export function guessWidth(path, aspect = 0) {
  for (const part of path.replace(/\.[a-z]+$/i, "").split("/").reverse()) {
    const size = sizeIn(part.replace(/_/g, " "));
    if (!size) continue;
    const [wide, high] = size, turns = aspect && high && wide !== high && wide > high !== aspect > 1;
    return Number((turns ? high : wide).toFixed(2));
  }
  return null;
}

/* What was said of this picture, of its folder, or of one above; else what names tell. */
export function widthOf(widths, path, aspect = 0) {
  for (let at = path; at; at = at.includes("/") ? at.slice(0, at.lastIndexOf("/")) : "") {
    if (widths[at] > 0) return widths[at];
  }
  return guessWidth(path, aspect);
}
