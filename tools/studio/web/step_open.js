/* Open: a model is chosen, and made into a scene. */
import * as api from "./api.js";
import { importArgs, variantListArgs } from "./commands.js";
import { button, choice, field, h, icon, ICONS } from "./dom.js";
import { chosenFiles, modelsOf, putModel } from "./files.js";
import { own } from "./step_view.js";
import { errorReport, importReport, isLoss, pictureTrouble } from "./words.js";

const KINDS = { model: "3D model", scene: "scene", set: "rendered room", folder: "folder", picture: "picture" };

export const id = "open", title = "Open", hint = "Choose a 3D model of a room.";

const troubleOf = ({ kind, project }) => (kind === "model" ? pictureTrouble(project.import.lines || []) : "");
export const isDone = (app) => !!app.model && (app.hasScene || app.kind === "set") && !troubleOf(app);

/* Files from outside, { path, file }, are put into a folder of the studio first. */
export async function openFiles(app, list) {
  const models = modelsOf(list);
  if (!models.length) {
    throw new Error(`${list.length === 1 ? `“${list[0].path}” is no model` : "There is no model among these files"}. Choose a file such as .glb, .obj, .fbx, or a scene .pov, with the files that belong to it.`);
  }
  app.say(list.length > 1 ? `${list.length} files are being copied…` : `“${models[0].path}” is being copied…`);
  const paths = await putModel(list);
  if (paths.length === 1) return openPath(app, paths[0]);
  app.choices = paths;
  return app.go("open");
}

async function openPath(app, path) {
  app.choices = null;
  await api.openModel(path);
  await app.load();
  begin(app);
}

/* Variants of a glTF file, by their names. */
async function learnVariants(app) {
  app.variants = [];
  if (!/\.gl(b|tf)$/i.test(app.project.model)) return;
  const text = await app.runWell("retex-import", variantListArgs(app.project), "Look for variants").catch(() => "");
  app.variants = text.split("\n").filter(Boolean);
  app.tell();
}

/* What comes first: an import, the view, or playing. */
export function begin(app) {
  app.listing = null;
  if (app.foreign) return;
  learnVariants(app);
  if (app.kind === "set") app.go("play");
  else if (app.hasScene) app.go(app.set ? "play" : "view");
  else {
    app.go("open");
    importModel(app);
  }
}

export const importModel = (app, change = {}) => app.attempt(async () => {
  const how = { ...app.project.import, ...change, done: false };
  app.amend((p) => ({ ...p, import: how }));
  app.importing = true;
  app.tell();
  const job = await app.run("retex-import", importArgs(app.project), "Read the model");
  app.importing = false;
  app.importLines = job.lines;
  const done = job.state === "done";
  app.amend((p) => ({ ...p, import: { ...how, done, number: (how.number || 0) + 1, lines: job.lines.slice(0, 40) } }));
  if (done) {
    app.modelChanged = false;
    app.known = {};
    app.say(troubleOf(app) || "The model is ready.", troubleOf(app) ? "hint" : "note");
  }
});

/* The file is another one than before. */
export function importAgain(app) {
  app.modelChanged = false;
  if (app.kind === "model") return importModel(app);
  app.known = {};
  app.player.clear();
  if (app.kind === "set") return app.attempt(() => app.player.show());
  return app.amend((p) => ({ ...p, import: { ...p.import, number: (p.import.number || 0) + 1 } }));
}

function browser(app) {
  const { listing } = app;
  if (!listing) {
    if (!app.listingComes) app.listingComes = app.attempt(() => browse(app, "")).finally(() => (app.listingComes = null));
    return h("p", { class: "hint" }, "Looking for models…");
  }
  const rows = listing.entries.filter((e) => ["folder", "model", "scene", "set"].includes(e.kind));
  const row = (e) => h("li", {}, button(e.name, () => app.attempt(() => (e.kind === "folder" ? browse(app, e.path) : openPath(app, e.path))),
    { class: "row", "aria-label": `${e.name}, ${KINDS[e.kind]}` }, e.kind === "folder" ? "folder" : "file"));
  return h("div", { class: "browser" },
    h("h3", {}, "On this computer"), h("p", { class: "path" }, listing.path),
    h("ul", { class: "rows" }, listing.parent ? h("li", {}, button("One folder up", () => app.attempt(() => browse(app, listing.parent)), { class: "row" }, "undo")) : null, rows.map(row)),
    rows.length ? null : h("p", { class: "hint" }, "There is no model in this folder."));
}

async function browse(app, path) {
  app.listing = await api.getFolder(path);
  app.tell();
}

const FILES = ".glb,.gltf,.bin,.obj,.mtl,.fbx,.dae,.3ds,.ply,.stl,.pov,.exr,.retex,image/*";

export function chooser(app, text, primary = true) {
  const put = (e) => e.target.files.length && app.attempt(() => openFiles(app, chosenFiles(e.target.files)));
  const input = (properties) => h("input", { type: "file", class: "quiet", tabIndex: -1, "aria-hidden": "true", onchange: put, multiple: true, ...properties });
  const files = input({ id: "model-file", accept: FILES }), folder = input({ webkitdirectory: true });
  return [button(text, () => files.click(), { class: primary ? "primary" : "", id: `choose-${primary ? "first" : "other"}` }),
    button("A folder…", () => folder.click(), { id: "choose-folder", "aria-label": "Choose a folder with a model and its files" }), files, folder];
}

/* Of a drop that has several models. */
function choices(app) {
  return h("div", { class: "card", role: "status" }, h("div", {}, h("b", {}, "There are several models. Which one?"),
    h("ul", { class: "rows" }, app.choices.map((path, k) => h("li", {}, button(path.split("/").at(-1), () => app.attempt(() => openPath(app, path)), { class: "row", id: `model-${k}` }, "file"))))));
}

