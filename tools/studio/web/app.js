/* What the page knows: the project with its history, jobs, and which step is shown. It tells of changes by events:
 * "change" (anything to be drawn anew), "message". */
import * as api from "./api.js";
import { amended, changed, emptyProject, kindOf, newHistory, readProject, redone, undone, withRender } from "./project.js";
import { errorReport, plainly } from "./words.js";

const SAVE_AFTER = 400; // ms
const LAST_MOST = 30000; // letters; browsers send at most 64 KiB after a window has closed

const outputOf = (args) => args[args.indexOf("-o") + 1];
const isOver = (job) => ["done", "failed", "stopped"].includes(job.state);

export class App extends EventTarget {
  constructor() {
    super();
    this.history = newHistory(emptyProject(""));
    this.jobs = new Map();
    this.waiting = new Map();
    this.step = "open";
    this.model = null;
    this.etag = "";
    this.saved = "saved";
    this.known = {}; // what jobs have told of the scene: lamps, finishes, estimate
  }

  get project() {
    return this.history.present.project;
  }

  tell(name = "change", detail = null) {
    this.dispatchEvent(new CustomEvent(name, { detail }));
  }

  /* kind: "error" stays until it is closed, "note" goes by itself. */
  say(text, kind = "note", action = null) {
    this.tell("message", { text, kind, action });
  }

  /* Do something, and say what went wrong. */
  async attempt(action) {
    try {
      return await action();
    } catch (error) {
      if (error.status === 0) this.meetLoss(0);
      else if (error.name !== "AbortError") this.say(plainly(error.message), "error");
      return undefined;
    }
  }

  // ---- the project ----

  async load() {
    const state = await api.getState();
    this.state = state;
    if (state.model?.path !== this.model?.path) this.modelChanged = false;
    this.model = state.model || null;
    this.conflict = false;
    if (!this.model) {
      this.history = newHistory(emptyProject(""));
      return this.tell();
    }
    this.etag = "";
    this.foreign = state.foreign || ""; // why nothing is run yet
    this.history = newHistory(emptyProject(this.model.path));
    let project = emptyProject(this.model.path);
    if (state.project) {
      const read = await api.getProject().catch((error) => {
        this.model = null; // of what is damaged, nothing is shown
        throw error;
      });
      project = readProject(read.project, this.model.path);
      this.etag = read.etag;
    }
    this.history = newHistory(project);
    this.known = {};
    if (!this.foreign) {
      await this.addFolders();
      await this.readJobs();
    }
    this.tell("opened");
    this.tell();
    return undefined;
  }

  /* The user agrees to go on with what somebody else may have made. */
  async trust() {
    await api.trust(`${this.model.folder}/${this.model.name}`);
    await this.load();
  }

  /* Those of pictures, which the server shows from now on. */
  async addFolders() {
    const { folders } = this.project.textures, wanted = folders.filter((f) => !this.state.textures.includes(f));
    const gone = [];
    for (const folder of wanted) await api.addTextures(folder).catch(() => gone.push(folder));
    if (wanted.length) this.state = await api.getState();
    if (gone.length) this.say(`The folder of pictures ${gone.join(", ")} is no longer there.`);
  }

  /* One step that can be undone. change: a new project, or what makes it of the present one. */
  change(label, change, merge = "") {
    const project = typeof change === "function" ? change(this.project) : change;
    this.history = changed(this.history, label, project, merge);
    this.save();
    this.tell();
  }

  /* What has happened, and is not undone. */
  amend(change) {
    this.history = amended(this.history, change);
    this.save();
    this.tell();
  }

  undo() {
    this.travel(undone, "Undone: ");
  }

  redo() {
    this.travel(redone, "Done again: ");
  }

  travel(go, what) {
    const before = this.history, label = go === undone ? before.present.label : before.future[0]?.label;
    this.history = go(before);
    if (this.history === before) return;
    this.save();
    this.tell("travelled");
    this.tell();
    this.say(what + label.toLowerCase());
  }

