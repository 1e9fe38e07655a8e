// ---- maps: pictures that say which finish of a target is where ----

import { FILTER, HEAD, SHARE, classCode, imageUniforms, number, withTargets } from "./glsl.js";

/* Weights of the second finish and of later ones by texels of a map: rough: of roughness, in one channel; channel.w: 1 of
 * gloss. A roughness is between two finishes of the target, by their own. */
export const WEIGH = `${HEAD}
uniform sampler2D codes;
uniform bool grey, rough;
uniform int count;
uniform vec4 roughness, channel;
out vec4 result;
float scale(int k) { return k < count ? roughness[k] : -1.0; }
vec3 between(float r) {
  int below = -1, above = -1;
  for (int k = 0; k < 4; k++) {
    if (scale(k) >= 0.0 && scale(k) <= r && (below < 0 || scale(k) > scale(below))) below = k;
    if (scale(k) > r && (above < 0 || scale(k) < scale(above))) above = k;
  }
  float at = below < 0 ? 1.0 : above < 0 ? 0.0 : (r - scale(below)) / (scale(above) - scale(below));
  vec4 w = vec4(0.0);
  if (above >= 0) w[above] = at;
  if (below >= 0) w[below] = 1.0 - at;
  return w.yzw;
}
void main() {
  vec4 code = texelFetch(codes, ivec2(gl_FragCoord.xy), 0);
  vec3 w = code.rgb * code.a;
  vec3 chosen = w * channel.rgb;
  if (rough) w = between(abs(channel.w - (chosen.r + chosen.g + chosen.b)));
  else if (grey) w = max(1.0 - abs(vec3(w.r * float(count - 1)) - vec3(1.0, 2.0, 3.0)), 0.0);
  else w *= vec3(1.0, count > 2 ? 1.0 : 0.0, count > 3 ? 1.0 : 0.0);
  result = vec4(w / max(w.r + w.g + w.b, 1.0), 1.0);
}`;

/* Texels of the texture where it has one finish, multiplied before they are filtered; of finish 0 the weights. */
export const PRODUCT = `${HEAD}${SHARE}
uniform sampler2D image, weights;
uniform vec2 size;
uniform int finish;
out vec4 result;
void main() {
  vec2 place = gl_FragCoord.xy / size;
  vec4 color = textureLod(image, place, 0.0);
  vec3 w = textureLod(weights, place, 0.0).rgb;
  result = finish == 0 ? vec4(w * color.a, color.a) : vec4(color.rgb * share(w, finish), color.a);
}`;

/* Gates: the mean weights of finishes over a target's footprints in a pixel. What is seen sharply counts far more than what
 * scattered light met, and that more than later hits, which only decide where there is nothing else. */
const IMPORTANCE = { sharp: "1.0", broad: "1e-3", interreflection: "1e-6" };
const gateCode = (room, c) => classCode(room, c, `shown[${room.classes[c].target}]`, "sum += max(w.x, w.y) * color; total += max(w.x, w.y);");
const GATES = `
uniform usampler2DArray heads;
uniform int which;
uniform bool original;
uniform vec3 shown[TARGETS];
out vec4 result;
`;

/* The sums of one class that is smaller than the picture. */
export const smallGateShader = (room) => `${HEAD}${withTargets(room, FILTER)}${imageUniforms(room)}${withTargets(room, GATES)}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0);
  float total = 0.0;
  ${room.classes.map((info, c) => (info.scale > 1 && room.targets[info.target].finishes ? `if (which == ${info.layer}) ${gateCode(room, c)}` : "")).join("\n")}
  result = vec4(sum, total);
}`;

/* The gate of one target. */
export const gateShader = (room) => `${HEAD}${withTargets(room, FILTER)}${imageUniforms(room)}${withTargets(room, GATES)}
uniform sampler2DArray sums;
vec4 smaller(int layer, vec2 size, float times) {
  vec2 at = clamp(gl_FragCoord.xy / times, vec2(0.5), size - 0.5);
  return texture(sums, vec3(at / vec2(textureSize(sums, 0).xy), layer));
}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0.0), all = vec3(0.0), before = vec3(0.0);
  float total = 0.0, weight = 0.0;
  vec4 found = vec4(0.0);
  ${room.targets.map(({ finishes }, t) => (finishes ? `if (which == ${t}) {
    before = shown[${t}];
    ${room.classes.map((info, c) => {
      if (info.target !== t) return "";
      if (info.scale === 1) return `sum = vec3(0.0); total = 0.0; ${gateCode(room, c)} all += ${IMPORTANCE[info.kind]} * sum; weight += ${IMPORTANCE[info.kind]} * total;`;
      return `found = smaller(${info.layer}, vec2(${info.width}, ${info.height}), ${number(info.scale)}); all += ${IMPORTANCE[info.kind]} * found.rgb; weight += ${IMPORTANCE[info.kind]} * found.a;`;
    }).join("\n")}
  }` : "")).join("\n")}
  result = vec4(weight > 0.0 ? all / weight : before, 1.0);
}`;

/* The target on which a mixture is a path's first hit; -1: none, or several. */
export function firstHit(room, mixture) {
  const classes = mixture < 0 || room.further?.mixtures.includes(mixture) ? [] : room.mixtures[mixture].map(([c]) => room.classes[c]);
  return classes.length && classes.every((c) => c.target === classes[0].target && c.kind !== "interreflection") ? classes[0].target : -1;
}

/* The target of the first hit of a group's light. */
export function firstHitOf(room, group) {
  const { mixture } = room.groups[group], terms = room.lamps.terms.filter((t) => t.group === group);
  const hits = new Set(mixture >= 0 ? [firstHit(room, mixture)] : terms.map((t) => firstHit(room, t.factors[0] ?? -1)));
  return hits.size === 1 ? [...hits][0] : -1;
}

/* The choices of finishes of mapped targets for which a room keeps light apart: 0 = of light that met none. The picture is
 * the sum over them. */
export function passesOf(room, mapped) {
  const choices = [room.targets.map(() => 0), ...room.parameters.map((p) => p.finishes.map((f, t) => (mapped[t] ? f : 0)))];
  return [...new Map(choices.map((pass) => [String(pass), pass])).values()];
}

/* The colours of parameters in a pass. */
export const passColors = (room, mapped, pass, colors) =>
  room.parameters.map((p, i) => (p.finishes.every((f, t) => !mapped[t] || f === pass[t]) ? colors[i] : [0, 0, 0]));

/* The same while there are no passes: of the finishes that are chosen. */
export const chosenColors = (room, chosen, colors) =>
  room.parameters.map((p, i) => (p.finishes.every((f, t) => !f || f === chosen[t]) ? colors[i] : [0, 0, 0]));
