/* Texts of strangers, such as links, presets and projects, are read in time that grows as their length does: each regular
 * expression of the page's and the studio's modules, on texts that repeat what it looks for; and the readers of links. */
import { readFileSync, readdirSync } from "node:fs";
import { player } from "./player.mjs";
import { test } from "./tap.mjs";

const { OPTIONS, parseEdit, parseLamp, parsePreset, readColor } = player();
const FIRST = 320, LAST = 20480, NOTICED_MS = 30;

function milliseconds(read, text) {
  const begin = performance.now();
  try {
    read(text);
  } catch {
    // what is no such text is told
  }
  return performance.now() - begin;
}
/* Four times the length takes four times as long where time is linear, and sixteen where it grows by the square, which at
 * the last length is 200 ms or more. The fastest of three counts. */
function isLinear(read, make) {
  for (let length = FIRST, shorter = Infinity; length <= LAST; length *= 4) {
    const text = make(length);
    let time = milliseconds(read, text);
    if (time > NOTICED_MS) time = Math.min(time, milliseconds(read, text), milliseconds(read, text));
    if (time > NOTICED_MS && time > 8 * shorter) return false;
    shorter = time;
  }
  return true;
}
function check(what, read, texts) {
  const slow = texts.find(([head, word, tail]) => !isLinear(read, (length) => head + word.repeat(length / word.length) + tail));
  if (slow) throw new Error(`${what}: time grows faster than the text ${slow.map((part) => JSON.stringify(part)).join(" ")}`);
}

/* Heads, and words that are repeated, for an expression: pieces of its own text, and one of each class of characters. */
const LITERAL = /(?<=^|[=(,:!&|?{}[\s])\/(?![*\/])((?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^\/\\[\n])+)\/([gimsuvy]*)/gm;
function textsFor(source) {
  const pieces = source.replace(/\\[a-zA-Z]|\(\?[<:=!]*|[\\[\](){}|^$*+?]/g, " ").split(" ").filter(Boolean);
  const signs = [...new Set([...pieces.join("")].filter((c) => !/\w/.test(c)))].slice(0, 6), classes = [...new Set([" ", "0", "a", ".", ...signs])];
  const words = classes.flatMap((a) => classes.map((b) => (a === b ? a : a + b)));
  return ["", "0", "a", ...pieces.slice(0, 2), ...signs.slice(0, 2)].flatMap((head) => words.map((word) => [head, word, "\r!"]));
}

for (const folder of ["tools/web", "tools/studio/web"])
  test(`regular expressions of ${folder}`, () => {
    let count = 0;
    for (const file of readdirSync(folder).filter((name) => name.endsWith(".js")))
      for (const [literal, source, flags] of readFileSync(`${folder}/${file}`, "utf8").matchAll(LITERAL)) {
        let expression;
        try {
          expression = new RegExp(source, flags.replace("y", ""));
        } catch {
          continue; // a quotient, or a part of a text
        }
        count++;
        check(`${file}: ${literal}`, (text) => text.replace(expression, ""), textsFor(source));
      }
    if (count < 15) throw new Error(`only ${count} expressions were found`);
  });

const NUMBERS = [["", "9", "m"], ["1", "0", "e"], [".", "0", "x"], ["1e", "0", "x"], ["", " ", "x"], ["1", " ", "x"], ["1", " ", "m x"], ["1", "\t ", "mm!"], ["", "1,", ""], ["", "-", ""], ["", "m", " "], ["1,", "9", "m"], ["1m,", " ", "x"]];
for (const option of Object.keys(OPTIONS)) test(`values of ${option}`, () => check(option, (text) => parseEdit(`Floor=a.png;Floor.${option}=${text}`), NUMBERS));

test("the light of the picture", () => {
  for (const key of ["warmth", "exposure", "picture:exposure", "picture:view", "picture:white-balance"]) check(key, (text) => parseEdit(`${key}=${text}`), NUMBERS);
});
test("colours and lamps", () => {
  const colors = [...NUMBERS, ["#", "f", "g"], ["rgb", " ", "x"], ["rgb(", "9", "x"], ["srgb(", "1,", ")"], ["rgb(1,", " ", "1"], ["grey", "grey", ""]];
  check("a colour", readColor, colors);
  check("a lamp", parseLamp, [...colors, ["", "1*", "x"], ["", "*", ""], ["1", "0", "K"], ["", "+", "k"]]);
});
test("whole edits and presets", () => {
  const edits = [["", ";", ""], ["", "=", ""], ["", "%25", "=1"], ["", "a.", "=1"], ["over", ":", "=a"], ["", "a=b;", ""], ["light:", "a", "=1"], ["", "light:=1;", ""], ["a=", "../", "b"]];
  check("an edit", parseEdit, edits);
  check("a preset", (text) => parsePreset(JSON.stringify({ "retex-preset": 1, edit: text }), "http://a/b/", "http://a/"), edits);
});
