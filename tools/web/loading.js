// ---- loading of a room's folder ----

import { decodeClass, decodeJpeg, fetchBytes, fetchChecked, inflate, mostBytes } from "./files.js";
import { finishesAsRendered, lampsOf } from "./lamps.js";
import { plainTexture } from "./look.js";
import { Renderer, checkManifest, isRelit } from "./renderer.js";

const NO_WEBGL = "This browser cannot change textures: it has no WebGL 2. The picture is as it was rendered.";

function readManifest(text) {
  try {
    const room = JSON.parse(text);
    checkManifest(room);
    return room;
  } catch (error) {
    throw error instanceof TypeError || error instanceof SyntaxError ? new Error("room.json is damaged.") : error;
  }
}

/* How an element loads its room. */
export const withLoading = (Base) => class extends Base {
  /* kept: textures that come back with the room, after the graphics card was lost, or with a larger room; instead: what
   * is done if that does not come. */
  async load(kept, instead) {
    this.started = true;
    if (!kept || !this.isComplete) this.abort?.abort(); // else pictures may be on the way, which are wanted
    const abort = (this.abort = new AbortController()), canvas = this.$("canvas");
    this.before = kept && this.renderer ? canvas.toDataURL("image/jpeg", 0.9) : "";
    canvas.classList.remove("shown");
    this.renderer = this.lampsComing = null;
    this.isComplete = false;
    if (!kept) this.room = null, this.textures = [];
    this.$(".room").classList.remove("empty");
    this.fail(null);
    this.whenComplete = this.run(abort.signal, kept).catch((error) => {
      if (abort.signal.aborted) return undefined;
      return instead ? instead() && this.complete : this.fail(error.message);
    });
  }

  async run(signal, kept) {
    const base = new URL(this.getAttribute("src").replace(/\/?$/, "/"), document.baseURI);
    const text = new TextDecoder().decode(await fetchBytes(new URL("room.json", base), signal, "no-cache").catch((error) => {
      throw error.status ? new Error(`There is no room in ${base.href}: ${error.message}`) : error;
    }));
    let room = readManifest(text);
    if (signal.aborted) return;
    this.setRooms(room);
    const chosen = this.pickRoom();
    if (chosen !== room) room = readManifest(new TextDecoder().decode(await fetchChecked(base, chosen, signal)));
    if (signal.aborted) return;
    this.room = room;
    this.textures = room.targets.map((_, i) => Object.assign(kept?.[i] || plainTexture(), { put: {} }));
    if (!kept) this.said = lampsOf(room).map(() => null), this.finishes = finishesAsRendered(room);
    this.recolor();
    if (!kept) this.selected = room.targets.reduce((best, t, i) => (t.share > room.targets[best].share ? i : best), 0);
    this.$(".view").style.setProperty("--ratio", this.rooms.at(-1).width / this.rooms.at(-1).height);
    if (!kept) this.refresh();
    this.progress = { done: 0, all: [room.picture, room.reduced, ...room.lights, ...room.classes].reduce((n, f) => n + (f?.bytes || 0), 0) };
    const get = async (entry) => {
      const bytes = await fetchChecked(base, entry, signal);
      this.$(".bar").value = (this.progress.done += bytes.length) / this.progress.all;
      return bytes;
    };
    this.getLamps = async () => decodeJpeg(await fetchChecked(base, room.lamps, signal), room.lamps.file);
    const still = await decodeJpeg(await get(room.picture), room.picture.file);
    if (still.naturalWidth !== room.width || still.naturalHeight !== room.height) throw new Error(`${room.picture.file} is damaged.`);
    const shown = this.$("img");
    shown.src = this.before || new URL(room.picture.file, base).href;
    shown.hidden = false;
    this.emit("retex-still", {});
    try {
      this.renderer = new Renderer(this.$("canvas"), room);
    } catch (error) {
      this.$(".bar").hidden = true;
      throw error.message === "no WebGL 2" || typeof DecompressionStream === "undefined" ? new Error(NO_WEBGL) : error;
    }
    this.renderer.putStill(still);
    await this.stream(get, signal, kept);
  }

  /* The target that shows most, then the others, then light that no target changes. */
  async stream(get, signal, kept) {
    const { room, renderer } = this;
    const order = room.targets.map((_, i) => i).sort((a, b) => room.targets[b].share - room.targets[a].share);
    const jobs = [];
    const light = (l) => jobs.push(async () => renderer.putLight(l, await decodeJpeg(await get(room.lights[l]), room.lights[l].file)));
    const footprints = (c) => jobs.push(async () => {
      const data = await inflate(await get(c), c.file, mostBytes(c));
      await new Promise((resolve) => setTimeout(resolve));
      renderer.putClass(c, decodeClass(c, data, c.base, room.targets[c.target].periodic));
    });
    if (renderer.lacksLamps) jobs.push(() => this.loadLamps());
    if (room.reduced) jobs.push(async () => renderer.putReduced(await decodeJpeg(await get(room.reduced), room.reduced.file)));
    room.classes.filter((c) => c.kind === "interreflection").forEach(footprints);
    const steps = [];
    for (const t of order) {
      room.classes.filter((c) => c.kind !== "interreflection" && c.target === t).forEach(footprints);
      room.lights.forEach((l, i) => l.target === t && light(i));
      steps.push(jobs.length);
    }
    room.lights.forEach((l, i) => (l.target < 0 || l.target >= room.targets.length) && light(i));
    for (let i = 0, step = 0; i < jobs.length; ) {
      const end = steps[step] ?? jobs.length;
      await Promise.all(jobs.slice(i, end).map((job) => job()));
      if (signal.aborted) return;
      i = end;
      if (step++ === 0) await this.begin(kept);
      this.refresh();
      this.draw(true);
    }
    this.$(".bar").hidden = true;
    this.isComplete = true;
    this.emit("retex-complete", {});
    this.say("All is loaded.");
    this.grow();
  }

  /* The first target can be changed. */
  async begin(kept) {
    this.$("canvas").classList.add("shown");
    this.textures.forEach((_, i) => this.put(i));
    this.emit("retex-ready", { targets: this.targets });
    if (kept) await this.loadLamps();
    else if (!(await this.restore()) && this.hasAttribute("preset")) await this.putPreset();
  }

  /* The light of single lamps, once the room is drawn and needs it. */
  async loadLamps() {
    const { renderer, room } = this;
    if (!renderer || renderer.lampTiles || !(renderer.lacksLamps || isRelit(room, this.colors))) return;
    this.lampsComing ||= this.getLamps().then((image) => renderer.putLamps(image)).catch((error) => {
      this.lampsComing = null; // for another try
      throw error;
    });
    await this.lampsComing;
    this.draw(false);
  }
};
