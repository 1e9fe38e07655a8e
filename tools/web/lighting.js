// ---- light: what is said of lamps, finishes and the picture ----

import { checkedLight } from "./edit.js";
import { finishesAsRendered, indexNamed, lampColor, lampText, lampsOf, parameterColors, parseLamp } from "./lamps.js";
import { mapOn } from "./textures.js";

/* What an element does with light. */
export const withLighting = (Base) => class extends Base {
  /* The lamps: names; values as in links, null as rendered; and colours, linear numbers. */
  get lamps() {
    return lampsOf(this.room || {}).map(({ name, index }, i) => ({ name, value: this.said[i], color: [...this.colors[index]] }));
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
};
