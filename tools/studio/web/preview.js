/* The live picture: a canvas that follows the camera, and what lies under the pointer. */
import * as api from "./api.js";
import * as cam from "./camera.js";
import { liveArgs, sceneOf } from "./commands.js";
import { displayed, displayTable } from "./picture.js";
import { gridLine, isEdge, maskOf, readCoordinates, readSurfaces, surfaceAt } from "./planes.js";
import { plainly } from "./words.js";

const WIDEST = 960, MOVING_WIDEST = 400, SAMPLES = 64, MOVING_SAMPLES = 1, SETTLE_AFTER = 350; // ms
const SMOOTHED = [4, 16, SAMPLES]; // of these samples the grain is removed
const STEP_KEYS = { w: ["forward", 1], s: ["forward", -1], a: ["right", -1], d: ["right", 1], e: ["up", 1], q: ["up", -1] };
const TURN_KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
export const CHIPS = ["#e0533f", "#2f7fd0", "#e0a100", "#3d9a50", "#9b59c6", "#00a0a0", "#d0659a", "#7a6a50"];

export class Preview extends EventTarget {
  constructor(app, { canvas, overlay, label }) {
    super();
    Object.assign(this, { app, canvas, overlay, label });
    this.table = displayTable();
    this.stops = 0;
    this.smooth = true;
    this.after = 0;
    this.answered = {};
    this.pressed = new Set();
    this.scope = "material";
    this.listen();
  }

  // ---- the process ----

  /* Start for this scene and these targets, unless it runs for them. */
  async start() {
    const scene = sceneOf(this.app.project), args = liveArgs(this.app.project), key = JSON.stringify([scene, args, this.app.project.import.number]);
    if (this.key === key) return this.resume();
    this.key = key;
    this.abort?.abort();
    const abort = (this.abort = new AbortController());
    const found = JSON.stringify([scene, this.app.project.import.number]), isNewScene = this.scene !== found;
    this.scene = found;
    this.coordinates = null;
    if (isNewScene) this.surfaces = null; // else what is seen stays until the process with other targets tells it anew
    this.after = 0;
    this.answered = {};
    if (isNewScene) this.live = null;
    this.note("The scene is being read…");
    try {
      await api.startPreview(scene, args);
      this.live = (await this.answer("live", abort.signal)).head;
      this.side = cam.sideOf(this.live.camera);
      this.tell("live");
      this.watch(abort.signal);
      await this.settle();
    } catch (error) {
      if (abort.signal.aborted) return undefined;
      this.key = "";
      this.note("");
      throw error;
    }
    return undefined;
  }

  /* Another project: nothing of this one is shown. */
  end() {
    this.abort?.abort();
    this.key = "";
    this.last = this.live = this.surfaces = null;
    this.canvas.classList.remove("shown");
  }

  tell(name) {
    this.dispatchEvent(new CustomEvent(name));
  }

  note(text) {
    this.label.textContent = text;
  }

  async send(line) {
    await api.sendPreview(line);
  }

  /* The next answer of a kind. */
  async answer(kind, signal = this.abort.signal) {
    for (;;) {
      const answer = await api.nextAnswer(kind, this.answered[kind] || 0, signal);
      if (!answer) continue;
      this.answered[kind] = answer.head.number;
      if (answer.head.error) throw new Error(answer.head.error);
      return answer;
    }
  }

  /* Pictures as they come. */
  async watch(signal) {
    while (!signal.aborted) {
      try {
        const picture = await api.nextPicture(this.after, signal);
        if (picture) this.show(picture);
      } catch (error) {
        if (signal.aborted) return;
        this.key = "";
        this.note("");
        if (this.app.ended) return;
        if (error.status === 0) return void this.app.meetLoss(0);
        this.app.say(`The preview has stopped. ${plainly(error.message)}`, "error", { label: "Start it again", run: () => this.start() });
        return;
      }
    }
  }

