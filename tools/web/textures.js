// ---- what lies on targets: textures, and how they lie ----

/* Two repeats as one picture: side by side, the right one moved down, or one above the other, the upper one moved right. */
function shiftedRepeats(image, repeat) {
  const w = image.naturalWidth || image.width, h = image.naturalHeight || image.height, across = repeat === "half-drop";
  const context = drawingContext(across ? 2 * w : w, across ? h : 2 * h);
  for (const [x, y] of across ? [[0, 0], [w, h >> 1], [w, (h >> 1) - h]] : [[0, h], [w >> 1, 0], [(w >> 1) - w, 0]])
    context.drawImage(image, x, y);
  return context.canvas;
}

/* Whether a picture may show what lies below it. */
function isClear(image) {
  const context = drawingContext(64, 64);
  context.drawImage(image, 0, 0, 64, 64);
  return context.getImageData(0, 0, 64, 64).data.some((x, i) => i % 4 === 3 && x < 255);
}

const DRAWING = "image/svg+xml";

/* A visitor's picture. Drawings may have no size of their own. A JPEG file has no transparent parts, but if its end is
 * missing the browser leaves some. */
async function decodePicture(blob, name) {
  const image = await decodeImage(blob, name), bytes = new Uint8Array(await blob.arrayBuffer());
  if (isDamaged(bytes) || (bytes[0] === 255 && isClear(image))) throw new Error(`${name} is damaged.`);
  return blob.type === DRAWING ? smaller(image, 1024) : image;
}

/* A picture in a canvas whose longer side has so many pixels. */
function smaller(image, most) {
  const times = most / Math.max(image.naturalWidth, image.naturalHeight);
  const size = [image.naturalWidth, image.naturalHeight].map((x) => Math.max(1, Math.round(x * times))), context = drawingContext(...size);
  context.imageSmoothingQuality = "high";
  context.drawImage(image, 0, 0, ...size);
  return context.canvas;
}

/* What a texture keeps of a map: its address, for links, its name, and the channel that is roughness. */
const mapOf = (map, from, channel = null) => ({
  map, channel: map && channel, finish: map && !(from instanceof Blob) ? String(from) : "", mapLabel: map ? (from instanceof Blob ? from.name || "Picture" : nameOf(String(from))) : "",
});

/* What an element does with textures. */
const withTextures = (Base) => class extends Base {
  /* Put a texture on a target: a File or Blob, a list of the Files of one texture, the URL of a picture, a colour as in
   * retex-edit(5), or null for the original. options: scale (a number keeps the picture's proportions, a pair is as of
   * retex-combine), rotate in degrees, offset [u, v], tint "#rrggbb", label; flip, wrap and repeat as of retex-combine; finish:
   * a File, Blob or URL of a picture that says which finish is where, or "none". Resolves when it is drawn. */
  async setTexture(name, source, options = {}) {
    const index = this.indexOf(name), order = (this.textures[index].order = (this.textures[index].order || 0) + 1);
    let image = null, label = "Original", kept = null, rough = null, channel = null;
    if (Array.isArray(source)) {
      const folder = source.length > 1 ? readFolder(source) : { color: source[0] };
      source = folder.color;
      if (folder.rough && !options.finish && hasRoughness(this.room.targets[index])) ({ rough, channel } = folder);
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
    const chosen = options.finish || rough, map = image && chosen && chosen !== "none" ? await this.getMap(index, chosen) : null;
    const normal = image && options.normal !== "none" && String(options.normal ?? ""); // it stays in states, for the tools
    if (order !== this.textures[index].order) return; // another one has been chosen since
    placing(plainTexture(), options);
    Object.assign(this.textures[index], plainTexture(), { source: kept, label, image, local: source instanceof Blob, order, normal: normal || "", ...mapOf(map, chosen, channel) });
    this.place(name, options);
    this.say(`${name}: ${this.textures[index].label}${normal ? "; a page does not show normal maps" : ""}`);
  }

  /* Another map, or null, on what lies on a target already. */
  async setMap(name, map) {
    const index = this.indexOf(name), texture = this.textures[index], order = (texture.order = (texture.order || 0) + 1);
    if (map && !texture.image) throw new Error(`A map of finishes needs a new texture on ${name}.`);
    const image = map && (await this.getMap(index, map));
    if (order !== texture.order) return;
    Object.assign(texture, mapOf(image, map));
    this.place(name, {});
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

  /* Change how a target's texture lies: the options of setTexture, but finish. */
  place(name, options) {
    const index = this.indexOf(name), texture = this.textures[index];
    Object.assign(texture, placing(texture, options));
    this.put(index);
    this.update();
  }

  /* Give the renderer a target's texture, if it has another one. */
  put(index) {
    const { renderer } = this, texture = this.textures[index], { image, repeat, put, map } = texture;
    const shifted = image && (map || !Array.isArray(image)) && isShifted(repeat) ? repeat : "", wrap = map ? this.wrapOf(texture) : [];
    if (!renderer || (put.image === image && put.shifted === shifted && put.map === map && String(put.wrap) === String(wrap))) return;
    texture.put = { image, shifted, map, wrap };
    const most = Math.min(renderer.most, 4096) / (shifted ? 2 : 1);
    const fit = (x) => (x?.naturalWidth && Math.max(x.naturalWidth, x.naturalHeight) > most ? smaller(x, most) : x);
    const arranged = (x) => (shifted && !Array.isArray(x) ? shiftedRepeats(fit(x), repeat) : fit(x));
    renderer.putTexture(index, arranged(image), map && { image: arranged(map), wrap, channel: texture.channel });
  }

  /* A target's scale as a pair, by which the tools go. */
  scaleOf(index) {
    const { uv_scale: unit } = this.room.targets[index], { image: own, map, scale } = this.textures[index];
    if (Array.isArray(scale)) return scale;
    const image = Array.isArray(own) ? map : own, wide = image ? (image.naturalWidth || image.width) / (image.naturalHeight || image.height) : 1;
    return [scale, scale * wide * (unit[0] > 0 && unit[1] > 0 ? unit[1] / unit[0] : 1)];
  }

  wrapOf({ image, map, wrap, repeat }) {
    const modes = (Array.isArray(image) && !map ? "repeat" : wrap).split(",");
    return [modes[0], modes[1] || modes[0]].map((m) => (m === "repeat" && repeat === "mirror" ? "mirror" : m));
  }

  settings() {
    return this.textures.map((t, i) => {
      const scale = this.scaleOf(i), wrap = this.wrapOf(t);
      const share = [t.put.shifted === "half-drop" ? 0.5 : 1, t.put.shifted === "brick" ? 0.5 : 1];
      return { ...t, scale, wrap, share, tint: parseColor(t.tint), finish: this.finishes?.[i] ?? 0 };
    });
  }
};
