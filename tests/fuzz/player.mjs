/* Fuzzing of what the player reads, under Node: room.json, files of footprints, links and presets, and the bytes of
 * pictures. player.mjs SECONDS SEED FOLDER [KEEP], where FOLDER is one of `retex-pack --web`. What is broken is refused by
 * an Error with a sentence; what is accepted makes shaders, has the sizes that it promises, and texts of edits say the
 * same again. A finding is any other exception, or an input that takes longer than two seconds; it is kept in KEEP. */
import { readFileSync, writeFileSync } from "node:fs";
import { inflateSync } from "node:zlib";
import { random } from "../web/tap.mjs";
import { player } from "../web/player.mjs";

const [seconds, seed, folder, keep] = process.argv.slice(2);
const { checkManifest, factorShader, mixtureShader, pictureShader, decodeClass, mostBytes, isDamaged, parseEdit, parsePreset, editText } = player();
const next = random(Number(seed)), pick = (list) => list[next(0, list.length - 1)];

// ---- mutations ----

const ODD = [0, -1, 1, 0.5, -0.5, 2, 3, 7, 8, 255, 256, 4096, 65536, 2 ** 31, -(2 ** 31), 2 ** 53, 1e30, 1e308, -1e-30, null, true, "", "one",
  "x".repeat(300), "../a", "__proto__", "constructor", [], {}, [0], [1, 1, 1], [[0, 0]]];

/* Every place of a value within another: an object or a list, and the key there. */
function placesOf(value) {
  const places = [], visit = (of) => Object.keys(of).forEach((key) => {
    places.push([of, key]);
    if (of[key] && typeof of[key] === "object") visit(of[key]);
  });
  visit(value);
  return places;
}

function mutateValue(value) {
  let changed = structuredClone(value);
  for (let k = next(1, 3); k > 0; k--) {
    const places = placesOf(changed);
    if (!places.length) return changed;
    const [of, key] = pick(places), how = next(0, 4);
    if (how === 0) delete of[key];
    else if (how === 1 && Array.isArray(of)) of.splice(Number(key), 0, ...Array(next(1, 40)).fill(of[key]));
    else if (how === 2) of[key] = structuredClone(((at) => at[0][at[1]])(pick(places)));
    else if (how === 3 && typeof of[key] === "number") of[key] += pick([1, -1, 0.5, 100, -100]);
    else of[key] = structuredClone(pick(ODD));
    changed = JSON.parse(JSON.stringify(changed)); // without holes
  }
  return changed;
}

function mutateBytes(bytes) {
  let changed = [...bytes];
  for (let k = next(1, 4); k > 0 && changed.length; k--) {
    const at = next(0, changed.length - 1), how = next(0, 4);
    if (how === 0) changed[at] = next(0, 255);
    else if (how === 1) changed[at] ^= 1 << next(0, 7);
    else if (how === 2) changed.splice(at, next(1, 30));
    else if (how === 3) changed.splice(at, 0, ...changed.slice(at, at + next(1, 30)));
    else changed = changed.slice(0, at);
  }
  return Uint8Array.from(changed);
}

