/* Footprints: planes are decoded as retex-pack(5) and retex-web(5) say. Streams of known integers are written here by the
 * formulas of these pages; what retex-pack wrote is read by reference.py, with numpy. */
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { inflateSync } from "node:zlib";
import { fails, near, random, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

const { decodePlane, decodeClass, mostBytes, RECORD_COLUMNS } = player();

/* ---- the format, by its description ---- */

/* What predictor `kind` expects at x, y. value(x, y): an integer that came before, or undefined where there is none. */
function predict(kind, value, x, y, last) {
  const [left, upper, corner] = [value(x - 1, y), value(x, y - 1), value(x - 1, y - 1)];
  if (kind === 0) return 0;
  if (left === undefined || upper === undefined || corner === undefined) return left ?? upper ?? last;
  const plane = left + upper - corner;
  if (kind === 1) return left;
  if (kind === 2) return upper;
  if (kind === 3) return plane;
  return Math.min(Math.max(plane, Math.min(left, upper)), Math.max(left, upper));
}

/* The bytes of a plane of integers, which are multiples of 2^shift. numbers[i] undefined: not stored. Residuals of bits
 * are signed numbers of 8 bits or 32. */
function encodePlane(numbers, width, kind, size, shift = () => 0, bits = 32) {
  const value = (x, y) => (x < 0 || y < 0 ? undefined : numbers[y * width + x]);
  const residuals = [];
  let last = 0;
  numbers.forEach((number, i) => {
    if (number === undefined) return;
    const step = 2 ** shift(i), guess = predict(kind, value, i % width, Math.floor(i / width), last);
    residuals.push(number / step - Math.floor(guess / step + 0.5)); // halves up
    last = number;
  });
  const signed = residuals.map((r) => ((r + 8.5 * 2 ** bits) % 2 ** bits) - 2 ** (bits - 1));
  const codes = signed.map((r) => (r < 0 ? -2 * r - 1 : 2 * r));
  const bytes = [kind + 16 * size];
  for (let k = 0; k < size; k++) bytes.push(...codes.map((c) => Math.floor(c / 256 ** k) % 256));
  return bytes;
}

const [WIDTH, HEIGHT] = [13, 9];

function decoded(bytes, numbers, shift, mask, out) {
  const present = Uint8Array.from(numbers, (n) => (n === undefined ? 0 : 1));
  const stream = { data: Uint8Array.from(bytes), at: 0, count: present.reduce((a, b) => a + b, 0) };
  decodePlane(stream, present, WIDTH, HEIGHT, out, shift, mask);
  same(stream.at, bytes.length, "bytes taken");
  return [...out];
}

const zeros = (numbers) => numbers.map((n) => n ?? 0);

test("planes of all predictors and sizes, with gaps", () => {
  const next = random(3);
  for (let kind = 0; kind <= 4; kind++)
    for (const [size, most] of [[1, 20], [2, 3000], [4, 300000000]])
      for (const gaps of [0, 1, 2]) {
        const numbers = Array.from({ length: WIDTH * HEIGHT }, () => (gaps && next(0, 3) < gaps ? undefined : next(-most, most)));
        const bytes = encodePlane(numbers, WIDTH, kind, size);
        same(decoded(bytes, numbers, null, -1, new Int32Array(numbers.length)), zeros(numbers), `predictor ${kind}, ${size} bytes`);
      }
});

test("planes of slopes and steps: predictor 4 is limited to its neighbours", () => {
  for (const f of [(x, y) => 7 * x - 3 * y, (x, y) => (x > 5 ? 900 : 0) + (y > 4 ? -500 : 0), (x, y) => (x * y) % 5, (x, y) => (x + y) ** 3]) {
    const numbers = Array.from({ length: WIDTH * HEIGHT }, (_, i) => f(i % WIDTH, Math.floor(i / WIDTH)));
    for (let kind = 0; kind <= 4; kind++)
      same(decoded(encodePlane(numbers, WIDTH, kind, 4), numbers, null, -1, new Int32Array(numbers.length)), numbers, `predictor ${kind}`);
  }
});

test("planes on a lattice: predictions are rounded to its steps, halves up", () => {
  const next = random(4);
  for (let kind = 0; kind <= 4; kind++)
    for (let turn = 0; turn < 20; turn++) {
      const shift = Uint8Array.from({ length: WIDTH * HEIGHT }, () => next(0, turn % 2 ? 3 : 20));
      const numbers = Array.from(shift, (s) => (next(0, 4) ? next(-9, 9) * 2 ** s : undefined));
      const bytes = encodePlane(numbers, WIDTH, kind, 4, (i) => shift[i]);
      same(decoded(bytes, numbers, shift, -1, new Int32Array(numbers.length)), zeros(numbers), `predictor ${kind}`);
    }
});

test("planes of bytes go round from 255 to 0", () => {
  const next = random(5);
  for (let kind = 0; kind <= 4; kind++) {
    const numbers = Array.from({ length: WIDTH * HEIGHT }, () => next(0, 255));
    same(decoded(encodePlane(numbers, WIDTH, kind, 1, () => 0, 8), numbers, null, 255, new Uint8Array(numbers.length)), numbers, `predictor ${kind}`);
  }
  // a residual of 8 bits, taken as signed: 250 after 3 is 3 - 9
  same(decoded([1 + 16, 6, 17, ...Array(WIDTH * HEIGHT - 2).fill(0)], Array(WIDTH * HEIGHT).fill(0), null, 255,
    new Uint8Array(WIDTH * HEIGHT)).slice(0, 3), [3, 250, 250]);
});

test("planes without residuals are 0, and those that end early are damaged", () => {
  const numbers = Array(WIDTH * HEIGHT).fill(0);
  same(decoded([4], numbers, null, -1, new Int32Array(numbers.length).fill(9)), numbers);
  const bytes = encodePlane(numbers.map((_, i) => i), WIDTH, 4, 2);
  return fails(() => decoded(bytes.slice(0, -1), numbers, null, -1, new Int32Array(numbers.length)), "Footprints are damaged.");
});

/* ---- records ---- */

/* The numbers of a record: u, v, sigma of u and v, rho, and the two weights as shares of the class's largest. */
function readRecord(records, at) {
  const floats = new Float32Array(records.buffer), [sigmas, rest] = [records[4 * at + 2], records[4 * at + 3]];
  const sigma = (code) => (code ? 2 ** (code / 2048 - 24) : 0);
  return [floats[4 * at], floats[4 * at + 1], sigma(sigmas & 65535), sigma(sigmas >>> 16), ((rest & 255) - 128) / 127,
    ((rest >>> 8) & 4095) / 4095, (rest >>> 20) / 4095];
}

/* Compares decoded records with lists of footprints, each of [pixel, u, v, sigma, sigma, rho, weight, weight] or, with
 * axes, which are a second record, of [pixel, u, v, du/dx, du/dy, dv/dx, dv/dy, weight, weight]. */
function compare(info, { heads, records, rows }, footprints) {
  const each = info.spreads === 4 ? 2 : 1, floats = new Float32Array(records.buffer);
  same(rows, Math.ceil(info.records * each / RECORD_COLUMNS), "rows");
  const byPixel = Array.from({ length: info.width * info.height }, () => []);
  for (const footprint of footprints) for (const [pixel, ...values] of footprint) byPixel[pixel].push(values);
  const most = Math.max(1e-6, ...footprints.flat().flatMap((f) => f.slice(-2)));
  let at = info.base;
  byPixel.forEach((expected, pixel) => {
    same([heads[pixel] >>> 5, heads[pixel] & 31], [at, each * expected.length], `head of pixel ${pixel}`);
    for (const values of expected) {
      const found = readRecord(records, at++ - info.base), what = `pixel ${pixel}`;
      near(found.slice(0, 2), values.slice(0, 2).map(Math.fround), 0, `${what}: u, v`);
      near(found.slice(5), values.slice(-2).map((w) => w / most), 0.5001 / 4095, `${what}: weights`);
      if (each > 1) {
        const axes = floats.slice(4 * (at - info.base), 4 * (++at - info.base));
        near([axes[0], axes[2], axes[1], axes[3]], values.slice(2, 6), 1e-6, `${what}: axes`);
        continue;
      }
      for (const k of [2, 3]) near(found[k], values[k], values[k] * 0.0002, `${what}: sigma`); // half a step of 2^(1/2048)
      near(found[4], values[4], 0.5001 / 127, `${what}: rho`);
    }
  });
  same(at - info.base, info.records * each, "records");
}

test("classes of known footprints: masks, means, spreads and weights", () => {
  const next = random(6);
  for (let turn = 0; turn < 12; turn++) {
    const spreads = 2 + (turn & 1), forms = [["one", null], [0.25, 1 / 3], [null, 0.5], ["one", 0.125]];
    const info = { file: "c", width: WIDTH, height: HEIGHT, spreads, base: 2048 * turn, footprints: [], records: 0 };
    const bytes = [], footprints = [];
    for (let k = 0; k <= turn % 3; k++) {
      const f = { first: 2 ** -next(4, 12), per_octave: next(1, 8), sigma_first: next(-20, 20), angle_steps: spreads > 2 ? next(3, 120) : 0,
        weights: forms[(turn + k) % 4] };
      const present = Array.from({ length: WIDTH * HEIGHT }, () => next(0, 3) > 0);
      const plane = (low, high) => present.map((p) => (p ? next(low, high) : undefined));
      for (let y = 0; y < HEIGHT; y++)
        for (let x = 0; x < WIDTH; x += 8)
          bytes.push(Array.from({ length: 8 }, (_, b) => (x + b < WIDTH && present[y * WIDTH + x + b] ? 2 ** b : 0)).reduce((a, b) => a + b));
      const codes = [plane(0, 10 * f.per_octave), plane(0, 10 * f.per_octave), ...(spreads > 2 ? [plane(128 - f.angle_steps, 128 + f.angle_steps)] : [])];
      for (const c of codes) bytes.push(...encodePlane(c, WIDTH, next(0, 4), 1, () => 0, 8));
      const uv = [0, 1].map((axis) => {
        const shift = (i) => Math.min(Math.max(Math.floor((codes[axis][i] - 1 + f.sigma_first) / f.per_octave), 0), 24);
        const numbers = present.map((p, i) => (p ? next(-9, 9) * 2 ** shift(i) : undefined));
        bytes.push(...encodePlane(numbers, WIDTH, next(0, 4), 4, shift));
        return numbers;
      });
      const weights = f.weights.map((w) => {
        if (typeof w !== "number") return present.map(() => (w === "one" ? 1 : 0));
        const numbers = plane(0, 255);
        bytes.push(...encodePlane(numbers, WIDTH, next(0, 4), 1, () => 0, 8));
        return numbers.map((n) => (n ?? 0) * w);
      });
      const sigma = (c) => (c ? f.first * 2 ** ((c - 1) / f.per_octave) : 0);
      footprints.push(present.flatMap((p, i) => (p ? [[i, uv[0][i] / 2 ** 18, uv[1][i] / 2 ** 18, sigma(codes[0][i]), sigma(codes[1][i]),
        spreads > 2 ? Math.sin((((codes[2][i] - 128) / f.angle_steps) * Math.PI) / 2) : 0, weights[0][i], weights[1][i]]] : [])));
      info.footprints.push(f);
      info.records += present.filter(Boolean).length;
    }
    if (bytes.length >= mostBytes(info)) throw new Error(`${bytes.length} bytes, more than ${mostBytes(info)}`);
    compare(info, decodeClass(info, Uint8Array.from(bytes), info.base), footprints);
  }
});

test("axes are the steps of means within 64 rows, the shorter way round where UV are periodic", () => {
  const width = 9, height = 70, next = random(8), periodic = [1, 0];
  const info = { file: "c", width, height, spreads: 4, base: 4096, records: 0,
    footprints: [{ first: 2 ** -9, per_octave: 4, sigma_first: 0, angle_steps: 0, weights: [0.25, null] }] };
  const present = Array.from({ length: width * height }, () => next(0, 4) > 0), bytes = [];
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x += 8)
      bytes.push(Array.from({ length: 8 }, (_, b) => (x + b < width && present[y * width + x + b] ? 2 ** b : 0)).reduce((a, b) => a + b));
  const plane = (low, high) => present.map((p) => (p ? next(low, high) : undefined));
  for (let k = 0; k < 2; k++) bytes.push(...encodePlane(plane(1, 1), width, 1, 1, () => 0, 8));
  const uv = [plane(0, 2 ** 18), plane(-(2 ** 16), 2 ** 16)], weights = plane(0, 4);
  for (const numbers of uv) bytes.push(...encodePlane(numbers, width, 3, 4, () => 0));
  bytes.push(...encodePlane(weights, width, 1, 1, () => 0, 8));
  const there = (x, y, from) => x >= 0 && y >= 0 && x < width && y < height && y >> 6 === from >> 6 && present[y * width + x];
  const footprint = [];
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const i = y * width + x;
      if (!present[i]) continue;
      const step = (axis, dx, dy) => {
        const far = dx + width * dy, at = (k) => there(x + k * dx, y + k * dy, y);
        const between = (k) => {
          const d = (uv[axis][i + (k + 1) * far] - uv[axis][i + k * far]) / 2 ** 18;
          return periodic[axis] ? [d - 1, d, d + 1].reduce((m, e) => (Math.abs(e) < Math.abs(m) ? e : m)) : d;
        };
        if (at(-1) && at(1)) return (between(-1) + between(0)) / 2;
        const side = at(-1) ? -1 : 1, first = side < 0 ? -1 : 0; // a parabola through three pixels, or a line through two
        if (!at(side)) return 0;
        return at(2 * side) ? between(first) + (between(first) - between(first + side)) / 2 : between(first);
      };
      footprint.push([i, uv[0][i] / 2 ** 18, uv[1][i] / 2 ** 18, step(0, 1, 0), step(0, 0, 1), step(1, 1, 0), step(1, 0, 1), (weights[i] ?? 0) / 4, 0]);
    }
  info.records = footprint.length;
  compare(info, decodeClass(info, Uint8Array.from(bytes), info.base, periodic), [footprint]);
});

