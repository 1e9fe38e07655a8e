/* The player: <retex-room>, the program's own, of the room that retex-pack made of a set. The project has its look. */
import { pageOf, webArgs } from "./commands.js";
import { addressOf, lookOfLink } from "./look.js";

/* Only what tools can make of it is kept; one's own files are put into the project first. */
export class Player {
  constructor(app, stage, onDrop) {
    Object.assign(this, { app, stage, onDrop });
    app.addEventListener("travelled", () => this.putLook());
    app.addEventListener("opened", () => this.clear());
  }

  get room() {
    return this.element;
  }

  clear() {
    this.element?.remove();
    this.element = null;
    this.made = "";
  }

  /* Make the page of the project's set, if it is another one than what is shown. */
  async show() {
    const { set } = this.app;
    if (!set || this.made === set || this.making === set) return;
    this.making = set;
    this.app.tell();
    try {
      const folder = pageOf(this.app.project.model, set);
      await this.app.runWell("retex-pack", webArgs(set, folder), "Make the page");
      await import(new URL("retex-room.js", document.baseURI).href);
      this.clear();
      this.made = set;
      this.begin(`${addressOf(folder)}/`);
    } finally {
      this.making = "";
      this.app.tell();
    }
  }

  begin(src) {
    this.setHash(this.app.project.look);
    const room = (this.element = document.createElement("retex-room"));
    room.setAttribute("src", src);
    if (matchMedia("(max-width: 800px)").matches) room.setAttribute("panel", "closed");
    room.addEventListener("retex-change", () => this.takeLook());
    room.addEventListener("retex-select", () => this.app.tell());
    room.addEventListener("retex-ready", () => this.app.tell());
    room.addEventListener("retex-complete", () => (this.isReady = true));
    this.catchFiles(room);
    this.isReady = false;
    this.stage.append(room);
  }

  setHash(look) {
    history.replaceState(null, "", look ? `#room=${encodeURIComponent(look)}` : location.pathname + location.search);
  }

  /* One's own files become files of the project, so that they are still there tomorrow. */
  catchFiles(room) {
    room.addEventListener("drop", (event) => {
      if (!event.dataTransfer.files.length) return;
      event.preventDefault();
      event.stopPropagation();
      const target = room.targetAt?.(event.clientX, event.clientY) ?? -1;
      this.onDrop([...event.dataTransfer.files], target >= 0 ? room.targets[target] : this.target);
    }, true);
    room.addEventListener("change", (event) => {
      const input = event.composedPath()[0];
      if (input.type !== "file" || input.dataset.set !== "file" || !input.files.length) return;
      event.stopPropagation();
      this.onDrop([...input.files], this.target);
      input.value = "";
    }, true);
  }

  /* The target that its controls change. */
  get target() {
    return this.element?.targets[this.element.selected] || "";
  }

  async put(target, path, width) {
    await this.element.setTexture(target, addressOf(path), width ? { width: `${width}cm` } : {});
    this.element.select(target);
  }

  /* What the player shows becomes a step of the project. */
  takeLook() {
    if (this.isPutting || !this.isReady) return;
    const look = lookOfLink(this.element.link);
    if (look !== this.app.project.look) this.app.change("Change the look", (p) => ({ ...p, look }), "look");
  }

  /* What the project says is shown. */
  async putLook() {
    const { element } = this;
    if (!element?.renderer) return;
    this.isPutting = true;
    this.setHash(this.app.project.look);
    try {
      if (this.app.project.look) await element.restore();
      else await element.setState({});
    } finally {
      setTimeout(() => (this.isPutting = false));
    }
  }
}
