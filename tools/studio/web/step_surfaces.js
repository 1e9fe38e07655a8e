/* Surfaces: what can be given other textures later. */
import { button, check, choice, field, h, icon, iconButton, ICONS } from "./dom.js";
import { CHIPS } from "./preview.js";
import { SCOPES, surfacesOf } from "./planes.js";
import { spoken, TARGETS_MOST, withoutTarget, withRenamed, withTarget } from "./project.js";

export const id = "surfaces", title = "Surfaces", hint = "Click what should get other textures: the floor, a wall, the sofa.";
export const isOpen = (app) => app.hasScene;
export const isDone = (app) => app.project.targets.length > 0;

const WORDS = {
  material: ["Material", "everything that is made of the same"],
  flat: ["Flat part", "this face alone, as far as it is flat"],
  level: ["Level", "all that lies in one plane, such as a floor of many boards"],
  object: ["Object", "the whole thing"],
};
const PROJECTIONS = [["", "automatic"], ["planar", "flat"], ["box", "around a box"], ["cylinder", "around a pillar"], ["model", "as the model says"]];
const percent = (share) => (share >= 0.01 ? `${Math.round(100 * share)} %` : "less than 1 %");

const FULL = `${TARGETS_MOST} surfaces are chosen, the most that a picture can have. Remove one to take another.`;

export const take = (app, surface) => app.attempt(async () => {
  if (app.project.targets.length >= TARGETS_MOST) return app.say(FULL, "error");
  if (!surface) throw new Error("There is nothing here that can be taken this way. Try another kind of “What a click takes”.");
  app.change(`Take ${surface.name || "a surface"}`, (p) => withTarget(p, surface));
  return app.say(`“${app.project.targets.at(-1).name}” is in the list. Give it a name you like.`);
});

function scopes(app) {
  const set = (scope) => {
    app.preview.setScope(scope);
    app.tell();
  };
  return h("fieldset", { class: "scopes" }, h("legend", {}, "What a click takes"),
    SCOPES.map((scope, k) => h("label", { class: "scope", for: `scope-${scope}` },
      h("input", { type: "radio", name: "scope", id: `scope-${scope}`, checked: app.preview.scope === scope, onchange: () => set(scope) }),
      h("span", {}, h("b", {}, WORDS[scope][0]), h("small", {}, WORDS[scope][1])), h("kbd", { title: "Key" }, k + 1))));
}

function row(app, target, k) {
  const chip = h("span", { class: "chip", "aria-hidden": "true" }, k + 1);
  chip.style.background = CHIPS[k % CHIPS.length];
  const name = h("input", { type: "text", id: `target-${k}`, value: target.name, "aria-label": `Name of surface ${k + 1}`, maxLength: 60,
    onchange: (e) => app.change("Rename a surface", (p) => withRenamed(p, target.name, e.target.value)) });
  const uv = choice(`uv-${k}`, PROJECTIONS, target.uv || "", (v) =>
    app.change("Change a surface's directions", (p) => ({ ...p, targets: p.targets.map((t) => (t === target ? { ...t, uv: v } : t)) })));
  uv.setAttribute("aria-label", `How pictures lie on ${target.name}`);
  return h("li", { class: "target" }, chip, name, h("span", { class: "share" }, target.share ? percent(target.share) : ""),
    iconButton(`Remove ${target.name}`, "remove", () => app.change(`Remove ${target.name}`, (p) => withoutTarget(p, target.name))),
    h("div", { class: "how" }, h("span", {}, "Pictures lie"), uv));
}

/* The same without a pointer. */
function seen(app) {
  const { surfaces, scope, live } = app.preview;
  if (!surfaces) return h("p", { class: "hint" }, live ? "Looking at what is there…" : "The preview is coming…");
  const taken = new Set(app.project.targets.map((t) => t.select));
  const list = surfacesOf(surfaces, scope).slice(0, 30);
  return h("details", { id: "seen", open: !!app.seenOpen, ontoggle: (e) => (app.seenOpen = e.target.open) },
    h("summary", {}, `Choose from a list (${list.length})`),
    h("ul", { class: "rows" }, list.map((s, k) => h("li", {}, h("button", { type: "button", class: "row", id: `seen-${k}`, disabled: taken.has(s.text),
      onclick: () => take(app, s), onfocus: () => app.preview.hoverSurface(s), onblur: () => app.preview.hoverSurface(null),
      onmouseenter: () => app.preview.hoverSurface(s), onmouseleave: () => app.preview.hoverSurface(null) },
    h("span", {}, s.name ? spoken(s.name) : s.text), h("small", {}, taken.has(s.text) ? "taken" : percent(s.share)))))));
}

export function render(app) {
  const { targets } = app.project;
  return [
    scopes(app), seen(app),
    h("h3", {}, `Chosen surfaces (${targets.length} of ${TARGETS_MOST} at most)`),
    targets.length ? h("ol", { class: "targets" }, targets.map((t, k) => row(app, t, k))) : h("p", { class: "empty" }, icon(ICONS.surfaces), "Nothing yet. Click a surface in the picture."),
    targets.length >= TARGETS_MOST ? h("div", { class: "card" }, icon(ICONS.warn), h("p", {}, FULL)) : null,
    targets.length ? [check("grid", "Show a grid of metres", !!app.grid, (on) => {
      app.grid = on;
      app.tell("step");
    }), app.grid ? h("p", { class: "hint" }, "Each field is a metre wide and high. Red: where pictures begin at the left; blue: at the bottom.") : null] : null,
  ];
}

export function next(app) {
  if (!app.project.targets.length) return { label: "Light and finishes", disabled: true, why: "Click at least one surface first." };
  return { label: "Light and finishes", step: "light" };
}
