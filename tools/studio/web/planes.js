/* What a click would take: planes of numbers that the renderer sends beside its pictures. */

export const SCOPES = ["material", "flat", "level", "object"]; // in the order of the keys 1 to 4
const PLANES = ["material", "object", "flat", "level"]; // in the order of the bytes

/* The answer `surfaces`: { surfaces, width, height } and a plane for each scope. */
export function readSurfaces(head, buffer) {
  const { width, height, surfaces } = head, pixels = width * height;
  if (buffer.byteLength < pixels * 2 * PLANES.length) throw new Error("The preview's answer is cut off.");
  const planes = {};
  PLANES.forEach((name, k) => (planes[name] = new Uint16Array(buffer, k * pixels * 2, pixels)));
  return { width, height, surfaces, planes };
}

/* The surface at a place of the picture, from 0 to 1 to the right and down; null where there is none. */
export function surfaceAt({ width, height, surfaces, planes }, scope, x, y) {
  const column = Math.floor(x * width), row = Math.floor(y * height);
  if (!(column >= 0 && column < width && row >= 0 && row < height)) return null;
  return surfaces[planes[scope][row * width + column] - 1] || null;
}

/* All that clicks would take by a scope, the largest first. Of a material that one object alone has, that is the object. */
export function surfacesOf({ surfaces, planes }, scope) {
  const numbers = new Set(planes[scope]);
  return surfaces.filter((_, k) => numbers.has(k + 1)).sort((a, b) => b.share - a.share);
}

/* Where a surface is: a byte a pixel, 1 inside. */
export function maskOf({ surfaces, planes }, surface) {
  const number = surfaces.indexOf(surface) + 1;
  return number ? Uint8Array.from(planes[surface.kind], (x) => (x === number ? 1 : 0)) : null;
}

/* Whether a pixel is inside and has a neighbour that is not, for outlines. */
export function isEdge(mask, width, height, x, y) {
  const inside = (a, b) => a >= 0 && b >= 0 && a < width && b < height && mask[b * width + a];
  return !!inside(x, y) && !(inside(x - 1, y) && inside(x + 1, y) && inside(x, y - 1) && inside(x, y + 1));
}

/* The answer `uv`: target numbers and coordinates of each pixel. */
export function readCoordinates(head, buffer) {
  const { width, height, uv } = head, pixels = width * height;
  if (buffer.byteLength < pixels * 10) throw new Error("The preview's answer is cut off.");
  return {
    width, height, targets: uv,
    target: new Uint16Array(buffer, 0, pixels),
    u: new Float32Array(buffer.slice(pixels * 2, pixels * 6)),
    v: new Float32Array(buffer.slice(pixels * 6, pixels * 10)),
  };
}

/* Which line of the grid a pixel is on: 0 none, 1 a metre, 2 where u is 0, 3 where v is 0. A line is where a neighbour,
 * to the right or below, of the same target is beyond a whole number. */
export function gridLine({ width, height, target, u, v }, x, y) {
  const i = y * width + x, own = target[i];
  if (!own) return 0;
  let line = 0;
  for (const j of [x + 1 < width ? i + 1 : i, y + 1 < height ? i + width : i]) {
    if (target[j] !== own) continue;
    for (const [plane, zero] of [[u, 2], [v, 3]]) {
      const a = Math.floor(plane[i]), b = Math.floor(plane[j]);
      if (a === b || Math.abs(plane[j] - plane[i]) > 1) continue; // a seam, or too far for lines
      line = Math.max(line, Math.max(a, b) === 0 ? zero : 1);
    }
  }
  return line;
}
