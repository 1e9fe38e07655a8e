// ---- laying: several repeats of a texture, with joints between them, become one image that repeats ----

import { BONDS } from "./edit.js";
import { HEAD } from "./glsl.js";
import { parseColor } from "./values.js";

export const MOST_LAID = 2 ** 24, LIBRARY_LAID = 2 ** 26, LIBRARY_LAID_COLOR = 2 ** 23, HEXAGON = Math.sqrt(3) / 2;
export const rint = (x) => (Math.abs(x % 1) === 0.5 ? 2 * Math.round(x / 2) : Math.round(x));
const jointTexels = (grout, texel) => (grout > 0 ? Math.max(1, Math.ceil(grout / texel - 1e-6)) : 0);

/* Whether a texture's texels are more than the image's own. */
export const isLaid = ({ repeat, grout, vary, tiles }) => !["straight", "mirror"].includes(repeat) || grout > 0 || !!vary || !!tiles;

/* Bonds whose repeats all lie alike. */
function planRows({ repeat, grout }, block, size) {
  const count = [repeat === "half-drop" ? 2 : 1, repeat === "brick" ? 2 : 1], joint = block.map((b, k) => jointTexels(grout, size[k] / b));
  const [across, up] = block.map((b, k) => b + joint[k]);
  return {
    block, joint, size: [count[0] * across, count[1] * up], period: count.map((n, k) => n * (1 + grout / size[k])),
    grout: [across, up].map((pitch, k) => pitch * grout / (size[k] + grout)),
    blocks: Array.from({ length: count[0] * count[1] }, (_, k) => (count[0] > 1 ? { x: k * across, y: -k * (up >> 1) } : { x: k * (across >> 1), y: k * up })),
  };
}

/* The nearest ratio of small whole numbers to long / short; both pitches become multiples of its unit. */
function fitRatio(long, short, most) {
  const ratio = long / short;
  let q = 1;
  while (q < most && Math.abs(rint(ratio * q) / q - ratio) > 0.005 * ratio) q++;
  const unit = Math.max(1, rint(short / q));
  return [Math.max(q, rint(ratio * q)) * unit, q * unit];
}

const divisor = (a, b) => (b ? divisor(b, a % b) : a);

/* Repeats that lie begin at (a + b) steps along the diagonal and b along the other side; at the right of each stands one. */
function herringbone(m, n) {
  const side = 2 * m / divisor(m, n) * n, blocks = [];
  for (let b = 0; b < side / (2 * m); b++)
    for (let a = 0; a < side / n; a++) {
      const x = a * n + b * (m + n), y = a * n + b * (n - m);
      blocks.push({ x: x % side, y: y % side }, { x: (x + m) % side, y: (y + n - m) % side, stands: true });
    }
  return { side, blocks };
}

/* Squares of repeats that lie and that stand, by turns. */
function basket(m, n) {
  const blocks = [];
  for (let square = 0; square < 4; square++)
    for (let k = 0; k < m / n; k++) {
      const x = square % 2 * m, y = (square >> 1) * m, stands = square === 1 || square === 2;
      blocks.push(stands ? { x: x + k * n, y, stands } : { x, y: y + k * n });
    }
  return { side: 2 * m, blocks };
}

/* Bonds in which repeats lie and stand: texels are as high as they are wide. */
function planTurned({ repeat, grout }, block, size) {
  const long = size[1] > size[0] ? 1 : 0, short = 1 - long, width = block[short] + jointTexels(grout, size[short] / block[short]);
  const [m, n] = fitRatio(rint((size[long] + grout) / ((size[short] + grout) / width)), width, repeat === "herringbone" ? 4 : 1);
  const texel = (size[short] + grout) / n, joint = jointTexels(grout, texel), { side, blocks } = (repeat === "herringbone" ? herringbone : basket)(m, n);
  for (const b of blocks) b.stands = !!b.stands !== !!long;
  return {
    block: long ? [n - joint, m - joint] : [m - joint, n - joint], joint: [joint, joint], grout: [grout / texel, grout / texel], size: [side, side],
    period: size.map((s) => side * texel / s), blocks,
  };
}

/* Rows of hexagons with a corner above; of an image its middle is seen. Their x and y are their middles. */
function planHexagons({ grout }, block, size) {
  const texels = Math.max(1, Math.trunc(Math.min(block[0], block[1] * HEXAGON))), joint = jointTexels(grout, size[0] / texels);
  const pitch = texels + joint + (texels + joint) % 2, row = rint(pitch * HEXAGON), texel = (size[0] + grout) / pitch;
  return {
    block: [pitch - joint, block[1]], joint: [joint, joint], grout: [grout / texel, grout / texel], size: [pitch, 2 * row], hexagon: { pitch, row },
    period: [1 + grout / size[0], (size[0] + grout) * 2 * HEXAGON / size[1]], blocks: [{ x: 0, y: 0 }, { x: pitch / 2, y: row }],
  };
}

