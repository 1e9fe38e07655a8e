/* Rooms that retex-pack wrote, drawn by the player's Renderer on webgl.mjs, and pictures to compare them with. All files are in
 * a folder of their own. */
import { execFileSync, spawn } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, openSync, readFileSync, readSync, rmSync, writeFileSync, writeSync } from "node:fs";
import { tmpdir } from "node:os";
import { resolve } from "node:path";
import { inflateSync } from "node:zlib";
import { player } from "./player.mjs";
import { context, WebGLTexture } from "./webgl.mjs";

const here = new URL(".", import.meta.url).pathname;
export const scenes = `${here}/../../scenes`, folder = mkdtempSync(`${tmpdir()}/player-`), bin = `${process.env.BUILD || "build"}/bin`;
export const run = (program, ...args) => execFileSync(program, args, { cwd: folder, maxBuffer: 1 << 28 });
export const tool = (name, ...args) => run(name.startsWith("/") ? name : new URL(`../../${bin}/${name}`, import.meta.url).pathname, ...args);
export const write = (name, text) => writeFileSync(`${folder}/${name}`, text);
process.on("exit", () => rmSync(folder, { recursive: true }));

/* Pictures as images of a page: rows of red, green, blue and alpha. A run of Python takes half a second: one reads all
 * pictures, and each once by its bytes. */
const known = new Map();
let pipes;
function read(picture) {
  if (!pipes) {
    const names = ["questions", "answers"].map((name) => `${folder}/${name}.pipe`);
    run("mkfifo", ...names);
    spawn("/usr/bin/python3", ["-B", `${here}/pixels.py`, ...names], { cwd: folder, stdio: ["ignore", "ignore", "inherit"] }).unref();
    pipes = [openSync(names[0], "w"), openSync(names[1], "r")];
  }
  writeSync(pipes[0], `${picture}\tpixels\n`);
  if (readSync(pipes[1], Buffer.alloc(1)) !== 1) throw new Error(`pixels.py cannot read ${picture}`);
  return readFileSync(`${folder}/pixels`);
}
export function images(names) {
  return names.map((name) => {
    const key = createHash("sha256").update(readFileSync(resolve(folder, name))).digest("hex");
    if (!known.has(key)) {
      const data = read(name);
      known.set(key, { naturalWidth: data.readUInt32LE(0), naturalHeight: data.readUInt32LE(4), rgba: data.subarray(8) });
    }
    return { ...known.get(key) };
  });
}

/* What isClear does with a canvas. */
const document = { createElement: () => {
  let shown;
  return { getContext: () => ({ drawImage: (image) => (shown = image), getImageData: () => ({ data: shown.rgba }) }) };
} };
const { Renderer, RetexRoom, plainTexture, decodeClass, checkManifest } = player({ WebGLTexture, document });

export function open(name, { classes = () => true, lit = true } = {}) {
  const room = JSON.parse(readFileSync(`${folder}/${name}/room.json`, "utf8"));
  checkManifest(room);
  const canvas = {}, gl = context(canvas), renderer = new Renderer({ getContext: () => gl }, room);
  const [still, ...lights] = images([room.picture, ...room.lights].map((entry) => `${name}/${entry.file}`));
  renderer.putStill(still);
  if (room.reduced) renderer.putReduced(images([`${name}/${room.reduced.file}`])[0]);
  if (room.lamps && lit) renderer.putLamps(images([`${name}/${room.lamps.file}`])[0]);
  lights.forEach((light, i) => renderer.putLight(i, light));
  for (const c of room.classes.filter(classes)) renderer.putClass(c, decodeClass(c, inflateSync(readFileSync(`${folder}/${name}/${c.file}`)), c.base, room.targets[c.target].periodic));
  const draw = (textures, { split = 0, light = {}, colors = room.parameters?.map((p) => p.value), finishes = [] } = {}) => {
    const none = plainTexture(), element = Object.assign(Object.create(RetexRoom.prototype), { room, finishes, renderer, refresh: () => {}, update: () => {} });
    element.textures = room.targets.map(() => ({ ...plainTexture(), put: {} }));
    for (const [name, { image = null, map = null, channel = null, tileImages = [], tiles = "", ...options }] of Object.entries(textures)) {
      const { index, layer } = element.placeOf(name), texture = { ...none, image, map, channel, tileImages, tiles };
      if (layer) element.putLayer(name, index, layer, texture, options);
      else element.change(name, index, element.textures[index], texture, options);
    }
    element.textures.forEach((_, i) => element.put(i));
    const settings = element.settings();
    renderer.render(settings, split, { exposure: 0, warmth: 0, ...light }, colors);
    return canvas.picture;
  };
  return { room, draw, renderer };
}

/* PSNR of the canvas against a picture: both are encoded in sRGB. */
export function psnr(picture, image, columns = [0, image.naturalWidth]) {
  const { naturalWidth: width, naturalHeight: height, rgba } = image;
  let sum = 0, count = 0;
  for (let y = 0; y < height; y++)
    for (let x = columns[0]; x < columns[1]; x++)
      for (let k = 0; k < 3; k++, count++) sum += (picture.values[4 * ((height - 1 - y) * width + x) + k] - rgba[4 * (y * width + x) + k] / 255) ** 2;
  return -10 * Math.log10(sum / count);
}
export function least(found, decibels, what) {
  console.log(`# ${what}: ${found.toFixed(1)} dB`);
  if (!(found >= decibels)) throw new Error(`${what}: ${found} dB, less than ${decibels}`);
}
