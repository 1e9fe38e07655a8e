/* Tests for Node, printed as TAP: test(NAME, BODY) for each, in order; a body that throws has failed. */
import { isDeepStrictEqual } from "node:util";

let number = 0, last = Promise.resolve();

export function test(name, body) {
  last = last.then(async () => {
    number++;
    try {
      await body();
      console.log(`ok ${number} - ${name}`);
    } catch (error) {
      console.log(`not ok ${number} - ${name}`);
      console.log(String(error.stack).replace(/^/gm, "# "));
    }
  });
}

process.on("beforeExit", () => {
  if (!number) return;
  console.log(`1..${number}`);
  number = 0;
});

const text = (value) => JSON.stringify(value, (_, x) => (typeof x === "number" && !Number.isFinite(x) ? String(x) : x));

export function same(found, expected, what = "") {
  if (!isDeepStrictEqual(found, expected)) throw new Error(`${what}: ${text(found)} instead of ${text(expected)}`);
}

/* Numbers, or lists of them, that differ by at most `most`. */
export function near(found, expected, most, what = "") {
  if (Array.isArray(expected)) {
    same(found.length, expected.length, `${what}, length`);
    expected.forEach((x, i) => near(found[i], x, most, `${what}[${i}]`));
  } else if (!(Math.abs(found - expected) <= most)) {
    throw new Error(`${what}: ${found} instead of ${expected}`);
  }
}

export async function fails(action, message, what = "") {
  try {
    await action();
  } catch (error) {
    if (error.message !== message && !(message instanceof RegExp && message.test(error.message))) throw error;
    return;
  }
  throw new Error(`${what}: no error, instead of: ${message}`);
}

/* Random numbers of a fixed seed: whole ones from low to high. */
export function random(seed) {
  let state = seed >>> 0;
  return (low, high) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return low + Math.floor((state / 2 ** 32) * (high - low + 1));
  };
}