/* How many copies of a bond lie side by side, so that more repeats differ. */
function copiesOf({ size, blocks }) {
  let counts = [1, 1];
  for (let last; last !== counts; ) {
    const wider = counts[0] * size[0] <= counts[1] * size[1], ways = [[counts[0] + 1, counts[1]], [counts[0], counts[1] + 1]];
    last = counts;
    counts = (wider ? ways : ways.reverse()).find(([a, u]) => Math.max(a, u) <= 16 && a * u * blocks.length <= 256 && a * size[0] * u * size[1] <= LIBRARY_LAID) || counts;
  }
  return counts;
}

/* The image of a texture whose repeats have so many texels: its size, and where each repeat lies, as the tools lay them. An
 * image that is too large for a page, with a longer side or more texels than these, is coarser. */
export function layoutOf(laid, [width, height], most, texels) {
  const size = laid.width ? [laid.width[0], laid.width[1] || laid.width[0] * height / width] : [1, 1], short = Math.min(...size), turned = BONDS.includes(laid.repeat);
  if (turned && Math.max(...size) > 256 * short) throw new Error("A repeat that turns is at most 256 times as long as wide.");
  if (laid.grout > short) throw new Error("The grout is wider than a repeat.");
  const plan = (block) => (laid.repeat === "hexagon" ? planHexagons : turned ? planTurned : planRows)(laid, block, size);
  const isColor = width === 1 && height === 1, longer = Math.max(...size);
  let block = [width, height];
  if (isColor && laid.grout > 0) {
    const joint = Math.ceil(Math.max(4, laid.grout * 1024 / longer)); // its texels, so that joints have sharp edges
    block = size.map((s) => Math.max(1, rint(s / Math.max(laid.grout / joint, longer / 2048))));
  }
  let layout = plan(block);
  const share = Math.sqrt((isColor ? LIBRARY_LAID_COLOR : LIBRARY_LAID) / (layout.size[0] * layout.size[1]));
  if (turned && share < 1) layout = plan((block = block.map((x) => Math.max(1, Math.trunc(x * share)))));
  const counts = (laid.vary && !isColor) || laid.tiles ? copiesOf(layout) : [1, 1];
  for (;;) {
    const whole = layout.size.map((s, k) => s * counts[k]), times = Math.min(...whole.map((s) => most / s), Math.sqrt(texels / (whole[0] * whole[1])));
    if (times >= 1) break;
    if (Math.max(...block) === 1) throw new Error("A texture that is laid so is too large for this device.");
    layout = plan((block = block.map((b) => Math.max(1, Math.floor(b * times)))));
  }
  const { blocks } = layout, [w, h] = layout.size;
  const copies = Array.from({ length: counts[0] * counts[1] * blocks.length }, (_, i) => {
    const copy = Math.floor(i / blocks.length), column = copy % counts[0], row = Math.floor(copy / counts[0]), own = i % blocks.length;
    return { ...blocks[own], x: blocks[own].x + column * w, y: blocks[own].y + row * h, column: own + column * blocks.length, row };
  });
  return { ...layout, blocks: copies, size: [w * counts[0], h * counts[1]], period: layout.period.map((p, k) => p * counts[k]), isShifted: laid.vary.includes("shift") };
}

/* Steele, Lea and Flood's SplitMix64. */
function randomsOf(seed) {
  const bits = (x) => BigInt.asUintN(64, x);
  let state = seed;
  return () => {
    let z = (state = bits(state + 0x9e3779b97f4a7c15n));
    z = bits((z ^ (z >> 30n)) * 0xbf58476d1ce4e5b9n);
    z = bits((z ^ (z >> 27n)) * 0x94d049bb133111ebn);
    return z ^ (z >> 31n);
  };
}

/* What differs from repeat to repeat: the number of the tile, quarters of a turn, flips, and how far it is shifted. */
export function looksOf({ vary, width }, { block }, { column, row }, ntiles) {
  const parts = vary.split(","), first = randomsOf(BigInt(parts.find((part) => part > 0) || 0));
  const next = randomsOf(first() ^ (BigInt(column) << 32n) ^ BigInt(row)), [random, x, y] = [next(), next(), next()];
  const isSquare = width && Math.abs((width[1] ? width[1] / width[0] : block[1] / block[0]) - 1) < 1e-3;
  return {
    tile: Number(random % BigInt(ntiles)), quarters: parts.includes("turn") ? Number((random >> 32n) & (isSquare ? 3n : 2n)) : 0,
    flip: [40n, 41n].map((at) => parts.includes("flip") && !!((random >> at) & 1n)),
    shift: [x, y].map((z) => (parts.includes("shift") ? Number(z >> 11n) / 2 ** 53 : 0)),
  };
}

