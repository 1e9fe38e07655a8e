/* retex studio: files that are dropped, and parts of the picture. */
import { same, test } from "./tap.mjs";
import { MIDDLE, partBetween, partMoved, partPixels, partSized } from "../../tools/studio/web/crop.js";
import { inFolder, isRenamed, modelsOf } from "../../tools/studio/web/files.js";

const of = (...paths) => paths.map((path) => ({ path }));
const paths = (list) => list.map(({ path }) => path);

test("the model of several files is the uppermost", () => {
  same(paths(modelsOf(of("room.bin", "room.gltf", "textures/oak.jpg", "old/room.obj"))), ["room.gltf"]);
  same(paths(modelsOf(of("a/x/chair.glb", "a/x/table.obj", "a/x/table.mtl"))), ["a/x/chair.glb", "a/x/table.obj"]);
  same(modelsOf(of("oak.jpg", "notes.txt")), []);
});

test("files of a model lie in a folder of their own, as they lay", () => {
  same(paths(inFolder(of("room.gltf", "room.bin", "t/oak.jpg"))), ["room/room.gltf", "room/room.bin", "room/t/oak.jpg"]);
  same(paths(inFolder(of("flat/room.gltf", "flat/t/oak.jpg"))), ["flat/room.gltf", "flat/t/oak.jpg"]);
  same(paths(inFolder(of("flat/room.gltf", "flat/t/oak.jpg"), 2)), ["flat-2/room.gltf", "flat-2/t/oak.jpg"]);
  same(paths(inFolder(of("flat/room.gltf", "t/oak.jpg"), 3)), ["room-3/flat/room.gltf", "room-3/t/oak.jpg"]);
});

test("a name that another file has is seen", () => {
  same([["room/room.gltf", "/home/u/retex-studio/room/room-2.gltf"], ["room/room.gltf", "room.gltf"], ["a/oak-2.jpg", "a/oak-2.jpg"], ["a/b:c.jpg", "a/b_c.jpg"]]
    .map(([wanted, kept]) => isRenamed(wanted, kept)), [true, false, false, false]);
});

const near = (part) => part.map((x) => Number(x.toFixed(6)));

test("a part is drawn from any corner, and stays in the picture", () => {
  same(near(partBetween([0.6, 0.7], [0.2, 0.5])), [0.2, 0.5, 0.4, 0.2]);
  same(near(partBetween([0.9, 0.9], [1.5, 3])), [0.9, 0.9, 0.1, 0.1]);
  same(near(partBetween([1, 1], [1, 1])), [0.98, 0.98, 0.02, 0.02]);
  same(near(partMoved([0.8, 0, 0.2, 0.5], 0.1, -0.1)), [0.8, 0, 0.2, 0.5]);
  same(near(partMoved([0.4, 0.2, 0.2, 0.5], -0.1, 0.1)), [0.3, 0.3, 0.2, 0.5]);
  same(near(partSized([0.4, 0.2, 0.2, 0.5], 0.9, -0.9)), [0.4, 0.2, 0.6, 0.02]);
});

test("a part in pixels lies in the render", () => {
  same(partPixels([0.5, 0.5, 0.25, 0.5], { width: 1280, height: 720 }), [640, 360, 320, 360]);
  same(partPixels([0.98, 0.98, 0.02, 0.02], { width: 160, height: 90 }), [144, 74, 16, 16]);
  for (const size of [{ width: 16, height: 16 }, { width: 17, height: 4001 }]) {
    const [x, y, w, h] = partPixels(MIDDLE, size);
    same([x >= 0, y >= 0, x + w <= size.width, y + h <= size.height], [true, true, true, true]);
  }
});
