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
vec3 encoded(vec3 y) { return mix(12.92 * y, 1.055 * pow(max(y, 0.0031308), vec3(1.0 / 2.4)) - 0.055, greaterThan(y, vec3(0.0031308))); }
vec3 light(vec3 code, float white, float levels) {
  vec3 y = code * (255.0 / levels);
  return white * mix(linear(y), exp((max(y, 1.0) - 1.0) * (255.0 / 48.0)), greaterThan(y, vec3(1.0)));
}
`;

const PREMULTIPLY = `${HEAD}
uniform sampler2D straight;
out vec4 result;
void main() {
  result = texelFetch(straight, ivec2(gl_FragCoord.xy), 0);
  result.rgb *= result.a;
}`;

/* The next level: means of what its texels take, two of an even size and a little more of an odd one. */
const HALVE = `${HEAD}
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

const FILTER = `
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
const OVERS = `
uniform sampler2DArray overs;
uniform mat2 overTurn[OVERS];
uniform vec2 overOffset[OVERS];
uniform int overEnd[TARGETS];
${LOOK_UPS.replace(/\b(look|filtered|evenly)\(/g, "$1Over(").replace(/sampler2D image/g, "sampler2DArray image,float layer").replace(/Over\(image/g, "Over(image,layer")
  .replace(/vec2\((place\.x, ?1\.0 ?- ?place\.y)\)/, "vec3($1,layer)")}
`;

const number = (x) => (/[.e]/.test(String(x)) ? String(x) : `${x}.0`);

/* Adds the colours of class c's records in pixel p to sum and total, weighted by w. */
function classCode(room, c, albedo, add, hasOvers) {
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

const lightCode = (room, l) => `light(texelFetch(lights, ivec3(p, ${l}), 0).rgb, ${number(room.lights[l].white)}, ${number(room.lights[l].levels)})`;

const imageUniforms = (room) => room.targets.map((_, t) => `uniform sampler2D image${t};`).join("\n");

const OVERS_MOST = 4; // on a target
const withTargets = (room, text) => text.replace(/TARGETS/g, room.targets.length).replace(/OVERS/g, OVERS_MOST * room.targets.length);

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

/* First step: mixtures that are smaller than the picture, one layer each. Those of quantity `further` are S(a) by S of
 * the original, with S(a) = 1 + q a + ... + (q a)^n: light that meets the texture more often than terms have hits. */
function mixtureShader(room, hasOvers) {
  const { hits = 0, ratio = [0, 0, 0] } = room.further ?? {};
  const cases = room.mixtures.map((m, index) => {
    if (room.classes[m[0][0]].scale === 1) return "";
    const code = m.map(([c, slot]) => classCode(room, c, tileCode(room, room.classes[c].albedo, room.classes[c].scale),
      `sum += w[${slot}] * color; before += w[${slot}] * own; total += w[${slot}];`, hasOvers));
    if (room.further?.mixtures.includes(index)) code.push("sum = min(total * series(sum / total) / series(before / total), 65504.0);");
    return `if (mixture == ${index}) { ${code.join("\n")} }`;
  });
  return HEAD + withTargets(room, FILTER + (hasOvers ? OVERS : "")) + imageUniforms(room) + `
uniform usampler2DArray heads;
uniform sampler2D reduced;
uniform int mixture;
uniform bool original;
out vec4 result;
vec3 series(vec3 a) {
  vec3 s = vec3(1.0);
  for (int k = 0; k < ${hits}; k++) s = s * a * vec3(${ratio.map(number)}) + 1.0;
  return s;
}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0), before = vec3(0.0);
  float total = 0.0;
  ${cases.join("\n")}
  result = vec4(total > 0.0 ? sum / total : vec3(0.0), 1.0);
}`;
}

/* Second step: for each group its parameters times the sum over its terms of gain times mixtures, at the finest of the smaller sizes. */
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
uniform vec3 color;
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
  result = vec4(min(sum * color, 65504.0), 1.0);
}`;
}

/* The second step where lamps have new colours: for each group the sum over its terms of single lamps. There are many, so
 * the shader reads what they are: rows of a texture, with the box of the gain in the atlas; its scale, curve and lamp; and
 * the layer, size and scale of each mixture. */
const lampShader = (room) => `${HEAD}
uniform sampler2DArray mixtures;
uniform sampler2D tiles, terms;
uniform int first, end;
uniform vec3 colors[${room.parameters.length}];
out vec4 result;
vec3 share(vec4 box, vec4 how) {
  vec2 at = clamp(gl_FragCoord.xy / how.x - 0.5, vec2(0.0), box.zw - 1.0);
  ivec2 a = ivec2(at), b = min(a + 1, ivec2(box.zw) - 1), o = ivec2(box.xy);
  vec2 f = fract(at);
  return mix(
    mix(light(texelFetch(tiles, o + a, 0).rgb, how.y, how.z), light(texelFetch(tiles, o + ivec2(b.x, a.y), 0).rgb, how.y, how.z), f.x),
    mix(light(texelFetch(tiles, o + ivec2(a.x, b.y), 0).rgb, how.y, how.z), light(texelFetch(tiles, o + b, 0).rgb, how.y, how.z), f.x), f.y);
}
void main() {
  vec3 sum = vec3(0.0);
  for (int i = first; i < end; i++) {
    vec4 box = texelFetch(terms, ivec2(0, i), 0), how = texelFetch(terms, ivec2(1, i), 0);
    int count = int(texelFetch(terms, ivec2(2, i), 0).x);
    vec3 product = colors[int(how.w)];
    if (box.z > 0.0) product *= share(box, how);
    for (int k = 0; k < count; k++) {
      vec4 m = texelFetch(terms, ivec2(3 + k, i), 0);
      vec2 at = clamp(gl_FragCoord.xy / m.w, vec2(0.5), m.yz - 0.5);
      product *= texture(mixtures, vec3(at / vec2(textureSize(mixtures, 0).xy), m.x)).rgb;
    }
    sum += product;
  }
  result = vec4(min(sum, 65504.0), 1.0);
}`;

