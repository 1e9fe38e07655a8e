/* retex studio's command lines, looks and tables; words of the tools' grammar are those of retex-edit(5). */
import { execFileSync } from "node:child_process";
import { same, test } from "./tap.mjs";
import * as c from "../../tools/studio/web/commands.js";
import { addressOf, lookArgs, lookOfLink, pathOf, presetOf, readLook } from "../../tools/studio/web/look.js";
import { emptyProject } from "../../tools/studio/web/project.js";
import { errorReport, importReport, isLoss, pictureTrouble } from "../../tools/studio/web/words.js";
import { player } from "./player.mjs";

const room = { ...emptyProject("my room.glb"), view: { eye: [1, 2, 3], at: [0, 1, 0], angle: 65 },
  targets: [{ name: "Floor", select: "#3/flat:1", uv: "planar" }, { name: "Wall", select: "Walls", uv: "" }], lamps: ["Lamp"], finishes: { Floor: ["matt", "satin"], Wall: [] } };

test("a render has all that was chosen", () => {
  same(c.nextSet(room), "my room.glb.studio/renders/1.exr");
  same(c.nextSet({ ...room, renders: [{ set: "my room.glb.studio/renders/9.exr" }, { set: "x" }] }), "my room.glb.studio/renders/10.exr");
  same(c.renderArgs(room, "s.exr"), ["-t", "Floor=#3/flat:1:uv=planar", "-t", "Wall=Walls", "-l", "Lamp", "--finish", "Floor=matt,satin", "--camera", "1,2,3:0,1,0:65",
    "--size", "1280x720", "--spp", "64", "--denoise", "--resume", "--progress", "json", "-o", "s.exr", "--", "my room.glb.studio/scene/scene.pov"]);
  const plain = c.renderArgs({ ...room, model: "a.pov", view: null, render: { ...room.render, samples: 1, noise: 0.05 } }, "s.exr");
  same(plain.slice(-9), ["--noise", "0.05", "--resume", "--progress", "json", "-o", "s.exr", "--", "a.pov"]);
  same([plain.includes("--camera"), plain.includes("--denoise")], [false, false]);
});

test("an import has what was said, and goes into the project's folder", () => {
  same(c.importArgs({ ...room, import: { unit: "cm", camera: "inside", done: true, lines: ["x"], partial: true } }), ["--camera", "inside", "--unit", "cm", "--partial", "--force", "-o", "my room.glb.studio/scene", "--", "my room.glb"]);
});

test("names stand behind the options, also those that look like one", () => {
  const model = "--help", project = { ...room, model }, set = "-o.exr";
  const lines = [c.importArgs(project), c.variantListArgs(project), c.renderArgs({ ...project, model: "-x.pov" }, set), c.trialArgs(project, 100, "t"), c.cropArgs(project, [0, 0, 1, 1], "t"),
    c.lampListArgs(project), c.viewArgs(project, "-x", "v"), c.finishListArgs(project), c.webArgs(set, "w"), c.pageArgs(set, "w", "p", true), c.packArgs(set, "p"), c.pictureArgs(set, "Floor=tomato", "p", "640x"), c.catalogueArgs(set, "t", "r", "")];
  for (const line of lines) same([line.indexOf("--"), line.length - 2 - line.indexOf("--")], [line.length - 2, 0], line.join(" "));
});

test("trials and parts are of the same scene", () => {
  same(c.trialArgs(room, 100, "t.exr").slice(-13), ["1,2,3:0,1,0:65", "--size", "100x56", "--spp", "4", "--denoise", "--stats", "-", "-q", "-o", "t.exr", "--", "my room.glb.studio/scene/scene.pov"]);
  const part = c.cropArgs(room, [10, 20, 30, 40], "p.png");
  same([part.includes("-l"), part.includes("--finish"), part[part.indexOf("--crop") + 1]], [false, false, "10,20,30,40"]);
});

