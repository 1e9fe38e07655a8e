// ---- folders: a texture of several files, by their names as in retex-edit(5) ----

const KINDS = { diff: "c", diffuse: "c", col: "c", color: "c", colour: "c", basecolor: "c", basecolour: "c", albedo: "c", rough: "r", roughness: "r", gloss: "g", glossiness: "g", arm: "p", orm: "p" };
const texelsOf = (word) => {
  const [, digits, rest] = /^(\d{1,6})(k|x\d*|)$/.exec(word) || [], n = Number(digits);
  return !digits ? 0 : rest === "k" ? 1024 * n : rest ? n : n < 128 || n & (n - 1) ? 0 : n;
};
const isFormat = (word) => /^(jpe?g|png|exr|tiff?|(8|16|32)bit)$/.test(word);

/* What a file is by its name: colour, roughness, gloss, packed; and what tells two forms of one map apart from two maps. */
function readName(name) {
  const [, stem, ending] = /^(.*)\.(jpe?g|jpe|jfif|png|webp|avif|gif|bmp)$/i.exec(name) || [];
  const words = (stem || "").toLowerCase().split(/[^a-z0-9\u0080-\uffff]+/).filter(Boolean), texels = words.map(texelsOf);
  const kind = KINDS[words.filter((word, k) => !texels[k] && !isFormat(word) && !/^\d+$/.test(word)).pop()];
  return { kind, name, key: words.filter((word, k) => !texels[k] && !isFormat(word)).join("_"), texels: Math.max(0, ...texels), lossy: /^j/i.test(ending) };
}

/* The best forms of files of a kind, by key. */
function bestOf(files, kind) {
  const best = new Map(), better = (a, b) => a.texels - b.texels || b.lossy - a.lossy || (a.name < b.name ? 1 : -1);
  for (const file of files) if (file.kind === kind && !(best.has(file.key) && better(best.get(file.key), file) > 0)) best.set(file.key, file);
  return [...best.values()].sort((a, b) => (a.key < b.key ? -1 : 1));
}

/* The base colour of a folder's files, and the map of roughness if there is one: { color, rough, channel }. */
export function readFolder(files) {
  const named = files.map((file) => ({ ...readName(file.name), file })), colors = bestOf(named, "c");
  if (!colors.length) throw new Error("None of these files is a base colour by its name, such as wood_diff_2k.jpg or wood_Color.png.");
  if (colors[1]) throw new Error(`Several base colours, such as ${colors[0].name} and ${colors[1].name}: choose one of them.`);
  const maps = ["r", "g", "p"].map((kind) => bestOf(named, kind)).find((list) => list.length) || [];
  return { color: colors[0].file, rough: maps.length === 1 ? maps[0].file : null, channel: maps[0]?.kind === "p" ? [0, 1, 0, 0] : [1, 0, 0, maps[0]?.kind === "g" ? 1 : 0] };
}

/* Whether roughness chooses among a target's finishes: that of two is known. */
export const hasRoughness = ({ finish_roughness: known = [], normal_tilt: tilt }) => !tilt && known.filter((x) => x >= 0).length > 1;

/* All files that were dropped, those of folders too, and of folders `textures` in them. To be called before the event ends. */
export async function droppedFiles({ items, files }) {
  const entries = [...items].map((item) => item.webkitGetAsEntry?.()), found = [];
  if (!entries.some((entry) => entry?.isDirectory)) return [...files];
  const add = async (entry, depth) => {
    if (found.length > 1000 || entry.name[0] === ".") return;
    if (entry.isFile) return void found.push(await new Promise((done, failed) => entry.file(done, failed)));
    if (depth > 1 || (depth && entry.name.toLowerCase() !== "textures")) return;
    const reader = entry.createReader();
    for (let some; (some = await new Promise((done, failed) => reader.readEntries(done, failed))).length; ) for (const inner of some) await add(inner, depth + 1);
  };
  for (const entry of entries) if (entry) await add(entry, 0);
  return found;
}