  show({ head, data }) {
    this.after = head.number;
    if (this.isMoving && head.denoised) return;
    if (this.smooth && !head.denoised && !this.isMoving && SMOOTHED.includes(head.picture)) this.send("denoise").catch(() => 0);
    if (this.isSmooth && !head.denoised) return; // no grain again before it is smooth again
    this.isSmooth = !!head.denoised;
    this.paint({ head, data });
    if (this.isMoving || !head.picture || head.picture >= SAMPLES) this.note("");
    else this.note(`Getting clearer… ${Math.round((100 * head.picture) / SAMPLES)} %`);
  }

  paint({ head, data }) {
    const bytes = displayed(data, head.width, head.height, this.table);
    if (!bytes) return;
    Object.assign(this.canvas, { width: head.width, height: head.height });
    this.canvas.getContext("2d").putImageData(new ImageData(bytes, head.width, head.height), 0, 0);
    this.canvas.classList.add("shown");
    this.last = { head, data };
  }

  /* Without grain, as soon as it stands. */
  setSmooth(on) {
    this.smooth = on;
    return this.live && !this.app.paused ? this.settle() : undefined;
  }

  /* Brighter or darker, in stops; for the preview alone. */
  expose(stops) {
    this.stops = stops;
    this.table = displayTable(stops);
    if (this.last) this.paint(this.last);
  }

  // ---- the camera ----

  get camera() {
    return this.moved || this.app.project.view || this.live?.camera || null;
  }

  get text() {
    if (this.moved || this.app.project.view) return cam.cameraText(this.camera);
    return "-";
  }

  size(widest) {
    const { width, height } = this.app.project.render, box = this.canvas.parentElement.getBoundingClientRect();
    const fits = Math.min(box.width, (box.height * width) / height) * Math.min(devicePixelRatio, 2);
    const w = Math.max(64, Math.min(widest, Math.round(fits)));
    return [w, Math.max(36, Math.round((w * height) / width))];
  }

  async view(widest, samples) {
    const [w, h] = this.size(widest);
    this.isSmooth = false;
    if (samples === SAMPLES) this.viewed = w;
    await this.send(`view ${w} ${h} ${this.text} ${samples}`);
  }

