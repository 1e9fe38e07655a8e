/* A project as command lines: those that the page runs are those that it shows. */
import { cameraText } from "./camera.js";
import { lookArgs, optionText, readLook } from "./look.js";
import { kindOf } from "./project.js";

/* Where what is made of a model lies. */
export const folderOf = (model) => `${model.replace(/^.*\//, "")}.studio`;
export const sceneOf = ({ model }) => (kindOf(model) === "scene" ? model : `${folderOf(model)}/scene/scene.pov`);
const rendersOf = (model) => `${folderOf(model)}/renders`;

/* The next free name of a set. */
export function nextSet({ model, renders }) {
  const numbers = renders.map((r) => Number(/\/(\d+)\.exr$/.exec(r.set)?.[1] || 0));
  return `${rendersOf(model)}/${Math.max(0, ...numbers) + 1}.exr`;
}

/* Pages of a set, of those too that were rendered elsewhere: what the step Play shows, and what is taken away. */
const wordOfSet = (set) => set.replace(/^.*\//, "").replace(/\.[^.]+$/, "");
export const pageOf = (model, set) => `${folderOf(model)}/pages/${wordOfSet(set)}`;
export const webOf = (model, set) => `${folderOf(model)}/web/${wordOfSet(set)}`;

export function importArgs({ model, import: how }) {
  const said = ["camera", "variant", "unit", "up", "lights", "sky"].filter((key) => how[key]);
  return [
    ...said.flatMap((key) => [`--${key}`, String(how[key])]),
    ...(how.partial ? ["--partial"] : []), "--force", "-o", `${folderOf(model)}/scene`, "--", model,
  ];
}

export const variantListArgs = ({ model }) => ["--list-variants", "--", model];

const selected = ({ name, select, uv }) => `${name}=${select}${uv ? `:uv=${uv}` : ""}`;
const targetArgs = ({ targets }) => targets.flatMap((t) => ["-t", selected(t)]);
const cameraArgs = ({ view }) => (view ? ["--camera", cameraText(view)] : []);
const lampArgs = ({ lamps }) => lamps.flatMap((lamp) => ["-l", lamp]);
const finishArgs = ({ finishes }) =>
  Object.entries(finishes).filter(([, f]) => f.length).flatMap(([target, f]) => ["--finish", `${target}=${f.join()}`]);

/* What the preview is started with: targets have their projections. Its camera moves by requests. */
export const liveArgs = (project) => targetArgs(project);

/* All that a render depends on: a list of renders keeps it, so that one that was stopped goes on as it began. */
export const settingsOf = ({ view, targets, lamps, finishes, render }) => ({ view, targets, lamps, finishes, render });

/* What is in the picture, and how well it is rendered. */
const contentArgs = (project) => [...targetArgs(project), ...lampArgs(project), ...finishArgs(project), ...cameraArgs(project)];
const qualityArgs = ({ samples, noise, denoise }) =>
  ["--spp", String(samples), ...(noise > 0 ? ["--noise", String(noise)] : []), ...(denoise && samples > 1 ? ["--denoise"] : [])];

export function renderArgs(project, set) {
  const { width, height } = project.render;
  return [...contentArgs(project), "--size", `${width}x${height}`, ...qualityArgs(project.render), "--resume",
    "--progress", "json", "-o", set, "--", sceneOf(project)];
}

/* A part of the picture at its full size, to look at: X, Y, width and height in pixels. */
export function cropArgs(project, [x, y, w, h], file) {
  const { width, height } = project.render;
  return [...contentArgs({ ...project, lamps: [], finishes: {} }), "--plain", "--size", `${width}x${height}`, "--crop",
    [x, y, w, h].join(), ...qualityArgs(project.render), "--progress", "json", "-o", file, "--", sceneOf(project)];
}

/* Small renders that tell what the large one will take. */
export const TRIAL_SAMPLES = 4;
export function trialArgs(project, width, file) {
  const height = Math.max(16, Math.round((width * project.render.height) / project.render.width));
  return [...contentArgs(project), "--size", `${width}x${height}`, ...qualityArgs({ ...project.render, samples: TRIAL_SAMPLES, noise: 0 }),
    "--stats", "-", "-q", "-o", file, "--", sceneOf(project)];
}

/* A small picture of what a camera of the scene sees; "": its first one. */
export const viewArgs = (project, camera, file) =>
  ["--plain", ...(camera ? ["--camera", camera] : []), "--size", "192x144", "--spp", "8", "-q", "-o", file, "--", sceneOf(project)];

export const lampListArgs = (project) => ["--list-lamps", ...cameraArgs(project), "--", sceneOf(project)];
export const finishListArgs = (project) => ["--list-finishes", "--", sceneOf(project)];
export const webArgs = (set, folder) => ["-q", "--web", folder, "--", set];
/* A page for others: with a look to begin with, and smaller rooms for small screens. A pack has none. */
export const maySmaller = (set) => !set.endsWith(".retex");
export const pageArgs = (set, folder, preset, smaller) =>
  ["-q", ...(preset ? ["--preset", preset] : []), ...(smaller ? ["--web-smaller", "2,4"] : []), "--web", folder, "--", set];
export const packArgs = (set, file) => ["-q", "-o", file, "--", set];
export const pictureArgs = (set, look, file, size = "") =>
  ["-q", ...lookArgs(look), ...(size ? ["--size", size] : []), "-o", file, "--", set];

const cell = (text) => (/[",\n;\t]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);

/* A table for --batch: a row for each texture on one target, the rest as it looks now. */
export function catalogueTable(target, textures, look) {
  const laid = readLook(look).textures.find((t) => t.target === target && !t.layer);
  const rows = textures.map(({ path, width, output }) => {
    const kept = (laid?.options || []).filter(([word]) => !["scale", "width", "at", "finish", "normal", "tiles"].includes(word));
    const options = optionText({ layer: 0, options: [...(width ? [["width", `${width}cm`]] : []), ...kept] });
    return [output, options ? `${options} ${path}` : /^[:+]|\s\+\s/.test(path) ? `./${path}` : path];
  });
  return [["output", target], ...rows].map((row) => row.map(cell).join(",")).join("\n") + "\n";
}

/* The look without the texture of one target, which a table has. */
export function lookWithout(look, target) {
  return look.split(/[;&]/).filter((s) => {
    const key = s.slice(0, s.indexOf("="));
    return key !== target && !(key.startsWith(`${target}.`) && !key.slice(target.length + 1).includes("."));
  }).join(";");
}
export const catalogueArgs = (set, table, root, rest) =>
  ["-q", ...lookArgs(rest), "--batch", table, "--batch-root", root, "--mkdir", "--keep-going", "--", set];

// ---- for people ----

/* A word of a shell; quotes only where it needs them. */
const shellWord = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);
export const shellLine = (tool, args) => [tool, ...args.map((a) => shellWord(a))].join(" ");

const withoutProgress = (args) => args.filter((a, i) => a !== "--progress" && args[i - 1] !== "--progress");

/* All that was done, in order: [{ title, line }]. They are run in the folder of the model. */
export function commandsOf(project) {
  const list = [], add = (title, tool, args) => list.push({ title, line: shellLine(tool, args) });
  if (kindOf(project.model) === "model") add("Make a scene of the model", "retex-import", importArgs(project));
  const done = project.renders.filter((r) => r.done).at(-1), set = kindOf(project.model) === "set" ? project.model : done?.set || nextSet(project);
  if (kindOf(project.model) !== "set") {
    add("Render", "retex-render", withoutProgress(renderArgs(done ? { ...done.settings, model: project.model } : project, set)));
  }
  const preset = project.look ? `${folderOf(project.model)}/look.json` : "", picture = pictureArgs(set, project.look, `${folderOf(project.model)}/picture.png`);
  add("Make the picture", "retex-combine", preset ? ["--save-preset", preset, ...picture] : picture);
  add("Make the page", "retex-pack", pageArgs(set, webOf(project.model, set), preset, maySmaller(set)));
  return list;
}
