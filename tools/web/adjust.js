// ---- adjustments of a texture's colours, before anything is filtered ----

import { ADJUSTMENTS, WRAPS } from "./edit.js";
import { HEAD } from "./glsl.js";
import { parseColor } from "./values.js";

const ADJUSTS = Object.keys(ADJUSTMENTS);

/* What the shader gets of an adjustment: its number, and three numbers. */
export function adjustNumbers([word, value]) {
  const numbers = word === "invert" ? [1] : typeof value === "string" ? parseColor(value) : [value].flat();
  return { kind: ADJUSTS.indexOf(word), value: [0, 1, 2].map((k) => numbers[k] ?? 0) };
}

/* Adjustments of single colours, one after the other; texels are multiplied by what they cover. mean: sums of the whole, for
 * `colorize`. The hue is turned in Oklab: B. Ottosson, 'A perceptual color space for image processing' (2020). */
export const ADJUST = `${HEAD}
uniform sampler2D image, mean;
uniform int count;
uniform int kinds[${ADJUSTS.length}];
uniform vec3 values[${ADJUSTS.length}];
out vec4 result;
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
vec3 turnHue(vec3 c, float degrees) {
  vec3 lms = vec3(dot(c, vec3(0.4122214708, 0.5363325363, 0.0514459929)), dot(c, vec3(0.2119034982, 0.6806995451, 0.1073969566)),
    dot(c, vec3(0.0883024619, 0.2817188376, 0.6299787005)));
  vec3 r = sign(lms) * pow(abs(lms), vec3(1.0 / 3.0));
  float l = dot(r, vec3(0.2104542553, 0.7936177850, -0.0040720468)), a = dot(r, vec3(1.9779984951, -2.4285922050, 0.4505937099));
  float b = dot(r, vec3(0.0259040371, 0.7827717662, -0.8086757660)), turn = degrees * 0.017453292519943295;
  vec3 lab = vec3(l, cos(turn) * a - sin(turn) * b, sin(turn) * a + cos(turn) * b);
  r = vec3(dot(lab, vec3(1.0, 0.3963377774, 0.2158037573)), dot(lab, vec3(1.0, -0.1055613458, -0.0638541728)),
    dot(lab, vec3(1.0, -0.0894841775, -1.2914855480)));
  r = r * r * r;
  return vec3(dot(r, vec3(4.0767416621, -3.3077115913, 0.2309699292)), dot(r, vec3(-1.2684380046, 2.6097574011, -0.3413193965)),
    dot(r, vec3(-0.0041960863, -0.7034186147, 1.7076147010)));
}
vec3 adjusted(vec3 c, int kind, vec3 value) {
  if (kind == ${ADJUSTS.indexOf("hue")}) return turnHue(c, value.x);
  if (kind == ${ADJUSTS.indexOf("saturation")}) return luminance(c) + value.x * (c - luminance(c));
  if (kind == ${ADJUSTS.indexOf("gamma")}) return pow(max(c, 0.0), vec3(1.0 / value.x));
  if (kind == ${ADJUSTS.indexOf("contrast")}) return 0.18 * pow(max(c, 0.0) / 0.18, vec3(value.x));
  if (kind == ${ADJUSTS.indexOf("invert")}) return linear(1.0 - encoded(clamp(c, 0.0, 1.0)));
  if (kind != ${ADJUSTS.indexOf("colorize")}) return c * value;
  vec4 all = texelFetch(mean, ivec2(0, 0), 0);
  float grey = all.a > 0.0 ? luminance(all.rgb) / all.a : 0.0;
  return value * (grey > 1e-6 ? luminance(c) / grey : 1.0);
}
void main() {
  vec4 texel = texelFetch(image, ivec2(gl_FragCoord.xy), 0);
  vec3 c = texel.a > 0.0 ? texel.rgb / texel.a : vec3(0.0);
  for (int i = 0; i < count; i++) c = adjusted(c, kinds[i], values[i]);
  result = vec4(clamp(c, 0.0, 1.0) * texel.a, texel.a);
}`;

/* Sums of squares of texels, and of such sums: their proportions are those of the whole. */
export const SUM_SIDE = 16;
export const SUM = `${HEAD}
uniform sampler2D image;
out vec4 result;
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * ${SUM_SIDE}, end = min(first + ${SUM_SIDE}, textureSize(image, 0));
  vec4 sum = vec4(0.0);
  for (int y = first.y; y < end.y; y++)
    for (int x = first.x; x < end.x; x++) sum += texelFetch(image, ivec2(x, y), 0);
  result = sum / ${SUM_SIDE * SUM_SIDE}.0;
}`;

/* A Gaussian along rows, or columns, of texels, with what lies beyond the image; `stride` texels for each that is made. */
export const BLUR = `${HEAD}
uniform sampler2D image;
uniform bool down;
uniform int wrap;
uniform float sigma, stride;
out vec4 result;
int wrapped(int i, int size) {
  if (i >= 0 && i < size) return i;
  if (wrap == ${WRAPS.indexOf("black")}) return -1;
  if (wrap == ${WRAPS.indexOf("clamp")}) return i < 0 ? 0 : size - 1;
  int period = wrap == ${WRAPS.indexOf("mirror")} ? 2 * size : size, at = i - period * int(floor(float(i) / float(period)));
  return at < size ? at : 2 * size - 1 - at;
}
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), size = textureSize(image, 0);
  float middle = (down ? gl_FragCoord.y : gl_FragCoord.x) * stride, total = 0.0;
  vec4 sum = vec4(0.0);
  int end = int(ceil(middle + 4.0 * sigma));
  for (int i = int(floor(middle - 4.0 * sigma)); i < end; i++) {
    float far = (float(i) + 0.5 - middle) / sigma, weight = exp(-0.5 * far * far);
    int at = wrapped(i, down ? size.y : size.x);
    if (at >= 0) sum += weight * texelFetch(image, down ? ivec2(p.x, at) : ivec2(at, p.y), 0);
    total += weight;
  }
  result = sum / total;
}`;

/* How a blurred line of texels is made: of wide Gaussians fewer texels, which then are enlarged linearly, and that widens
 * them a little. */
export function blurSizes(sigma, texels) {
  const made = Math.ceil(texels / Math.max(1, sigma / 4)), stride = texels / made;
  return { made, stride, sigma: Math.sqrt(sigma * sigma - (made < texels ? stride * stride / 6 : 0)) };
}
