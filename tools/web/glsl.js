// ---- what shaders share ----

import { LOG_OFFSET, LOG_STEPS, RECORD_COLUMNS } from "./files.js";

export const VERTEX = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

export const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
precision highp usampler2D;
precision highp usampler2DArray;
vec3 linear(vec3 y) { return mix(y / 12.92, pow((max(y, 0.04045) + 0.055) / 1.055, vec3(2.4)), greaterThan(y, vec3(0.04045))); }
vec3 encoded(vec3 y) { return mix(12.92 * y, 1.055 * pow(max(y, 0.0031308), vec3(1.0 / 2.4)) - 0.055, greaterThan(y, vec3(0.0031308))); }
vec3 light(vec3 code, vec3 white, float levels) {
  vec3 y = code * (255.0 / levels);
  return white * mix(linear(y), exp((max(y, 1.0) - 1.0) * (255.0 / 48.0)), greaterThan(y, vec3(1.0)));
}
`;

export const PREMULTIPLY = `${HEAD}
uniform sampler2D straight;
out vec4 result;
void main() {
  result = texelFetch(straight, ivec2(gl_FragCoord.xy), 0);
  result.rgb *= result.a;
}`;

/* The next level: means of what its texels take, two of an even size and a little more of an odd one. */
export const HALVE = `${HEAD}
uniform sampler2D image;
out vec4 result;
void main() {
  ivec2 size = textureSize(image, 0);
  vec2 share = vec2(size) / vec2(max(size / 2, ivec2(1))), low = (gl_FragCoord.xy - 0.5) * share, high = low + share;
  ivec2 first = ivec2(low), end = min(ivec2(ceil(high)), size);
  vec4 sum = vec4(0.0);
  float total = 0.0;
  for (int y = first.y; y < end.y; y++)
    for (int x = first.x; x < end.x; x++) {
      vec2 part = max(min(high, vec2(x, y) + 1.0) - max(low, vec2(x, y)), 0.0);
      sum += part.x * part.y * texelFetch(image, ivec2(x, y), 0);
      total += part.x * part.y;
    }
  result = sum / total;
}`;

/* Texels are multiplied by what they cover; keeps: what they do not cover shows the original. ends: in u and v 1 if nothing lies beyond the image, -1 if its
 * border continues, so that the finest level has it.
 *
 * The mean of a texture over a footprint: over an evenly filled ellipse of two standard deviations (disc) or a bell.
 * Three rows across the shorter axis; along the longer axis as many samples as its length needs. Each sample is a
 * trilinear look-up with a part of the footprint's variance, the rows and samples have the rest.
 *
 * Over a parallelogram (evenly): cells along its two sides, each a look-up of the size of a cell. Cells are drawn together
 * where a look-up cannot be as small as they are. */
const LOOK_UPS = `
vec4 look(sampler2D image, vec2 size, vec2 place, float lod, vec2 ends) {
  vec2 beyond = clamp((abs(place - 0.5) - 0.5) * max(size * exp2(-lod), 1.0) + 0.5, 0.0, 1.0);
  vec2 inside = 1.0 - beyond * max(ends, 0.0);
  beyond *= max(-ends, 0.0);
  return textureLod(image, vec2(place.x, 1.0 - place.y), lod * (1.0 - max(beyond.x, beyond.y))) * (inside.x * inside.y);
}
vec4 filtered(sampler2D image, mat2 turned, vec2 moved, vec2 ends, vec4 bounds, uvec4 record, bool disc) {
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
      sum += w * look(image, size, place, lod, ends);
      total += w;
    }
  }
  return total > 0.0 ? sum / total : look(image, size, mean, lod, ends);
}
vec4 evenly(sampler2D image, mat2 turned, vec2 moved, vec2 ends, uvec4 record, mat2 axes) {
  vec2 size = vec2(textureSize(image, 0)), uv = vec2(uintBitsToFloat(record.x), uintBitsToFloat(record.y));
  mat2 sides = mat2(size.x, 0.0, 0.0, size.y) * turned * axes;
  vec2 longs = vec2(length(sides[0]), length(sides[1])), most = longs.x > longs.y ? vec2(32.0, 6.0) : vec2(6.0, 32.0);
  vec2 counts = clamp(ceil(longs / max(1.5, min(longs.x, longs.y) / 6.0)), vec2(1.0), most), cells = longs / counts;
  float cell = max(cells.x, cells.y), tap = max(cell * cell / 12.0, 1.0 / 6.0);
  float power = 4.0 * (tap + 1.0 / 12.0), low = floor(0.5 * log2(power));
  float lod = low + (power / exp2(2.0 * low) - 1.0) / 3.0;
  vec2 variance = longs * longs / 12.0, places = max(variance * (1.0 - 1.0 / (counts * counts)), vec2(1e-9));
  vec2 drawn = min(sqrt(max(variance - tap, vec2(0.0)) / places), vec2(1.0));
  vec4 sum = vec4(0.0);
  for (float j = 0.5; j < counts.y; j += 1.0)
    for (float i = 0.5; i < counts.x; i += 1.0)
      sum += look(image, size, turned * uv + moved + sides * ((vec2(i, j) / counts - 0.5) * drawn) / size, lod, ends);
  return sum / (counts.x * counts.y);
}
`;

export const FILTER = `
uniform usampler2D records;
uniform mat2 turn[TARGETS];
uniform vec2 offset[TARGETS];
uniform vec2 edge[TARGETS];
uniform bool edited[TARGETS];
uniform bool keeps[TARGETS];
${LOOK_UPS}
vec2 shares(uvec4 r) { return vec2(float((r.w >> 8) & 4095u), float(r.w >> 20)); }
uvec4 recordAt(int at) { return texelFetch(records, ivec2(at & ${RECORD_COLUMNS - 1}, at / ${RECORD_COLUMNS}), 0); }
mat2 axesAt(int at) { vec4 a = uintBitsToFloat(recordAt(at)); return mat2(a.x, a.y, a.z, a.w); }
`;

/* Layers, which lie on textures and are images of one size: the same look-ups, and what there is of them. overEnd:
 * after those of a target. */
export const OVERS = `
uniform sampler2DArray overs;
uniform mat2 overTurn[OVERS];
uniform vec2 overOffset[OVERS];
uniform int overEnd[TARGETS];
${LOOK_UPS.replace(/\b(look|filtered|evenly)\(/g, "$1Over(").replace(/sampler2D image/g, "sampler2DArray image,float layer").replace(/Over\(image/g, "Over(image,layer")
  .replace(/vec2\((place\.x, ?1\.0 ?- ?place\.y)\)/, "vec3($1,layer)")}
`;

export const number = (x) => (/[.e]/.test(String(x)) ? String(x) : `${x}.0`);

/* Adds the colours of class c's records in pixel p to sum and total, weighted by w. */
export function classCode(room, c, albedo, add, hasOvers) {
  const info = room.classes[c], t = info.target, target = room.targets[t];
  const axes = info.spreads === 4;
  const disc = info.kind === "sharp" && room.filter === "box";
  const bound = (value, k, far) => number(target.periodic[k] ? far : value[k]);
  const bounds = `vec4(${bound(target.uv_min, 0, -1e30)}, ${bound(target.uv_min, 1, -1e30)}, ` +
    `${bound(target.uv_max, 0, 1e30)}, ${bound(target.uv_max, 1, 1e30)})`;
  const look = (over, where) => (axes ? `evenly${over}(${where}, r, axesAt(first + i + 1))` : `filtered${over}(${where}, ${bounds}, r, ${disc})`);
  const layers = `for (int k = ${t ? `overEnd[${t - 1}]` : "0"}; k < overEnd[${t}]; k++) {
          vec4 over = ${look("Over", "overs, float(k), overTurn[k], overOffset[k], vec2(1.0)")};
          found = over + found * (1.0 - over.a);
        }`;
  return `{
    uint head = texelFetch(heads, ivec3(p, ${info.layer}), 0).r;
    int count = int(head & 31u), first = int(head >> 5);
    vec3 own = count > 0 ? ${albedo} : vec3(0.0);
    for (int i = 0; i < count; i += ${axes ? 2 : 1}) {
      uvec4 r = recordAt(first + i);
      vec2 w = shares(r);
      vec3 color = own;
      if (edited[${t}] && !original) {
        vec4 found = ${look("", `image${t}, turn[${t}], offset[${t}], edge[${t}]`)};
        ${hasOvers ? layers : ""}
        color = (keeps[${t}] ? own * (1.0 - found.a) : vec3(0.0)) + found.rgb;
      }
      ${add}
    }
  }`;
}

/* A curve's white by channel; where all have one it is a number. */
export const whites = ({ white }) => [white, white, white].flat().slice(0, 3);

export const valueCode = (texel, curve) => `light(${texel}.rgb, vec3(${whites(curve).map(number)}), ${number(curve.levels)})`;

export const lightCode = (room, l) => valueCode(`texelFetch(lights, ivec3(p, ${l}), 0)`, room.lights[l]);

export const imageUniforms = (room) => room.targets.map((_, t) => `uniform sampler2D image${t};`).join("\n");

export const OVERS_MOST = 4; // on a target
export const withTargets = (room, text) => text.replace(/TARGETS/g, room.targets.length).replace(/OVERS/g, OVERS_MOST * room.targets.length);

/* The weight of a finish, of the first or by those of the others. */
export const SHARE = `
float share(vec3 w, int finish) {
  return finish == 1 ? max(1.0 - w.r - w.g - w.b, 0.0) : finish == 2 ? w.r : finish == 3 ? w.g : w.b;
}
`;