test("classes of another length or number of records are damaged", async () => {
  const info = { file: "c.z", width: 2, height: 1, spreads: 2, footprints: [{ first: 1, per_octave: 1, sigma_first: 0, angle_steps: 0, weights: ["one", null] }] };
  const bytes = [3, 0, 0, 0, 0]; // both pixels, and planes of zeros
  decodeClass({ ...info, records: 2 }, Uint8Array.from(bytes), 0);
  await fails(() => decodeClass({ ...info, records: 1 }, Uint8Array.from(bytes), 0), "c.z is damaged.");
  await fails(() => decodeClass({ ...info, records: 2 }, Uint8Array.from([...bytes, 0]), 0), "c.z is damaged.");
});

test("the footprints of a room that retex-pack wrote are those that numpy reads", () => {
  const here = new URL(".", import.meta.url).pathname, folder = mkdtempSync(`${tmpdir()}/player-`);
  const bin = `${process.env.BUILD || "build"}/bin`, run = (program, ...args) => execFileSync(program, args, { maxBuffer: 1 << 28 });
  try {
    run(`${bin}/retex-render`, "-q", "--size", "48x27", "--spp", "16", "--denoise", "-t", "Floor", "-t", "Wall",
      `${here}/../../scenes/living-room/living-room.pov`, "-o", `${folder}/s.exr`);
    run(`${bin}/retex-pack`, "-q", `${folder}/s.exr`, "--web", `${folder}/room`);
    const room = JSON.parse(readFileSync(`${folder}/room/room.json`, "utf8"));
    const expected = JSON.parse(run("/usr/bin/python3", "-B", `${here}/classes.py`, `${folder}/room`));
    same(expected.length, room.classes.length);
    player().checkManifest(room);
    /* Light is loaded with the target that the name of its file has, or is of all of them. */
    const targets = room.lights.map((light) => light.target), named = ({ file }) => room.targets.findIndex(({ name }) => file.includes(`_${name}_`));
    same(targets, room.lights.map(named));
    same([new Set(targets).size, Math.min(...targets)], [3, -1]);
    let base = 0;
    room.classes.forEach((info, k) => {
      const data = inflateSync(readFileSync(`${folder}/room/${info.file}`));
      if (data.length >= mostBytes(info)) throw new Error(`${info.file}: more than ${mostBytes(info)} bytes`);
      compare(Object.assign(info, { base }), decodeClass(info, data, base, room.targets[info.target].periodic), expected[k]);
      base += RECORD_COLUMNS * Math.ceil(info.records * (info.spreads === 4 ? 2 : 1) / RECORD_COLUMNS);
    });
  } finally {
    rmSync(folder, { recursive: true });
  }
});