/* The weight of a finish, of the first or by those of the others. */
const SHARE = `
float share(vec3 w, int finish) {
  return finish == 1 ? max(1.0 - w.r - w.g - w.b, 0.0) : finish == 2 ? w.r : finish == 3 ? w.g : w.b;
}
`;

const MAPPED = `
uniform sampler2DArray gates;
uniform bool more;
uniform int finish[TARGETS];
${SHARE}`;

/* Last step: the picture, with the original textures left of `split`. While not everything is loaded it is the still plus
 * what new textures change; `below` has the still. hasMaps: the picture is a sum of several: `more`, that of those before is in
 * `below`. The last is developed, unless it is measured. Light of a finish is multiplied by its gate, but for that whose first hit is on the target. */
function pictureShader(room, hasMaps, hasOvers) {
  const full = room.mixtures.map((m, i) => [m, i]).filter(([m]) => room.classes[m[0][0]].scale === 1);
  const byClass = new Map();
  for (const [m, i] of full) for (const [c, slot] of m) byClass.set(c, [...(byClass.get(c) || []), [i, slot]]);
  const mixtures = [...byClass].map(([c, list]) => `
  if (loaded[${c}]) ${classCode(room, c, lightCode(room, room.classes[c].albedo),
    list.map(([i, slot]) => `sum${i} += w[${slot}] * color; total${i} += w[${slot}]; own${i} += w[${slot}] * own;`).join(" "), hasOvers)}`);
  const mappable = hasMaps ? room.targets.map((_, t) => t).filter((t) => room.targets[t].finishes) : [];
  const gatesOf = (own) => mappable.filter((t) => t !== own).map((t) => ` * gate${t}`).join("");
  const groups = room.groups.map((g, i) => {
    const factor = g.mixture < 0 ? "" : ` * mean(sum${g.mixture}, total${g.mixture})`;
    const before = g.mixture < 0 ? "" : ` * mean(own${g.mixture}, total${g.mixture})`;
    return `
  if (ready[${i}]) {
    vec3 d = ${lightCode(room, g.light)}${hasMaps ? gatesOf(firstHitOf(room, i)) : ""};
    if (original) color += d * factor(originals, originalGrid, ${i})${factor};
    else color += d * factor(factors, grid, ${i})${factor};
    if (partial) color -= d * factor(originals, originalGrid, ${i})${before};
  }`;
  });
  return HEAD + withTargets(room, FILTER + (hasOvers ? OVERS : "")) + imageUniforms(room) + `
uniform usampler2DArray heads;
uniform sampler2DArray lights, factors, originals;
uniform sampler2D below;
uniform bool loaded[${room.classes.length}];
uniform bool ready[${room.groups.length}];
uniform bool partial;
uniform float split;
${hasMaps ? withTargets(room, MAPPED) : ""}
uniform vec3 grid, originalGrid;
uniform bool last;
out vec4 result;
${SHOWN}
vec3 factor(sampler2DArray from, vec3 grid, int layer) {
  vec2 at = clamp((vec2(gl_FragCoord.x, ${number(room.height)} - gl_FragCoord.y)) / grid.z, vec2(0.5), grid.xy - 0.5);
  return texture(from, vec3(at / vec2(textureSize(from, 0).xy), layer)).rgb;
}
vec3 mean(vec3 sum, float total) { return total > 0.0 ? sum / total : vec3(0.0); }
void main() {
  ivec2 p = ivec2(int(gl_FragCoord.x), ${room.height - 1} - int(gl_FragCoord.y));
  bool original = gl_FragCoord.x < split;
  vec3 color = partial ? linear(texelFetch(below, p, 0).rgb) : vec3(0.0);
  ${hasMaps ? "if (more) color = texelFetch(below, ivec2(gl_FragCoord.xy), 0).rgb;" : ""}
  if (${hasMaps ? "more ? !original : " : ""}!partial || !original) {
    ${mappable.map((t, layer) => `float gate${t} = finish[${t}] > 0 ? share(texelFetch(gates, ivec3(p, ${layer}), 0).rgb, finish[${t}]) : 1.0;`).join("\n")}
    ${full.map(([, i]) => `vec3 sum${i} = vec3(0.0), own${i} = vec3(0.0); float total${i} = 0.0;`).join("\n")}
    ${mixtures.join("")}
    ${groups.join("")}
  }
  result = vec4(last ? shown(color) : min(color, 65504.0), 1.0);
}`;
}