test("words of a shell are read by a shell as they were", () => {
  const words = ["plain", "my room.glb", "it's", "a$b`c", "", "#3/flat:1", "x=y", "-o", "!*?[]", "\n", "ö", "back\\slash", '"'];
  const printed = execFileSync("sh", ["-c", c.shellLine("printf '%s|'", words)], { encoding: "utf8" });
  same(printed, words.map((w) => `${w}|`).join(""));
});

test("the commands of a project, as they were run", () => {
  const set = "my room.glb.studio/renders/1.exr", done = { ...room, renders: [{ set, settings: c.settingsOf(room), done: true }], lamps: ["Later"], look: "Floor=tomato" };
  const lines = c.commandsOf(done).map((l) => l.line);
  same(lines.map((l) => l.split(" ")[0]), ["retex-import", "retex-render", "retex-combine", "retex-pack"]);
  same(lines.slice(2).map((l) => l.replaceAll("my room.glb.studio", "S")), ["retex-combine --save-preset 'S/look.json' -q --texture Floor=tomato -o 'S/picture.png' -- 'S/renders/1.exr'",
    "retex-pack -q --preset 'S/look.json' --web-smaller 2,4 --web 'S/web/1' -- 'S/renders/1.exr'"]);
  same(c.commandsOf(emptyProject("x.retex")).map((l) => l.line), ["retex-combine -q -o x.retex.studio/picture.png -- x.retex", "retex-pack -q --web x.retex.studio/web/x -- x.retex"]);
  same([lines[1].includes("--progress"), lines[1].includes("json"), lines[1].includes("'my room.glb.studio/renders/1.exr'"), lines[1].includes("-l Lamp "), lines[1].includes("Later")], [false, false, true, true, false]);
});

