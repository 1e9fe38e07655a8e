/* What a project is: plain data, and its history. Everything that the page lets one do is a change of it. */

const VERSION = 1;
export const TARGETS_MOST = 8;
export const LAMPS_MOST = 16;

/* What the page calls a lamp, of what -l takes: `Lamp`, or `light2=light_source#2` and `object7=#7` of lamps that have no
 * name in the scene. */
export function lampLabel(lamp) {
  const [, kind, number] = /=(light_source)?#(\d+)$/.exec(lamp) || [];
  return number ? `${kind ? "Light" : "Object"} ${number}` : lamp.split("=")[0];
}

/* What kind of file this is, by its name: a set is played as it is, a scene rendered, a model imported first. */
export function kindOf(path) {
  const ending = /\.([^./]+)$/.exec(path || "")?.[1].toLowerCase();
  if (!ending) return "other";
  if (ending === "pov" || ending === "ini") return "scene";
  if (ending === "exr" || ending === "retex") return "set";
  if (/^(gltf|glb|obj|fbx|dae|3ds|ply|stl|blend|dxf|lwo|x)$/.test(ending)) return "model";
  if (/^(jpe?g|png|webp|tiff?|tga|bmp|gif|hdr|avif)$/.test(ending)) return "picture";
  return "other";
}

export const emptyProject = (model) => ({
  "retex-studio": VERSION,
  model,
  import: {},
  view: null,
  cameras: [],
  targets: [],
  lamps: [],
  finishes: {},
  render: { width: 1280, height: 720, samples: 64, noise: 0, denoise: true },
  renders: [],
  textures: { folders: [], widths: {} },
  look: "",
  presets: [],
});

/* A project as it was read: what it lacks is as in a new one. The server has checked what is there. */
export const readProject = (value, model) => ({ ...emptyProject(model), ...value });

// ---- history: { past, present, future } of { project, label } ----

const STEPS_MOST = 200;

export const newHistory = (project) => ({ past: [], present: { project, label: "" }, future: [] });

/* One step. Steps of the same `merge`, one after the other, are one: a camera that is dragged. */
export function changed(history, label, project, merge = "") {
  if (project === history.present.project) return history;
  const isSame = merge && history.present.merge === merge;
  const past = isSame ? history.past : [...history.past, history.present].slice(-STEPS_MOST);
  return { past, present: { project, label, merge }, future: [] };
}

export function undone(history) {
  if (!history.past.length) return history;
  const present = { ...history.past.at(-1), merge: "" };
  return { past: history.past.slice(0, -1), present, future: [history.present, ...history.future] };
}

export function redone(history) {
  if (!history.future.length) return history;
  const [next, ...future] = history.future;
  return { past: [...history.past, history.present], present: { ...next, merge: "" }, future };
}

/* What has happened, such as a render that is complete, is in all steps: undoing does not undo it. */
export function amended({ past, present, future }, change) {
  const one = (step) => ({ ...step, project: change(step.project) });
  return { past: past.map(one), present: one(present), future: future.map(one) };
}

/* What undoing and redoing would change, for the buttons; "" where there is nothing. */
export const undoLabel = ({ past, present }) => (past.length ? present.label : "");
export const redoLabel = ({ future }) => (future.length ? future[0].label : "");

// ---- changes ----

/* A name that tools take: letters, digits, spaces and a few signs. */
function cleanName(text) {
  return text.normalize("NFC").replace(/[^\p{L}\p{N} _\-.+()]/gu, "_").trim().slice(0, 60);
}

/* The name, or with a number where the list has it. */
export function freeName(name, taken) {
  const plain = cleanName(name) || "Surface", has = (n) => taken.some((t) => t.toLowerCase() === n.toLowerCase());
  if (!has(plain)) return plain;
  let number = 2;
  while (has(`${plain} ${number}`)) number++;
  return `${plain} ${number}`;
}

/* What a surface is called at first: importers write Mesh_ and underscores. */
export const spoken = (name) => name.replace(/^Mesh_(?=.)/, "").replace(/_+/g, " ");

export function withTarget(project, surface) {
  if (project.targets.length >= TARGETS_MOST) {
    throw new Error(`A picture can have ${TARGETS_MOST} surfaces.`);
  }
  if (project.targets.some((t) => t.select === surface.text)) throw new Error("This surface is in the list already.");
  const name = freeName(spoken(surface.name || "Surface"), project.targets.map((t) => t.name));
  const target = { name, select: surface.text, uv: surface.uv || "", share: surface.share || 0 };
  return { ...project, targets: [...project.targets, target] };
}

export function withoutTarget(project, name) {
  const { [name]: _, ...finishes } = project.finishes;
  return { ...project, targets: project.targets.filter((t) => t.name !== name), finishes };
}

/* Its finishes follow a new name. */
export function withRenamed(project, name, wanted) {
  if (wanted === name || !cleanName(wanted)) return project;
  const others = project.targets.filter((t) => t.name !== name).map((t) => t.name), free = freeName(wanted, others);
  const finishes = Object.fromEntries(Object.entries(project.finishes).map(([n, f]) => [n === name ? free : n, f]));
  return { ...project, targets: project.targets.map((t) => (t.name === name ? { ...t, name: free } : t)), finishes };
}

/* Combinations of finishes, which 8 may be; with lamps, combinations times lamps 16. */
export function finishTrouble({ finishes, lamps }) {
  const chosen = Object.values(finishes).filter((f) => f.length > 1);
  const all = chosen.reduce((product, f) => product * f.length, 1);
  if (all > 8) return `These finishes make ${all} combinations; there can be 8. Take some away.`;
  if (all > 1 && lamps.length && all * (lamps.length + 1) > 16) {
    return `${all} combinations of finishes with ${lamps.length + 1} lights make ${all * (lamps.length + 1)} pictures; `
      + "there can be 16. Take some lamps or finishes away.";
  }
  return "";
}

/* Another state of the render of this set, in a list that may not have it. */
export const withRender = (project, set, state) =>
  ({ ...project, renders: project.renders.map((r) => (r.set === set ? { ...r, ...state } : r)) });
