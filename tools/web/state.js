// ---- states and links ----

import { editText, hasGrout, layerKey, parseEdit, parsePreset } from "./edit.js";
import { fetchBytes } from "./files.js";
import { OVERS_MOST } from "./glsl.js";
import { finishesAsRendered, indexNamed } from "./lamps.js";
import { LAYING } from "./look.js";

/* An element's state as an object, and as a link. */
export const withState = (Base) => class extends Base {
  getState() {
    const textures = {}, said = ({ source, scale, rotate, offset, flip, wrap, repeat, adjust, ...t }, layer) => {
      const others = [...LAYING, "tiles", "finish", "normal"].filter((key) => t[key]).map((key) => [key, t[key]]);
      return { source, scale, rotate, offset, flip, ...(layer ? {} : { wrap, repeat }), ...Object.fromEntries(others), ...adjust };
    };
    this.textures.forEach((t, i) => {
      if (t.source) textures[this.targets[i]] = said(t);
      t.overs.filter((o) => o.source).forEach((o, k) => (textures[layerKey(this.targets[i], k + 1)] = said(o, true)));
    });
    const lamps = Object.fromEntries(this.lamps.filter((l) => l.value).map((l) => [l.name, l.value]));
    const finishes = {}, rendered = finishesAsRendered(this.room || {});
    this.targets.forEach((name, i) => {
      if (this.finishName(i) && this.finishes[i] !== rendered[i]) finishes[name] = this.finishName(i);
    });
    return { textures, light: Object.fromEntries(Object.entries(this.light).filter(([, value]) => value !== null && value !== false)), lamps, finishes };
  }

  async setState(state) {
    let failed;
    const { light } = state, plain = { exposure: Number(light?.exposure) || 0, warmth: Number(light?.warmth) || 0, autoExposure: null, view: null, whiteBalance: null };
    for (const said of [plain, { ...light, exposure: undefined, warmth: undefined }]) await this.setLight(said).catch((error) => (failed ||= error));
    const lamps = state.lamps || {}, others = lamps["*"] ?? null, values = Object.fromEntries(this.lamps.map((l) => [l.name, others]));
    for (const name of Object.keys(lamps)) {
      const index = indexNamed(this.lamps, name);
      if (index >= 0) values[this.lamps[index].name] = lamps[name];
    }
    this.finishes = finishesAsRendered(this.room || {});
    for (const [name, finish] of Object.entries(state.finishes || {})) {
      const index = indexNamed(this.room?.targets || [], name), chosen = index < 0 ? 0 : this.finishNumber(index, finish);
      if (chosen) this.finishes[index] = chosen;
    }
    this.recolor();
    await this.setLamps(values).catch((error) => (failed = error));
    for (const t of this.textures) t.overs = [];
    for (const name of this.targets) {
      const { source = null, ...options } = state.textures?.[name] || {};
      await this.setTexture(name, source, options).catch((error) => (failed ||= error));
      for (let k = 1; k <= OVERS_MOST; k++) {
        const { source: over, ...how } = state.textures?.[layerKey(name, k)] || {}, on = this.textures[this.indexOf(name)];
        if (over) await this.setTexture(layerKey(name, on.overs.length + 1), over, how).catch((error) => (failed ||= error));
      }
    }
    if (failed) throw failed;
  }

  /* What the room's state is called in links: several rooms of a page are told apart by their ids. */
  get key() {
    return `${encodeURIComponent(this.id || "room")}=`;
  }

  /* A link to the page with this room's state. Pictures from the visitor's own files are not in it. */
  get link() {
    const url = new URL(location.href), others = url.hash.slice(1).split("&").filter((part) => part.includes("=") && !part.startsWith(this.key));
    const state = this.getState();
    this.textures.forEach((own, i) => {
      const isColor = Array.isArray(own.image) && !own.map && !hasGrout(own); // it has none
      [own, ...own.overs.filter((o) => o.source)].forEach((t, k) => {
        const said = state.textures[k ? layerKey(this.targets[i], k) : this.targets[i]];
        if (said) said.scale = isColor && !k ? undefined : this.scaleOf(i, t);
      });
    });
    for (const key of ["exposure", "warmth"]) state.light[key] ||= null;
    const text = encodeURIComponent(editText(state)).replace(/%(3B|3D|2C|2F|3A)/g, decodeURIComponent);
    url.hash = [...others, this.key + text].join("&");
    return url.href;
  }

  /* Take the state that the page's address has. False: it has none. */
  async restore() {
    const part = location.hash.slice(1).split("&").find((text) => text.startsWith(this.key));
    if (!part || !this.renderer || this.hasAttribute("no-link")) return false;
    try {
      const text = decodeURIComponent(part.slice(this.key.length));
      await this.setState(text.startsWith("{") ? JSON.parse(text) : parseEdit(text)); // links were JSON once
    } catch (error) {
      this.fail(`The link's textures could not be restored: ${error.message}`);
    }
    return true;
  }

  /* Take the look that the room begins with, that of the attribute `preset`. */
  async putPreset() {
    const address = new URL(this.getAttribute("preset"), document.baseURI);
    try {
      const text = new TextDecoder().decode(await fetchBytes(address, this.abort.signal, "no-cache"));
      await this.setState(parsePreset(text, address, new URL(".", document.baseURI).href));
    } catch (error) {
      this.fail(`${address.pathname.split("/").at(-1)}, the room's look, could not be shown: ${error.message}`);
    }
  }
};
