/*! The page of retex studio. Licence: Apache-2.0. */
/* Steps on the left, the picture in the middle, one next thing to do. */
import { App } from "./app.js";
import { bar, endedText, foreignText, quitText } from "./bar.js";
import { Crop } from "./crop.js";
import { button, h, icon, iconButton, ICONS, refill } from "./dom.js";
import { droppedFiles } from "./files.js";
import { HELP } from "./help.js";
import { Player } from "./player.js";
import { Preview } from "./preview.js";
import { SCOPES } from "./planes.js";
import { redoLabel, spoken, undoLabel } from "./project.js";
import * as open from "./step_open.js";
import * as view from "./step_view.js";
import * as surfaces from "./step_surfaces.js";
import * as light from "./step_light.js";
import * as render from "./step_render.js";
import * as play from "./step_play.js";
import * as take from "./step_take.js";

const STEPS = [open, view, surfaces, light, render, play, take];
const WHY = { view: "Open a model first.", surfaces: "Open a model first.", light: "Choose a surface first.", render: "Choose a surface first.", play: "Render first.", take: "Render first." };
const $ = (selector) => document.querySelector(selector);

const app = new App();
const preview = (app.preview = new Preview(app, { canvas: $("#picture"), overlay: $("#overlay"), label: $("#picture-note") }));
const player = (app.player = new Player(app, $("#player"), (files, target) => play.takeFiles(app, files, target)));
app.crop = new Crop($("#crop"), $("#crop-frame"), () => {
  app.known.part = "";
  draw();
});
const current = () => STEPS.find((s) => s.id === app.step);
const isOpen = (step) => !step.isOpen || step.isOpen(app);
const isPlaying = () => ["play", "take"].includes(app.step);

// ---- drawing ----

function drawSteps() {
  refill($("#steps"), STEPS.map((step, k) => {
    const done = step.isDone(app), now = step.id === app.step, usable = isOpen(step);
    return h("li", {}, h("button", { type: "button", id: `step-${step.id}`, class: "step", "aria-current": now ? "step" : null, "aria-disabled": String(!usable), title: usable ? "" : WHY[step.id],
      onclick: () => (usable ? app.go(step.id) : app.say(WHY[step.id], "hint")) },
    icon(ICONS[step.id]), h("span", {}, h("span", { class: "quiet" }, `Step ${k + 1}: `), step.title), done ? h("span", { class: "tick" }, icon(ICONS.done), h("span", { class: "quiet" }, " done")) : null));
  }));
}

function drawPanel() {
  const step = current();
  $("#panel-title").textContent = step.title;
  $("#panel-hint").textContent = step.hint;
  refill($("#panel-body"), step.render(app));
  refill($("#help"), HELP[step.id].map((text) => h("p", {}, text)));
  const next = step.next(app);
  refill($("#next"), next ? [
    button(next.label, () => (next.step ? app.go(next.step) : next.run()), { id: "next-button", class: "primary", disabled: !!next.disabled }),
    next.why ? h("p", { class: "hint" }, next.why) : null,
  ] : open.chooser(app, "Choose a model…"));
}

function drawTop() {
  const undo = undoLabel(app.history), redo = redoLabel(app.history);
  $("#title").textContent = app.model ? app.model.name : "";
  const saved = app.lost ? "Not connected" : { saved: "All is saved", saving: "Saving…", unsaved: "Not saved" }[app.saved];
  $("#saved").textContent = app.model ? saved : "";
  Object.assign($("#undo"), { disabled: !undo, title: undo ? `Undo: ${undo}` : "Nothing to undo" });
  Object.assign($("#redo"), { disabled: !redo, title: redo ? `Do again: ${redo}` : "Nothing to do again" });
  const job = [...app.jobs.values()].find((j) => j.state === "running");
  refill($("#job"), job && app.step !== "render" ? render.progressOf(job, job.label) : []);
}

