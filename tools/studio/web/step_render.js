/* Render: the long computation, after which all else is immediate. */
import * as api from "./api.js";
import { cropArgs, folderOf, nextSet, renderArgs, settingsOf, TRIAL_SAMPLES, trialArgs } from "./commands.js";
import { button, check, choice, field, h, icon, iconButton, ICONS, numberField } from "./dom.js";
import { partPixels } from "./crop.js";
import { bytesText, durationText, estimate, trialOf } from "./estimate.js";
import { addressOf } from "./look.js";
import { withRender } from "./project.js";
import { errorReport } from "./words.js";

export const id = "render", title = "Render", hint = "The computer works out the light once. After that, other textures appear at once.";
export const isOpen = (app) => app.hasScene && app.project.targets.length + app.project.lamps.length > 0;
export const isDone = (app) => app.project.renders.some((r) => r.done);

const SIZES = [["640x360", "Draft, 640 × 360"], ["1280x720", "HD, 1280 × 720"], ["1920x1080", "Full HD, 1920 × 1080"], ["3840x2160", "4K, 3840 × 2160"],
  ["1080x1080", "Square, 1080 × 1080"], ["1080x1350", "Upright, 1080 × 1350"]];
const QUALITIES = [["8", "Sketch"], ["64", "Good"], ["256", "Fine"], ["1024", "Finest"]];

const put = (app, change) => app.change("Change the render", (p) => ({ ...p, render: { ...p.render, ...change } }));
const unfinished = (app) => app.project.renders.find((r) => !r.done);

const startRender = (app) => app.attempt(async () => {
  const set = nextSet(app.project), settings = settingsOf(app.project);
  app.amend((p) => ({ ...p, renders: [...p.renders, { set, settings, done: false, when: new Date().toISOString() }] }));
  await goOn(app, { set, settings });
});

/* From where it was, or from the start. */
async function goOn(app, { set, settings }) {
  app.amend((p) => withRender(p, set, { error: "" }));
  await app.saveNow();
  const job = await app.run("retex-render", renderArgs({ ...settings, model: app.project.model }, set), "Render");
  if (job.state === "failed") throw new Error(errorReport(job.lines, "The render").text);
}

/* Two small renders: a fifth and a third of the width, at few samples. */
const guess = (app) => app.attempt(async () => {
  const { render } = app.project, trials = [];
  app.known.guessing = true;
  app.tell();
  try {
    for (const part of [0.15, 0.3]) {
      const width = Math.max(48, Math.round(render.width * part)), pixels = width * Math.max(16, Math.round((width * render.height) / render.width));
      const folder = `${folderOf(app.project.model)}/trials`, file = `${folder}/trial.exr`;
      const text = await app.runWell("retex-render", trialArgs(app.project, width, file), "Try out");
      const { entries } = await api.getFolder(folder);
      trials.push(trialOf(text, pixels, TRIAL_SAMPLES, entries.find((e) => e.name === "trial.exr")?.bytes || 0));
    }
    app.known.estimate = { trials, key: keyOf(app) };
  } finally {
    app.known.guessing = false;
    app.tell();
  }
});

/* An estimate holds for other sizes and samples, not for other surfaces. */
const keyOf = ({ project: { targets, lamps, finishes } }) => JSON.stringify([targets, lamps, finishes]);

const partFile = (app) => `${folderOf(app.project.model)}/trials/part.png`;
const tryPart = (app) => app.attempt(async () => {
  const { crop } = app, args = cropArgs(app.project, partPixels(crop.part, app.project.render), partFile(app));
  const job = await app.run("retex-render", args, "Try a part");
  if (job.state === "failed") throw new Error(errorReport(job.lines, "The render").text);
  if (job.state !== "done") return;
  app.known.part = `${addressOf(partFile(app))}?${job.job}`;
  crop.show(app.known.part);
  app.tell();
});

/* The part that is drawn on the picture, rendered in full quality. */
function trial(app) {
  const job = app.jobOf(partFile(app)), [, , width, height] = partPixels(app.crop.part, app.project.render);
  return h("div", { class: "forecast" }, h("p", { class: "hint" }, `Draw a part on the picture to see it in this quality first: now ${width} × ${height} pixels.`),
    job ? [progressOf(job, "The part"), button("Stop", () => app.stop(job.job), { id: "stop-part", disabled: !!job.stopping })]
      : h("div", { class: "buttons" }, button("Try this part", () => tryPart(app), { id: "try-part" })),
    app.known.part ? h("img", { class: "part", src: app.known.part, alt: "The part at full size" }) : null);
}

