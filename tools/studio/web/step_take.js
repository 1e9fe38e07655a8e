/* Take away: pictures, files and pages for others. */
import * as api from "./api.js";
import { catalogueArgs, catalogueTable, commandsOf, folderOf, lookWithout, maySmaller, packArgs, pageArgs, pictureArgs, shellLine, webOf } from "./commands.js";
import { button, check, choice, download, field, h, icon, iconButton, ICONS } from "./dom.js";
import { addressOf, presetOf, readLook } from "./look.js";
import { freeName } from "./project.js";
import { widthOf } from "./widths.js";

export const id = "take", title = "Take away", hint = "Save what you made.";
export const isOpen = (app) => !!app.set;
export const isDone = () => false;
export const enter = (app) => app.attempt(() => app.player.show());

const away = (app) => (app.away ||= { format: "png", size: "", smaller: true });
const stamp = () => new Date().toISOString().slice(0, 19).replace(/[:T]/g, "-");

/* Do it, with a note while it is done; the result is a file to be downloaded. */
const make = (app, key, action) => app.attempt(async () => {
  const state = away(app);
  state.busy = key;
  app.tell();
  try {
    state[key] = await action();
  } finally {
    state.busy = "";
    app.tell();
  }
});

const link = (path, text) => h("a", { href: addressOf(path), download: path.split("/").at(-1), class: "button" }, icon(ICONS.take), h("span", {}, text));

/* shown: what leads to what was made. */
function card(app, key, name, about, body, label, action, shown = (file) => link(file, "Download")) {
  const { busy } = away(app), done = away(app)[key];
  return h("section", { class: "card", "aria-labelledby": `${key}-title` }, h("div", {},
    h("h3", { id: `${key}-title` }, name), h("p", { class: "hint" }, about), body,
    h("div", { class: "buttons" }, button(busy === key ? "One moment…" : label, () => make(app, key, action), { id: `make-${key}`, disabled: !!busy }),
      done ? shown(done) : null)));
}

function picture(app) {
  const state = away(app), put = (key) => (value) => {
    state[key] = value;
    state.picture = null;
    app.tell();
  };
  const body = h("div", { class: "pair" },
    field("Kind", choice("format", [["png", "PNG"], ["jpg", "JPEG"], ["tif", "TIFF, for print"], ["exr", "EXR, for compositing"]], state.format, put("format"))),
    field("Size", choice("picture-size", [["", "as rendered"], ["1280x", "1280 wide"], ["640x", "640 wide"]], state.size, put("size"))));
  return card(app, "picture", "Picture", "The room as it looks now, in full quality.", body, "Make the picture", async () => {
    await app.saveNow();
    const file = `${folderOf(app.project.model)}/pictures/${stamp()}.${state.format}`;
    await app.runWell("retex-combine", pictureArgs(app.set, app.project.look, file, state.size), "Make the picture");
    return file;
  });
}

function pack(app) {
  return card(app, "pack", "Room file", "One file with all of the room, for others who have retex, and for archives.", null, "Make the file", async () => {
    const file = `${folderOf(app.project.model)}/room.retex`;
    await app.runWell("retex-pack", packArgs(app.set, file), "Make the room file");
    return file;
  });
}

function page(app) {
  const state = away(app), { look } = app.project, folder = webOf(app.project.model, app.set), mayBeSmaller = maySmaller(app.set);
  const body = [
    state.page ? h("p", { class: "path" }, state.page) : null,
    mayBeSmaller ? check("page-smaller", "Smaller rooms beside it, for phones", state.smaller, (on) => (state.smaller = on)) : null,
  ];
  /* its scripts are not run at this address, where they could ask the studio for all that the user may do */
  const place = (made) => h("div", { id: "page-made" }, h("p", { class: "hint" }, "Put it on any web server. To look at it first, in a shell:"),
    h("pre", { tabIndex: 0 }, shellLine("python3", ["-m", "http.server", "-b", "127.0.0.1", "-d", `${app.model.folder}/${made}`])));
  return card(app, "page", "Web page", "A folder for any web server. Visitors see the room as it looks now, and change the textures themselves.", body, "Make the page", async () => {
    const preset = look ? await api.upload("look.json", new Blob([presetOf(look, app.model.folder)])) : "";
    await app.runWell("retex-pack", pageArgs(app.set, folder, preset, mayBeSmaller && state.smaller), "Make the page");
    return folder;
  }, place);
}

