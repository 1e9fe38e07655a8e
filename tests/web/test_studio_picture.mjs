/* retex studio's preview: the camera, halves as pictures, planes of surfaces, what a render will take. */
import { fails, near, random, same, test } from "./tap.mjs";
import * as cam from "../../tools/studio/web/camera.js";
import { displayed, displayTable, halfValue } from "../../tools/studio/web/picture.js";
import { gridLine, isEdge, maskOf, readCoordinates, readSurfaces, SCOPES, surfaceAt, surfacesOf } from "../../tools/studio/web/planes.js";
import { bytesText, durationText, estimate, trialOf } from "../../tools/studio/web/estimate.js";

const camera = { eye: [1, 2, 3], at: [1, 2, 8], angle: 60 }; // along z
const far = ({ eye, at }) => Math.hypot(...at.map((x, i) => x - eye[i]));
const quarter = Math.PI / 2;

test("axes: right is x where one looks along z, as in POV-Ray, and -x in a mirrored scene", () => {
  near(Object.values(cam.axesOf(camera)).flat(), [0, 0, 1, 1, 0, 0, 0, 1, 0], 1e-12);
  near(Object.values(cam.axesOf(camera, -1)).flat(), [0, 0, 1, -1, 0, 0, 0, 1, 0], 1e-12);
  same([cam.sideOf({ ...camera, right: [1, 0, 0] }), cam.sideOf({ ...camera, right: [-1, 0, 0] }), cam.sideOf(camera)], [1, -1, 1]);
});

test("to look round moves what is looked at, to the right and up", () => {
  near(cam.lookedRound(camera, quarter, 0).at, [6, 2, 3], 1e-9);
  near(cam.lookedRound(camera, quarter, 0, -1).at, [-4, 2, 3], 1e-9);
  near(cam.lookedRound(camera, 0, Math.PI / 6).at, [1, 4.5, 3 + 5 * Math.cos(Math.PI / 6)], 1e-9);
  same(cam.lookedRound(camera, 1, 1).eye, camera.eye);
});

test("to go round keeps what is looked at, and the eye goes where it is told", () => {
  near(cam.orbited(camera, quarter, 0).eye, [6, 2, 8], 1e-9);
  near(cam.orbited(camera, quarter, 0, -1).eye, [-4, 2, 8], 1e-9);
  near(cam.orbited(camera, 0, Math.PI / 6).eye[1], 4.5, 1e-9);
  same(cam.orbited(camera, 1, 1).at, camera.at);
});

test("steps are level, and the eye never turns over", () => {
  const down = cam.lookedRound(camera, 0, -1);
  near(cam.walked(down, { forward: 2, right: 1, up: 0.5 }).eye, [2, 2.5, 5], 1e-9);
  near(cam.walked(down, { right: 1 }, -1).eye, [0, 2, 3], 1e-9);
  const over = cam.lookedRound(camera, 0, 9), { up } = cam.axesOf(over);
  near([far(over), up[1] > 0], [5, true].map(Number), 1e-9);
  near(far(cam.dollied(camera, 0.5)), 2.5, 1e-9);
  same(cam.dollied(camera, 0.5).at, camera.at);
});

test("what is double-clicked comes into the middle: found again by projecting it", () => {
  const next = random(7);
  for (let k = 0; k < 50; k++) {
    const [x, y, aspect, side] = [next(-90, 90) / 100, next(-90, 90) / 100, next(5, 25) / 10, next(0, 1) ? 1 : -1];
    const view = { eye: [next(-9, 9), next(-9, 9), next(-9, 9)], at: [next(-9, 9) + 0.5, 0, next(-9, 9) + 0.5], angle: next(20, 100) };
    const found = cam.aimed(view, x, y, aspect, side), d = found.at.map((a, i) => a - view.eye[i]);
    const { forward, right, up } = cam.axesOf(view, side), along = (axis) => axis.reduce((sum, a, i) => sum + a * d[i], 0);
    const half = Math.tan((view.angle * Math.PI) / 360);
    if (Math.abs(d[1]) / Math.hypot(...d) > 0.999) continue; // straight up or down, where it stops
    near([along(right) / along(forward) / half, ((along(up) / along(forward)) * aspect) / half], [x, y], 1e-6);
  }
});

test("angles, steps and the text of a camera have bounds", () => {
  same([cam.angled(camera, 200).angle, cam.angled(camera, 1).angle], [120, 10]);
  near([cam.stepOf([[0, 0, 0], [3, 4, 0]]), cam.stepOf([[0, 0, 0], [300, 4, 0]]), cam.stepOf(null), cam.stepOf([[-Infinity, 0, 0], [0, 0, 0]])], [0.125, 0.5, 0.25, 0.25], 1e-12);
  same(cam.cameraText({ eye: [1.23456, -0.00001, 2], at: [1e-7, 0, 3], angle: 70.5 }), "1.2346,0,2:0,0,3:70.5");
});

test("halves: all of them, against the encoder of DataView or Math", () => {
  for (const [bits, value] of [[0x3c00, 1], [0x3800, 0.5], [0xc000, -2], [0x0001, 2 ** -24], [0x7bff, 65504], [0x03ff, 1023 * 2 ** -24], [0x7c00, Infinity], [0xfc00, -Infinity]]) same(halfValue(bits), value);
  same([halfValue(0x7e00), halfValue(0x8000)], [NaN, -0]);
});