function drawStage() {
  const shows = isPlaying() && app.set ? "player" : app.hasScene || (app.importing && preview.last) ? "preview" : "welcome";
  Object.assign(document.body.dataset, { stage: shows, step: app.step });
  for (const name of ["welcome", "preview", "player"]) $(`#stage-${name}`).hidden = name !== shows;
  $("#player-wait").hidden = !!player.room;
  $("#smooth").setAttribute("aria-pressed", String(preview.smooth));
  $("#pause").setAttribute("aria-pressed", String(!!app.paused));
  preview.fit();
}

const showDialog = (dialog, shows) => shows !== dialog.open && (shows ? dialog.showModal() : dialog.close());

function drawBar() {
  const body = bar(app), place = $("#bar"), key = body ? body.map((e) => e.outerHTML).join() : "";
  place.hidden = !body;
  if (key !== place.dataset.key) refill(place, body || []); // not to be read again by screen readers
  place.dataset.key = key;
  showDialog($("#conflict"), !!app.conflict && !app.lost);
  if (app.foreign && !$("#foreign").open) refill($("#foreign-text"), foreignText(app));
  showDialog($("#foreign"), !!app.foreign && !app.ended && !app.lost);
  if (app.ended && !$("#ended").open) refill($("#ended-text"), endedText(app));
  showDialog($("#ended"), !!app.ended);
}

let frame = 0;
function draw() {
  frame ||= requestAnimationFrame(() => {
    frame = 0;
    drawTop();
    drawSteps();
    drawPanel();
    drawStage();
    drawBar();
  });
}

// ---- messages ----

function showMessage({ detail: { text, kind, action } }) {
  const close = () => message.remove();
  const message = h("div", { class: `message ${kind}`, role: kind === "error" ? "alert" : "status" }, icon(ICONS[{ error: "warn", hint: "help" }[kind] || "done"]), h("span", {}, text),
    action ? button(action.label, () => {
      close();
      app.attempt(action.run);
    }) : null, iconButton("Close this message", "close", close));
  const list = $("#messages");
  if (kind !== "error") for (const old of list.querySelectorAll(".message:not(.error)")) old.remove();
  for (const old of list.querySelectorAll(".error")) if (old.querySelector("span").textContent === text) old.remove();
  list.append(message);
  if (kind !== "error") setTimeout(close, 6000);
}

// ---- the preview follows the project ----

let started = "";
function followPreview() {
  if (app.foreign) return;
  if (!app.hasScene || isPlaying()) {
    if (started && isPlaying()) preview.send("stop").catch(() => 0);
    return;
  }
  started = "yes";
  preview.want({ surfaces: app.step === "surfaces", grid: app.step === "surfaces" && !!app.grid });
  if (!app.paused) app.attempt(() => preview.start());
}

let shown = "";
function enterStep() {
  if (shown === app.step) return followPreview();
  shown = app.step;
  current().enter?.(app);
  followPreview();
  $("#panel").scrollTop = 0;
  return undefined;
}

app.addEventListener("change", () => {
  draw();
  const { project } = app, key = JSON.stringify([app.hasScene && project.import.number, project.view, project.targets.map((t) => [t.select, t.uv]), project.render.width / project.render.height]);
  if (key !== app.previewKey) {
    app.previewKey = key;
    app.known.part = "";
    app.crop.show("");
    followPreview();
  } else preview.drawOverlay();
});
app.addEventListener("step", () => {
  draw();
  enterStep();
});
app.addEventListener("opened", () => preview.end());
app.addEventListener("again", () => followPreview());
app.addEventListener("rendered", () => app.say("The render is complete.", "note"));
app.addEventListener("message", showMessage);
preview.addEventListener("live", draw);
preview.addEventListener("surfaces", draw);
preview.addEventListener("pick", ({ detail }) => surfaces.take(app, detail));
preview.addEventListener("hover", () => {
  const surface = preview.hovered;
  $("#under").hidden = !surface;
  if (surface) $("#under").textContent = surface.name ? spoken(surface.name) : surface.text;
});

// ---- keys, buttons, files ----