  save() {
    this.saved = "saving";
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.saveNow(), SAVE_AFTER);
  }

  /* One after the other: each needs the ETag of the one before. */
  async saveNow() {
    clearTimeout(this.timer);
    if (!this.model || this.conflict || this.foreign) return;
    if (this.saving) {
      this.again = true;
      return;
    }
    this.saving = true;
    try {
      this.sent = this.project;
      this.etag = await api.putProject(this.sent, this.etag, this.isSmall);
      if (this.sent === this.project) this.saved = "saved";
    } catch (error) {
      this.saved = "unsaved";
      if (error.status === 412) this.meetConflict();
      else if (error.status === 0) this.meetLoss(0);
      else this.say(`The project could not be saved: ${plainly(error.message)}`, "error", { label: "Try again", run: () => this.saveNow() });
    }
    this.saving = false;
    this.tell();
    if (this.again) {
      this.again = false;
      await this.saveNow();
    }
  }

  get isSmall() {
    return JSON.stringify(this.project).length < LAST_MOST;
  }

  /* Whether a window that closes loses nothing: what it sends last is small, and waits for no other answer. */
  get canLeave() {
    if (!this.model || this.ended || this.saved === "saved") return true;
    return this.saved === "saving" && this.isSmall && (!this.saving || this.sent === this.project);
  }

  /* The window closes. */
  saveLast() {
    clearTimeout(this.timer);
    if (this.saved !== "saved" && !this.saving && this.canLeave) api.putProject(this.project, this.etag, true).catch(() => 0);
  }

  /* Another window, or program, has changed the project. */
  meetConflict() {
    this.conflict = true;
    this.tell();
  }

  async takeOver() {
    this.etag = (await api.getProject()).etag;
    this.conflict = false;
    await this.saveNow();
  }

  // ---- jobs ----

  /* The stream begins with all jobs and the project as they are: what happened before it, or while it was broken, is met
   * as it would have been then. */
  listen() {
    let isFirst = true;
    api.listenTo({
      job: (job) => this.meetJob(job),
      project: ({ etag }) => {
        if (this.saving || !this.model || etag === this.etag) return;
        if (this.saved === "saved" && !this.conflict) this.attempt(() => this.load()).then(() => this.say("Another window has changed the project; here it is."));
        else this.meetConflict();
      },
      model: ({ changed }) => {
        if (!this.model || changed === this.model.changed) return; // of the model that is being opened
        this.modelChanged = true;
        this.tell();
      },
      open: () => (isFirst ? (isFirst = false) : this.meetAgain()),
      lost: (status) => this.meetLoss(status),
    });
  }

  /* The server does not answer, or, with a status, is another one that does not know this page. */
  meetLoss(status) {
    if (this.ended) return;
    this.lost = true;
    this.isMoved = status === 403;
    this.tell();
  }

  /* What was changed meanwhile is saved now. */
  async meetAgain() {
    this.lost = this.isMoved = false;
    this.tell("again");
    if (this.saved !== "saved") await this.saveNow();
    this.tell();
  }

  async quit() {
    await this.saveNow();
    await api.quit();
    this.ended = true;
    this.tell();
  }

  async readJobs() {
    const list = await api.getJobs();
    for (const job of list) this.jobs.set(job.job, job);
    for (const job of list) this.meetJob(job);
  }

  meetJob(job) {
    this.jobs.set(job.job, job);
    if (job.tool === "retex-render" && isOver(job)) this.meetRender(job);
    const waiting = this.waiting.get(job.job);
    if (waiting && isOver(job)) {
      this.waiting.delete(job.job);
      waiting(job);
    }
    this.tell();
  }

  meetRender(job) {
    const set = outputOf(job.args), render = this.project.renders.find((r) => r.set === set);
    if (!render || render.done) return;
    if ([...this.jobs.values()].findLast((j) => outputOf(j.args) === set) !== job) return; // it has gone on since
    const done = job.state === "done", part = job.progress || 0, error = job.state === "failed" ? errorReport(job.lines, "The render").text : "";
    if (!done && render.error === error && render.part === part) return;
    this.amend((p) => withRender(p, set, done ? { done, seconds: job.seconds, error: "", part: 1 } : { error, part }));
    if (done) this.tell("rendered");
  }

  /* The job that writes this file and is not over. */
  jobOf(output) {
    return [...this.jobs.values()].find((j) => !isOver(j) && outputOf(j.args) === output);
  }

  /* Run a tool; resolves with the job when it is over. */
  async run(tool, args, label) {
    const { job } = await api.startJob(tool, args, label), known = this.jobs.get(job);
    if (known && isOver(known)) return known;
    const over = new Promise((resolve) => this.waiting.set(job, resolve));
    if (!known) this.jobs.set(job, { job, tool, args, label, state: "waiting", progress: 0, lines: [] });
    this.tell();
    return over;
  }

  /* The same; what it prints, or an error in plain words. */
  async runWell(tool, args, label) {
    const job = await this.run(tool, args, label);
    if (job.state === "stopped") throw new Error(`“${label}” was stopped.`);
    if (job.state !== "done") throw new Error(errorReport(job.lines, tool).text);
    return job.stdout || "";
  }

  stop(job) {
    return this.attempt(() => api.stopJob(job));
  }

  // ---- steps ----

  go(step) {
    this.step = step;
    this.tell("step");
    this.tell();
  }

  get kind() {
    return kindOf(this.project.model);
  }

  /* Whether there is a scene to look at. */
  get hasScene() {
    return this.kind === "scene" || (this.kind === "model" && !!this.project.import.done);
  }

  /* The set that is played: rendered here, or the file itself. */
  get set() {
    if (this.kind === "set") return this.project.model;
    return this.project.renders.filter((r) => r.done).at(-1)?.set || "";
  }
}
