/* View: where the picture is taken from. */
import { angled, ANGLE_LEAST, ANGLE_MOST } from "./camera.js";
import { folderOf, viewArgs } from "./commands.js";
import { button, choice, field, h, iconButton } from "./dom.js";
import { addressOf } from "./look.js";
import { freeName, spoken } from "./project.js";

export const id = "view", title = "View", hint = "Move until the picture shows what you want.";
export const isOpen = (app) => app.hasScene;
export const isDone = (app) => app.project.targets.length > 0 || app.project.renders.length > 0;

const same = (a, b) => a && b && JSON.stringify([a.eye, a.at, a.angle]) === JSON.stringify([b.eye, b.at, b.angle]);
const plain = ({ eye, at, angle }) => ({ eye, at, angle });

function saved(app) {
  const { cameras, view } = app.project;
  const put = (camera) => app.change(`Go to ${camera.name}`, (p) => ({ ...p, view: plain(camera) }));
  return h("ul", { class: "cameras" }, cameras.map((camera, k) => h("li", {},
    h("button", { type: "button", class: "camera", id: `camera-${k}`, "aria-pressed": String(!!same(camera, view)), onclick: () => put(camera) },
      camera.thumb ? h("img", { src: camera.thumb, alt: "" }) : h("span", { class: "no-thumb" }), h("span", {}, camera.name)),
    iconButton(`Remove ${camera.name}`, "remove", () => app.change(`Remove ${camera.name}`, (p) => ({ ...p, cameras: p.cameras.filter((c) => c !== camera) }))))));
}

function save(app) {
  const camera = app.preview.camera;
  if (!camera) return;
  const name = freeName(`View ${app.project.cameras.length + 1}`, app.project.cameras.map((c) => c.name));
  app.change(`Keep ${name}`, (p) => ({ ...p, view: plain(camera), cameras: [...p.cameras, { name, ...plain(camera), thumb: app.preview.thumbnail() }] }));
}

function angle(app) {
  const camera = app.preview.camera, value = Math.round(camera?.angle || 70), out = h("output", {}, `${value}°`);
  const input = h("input", { id: "angle", type: "range", min: ANGLE_LEAST, max: ANGLE_MOST, step: 1, value, disabled: !camera,
    oninput: (e) => {
      out.textContent = `${e.target.value}°`;
      app.preview.move(angled(app.preview.camera, Number(e.target.value)));
    } });
  input.value = value;
  return h("div", { class: "field slider" }, h("label", { for: "angle" }, "How wide"), input, out);
}

/* Small pictures of the scene's own views, one after the other. */
function lookRound(app, names) {
  const { known } = app;
  if (known.views) return;
  known.views = {};
  app.attempt(async () => {
    for (const name of names) {
      if (app.known !== known) return; // it has been read anew
      const file = `${folderOf(app.project.model)}/views/${names.indexOf(name)}.png`;
      await app.runWell("retex-render", viewArgs(app.project, name, file), "Look from other places");
      known.views[name] = `${addressOf(file)}?${app.project.import.number || 0}`;
      app.tell();
    }
  });
}

const PICTURES_MOST = 8;

/* Views that the scene has, where there are several: as pictures, of many their names. then: after one is chosen. */
export function own(app, then = () => 0) {
  const cameras = app.preview.live?.cameras || [], { view } = app.project;
  if (!cameras.length) return null;
  const go = (name) => {
    const camera = cameras.find((c) => c.name === name);
    app.change(`Go to ${name ? spoken(name) : "the file's view"}`, (p) => ({ ...p, view: camera ? plain(camera) : null }));
    then();
  };
  const now = view ? cameras.find((c) => same(c, view))?.name : "";
  if (cameras.length > PICTURES_MOST) return field("Cameras of the file", choice("file-camera", [["", "choose one"], ...cameras.map((c) => [c.name, spoken(c.name)])], now || "", go));
  const names = ["", ...cameras.map((c) => c.name)];
  lookRound(app, names);
  return [h("h3", {}, "Views of the file"), h("ul", { class: "cameras", id: "own-views" }, names.map((name, k) => h("li", {},
    h("button", { type: "button", class: "camera", id: `own-view-${k}`, "aria-pressed": String(name === now), onclick: () => go(name) },
      app.known.views[name] ? h("img", { src: app.known.views[name], alt: "" }) : h("span", { class: "no-thumb" }), h("span", {}, name ? spoken(name) : "First view")))))];
}

export function render(app) {
  const brightness = h("input", { id: "brightness", type: "range", min: -4, max: 4, step: 0.25, oninput: (e) => app.preview.expose(Number(e.target.value)) });
  brightness.value = app.preview.stops;
  return [
    h("ul", { class: "keys" },
      h("li", {}, h("b", {}, "Drag"), " to look round"), h("li", {}, h("b", {}, "Wheel"), " to go nearer"),
      h("li", {}, h("b", {}, "Double click"), " to look there"),
      h("li", {}, h("kbd", {}, "W"), h("kbd", {}, "A"), h("kbd", {}, "S"), h("kbd", {}, "D"), " to walk, ", h("kbd", {}, "Q"), h("kbd", {}, "E"), " lower, higher"),
      h("li", {}, h("kbd", {}, "←"), h("kbd", {}, "→"), h("kbd", {}, "↑"), h("kbd", {}, "↓"), " to turn")),
    angle(app),
    h("div", { class: "field slider" }, h("label", { for: "brightness" }, "Brightness"), brightness, h("span", {})),
    field("Dragging", choice("drag-mode", [["", "as fits the place"], ["look", "turns my head"], ["round", "goes round the room"]], app.preview.mode || "", (m) => (app.preview.mode = m))),
    own(app),
    h("h3", {}, "Views to come back to"),
    saved(app),
    h("div", { class: "buttons" },
      button("Keep this view", () => save(app), { id: "keep-view", disabled: !app.preview.live }),
      button("Back to the file's view", () => app.change("Go to the file's view", (p) => ({ ...p, view: null })), { id: "own-view", disabled: !app.project.view })),
  ];
}

export const next = () => ({ label: "Choose surfaces", step: "surfaces" });