const WORDS = readFileSync("tests/data/edits.txt", "utf8").split(/[^\w.#:-]+/).filter(Boolean);
const EDITS = readFileSync("tests/data/edits.txt", "utf8").split("\n").filter((line) => /^[<>]/.test(line)).map((line) => line.slice(2));

function mutateText(text) {
  const tokens = text.match(/\w+|\W/gs) || [];
  for (let k = next(1, 4); k > 0; k--) {
    const at = next(0, tokens.length), how = next(0, 4);
    if (how === 0) tokens.splice(at, 1);
    else if (how === 1) tokens.splice(at, 0, pick(WORDS));
    else if (how === 2) tokens[at] = pick([...";&=.,:()#%-+*", "%25", "%3b", "1e999", "-0", "1e-9", "NaN", "\u0000", "\ud800", "é", "__proto__", "toString"]);
    else if (how === 3) tokens.splice(at, 0, ...tokens.slice(0, next(0, 40)));
    else tokens.splice(at, tokens.length, ...pick(EDITS).match(/\w+|\W/gs) || []);
  }
  return tokens.join("");
}

// ---- what must hold ----

/* As the player reads it: what is missing is damage, too. */
function isAccepted(room) {
  try {
    checkManifest(room);
    return true;
  } catch (error) {
    if (!(error instanceof TypeError) && error.constructor !== Error) throw error;
    return false;
  }
}

const must = (good, what) => { if (!good) throw new TypeError(`does not hold: ${what}`); };
const rooms = [JSON.parse(readFileSync(`${folder}/room.json`, "utf8"))];
const base = rooms[0].classes.map((info) => ({ info, data: inflateSync(readFileSync(`${folder}/${info.file}`)), periodic: rooms[0].targets[info.target].periodic }));
const pictures = [readFileSync(`${folder}/${rooms[0].picture.file}`), readFileSync("docs/pictures/scale.png"), Uint8Array.from([0x52, 0x49, 0x46, 0x46, 4, 0, 0, 0, 1, 2, 3, 4])];

function again(state) {
  const text = editText(state);
  must(editText(parseEdit(text)) === text, `an edit says the same again: ${text}`);
}

const KINDS = {
  room: {
    make: () => mutateValue(pick(rooms)),
    run(room) {
      if (!isAccepted(room)) throw new Error("refused");
      let layers = 0; // as the renderer counts them
      room.classes.forEach((c) => (c.layer = 0));
      room.mixtureLayers = room.mixtures.map((m) => (room.classes[m[0][0]].scale > 1 ? layers++ : -1));
      for (const c of room.classes) must(mostBytes(c) > 0 && Number.isSafeInteger(mostBytes(c)), "a class has a size");
      for (const text of [factorShader(room), mixtureShader(room, false), mixtureShader(room, true), pictureShader(room, false, true)])
        must(text == null || !/NaN|undefined|Infinity/.test(text), "shaders have numbers");
    },
  },
  class: {
    make: () => {
      const index = next(0, base.length - 1), c = base[index];
      return { ...c, index, info: next(0, 3) ? c.info : mutateValue(c.info), data: mutateBytes(c.data) };
    },
    run({ info, index, data, periodic }) {
      if (!isAccepted({ ...rooms[0], classes: rooms[0].classes.with(index, info) })) throw new Error("refused");
      const { heads, records, rows } = decodeClass(info, data, 0, periodic);
      must(heads.length === info.width * info.height && records.length === rows * 2048 * 4, "records have their size");
    },
  },
  edit: { make: () => mutateText(pick(EDITS)), run: (text) => again(parseEdit(text)) },
  preset: {
    make: () => { const text = JSON.stringify({ "retex-preset": 1, edit: mutateText(pick(EDITS)) }); return next(0, 3) ? text : mutateText(text); },
    run: (text) => again(parsePreset(text, "https://example.org/looks/a.json", "https://example.org/")),
  },
  picture: { make: () => mutateBytes(pick(pictures).subarray(0, next(4, 3000))), run: (bytes) => must(typeof isDamaged(bytes) === "boolean", "damage is told") },
};

// ---- the loop ----

const until = performance.now() + 1000 * seconds, told = new Map(), counts = {};
for (const kind of Object.keys(KINDS)) counts[kind] = [0, 0];
for (let k = 0; performance.now() < until; k++) {
  const kind = Object.keys(KINDS)[k % Object.keys(KINDS).length], { make, run } = KINDS[kind];
  const input = make(), began = performance.now();
  let wrong;
  try {
    run(input);
    counts[kind][1]++;
  } catch (error) {
    if (error.constructor !== Error || !error.message || /\n/.test(error.message)) wrong = error;
  }
  counts[kind][0]++;
  if (performance.now() - began > 2000) wrong = new Error("takes too long");
  const place = wrong && `${kind}: ${wrong.message.slice(0, 80)} ${(wrong.stack.split("\n")[1] || "").trim()}`;
  if (!wrong || told.has(place)) continue;
  told.set(place, input);
  console.log(place);
  if (keep) writeFileSync(`${keep}/player-${kind}-${seed}-${k}`, typeof input === "string" ? input : JSON.stringify(input));
}
console.log(`fuzz_player: seed ${seed}, ${Object.entries(counts).map(([kind, [n, taken]]) => `${n} of ${kind}, ${taken} accepted`).join("; ")}; ${told.size} findings`);
process.exit(told.size ? 1 : 0);
