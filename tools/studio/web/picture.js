/* Pictures of the preview: half floats of linear light become bytes of sRGB. */

export function halfValue(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024) : sign * 2 ** -14 * (fraction / 1024);
}

const srgbEncode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

/* The byte of each half, with so many stops of exposure. What is no number is black. */
export function displayTable(stops = 0) {
  const table = new Uint8ClampedArray(65536), gain = 2 ** stops;
  for (let bits = 0; bits < 65536; bits++) {
    const x = halfValue(bits) * gain;
    table[bits] = x > 0 ? Math.round(255 * srgbEncode(Math.min(x, 1))) : 0;
  }
  return table;
}

/* Bytes of RGBA for a canvas, opaque; undefined where there are not as many halves as pixels need. */
export function displayed(buffer, width, height, table) {
  if (buffer.byteLength < width * height * 8) return undefined;
  const halves = new Uint16Array(buffer, 0, width * height * 4), bytes = new Uint8ClampedArray(width * height * 4);
  for (let i = 0; i < bytes.length; i += 4) {
    bytes[i] = table[halves[i]];
    bytes[i + 1] = table[halves[i + 1]];
    bytes[i + 2] = table[halves[i + 2]];
    bytes[i + 3] = 255;
  }
  return bytes;
}
