/* What the server is asked. All addresses are below the page's own, which has the token. */

class ServerError extends Error {
  constructor(message, status) {
    super(message);
    this.status = status;
  }
}

async function ask(path, options = {}) {
  let answer;
  try {
    answer = await fetch(path, { cache: "no-store", ...options });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ServerError("retex studio does not answer.", 0);
  }
  if (answer.ok) return answer;
  const text = await answer.text().catch(() => "");
  let message = text;
  try {
    message = JSON.parse(text).error || text;
  } catch { /* no JSON: the text is the message */ }
  throw new ServerError(message || `The answer was ${answer.status}.`, answer.status);
}

const json = async (path, options) => (await ask(path, options)).json();
const post = (path, value) => json(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(value) });

export const getState = () => json("api/state");
export const openModel = (path) => post("api/open", { path });
export const getFolder = (path) => json(path ? `api/folder?path=${encodeURIComponent(path)}` : "api/folder");
export const thumbAddress = (path, size = 160) => `api/thumb?path=${encodeURIComponent(path)}&size=${size}`;
export const getJobs = () => json("api/jobs").then((answer) => answer.jobs || answer);
export const addTextures = (path) => post("api/textures", { path });
export const trust = (model) => post("api/trust", { model });
export const startJob = (tool, args, label) => post("api/jobs", { tool, args, label });
export const stopJob = (job) => post(`api/jobs/${job}/stop`, {});
export const startPreview = (scene, args) => post("api/preview/start", { scene, args });
export const sendPreview = (line) => post("api/preview", { line });
export const quit = () => post("api/quit", {});

export async function getProject() {
  const answer = await ask("api/project");
  return { project: await answer.json(), etag: answer.headers.get("ETag") };
}

/* The new ETag. etag: of what this window last saw; "" for the first project. keepalive: the window may close meanwhile. */
export async function putProject(project, etag, keepalive = false) {
  const match = etag ? { "If-Match": etag } : { "If-None-Match": "*" };
  const answer = await ask("api/project", {
    method: "PUT", headers: { "Content-Type": "application/json", ...match }, body: JSON.stringify(project, null, 1), keepalive,
  });
  return answer.headers.get("ETag") || (await answer.json()).etag;
}

/* A file into the project's folder, or a model into a folder of its own; its path there. */
const sent = (query, body) => json(`api/upload?${query}`, { method: "POST", body }).then((a) => a.path);
export const upload = (name, body) => sent(`name=${encodeURIComponent(name)}`, body);
export const uploadModel = (name, body) => sent(`as=model&name=${encodeURIComponent(name)}`, body);

/* The newest picture after one: { head, data }; null if none came. */
export async function nextPicture(after, signal) {
  const answer = await ask(`api/preview/picture?after=${after}`, { signal });
  if (answer.status === 204) return null;
  return { head: JSON.parse(answer.headers.get("Retex-Picture")), data: await answer.arrayBuffer() };
}

/* The newest answer of a kind likewise: a line of JSON, then bytes. */
export async function nextAnswer(kind, after, signal) {
  const answer = await ask(`api/preview/answer?kind=${kind}&after=${after}`, { signal });
  if (answer.status === 204) return null;
  const data = await answer.arrayBuffer(), end = new Uint8Array(data).indexOf(10);
  return { head: JSON.parse(new TextDecoder().decode(data.slice(0, end))), data: data.slice(end + 1) };
}

const RETRY_AFTER = 1500; // ms

/* listeners by the event's name; `open` each time that the server is there (again), `lost` when it is not, with the
 * status of its answer, 0 for none. */
export function listenTo(listeners) {
  const source = new EventSource("api/events"), { open, lost, ...others } = listeners;
  source.addEventListener("open", () => open());
  source.addEventListener("error", async () => {
    source.close(); // the browser's own attempts end at a refusal
    const status = await fetch("api/state", { cache: "no-store" }).then((answer) => answer.status, () => 0);
    if (status !== 200) lost(status);
    setTimeout(() => listenTo(listeners), RETRY_AFTER);
  });
  for (const [name, listener] of Object.entries(others)) {
    source.addEventListener(name, (event) => listener(event.data ? JSON.parse(event.data) : {}));
  }
}