/* Chosen by a shop in the file, such as colours of a sofa. */
function variants(app) {
  const { variant = "" } = app.project.import;
  if (!app.variants?.length) return null;
  return field("Variant", choice("import-variant", [["", "as the file is, with all that can be chosen later"], ...app.variants.map((v) => [v, v])], variant, (v) => importModel(app, { variant: v })));
}

const UNITS = [["", "find out"], ["m", "metres"], ["cm", "centimetres"], ["mm", "millimetres"], ["in", "inches"], ["ft", "feet"]];

function options(app) {
  const how = app.project.import, set = (key) => (value) => app.change(`Change the import`, (p) => ({ ...p, import: { ...p.import, [key]: value } }));
  return h("details", { id: "import-options", open: !!app.optionsOpen, ontoggle: (e) => (app.optionsOpen = e.target.open) },
    h("summary", {}, "Is something wrong with the model?"),
    field("Its lengths are in", choice("import-unit", UNITS, how.unit || "", set("unit")), "If tiles get the wrong size, this is why."),
    field("Up is", choice("import-up", [["", "find out"], ["y", "the y axis"], ["z", "the z axis"]], how.up || "", set("up")), "If the room lies on its side."),
    field("Begin", choice("import-camera", [["", "at the file's camera, or a good place"], ["inside", "inside the room"], ["outside", "outside, all of it"], ["cutaway", "above, without the ceiling"]], how.camera || "", set("camera"))),
    field("Lights are", choice("import-lights", [["", "as bright as the file says"], ["0.25", "four times darker"], ["4", "four times brighter"], ["16", "sixteen times brighter"]], how.lights || "", set("lights"))),
    button("Read the model again", () => importModel(app), { id: "import-again" }));
}

/* A plain sky, brighter above. */
function skyPicture() {
  const canvas = h("canvas", { width: 64, height: 32 }), context = canvas.getContext("2d"), colors = context.createLinearGradient(0, 0, 0, 32);
  for (const [at, color] of [[0, "#dfe9f5"], [0.5, "#f3f3f0"], [0.52, "#8c8880"], [1, "#8c8880"]]) colors.addColorStop(at, color);
  context.fillStyle = colors;
  context.fillRect(0, 0, 64, 32);
  return new Promise((done) => canvas.toBlob(done));
}

const addSky = (app) => app.attempt(async () => importModel(app, { sky: await api.upload("sky.png", await skyPicture()) }));

/* A first picture that is of no use, and what to try. */
function trouble(app, lines) {
  const text = troubleOf(app), { camera, sky } = app.project.import;
  const isOutside = camera ? camera === "outside" : lines.some((line) => /the view is from outside/.test(line));
  return text && h("div", { class: "card bad", role: "alert", id: "import-trouble" }, icon(ICONS.warn),
    h("div", {}, h("strong", {}, "The model was read, but its picture is of no use yet"), h("p", {}, text),
      h("div", { class: "buttons" },
        button(isOutside ? "Look from inside" : "Look from outside", () => importModel(app, { camera: isOutside ? "inside" : "outside" }), { id: "import-other-view" }),
        sky ? button("Take the sky away", () => importModel(app, { sky: "" }), { id: "import-sky" }) : button("Put a sky around it", () => addSky(app), { id: "import-sky" })),
      own(app, () => app.go("view"))));
}

function report(app) {
  const { lines = [], done } = app.project.import, problems = importReport(lines);
  if (!lines.length) return null;
  if (!done) {
    const loss = isLoss(lines);
    return h("div", { class: "card bad", role: "alert" }, icon(ICONS.warn),
      h("div", {}, h("strong", {}, loss ? "Something is missing in the model" : "The model could not be read"),
        loss ? h("ul", {}, problems.filter((p) => p.asks).map((p) => h("li", {}, p.text))) : h("p", {}, errorReport(lines, "The reader").text),
        loss ? button("Go on without it", () => importModel(app, { partial: true }), { id: "import-partial" }) : null,
        h("details", {}, h("summary", {}, "What the program said"), h("pre", {}, lines.join("\n")))));
  }
  return [trouble(app, lines), h("div", { class: "report" }, h("h3", {}, "What was found"),
    h("ul", {}, problems.map((p) => h("li", { class: p.asks ? "asks" : "" }, p.asks ? icon(ICONS.warn) : icon(ICONS.done), h("span", {}, p.text)))),
    h("details", {}, h("summary", {}, "What the program said"), h("pre", {}, lines.join("\n"))))];
}

export function render(app) {
  if (app.choices) return [choices(app)];
  if (!app.model) {
    return [h("p", {}, "A model is a file such as ", h("b", {}, "room.glb"), ", as Blender, SketchUp and other programs export it."), browser(app)];
  }
  return [
    h("p", { class: "file-name" }, icon(ICONS.file), h("b", {}, app.model.name), ` (${KINDS[app.kind] || "file"})`),
    app.importing ? h("div", { class: "card" }, h("span", { class: "spinner" }), h("p", {}, "The model is being read…")) : report(app),
    app.kind === "model" && !app.importing ? [variants(app), options(app)] : null,
    h("div", { class: "buttons" }, chooser(app, "Open another model…", false)),
  ].filter(Boolean);
}

export function next(app) {
  if (!app.model) return null;
  if (app.importing) return { label: "Reading the model…", disabled: true };
  if (app.kind === "set") return { label: "Play with it", step: "play" };
  if (app.hasScene) return { label: "Look at it", step: "view" };
  return { label: "Read the model", run: () => importModel(app) };
}