  /* While it moves: small pictures, one request at a time. */
  move(camera) {
    if (!this.live || !camera) return;
    this.moved = camera;
    this.isMoving = true;
    this.surfaces = this.coordinates = null;
    this.hover(null);
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.commit(), SETTLE_AFTER);
    if (this.asking) return;
    this.asking = true;
    requestAnimationFrame(() => this.view(MOVING_WIDEST, MOVING_SAMPLES).catch(() => 0).finally(() => (this.asking = false)));
  }

  /* The camera stands: the project has it, and the picture gets clear. */
  commit() {
    if (this.pressed.size || this.dragging) {
      this.settling = setTimeout(() => this.commit(), SETTLE_AFTER);
      return;
    }
    const { eye, at, angle } = this.moved;
    this.moved = null;
    this.app.change("Move the camera", (p) => ({ ...p, view: { eye, at, angle } }), "camera");
  }

  /* Planes first, since they end a view. */
  async settle() {
    if (!this.live || this.app.paused) return;
    if (!this.canvas.clientWidth) await new Promise(requestAnimationFrame); // the step before did not show it
    this.isMoving = false;
    const text = (this.shownText = this.text);
    if (this.wants.surfaces && this.surfaces?.text !== text) await this.readPlanes("surfaces", text);
    if (this.wants.grid && this.app.project.targets.length && this.coordinates?.text !== text) await this.readPlanes("uv", text);
    if (this.text !== text || this.isMoving) return;
    this.drawOverlay();
    await this.view(WIDEST, SAMPLES);
  }

  async readPlanes(kind, text) {
    const [w, h] = this.size(640);
    await this.send(`${kind} ${w} ${h} ${text}`);
    const { head, data } = await this.answer(kind);
    if (kind === "surfaces") {
      this.hovered = null; // it was one of the planes before
      this.surfaces = { ...readSurfaces(head, data), text };
    }
    if (kind === "uv") this.coordinates = { ...readCoordinates(head, data), text };
    this.tell(kind);
  }

  /* What the step needs beside the picture. */
  want(wants) {
    this.wants = wants;
    if (!wants.surfaces) this.hover(null);
    return this.live ? this.settle() : undefined;
  }
  wants = {};

  async resume() {
    if (this.app.paused) return this.send("stop");
    return this.shownText !== this.text || this.isMoving ? this.settle() : undefined;
  }

  pause(on) {
    this.app.paused = on;
    this.note(on ? "The preview rests." : "");
    return on ? this.send("stop") : this.settle();
  }

  // ---- pointer and keys ----

  /* A place of the window in the picture, 0 to 1 to the right and down. */
  place({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect();
    return [(clientX - box.x) / box.width, (clientY - box.y) / box.height];
  }

  /* Outside of the scene one goes round it, inside one looks round. */
  get goesRound() {
    if (this.mode) return this.mode === "round";
    const { bounds, eye } = this.live.camera, inner = this.camera?.eye || eye;
    return !!bounds && inner.some((x, i) => x < bounds[0][i] || x > bounds[1][i]);
  }

  drag(dx, dy) {
    const camera = this.camera, box = this.canvas.getBoundingClientRect();
    if (!camera) return;
    const turn = ((camera.angle / box.width) * Math.PI) / 180;
    if (this.goesRound) this.move(cam.orbited(camera, -dx * 0.008, dy * 0.008, this.side));
    else this.move(cam.lookedRound(camera, -dx * turn, dy * turn, this.side));
  }

  listen() {
    const { canvas } = this, pointers = new Map();
    let far = 0, pinch = 0;
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      if (!pointers.size) far = 0;
      pointers.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
      pinch = 0;
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = pointers.get(event.pointerId);
      if (!before) return this.hover(event);
      const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
      pointers.set(event.pointerId, event);
      far += Math.abs(dx) + Math.abs(dy);
      if (pointers.size === 2) {
        const [a, b] = pointers.values(), apart = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (pinch && this.camera) this.move(cam.dollied(this.camera, pinch / apart));
        pinch = apart;
      } else if (far > 5) {
        this.dragging = true;
        this.drag(dx, dy);
      }
      return undefined;
    });
    const end = (event) => {
      const was = pointers.delete(event.pointerId);
      if (!pointers.size) this.dragging = false;
      if (was && event.type === "pointerup" && far <= 5) this.pick(event);
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("pointerleave", () => this.hover(null));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (this.camera) this.move(cam.dollied(this.camera, 2 ** (event.deltaY / 800)));
    }, { passive: false });
    canvas.addEventListener("dblclick", (event) => {
      if (!this.camera || this.wants.surfaces) return;
      const [x, y] = this.place(event);
      this.move(cam.aimed(this.camera, 2 * x - 1, 1 - 2 * y, canvas.width / canvas.height, this.side));
    });
    canvas.addEventListener("keydown", (event) => this.onKey(event));
    canvas.addEventListener("keyup", (event) => this.pressed.delete(event.key.length === 1 ? event.key.toLowerCase() : event.key));
    canvas.addEventListener("blur", () => this.pressed.clear());
    new ResizeObserver(() => {
      this.fit();
      if (this.live && !this.isMoving && this.size(WIDEST)[0] > 1.2 * this.viewed) this.settle().catch(() => 0);
    }).observe(canvas.parentElement);
  }

  onKey(event) {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.ctrlKey || event.metaKey || event.altKey || !this.camera) return;
    if (STEP_KEYS[key] || TURN_KEYS[key]) {
      event.preventDefault();
      const begins = !this.pressed.size;
      this.pressed.add(key);
      if (begins) this.walk(performance.now() - 30);
    } else if (key === "+" || key === "-") this.move(cam.dollied(this.camera, key === "+" ? 0.9 : 1 / 0.9));
    else if (key === "Escape") this.hover(null);
  }

  /* As long as keys are down. */
  walk(before) {
    if (!this.pressed.size) return;
    const now = performance.now(), seconds = Math.min((now - before) / 1000, 0.1), step = cam.stepOf(this.live?.camera.bounds) * 4 * seconds;
    let camera = this.camera;
    for (const key of this.pressed) {
      const [axis, sign] = STEP_KEYS[key] || [], [right, up] = TURN_KEYS[key] || [];
      if (axis) camera = cam.walked(camera, { [axis]: sign * step }, this.side);
      else camera = cam.lookedRound(camera, right * seconds, up * seconds, this.side);
    }
    this.move(camera);
    requestAnimationFrame(() => this.walk(now));
  }

  // ---- surfaces ----

  hover(event) {
    const found = event && this.wants.surfaces && this.surfaces ? surfaceAt(this.surfaces, this.scope, ...this.place(event)) : null;
    this.hoverSurface(found);
  }

  hoverSurface(surface) {
    if (surface === this.hovered) return;
    this.hovered = surface;
    this.drawOverlay();
    this.tell("hover");
  }

  pick(event) {
    if (!this.wants.surfaces || !this.surfaces) return;
    const surface = surfaceAt(this.surfaces, this.scope, ...this.place(event));
    this.dispatchEvent(new CustomEvent("pick", { detail: surface }));
  }

  setScope(scope) {
    this.scope = scope;
    this.hoverSurface(null);
  }

  /* The picture as large as its place allows, the overlay on it. */
  fit() {
    const { width, height } = this.app.project.render;
    this.canvas.parentElement.style.setProperty("--ratio", width / height);
    this.drawOverlay();
  }

  drawOverlay() {
    const { overlay, surfaces, coordinates, hovered } = this, of = surfaces || coordinates;
    const context = overlay.getContext("2d");
    if (!of || (!this.wants.surfaces && !this.wants.grid)) return context.clearRect(0, 0, overlay.width, overlay.height);
    Object.assign(overlay, { width: of.width, height: of.height });
    const image = context.createImageData(of.width, of.height);
    if (surfaces && this.wants.surfaces) this.paintTargets(image, of);
    if (coordinates && this.wants.grid && coordinates.width === of.width) this.paintGrid(image, of);
    if (hovered && surfaces && this.wants.surfaces) this.paintOutline(image, of, maskOf(surfaces, hovered), [255, 255, 255], 60, 2);
    context.putImageData(image, 0, 0);
    return undefined;
  }

  /* Chosen surfaces have their colour's outline, and a little of it inside. */
  paintTargets(image, of) {
    this.app.project.targets.forEach((target, k) => {
      const surface = of.surfaces.find((s) => s.text === target.select);
      const color = CHIPS[k % CHIPS.length].match(/\w\w/g).map((x) => parseInt(x, 16));
      if (surface) this.paintOutline(image, of, maskOf(of, surface), color, 70, 1);
    });
  }

  paintOutline({ data }, { width, height }, mask, [r, g, b], inside, thick) {
    for (let y = 0, i = 0; y < height; y++) {
      for (let x = 0; x < width; x++, i++) {
        if (!mask[i]) continue;
        let edge = isEdge(mask, width, height, x, y);
        for (let k = 1; !edge && k < thick; k++) edge = isEdge(mask, width, height, x + k, y) || isEdge(mask, width, height, x, y + k);
        const alpha = edge ? 255 : inside;
        if (alpha >= data[4 * i + 3] || edge) data.set([r, g, b, alpha], 4 * i);
      }
    }
  }

  paintGrid({ data }, { width, height }) {
    const colors = [null, [255, 255, 255, 190], [230, 70, 60, 255], [60, 130, 230, 255]];
    for (let y = 0, i = 0; y < height; y++) {
      for (let x = 0; x < width; x++, i++) {
        const line = gridLine(this.coordinates, x, y);
        if (line) data.set(colors[line], 4 * i);
      }
    }
  }

  /* A small JPEG of what is shown, for saved cameras. */
  thumbnail() {
    const { canvas } = this;
    if (!canvas.classList.contains("shown")) return "";
    const small = Object.assign(document.createElement("canvas"), { width: 160, height: Math.round((160 * canvas.height) / canvas.width) });
    small.getContext("2d").drawImage(canvas, 0, 0, small.width, small.height);
    return small.toDataURL("image/jpeg", 0.7);
  }
}
