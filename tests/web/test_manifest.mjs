/* The manifest of a room: what retex-web(5) describes is accepted, and everything else refused before it reaches shaders or
 * memory. */
import { fails, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

const file = (name) => ({ file: name, bytes: 10, crc32: 5 });
const manifest = () => ({
  retex_web: 1, width: 20, height: 10, filter: "box", finest: 2,
  picture: file("picture.jpg"),
  targets: [{ name: "Floor", share: 0.5, uv_min: [0, 0], uv_max: [1, 1], uv_scale: [1, 1], periodic: [0, 1] },
    { name: "Wall", share: 0.2, uv_min: [0, 0], uv_max: [1, 1], uv_scale: [0, 0], periodic: [0, 0] }],
  lights: [{ ...file("a.jpg"), white: 1.5, levels: 200, target: -1 }, { ...file("b.jpg"), white: 2, levels: 255, target: 1 }],
  reduced: { ...file("reduced.jpg"), tiles: [{ x: 0, y: 0, width: 10, height: 5, scale: 2, white: 1, levels: 255 }] },
  classes: [{ ...file("c.z"), kind: "sharp", target: 0, scale: 1, width: 20, height: 10, albedo: 1, spreads: 2, records: 200,
    footprints: [{ first: 0.1, per_octave: 4, sigma_first: -3, angle_steps: 0, weights: ["one", null] }] },
  { ...file("d.z"), kind: "interreflection", target: 1, scale: 2, width: 10, height: 5, albedo: 0, spreads: 3, records: 50,
    footprints: [{ first: 0.1, per_octave: 4, sigma_first: -3, angle_steps: 60, weights: [0.25, 0.5] }] }],
  mixtures: [[[0, 0]], [[1, 0]]],
  groups: [{ light: 0, mixture: 0, target: 0 }, { light: 1, mixture: -1, target: -1 }],
  terms: [{ group: 0, gain: -1, factors: [] }, { group: 1, gain: 0, factors: [1, 1] }],
});

const { checkManifest } = player();
const DAMAGED = "room.json is damaged.";

/* The manifest with a value at a path such as "classes.0.scale". */
function changed(path, value) {
  const room = manifest(), keys = path.split("."), last = keys.pop();
  keys.reduce((at, key) => at[key], room)[last] = value;
  return room;
}
const refused = (path, value) => fails(() => checkManifest(changed(path, value)), /damaged|undefined|null|iterable/, `${path} = ${JSON.stringify(value)}`);

test("a manifest as described is accepted, without reduced images too", () => {
  checkManifest(manifest());
  const room = manifest();
  Object.assign(room, { reduced: null, classes: room.classes.slice(0, 1), mixtures: room.mixtures.slice(0, 1), terms: room.terms.slice(0, 1) });
  checkManifest(room);
  checkManifest(changed("classes.0.records", 0));
  checkManifest(changed("lights.0.white", 1e-30));
  checkManifest(changed("lights.0.white", [1, 2, 3]));
});

test("parameters, which groups refer to", async () => {
  const parameters = [{ name: "Lamp", value: [1, 0.5, 2] }], lit = (changes) => ({ ...manifest(), parameters, ...changes });
  const group = (list) => ({ groups: [{ ...manifest().groups[0], parameters: list }, manifest().groups[1]] });
  checkManifest(lit());
  checkManifest(lit(group([0, 0])));
  for (const wrong of [group([1]), group([-1]), group([0.5]), group(0), group(Array(17).fill(0)), { parameters: 3 }, { parameters: Array(65).fill(parameters[0]) },
    { parameters: [{ value: [1, 1, 1] }] }, ...[[1, 1], [1, 1, 1, 1], [1, -1, 1], [1, "1", 1], 1, undefined].map((value) => ({ parameters: [{ name: "Lamp", value }] }))])
    await fails(() => checkManifest(lit(wrong)), /damaged|undefined/, JSON.stringify(wrong));
  await refused("groups.0.parameters", [0]);
});

test("the light of single lamps: an atlas of its own, whose terms are of groups and parameters", async () => {
  const parameters = [{ name: "Lamp", value: [0, 0, 0], kept: [1, 0.5, 2] }, { name: "Sky", value: [1, 1, 1], kept: [1, 1, 1], several: true }];
  const lamps = { ...file("lamps.jpg"), width: 24, height: 8, finest: 2, tiles: [{ x: 0, y: 0, width: 10, height: 5, scale: 2, white: 0.1, levels: 200 },
    { x: 16, y: 0, width: 5, height: 3, scale: 4, white: 1, levels: 255 }],
    terms: [{ group: 0, gain: 1, parameter: 1, factors: [] }, { group: 1, gain: 0, parameter: 0, factors: [1, 1] }, { group: 1, gain: -1, parameter: 0, factors: [] }] };
  checkManifest({ ...manifest(), parameters, lamps });
  const term = (changes) => ({ terms: [{ ...lamps.terms[1], ...changes }] }), tile = (changes) => ({ tiles: [lamps.tiles[0], { ...lamps.tiles[1], ...changes }] });
  for (const wrong of [{ file: "../x" }, { crc32: -1 }, { tiles: [] }, { tiles: 7 }, { terms: 7 }, { terms: Array(1025).fill(lamps.terms[0]) }, { finest: 3 }, { finest: 4 },
    { width: 20 }, { width: 0.5 }, { width: 4097 }, { height: 4 }, { height: undefined }, term({ group: 2 }), term({ gain: 2 }), term({ gain: -2 }), term({ parameter: 2 }), term({ parameter: -1 }),
    term({ parameter: undefined }), term({ factors: [0] }), term({ factors: [2] }), term({ factors: Array(17).fill(1) }), tile({ x: 20 }), tile({ y: -1 }), tile({ scale: 2 }), tile({ white: 0 }), tile({ white: [1, 1] })])
    await fails(() => checkManifest({ ...manifest(), parameters, lamps: { ...lamps, ...wrong } }), /damaged|undefined/, JSON.stringify(wrong));
  for (const wrong of [{ parameters: undefined }, { parameters: [parameters[0], { name: "Sky", value: [1, 1, 1] }] }, { parameters: [parameters[0], { ...parameters[1], kept: [1, -1, 1] }] }, { lamps: null }, { lamps: 5 }])
    await fails(() => checkManifest({ ...manifest(), parameters, lamps, ...wrong }), /damaged|undefined|null/, JSON.stringify(wrong));
});

test("finishes of targets, which parameters refer to", async () => {
  const part = (finishes, value = [1, 1, 1]) => ({ name: `light ${finishes}`, value, lamp: "Lamp", finishes });
  const shiny = ({ targets: of = {}, ...changes } = {}) => ({ ...manifest(), targets: [{ ...manifest().targets[0], finishes: ["matt", "satin"], finish: 1, ...of }, manifest().targets[1]],
    parameters: [part([0, 0]), part([1, 0]), part([2, 0]), { ...part([2, 0]), lamp: "" }], ...changes });
  checkManifest(shiny());
  checkManifest(shiny({ targets: { finishes: ["a", "b", "c", "d"], finish: 4 } }));
  checkManifest(shiny({ targets: { finishes: ["a", "b", "c"], finish: 1, normal_tilt: 15, finish_roughness: [1, 1, 1] } }));
  checkManifest(shiny({ targets: { finish_roughness: [-1, 0.25] } }));
  checkManifest(shiny({ parameters: undefined }));
  for (const targets of [{ finish: 3 }, { finish: 0 }, { finish: -1 }, { finish: "satin" }, { finish: undefined }, { finishes: ["matt"], finish: 1 }, { finishes: [], finish: 0 }, { finishes: "matt" }, { finishes: null },
    { normal_tilt: "15" }, { finishes: ["matt", 3] }, { finishes: ["a", "b", "c", "d", "e"] }, { finishes: undefined },
    { finish_roughness: [1] }, { finish_roughness: [0, 2] }, { finish_roughness: [0, "1"] }, { finish_roughness: 1 }])
    await fails(() => checkManifest(shiny({ targets })), DAMAGED, JSON.stringify(targets));
  for (const wrong of [part([3, 0]), part([-1, 0]), part([0.5, 0]), part(["1", 0]), part([1, 1]), part([1]), part([1, 0, 0]), part(1), part(undefined), { ...part([1, 0]), lamp: undefined }, { ...part([1, 0]), lamp: 3 }])
    await fails(() => checkManifest(shiny({ parameters: [part([0, 0]), wrong] })), DAMAGED, JSON.stringify(wrong));
  for (const key of ["lamp", "finishes"]) // of a room without finishes
    await fails(() => checkManifest({ ...manifest(), parameters: [{ name: "Lamp", value: [1, 1, 1], [key]: part([0, 0])[key] }] }), DAMAGED, key);
});

test("no factor is finer than what it is multiplied at", async () => {
  await fails(() => checkManifest({ ...manifest(), finest: 4, terms: [{ group: 1, gain: -1, factors: [1] }] }), DAMAGED);
  await fails(() => checkManifest({ ...manifest(), finest: 4, terms: [{ group: 1, gain: 0, factors: [] }] }), DAMAGED);
});

test("further hits, of reduced mixtures", async () => {
  const further = { hits: 9, ratio: [1, 0.5, 0], mixtures: [1] };
  checkManifest({ ...manifest(), further });
  for (const wrong of [{ hits: 256 }, { hits: -1 }, { hits: 0.5 }, { ratio: [1, 1] }, { ratio: [1, 1, 1, 1] }, { ratio: [1, "1", 1] }, { ratio: [1, -1, 1] }, { ratio: 1 },
    { mixtures: [2] }, { mixtures: [0] }, { mixtures: 1 }, { mixtures: undefined }])
    await fails(() => checkManifest({ ...manifest(), further: { ...further, ...wrong } }), /damaged|undefined/, JSON.stringify(wrong));
});

test("another version is told", async () => {
  for (const value of [undefined, 0, 2, "1"])
    await fails(() => checkManifest(changed("retex_web", value)), "room.json is of another version, or no room: write the folder again.");
  for (const value of [null, 3, "room"]) await fails(() => checkManifest(value), DAMAGED);
});

test("numbers out of their ranges", async () => {
  const wrong = {
    width: [0, 32769, 2.5, "20", null, NaN], height: [0, 32769, -1], finest: [0, 3, 16],
    "picture.bytes": [-1, 2 ** 31 + 1, 0.5], "picture.crc32": [-1, 2 ** 32, "5"],
    "targets.0.share": [-0.1, Infinity, "1"], "lights.0.white": [0, -1, Infinity, 1e31, [], [1, 2], [1, 2, 3, 4], [1, 0, 1], [1, 1, "1"], [1, [1], 1], {}], "lights.0.levels": [0.5, 256],
    "lights.0.target": [-2, 9, 0.5], "reduced.tiles.0.x": [-1, 4097, 0.5], "reduced.tiles.0.y": [-1, 4097],
    "reduced.tiles.0.white": [0], "reduced.tiles.0.levels": [0, 256],
    "classes.0.scale": [0, 3, 16, "1"], "classes.0.spreads": [1, 5], "classes.0.target": [-1, 2, 0.5], "classes.0.records": [-1, 201, 0.5],
    "classes.0.footprints.0.first": [-1, NaN], "classes.0.footprints.0.per_octave": [0, 1e-4], "classes.0.footprints.0.sigma_first": [-1e10, "3"],
    "classes.0.footprints.0.angle_steps": [-1], "groups.0.light": [-1, 2], "groups.0.mixture": [-2, 2], "groups.0.target": [-2, 9],
    "terms.0.group": [-1, 2], "terms.0.gain": [-2, 1], "mixtures.0.0.0": [-1, 2], "mixtures.0.0.1": [-1, 2],
  };
  for (const path in wrong) for (const value of wrong[path]) await refused(path, value);
});

test("sizes that do not belong together", async () => {
  await refused("classes.0.width", 19);
  await refused("classes.1.height", 6);
  await refused("reduced.tiles.0.width", 20);
  await refused("classes.0.albedo", 2); // of the lights
  await refused("classes.1.albedo", 1); // of the tiles
  await refused("mixtures.0", [[0, 0], [1, 0]]); // classes of two sizes
  await refused("mixtures.0", []);
  await refused("groups.0.mixture", 1); // of a smaller size
  await refused("terms.1.factors", [0]); // of the picture's size
  await refused("finest", 4); // smaller than a factor
});

test("names of files that lead elsewhere", async () => {
  for (const name of ["../a.jpg", "https://x.org/a.jpg", "a\\b", "C:a", 3, null]) {
    await refused("picture.file", name);
    await refused("lights.1.file", name);
    await refused("classes.0.file", name);
    await refused("reduced.file", name);
  }
});

test("lists that are too long, or none", async () => {
  const room = manifest();
  const longest = { targets: 8, lights: 256, "reduced.tiles": 2048, classes: 24, "classes.0.footprints": 16, "classes.0.footprints.0.weights": 2,
    mixtures: 96, groups: 128, terms: 1024, "terms.0.factors": 16 };
  for (const path in longest) {
    const one = path.split(".").reduce((at, key) => at[key], room)[0] ?? 1;
    await refused(path, Array(longest[path] + 1).fill(one));
    await refused(path, {});
  }
  await refused("targets", []);
  await refused("targets.0.name", 3);
  for (const key of ["uv_min", "uv_max", "uv_scale", "periodic"]) for (const value of [[1], [1, null], 1]) await refused(`targets.0.${key}`, value);
  for (const value of ["two", true, -1, Infinity]) await refused("classes.0.footprints.0.weights.0", value);
  same(manifest(), room);
});
