// ---- the panel's controls ----

import { BONDS } from "./edit.js";
import { nameOf } from "./files.js";
import { isBlack, kelvinColor, kelvinOf, lampText, lampsOf, miredOf, parseLamp } from "./lamps.js";
import { wordsOf } from "./look.js";
import { LAMP_ROW } from "./page.js";
import { parseColor } from "./values.js";

/* What an element's controls show and do. */
export const withControls = (Base) => class extends Base {
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
};
