// ---- how the picture is developed, as in retex-edit(5) ----

import { HEAD, number } from "./glsl.js";
import { kelvinColor } from "./lamps.js";
import { clamp } from "./values.js";

/* From linear Rec.709 to Bradford's responses of cones, and back. */
const TO_CONES = [[0.4227253, 0.4913453, 0.0273579], [0.0556998, 0.9615341, 0.0231838], [0.0213826, 0.0876419, 0.9805081]];
const FROM_CONES = [[2.5380445, -1.293277, -0.0402369], [-0.1460041, 1.1166483, -0.022329], [-0.0422985, -0.0716072, 1.0227527]];
const dotOf = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);

/* What light makes of linear colours, without the view: nine numbers, by rows. The colour of whiteBalance becomes white; warmth
 * multiplies red and blue. stops: of the automatic exposure, beside those of the light. */
export function developMatrix({ exposure, warmth, whiteBalance }, stops = 0) {
  const gain = 2 ** clamp(exposure + stops, -30, 30), lit = whiteBalance && kelvinColor(whiteBalance);
  const scales = lit && TO_CONES.map((row) => dotOf(row, [1, 1, 1]) / dotOf(row, lit));
  return [1, 0, -1].flatMap((side, i) => [0, 1, 2].map((j) =>
    gain * 2 ** (0.4 * warmth * side) * (lit ? dotOf(FROM_CONES[i], TO_CONES.map((row, k) => scales[k] * row[j])) : i === j ? 1 : 0)));
}

/* From linear colours to those of the display, by the number of the view. Filmic: Narkowicz's fit of the Academy's curve, with
 * a grey of 0.18 as it is. Neutral: the Khronos PBR Neutral Tone Mapper. */
export const SHOWN = `
uniform vec3 develop[3];
uniform int view;
vec3 shown(vec3 color) {
  vec3 x = max(vec3(dot(develop[0], color), dot(develop[1], color), dot(develop[2], color)), 0.0);
  if (view == 1) {
    x = 0.7231708 * min(x, 10.1);
    x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  }
  if (view == 2) {
    float least = min(x.r, min(x.g, x.b));
    x -= least < 0.08 ? least - least * least / 0.16 : 0.04;
    float peak = max(x.r, max(x.g, x.b));
    if (peak > 0.76) {
      float y = 1.0 - 0.0576 / (peak - 0.52), kept = 1.0 / (0.15 * (peak - y) + 1.0);
      x = x * (y / peak * kept) + y * (1.0 - kept);
    }
  }
  x = min(x, 1.0);
  return view == 3 ? x : encoded(x);
}
`;

/* Of each block of the picture: the sum of the binary logarithms of luminances that are not 0, and how many they are, both by
 * the pixels of a block. */
export const METER_BLOCK = 16;
export const METER = `${HEAD}
uniform sampler2D picture;
out vec4 result;
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * ${METER_BLOCK}, end = min(first + ${METER_BLOCK}, textureSize(picture, 0));
  vec2 sum = vec2(0.0);
  for (int y = first.y; y < end.y; y++)
    for (int x = first.x; x < end.x; x++) {
      float luminance = dot(texelFetch(picture, ivec2(x, y), 0).rgb, vec3(0.2126, 0.7152, 0.0722));
      if (luminance > 0.0) sum += vec2(log2(luminance), 1.0);
    }
  result = vec4(sum / ${number(METER_BLOCK ** 2)}, 0.0, 1.0);
}`;
