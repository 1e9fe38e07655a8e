/* The scripts that pages load, as `make` makes them of the modules. */
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { fileURLToPath, pathToFileURL } from "node:url";
import { same, test } from "./tap.mjs";

const build = process.env.BUILD || "build", url = pathToFileURL(`${build}/gen/retex-room.js`);
const folderOf = (path) => fileURLToPath(new URL(`../../tools/${path}/`, import.meta.url));
const made = (name) => readFileSync(`${build}/gen/${name}`, "utf8");
const SCRIPTS = [ // head: how its comment begins; imports: of addresses that are not known before
  { name: "retex-room.js", sources: folderOf("web"), first: "element.js", head: "/*! <retex-room ", imports: 0 },
  { name: "studio.js", sources: folderOf("studio/web"), first: "studio.js", head: "/*! The page of retex studio.", imports: 1 },
];
const modulesIn = (sources) => readdirSync(sources).filter((name) => name.endsWith(".js"));

test("the comment with the licence is on top, and what is below is one small module", () => {
  for (const { name, sources, head, imports } of SCRIPTS) {
    const [comment, body] = made(name).split(/(?<=\*\/\n)/);
    same([comment.startsWith(head), comment.includes("Apache-2.0")], [true, true], name);
    same(/^\s*(\/\/|\/\*)|(?:^|[;}])\s*import\s*[{"*\w]|\brequire\(|sourceMappingURL/m.test(body), false, `imports, comments, maps of ${name}`);
    same((body.match(/\bimport\(/g) || []).length, imports, `calls of import in ${name}`);
    const whole = modulesIn(sources).reduce((sum, file) => sum + readFileSync(sources + file).length, 0);
    if (made(name).length > 0.75 * whole) throw new Error(`${name}: ${made(name).length} bytes of ${whole}`);
  }
  same(made("studio.css").startsWith("/*! The page of retex studio. Licence: Apache-2.0. */\n"), true, "studio.css");
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
  const names = [...SCRIPTS.map(({ name }) => name), "studio.css"];
  mkdirSync(`${folder}/other`);
  copyFileSync(`${build}/config.mk`, `${folder}/other/config.mk`); // not to look for the libraries again
  execFileSync("make", ["-s", `BUILD=${folder}/other`, ...names.map((name) => `${folder}/other/gen/${name}`)], { env, stdio: "pipe" });
  for (const name of names) same(readFileSync(`${folder}/other/gen/${name}`, "utf8") === made(name), true, name);
  rmSync(folder, { recursive: true });
});

/* Shaders are put together of other modules' texts while modules are loaded: in a circle, some would not be there yet. */
test("modules do not import each other in a circle", () => {
  for (const { name, sources, first } of SCRIPTS) {
    const imports = (file) => [...readFileSync(sources + file, "utf8").matchAll(/\bfrom "\.\/([^"]+)";/g)].map((match) => match[1]);
    const visit = (file, above) => {
      if (above.includes(file)) throw new Error([...above, file].join(" -> "));
      if (seen.has(file)) return;
      for (const other of imports(file)) visit(other, [...above, file]);
      seen.add(file);
    }, seen = new Set();
    visit(first, []);
    same([...seen].sort(), modulesIn(sources).sort(), `all are of ${name}`);
  }
});
