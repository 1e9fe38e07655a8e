/* Play: pictures are put onto surfaces, and appear at once. */
import * as api from "./api.js";
import { button, h, icon, ICONS, numberField } from "./dom.js";
import { chooseFolder } from "./folders.js";
import { progressOf } from "./step_render.js";
import { widthOf } from "./widths.js";
import { kindOf } from "./project.js";

export const id = "play", title = "Play", hint = "Drag a picture onto a surface, or click a surface and then a picture.";
export const isOpen = (app) => !!app.set;
export const isDone = (app) => app.project.look !== "";

export const enter = (app) => app.attempt(() => app.player.show());

const aspects = new Map(); // of thumbnails, by path

const putPicture = (app, path, target = app.player.target) => app.attempt(async () => {
  if (!target) throw new Error("The room is still being loaded. Try again in a moment.");
  await app.player.put(target, path, widthOf(app.project.textures.widths, path, aspects.get(path)));
  app.chosen = path;
  app.tell();
});

/* Files from the window: the first lies on the target. */
export const takeFiles = (app, files, target) => app.attempt(async () => {
  const pictures = files.filter((f) => kindOf(f.name) === "picture");
  if (!pictures.length) throw new Error("These files are no pictures. Use JPEG, PNG or WebP.");
  const paths = [];
  for (const file of pictures) paths.push(await api.upload(file.name, file));
  app.pictures = null;
  await putPicture(app, paths[0], target);
});

/* The folder that was chosen last, whatever comes first. */
async function browse(app, path) {
  app.pictureFolder = path;
  const pictures = await api.getFolder(path);
  if (app.pictureFolder === path) app.pictures = pictures;
  app.tell();
}

function roots(app) {
  const own = `${app.state?.folder || ""}/files`, list = [[own, "My pictures"], ...(app.state?.textures || []).map((t) => [t, t.split("/").filter(Boolean).at(-1)])];
  const open = app.pictureFolder || own;
  return h("div", { class: "tabs", role: "group", "aria-label": "Folders of pictures" },
    list.map(([path, name], k) => button(name, () => app.attempt(() => browse(app, path)), { id: `root-${k}`, "aria-pressed": String(open.startsWith(path)) })));
}

/* A folder of pictures stays in the project. */
const addFolder = (app) => app.attempt(async () => {
  const path = await chooseFolder("Where are your pictures?", "picture", "pictures");
  if (!path) return;
  await api.addTextures(path);
  const before = app.state.textures, { textures } = await api.getState(), added = textures.find((t) => !before.includes(t)) || path;
  app.state.textures = textures;
  if (!app.project.textures.folders.includes(added)) {
    app.change("Add a folder of pictures", (p) => ({ ...p, textures: { ...p.textures, folders: [...p.textures.folders, added] } }));
  }
  await browse(app, added);
});

function swatch(app, entry, k) {
  if (entry.kind === "folder") return h("li", {}, button(entry.name, () => app.attempt(() => browse(app, entry.path)), { class: "swatch folder", id: `swatch-${k}` }, "folder"));
  const width = widthOf(app.project.textures.widths, entry.path, aspects.get(entry.path));
  const image = h("img", { src: api.thumbAddress(entry.path), alt: "", loading: "lazy", onload: (e) => aspects.set(entry.path, e.target.naturalWidth / e.target.naturalHeight) });
  return h("li", {}, h("button", { type: "button", class: "swatch", id: `swatch-${k}`, draggable: true, title: entry.name, "aria-pressed": String(app.chosen === entry.path),
    onclick: () => putPicture(app, entry.path), ondragstart: (e) => e.dataTransfer.setData("text/retex-path", entry.path) },
  image, h("span", {}, entry.name.replace(/\.\w+$/, "")), width ? h("small", {}, `${width} cm`) : null));
}

function width(app) {
  const path = app.chosen;
  if (!path) return null;
  const { widths } = app.project.textures, value = widthOf(widths, path, aspects.get(path)), name = path.split("/").at(-1);
  const put = (cm) => {
    app.change("Change a picture's width", (p) => ({ ...p, textures: { ...p.textures, widths: { ...p.textures.widths, [path]: cm } } }));
    putPicture(app, path);
  };
  return h("div", { class: "card" }, h("div", {}, h("label", { for: "picture-width" }, "How wide is ", h("b", {}, name), " in reality?"),
    h("div", { class: "pair" }, numberField("picture-width", value, 0.1, 10000, put, 0.1), h("span", {}, "cm")),
    h("p", { class: "hint" }, value ? widths[path] ? "You said so." : "Taken from its name." : "Not known yet: it may lie too large, or too small.")));
}

function gallery(app) {
  const { pictures } = app, folder = app.pictureFolder || `${app.state?.folder || ""}/files`;
  if (!pictures) {
    app.picturesCome ||= browse(app, folder).catch(() => (app.pictures = { path: folder, entries: [] })).finally(() => {
      app.picturesCome = null;
      app.tell();
    });
    return null;
  }
  const wanted = (app.search || "").toLowerCase();
  const list = pictures.entries.filter((e) => ["folder", "picture"].includes(e.kind) && e.name.toLowerCase().includes(wanted));
  const search = h("input", { id: "search", type: "search", placeholder: "Search", "aria-label": "Search pictures", value: app.search || "", oninput: (e) => {
    app.search = e.target.value;
    app.tell();
  } });
  return [search, list.length ? h("ul", { class: "swatches" }, list.slice(0, 200).map((e, k) => swatch(app, e, k)))
    : h("p", { class: "empty" }, icon(ICONS.picture), wanted ? "No picture has this name." : "No pictures yet. Add some, or drop them onto the room.")];
}

export function render(app) {
  const making = [...app.jobs.values()].find((j) => j.tool === "retex-pack" && j.state === "running");
  const input = h("input", { type: "file", class: "quiet", multiple: true, accept: "image/*", tabIndex: -1, "aria-hidden": "true", onchange: (e) => takeFiles(app, [...e.target.files], app.player.target) });
  return [
    making ? progressOf(making, "Getting the room ready") : null,
    app.player.target ? h("p", { class: "on", role: "status" }, "Pictures go onto ", h("b", {}, app.player.target), ".") : null,
    roots(app),
    h("div", { class: "buttons" }, button("Add pictures…", () => input.click(), { id: "add-pictures" }, "picture"), input,
      button("Add a folder…", () => addFolder(app), { id: "add-folder" }, "folder")),
    gallery(app), width(app),
  ];
}

export const dropPath = putPicture;
export const next = () => ({ label: "Take it away", step: "take" });
