/* Light: lamps and finishes that can be chosen after rendering. */
import { finishListArgs, lampListArgs } from "./commands.js";
import { button, check, h, icon, ICONS } from "./dom.js";
import { finishTrouble, lampLabel, LAMPS_MOST } from "./project.js";

export const id = "light", title = "Light", hint = "Choose what you want to change later without rendering again. You may leave all as it is.";
export const isOpen = (app) => app.hasScene && app.project.targets.length > 0;
export const isDone = (app) => app.project.lamps.length > 0 || Object.keys(app.project.finishes).length > 0;

/* " 68.40%  Daylight  rgb(5,5.6,6.3)" */
export const readLamps = (text) => text.split("\n").map((line) => /^\s*([\d.]+)%\s{2}(.+)/.exec(line)).filter(Boolean)
  .map(([, share, said]) => ({ name: said.split(/\s{2}/, 1)[0], share: Number(share) / 100 }));
/* "matt	built in" */
export const readFinishes = (text) => text.split("\n").map((line) => line.split("\t")).filter(([name]) => name).map(([name, from = ""]) => ({ name, from }));

const FINISH_WORDS = { matt: "matt", satin: "satin", polished: "polished", metal: "metal", original: "as it is now" };

/* Asked once for each scene. */
async function learn(app) {
  const [lamps, finishes] = [
    await app.runWell("retex-render", lampListArgs({ ...app.project, view: null }), "Look for lamps"),
    await app.runWell("retex-render", finishListArgs(app.project), "Look for finishes"),
  ];
  Object.assign(app.known, { lamps: readLamps(lamps), finishes: readFinishes(finishes) });
}

export function enter(app) {
  if (app.known.lamps || app.known.learning) return;
  app.known.learning = true;
  app.attempt(() => learn(app)).finally(() => {
    app.known.learning = false;
    app.tell();
  });
}

function lamps(app) {
  const known = app.known.lamps, chosen = app.project.lamps;
  if (!known) {
    return app.known.learning ? h("div", { class: "card" }, h("span", { class: "spinner" }), h("p", {}, "Looking for lamps…")) : button("Look for lamps", () => enter(app), { id: "learn" });
  }
  const list = known.filter((l) => l.name !== "rest");
  if (!list.length) return h("p", { class: "hint" }, "This scene has no lamps that can be changed.");
  const put = (names) => app.change("Change the lamps", (p) => ({ ...p, lamps: names.slice(0, LAMPS_MOST) }));
  const toggle = (name) => (on) => put(on ? [...chosen, name] : chosen.filter((l) => l !== name));
  const lamp = (l, k) => h("li", {}, check(`lamp-${k}`, lampLabel(l.name), chosen.includes(l.name), toggle(l.name)), h("small", {}, `${Math.round(100 * l.share)} % of the light`));
  const all = list.every((l) => chosen.includes(l.name));
  return [h("ul", { class: "lamps" }, list.map(lamp)),
    list.length > 1 ? button(all ? "None of them" : "All of them", () => put(all ? [] : list.map((l) => l.name)), { id: "all-lamps" }) : null];
}

function finishes(app) {
  const known = app.known.finishes || [];
  return app.project.targets.map((target, k) => {
    const chosen = app.project.finishes[target.name] || [];
    const toggle = (name) => (on) => app.change(`Change the finishes of ${target.name}`, (p) => {
      const list = on ? [...chosen, name] : chosen.filter((f) => f !== name), { [target.name]: _, ...others } = p.finishes;
      return { ...p, finishes: list.length ? { ...others, [target.name]: list.slice(0, 4) } : others };
    });
    return h("fieldset", { class: "finishes" }, h("legend", {}, target.name),
      known.map((f, j) => check(`finish-${k}-${j}`, FINISH_WORDS[f.name] || f.name, chosen.includes(f.name), toggle(f.name), { disabled: !chosen.includes(f.name) && chosen.length >= 4 })));
  });
}

export function render(app) {
  const trouble = finishTrouble(app.project);
  return [
    h("h3", {}, "Lamps to change later"), h("p", { class: "hint" }, "Each can be made brighter, darker or of another colour, and turned off."), lamps(app),
    h("h3", {}, "Finishes to choose from later"), h("p", { class: "hint" }, "Such as a floor that is matt or polished. Choose two or more for a surface; rendering takes longer with each."),
    finishes(app),
    trouble ? h("div", { class: "card bad", role: "alert" }, icon(ICONS.warn), h("p", {}, trouble)) : null,
  ];
}

export function next(app) {
  const trouble = finishTrouble(app.project);
  return trouble ? { label: "Render", disabled: true, why: trouble } : { label: "Go on to rendering", step: "render" };
}