function settings(app) {
  const { width, height, samples, noise, denoise } = app.project.render, size = `${width}x${height}`, own = !SIZES.some(([v]) => v === size) || app.ownSize;
  return [
    field("Size of the picture", choice("size", [...SIZES, ["own", "Own size…"]], own ? "own" : size, (value) => {
      app.ownSize = value === "own";
      if (value !== "own") put(app, { width: Number(value.split("x")[0]), height: Number(value.split("x")[1]) });
      else app.tell();
    })),
    own ? h("div", { class: "pair" }, field("Width", numberField("own-width", width, 16, 16384, (x) => put(app, { width: Math.round(x) }))),
      field("Height", numberField("own-height", height, 16, 16384, (x) => put(app, { height: Math.round(x) })))) : null,
    field("Quality", choice("quality", QUALITIES.some(([v]) => v === String(samples)) ? QUALITIES : [...QUALITIES, [samples, `${samples} samples`]], samples, (v) => put(app, { samples: Number(v) }))),
    check("denoise", "Remove the grain", denoise, (on) => put(app, { denoise: on })),
    h("details", { id: "more-render", open: !!app.moreOpen, ontoggle: (e) => (app.moreOpen = e.target.open) }, h("summary", {}, "More"),
      field("Samples a pixel", numberField("samples", samples, 1, 65536, (x) => put(app, { samples: Math.round(x) })), "More take longer and have less grain."),
      field("Stop where the noise is below", numberField("noise", noise, 0, 1, (x) => put(app, { noise: x }), 0.01), "0: all samples everywhere. 0.02 is smooth, 0.1 a sketch.")),
  ];
}

function told(app) {
  const known = app.known.estimate;
  return known?.key === keyOf(app) ? estimate(known.trials, app.project.render) : null;
}

function forecast(app) {
  const expected = told(app), least = app.project.render.noise > 0 ? "at most " : expected?.seconds >= 1 ? "about " : "";
  return h("div", { class: "forecast" },
    expected ? h("dl", {}, h("dt", {}, "Time"), h("dd", {}, (expected.seconds < 1 ? "" : least) + durationText(expected.seconds)), h("dt", {}, "Memory"), h("dd", {}, bytesText(expected.memory)), h("dt", {}, "On the disk"), h("dd", {}, bytesText(expected.bytes))) : null,
    h("div", { class: "buttons" },
      button(app.known.guessing ? "Trying out…" : "How long will it take?", () => guess(app), { id: "guess", disabled: !!app.known.guessing })));
}

/* What is left, by what was done; nothing before it is known. */
function remaining({ progress, seconds, stage }) {
  if (!(progress > 0.03) || !(seconds > 2) || (stage && stage !== "render")) return "";
  return `, ${durationText((seconds / progress) * (1 - progress))} left`;
}

export function progressOf(job, text) {
  const value = job.progress || 0, isWaiting = job.state === "waiting";
  return h("div", { class: "progress" }, h("progress", { max: 1, value, "aria-label": text }),
    h("span", {}, isWaiting ? "Waiting for another render" : `${job.stage === "denoise" ? "Removing grain" : text}: ${Math.round(100 * value)} %${remaining(job)}`));
}

function row(app, render) {
  const job = app.jobOf(render.set), expected = job && told(app), name = `Render ${/\/(\d+)\.exr$/.exec(render.set)?.[1] || ""}`;
  const { width, height } = render.settings.render, size = `${width} × ${height}`;
  const away = () => app.change(`Remove ${name}`, (p) => ({ ...p, renders: p.renders.filter((r) => r.set !== render.set) }));
  return h("li", { class: "card" }, h("div", {}, h("b", {}, name), h("small", {}, ` ${size}`),
    job ? [progressOf(job, "Rendering"), expected ? h("small", {}, `${bytesText(expected.memory)} of memory, ${bytesText(expected.bytes)} on the disk`) : null, button(job.stopping ? "Pausing…" : "Pause", () => app.stop(job.job), { id: `stop-${job.job}`, disabled: !!job.stopping }, "pause")]
      : render.done ? h("p", { class: "good" }, icon(ICONS.done), `Done${render.seconds ? ` in ${durationText(render.seconds)}` : ""}`)
        : [h("p", {}, render.error || `Paused${render.part ? ` at ${Math.round(100 * render.part)} %` : ""}. It goes on from there, also on another day.`),
          button("Go on", () => app.attempt(() => goOn(app, render)), { id: `go-on-${name}`, class: "primary" }, "go")]),
  job ? null : iconButton(`Remove ${name} from the list`, "remove", away));
}

export function render(app) {
  const { renders } = app.project;
  return [
    settings(app), forecast(app), trial(app),
    renders.length ? [h("h3", {}, "Renders"), h("ul", { class: "renders" }, [...renders].reverse().map((r) => row(app, r)))] : null,
  ];
}

export function next(app) {
  const open = unfinished(app), job = open && app.jobOf(open.set);
  if (job) return { label: "Rendering…", disabled: true, why: "You can go on looking round; or pause it, and go on another day." };
  const last = app.project.renders.at(-1);
  const isCurrent = last?.done && JSON.stringify(last.settings) === JSON.stringify(settingsOf(app.project));
  if (isCurrent) return { label: "Play with textures", step: "play" };
  return { label: app.project.renders.length ? "Render anew" : "Render", run: () => startRender(app) };
}

