// ---- the shaders of the picture ----

import { SHOWN } from "./develop.js";
import { FILTER, HEAD, OVERS, SHARE, classCode, imageUniforms, lightCode, number, valueCode, withTargets } from "./glsl.js";
import { firstHitOf } from "./maps.js";

/* An image of the atlas at pixel p of the size that is `finest` times smaller than the picture. */
function tileCode(room, index, finest) {
  const t = room.reduced.tiles[index];
  const read = (at) => valueCode(`texelFetch(reduced, ivec2(${t.x}, ${t.y}) + ${at}, 0)`, t);
  if (t.scale === finest) return read(`min(p, ivec2(${t.width - 1}, ${t.height - 1}))`);
  return `bilinear${index}(p)`;
}

function tileFunction(room, index, finest) {
  const t = room.reduced.tiles[index];
  if (t.scale === finest) return "";
  const read = (x, y) => valueCode(`texelFetch(reduced, ivec2(${t.x}, ${t.y}) + ivec2(${x}, ${y}), 0)`, t);
  return `vec3 bilinear${index}(ivec2 p) {
    vec2 at = clamp((vec2(p) + 0.5) / ${number(t.scale / finest)} - 0.5, vec2(0.0), vec2(${t.width - 1}, ${t.height - 1}));
    ivec2 a = ivec2(at), b = min(a + 1, ivec2(${t.width - 1}, ${t.height - 1}));
    vec2 f = fract(at);
    return mix(mix(${read("a.x", "a.y")}, ${read("b.x", "a.y")}, f.x), mix(${read("a.x", "b.y")}, ${read("b.x", "b.y")}, f.x), f.y);
  }`;
}

/* First step: mixtures that are smaller than the picture, one layer each. Those of quantity `further` are S(a) by S of
 * the original, with S(a) = 1 + q a + ... + (q a)^n: light that meets the texture more often than terms have hits. */
export function mixtureShader(room, hasOvers) {
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
export function factorShader(room) {
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

/* The second step where lamps have new colours: for each group that of all light, which is in `all` if group is not -1, plus the sum over its terms of single lamps. There are many, so
 * the shader reads what they are: rows of a texture, with the box of the gain in the atlas; its scale, levels, lamp and number of mixtures; its white; and
 * the layer, size and scale of each mixture. */
export const lampShader = (room) => `${HEAD}
uniform sampler2DArray mixtures, all;
uniform sampler2D tiles, terms;
uniform int first, end, group;
uniform vec2 allSize;
uniform float times;
uniform vec3 colors[${room.parameters.length}];
out vec4 result;
vec3 share(vec4 box, vec4 how, vec3 white) {
  vec2 at = clamp(gl_FragCoord.xy / how.x - 0.5, vec2(0.0), box.zw - 1.0);
  ivec2 a = ivec2(at), b = min(a + 1, ivec2(box.zw) - 1), o = ivec2(box.xy);
  vec2 f = fract(at);
  return mix(
    mix(light(texelFetch(tiles, o + a, 0).rgb, white, how.y), light(texelFetch(tiles, o + ivec2(b.x, a.y), 0).rgb, white, how.y), f.x),
    mix(light(texelFetch(tiles, o + ivec2(a.x, b.y), 0).rgb, white, how.y), light(texelFetch(tiles, o + b, 0).rgb, white, how.y), f.x), f.y);
}
void main() {
  vec3 sum = vec3(0.0);
  if (group >= 0) sum = texture(all, vec3(clamp(gl_FragCoord.xy / times, vec2(0.5), allSize - 0.5) / vec2(textureSize(all, 0).xy), group)).rgb;
  for (int i = first; i < end; i++) {
    vec4 box = texelFetch(terms, ivec2(0, i), 0), how = texelFetch(terms, ivec2(1, i), 0);
    vec3 product = colors[int(how.z)];
    if (box.z > 0.0) product *= share(box, how, texelFetch(terms, ivec2(2, i), 0).rgb);
    for (int k = 0; k < int(how.w); k++) {
      vec4 m = texelFetch(terms, ivec2(3 + k, i), 0);
      vec2 at = clamp(gl_FragCoord.xy / m.w, vec2(0.5), m.yz - 0.5);
      product *= texture(mixtures, vec3(at / vec2(textureSize(mixtures, 0).xy), m.x)).rgb;
    }
    sum += product;
  }
  result = vec4(min(sum, 65504.0), 1.0);
}`;

const MAPPED = `
uniform sampler2DArray gates;
uniform bool more;
uniform int finish[TARGETS];
${SHARE}`;

/* Last step: the picture, with the original textures left of `split`. While not everything is loaded it is the still plus
 * what new textures change; `below` has the still. hasMaps: the picture is a sum of several: `more`, that of those before is in
 * `below`. The last is developed, unless it is measured. Light of a finish is multiplied by its gate, but for that whose first hit is on the target. */
export function pictureShader(room, hasMaps, hasOvers) {
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