/* From a place in a repeat, 0, 0 at its lower left corner and 1, 1 at the upper right one, to one in its image, whose first
 * row is the upper one: a matrix by columns, and what is added. */
function placeInTile(stands, { quarters, flip, shift }) {
  const from1 = (x) => [-x[0], -x[1], 1 - x[2]];
  let at = stands ? [[0, 1, 0], [-1, 0, 1]] : [[1, 0, 0], [0, 1, 0]]; // turned counter-clockwise
  for (let k = 0; k < quarters; k++) at = [from1(at[1]), at[0]];
  const [u, v] = at.map((x, k) => (flip[k] ? from1(x) : x)).map((x, k) => [x[0], x[1], x[2] + shift[k]]), down = from1(v);
  return { turned: [u[0], down[0], u[1], down[1]], moved: [u[2], down[2]] };
}

/* How each repeat is painted: the box that it takes, from the lower left corner of the image, its tile, and what LAY needs. */
export function paintingsOf(laid, layout, tiles) {
  const { block, joint, grout, hexagon } = layout, color = parseColor(laid.groutcolor || "#808080");
  return layout.blocks.map((b) => {
    const look = looksOf(laid, layout, b, tiles.length), tile = tiles[look.tile].size, stands = !!b.stands, values = { joint, grout, color, ...placeInTile(stands, look) };
    if (hexagon) {
      const { pitch, row } = hexagon, reach = Math.trunc(2 * row / 3) + 1, seen = Math.min(tile[0], tile[1] * HEXAGON);
      return { tile: look.tile, x: b.x - pitch / 2, y: b.y - reach, size: [pitch, 2 * reach], origin: [pitch / 2, reach],
        values: { ...values, hexagon: [pitch, row], block: tile.map((s) => block[0] * s / seen), lod: Math.max(0, Math.log2(seen / block[0])) } };
    }
    const lies = stands ? [block[1], block[0]] : block, size = lies.map((s, k) => s + joint[k]), finer = Math.min(...tile.map((s, k) => s / block[k]));
    return { tile: look.tile, x: b.x, y: b.y, size, origin: [0, size[1]], values: { ...values, hexagon: [0, 0], block: lies, lod: Math.max(0, Math.log2(finer)) } };
  });
}

/* A repeat and its joints: grout lies at a joint's outer end, where another joint may begin. origin: the lower left corner,
 * or of a hexagon the middle. hexagon: how far hexagons are apart, and their rows; whether a texel is one's is counted in
 * whole numbers, so that hexagons side by side have no texel twice. */
export const LAY = `${HEAD}
uniform sampler2D tile;
uniform mat2 turned;
uniform vec2 moved, origin, block, joint, grout;
uniform ivec2 hexagon;
uniform vec3 color;
uniform float lod;
out vec4 result;
float share(float at, float middle, float width) { return max(min(at + 0.5, middle + 0.5 * width) - max(at - 0.5, middle - 0.5 * width), 0.0); }
void main() {
  vec2 at = vec2(gl_FragCoord.x - origin.x, origin.y - gl_FragCoord.y), place = min(at, block - 0.5) / block;
  float filled;
  if (hexagon.x > 0) {
    ivec2 twice = ivec2(floor(2.0 * at + 0.5));
    int across = 2 * hexagon.y * twice.x, up = 3 * hexagon.x * twice.y, limit = 4 * hexagon.x * hexagon.y;
    if (across + up <= -limit || across + up > limit || up - across <= -limit || up - across > limit) discard;
    at.y *= float(hexagon.x) * ${HEXAGON} / float(hexagon.y);
    place = 0.5 + at / block;
    filled = share(max(abs(at.x), 0.5 * abs(at.x) + ${HEXAGON} * abs(at.y)), 0.5 * float(hexagon.x), grout.x);
  } else {
    vec2 middle = block + joint - 0.5 * grout;
    filled = 1.0 - (1.0 - share(at.x, middle.x, grout.x)) * (1.0 - share(at.y, middle.y, grout.y));
  }
  result = mix(textureLod(tile, turned * place + moved, lod), vec4(color, 1.0), filled);
}`;

/* What LAY needs to paint a whole image of another size with one. */
export const copyOf = ({ texture, size }, to) => ({
  tile: texture, origin: [0, to[1]], block: to, joint: [0, 0], grout: [0, 0], hexagon: [0, 0], color: [0, 0, 0], turned: [1, 0, 0, -1], moved: [0, 1],
  lod: Math.max(0, Math.log2(Math.min(...size.map((s, k) => s / to[k])))),
});
