// ---- what lies on targets: textures, and how they lie ----

import { NOT_OF_LAYERS, hasGrout, layerOf, textOf } from "./edit.js";
import { fetchBytes, nameOf } from "./files.js";
import { hasRoughness, readFolder } from "./folders.js";
import { MOST_LAID, isLaid, layoutOf } from "./lay.js";
import { lie, placing, plainTexture, readOption } from "./look.js";
import { DRAWING, MOST_SIDE, decodePicture, sizeOf, smaller } from "./pictures.js";
import { readColor } from "./values.js";

const mapOf = (map, from, channel = null) => ({
  map, channel: map && channel, finish: map && !(from instanceof Blob) ? String(from) : "", mapLabel: map ? (from instanceof Blob ? from.name || "Picture" : nameOf(String(from))) : "",
});

/* Where a map counts: that of a folder does not below layers. */
export const mapOn = ({ map, channel, overs }) => (channel && overs.length ? null : map);

/* What an element does with textures. */
export const withTextures = (Base) => class extends Base {
  /* Put a texture on a target, or as a layer on it, "over:Floor", "over2:Floor": a File or Blob, a list of the Files of one
   * texture, the URL of a picture, a colour as in retex-edit(5), or null for the original or no layer. options: scale (a number
   * keeps the picture's proportions, a pair is as of retex-combine), rotate in degrees, offset [u, v], label; finish: a File,
   * Blob or URL of a picture that says which finish is where, or "none"; the others as of retex-edit(5). Resolves when it is
   * drawn. */
  async setTexture(name, source, options = {}) {
    const { index, layer } = this.placeOf(name), target = this.textures[index], orders = (target.orders ||= []), order = (orders[layer] = (orders[layer] || 0) + 1);
    let image = null, label = "Original", kept = null, rough = null, channel = null;
    const tiles = source ? textOf(options.tiles ?? "") : "";
    if (Array.isArray(source)) {
      const folder = source.length > 1 ? readFolder(source) : { color: source[0] };
      source = folder.color;
      if (folder.rough && !options.finish && !tiles && !layer && hasRoughness(this.room.targets[index])) ({ rough, channel } = folder);
    }
    if (source instanceof Blob) {
      label = source.name || "Picture";
      image = await decodePicture(source, label);
    } else if (source) {
      kept = String(source);
      image = readColor(kept);
      label = kept;
      if (!image) {
        label = nameOf(kept);
        image = await this.fetchPicture(kept);
      }
    }
    const chosen = options.finish || rough, hasMap = image && chosen && chosen !== "none";
    if (layer && Array.isArray(image)) throw new Error(`${name} must be an image, not a colour.`);
    if (hasMap && tiles) throw new Error("finish cannot be used with tiles, which have no map of their own.");
    readOption("tiles", tiles);
    const map = hasMap ? await this.getMap(index, chosen) : null;
    const tileImages = await Promise.all(tiles ? tiles.split(",").map((tile) => this.fetchPicture(tile)) : []);
    const normal = image && options.normal !== "none" && String(options.normal ?? ""); // it stays in states, for the tools
    if (order !== orders[layer]) return; // another one has been chosen since
    const texture = { ...plainTexture(), source: kept, label, image, local: source instanceof Blob, normal: normal || "", tiles, tileImages, ...mapOf(map, chosen, channel) };
    if (layer) this.putLayer(name, index, layer, image && texture, options);
    else this.change(name, index, target, { ...texture, overs: target.overs, orders }, options);
    this.say(`${name}: ${image || !layer ? label : "no layer"}${normal ? "; a page does not show normal maps" : ""}`);
  }

  /* Another map, or null, on what lies on a target already. */
  async setMap(name, map) {
    const index = this.indexOf(name), texture = this.textures[index], orders = (texture.orders ||= []), order = (orders[0] = (orders[0] || 0) + 1);
    if (map && !texture.image) throw new Error(`A map of finishes needs a new texture on ${name}.`);
    const image = map && (await this.getMap(index, map));
    if (order !== orders[0]) return;
    this.change(name, index, texture, mapOf(image, map), {});
    this.say(map ? `${name}: map of finishes ${texture.mapLabel}` : `${name}: no map of finishes`);
  }

  async fetchPicture(address) {
    const bytes = await fetchBytes(new URL(address, document.baseURI), this.abort.signal), name = nameOf(address);
    return decodePicture(new Blob([bytes], { type: /\.svg$/i.test(name) ? DRAWING : "" }), name);
  }

  /* A picture that says which finish of a target is where. */
  async getMap(index, map) {
    if (!this.finishesOf(index).length) throw new Error(`${this.targets[index]} has no finishes to choose from.`);
    return map instanceof Blob ? decodePicture(map, map.name || "Picture") : this.fetchPicture(String(map));
  }

  /* Change how a texture or a layer lies and looks: the options of setTexture, but finish and tiles. */
  place(name, options) {
    const { index, layer } = this.placeOf(name), target = this.textures[index];
    if (layer > target.overs.length) throw new Error(`There is no ${name}.`);
    if (layer) this.putLayer(name, index, layer, target.overs[layer - 1], options);
    else this.change(name, index, target, {}, options);
  }

  /* The target that a name means, and the layer on it, from 1; 0: the texture itself. */
  placeOf(name) {
    const [target, layer] = this.targets.includes(name) ? [name, 0] : layerOf(name);
    return { index: this.indexOf(target), layer };
  }

  /* Change a texture; what cannot be leaves all as it was. */
  change(name, index, texture, changes, options) {
    const before = { ...texture };
    try {
      Object.assign(texture, changes);
      Object.assign(texture, placing(texture, options));
      this.checkTexture(name, index, texture);
      this.put(index);
    } catch (error) {
      Object.assign(texture, before, { put: texture.put });
      this.put(index);
      throw error;
    }
    this.update();
  }

  checkTexture(name, index, { image, map, channel, tiles, grout, width, overs }) {
    const { uv_scale: unit } = this.room.targets[index];
    if (width && (!Array.isArray(image) || parseFloat(grout) > 0) && !(unit[0] > 0 && unit[1] > 0)) throw new Error(`The size of ${name} is not known: width cannot be used on it, only scale.`);
    if (map && tiles) throw new Error(`${name}: finish cannot be used with tiles, which have no map of their own.`);
    if (map && !channel && overs.length) throw new Error(`${name}: finish cannot be used below layers.`);
  }

  /* The layer of that number, null to take it away; the ones above move down. */
  putLayer(name, index, layer, texture, options) {
    const { overs } = this.textures[index], other = NOT_OF_LAYERS.find((key) => options[key] && !["none", "repeat", "straight"].includes(options[key]));
    if (layer > overs.length + 1) throw new Error(`${name}: there is no layer below it.`);
    if (other) throw new Error(`${name} lies there once: it has no ${other}.`);
    const own = texture && { ...texture, wrap: "black", ...placing({ ...texture, wrap: "black" }, { ...options, wrap: "black", repeat: null, finish: null }) };
    if (own) this.checkTexture(name, index, own);
    this.change(name, index, this.textures[index], { overs: [...overs.slice(0, layer - 1), ...(own ? [own] : []), ...overs.slice(layer)] }, {});
  }

  /* Give the renderer a target's texture and layers, if they are others. */
  put(index) {
    const { renderer } = this, texture = this.textures[index], { image, tileImages, groutcolor, vary } = texture, map = mapOn(texture), wrap = this.wrapOf(texture);
    const most = Math.min(renderer?.most || MOST_SIDE, MOST_SIDE), laid = this.measures(texture);
    const isLaidImage = image && (map || !Array.isArray(image) || laid.grout > 0) && isLaid(laid), all = [image, ...tileImages, ...(map ? [map] : [])];
    const layout = isLaidImage ? layoutOf(laid, this.finestOf(all), most, map ? MOST_LAID / 4 : MOST_LAID) : null; // with a map there are several
    if (!renderer) return;
    const adjust = Object.entries(texture.adjust), how = JSON.stringify([adjust, layout && [layout, groutcolor, vary, laid.width], map || adjust.length ? wrap : 0]);
    const isSame = (made, of) => made && made.length === of.length && made.every((x, k) => x === of[k]), key = [...all, !!map, how];
    const fit = (x) => (x?.naturalWidth && Math.max(x.naturalWidth, x.naturalHeight) > most ? smaller(x, most) : x);
    if (!isSame(texture.put.key, key)) {
      texture.put = {};
      renderer.putTexture(index, fit(image), { tiles: tileImages.map(fit), adjust, laid, layout, wrap, map: fit(map), channel: texture.channel });
    }
    texture.put = { key, period: layout?.period };
    const overs = this.textures.flatMap((t, i) => t.overs.flatMap((o) => [i, o.image, JSON.stringify(Object.entries(o.adjust))]));
    if (!isSame(renderer.overKey || [], overs))
      renderer.putOvers(this.textures.map((t) => t.overs.map((o) => ({ image: fit(o.image), adjust: Object.entries(o.adjust) }))));
    renderer.overKey = overs;
  }

  /* The texels of the repeats of a texture of several images: the finest of these decides, in the first one's shape. */
  finestOf([first, ...others]) {
    return others.reduce((most, other) => {
      const finer = Math.max(...sizeOf(other).map((x, k) => x / most[k]));
      return finer > 1 ? most.map((x) => Math.ceil(x * finer)) : most;
    }, sizeOf(first));
  }

  /* A texture with its lengths as scene units; the width as a pair, the second one 0 if the image's proportions say it. */
  measures(texture) {
    const { unit = 1 } = this.room, lengths = (value) => (typeof value === "string" ? value.split(",").map((text) => parseFloat(text) / unit) : [value].flat());
    const { width, grout, at } = texture;
    return { ...texture, width: width ? [...lengths(width), 0].slice(0, 2) : null, grout: grout ? lengths(grout)[0] : 0, at: at && lengths(at) };
  }

  /* A texture's size: of its image or, of a colour without joints, of its map. */
  sizeOf(texture) {
    return sizeOf(Array.isArray(texture.image) && !hasGrout(texture) ? mapOn(texture) || texture.image : texture.image || {});
  }

  /* A texture's scale as a pair, by which the tools go. */
  scaleOf(index, texture = this.textures[index]) {
    const { uv_scale: unit } = this.room.targets[index], { scale, width } = texture, [wide, high] = this.sizeOf(texture);
    if (Array.isArray(scale)) return scale;
    return [scale, width ? scale : scale * (wide / high) * (unit[0] > 0 && unit[1] > 0 ? unit[1] / unit[0] : 1)];
  }

  /* As it lies, by the width that options of laying need. */
  measured(index) {
    const { uv_scale: unit } = this.room.targets[index], scale = this.scaleOf(index);
    return this.textures[index].width || !(unit[0] > 0 && unit[1] > 0) ? {} : { width: scale.map((x, k) => unit[k] / Math.abs(x)), scale: scale.map(Math.sign) };
  }

  wrapOf(texture) {
    const { image, wrap, repeat } = texture, modes = (Array.isArray(image) && !mapOn(texture) && !hasGrout(texture) ? "repeat" : wrap).split(",");
    return [modes[0], modes[1] || modes[0]].map((m) => (m === "repeat" && repeat === "mirror" ? "mirror" : m));
  }

  /* How textures and layers lie, as the renderer draws them. */
  settings() {
    return this.textures.map((texture, i) => {
      const lies = (t) => {
        const wrap = this.wrapOf(t), isColor = Array.isArray(t.image) && !hasGrout(t);
        return { wrap, ...lie({ ...this.measures(t), scale: this.scaleOf(i, t), ...(isColor && !mapOn(t) ? { width: null } : {}) }, this.room.targets[i], wrap, this.sizeOf(t), t.put?.period || [1, 1]) };
      };
      return { ...lies(texture), overs: texture.overs.map(lies), finish: this.finishes?.[i] ?? 0 };
    });
  }
};
