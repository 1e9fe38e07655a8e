/*! <retex-room src="FOLDER/">: a room whose textures can be changed in the browser. FOLDER is what `retex-pack --web`
 * wrote. The picture is a polynomial in the textures, see retex-web(5); WebGL 2 evaluates it. See README.md.
 * Licence: Apache-2.0. */

import { withControls } from "./controls.js";
import { withEvents } from "./events.js";
import { withLighting } from "./lighting.js";
import { withLoading } from "./loading.js";
import { BODY, STYLE } from "./page.js";
import { withSizes } from "./sizes.js";
import { withState } from "./state.js";
import { withTextures } from "./textures.js";
import { withView } from "./view.js";

// ---- the element ----

/* What it does is in parts, each of which adds to the class before it. Servers that render pages import the script too, and
 * have no elements. */
const PARTS = [withTextures, withLighting, withState, withSizes, withLoading, withView, withControls, withEvents];

export class RetexRoom extends PARTS.reduce((Base, withPart) => withPart(Base), globalThis.HTMLElement || Object) {
  static observedAttributes = ["src"];

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    root.innerHTML = `<style>${STYLE}</style>${BODY}`;
    this.$ = (selector) => root.querySelector(selector);
    this.textures = [];
    this.light = { exposure: 0, warmth: 0 };
    this.colors = [];
    this.said = [];
    this.finishes = [];
    this.zoom = { times: 1, x: 0, y: 0 };
    this.selected = 0;
    this.listen(root);
    this.$("[data-do=full]").hidden = !document.fullscreenEnabled;
    this.restore = this.restore.bind(this);
    this.growWhole = this.growWhole.bind(this);
  }

  connectedCallback() {
    addEventListener("hashchange", this.restore);
    addEventListener("beforeprint", this.growWhole);
    this.togglePanel(this.getAttribute("panel") !== "closed");
    if (!this.started && this.hasAttribute("src")) this.load();
  }

  disconnectedCallback() {
    removeEventListener("hashchange", this.restore);
    removeEventListener("beforeprint", this.growWhole);
    this.abort?.abort();
    this.started = false;
  }

  attributeChangedCallback() {
    this.wholeWanted = this.largest = undefined;
    if (this.isConnected) this.load();
  }

  /* The names of what can be changed. */
  get targets() {
    return this.room ? this.room.targets.map((t) => t.name) : [];
  }

  /* Resolves when all is loaded. */
  get complete() {
    return this.whenComplete;
  }

  /* The picture in the room's own size. */
  async toBlob(type = "image/png", quality) {
    await this.growWhole();
    this.draw(true);
    return new Promise((resolve) => this.$("canvas").toBlob(resolve, type, quality));
  }

  select(name) {
    this.selected = this.indexOf(name);
    this.refresh();
    this.emit("retex-select", { target: name });
  }

  /* now: before returning, and not with the next frame. */
  draw(now) {
    if (!this.renderer) return;
    if (!now) {
      this.frame ||= requestAnimationFrame(() => this.draw(true));
      return;
    }
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const begin = performance.now();
    const split = this.comparing ? (this.$(".split").value / 100) * this.room.width : 0;
    this.renderer.render(this.settings(), split, this.light, this.mapColors());
    this.emit("retex-draw", { milliseconds: performance.now() - begin });
  }

  update() {
    this.refresh();
    this.draw(false);
    this.emit("retex-change", this.getState());
  }

  emit(name, detail) {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true, composed: true }));
  }

  say(text) {
    this.$("[role=status]").textContent = text;
  }

  fail(message) {
    const box = this.$(".message");
    box.hidden = !message;
    box.firstChild.textContent = message || "";
    if (message) this.$(".room").classList.toggle("empty", !this.room); // there is nothing to control
    if (message) this.$(".bar").hidden = true, this.emit("retex-error", { message });
  }

  indexOf(name) {
    const index = this.targets.indexOf(name);
    if (index < 0) throw new Error(`The room has no '${name}'.`);
    return index;
  }
}

if (globalThis.customElements && !customElements.get("retex-room")) customElements.define("retex-room", RetexRoom);