const isText = (element) => /^(INPUT|SELECT|TEXTAREA)$/.test(element.tagName) && !/^(checkbox|radio|range|file)$/.test(element.type);
addEventListener("keydown", (event) => {
  const place = event.composedPath()[0];
  if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !isText(place)) {
    event.preventDefault();
    if (event.shiftKey) app.redo();
    else app.undo();
  } else if (!event.ctrlKey && !event.altKey && !event.metaKey && app.step === "surfaces" && /^[1-4]$/.test(event.key) && !isText(place)) {
    preview.setScope(SCOPES[event.key - 1]);
    draw();
  }
});
$("#undo").addEventListener("click", () => app.undo());
$("#redo").addEventListener("click", () => app.redo());
$("#undo").append(icon(ICONS.undo));
$("#redo").append(icon(ICONS.redo));
$("#help-button").append(icon(ICONS.help));
$("#help-button").addEventListener("click", () => {
  $("#help").hidden = !$("#help").hidden;
  $("#help-button").setAttribute("aria-expanded", String(!$("#help").hidden));
});
$("#smooth").append(icon(ICONS.smooth));
$("#smooth").addEventListener("click", () => app.attempt(() => preview.setSmooth(!preview.smooth)).then(draw));
$("#pause").append(icon(ICONS.pause));
$("#pause").addEventListener("click", () => app.attempt(() => preview.pause(!app.paused)).then(draw));
$("#take-over").addEventListener("click", () => app.attempt(() => app.takeOver()));
$("#reload").addEventListener("click", () => app.attempt(() => app.load()));
for (const id of ["#conflict", "#ended", "#foreign"]) {
  $(id).addEventListener("cancel", (event) => event.preventDefault());
  $(id).addEventListener("close", draw); // a second Escape closes it all the same: then it comes again
}
$("#foreign-open").addEventListener("click", () => app.attempt(async () => {
  await app.trust();
  open.begin(app);
}));
$("#foreign-end").addEventListener("click", () => app.attempt(() => app.quit()));
$("#quit-button").append(icon(ICONS.quit));
$("#quit-button").addEventListener("click", () => {
  refill($("#quit-text"), quitText(app));
  $("#quit").showModal();
});
$("#quit-stay").addEventListener("click", () => $("#quit").close());
$("#quit-end").addEventListener("click", () => {
  $("#quit").close();
  app.attempt(() => app.quit());
});

const stage = $("#stage");
const draggedPath = (event) => event.dataTransfer.types.includes("text/retex-path");
stage.addEventListener("dragover", (event) => {
  if (isPlaying() && !draggedPath(event)) return; // files are the player's
  event.preventDefault();
  stage.classList.add("drop");
});
stage.addEventListener("dragleave", (event) => stage.contains(event.relatedTarget) || stage.classList.remove("drop"));
addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
  event.preventDefault();
  stage.classList.remove("drop");
});
stage.addEventListener("drop", (event) => {
  event.preventDefault();
  stage.classList.remove("drop");
  if (draggedPath(event)) {
    const { room } = player, index = room?.targetAt?.(event.clientX, event.clientY) ?? -1;
    play.dropPath(app, event.dataTransfer.getData("text/retex-path"), index >= 0 ? room.targets[index] : player.target);
  } else if (!isPlaying() && event.dataTransfer.files.length) {
    const files = droppedFiles(event.dataTransfer);
    app.attempt(async () => open.openFiles(app, await files));
  }
}, true);

addEventListener("pagehide", () => app.saveLast());
addEventListener("beforeunload", (event) => {
  if (!app.canLeave) event.preventDefault();
});
document.addEventListener("visibilitychange", () => {
  if (!preview.live || isPlaying() || app.paused) return;
  if (document.hidden) preview.send("stop").catch(() => 0);
  else preview.settle().catch(() => 0);
});

app.attempt(() => app.load()).then(() => {
  app.listen();
  if (app.model) open.begin(app);
  else app.go("open");
});
