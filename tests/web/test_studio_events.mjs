/* retex studio's page with its server, without a browser: what happens after the page has asked how things are, and before
 * its stream of events is open, is not missed. */
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { resolve } from "node:path";
import { App } from "../../tools/studio/web/app.js";
import { same, test } from "./tap.mjs";

const SCENE = "camera { location -3*z look_at 0 } light_source { -9*z 1 } #declare Ball = texture { pigment { rgb 1 } } sphere { 0, 1 texture { Ball } }";
const ask = globalThis.fetch, pause = (ms) => new Promise((done) => setTimeout(done, ms));
const within = (promise, what, ms = 10000) => Promise.race([promise, pause(ms).then(() => { throw new Error(`${what} did not happen`); })]);

globalThis.CustomEvent ??= class extends Event {
  constructor(name, { detail }) {
    super(name);
    this.detail = detail;
  }
};

/* A server of a new folder; what the browser gives to the page: fetch, and streams that open when `opens` says so. */
async function withServer(body) {
  const folder = mkdtempSync(`${tmpdir()}/retex-events-`), abort = new AbortController();
  writeFileSync(`${folder}/room.pov`, SCENE);
  const program = resolve(process.env.BUILD || "build", "bin/retex-studio");
  const server = spawn(program, ["room.pov", "--no-browser", "-o", "address"], { cwd: folder, env: { ...process.env, HOME: folder } });
  const ended = new Promise((done) => server.on("exit", done));
  let open;
  const opens = new Promise((done) => (open = done));
  try {
    while (!existsSync(`${folder}/address`)) await pause(10);
    const address = readFileSync(`${folder}/address`, "utf8").trim(), get = (path, options = {}) => ask(new URL(path, address), { signal: abort.signal, ...options });
    globalThis.fetch = get;
    globalThis.EventSource = class extends EventTarget {
      constructor(path) {
        super();
        this.read(path).catch(() => 0); // aborted
      }
      close() {}
      async read(path) {
        await opens;
        const answer = await get(path), reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
        this.dispatchEvent(new Event("open"));
        for (let text = "", part; !(part = await reader.read()).done; ) {
          const events = (text + part.value).split("\n\n");
          text = events.pop();
          for (const [, name, data] of events.map((event) => /^event: (\w+)\ndata: (.*)$/.exec(event)).filter(Boolean)) this.dispatchEvent(Object.assign(new Event(name), { data }));
        }
      }
    };
    const app = new App();
    await app.load();
    app.listen();
    await body(app, get, open);
  } finally {
    abort.abort();
    server.kill();
    await ended;
    rmSync(folder, { recursive: true });
  }
}

test("a job that ends before the stream is open", () => withServer(async (app, get, open) => {
  const job = app.run("retex-render", ["--list-lamps", "--", "room.pov"], "a job");
  for (let jobs = []; !jobs.some((j) => j.state === "done"); jobs = await (await get("api/jobs")).json()) await pause(20);
  open();
  same((await within(job, "the end of the job")).state, "done");
}));

test("a project that another window has written meanwhile", () => withServer(async (app, get, open) => {
  const text = JSON.stringify({ ...app.project, look: "Ball=a.png" });
  same((await get("api/project", { method: "PUT", headers: { "If-None-Match": "*" }, body: text })).status, 200);
  open();
  await within(new Promise((done) => app.addEventListener("message", done)), "a message");
  same([app.project.look, app.conflict], ["Ball=a.png", false]);
}));
