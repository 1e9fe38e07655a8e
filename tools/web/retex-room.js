/* <retex-room src="FOLDER/">: a room whose textures can be changed in the browser. FOLDER is what `retex-pack --web`
 * wrote. The picture is a polynomial in the textures, see retex-web(5); WebGL 2 evaluates it. See README.md. */

// ---- files ----

const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; k++) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n;
});

function crc32(bytes) {
  let crc = -1;
  for (let i = 0; i < bytes.length; i++) crc = crcTable[(crc ^ bytes[i]) & 255] ^ (crc >>> 8);
  return ~crc >>> 0;
}

async function fetchBytes(url, signal, cache = "default") {
  let answer;
  try {
    answer = await fetch(url, { signal, cache });
  } catch (error) {
    if (signal.aborted) throw error;
    throw new Error(location.protocol === "file:" ? "This page must come from a web server, not from a file."
      : `${nameOf(url)} could not be loaded.`);
  }
  if (!answer.ok) throw new Error(`${nameOf(url)} is missing (status ${answer.status}).`);
  return new Uint8Array(await answer.arrayBuffer());
}

const nameOf = (url) => decodeURIComponent(String(url).split(/[?#]/)[0].split("/").pop());

/* A file of the room, whose size and checksum the manifest has. */
async function fetchChecked(base, entry, signal) {
  const bytes = await fetchBytes(new URL(entry.file, base), signal);
  if (bytes.length !== entry.bytes || crc32(bytes) !== entry.crc32) throw new Error(`${entry.file} is damaged.`);
  return bytes;
}

async function decodeImage(blob, name) {
  const image = new Image();
  image.src = URL.createObjectURL(blob);
  try {
    await image.decode();
  } catch {
    throw new Error(`${name} is no picture that this browser reads.`);
  } finally {
    URL.revokeObjectURL(image.src);
  }
  return image;
}

const decodeJpeg = (bytes, name) => decodeImage(new Blob([bytes], { type: "image/jpeg" }), name);

async function inflate(bytes, name) {
  try {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    throw new Error(`${name} is damaged.`);
  }
}

// ---- footprints ----

/* The integers of one plane, in the pixels where `present` is 1. */
function decodePlane(stream, present, width, height, out, shift, mask) {
  const head = stream.data[stream.at++], predictor = head & 15, size = head >> 4;
  out.fill(0);
  if (!size) return;
  const count = stream.count, data = stream.data, first = stream.at;
  let last = 0, at = 0;
  for (let y = 0, i = 0; y < height; y++)
    for (let x = 0; x < width; x++, i++) {
      if (!present[i]) continue;
      let residual = data[first + at];
      for (let k = 1; k < size; k++) residual |= data[first + k * count + at] << (8 * k);
      residual = (residual >>> 1) ^ -(residual & 1);
      at++;
      const left = x > 0 && present[i - 1], upper = y > 0 && present[i - width];
      let guess = 0;
      if (!predictor) guess = 0;
      else if (left && upper && present[i - width - 1]) {
        const a = out[i - 1], b = out[i - width], c = out[i - width - 1];
        if (predictor === 1) guess = a;
        else if (predictor === 2) guess = b;
        else if (predictor === 3 || (c < Math.max(a, b) && c > Math.min(a, b))) guess = a + b - c;
        else guess = c >= Math.max(a, b) ? Math.min(a, b) : Math.max(a, b);
      } else guess = left ? out[i - 1] : upper ? out[i - width] : last;
      const s = shift ? shift[i] : 0;
      guess = (guess + ((1 << s) >> 1)) >> s;
      out[i] = last = ((guess + residual) << s) & mask;
    }
  stream.at += count * size;
  if (stream.at > data.length) throw new Error("Footprints are damaged.");
}

const RECORD_COLUMNS = 2048;
const LOG_OFFSET = 24, LOG_STEPS = 2048;

/* All footprints of a class as records of four 32-bit numbers, pixel by pixel, and for each pixel where its records
 * begin, times 32, plus how many there are. */
function decodeClass(info, data, base) {
  const { width, height } = info, pixels = width * height, stream = { data, at: 0, count: 0 };
  const footprints = info.footprints.map((f) => {
    const present = new Uint8Array(pixels), rowBytes = (width + 7) >> 3;
    stream.count = 0;
    for (let y = 0, i = 0; y < height; y++)
      for (let x = 0; x < width; x++, i++)
        stream.count += present[i] = (data[stream.at + y * rowBytes + (x >> 3)] >> (x & 7)) & 1;
    stream.at += rowBytes * height;
    const coded = (bytes) => {
      decodePlane(stream, present, width, height, bytes, null, 255);
      return bytes;
    };
    const spread = Array.from({ length: info.spreads }, () => coded(new Uint8Array(pixels)));
    const uv = [0, 1].map((k) => {
      const shift = new Uint8Array(pixels), out = new Int32Array(pixels);
      for (let i = 0; i < pixels; i++)
        shift[i] = Math.min(Math.max(Math.floor((spread[k][i] - 1 + f.sigma_first) / f.per_octave), 0), 24);
      decodePlane(stream, present, width, height, out, shift, -1);
      return out;
    });
    const weights = f.weights.map((first) => (typeof first === "number" ? coded(new Uint8Array(pixels)) : null));
    return { f, present, spread, uv, weights };
  });
  if (stream.at !== data.length) throw new Error(`${info.file} is damaged.`);
  const most = footprints.reduce((m, { f, weights }) =>
    Math.max(m, ...f.weights.map((w, k) => (w === "one" ? 1 : weights[k] ? w * weights[k].reduce((a, b) => Math.max(a, b), 0) : 0))), 1e-6);
  for (const p of footprints) {
    const { f } = p;
    p.log = Uint16Array.from({ length: 256 }, (_, k) => k ? Math.min(Math.max(
      Math.round((Math.log2(f.first) + (k - 1) / f.per_octave + LOG_OFFSET) * LOG_STEPS), 1), 65535) : 0);
    p.rho = Uint8Array.from({ length: 256 }, (_, k) => f.angle_steps ? 128 + Math.round(127 *
      Math.sin(Math.min(Math.max((k - 128) / f.angle_steps, -1), 1) * Math.PI / 2)) : 128);
    p.share = f.weights.map((w) => Uint16Array.from({ length: 256 }, (_, k) =>
      w === "one" ? 4095 : w ? Math.round(Math.min(k * w / most, 1) * 4095) : 0));
    if (f.weights.includes("one")) p.share = p.share.map((t, k) => f.weights[k] === "one" ? t.fill(Math.round(4095 / most)) : t);
  }
  const total = footprints.reduce((n, p) => n + p.present.reduce((a, b) => a + b, 0), 0);
  if (total !== info.records) throw new Error(`${info.file} is damaged.`);
  const rows = Math.ceil(total / RECORD_COLUMNS);
  const records = new Uint32Array(rows * RECORD_COLUMNS * 4), floats = new Float32Array(records.buffer);
  const heads = new Uint32Array(pixels);
  let at = 0;
  for (let i = 0; i < pixels; i++) {
    const begin = at;
    for (const p of footprints) {
      if (!p.present[i]) continue;
      const w = [0, 1].map((k) => (p.share[k] ? p.share[k][p.weights[k] ? p.weights[k][i] : 0] : 0));
      floats[4 * at] = p.uv[0][i] / 262144;
      floats[4 * at + 1] = p.uv[1][i] / 262144;
      records[4 * at + 2] = p.log[p.spread[0][i]] | (p.log[p.spread[1][i]] << 16);
      records[4 * at + 3] = (info.spreads > 2 ? p.rho[p.spread[2][i]] : 128) | (w[0] << 8) | (w[1] << 20);
      at++;
    }
    heads[i] = (base + begin) * 32 + at - begin;
  }
  return { heads, records, rows };
}

// ---- shaders ----

const VERTEX = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
precision highp usampler2D;
precision highp usampler2DArray;
vec3 linear(vec3 y) { return mix(y / 12.92, pow((max(y, 0.04045) + 0.055) / 1.055, vec3(2.4)), greaterThan(y, vec3(0.04045))); }
vec3 light(vec3 code, float white, float levels) {
  vec3 y = code * (255.0 / levels);
  return white * mix(linear(y), exp((max(y, 1.0) - 1.0) * (255.0 / 48.0)), greaterThan(y, vec3(1.0)));
}
`;

/* The mean of a texture over a footprint: over an evenly filled ellipse of two standard deviations (disc) or a bell.
 * Three rows across the shorter axis; along the longer axis as many samples as its length needs. Each sample is a
 * trilinear look-up with a part of the footprint's variance, the rows and samples have the rest. */
const FILTER = `
uniform usampler2D records;
uniform mat2 turn[TARGETS];
uniform vec2 offset[TARGETS];
uniform vec3 tint[TARGETS];
uniform bool edited[TARGETS];
vec4 filtered(sampler2D image, mat2 turned, vec2 moved, vec4 bounds, uvec4 record, bool disc) {
  const float along = 32.0;
  vec2 size = vec2(textureSize(image, 0)), uv = vec2(uintBitsToFloat(record.x), uintBitsToFloat(record.y));
  vec2 codes = vec2(float(record.z & 65535u), float(record.z >> 16));
  vec2 sigma = mix(vec2(0.0), exp2(codes / ${LOG_STEPS}.0 - ${LOG_OFFSET}.0), greaterThan(codes, vec2(0.0)));
  float cross = (float(record.w & 255u) - 128.0) / 127.0 * sigma.x * sigma.y;
  mat2 texels = mat2(size.x, 0.0, 0.0, size.y) * turned, back = inverse(texels);
  mat2 c = texels * mat2(sigma.x * sigma.x, cross, cross, sigma.y * sigma.y) * transpose(texels);
  vec2 mean = turned * uv + moved;
  float middle = 0.5 * (c[0][0] + c[1][1]);
  float root = length(vec2(0.5 * (c[0][0] - c[1][1]), c[0][1]));
  float longest = middle + root, shortest = max(middle - root, 0.0);
  float angle = root > 0.0 ? 0.5 * atan(2.0 * c[0][1], c[0][0] - c[1][1]) : 0.0;
  vec2 axis = vec2(cos(angle), sin(angle));
  float reach = disc ? 2.0 : 2.5, least = 2.0 * reach / (1.5 * along);
  float tap = max(max(0.5 * shortest, 1.0 / 6.0), longest * least * least);
  float power = 4.0 * (tap + 1.0 / 12.0), low = floor(0.5 * log2(power));
  float lod = low + (power / exp2(2.0 * low) - 1.0) / 3.0;
  longest = sqrt(max(longest - tap, 0.0));
  shortest = sqrt(max(shortest - tap, 0.0));
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int row = -1; row <= 1; row++) {
    if (row != 0 && shortest < 0.05) continue;
    float t = float(row) * (disc ? 0.70710678 : 1.7320508);
    float weight = disc ? (row == 0 ? 0.5 : 0.25) : (row == 0 ? 2.0 / 3.0 : 1.0 / 6.0);
    float chord = reach * longest * (disc ? sqrt(1.0 - t * t) : 1.0);
    float count = clamp(ceil(2.0 * chord / (1.5 * sqrt(tap))), 1.0, along);
    vec2 across = vec2(-axis.y, axis.x) * (t * shortest * (disc ? 2.0 : 1.0));
    for (float k = 0.5; k < count; k += 1.0) {
      float s = 2.0 * k / count - 1.0;
      vec2 step = axis * (s * chord) + across;
      float w = disc ? weight / count : weight * exp(-0.5 * reach * reach * s * s);
      if (!disc) {
        vec2 at = uv + back * step;
        if (any(lessThan(at, bounds.xy)) || any(greaterThan(at, bounds.zw))) continue;
      }
      vec2 place = mean + step / size;
      sum += w * textureLod(image, vec2(place.x, 1.0 - place.y), lod);
      total += w;
    }
  }
  return total > 0.0 ? sum / total : textureLod(image, vec2(mean.x, 1.0 - mean.y), lod);
}
vec2 shares(uvec4 r) { return vec2(float((r.w >> 8) & 4095u), float(r.w >> 20)); }
uvec4 recordAt(int at) { return texelFetch(records, ivec2(at & ${RECORD_COLUMNS - 1}, at / ${RECORD_COLUMNS}), 0); }
`;

const number = (x) => (/[.e]/.test(String(x)) ? String(x) : `${x}.0`);

/* Adds the colours of class c's records in pixel p to sum and total, weighted by w. */
function classCode(room, c, albedo, slots) {
  const info = room.classes[c], t = info.target, target = room.targets[t];
  const disc = info.kind === "sharp" && room.filter === "box";
  const bound = (value, k, far) => number(target.periodic[k] ? far : value[k]);
  const bounds = `vec4(${bound(target.uv_min, 0, -1e30)}, ${bound(target.uv_min, 1, -1e30)}, ` +
    `${bound(target.uv_max, 0, 1e30)}, ${bound(target.uv_max, 1, 1e30)})`;
  return `{
    uint head = texelFetch(heads, ivec3(p, ${info.layer}), 0).r;
    int count = int(head & 31u), first = int(head >> 5);
    vec3 own = count > 0 ? ${albedo} : vec3(0.0);
    for (int i = 0; i < count; i++) {
      uvec4 r = recordAt(first + i);
      vec2 w = shares(r);
      vec3 color = own;
      if (edited[${t}]${slots.original ? " && !original" : ""}) {
        vec4 found = filtered(image${t}, turn[${t}], offset[${t}], ${bounds}, r, ${disc});
        color = mix(own, found.rgb * tint[${t}], found.a);
      }
      ${slots.add}
    }
  }`;
}

const lightCode = (room, l) => `light(texelFetch(lights, ivec3(p, ${l}), 0).rgb, ${number(room.lights[l].white)}, ${number(room.lights[l].levels)})`;

const imageUniforms = (room) => room.targets.map((_, t) => `uniform sampler2D image${t};`).join("\n");

const withTargets = (room, text) => text.replace(/TARGETS/g, room.targets.length);

/* An image of the atlas at pixel p of the size that is `finest` times smaller than the picture. */
function tileCode(room, index, finest) {
  const t = room.reduced.tiles[index];
  const read = (at) => `light(texelFetch(reduced, ivec2(${t.x}, ${t.y}) + ${at}, 0).rgb, ${number(t.white)}, ${number(t.levels)})`;
  if (t.scale === finest) return read(`min(p, ivec2(${t.width - 1}, ${t.height - 1}))`);
  return `bilinear${index}(p)`;
}

function tileFunction(room, index, finest) {
  const t = room.reduced.tiles[index];
  if (t.scale === finest) return "";
  const read = (x, y) => `light(texelFetch(reduced, ivec2(${t.x}, ${t.y}) + ivec2(${x}, ${y}), 0).rgb, ${number(t.white)}, ${number(t.levels)})`;
  return `vec3 bilinear${index}(ivec2 p) {
    vec2 at = clamp((vec2(p) + 0.5) / ${number(t.scale / finest)} - 0.5, vec2(0.0), vec2(${t.width - 1}, ${t.height - 1}));
    ivec2 a = ivec2(at), b = min(a + 1, ivec2(${t.width - 1}, ${t.height - 1}));
    vec2 f = fract(at);
    return mix(mix(${read("a.x", "a.y")}, ${read("b.x", "a.y")}, f.x), mix(${read("a.x", "b.y")}, ${read("b.x", "b.y")}, f.x), f.y);
  }`;
}

/* First step: mixtures that are smaller than the picture, one layer each. */
function mixtureShader(room) {
  const cases = room.mixtures.map((m, index) => {
    if (room.classes[m[0][0]].scale === 1) return "";
    const code = m.map(([c, slot]) => classCode(room, c, tileCode(room, room.classes[c].albedo, room.classes[c].scale), {
      original: true, add: `sum += w[${slot}] * color; total += w[${slot}];`,
    }));
    return `if (mixture == ${index}) { ${code.join("\n")} }`;
  });
  return HEAD + withTargets(room, FILTER) + imageUniforms(room) + `
uniform usampler2DArray heads;
uniform sampler2D reduced;
uniform int mixture;
uniform bool original;
out vec4 result;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
  float total = 0.0;
  ${cases.join("\n")}
  result = vec4(total > 0.0 ? sum / total : vec3(0.0), 1.0);
}`;
}

/* Second step: for each group the sum over its terms of gain times mixtures, at the finest of the smaller sizes. */
function factorShader(room) {
  const scale = (m) => room.classes[room.mixtures[m][0][0]].scale;
  const size = (m) => [room.classes[room.mixtures[m][0][0]].width, room.classes[room.mixtures[m][0][0]].height];
  const used = [...new Set(room.terms.flatMap((t) => t.factors))];
  const cases = room.groups.map((_, g) => {
    const terms = room.terms.filter((t) => t.group === g);
    const mixtures = [...new Set(terms.flatMap((t) => t.factors))];
    return `if (group == ${g}) {
      ${mixtures.map((m) => `vec3 m${m} = mixed(${room.mixtureLayers[m]}, vec2(${size(m)}), ${number(scale(m) / room.finest)});`).join("\n")}
      ${terms.map((t) => {
        const factors = t.factors.map((m) => `m${m}`);
        if (t.gain >= 0) factors.unshift(tileCode(room, t.gain, room.finest));
        return `sum += ${factors.join(" * ") || "vec3(1.0)"};`;
      }).join("\n")}
    }`;
  });
  const tiles = [...new Set(room.terms.map((t) => t.gain).filter((g) => g >= 0))];
  return HEAD + `
uniform sampler2DArray mixtures;
uniform sampler2D reduced;
uniform int group;
out vec4 result;
vec3 mixed(int layer, vec2 size, float times) {
  vec2 at = clamp(gl_FragCoord.xy / times, vec2(0.5), size - 0.5);
  return texture(mixtures, vec3(at / vec2(textureSize(mixtures, 0).xy), layer)).rgb;
}
${tiles.map((t) => tileFunction(room, t, room.finest)).join("\n")}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
  ${used.length || cases.length ? cases.join("\n") : ""}
  result = vec4(sum, 1.0);
}`;
}

/* Last step: the picture. While not everything is loaded it is the still plus what new textures change. */
function pictureShader(room) {
  const full = room.mixtures.map((m, i) => [m, i]).filter(([m]) => room.classes[m[0][0]].scale === 1);
  const byClass = new Map();
  for (const [m, i] of full) for (const [c, slot] of m) byClass.set(c, [...(byClass.get(c) || []), [i, slot]]);
  const mixtures = [...byClass].map(([c, list]) => `
  if (loaded[${c}]) ${classCode(room, c, lightCode(room, room.classes[c].albedo), {
    add: list.map(([i, slot]) => `sum${i} += w[${slot}] * color; total${i} += w[${slot}];`).join(" ") +
      list.map(([i, slot]) => `own${i} += w[${slot}] * own;`).join(" "),
  })}`);
  const groups = room.groups.map((g, i) => {
    const factor = g.mixture < 0 ? "" : ` * mean(sum${g.mixture}, total${g.mixture})`;
    const before = g.mixture < 0 ? "" : ` * mean(own${g.mixture}, total${g.mixture})`;
    return `
  if (ready[${i}]) {
    vec3 d = ${lightCode(room, g.light)};
    color += d * factor(factors, ${i})${factor};
    if (partial) color -= d * factor(originals, ${i})${before};
  }`;
  });
  const small = [Math.ceil(room.width / room.finest), Math.ceil(room.height / room.finest)];
  return HEAD + withTargets(room, FILTER) + imageUniforms(room) + `
