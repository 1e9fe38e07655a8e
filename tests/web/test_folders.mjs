/* Folders of textures in pages: which file is what by its name, as tests/unit/test_folder.c has it for the tools; and
 * what is found in what was dropped. */
import { fails, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

const { readFolder, droppedFiles, hasRoughness } = player();
const chosen = (...names) => {
  const { color, rough, channel } = readFolder(names.map((name) => ({ name })));
  return [color.name, rough && rough.name, ...(rough ? channel : [])].join(" ");
};

test("the base colour and the roughness of folders as they are downloaded", () => {
  same(chosen("oak_diff_2k.jpg", "oak_rough_2k.jpg", "oak_nor_gl_2k.jpg"), "oak_diff_2k.jpg oak_rough_2k.jpg 1 0 0 0");
  same(chosen("Wood_2K-JPG_Color.jpg", "Wood_2K-JPG_Roughness.jpg", "Wood_2K-JPG_Opacity.jpg"), "Wood_2K-JPG_Color.jpg Wood_2K-JPG_Roughness.jpg 1 0 0 0");
  same(chosen("a_BaseColour.png", "a_Glossiness.png"), "a_BaseColour.png a_Glossiness.png 1 0 0 1");
  same(chosen("a-albedo.png", "a-ARM.png"), "a-albedo.png a-ARM.png 0 1 0 0");
  same(chosen("a_col.png", "a_orm.png", "a_gloss.png", "a_rough.png"), "a_col.png a_rough.png 1 0 0 0");
  same(chosen("a_col.png", "a_rough_1.png", "a_rough_2.png"), "a_col.png "); // which of them nobody says
  same(chosen("rough_wood_diff.jpg", "rough_wood.blend"), "rough_wood_diff.jpg ");
});

test("of several forms of a map the largest one, then one that lost nothing", () => {
  same(chosen("oak_diff_1k.png", "oak_diff_4k.jpg", "oak_diff_2048x2048.png"), "oak_diff_4k.jpg ");
  same(chosen("oak_diff_2k.jpg", "oak_diff_2048.png"), "oak_diff_2048.png ");
  same(chosen("oak_diff.jpg", "oak_diff_2k.tif", "oak_rough_1k.jpg", "oak_rough_2k.exr"), "oak_diff.jpg oak_rough_1k.jpg 1 0 0 0"); // that browsers read
});

test("what is no folder of one texture", async () => {
  await fails(() => readFolder([{ name: "oak.jpg" }, { name: "oak_rough.jpg" }]), /^None of these files is a base colour/);
  await fails(() => readFolder([{ name: "b_col.jpg" }, { name: "a_col.jpg" }]), "Several base colours, such as a_col.jpg and b_col.jpg: choose one of them.");
});

test("roughness chooses where that of two finishes is known", () => {
  same([{ finish_roughness: [0.5, -1, 0] }, { finish_roughness: [0.5, -1] }, {}].map(hasRoughness), [true, false, false]);
});

test("dropped folders are read, and `textures` in them, but no others", async () => {
  const file = (name) => ({ name, isFile: true, file: (done) => done(name) });
  const folder = (name, ...entries) => ({ name, isDirectory: true, createReader: () => ({ readEntries: (done) => done(entries.splice(0, 2)) }) });
  const dropped = (...entries) => droppedFiles({ items: entries.map((entry) => ({ webkitGetAsEntry: () => entry })), files: ["plain"] });
  same(await dropped(file("a.jpg")), ["plain"]);
  same(await dropped(folder("oak", file("a.jpg"), file(".b.jpg"), folder("Textures", file("c.jpg"), folder("textures", file("d.jpg"))), folder("old", file("e.jpg")), file("f.jpg"))), ["a.jpg", "c.jpg", "f.jpg"]);
});
