/* retex studio's projects: what is read, steps that are undone, surfaces and finishes; and the widths of textures, by
 * names as people write them. */
import { fails, same, test } from "./tap.mjs";
import { amended, changed, emptyProject, finishTrouble, freeName, kindOf, lampLabel, newHistory, readProject, redone, redoLabel, undoLabel, undone, withoutTarget, withRenamed, withRender, withTarget } from "../../tools/studio/web/project.js";
import { guessWidth, widthOf } from "../../tools/studio/web/widths.js";

const project = (change = {}) => ({ ...emptyProject("room.glb"), ...change });
const target = (name, select = name) => ({ name, select, uv: "", share: 0.1 });

test("kinds of files, by their names", () => {
  same(["a/room.GLB", "s.pov", "s.ini", "x.exr", "x.retex", "oak.jpeg", "notes.txt", "none", ""].map(kindOf),
    ["model", "scene", "scene", "set", "set", "picture", "other", "other", "other"]);
});

test("a project that was written is read, with what it lacks, and keeps what is unknown", () => {
  const read = readProject({ "retex-studio": 1, model: "room.glb", later: [1] }, "room.glb");
  same(read, { ...emptyProject("room.glb"), later: [1] });
  same(readProject(JSON.parse(JSON.stringify(project())), "x"), project());
});

test("steps are undone and done again; a new one ends what could be done again", () => {
  let h = newHistory(project());
  same([undone(h), redone(h), undoLabel(h), redoLabel(h)], [h, h, "", ""]);
  h = changed(changed(h, "one", project({ look: "1" })), "two", project({ look: "2" }));
  same([undoLabel(h), redoLabel(h)], ["two", ""]);
  h = undone(h);
  same([h.present.project.look, undoLabel(h), redoLabel(h)], ["1", "one", "two"]);
  same(redone(h).present.project.look, "2");
  same(undone(undone(h)).present.project.look, "");
  h = changed(h, "three", project({ look: "3" }));
  same([redoLabel(h), undone(h).present.project.look], ["", "1"]);
  same(changed(h, "nothing", h.present.project), h);
});

test("a drag is one step, and two drags with an undo between them are two", () => {
  let h = newHistory(project());
  for (const look of ["1", "2", "3"]) h = changed(h, "move", project({ look }), "drag");
  same([h.past.length, undone(h).present.project.look, redone(undone(h)).present.project.look], [1, "", "3"]);
  const again = changed(redone(undone(h)), "move", project({ look: "4" }), "drag");
  same([again.past.length, undone(again).present.project.look], [2, "3"]);
  const other = changed(h, "move", project({ look: "4" }), "other");
  same(other.past.length, 2);
});

test("at most 200 steps are kept", () => {
  let h = newHistory(project());
  for (let k = 0; k < 300; k++) h = changed(h, "x", project({ look: String(k) }));
  same([h.past.length, h.past[0].project.look], [200, "99"]);
});

test("what has happened stays, whatever is undone", () => {
  const first = project({ renders: [{ set: "1.exr", done: false }] });
  let h = changed(newHistory(first), "look", { ...first, look: "x" });
  h = amended(undone(h), (p) => withRender(p, "1.exr", { done: true }));
  same([h.present.project, redone(h).present.project].map((p) => p.renders[0].done), [true, true]);
});

test("surfaces are taken under a name of their own, eight of them", async () => {
  let p = withTarget(project(), { text: "#1/material", name: "Floor", share: 0.2 });
  p = withTarget(p, { text: "#2/flat:1", name: "Mesh_floor" });
  p = withTarget(p, { text: "#3", name: "old__wood=a" });
  same(p.targets.map((t) => t.name), ["Floor", "floor 2", "old wood_a"]);
  await fails(() => withTarget(p, { text: "#3", name: "x" }), /already/);
  for (let k = 4; k <= 8; k++) p = withTarget(p, { text: `#${k}`, name: "" });
  await fails(() => withTarget(p, { text: "#9", name: "x" }), /can have 8/);
  same(freeName("Wand grün", []), "Wand grün");
});

test("finishes follow the name of their surface, and go with it", () => {
  const p = project({ targets: [target("Floor"), target("Wall")], finishes: { Floor: ["matt", "satin"], Wall: ["metal"] } });
  same(withRenamed(p, "Floor", "Boden"), { ...p, targets: [{ ...target("Boden"), select: "Floor" }, target("Wall")], finishes: { Boden: ["matt", "satin"], Wall: ["metal"] } });
  same(withRenamed(p, "Floor", "wall").targets[0].name, "wall 2");
  same(withRenamed(p, "Floor", "  "), p);
  same(withoutTarget(p, "Floor"), { ...p, targets: [target("Wall")], finishes: { Wall: ["metal"] } });
});

test("how many finishes and lamps go together, as retex-render has it", () => {
  const trouble = (counts, lamps) => finishTrouble({ finishes: Object.fromEntries(counts.map((n, k) => [k, Array(n).fill("x")])), lamps: Array(lamps).fill("l") }) !== "";
  same([[[], 16], [[2, 4], 0], [[3, 3], 0], [[1, 1, 1, 1], 3], [[2], 7], [[2], 8], [[4, 2], 1], [[4, 2], 2]].map(([c, l]) => trouble(c, l)),
    [false, false, true, false, false, true, false, true]);
});

test("widths in names of textures", () => {
  const said = { "oak 120cm.jpg": 120, "tiles/60x60.jpg": 60, "plank_1200x200mm.png": 120, "terrazzo-600x600.jpg": 60, "Eiche 1,2 m.jpg": 120,
    "rug 2m x 3m.jpg": 200, "hex 8in.jpg": 20.32, "30×60/grey.jpg": 30, "60x60/oak 90cm.jpg": 90, "tile 45x45cm v2.png": 45, "metro_7.5x15.jpg": 7.5 };
  for (const [name, cm] of Object.entries(said)) same(guessWidth(name), cm, name);
});

test("numbers in names that are no widths", () => {
  for (const name of ["oak.jpg", "oak_2k.jpg", "oak_2048x2048.jpg", "wood_1920x1080.png", "4096/wood.jpg", "v3m2.jpg", "IMG_20240112.jpg", "tile 0x0.jpg", "a1cmx.jpg", "2000cm.jpg", "ral9010.png"])
    same(guessWidth(name), null, name);
});

test("a picture that stands has the shorter side as its width", () => {
  same([guessWidth("30x60.jpg", 2), guessWidth("30x60.jpg", 0.5), guessWidth("60x30.jpg", 0.5), guessWidth("30x60.jpg"), guessWidth("20x20.jpg", 2)], [60, 30, 30, 30, 20]);
});

test("what was said of a picture or a folder goes before names", () => {
  const widths = { "tex/oak 50cm.jpg": 80, "tex/slate": 40 };
  same(["tex/oak 50cm.jpg", "tex/elm 50cm.jpg", "tex/slate/a/b 10cm.jpg", "tex/x.jpg", "tex"].map((p) => widthOf(widths, p)), [80, 50, 40, null, null]);
});

test("lamps without a name in the scene are told by kind and number", () => {
  same(["Lamp", "sky", "light2_=light_source#2", "object17=#17", "Key=Spot,Rim"].map(lampLabel), ["Lamp", "sky", "Light 2", "Object 17", "Key"]);
});
