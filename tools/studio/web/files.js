/* Files from outside: a model, alone or with what belongs to it, such as room.gltf with room.bin and pictures. */
import * as api from "./api.js";
import { kindOf } from "./project.js";

const MOST = 2000; // files of one drop
const depth = (path) => path.split("/").length;
const stem = (path) => path.split("/").at(-1).replace(/\.[^.]+$/, "");

/* What can be opened of a list of { path, file }: the uppermost. */
export function modelsOf(list) {
  const models = list.filter(({ path }) => ["model", "scene", "set"].includes(kindOf(path)));
  const least = Math.min(...models.map(({ path }) => depth(path)));
  return models.filter(({ path }) => depth(path) === least);
}

/* In a folder of its own: that which was dropped, or one of the model's name. */
export function inFolder(list, number = 1) {
  const tops = new Set(list.map(({ path }) => (path.includes("/") ? path.split("/")[0] : "")));
  const [only] = tops, mark = number > 1 ? `-${number}` : "";
  if (tops.size === 1 && only) return list.map((f) => ({ ...f, path: f.path.replace(/^[^/]+/, (top) => top + mark) }));
  return list.map((f) => ({ ...f, path: `${stem(modelsOf(list)[0].path)}${mark}/${f.path}` }));
}

/* Whether the server has kept a file under another name, since there was another one of this name. */
export const isRenamed = (wanted, kept) => stem(kept) !== stem(wanted) && /-\d+$/.test(stem(kept));

async function readFolder(entry, above, found) {
  if (found.length > MOST) throw new Error(`There are more than ${MOST} files. Drop the folder of the model alone.`);
  const path = `${above}${entry.name}`;
  if (entry.isFile) {
    found.push({ path, file: await new Promise((resolve, reject) => entry.file(resolve, reject)) });
    return;
  }
  const reader = entry.createReader();
  for (;;) {
    const entries = await new Promise((resolve, reject) => reader.readEntries(resolve, reject)); // some at a time
    if (!entries.length) return;
    for (const one of entries) await readFolder(one, `${path}/`, found);
  }
}

/* Of a drop, which has to be asked before anything else is waited for. */
export async function droppedFiles(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean), found = [];
  for (const entry of entries) await readFolder(entry, "", found);
  return found;
}

export const chosenFiles = (files) => [...files].map((file) => ({ path: file.webkitRelativePath || file.name, file }));

/* All into one folder; the paths of those that can be opened. The model is first, so that another of its name is met
 * before the rest is copied. */
async function putTogether(list, number) {
  const files = inFolder(list, number), models = modelsOf(files), paths = [];
  for (const { path, file } of [...models, ...files.filter((f) => !models.includes(f))]) {
    const kept = await api.uploadModel(path, file);
    if (isRenamed(path, kept)) return null;
    if (models.some((m) => m.path === path)) paths.push(kept);
  }
  return paths;
}

export async function putModel(list) {
  if (list.length === 1) return [await api.uploadModel(list[0].path.split("/").at(-1), list[0].file)];
  const files = list.filter(({ path }) => !/(^|\/)\./.test(path));
  for (let number = 1; number < 100; number++) {
    const paths = await putTogether(files, number);
    if (paths) return paths;
  }
  throw new Error("There are too many models of this name in the folder retex-studio.");
}
