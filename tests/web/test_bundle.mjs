/* The script that pages load, as `make` makes it of the modules. */
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { fileURLToPath, pathToFileURL } from "node:url";
import { same, test } from "./tap.mjs";

const build = process.env.BUILD || "build", file = `${build}/gen/retex-room.js`, script = readFileSync(file, "utf8");
const sources = fileURLToPath(new URL("../../tools/web/", import.meta.url)), url = pathToFileURL(file);

test("the comment with the licence is on top, and what is below is one small module", () => {
  const [head, body] = script.split(/(?<=\*\/\n)/);
  same([head.startsWith("/*! <retex-room "), head.includes("Apache-2.0")], [true, true]);
  same(/^\s*(import|\/\/|\/\*)|\bimport\s*[({"]|\brequire\(|sourceMappingURL/m.test(body), false, "imports, comments, maps");
  const whole = readdirSync(sources).filter((name) => name.endsWith(".js")).reduce((sum, name) => sum + readFileSync(sources + name).length, 0);
  if (script.length > 0.75 * whole) throw new Error(`${script.length} bytes of ${whole}`);
});

test("a server that renders pages may import it, which has the element and defines none", async () => {
  const { RetexRoom, ...others } = await import(`${url}?server`);
  same(others, {});
  same([typeof RetexRoom, RetexRoom.observedAttributes], ["function", ["src"]]);
});

test("a page has the element, once", async () => {
  const defined = new Map();
  globalThis.HTMLElement = class {};
  globalThis.customElements = { get: (name) => defined.get(name), define: (name, element) => {
    if (defined.has(name)) throw new Error(`${name} is there already`);
    defined.set(name, element);
  } };
  const { RetexRoom } = await import(`${url}?page`);
  await import(`${url}?again`);
  same([[...defined.keys()], defined.get("retex-room") === RetexRoom, RetexRoom.prototype instanceof HTMLElement], [["retex-room"], true, true]);
});

test("it is the same bytes wherever it is made", () => {
  const folder = mkdtempSync(`${tmpdir()}/bundle-`), { MAKEFLAGS, MFLAGS, MAKELEVEL, ...env } = process.env;
  mkdirSync(`${folder}/other`);
  copyFileSync(`${build}/config.mk`, `${folder}/other/config.mk`); // not to look for the libraries again
  execFileSync("make", ["-s", `BUILD=${folder}/other`, `${folder}/other/gen/retex-room.js`], { env, stdio: "pipe" });
  same(readFileSync(`${folder}/other/gen/retex-room.js`, "utf8") === script, true);
  rmSync(folder, { recursive: true });
});

/* Shaders are put together of other modules' texts while modules are loaded: in a circle, some would not be there yet. */
test("modules do not import each other in a circle", () => {
  const imports = (name) => [...readFileSync(sources + name, "utf8").matchAll(/\bfrom "\.\/([^"]+)";/g)].map((match) => match[1]);
  const visit = (name, above) => {
    if (above.includes(name)) throw new Error([...above, name].join(" -> "));
    if (seen.has(name)) return;
    for (const other of imports(name)) visit(other, [...above, name]);
    seen.add(name);
  }, seen = new Set();
  visit("element.js", []);
  same([...seen].sort(), readdirSync(sources).filter((name) => name.endsWith(".js")).sort(), "all are of the player");
});