test("addresses of files, and back", () => {
  for (const path of ["room.studio/files/oak.jpg", "/home/u/a b/#1%.jpg", "ä/?.png"]) {
    same(pathOf(addressOf(path)), path);
    same(/[ #?]/.test(addressOf(path)), false);
  }
  same([addressOf("/tmp/a.jpg"), pathOf("tomato")], ["files//tmp/a.jpg", "tomato"]);
});

test("a look becomes options, whatever the player writes", () => {
  const { parseEdit, editText } = player();
  const text = editText(parseEdit("Floor=files/t/oak%25201.jpg;Floor.scale=2,1;Floor.rotate=30;over:Floor=files/l.png;over:Floor.width=0.5m;Wall%2Ewidth=tomato;light:Lamp=2.5;finish:Floor=satin;picture:exposure=0.5;picture:auto-exposure=yes;warmth=0.3"));
  same(lookArgs(text), ["--texture:scale=2,1:rotate=30", "Floor=t/oak 1.jpg", "--texture:over:width=0.5m", "Floor=l.png", "--texture", "Wall.width=tomato", "--light", "Lamp=2.5", "--finish", "Floor=satin", "--auto-exposure", "--exposure", "0.5"]);
  same(readLook(text).warmth, 0.3);
  same([lookArgs(""), readLook("").textures], [[], []]);
  same(lookOfLink("http://h/t/#room=Floor%3Dfiles%2Foak.jpg%3BFloor.scale=2,1&x=1"), "Floor=files/oak.jpg;Floor.scale=2,1");
  same(lookOfLink("http://h/t/"), "");
});

test("a look as a preset names its pictures by their places", () => {
  const { edit, ...rest } = JSON.parse(presetOf("Floor=files/room.studio/files/oak%25201.jpg;Floor.tiles=files/a.jpg,files//t/b%253bc.jpg;Wall=#aabbcc;warmth=0.3", "/home/u"));
  same(rest, { "retex-preset": 1 });
  same(edit, "Floor=/home/u/room.studio/files/oak 1.jpg;Floor.tiles=/home/u/a.jpg,/t/b%3bc.jpg;Wall=#aabbcc");
});

test("a table of a catalogue", () => {
  const textures = [{ path: "t/oak.jpg", width: 120, output: "oak.jpg" }, { path: "t/a, b.jpg", width: null, output: "a, b.jpg" }];
  same(c.catalogueTable("Floor", textures, ""), 'output,Floor\noak.jpg,:width=120cm t/oak.jpg\n"a, b.jpg","t/a, b.jpg"\n');
  const look = "Floor=files/x.jpg;Floor.scale=2,2;Floor.rotate=45;Floor.2=files/y.jpg;Wall=tomato";
  same(c.catalogueTable("Floor", textures.slice(0, 1), look), "output,Floor\noak.jpg,:width=120cm:rotate=45 t/oak.jpg\n");
  same(c.lookWithout(look, "Wall"), "Floor=files/x.jpg;Floor.scale=2,2;Floor.rotate=45;Floor.2=files/y.jpg");
});

test("a look without a target keeps those whose names begin alike", () => {
  same(c.lookWithout("Floor=a;Floor.rotate=3;Floor 2=b;Flo=c;over:Floor=d", "Floor"), "Floor 2=b;Flo=c;over:Floor=d");
});

test("what an import tells, in plain words", () => {
  const lines = ["retex-import: the room is 260 units high: they are taken as centimetres, and become metres; --unit overrides", "retex-import: there is no image `wood.png`",
    "retex-import: warning: the image `Oak_0-1` cannot be read: no PNG", "retex-import: something new",
    "retex-import: warning: the picture will be black, or nearly so: the lights of the model are; --sky FILE lights it", "retex-import: wrote x/x.pov", ""];
  same(importReport(lines).map(({ text, asks }) => [text.slice(0, 40), asks]), [["The lengths of this model look like cent", false], ["The picture “wood.png” is missing. Put i", true], ["The picture “Oak_0-1” cannot be read. Sa", true], ["Something new", false],
    ["Next to nothing lights this model: its p", true]]);
  same([isLoss(["retex-import: images are lost; --partial makes the scene without them"]), isLoss(lines)], [true, false]);
});

test("a first picture of no use is told, and what was done about light is no trouble", () => {
  const told = (line) => pictureTrouble(["retex-import: 3 materials, 2 meshes, 2 objects, 9 triangles", `retex-import: ${line}`, "retex-import: wrote s/s.pov"]).slice(0, 26);
  same(told("warning: nothing is seen in the picture: --camera chooses another view"), "The first picture shows no");
  same(told("warning: the picture is black: no light reaches what is seen; --sky FILE lights it, --camera another view"), "The first picture is black");
  same(told("warning: the picture will be black, or nearly so: the lights of the model are; --sky FILE lights it"), "Next to nothing lights thi");
  const done = ["the light of the model comes by few ways, as of a lamp: light is added", "the model has no sky: one is added, Added_light in s.pov, 0 without",
    "the light of the model reaches 3 % of what is seen: light is added", "an exposure of +5.10 stops brings the picture to a middle grey: retex_exposure in s.pov"];
  same([done.map(told), importReport(done).map(({ asks }) => asks)], [["", "", "", ""], [false, false, false, false]]);
});

test("views of the scene are looked at in small", () => {
  same(c.viewArgs(room, "View_2", "v.png"), ["--plain", "--camera", "View_2", "--size", "192x144", "--spp", "8", "-q", "-o", "v.png", "--", "my room.glb.studio/scene/scene.pov"]);
  same(c.viewArgs(room, "", "v.png").includes("--camera"), false);
});

test("errors say what to do, and keep the tool's line", () => {
  same(errorReport(["retex-render: No space left on device"]).text.startsWith("The disk is full."), true);
  const told = (line) => errorReport([`retex-render: error: ${line}`]).text;
  same(told("out of memory: this takes more than the 512 MB of --max-memory").startsWith("This needs more than the 512 MB of memory"), true);
  same(told("out of memory for the film").startsWith("There is too little memory"), true);
  const ended = (signal) => errorReport([`retex-studio: the program was ended by a signal: ${signal}`]).text;
  same([ended("Killed").includes("memory ran out"), ended("Segmentation fault").includes("Try again")], [true, true]);
  same(errorReport(['{"stage": "render"}', "retex-render: odd: thing", "  "]), { text: "This did not work: odd: thing", asks: true, line: "odd: thing" });
  same(errorReport([], "The render").text, "The render ended without saying why.");
});