/* All pictures of the folder that is open in Play, one after the other on the target. */
async function makeCatalogue(app, target) {
  const entries = (app.pictures?.entries || []).filter((e) => e.kind === "picture");
  if (!entries.length) throw new Error("Open a folder with pictures in the step Play first.");
  const root = `${folderOf(app.project.model)}/catalogue`, taken = [];
  const textures = entries.map((e) => {
    const name = freeName(e.name.replace(/\.\w+$/, ""), taken);
    taken.push(name);
    return { path: e.path, width: widthOf(app.project.textures.widths, e.path), output: `${name}.jpg` };
  });
  const table = await api.upload("catalogue.csv", new Blob([catalogueTable(target, textures, app.project.look)]));
  await app.runWell("retex-combine", catalogueArgs(app.set, table, root, lookWithout(app.project.look, target)), "Make the catalogue");
  away(app).sheet = textures.map((t) => ({ file: `${root}/${t.output}`, name: t.output.replace(/\.jpg$/, ""), width: t.width }));
  return null;
}

function catalogue(app) {
  const targets = app.player.room?.targets || app.project.targets.map((t) => t.name), state = away(app);
  const target = targets.includes(state.target) ? state.target : app.player.target || targets[0] || "";
  const body = field("One picture for each texture on", choice("catalogue-target", targets.map((t) => [t, t]), target, (t) => (state.target = t)));
  return [card(app, "catalogue", "Catalogue", "A picture of the room with every texture of the folder that is open in Play.", body, "Make the catalogue", () => makeCatalogue(app, state.target || target)),
    state.sheet ? h("section", { class: "sheet" }, h("div", { class: "buttons" }, button("Print", () => print(), { id: "print" })),
      h("ul", {}, state.sheet.map((s) => h("li", {}, h("a", { href: addressOf(s.file), target: "_blank", rel: "noopener" }, h("img", { src: addressOf(s.file), alt: `The room with ${s.name}`, loading: "lazy" })), h("span", {}, s.name), s.width ? h("small", {}, ` ${s.width} cm`) : null)))) : null];
}

function presets(app) {
  const { presets: list, look } = app.project;
  const keep = () => {
    const name = freeName(`Look ${list.length + 1}`, list.map((p) => p.name));
    app.change(`Keep ${name}`, (p) => ({ ...p, presets: [...p.presets, { name, look }] }));
  };
  const rename = (preset) => (e) => app.change("Rename a look", (p) => ({ ...p, presets: p.presets.map((q) => (q === preset ? { ...q, name: e.target.value || q.name } : q)) }));
  const use = (preset) => {
    app.change(`Show ${preset.name}`, (p) => ({ ...p, look: preset.look }));
    app.attempt(() => app.player.putLook());
  };
  return h("section", { class: "card", "aria-labelledby": "presets-title" }, h("div", {}, h("h3", { id: "presets-title" }, "Looks"), h("p", { class: "hint" }, "Keep how the room looks, to come back to it. A downloaded one is for retex-combine: --preset FILE."),
    h("ul", { class: "presets" }, list.map((preset, k) => h("li", {}, h("input", { type: "text", id: `preset-${k}`, value: preset.name, "aria-label": `Name of look ${k + 1}`, onchange: rename(preset) }),
      iconButton(`Download ${preset.name}`, "take", () => download(`${preset.name}.json`, presetOf(preset.look, app.model.folder))),
      button("Show", () => use(preset), { id: `show-${k}`, "aria-label": `Show ${preset.name}` }),
      iconButton(`Remove ${preset.name}`, "remove", () => app.change(`Remove ${preset.name}`, (p) => ({ ...p, presets: p.presets.filter((q) => q !== preset) })))))),
    button("Keep this look", keep, { id: "keep-look" })));
}

function commands(app) {
  const lines = commandsOf(app.project), text = lines.map((l) => `# ${l.title}\n${l.line}\n`).join("\n");
  const copy = () => app.attempt(async () => {
    await navigator.clipboard.writeText(text);
    app.say("Copied.");
  });
  return h("details", { class: "commands", id: "commands", open: !!app.commandsOpen, ontoggle: (e) => (app.commandsOpen = e.target.open) }, h("summary", {}, "Commands"),
    h("p", { class: "hint" }, "The same in a shell, in the folder of the model. The files are the same to the bit."), h("pre", { tabIndex: 0 }, text), button("Copy", copy, { id: "copy-commands" }));
}

export function render(app) {
  const { warmth } = readLook(app.project.look);
  return [
    warmth ? h("div", { class: "card" }, icon(ICONS.warn), h("p", {}, "Warmth is of the page alone. To have it in pictures, change the colour of lamps.")) : null,
    picture(app), catalogue(app), page(app), pack(app), presets(app), commands(app),
  ];
}

export const next = (app) => ({ label: "Make the picture", run: () => document.getElementById("make-picture")?.click(), disabled: !!away(app).busy });