test("linear halves become bytes of sRGB", () => {
  const table = displayTable(), brighter = displayTable(1);
  same([0x3c00, 0x4000, 0x0000, 0xbc00, 0x7e00, 0x7c00].map((b) => table[b]), [255, 255, 0, 0, 0, 255]);
  same([table[0x31c3], table[0x3800]], [118, 188]); // 0.18 and 0.5
  same([brighter[0x3400], brighter[0x3800]], [188, 255]);
  const pixels = new Uint16Array([0x3c00, 0, 0x3800, 0x3c00]);
  same([...displayed(pixels.buffer, 1, 1, table)], [255, 0, 188, 255]);
  same(displayed(pixels.buffer, 2, 1, table), undefined);
});

const planes = () => {
  const surfaces = [{ kind: "material", text: "A" }, { kind: "object", text: "#1" }, { kind: "flat", text: "#1/flat:1" }, { kind: "level", text: "#1/level:1" }];
  const one = (n) => [0, n, n, n, n, n, 0, 0]; // 4 x 2
  return readSurfaces({ surfaces, width: 4, height: 2 }, new Uint16Array([1, 2, 3, 4].flatMap(one)).buffer);
};

test("the surface under the pointer, by scope", async () => {
  const of = planes();
  same(SCOPES.map((scope) => surfaceAt(of, scope, 0.3, 0.1)?.text), ["A", "#1/flat:1", "#1/level:1", "#1"]);
  same([[0, 0], [0.99, 0.99], [1, 0], [-0.01, 0], [0, 1], [0.1, 0.9]].map(([x, y]) => surfaceAt(of, "material", x, y)?.text), [undefined, undefined, undefined, undefined, undefined, "A"]);
  same([...maskOf(of, of.surfaces[2])], [0, 1, 1, 1, 1, 1, 0, 0]);
  same(maskOf(of, { kind: "flat" }), null);
  const surfaces = [{ kind: "object", text: "B", share: 0.1 }, { kind: "object", text: "C", share: 0.2 }, { kind: "material", text: "D", share: 0.5 }];
  same(surfacesOf({ surfaces, planes: { material: new Uint16Array([1, 0, 2, 2]) } }, "material").map((s) => s.text), ["C", "B"]);
  await fails(() => readSurfaces({ surfaces: [], width: 9, height: 9 }, new ArrayBuffer(100)), /cut off/);
});

test("edges are inside, beside what is outside", () => {
  const mask = Uint8Array.from({ length: 25 }, (_, i) => (i % 5 > 0 && i < 20 ? 1 : 0)), edges = [];
  for (let y = 0; y < 5; y++) for (let x = 0; x < 5; x++) edges.push(isEdge(mask, 5, 5, x, y) ? 1 : 0);
  same(edges, [0, 1, 1, 1, 1, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0]);
});

test("the grid has a line at each metre, two of them for where textures begin, none at seams", async () => {
  const [width, height] = [7, 1], u = [-0.6, -0.1, 0.4, 0.9, 1.4, 7.2, 7.3], v = Array(7).fill(0.5), target = [1, 1, 1, 1, 1, 1, 0];
  const buffer = new ArrayBuffer(width * 10 + 2), bytes = new Uint8Array(buffer);
  bytes.set(new Uint8Array(Uint16Array.from(target).buffer));
  bytes.set(new Uint8Array(Float32Array.from(u).buffer), width * 2);
  bytes.set(new Uint8Array(Float32Array.from(v).buffer), width * 6);
  const of = readCoordinates({ width, height, uv: [] }, buffer);
  same(u.map((_, x) => gridLine(of, x, 0)), [0, 2, 0, 1, 0, 0, 0]);
  await fails(() => readCoordinates({ width: 9, height: 9, uv: [] }, buffer), /cut off/);
});

test("an estimate is the line through two trials", () => {
  const trial = (pixels, seconds, memory, bytes) => ({ pixels, samples: 4, seconds, setup: 3, memory, bytes });
  const told = estimate([trial(1000, 2, 110, 60), trial(4000, 5, 140, 120)], { width: 100, height: 100, samples: 8 });
  near([told.seconds, told.memory, told.bytes], [3 + 1 + (80000 * 3) / 12000, 200, 240], 1e-9);
  const flat = estimate([trial(1000, 5, 100, 1), trial(4000, 4, 90, 1)], { width: 100, height: 100, samples: 8 }); // noise of the clock
  near([flat.seconds, flat.memory], [7, 90], 1e-9);
  same(trialOf('{"render_seconds":2,"parse_seconds":1,"build_seconds":0.5,"peak_memory_bytes":7}', 10, 4, 9), { pixels: 10, samples: 4, bytes: 9, seconds: 2, setup: 1.5, memory: 7 });
});

test("times and bytes in words", () => {
  same([0.2, 42, 95, 300, 5399, 9000, 86400].map(durationText), ["less than a second", "42 seconds", "2 minutes", "5 minutes", "90 minutes", "2.5 hours", "24 hours"]);
  same([12, 1500, 2.34e6, 5e7, 3.21e9].map(bytesText), ["12 bytes", "1.5 KB", "2.3 MB", "50 MB", "3.2 GB"]);
});