uniform usampler2DArray heads;
uniform sampler2DArray lights, factors, originals;
uniform sampler2D still;
uniform bool loaded[${room.classes.length}];
uniform bool ready[${room.groups.length}];
uniform bool partial;
uniform float split;
uniform vec3 lamp;
out vec4 result;
vec3 factor(sampler2DArray from, int layer) {
  vec2 at = clamp((vec2(gl_FragCoord.x, ${number(room.height)} - gl_FragCoord.y)) / ${number(room.finest)}, vec2(0.5), vec2(${small.map(number)}) - 0.5);
  return texture(from, vec3(at / vec2(textureSize(from, 0).xy), layer)).rgb;
}
vec3 mean(vec3 sum, float total) { return total > 0.0 ? sum / total : vec3(0.0); }
void main() {
  ivec2 p = ivec2(int(gl_FragCoord.x), ${room.height - 1} - int(gl_FragCoord.y));
  vec3 color = linear(texelFetch(still, p, 0).rgb);
  if (gl_FragCoord.x >= split) {
    if (!partial) color = vec3(0.0);
    ${full.map(([, i]) => `vec3 sum${i} = vec3(0.0), own${i} = vec3(0.0); float total${i} = 0.0;`).join("\n")}
    ${mixtures.join("")}
    ${groups.join("")}
  }
  vec3 y = clamp(color * lamp, 0.0, 1.0);
  result = vec4(mix(12.92 * y, 1.055 * pow(max(y, 0.0031308), vec3(1.0 / 2.4)) - 0.055, greaterThan(y, vec3(0.0031308))), 1.0);
}`;
}

// ---- the room on the graphics card ----

/* Numbers go into shaders, so they must be numbers. */
function checkManifest(room) {
  const bad = () => { throw new Error("room.json is damaged."); };
  if (!room || typeof room !== "object") bad();
  if (room.retex_web !== 1) throw new Error("room.json is of another version, or no room.");
  const list = (value, keys) => {
    if (!Array.isArray(value) || value.some((x) => keys.split(" ").some((k) => typeof x[k] !== "number"))) bad();
    return value;
  };
  const inside = (index, array, least = 0) => Number.isInteger(index) && index >= least && index < array.length || bad();
  for (const key of ["width", "height", "finest"]) if (!Number.isInteger(room[key]) || room[key] < 1) bad();
  list(room.targets, "share");
  list(room.lights, "bytes crc32 white levels target");
  list(room.classes, "bytes crc32 target scale width height albedo spreads records");
  list(room.groups, "light mixture target");
  list(room.terms, "group gain");
  const tiles = room.reduced ? list(room.reduced.tiles, "x y width height scale white levels") : [];
  if (!Array.isArray(room.mixtures)) bad();
  for (const t of room.targets) for (const key of ["uv_min", "uv_max", "uv_scale", "periodic"]) if (t[key]?.length !== 2) bad();
  for (const c of room.classes) {
    inside(c.target, room.targets);
    inside(c.albedo, c.scale === 1 ? room.lights : tiles);
    list(c.footprints, "first per_octave sigma_first angle_steps");
  }
  for (const m of room.mixtures) if (!m.length || m.some(([c, slot]) => inside(c, room.classes) !== true || !(slot in [0, 1]))) bad();
  for (const g of room.groups) inside(g.light, room.lights), inside(g.mixture, room.mixtures, -1);
  for (const t of room.terms) {
    inside(t.group, room.groups);
    inside(t.gain, tiles, -1);
    for (const m of t.factors) inside(m, room.mixtures);
  }
}

class Renderer {
  constructor(canvas, room) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no WebGL 2");
    if (!gl.getExtension("EXT_color_buffer_float") && !gl.getExtension("EXT_color_buffer_half_float")) throw new Error("no WebGL 2");
    Object.assign(this, { gl, room, loaded: new Set(), lights: new Set(), textures: [], most: gl.getParameter(gl.MAX_TEXTURE_SIZE) });
    if (Math.max(room.width, room.height) > this.most) throw new Error("The room is too large for this device.");
    canvas.width = room.width;
    canvas.height = room.height;
    this.full = room.classes.filter((c) => c.scale === 1);
    this.small = room.classes.filter((c) => c.scale > 1);
    this.full.forEach((c, i) => (c.layer = i));
    this.small.forEach((c, i) => (c.layer = i));
    let layers = 0, rows = 0;
    room.mixtureLayers = room.mixtures.map((m) => (room.classes[m[0][0]].scale > 1 ? layers++ : -1));
    for (const c of room.classes) {
      c.base = rows * RECORD_COLUMNS;
      rows += Math.ceil(c.records / RECORD_COLUMNS);
    }
    if (rows > this.most) throw new Error("The room is too large for this device.");
    const most = (list, key) => Math.max(1, ...list.map((x) => x[key]));
    const smallSize = [most(this.small, "width"), most(this.small, "height")];
    this.groupSize = [Math.ceil(room.width / room.finest), Math.ceil(room.height / room.finest)];
    this.records = this.texture(gl.TEXTURE_2D, gl.RGBA32UI, RECORD_COLUMNS, Math.max(rows, 1), 0, gl.NEAREST);
    this.heads = this.texture(gl.TEXTURE_2D_ARRAY, gl.R32UI, room.width, room.height, Math.max(this.full.length, 1), gl.NEAREST);
    this.smallHeads = this.texture(gl.TEXTURE_2D_ARRAY, gl.R32UI, ...smallSize, Math.max(this.small.length, 1), gl.NEAREST);
    this.light = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA8, room.width, room.height, room.lights.length, gl.NEAREST);
    this.still = this.texture(gl.TEXTURE_2D, gl.RGBA8, room.width, room.height, 0, gl.NEAREST);
    this.mixtures = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA16F, ...smallSize, Math.max(layers, 1), gl.LINEAR);
    this.factors = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA16F, ...this.groupSize, room.groups.length, gl.LINEAR);
    this.originals = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA16F, ...this.groupSize, room.groups.length, gl.LINEAR);
    this.none = this.texture(gl.TEXTURE_2D, gl.RGBA8, 1, 1, 0, gl.NEAREST);
    this.frame = gl.createFramebuffer();
    this.programs = [mixtureShader(room), factorShader(room), pictureShader(room)].map((text) => this.program(text));
    for (const target of room.targets) this.textures.push(null), (target.image = this.none);
  }

  texture(kind, format, width, height, layers, filter) {
    const { gl } = this, texture = gl.createTexture();
    gl.bindTexture(kind, texture);
    if (layers) gl.texStorage3D(kind, 1, format, width, height, layers);
    else gl.texStorage2D(kind, 1, format, width, height);
    for (const [key, value] of [["MIN_FILTER", filter], ["MAG_FILTER", filter], ["WRAP_S", gl.CLAMP_TO_EDGE], ["WRAP_T", gl.CLAMP_TO_EDGE]])
      gl.texParameteri(kind, gl[`TEXTURE_${key}`], value);
    return texture;
  }

  program(fragment) {
    const { gl } = this, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Error(`The room's shader does not compile: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error(`The room's shader does not link: ${gl.getProgramInfoLog(program)}`);
    const uniforms = new Map();
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const { name, type } = gl.getActiveUniform(program, i);
      uniforms.set(name.replace("[0]", ""), { at: gl.getUniformLocation(program, name), type });
    }
    return { program, uniforms };
  }

  putClass(info, { heads, records, rows }) {
    const { gl } = this;
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    gl.bindTexture(gl.TEXTURE_2D, this.records);
    if (rows) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, info.base / RECORD_COLUMNS, RECORD_COLUMNS, rows, gl.RGBA_INTEGER, gl.UNSIGNED_INT, records);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, info.scale === 1 ? this.heads : this.smallHeads);
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, info.layer, info.width, info.height, 1, gl.RED_INTEGER, gl.UNSIGNED_INT, heads);
    this.loaded.add(info);
    if (info.scale === 1) info.heads = heads; // for pointing at targets
  }

  /* Codes of images are numbers here: the browser must not convert them. */
  exactly(upload) {
    const { gl } = this;
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    upload();
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.BROWSER_DEFAULT_WEBGL);
  }

  putLight(index, image) {
    const { gl, room } = this;
    if (image.naturalWidth !== room.width || image.naturalHeight !== room.height) throw new Error(`${room.lights[index].file} is damaged.`);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.light);
    this.exactly(() => gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, index, room.width, room.height, 1, gl.RGBA, gl.UNSIGNED_BYTE, image));
    this.lights.add(index);
  }

  putStill(image) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.still);
    this.exactly(() => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, image));
  }

  putReduced(image) {
    const { gl } = this;
    if (Math.max(image.naturalWidth, image.naturalHeight) > this.most) throw new Error("The room is too large for this device.");
    this.reduced = this.texture(gl.TEXTURE_2D, gl.RGBA8, image.naturalWidth, image.naturalHeight, 0, gl.NEAREST);
    this.exactly(() => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, image));
  }

  /* A new texture: an image, or a linear colour; null: the original. */
  putTexture(index, source) {
    const { gl } = this, target = this.room.targets[index];
    if (target.image !== this.none) gl.deleteTexture(target.image);
    target.image = this.none;
    target.hasImage = !!source;
    if (!source) return;
    const width = source.naturalWidth || source.width || 1, height = source.naturalHeight || source.height || 1;
    target.image = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, target.image);
    if (Array.isArray(source)) {
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA16F, 1, 1);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array([...source, 1]));
    } else {
      gl.texStorage2D(gl.TEXTURE_2D, Math.floor(Math.log2(Math.max(width, height))) + 1, gl.SRGB8_ALPHA8, width, height);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, source);
      gl.generateMipmap(gl.TEXTURE_2D);
    }
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, Array.isArray(source) ? gl.NEAREST : gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, Array.isArray(source) ? gl.NEAREST : gl.LINEAR);
  }

  /* Draw with one program; values by name: numbers, arrays, or [kind, texture]. */
  draw({ program, uniforms }, values) {
    const { gl } = this;
    gl.useProgram(program);
    let unit = 0;
    for (const [name, { at, type }] of uniforms) {
      const value = values[name];
      if (value instanceof WebGLTexture) {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(type === gl.SAMPLER_2D || type === gl.UNSIGNED_INT_SAMPLER_2D ? gl.TEXTURE_2D : gl.TEXTURE_2D_ARRAY, value);
        gl.uniform1i(at, unit++);
      } else if (type === gl.FLOAT_MAT2) gl.uniformMatrix2fv(at, false, value);
      else if (type === gl.FLOAT_VEC2) gl.uniform2fv(at, value);
      else if (type === gl.FLOAT_VEC3) gl.uniform3fv(at, value);
      else if (type === gl.FLOAT) gl.uniform1f(at, value);
      else if (Array.isArray(value)) gl.uniform1iv(at, value);
      else gl.uniform1i(at, value);
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  into(texture, layer, width, height) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture, 0, layer);
    gl.viewport(0, 0, width, height);
  }

  /* What is smaller than the picture: mixtures, then factors of groups. */
  drawFactors(to, original, values) {
    const { room } = this;
    room.mixtures.forEach((m, mixture) => {
      const c = room.classes[m[0][0]];
      if (c.scale === 1) return;
      this.into(this.mixtures, room.mixtureLayers[mixture], c.width, c.height);
      this.draw(this.programs[0], { ...values, heads: this.smallHeads, mixture, original: original ? 1 : 0 });
    });
    room.groups.forEach((_, group) => {
      this.into(to, group, ...this.groupSize);
      this.draw(this.programs[1], { mixtures: this.mixtures, reduced: this.reduced, group });
    });
  }

  get complete() {
    return this.loaded.size === this.room.classes.length && this.lights.size === this.room.lights.length;
  }

  isReady(group) {
    const { room } = this, g = room.groups[group];
    const mixtures = room.terms.filter((t) => t.group === group).flatMap((t) => t.factors);
    if (g.mixture >= 0) mixtures.push(g.mixture);
    return (this.reduced || !room.reduced) && this.lights.has(g.light) && mixtures.every((m) => room.mixtures[m].every(([c]) =>
      this.loaded.has(room.classes[c]) && (room.classes[c].scale > 1 || this.lights.has(room.classes[c].albedo))));
  }

  /* Whether a target's own light is there. */
  canEdit(target) {
    return this.room.groups.every((g, i) => g.target !== target || this.isReady(i));
  }

  /* settings: by target {scale, rotate, offset, tint}; split: pixels from the left that stay as they were. */
  render(settings, split, lamp) {
    const { gl, room } = this, count = room.targets.length;
    const values = { records: this.records, reduced: this.reduced || this.none, turn: [], offset: [], tint: [], edited: [] };
    for (let t = 0; t < count; t++) {
      const s = settings[t], angle = s.rotate * Math.PI / 180, [c, d] = [Math.cos(angle), Math.sin(angle)];
      values.turn.push(c * s.scale[0], d * s.scale[0], -d * s.scale[1], c * s.scale[1]);
      values.offset.push(...s.offset);
      values.tint.push(...s.tint);
      values.edited.push(room.targets[t].hasImage ? 1 : 0);
      values[`image${t}`] = room.targets[t].image;
    }
    const partial = !this.complete, ready = room.groups.map((_, g) => (this.isReady(g) ? 1 : 0));
    if (ready.includes(1)) {
      if (partial) this.drawFactors(this.originals, true, values);
      this.drawFactors(this.factors, false, values);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, room.width, room.height);
    this.draw(this.programs[2], {
      ...values, heads: this.heads, lights: this.light, factors: this.factors, originals: this.originals, still: this.still,
      loaded: room.classes.map((c) => (this.loaded.has(c) && c.scale === 1 ? 1 : 0)), ready, partial: partial ? 1 : 0, split, lamp,
    });
  }
}

// ---- colours ----

const srgbDecode = (y) => (y <= 0.04045 ? y / 12.92 : ((y + 0.055) / 1.055) ** 2.4);
const srgbEncode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

/* "#rrggbb" as a display shows it, or "rgb(r,g,b)" with linear numbers from 0 to 1, as the tools take it. Or null. */
function parseColor(text) {
  const hex = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(text);
  if (hex) return hex.slice(1).map((x) => srgbDecode(parseInt(x, 16) / 255));
  const linear = /^rgb\(\s*([\d.]+)\s*,\s*([\d.]+)\s*,\s*([\d.]+)\s*\)$/.exec(text);
  return linear ? linear.slice(1).map(Number) : null;
}

const toHex = (linear) => "#" + linear.map((x) => Math.round(255 * srgbEncode(Math.min(Math.max(x, 0), 1))).toString(16).padStart(2, "0")).join("");

const plainTexture = () => ({ source: null, label: "Original", scale: 1, rotate: 0, offset: [0, 0], tint: "#ffffff" });
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

// ---- the element ----

const STYLE = `
:host { display: block; position: relative; font: 15px/1.4 system-ui, sans-serif; color: #222; background: #f6f5f3; --line: #0002; --accent: #2f5d50; }
* { box-sizing: border-box; }
[hidden] { display: none !important; }
.room { display: grid; grid-template-columns: minmax(0, 1fr) 300px; height: 100%; }
.stage { position: relative; overflow: hidden; background: #e9e7e3; min-height: 0; display: grid; place-items: center; cursor: pointer; touch-action: pan-y; }
.stage.zoomed { cursor: grab; touch-action: none; }
.view { position: relative; width: 100%; max-height: 100%; transform-origin: 0 0; }
.view img, .view canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; }
.view canvas { opacity: 0; transition: opacity .3s; }
.view canvas.shown { opacity: 1; }
.bar { position: absolute; inset: 0 0 auto; height: 3px; appearance: none; width: 100%; border: 0; background: transparent; }
.bar::-webkit-progress-bar { background: transparent; } .bar::-webkit-progress-value { background: var(--accent); } .bar::-moz-progress-bar { background: var(--accent); }
.tools { position: absolute; right: 10px; bottom: 10px; display: flex; gap: 2px; padding: 3px; border-radius: 12px; background: #fffd; box-shadow: 0 1px 6px #0003; }
.tools button { border: 0; background: none; min-width: 44px; height: 44px; padding: 0 6px; border-radius: 9px; }
svg { width: 22px; height: 22px; fill: none; stroke: currentColor; stroke-width: 1.7; display: block; margin: auto; }
.tools button:hover, .tools button[aria-pressed=true] { background: #0001; }
.name { position: absolute; left: 10px; top: 10px; padding: 4px 10px; border-radius: 10px; background: #fffd; pointer-events: none; }
.line { position: absolute; width: 2px; margin-left: -1px; background: #fff; box-shadow: 0 0 4px #0008; pointer-events: none; }
.split { position: absolute; height: 44px; margin: 0; background: none; appearance: none; cursor: ew-resize; }
.split::-webkit-slider-thumb { appearance: none; width: 44px; height: 44px; border-radius: 50%; background: #fffe; box-shadow: 0 1px 6px #0005; }
.split::-moz-range-thumb { width: 44px; height: 44px; border: 0; border-radius: 50%; background: #fffe; box-shadow: 0 1px 6px #0005; }
.split::-webkit-slider-runnable-track { background: none; }
.split:focus-visible { outline: none; } .split:focus-visible::-webkit-slider-thumb { outline: 3px solid var(--accent); } .split:focus-visible::-moz-range-thumb { outline: 3px solid var(--accent); }
.message { position: absolute; left: 16px; top: 16px; max-width: calc(100% - 32px); padding: 14px 20px; border-radius: 12px; background: #fff; box-shadow: 0 2px 14px #0004; }
.panel { padding: 18px; overflow: auto; border-left: 1px solid var(--line); background: #fff; min-height: 0; }
h2 { font-size: 13px; font-weight: 600; margin: 18px 0 6px; color: #555; } h2:first-child { margin-top: 0; }
.row { display: flex; flex-wrap: wrap; gap: 6px; }
button { font: inherit; color: inherit; cursor: pointer; }
.panel button, .file { min-height: 40px; padding: 6px 12px; border: 1px solid var(--line); border-radius: 10px; background: #fff; }
.panel button:hover, .file:hover { border-color: #0006; }
.panel [aria-pressed=true] { border-color: var(--accent); background: #2f5d5014; }
.panel button:disabled { opacity: .45; cursor: default; }
.swatch { width: 44px; height: 44px; padding: 0 !important; background-size: cover !important; }
.file { display: inline-flex; align-items: center; cursor: pointer; }
.file:focus-within, :focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
.file input { position: absolute; opacity: 0; width: 1px; height: 1px; }
label.slider { display: grid; grid-template-columns: 86px 1fr 48px; align-items: center; gap: 8px; min-height: 40px; }
label.slider output { text-align: right; font-variant-numeric: tabular-nums; color: #555; }
input[type=range] { width: 100%; height: 30px; accent-color: var(--accent); margin: 0; }
input[type=color] { width: 44px; height: 40px; padding: 2px; border: 1px solid var(--line); border-radius: 10px; background: #fff; }
.drop { outline: 3px dashed var(--accent); outline-offset: -8px; }
.quiet { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
@media (max-width: 760px), (max-aspect-ratio: 1/1) {
  .room { grid-template: auto minmax(0, 1fr) / minmax(0, 1fr); }
  .panel { border-left: 0; border-top: 1px solid var(--line); padding: 14px; }
  .tools { position: relative; inset: auto; width: 100%; justify-content: space-around; border-radius: 0; background: inherit; box-shadow: none; }
  .stage { grid-template-rows: auto auto; }
}
@media (prefers-reduced-motion: reduce) { * { transition: none !important; } }
@media (prefers-color-scheme: dark) {
  :host { color: #eee; background: #1b1b1a; --line: #fff3; --accent: #8fc7b5; }
  .stage { background: #111; } .panel, .panel button, .file, input[type=color], .message { background: #222221; }
  .tools, .name { background: #222d; } h2, label.slider output { color: #bbb; } .tools button:hover { background: #fff2; }
}`;

const TOOLS = [
  ["compare", "Before and after", "M4 5h16v14H4zM12 2v20"],
  ["out", "Zoom out", "M5 12h14"],
  ["in", "Zoom in", "M5 12h14M12 5v14"],
  ["full", "Full screen", "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5"],
  ["download", "Download the picture", "M12 4v11M7 11l5 5 5-5M5 20h14"],
  ["link", "Copy a link to this room", "M10 14l4-4M8 11l-3 3a3.5 3.5 0 0 0 5 5l3-3M16 13l3-3a3.5 3.5 0 0 0-5-5l-3 3"],
].map(([name, text, path]) => `<button data-do="${name}" title="${text}" aria-label="${text}"><svg aria-hidden="true" viewBox="0 0 24 24"><path d="${path}"/></svg></button>`).join("");

const slider = (name, text, low, high, step) => `<label class="slider"><span>${text}</span><input type="range" min="${low}" max="${high}" step="${step}" value="0" data-set="${name}"><output></output></label>`;

const BODY = `
<div class="room">
  <div class="stage" part="stage" tabindex="0" role="group" aria-label="Picture">
    <div class="view"><img alt="" hidden><canvas role="img" aria-label="The room"></canvas></div>
    <div class="name" aria-hidden="true" hidden></div>
    <div class="line" hidden></div>
    <input class="split" type="range" min="0" max="100" step="1" value="50" aria-label="Before and after" hidden>
    <progress class="bar" max="1" value="0" aria-label="Loading"></progress>
    <div class="message" role="alert" hidden></div>
    <div class="tools" role="toolbar" aria-label="View">
${TOOLS}
    </div>
  </div>
  <div class="panel" part="panel">
    <h2 id="what">Surface</h2>
    <div class="row targets" role="group" aria-labelledby="what"></div>
    <h2 id="with">Texture</h2>
    <div class="row swatches" role="group" aria-labelledby="with"></div>
    <div class="row" style="margin-top:6px">
      <label class="file">Choose a picture…<input type="file" accept="image/*" data-set="file"></label>
      <input type="color" value="#c8b9a6" data-set="color" title="One colour" aria-label="One colour">
      <button data-do="original">Original</button>
    </div>
    <div class="placing">
      ${slider("size", "Size", -3, 3, 0.01)}${slider("rotate", "Turn", -180, 180, 1)}
      ${slider("right", "Shift right", -1, 1, 0.01)}${slider("up", "Shift up", -1, 1, 0.01)}
      <label class="slider"><span>Tint</span><input type="color" data-set="tint"><output></output></label>
    </div>
    <h2>Light</h2>
    ${slider("exposure", "Brightness", -2, 2, 0.05)}${slider("warmth", "Warmth", -1, 1, 0.05)}
  </div>
  <div class="quiet" role="status" aria-live="polite"></div>
</div>`;

const NO_WEBGL = "This browser cannot change textures: it has no WebGL 2. The picture is as it was rendered.";

class RetexRoom extends HTMLElement {
  static observedAttributes = ["src"];

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    root.innerHTML = `<style>${STYLE}</style>${BODY}`;
    this.$ = (selector) => root.querySelector(selector);
    this.textures = [];
    this.light = { exposure: 0, warmth: 0 };
    this.zoom = { times: 1, x: 0, y: 0 };
    this.selected = 0;
    this.loading = 0;
    this.listen(root);
  }

  connectedCallback() {
    if (!this.started && this.hasAttribute("src")) this.load();
  }

  disconnectedCallback() {
    this.abort?.abort();
    this.started = false;
  }

  attributeChangedCallback() {
    if (this.isConnected) this.load();
  }

  // ---- public ----

  /* The names of what can be changed. */
  get targets() {
    return this.room ? this.room.targets.map((t) => t.name) : [];
  }

  /* Resolves when all is loaded. */
  get complete() {
    return this.whenComplete;
  }

  /* Put a texture on a target: a File or Blob, the URL of a picture, "#rrggbb", "rgb(r,g,b)" with linear numbers, or null
   * for the original. options: scale (a number keeps the picture's proportions, a pair is as of retex-combine), rotate in
   * degrees, offset [u, v], tint "#rrggbb", label. Resolves when it is drawn. */
  async setTexture(name, source, options = {}) {
    const index = this.indexOf(name), order = (this.textures[index].order = (this.textures[index].order || 0) + 1);
    let image = null, label = "Original", kept = null;
    if (source instanceof Blob) {
      label = source.name || "Picture";
      image = await decodeImage(source, label);
    } else if (source) {
      kept = String(source);
      image = parseColor(kept);
      label = kept;
      if (!image) {
        label = nameOf(kept);
        const bytes = await fetchBytes(new URL(kept, document.baseURI), this.abort.signal);
        image = await decodeImage(new Blob([bytes]), label);
      }
    }
    if (order !== this.textures[index].order) return; // another one has been chosen since
    const most = Math.min(this.renderer?.most || 4096, 4096);
    if (image && !Array.isArray(image) && Math.max(image.naturalWidth, image.naturalHeight) > most) image = smaller(image, most);
    Object.assign(this.textures[index], plainTexture(), { source: kept, label, image, local: source instanceof Blob, order });
    this.renderer?.putTexture(index, image);
    this.place(name, options);
    this.say(`${name}: ${this.textures[index].label}`);
  }

  /* Change scale, rotate, offset or tint of a target's texture. */
  place(name, options) {
    const texture = this.textures[this.indexOf(name)];
    for (const key of ["scale", "rotate", "offset", "tint", "label"]) if (options[key] !== undefined) texture[key] = options[key];
    this.update();
  }

  /* Brightness in stops, warmth from -1 to 1. */
  setLight(light) {
    Object.assign(this.light, light);
    this.update();
  }

  getState() {
    const textures = {};
    this.textures.forEach(({ source, scale, rotate, offset, tint }, i) => {
      if (source) textures[this.targets[i]] = { source, scale, rotate, offset, tint };
    });
    return { textures, light: { ...this.light } };
  }

  async setState(state) {
    this.setLight({ exposure: Number(state.light?.exposure) || 0, warmth: Number(state.light?.warmth) || 0 });
    for (const name of this.targets) {
      const { source = null, ...options } = state.textures?.[name] || {};
      await this.setTexture(name, source, options);
    }
  }

  /* A link to the page with this room's state. Pictures from the visitor's own files are not in it. */
  get link() {
    const url = new URL(location.href);
    url.hash = "room=" + encodeURIComponent(JSON.stringify(this.getState()));
    return url.href;
  }

  /* The picture in the room's own size. */
  toBlob(type = "image/png", quality) {
    this.draw(true);
    return new Promise((resolve) => this.$("canvas").toBlob(resolve, type, quality));
  }

  select(name) {
    this.selected = this.indexOf(name);
    this.refresh();
    this.emit("retex-select", { target: name });
  }

  // ---- loading ----

  async load() {
    this.started = true;
    this.abort?.abort();
    const abort = (this.abort = new AbortController());
    this.renderer = this.room = null;
    this.textures = [];
    this.fail(null);
    this.whenComplete = this.run(abort.signal).catch((error) => {
      if (!abort.signal.aborted) this.fail(error.message);
    });
  }

  async run(signal) {
    const base = new URL(this.getAttribute("src").replace(/\/?$/, "/"), document.baseURI);
    const text = new TextDecoder().decode(await fetchBytes(new URL("room.json", base), signal, "no-cache"));
    let room;
    try {
      room = JSON.parse(text);
    } catch {
      throw new Error("room.json is damaged.");
    }
    try {
      checkManifest(room);
    } catch (error) {
      throw error instanceof TypeError ? new Error("room.json is damaged.") : error;
    }
    if (signal.aborted) return;
    this.room = room;
    this.textures = room.targets.map(plainTexture);
    this.selected = room.targets.reduce((best, t, i) => (t.share > room.targets[best].share ? i : best), 0);
    const view = this.$(".view");
    view.style.aspectRatio = `${room.width} / ${room.height}`;
    view.style.maxWidth = `calc(100cqh * ${room.width / room.height})`;
    this.refresh();
    this.progress = { done: 0, all: [room.picture, room.reduced, ...room.lights, ...room.classes].reduce((n, f) => n + (f?.bytes || 0), 0) };
    const get = async (entry) => {
      const bytes = await fetchChecked(base, entry, signal);
      this.$(".bar").value = (this.progress.done += bytes.length) / this.progress.all;
      return bytes;
    };
    const still = await decodeJpeg(await get(room.picture), room.picture.file);
    if (still.naturalWidth !== room.width || still.naturalHeight !== room.height) throw new Error(`${room.picture.file} is damaged.`);
    const shown = this.$("img");
    shown.src = new URL(room.picture.file, base).href;
    shown.hidden = false;
    this.emit("retex-still", {});
    try {
      this.renderer = new Renderer(this.$("canvas"), room);
    } catch (error) {
      this.$(".bar").hidden = true;
      throw error.message === "no WebGL 2" || typeof DecompressionStream === "undefined" ? new Error(NO_WEBGL) : error;
    }
    this.renderer.putStill(still);
    await this.stream(get, signal);
  }

  /* The target that shows most, then the others, then light that no target changes. */
  async stream(get, signal) {
    const { room, renderer } = this;
    const order = room.targets.map((_, i) => i).sort((a, b) => room.targets[b].share - room.targets[a].share);
    const jobs = [];
    const light = (l) => jobs.push(async () => renderer.putLight(l, await decodeJpeg(await get(room.lights[l]), room.lights[l].file)));
    const footprints = (c) => jobs.push(async () => {
      const data = await inflate(await get(c), c.file);
      await new Promise((resolve) => setTimeout(resolve));
      renderer.putClass(c, decodeClass(c, data, c.base));
    });
    if (room.reduced) jobs.push(async () => renderer.putReduced(await decodeJpeg(await get(room.reduced), room.reduced.file)));
    room.classes.filter((c) => c.kind === "interreflection").forEach(footprints);
    const steps = [];
    for (const t of order) {
      room.classes.filter((c) => c.kind !== "interreflection" && c.target === t).forEach(footprints);
      room.lights.forEach((l, i) => l.target === t && light(i));
      steps.push(jobs.length);
    }
    room.lights.forEach((l, i) => (l.target < 0 || l.target >= room.targets.length) && light(i));
    for (let i = 0, step = 0; i < jobs.length; ) {
      const end = steps[step] ?? jobs.length;
      await Promise.all(jobs.slice(i, end).map((job) => job()));
      if (signal.aborted) return;
      i = end;
      if (step++ === 0) await this.begin();
      this.refresh();
      this.draw(true);
    }
    this.$(".bar").hidden = true;
    this.emit("retex-complete", {});
    this.say("All is loaded.");
  }

  /* The first target can be changed. */
  async begin() {
    this.$("canvas").classList.add("shown");
    this.emit("retex-ready", { targets: this.targets });
    const hash = /[#&]room=([^&]*)/.exec(location.hash);
    if (!hash || this.hasAttribute("no-link")) return;
    try {
      await this.setState(JSON.parse(decodeURIComponent(hash[1])));
    } catch (error) {
      this.fail(`The link's textures could not be restored: ${error.message}`);
    }
  }

  // ---- drawing ----

  settings() {
    return this.textures.map((t, i) => {
      const { uv_scale: unit } = this.room.targets[i], image = t.image;
      let scale = t.scale;
      if (!Array.isArray(scale)) {
        const wide = image && !Array.isArray(image) ? (image.naturalWidth || image.width) / (image.naturalHeight || image.height) : 1;
        scale = [scale, scale * wide * (unit[0] > 0 && unit[1] > 0 ? unit[1] / unit[0] : 1)];
      }
      return { scale, rotate: t.rotate, offset: t.offset, tint: parseColor(t.tint) || [1, 1, 1] };
    });
  }

  /* now: before returning, and not with the next frame. */
  draw(now) {
    if (!this.renderer) return;
    if (!now) {
      this.frame ||= requestAnimationFrame(() => this.draw(true));
      return;
    }
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const begin = performance.now(), { exposure, warmth } = this.light, most = 2 ** exposure;
    const split = this.comparing ? (this.$(".split").value / 100) * this.room.width : 0;
    this.renderer.render(this.settings(), split, [most * 2 ** (0.4 * warmth), most, most * 2 ** (-0.4 * warmth)]);
    this.emit("retex-draw", { milliseconds: performance.now() - begin });
  }

  update() {
    this.refresh();
    this.draw(false);
    this.emit("retex-change", this.getState());
  }

  emit(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true, composed: true }));
  }

  say(text) {
    this.$("[role=status]").textContent = text;
  }

  fail(message) {
    const box = this.$(".message");
    box.hidden = !message;
    box.textContent = message || "";
    if (message) this.$(".bar").hidden = true, this.emit("retex-error", { message });
  }

  indexOf(name) {
    const index = this.targets.indexOf(name);
    if (index < 0) throw new Error(`The room has no '${name}'.`);
    return index;
  }

  // ---- controls ----

  /* Pictures and colours that are offered: attribute `textures`, URLs separated by blanks. */
  get offers() {
    const given = (this.getAttribute("textures") || "").split(/\s+/).filter(Boolean);
    return [...given, "#e9e4da", "#b9a48c", "#7d5f48", "#8b9a86", "#44525c", "#2b2b2b"];
  }

  refresh() {
    const { room } = this, texture = this.textures[this.selected];
    if (!room) return;
    const row = this.$(".targets"), offers = this.$(".swatches");
    if (row.children.length !== room.targets.length)
      row.replaceChildren(...room.targets.map((t) => {
        const button = document.createElement("button");
        button.textContent = t.name;
        button.onclick = () => this.select(t.name);
        return button;
      }));
    [...row.children].forEach((button, i) => {
      button.setAttribute("aria-pressed", i === this.selected);
      button.disabled = !this.renderer?.canEdit(i);
    });
    if (!offers.children.length)
      offers.replaceChildren(...this.offers.map((source) => {
        const button = document.createElement("button"), color = parseColor(source);
        button.className = "swatch";
        button.style.background = color ? source : `url("${new URL(source, document.baseURI).href.replace(/"/g, "%22")}")`;
        button.dataset.source = source;
        button.title = color ? source : nameOf(source);
        button.setAttribute("aria-label", color ? `Colour ${source}` : nameOf(source));
        button.onclick = () => this.try(() => this.setTexture(this.targets[this.selected], source));
        return button;
      }));
    const off = !this.renderer?.canEdit(this.selected);
    for (const button of offers.children) button.disabled = off, button.setAttribute("aria-pressed", button.dataset.source === texture.source);
    this.$("[data-set=exposure]").disabled = this.$("[data-set=warmth]").disabled = !this.renderer;
    this.$("[data-set=file]").disabled = this.$("[data-set=color]").disabled = this.$("[data-do=original]").disabled = off;
    this.$(".placing").hidden = !texture.image;
    const mean = Array.isArray(texture.scale) ? texture.scale[0] : texture.scale;
    const show = (key, value, text) => {
      const input = this.$(`[data-set=${key}]`), output = input.parentElement.querySelector("output");
      if (this.shadowRoot.activeElement !== input || input.type !== "range") input.value = value;
      if (output) output.textContent = text;
      if (text) input.setAttribute("aria-valuetext", text);
    };
    show("size", -Math.log2(mean), `${(1 / mean).toFixed(2)}×`);
    show("rotate", texture.rotate, `${Math.round(texture.rotate)}°`);
    show("right", texture.offset[0], texture.offset[0].toFixed(2));
    show("up", texture.offset[1], texture.offset[1].toFixed(2));
    show("tint", texture.tint, "");
    show("exposure", this.light.exposure, (this.light.exposure > 0 ? "+" : "") + this.light.exposure.toFixed(2));
    show("warmth", this.light.warmth, (this.light.warmth > 0 ? "+" : "") + this.light.warmth.toFixed(2));
    this.$("canvas").setAttribute("aria-label", `The room. ${this.targets.map((n, i) => `${n}: ${this.textures[i].label}`).join(", ")}.`);
  }

  async try(action) {
    try {
      this.fail(null);
      await action();
    } catch (error) {
      this.fail(error.message);
    }
  }

  setControl(input) {
    const name = this.targets[this.selected], texture = this.textures[this.selected], value = Number(input.value);
    if (!texture) return;
    switch (input.dataset.set) {
      case "file": {
        const [file] = input.files;
        input.value = "";
        if (file) this.try(() => this.setTexture(name, file));
        break;
      }
      case "color": return this.try(() => this.setTexture(name, input.value));
      case "size": {
        const times = 2 ** -value, old = texture.scale;
        return this.place(name, { scale: Array.isArray(old) ? [times, old[1] / old[0] * times] : times });
      }
      case "rotate": return this.place(name, { rotate: value });
      case "right": return this.place(name, { offset: [value, texture.offset[1]] });
      case "up": return this.place(name, { offset: [texture.offset[0], value] });
      case "tint": return this.place(name, { tint: input.value });
      default: return this.setLight({ [input.dataset.set]: value });
    }
  }

  async command(name) {
    switch (name) {
      case "compare":
        this.comparing = !this.comparing;
        this.$("[data-do=compare]").setAttribute("aria-pressed", this.comparing);
        this.$(".split").hidden = this.$(".line").hidden = !this.comparing;
        if (this.comparing) this.$(".split").focus();
        this.moveLine();
        return this.draw(false);
      case "in": return this.zoomBy(1.5);
      case "out": return this.zoomBy(1 / 1.5);
      case "full": return document.fullscreenElement ? document.exitFullscreen() : this.requestFullscreen();
      case "original": return this.setTexture(this.targets[this.selected], null);
      case "link": {
        const local = this.textures.some((t) => t.local);
        history.replaceState(null, "", this.link);
        try {
          await navigator.clipboard.writeText(this.link);
        } catch { /* the address bar has it */ }
        return this.note(local ? "Link copied. Your own pictures are not in it." : "Link copied.");
      }
      case "download": {
        const a = document.createElement("a"), comparing = this.comparing;
        this.comparing = false;
        a.href = URL.createObjectURL(await this.toBlob());
        this.comparing = comparing;
        this.draw(false);
        a.download = "room.png";
        a.click();
        return setTimeout(() => URL.revokeObjectURL(a.href), 1000);
      }
    }
  }

  /* Show a few words for a moment. */
  note(text) {
    const label = this.$(".name");
    label.textContent = text;
    label.hidden = false;
    clearTimeout(this.noting);
    this.noting = setTimeout(() => (label.hidden = true), 2500);
    this.say(text);
  }

  moveLine() {
    const { left, top, width, height } = this.$("canvas").getBoundingClientRect(), stage = this.$(".stage").getBoundingClientRect();
    const split = this.$(".split");
    const bottom = Math.min(top + height, stage.bottom) - stage.top;
    Object.assign(split.style, { left: `${left - stage.left - 22}px`, width: `${width + 44}px`, top: `${bottom - 52}px` });
    const x = left - stage.left + (width * split.value) / 100;
    Object.assign(this.$(".line").style, { left: `${x}px`, top: `${top - stage.top}px`, height: `${height}px` });
  }

  zoomBy(times, x, y) {
    const stage = this.$(".stage").getBoundingClientRect(), z = this.zoom, next = clamp(z.times * times, 1, 12);
    const view = this.$(".view"), left = view.offsetLeft, top = view.offsetTop;
    const px = (x ?? stage.left + stage.width / 2) - stage.left - left, py = (y ?? stage.top + stage.height / 2) - stage.top - top;
    this.panTo(px - ((px - z.x) * next) / z.times, py - ((py - z.y) * next) / z.times, next);
  }

  panTo(x, y, times = this.zoom.times) {
    const view = this.$(".view"), width = view.offsetWidth, height = view.offsetHeight;
    this.zoom = { times, x: clamp(x, width - width * times, 0), y: clamp(y, height - height * times, 0) };
    view.style.transform = times > 1 ? `translate(${this.zoom.x}px, ${this.zoom.y}px) scale(${times})` : "";
    this.$(".stage").classList.toggle("zoomed", times > 1);
    this.moveLine();
  }

  /* The target that is seen at a place of the window, or -1. */
  targetAt(x, y) {
    const box = this.$("canvas").getBoundingClientRect(), room = this.room;
    if (!room || !this.renderer) return -1;
    const px = Math.floor(((x - box.left) / box.width) * room.width), py = Math.floor(((y - box.top) / box.height) * room.height);
    if (px < 0 || py < 0 || px >= room.width || py >= room.height) return -1;
    const seen = this.renderer.full.filter((c) => c.heads && c.heads[py * room.width + px] & 31);
    return seen.length ? seen.reduce((a, b) => (room.targets[a.target].share < room.targets[b.target].share ? a : b)).target : -1;
  }

  listen(root) {
    const stage = this.$(".stage"), canvas = this.$("canvas"), pointers = new Map();
    let moved = 0, pinch = 0;
    root.addEventListener("input", ({ target }) => {
      if (target.classList.contains("split")) this.moveLine(), this.draw(false);
      else if (target.dataset.set) this.setControl(target);
    });
    root.addEventListener("click", ({ target }) => {
      const button = target.closest("[data-do]");
      if (button) this.try(() => this.command(button.dataset.do));
    });
    const isPicture = (event) => !event.target.closest("button, input");
    stage.addEventListener("pointerdown", (event) => {
      if (!isPicture(event)) return;
      pointers.set(event.pointerId, event);
      moved = pointers.size > 1 ? 99 : 0;
      pinch = 0;
    });
    stage.addEventListener("pointermove", (event) => {
      const last = pointers.get(event.pointerId);
      if (!last) {
        if (event.pointerType === "mouse" && isPicture(event)) this.hover(event);
        return;
      }
      const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
      moved += Math.abs(dx) + Math.abs(dy);
      pointers.set(event.pointerId, event);
      if (pointers.size === 2) {
        const [a, b] = pointers.values(), far = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (pinch) this.zoomBy(far / pinch, (a.clientX + b.clientX) / 2, (a.clientY + b.clientY) / 2);
        pinch = far;
      } else if (moved > 6 && this.zoom.times > 1) {
        if (!stage.hasPointerCapture(event.pointerId)) stage.setPointerCapture(event.pointerId);
        this.panTo(this.zoom.x + dx, this.zoom.y + dy);
      }
    });
    const end = (event) => {
      if (!pointers.delete(event.pointerId) || event.type !== "pointerup" || moved > 6) return;
      const target = this.targetAt(event.clientX, event.clientY);
      if (target < 0 || !this.renderer.canEdit(target)) return;
      this.select(this.targets[target]);
      this.note(this.targets[target]);
    };
    stage.addEventListener("pointerup", end);
    stage.addEventListener("pointercancel", end);
    stage.addEventListener("pointerleave", () => (this.$(".name").hidden = true));
    stage.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && this.zoom.times === 1 && event.deltaY > 0) return; // the page scrolls
      event.preventDefault();
      this.zoomBy(2 ** (-event.deltaY / 300), event.clientX, event.clientY);
    }, { passive: false });
    stage.addEventListener("dblclick", (event) => isPicture(event) && (this.zoom.times > 1 ? this.panTo(0, 0, 1) : this.zoomBy(2.5, event.clientX, event.clientY)));
    stage.addEventListener("keydown", (event) => {
      if (event.target !== stage) return;
      const step = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] }[event.key];
      if (step) this.panTo(this.zoom.x + step[0], this.zoom.y + step[1]);
      else if (event.key === "+" || event.key === "=") this.zoomBy(1.5);
      else if (event.key === "-") this.zoomBy(1 / 1.5);
      else if (event.key === "0") this.panTo(0, 0, 1);
      else return;
      event.preventDefault();
    });
    stage.addEventListener("dragover", (event) => {
      event.preventDefault();
      stage.classList.add("drop");
      this.hover(event);
    });
    stage.addEventListener("dragleave", () => stage.classList.remove("drop"));
    stage.addEventListener("drop", (event) => {
      event.preventDefault();
      stage.classList.remove("drop");
      const [file] = event.dataTransfer.files, target = this.targetAt(event.clientX, event.clientY);
      if (target >= 0 && this.renderer?.canEdit(target)) this.select(this.targets[target]);
      if (file) this.try(() => this.setTexture(this.targets[this.selected], file));
    });
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.renderer = null;
      canvas.classList.remove("shown");
      this.fail("The graphics card was needed elsewhere. Please reload the page.");
    });
    new ResizeObserver(() => this.panTo(this.zoom.x, this.zoom.y)).observe(stage);
  }

  hover(event) {
    const target = this.targetAt(event.clientX, event.clientY), label = this.$(".name");
    label.hidden = target < 0;
    if (target >= 0) label.textContent = this.targets[target];
    clearTimeout(this.noting);
  }
}

/* A large picture in a canvas whose longer side has so many pixels. */
function smaller(image, most) {
  const times = most / Math.max(image.naturalWidth, image.naturalHeight), canvas = document.createElement("canvas");
  canvas.width = Math.max(1, Math.round(image.naturalWidth * times));
  canvas.height = Math.max(1, Math.round(image.naturalHeight * times));
  const context = canvas.getContext("2d");
  context.imageSmoothingQuality = "high";
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas;
}

if (!customElements.get("retex-room")) customElements.define("retex-room", RetexRoom);
export { RetexRoom };
