/* Servers that render pages import the script too, and have no elements. */
class RetexRoom extends withTextures(globalThis.HTMLElement || Object) {
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
    this.loading = 0;
    this.listen(root);
    this.$("[data-do=full]").hidden = !document.fullscreenEnabled;
    this.restore = this.restore.bind(this);
  }

  connectedCallback() {
    addEventListener("hashchange", this.restore);
    this.togglePanel(this.getAttribute("panel") !== "closed");
    if (!this.started && this.hasAttribute("src")) this.load();
  }

  disconnectedCallback() {
    removeEventListener("hashchange", this.restore);
    this.abort?.abort();
    this.started = false;
  }

  attributeChangedCallback() {
    if (this.isConnected) this.load();
  }

  // ---- public ----

  /* The names of what can be changed. */
  get targets() {
    return this.room ? this.room.targets.map((t) => t.name) : [];
  }

  /* The lamps: names; values as in links, null as rendered; and colours, linear numbers. */
  get lamps() {
    return lampsOf(this.room || {}).map(({ name, index }, i) => ({ name, value: this.said[i], color: [...this.colors[index]] }));
  }

  /* Resolves when all is loaded. */
  get complete() {
    return this.whenComplete;
  }

  /* Exposure in stops, warmth from -1 to 1, whiteBalance in kelvins, autoExposure, and the view by its name; null takes one
   * away. Or, by name, the value of a lamp, as "1.5*3000K", "#ffd0a0", 0; null: as rendered. Resolves when it is drawn. */
  async setLight(light, value = null) {
    if (typeof light === "string") return this.setLamps({ [light]: value });
    Object.assign(this.light, checkedLight(light));
    this.update();
  }

  /* By name. Their light is loaded when the first of them needs it. */
  async setLamps(values) {
    const lamps = lampsOf(this.room || {}), said = [...this.said];
    for (const [name, value] of Object.entries(values)) {
      const index = indexNamed(lamps, name), parsed = value === null ? null : parseLamp(String(value));
      if (index < 0) throw new Error(`The room has no '${name}'.`);
      if (parsed && !lampColor(parsed, lamps[index]).every((x) => x < 3e38)) throw new Error(`The light of ${name} becomes too bright.`);
      said[index] = parsed && lampText(parsed);
    }
    this.said = said;
    await this.relight();
  }

  /* One of a target's finishes by name; null: as rendered. Resolves when it is drawn. */
  async setFinish(name, finish = null) {
    const index = this.indexOf(name), chosen = this.finishNumber(index, finish);
    if (finish !== null && !chosen) throw new Error(`${name} has no finish '${finish}'.`);
    this.finishes[index] = chosen;
    this.say(`${name}: ${this.finishName(index) || "finish as rendered"}`);
    await this.relight();
  }

  /* Draw with what is said of lamps and finishes. */
  async relight() {
    this.recolor();
    this.update();
    await this.loadLamps();
  }

  recolor() {
    this.colors = this.colorsWith(this.finishes);
  }

  colorsWith(finishes) {
    return parameterColors(this.room || {}, this.said.map((text) => text && parseLamp(text)), finishes);
  }

  /* Where maps say which finish is where, light of all finishes is needed. */
  mapColors() {
    return this.textures.some(mapOn) ? this.colorsWith(this.finishes.map((f, t) => (mapOn(this.textures[t]) ? null : f))) : this.colors;
  }

  /* The finishes of a target that can be chosen: those for normal maps cannot. */
  finishesOf(target) {
    const { finishes = [], normal_tilt: tilt } = this.room.targets[target];
    return tilt ? [] : finishes;
  }

  /* From 1; 0: the target does not have it. */
  finishNumber(target, name) {
    const finishes = this.finishesOf(target);
    return name === null ? finishesAsRendered(this.room)[target] : 1 + indexNamed(finishes.map((text) => ({ name: text })), String(name));
  }

  /* Of the one that is chosen. */
  finishName(target) {
    return this.finishesOf(target)[this.finishes?.[target] - 1];
  }

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

  /* The picture in the room's own size. */
  toBlob(type = "image/png", quality) {
    this.draw(true);
    return new Promise((resolve) => this.$("canvas").toBlob(resolve, type, quality));
  }

  select(name) {
    this.selected = this.indexOf(name);
    this.refresh();
    this.emit("retex-select", { target: name });
  }

  // ---- loading ----

  /* kept: textures that come back with the room, after the graphics card was lost. */
  async load(kept) {
    this.started = true;
    this.abort?.abort();
    const abort = (this.abort = new AbortController());
    this.renderer = this.room = this.lampsComing = null;
    this.textures = [];
    this.fail(null);
    this.whenComplete = this.run(abort.signal, kept).catch((error) => {
      if (!abort.signal.aborted) this.fail(error.message);
    });
  }

  async run(signal, kept) {
    const base = new URL(this.getAttribute("src").replace(/\/?$/, "/"), document.baseURI);
    const text = new TextDecoder().decode(await fetchBytes(new URL("room.json", base), signal, "no-cache"));
    let room;
    try {
      room = JSON.parse(text);
    } catch {
      throw new Error("room.json is damaged.");
    }
    try {
      checkManifest(room);
    } catch (error) {
      throw error instanceof TypeError ? new Error("room.json is damaged.") : error;
    }
    if (signal.aborted) return;
    this.room = room;
    this.textures = room.targets.map((_, i) => ({ ...(kept?.[i] || plainTexture()), put: {} }));
    if (!kept) this.said = lampsOf(room).map(() => null), this.finishes = finishesAsRendered(room);
    this.recolor();
    if (!kept) this.selected = room.targets.reduce((best, t, i) => (t.share > room.targets[best].share ? i : best), 0);
    this.$(".view").style.setProperty("--ratio", room.width / room.height);
    this.refresh();
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
    shown.src = new URL(room.picture.file, base).href;
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
    this.emit("retex-complete", {});
    this.say("All is loaded.");
  }

  /* The first target can be changed. */
  async begin(kept) {
    this.$("canvas").classList.add("shown");
    this.textures.forEach((_, i) => this.put(i));
    this.emit("retex-ready", { targets: this.targets });
    if (!kept) await this.restore();
    else await this.loadLamps();
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

  /* Take the state that the page's address has. */
  async restore() {
    const part = location.hash.slice(1).split("&").find((text) => text.startsWith(this.key));
    if (!part || !this.renderer || this.hasAttribute("no-link")) return;
    try {
      const text = decodeURIComponent(part.slice(this.key.length));
      await this.setState(text.startsWith("{") ? JSON.parse(text) : parseEdit(text)); // links were JSON once
    } catch (error) {
      this.fail(`The link's textures could not be restored: ${error.message}`);
    }
  }

  // ---- drawing ----

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
    if (message) this.$(".bar").hidden = true, this.emit("retex-error", { message });
  }

  indexOf(name) {
    const index = this.targets.indexOf(name);
    if (index < 0) throw new Error(`The room has no '${name}'.`);
    return index;
  }

  // ---- controls ----

  /* Pictures and colours that are offered: attribute `textures`, URLs separated by blanks. */
  get offers() {
    const given = (this.getAttribute("textures") || "").split(/\s+/).filter(Boolean);
    return [...given, "#e9e4da", "#b9a48c", "#7d5f48", "#8b9a86", "#44525c", "#2b2b2b"];
  }

  refresh() {
    const { room } = this, texture = this.textures[this.selected];
    if (!room) return;
    const row = this.$(".targets");
    if (row.children.length !== room.targets.length)
      row.replaceChildren(...room.targets.map((t) => {
        const button = document.createElement("button");
        button.textContent = t.name;
        button.onclick = () => this.select(t.name);
        return button;
      }));
    [...row.children].forEach((button, i) => {
      button.setAttribute("aria-pressed", i === this.selected);
      button.disabled = !this.renderer?.canEdit(i);
      button.title = this.renderer?.isSeen(i) === false ? "Not seen in this picture" : "";
    });
    if (!this.offered)
      this.offered = this.offers.map((source) => {
        const button = document.createElement("button"), color = parseColor(source);
        button.className = "swatch";
        button.style.background = color ? source : `url("${new URL(source, document.baseURI).href.replace(/"/g, "%22")}")`;
        button.dataset.source = source;
        button.title = color ? source : wordsOf(nameOf(source));
        button.setAttribute("aria-label", color ? `Colour ${source}` : button.title);
        button.onclick = () => this.try(() => this.setTexture(this.targets[this.selected], source));
        if (color) this.$("[data-set=color]").before(button);
        else this.$(".images").append(button);
        return button;
      });
    const off = !this.renderer?.canEdit(this.selected);
    for (const button of this.offered) button.disabled = off, button.setAttribute("aria-pressed", button.dataset.source === texture.source);
    this.$("[data-set=exposure]").disabled = this.$("[data-set=warmth]").disabled = !this.renderer;
    this.$("[data-set=file]").disabled = this.$("[data-set=color]").disabled = this.$("[data-do=original]").disabled = off;
    this.$(".chosen:not(.map)").textContent = wordsOf(texture.label);
    this.$(".placing").hidden = !texture.image || Array.isArray(texture.image);
    const mean = Array.isArray(texture.scale) ? texture.scale[0] : texture.scale;
    const show = (key, value, text) => {
      const input = this.$(`[data-set=${key}]`), output = input.parentElement.querySelector("output");
      if (this.shadowRoot.activeElement !== input || input.type !== "range") input.value = value;
      if (output) output.textContent = text;
      if (text) input.setAttribute("aria-valuetext", text);
    };
    show("size", -Math.log2(mean), `${(1 / mean).toFixed(2)}×`);
    show("rotate", texture.rotate, `${Math.round(texture.rotate)}°`);
    show("right", texture.offset[0], texture.offset[0].toFixed(2));
    show("up", texture.offset[1], texture.offset[1].toFixed(2));
    show("tint", texture.adjust.tint || "#ffffff", "");
    show("repeat", texture.repeat, "");
    const { uv_scale: unit } = room.targets[this.selected], { saturation = 1, gain = [1] } = texture.adjust, lies = this.measures(texture), grout = lies.grout ? lies.grout / lies.width[0] : 0;
    show("grout", grout, `${Math.round(100 * grout)} %`);
    show("saturation", saturation, `${saturation}×`);
    show("lightness", Math.log2(gain[0]), `${Number(gain[0].toFixed(2))}×`);
    this.$("[data-set=grout]").disabled = !(unit[0] > 0 && unit[1] > 0) || texture.repeat === "mirror" || texture.wrap !== "repeat";
    this.refreshFinishes();
    this.refreshLamps();
    show("exposure", this.light.exposure, (this.light.exposure > 0 ? "+" : "") + this.light.exposure.toFixed(2));
    show("warmth", this.light.warmth, (this.light.warmth > 0 ? "+" : "") + this.light.warmth.toFixed(2));
    const lamps = this.lamps.filter((l) => l.value).map((l) => `${l.name}: ${isBlack(l.color) ? "off" : "changed"}`);
    this.$("canvas").setAttribute("aria-label", `The room. ${[...this.targets.map((n, i) => `${n}: ${[this.textures[i], ...this.textures[i].overs].map((t) => t.label).join(" + ")}${this.finishName(i) ? ` (${this.finishName(i)})` : ""}`), ...lamps].join(", ")}.`);
  }

  /* The finishes of the target that the controls change. */
  refreshFinishes() {
    const box = this.$(".finishes"), { name } = this.room.targets[this.selected], finishes = this.finishesOf(this.selected), of = [name, ...finishes].join();
    const { image, map, mapLabel } = this.textures[this.selected], chosen = this.finishes[this.selected], rendered = this.finishNumber(this.selected, null);
    this.$(".finish").hidden = !finishes.length;
    if (box.dataset.of !== of)
      box.replaceChildren(...finishes.map((text, i) => {
        const label = document.createElement("label"), input = document.createElement("input");
        label.className = "file";
        label.title = i + 1 === rendered ? "As rendered" : "";
        Object.assign(input, { type: "radio", name: "finish", value: text });
        input.dataset.set = "finish";
        label.append(input, text);
        return label;
      }));
    box.dataset.of = of;
    for (const input of box.querySelectorAll("input")) input.checked = input.value === finishes[chosen - 1], input.disabled = !this.renderer || !!map;
    this.$("[data-do=rendered]").disabled = !this.renderer || !!map || chosen === rendered;
    this.$("[data-set=map]").disabled = !this.renderer || !image;
    this.$("[data-do=unmap]").disabled = !map;
    this.$(".map").textContent = map ? wordsOf(mapLabel) : image ? "" : "Maps need a new texture";
  }

  /* A row a lamp. */
  refreshLamps() {
    const box = this.$(".lamps"), all = lampsOf(this.room);
    if (box.children.length !== all.length)
      box.replaceChildren(...all.map(({ name }, i) => {
        const row = document.createElement("div");
        row.className = "lamp";
        row.innerHTML = LAMP_ROW;
        row.dataset.lamp = i;
        row.setAttribute("role", "group");
        row.setAttribute("aria-label", name);
        row.querySelector("span").textContent = name;
        for (const input of row.querySelectorAll("input")) input.setAttribute("aria-label", `${name}: ${input.dataset.set === "gain" ? "strength" : "warmth"}`);
        const [lit, reset] = row.querySelectorAll("button");
        reset.setAttribute("aria-label", `${name}: as rendered`);
        lit.onclick = () => this.switchLamp(i);
        reset.onclick = () => (lit.focus(), this.try(() => this.setLight(name)));
        return row;
      }));
    all.forEach((lamp, i) => {
      const row = box.children[i], { gain, color } = this.lampValue(i), lit = !isBlack(this.colors[lamp.index]);
      const [button, reset] = row.querySelectorAll("button"), mired = miredOf(color || (lamp.several || isBlack(lamp.value) ? [1, 1, 1] : lamp.value));
      const show = (key, value, text) => {
        const input = row.querySelector(`[data-set=${key}]`);
        input.disabled = !this.renderer;
        if (this.shadowRoot.activeElement !== input && value !== null) input.value = value;
        input.setAttribute("aria-valuetext", text);
        input.parentElement.querySelector("output").textContent = text;
      };
      button.setAttribute("aria-pressed", lit);
      button.querySelector("i").textContent = lit ? "on" : "off";
      button.disabled = !this.renderer;
      reset.disabled = !this.said[i];
      if (gain) show("gain", Math.log2(gain), `${Number(gain.toPrecision(gain < 1 ? 2 : 3))}×`);
      else show("gain", null, "off");
      show("mired", mired, color ? (mired ? `${kelvinOf(mired)} K` : "colour") : "own");
    });
  }

  /* What is said of a lamp, as parseLamp has it. */
  lampValue(index) {
    return this.said[index] ? parseLamp(this.said[index]) : { gain: isBlack(lampsOf(this.room)[index].value) ? 0 : 1, color: null };
  }

  /* Change what is said of a lamp; as it was rendered nothing is. */
  changeLamp(index, change) {
    const { name, value } = lampsOf(this.room)[index], said = { ...this.lampValue(index), ...change };
    const isPlain = !said.color && said.gain === (isBlack(value) ? 0 : 1);
    return this.try(() => this.setLight(name, isPlain ? null : lampText(said)));
  }

  /* Off, and on again as it was. */
  switchLamp(index) {
    const { gain, color } = this.lampValue(index), row = this.$(".lamps").children[index], on = !gain;
    if (gain) row.before = gain;
    this.say(`${lampsOf(this.room)[index].name}: ${on ? "on" : "off"}`);
    return this.changeLamp(index, { gain: on ? row.before || 1 : 0, color });
  }

  async try(action) {
    try {
      this.fail(null);
      await action();
    } catch (error) {
      this.fail(error.message);
    }
  }

  setControl(input) {
    const name = this.targets[this.selected], texture = this.textures[this.selected], value = Number(input.value);
    if (!texture) return;
    switch (input.dataset.set) {
      case "file": {
        const files = [...input.files];
        input.value = "";
        if (files.length) this.try(() => this.setTexture(name, files));
        break;
      }
      case "map": {
        const [file] = input.files;
        input.value = "";
        if (file) this.try(() => this.setMap(name, file));
        break;
      }
      case "color": return this.try(() => this.setTexture(name, input.value));
      case "finish": return this.try(() => this.setFinish(name, input.value));
      case "size": {
        const times = 2 ** -value, old = texture.scale;
        return this.place(name, { scale: Array.isArray(old) ? [times, old[1] / old[0] * times] : times });
      }
      case "rotate": return this.place(name, { rotate: value });
      case "right": return this.place(name, { offset: [value, texture.offset[1]] });
      case "up": return this.place(name, { offset: [texture.offset[0], value] });
      case "tint":
      case "saturation": return this.try(() => this.place(name, { [input.dataset.set]: input.value }));
      case "lightness": return this.try(() => this.place(name, { gain: Number((2 ** value).toPrecision(3)) }));
      case "grout": {
        const { width, at } = this.measures(texture), measured = { width, at, ...this.measured(this.selected) };
        return this.try(() => this.place(name, { ...measured, grout: value * measured.width[0] }));
      }
      case "repeat": return this.try(() => this.place(name, { repeat: input.value, ...(BONDS.includes(input.value) ? this.measured(this.selected) : {}) }));
      case "gain": return this.changeLamp(Number(input.closest("[data-lamp]").dataset.lamp), { gain: Number((2 ** value).toPrecision(3)) });
      case "mired": return this.changeLamp(Number(input.closest("[data-lamp]").dataset.lamp), { color: kelvinColor(kelvinOf(value)) });
      default: return this.setLight({ [input.dataset.set]: value });
    }
  }

  async command(name) {
    switch (name) {
      case "compare":
        this.comparing = !this.comparing;
        this.$("[data-do=compare]").setAttribute("aria-pressed", this.comparing);
        this.$(".split").hidden = this.$(".line").hidden = !this.comparing;
        if (this.comparing) this.$(".split").focus();
        this.moveLine();
        return this.draw(false);
      case "panel": return this.togglePanel();
      case "in": return this.zoomBy(1.5);
      case "out": return this.zoomBy(1 / 1.5);
      case "full": return document.fullscreenElement ? document.exitFullscreen() : this.requestFullscreen();
      case "original": {
        this.textures[this.selected].overs = [];
        return this.setTexture(this.targets[this.selected], null);
      }
      case "unmap": {
        const done = this.setMap(this.targets[this.selected], null);
        this.$("[data-set=map]").focus(); // the button cannot be used any more
        return done;
      }
      case "rendered": {
        const done = this.setFinish(this.targets[this.selected]);
        this.$(".finishes input:checked").focus(); // the button cannot be used any more
        return done;
      }
      case "link": {
        const local = this.textures.some((t) => [t, ...t.overs].some((x) => x.local) || (t.map && !t.finish));
        let where = "Link copied.";
        history.replaceState(null, "", this.link);
        try {
          await navigator.clipboard.writeText(this.link);
        } catch {
          where = "The link is in the address bar.";
        }
        return this.note(local ? `${where} Your own pictures are not in it.` : where);
      }
      case "download": {
        const a = document.createElement("a"), comparing = this.comparing;
        this.comparing = false;
        a.href = this.renderer ? URL.createObjectURL(await this.toBlob()) : this.$("img").src;
        this.comparing = comparing;
        this.draw(false);
        a.download = this.renderer ? "room.png" : "room.jpg";
        a.click();
        return setTimeout(() => URL.revokeObjectURL(a.href), 1000);
      }
    }
  }

  /* Show the controls, or only the picture. */
  togglePanel(open = this.$(".panel").hidden) {
    this.$(".panel").hidden = !open;
    this.$(".room").classList.toggle("wide", !open);
    this.$("[data-do=panel]").setAttribute("aria-expanded", open);
  }

  /* Show a few words for a moment. */
  note(text) {
    const label = this.$(".name");
    label.textContent = text;
    label.hidden = false;
    clearTimeout(this.noting);
    this.noting = setTimeout(() => (label.hidden = true), 2500);
    this.say(text);
  }

  moveLine() {
    const { left, top, width, height } = this.$("canvas").getBoundingClientRect(), stage = this.$(".stage").getBoundingClientRect();
    const split = this.$(".split");
    const bottom = Math.min(top + height, stage.bottom) - stage.top;
    Object.assign(split.style, { left: `${left - stage.left - 22}px`, width: `${width + 44}px`, top: `${bottom - 52}px` });
    const x = left - stage.left + (width * split.value) / 100;
    Object.assign(this.$(".line").style, { left: `${x}px`, top: `${top - stage.top}px`, height: `${height}px` });
  }

  zoomBy(times, x, y) {
    const stage = this.$(".stage").getBoundingClientRect(), z = this.zoom, next = clamp(z.times * times, 1, 12);
    const view = this.$(".view"), left = view.offsetLeft, top = view.offsetTop;
    const px = (x ?? stage.left + stage.width / 2) - stage.left - left, py = (y ?? stage.top + stage.height / 2) - stage.top - top;
    this.panTo(px - ((px - z.x) * next) / z.times, py - ((py - z.y) * next) / z.times, next);
  }

  panTo(x, y, times = this.zoom.times) {
    const view = this.$(".view"), width = view.offsetWidth, height = view.offsetHeight;
    this.zoom = { times, x: clamp(x, width - width * times, 0), y: clamp(y, height - height * times, 0) };
    view.style.transform = times > 1 ? `translate(${this.zoom.x}px, ${this.zoom.y}px) scale(${times})` : "";
    this.$(".stage").classList.toggle("zoomed", times > 1);
    this.moveLine();
  }

  /* The target that is seen at a place of the window, or -1. */
  targetAt(x, y) {
    const box = this.$("canvas").getBoundingClientRect(), room = this.room;
    if (!room || !this.renderer) return -1;
    const px = Math.floor(((x - box.left) / box.width) * room.width), py = Math.floor(((y - box.top) / box.height) * room.height);
    if (px < 0 || py < 0 || px >= room.width || py >= room.height) return -1;
    const seen = this.renderer.full.filter((c) => c.heads && c.heads[py * room.width + px] & 31);
    return seen.length ? seen.reduce((a, b) => (room.targets[a.target].share < room.targets[b.target].share ? a : b)).target : -1;
  }

  listen(root) {
    const stage = this.$(".stage"), canvas = this.$("canvas"), pointers = new Map();
    let moved = 0, pinch = 0;
    root.addEventListener("input", ({ target }) => {
      if (target.classList.contains("split")) this.moveLine(), this.draw(false);
      else if (target.dataset.set) this.setControl(target);
    });
    root.addEventListener("click", ({ target }) => {
      const button = target.closest("[data-do]");
      if (button) this.try(() => this.command(button.dataset.do));
    });
    const isPicture = (event) => !event.target.closest("button, input");
    stage.addEventListener("pointerdown", (event) => {
      if (!isPicture(event)) return;
      pointers.set(event.pointerId, event);
      moved = pointers.size > 1 ? 99 : 0;
      pinch = 0;
    });
    stage.addEventListener("pointermove", (event) => {
      const last = pointers.get(event.pointerId);
      if (!last) {
        if (event.pointerType === "mouse" && isPicture(event)) this.hover(event);
        return;
      }
      const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
      moved += Math.abs(dx) + Math.abs(dy);
      pointers.set(event.pointerId, event);
      if (pointers.size === 2) {
        const [a, b] = pointers.values(), far = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (pinch) this.zoomBy(far / pinch, (a.clientX + b.clientX) / 2, (a.clientY + b.clientY) / 2);
        pinch = far;
      } else if (moved > 6 && this.zoom.times > 1) {
        if (!stage.hasPointerCapture(event.pointerId)) stage.setPointerCapture(event.pointerId);
        this.panTo(this.zoom.x + dx, this.zoom.y + dy);
      }
    });
    const end = (event) => {
      if (!pointers.delete(event.pointerId) || event.type !== "pointerup" || moved > 6) return;
      const target = this.targetAt(event.clientX, event.clientY);
      if (target < 0 || !this.renderer.canEdit(target)) return;
      this.select(this.targets[target]);
      this.note(this.targets[target]);
    };
    stage.addEventListener("pointerup", end);
    stage.addEventListener("pointercancel", end);
    stage.addEventListener("pointerleave", () => (this.$(".name").hidden = true));
    stage.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && this.zoom.times === 1 && event.deltaY > 0) return; // the page scrolls
      event.preventDefault();
      this.zoomBy(2 ** (-event.deltaY / 300), event.clientX, event.clientY);
    }, { passive: false });
    stage.addEventListener("dblclick", (event) => isPicture(event) && (this.zoom.times > 1 ? this.panTo(0, 0, 1) : this.zoomBy(2.5, event.clientX, event.clientY)));
    stage.addEventListener("keydown", (event) => {
      if (event.target !== stage) return;
      const step = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] }[event.key];
      if (step) this.panTo(this.zoom.x + step[0], this.zoom.y + step[1]);
      else if (event.key === "+" || event.key === "=") this.zoomBy(1.5);
      else if (event.key === "-") this.zoomBy(1 / 1.5);
      else if (event.key === "0") this.panTo(0, 0, 1);
      else return;
      event.preventDefault();
    });
    const room = this.$(".room"), dropAt = (event) => {
      const target = this.targetAt(event.clientX, event.clientY);
      return target >= 0 && this.renderer.canEdit(target) ? target : this.selected;
    };
    const isMap = (event) => !!event.target.closest?.(".finish") && !this.$("[data-set=map]").disabled;
    const drag = (event, on) => {
      event.preventDefault();
      room.classList.toggle("drop", on && !!this.renderer);
      this.hover(event);
      const where = isMap(event) ? `Map of finishes: ${this.targets[this.selected]}` : `Put it on: ${this.targets[dropAt(event)]}`;
      if (on && this.renderer) this.$(".name").hidden = false, (this.$(".name").textContent = where);
    };
    room.addEventListener("dragover", (event) => drag(event, true));
    room.addEventListener("dragleave", (event) => room.contains(event.relatedTarget) || drag(event, false));
    room.addEventListener("drop", (event) => {
      drag(event, false);
      if (!event.dataTransfer.files.length || !this.renderer) return;
      const dropped = droppedFiles(event.dataTransfer), asMap = isMap(event);
      if (!asMap) this.select(this.targets[dropAt(event)]);
      const name = this.targets[this.selected];
      this.try(async () => {
        const files = await dropped;
        if (files.length) await (asMap ? this.setMap(name, files[0]) : this.setTexture(name, files));
      });
    });
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.abort?.abort();
      this.renderer = null;
      canvas.classList.remove("shown");
      this.refresh();
      this.fail("The graphics card was needed elsewhere. The room comes back when it is free; reload the page if it does not.");
    });
    canvas.addEventListener("webglcontextrestored", () => this.isConnected && this.load(this.textures[0] && this.textures));
    new ResizeObserver(() => this.panTo(this.zoom.x, this.zoom.y)).observe(stage);
  }

  hover(event) {
    const target = this.targetAt(event.clientX, event.clientY), label = this.$(".name");
    label.hidden = target < 0;
    if (target >= 0) label.textContent = this.targets[target];
    clearTimeout(this.noting);
  }
}


const drawingContext = (width, height) => Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");

/* Which one a name means: exactly, else ignoring case if that is unique; or -1. */
function indexNamed(list, name) {
  const exact = list.findIndex((l) => l.name === name), alike = list.filter((l) => l.name.toLowerCase() === name.toLowerCase());
  return exact < 0 && alike.length === 1 ? list.indexOf(alike[0]) : exact;
}

if (globalThis.customElements && !customElements.get("retex-room")) customElements.define("retex-room", RetexRoom);
