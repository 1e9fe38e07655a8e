// ---- the room on the graphics card ----

import { METER, METER_BLOCK, developMatrix } from "./develop.js";
import { VIEWS } from "./edit.js";
import { RECORD_COLUMNS, recordsEach } from "./files.js";
import { whites } from "./glsl.js";
import { Images } from "./images.js";
import { isPair } from "./look.js";
import { chosenColors, firstHit, gateShader, passColors, passesOf, smallGateShader } from "./maps.js";
import { factorShader, lampShader, mixtureShader, pictureShader } from "./shaders.js";
import { clamp, srgbDecode } from "./values.js";

const FACTORS_MOST = 16; // of a term

/* Numbers go into shaders and sizes into memory, so all are what retex-pack can have written. */
export function checkManifest(room) {
  const check = (good) => { if (!good) throw new Error("room.json is damaged."); };
  const number = (x, low = 0, high = 1e30) => check(Number.isFinite(x) && x >= low && x <= high);
  const whole = (x, low, high) => check(Number.isInteger(x) && x >= low && x <= high);
  const list = (value, most, each) => {
    check(Array.isArray(value) && value.length <= most);
    value.forEach(each);
  };
  const inside = (index, array, least = 0) => whole(index, least, array.length - 1);
  const file = (f) => {
    check(typeof f.file === "string" && !/[\/\\:]/.test(f.file));
    whole(f.bytes, 0, 2 ** 31);
    whole(f.crc32, 0, 2 ** 32 - 1);
  };
  const levels = (c) => {
    check(!Array.isArray(c.white) || c.white.length === 3);
    [c.white].flat().forEach((x) => number(x, 1e-30));
    number(c.levels, 1, 255);
  };
  const scaled = (c) => {
    check([1, 2, 4, 8].includes(c.scale));
    check(c.width === Math.ceil(room.width / c.scale) && c.height === Math.ceil(room.height / c.scale));
  };
  check(room && typeof room === "object");
  if (room.retex_web !== 1) throw new Error("room.json is of another version, or no room: write the folder again.");
  whole(room.width, 1, 32768);
  whole(room.height, 1, 32768);
  if (room.unit !== undefined) number(room.unit, 1e-30);
  check([1, 2, 4, 8].includes(room.finest));
  file(room.picture);
  list(room.smaller ?? [], 4, (s) => (file(s), whole(s.width, 1, room.width - 1), whole(s.height, 1, room.height)));
  list(room.targets, 8, (t) => {
    check(typeof t.name === "string");
    number(t.share);
    for (const key of ["uv_min", "uv_max", "uv_scale", "periodic"]) check(isPair(t[key]));
  });
  check(room.targets.length);
  const hasFinishes = room.targets.some((t) => t.finishes !== undefined), named = (name) => check(typeof name === "string");
  for (const { finishes, finish, finish_roughness: rough } of room.targets) {
    if (finishes === undefined) continue;
    list(finishes, 4, named);
    check(finishes.length > 1);
    if (rough !== undefined) list(rough, 4, (x) => number(x, -1, 1)), check(rough.length === finishes.length);
    whole(finish, 1, finishes.length);
  }
  for (const { normal_tilt: tilt } of room.targets) if (tilt !== undefined) number(tilt);
  const color = (c) => (list(c, 3, (x) => number(x)), check(c.length === 3));
  list(room.parameters ?? [], 64, (p) => {
    named(p.name);
    color(p.value);
    check(hasFinishes || (p.lamp === undefined && p.finishes === undefined));
    if (!hasFinishes) return;
    named(p.lamp);
    list(p.finishes, room.targets.length, (f, t) => whole(f, 0, room.targets[t].finishes?.length ?? 0));
    check(p.finishes.length === room.targets.length);
  });
  list(room.lights, 256, (l) => (file(l), levels(l), whole(l.target, -1, 8)));
  const atlas = (entry) => {
    if (entry) file(entry);
    list(entry?.tiles || [], 2048, (t) => (scaled(t), levels(t), whole(t.x, 0, 4096), whole(t.y, 0, 4096)));
    return entry?.tiles || [];
  };
  const tiles = atlas(room.reduced);
  list(room.classes, 32, (c) => {
    file(c);
    scaled(c);
    inside(c.target, room.targets);
    inside(c.albedo, c.scale === 1 ? room.lights : tiles);
    whole(c.spreads, 2, 4);
    list(c.footprints, 16, (f) => {
      number(f.first);
      number(f.per_octave, 1e-3);
      number(f.sigma_first, -1e9);
      number(f.angle_steps);
      list(f.weights, 2, (w) => w === null || w === "one" || number(w));
    });
    whole(c.records, 0, c.width * c.height * c.footprints.length);
  });
  list(room.mixtures, 96, (m) => {
    check(m.length);
    list(m, 24, ([c, slot]) => (inside(c, room.classes), whole(slot, 0, 1)));
    check(m.every(([c]) => room.classes[c].scale === room.classes[m[0][0]].scale));
  });
  const scaleOf = (m) => room.classes[room.mixtures[m][0][0]].scale, { further } = room;
  if (further) {
    whole(further.hits, 0, 255);
    color(further.ratio);
    list(further.mixtures, 96, (m) => (inside(m, room.mixtures), check(scaleOf(m) > 1)));
  }
  list(room.groups, 128, (g) => {
    inside(g.light, room.lights);
    inside(g.mixture, room.mixtures, -1);
    whole(g.target, -1, 8);
    check(g.mixture < 0 || scaleOf(g.mixture) === 1);
    list(g.parameters ?? [], 16, (p) => inside(p, room.parameters));
  });
  const term = (t, among, finest) => {
    inside(t.group, room.groups);
    inside(t.gain, among, -1);
    check(t.gain < 0 || among[t.gain].scale >= finest);
    list(t.factors, FACTORS_MOST, (m) => (inside(m, room.mixtures), check(scaleOf(m) >= finest && scaleOf(m) > 1)));
  };
  list(room.terms, 1024, (t) => term(t, tiles, room.finest));
  if (room.lamps === undefined) return;
  const { lamps } = room, shares = atlas(lamps);
  check(shares.length && [1, 2, 4, 8].includes(lamps.finest));
  whole(lamps.width, 1, 4096);
  whole(lamps.height, 1, 4096);
  check(shares.every((t) => t.x + t.width <= lamps.width && t.y + t.height <= lamps.height));
  list(lamps.terms, 1024, (t) => (term(t, shares, lamps.finest), inside(t.parameter, room.parameters)));
  room.parameters.forEach((p) => color(p.kept));
}

/* What lamps of these colours have in common, in times of what they are kept with: the least of all, by channel. So much of
 * all light counts, and of each lamp what it has beyond. */
export function shareLight({ parameters }, colors) {
  const times = parameters.map(({ kept }, i) => kept.map((k, c) => (k > 0 ? colors[i][c] / k : Infinity)));
  const common = [0, 1, 2].map((c) => Math.min(...times.map((t) => t[c]))).map((x) => (x < Infinity ? x : 1));
  return { common, beyond: colors.map((color, i) => color.map((x, c) => (times[i][c] <= common[c] ? 0 : Math.max(x - common[c] * parameters[i].kept[c], 0)))) };
}

/* Whether the terms of all light do not have lamps of these colours: those of single lamps are needed too. */
export const isRelit = ({ lamps, parameters }, colors) => !!lamps && colors.some((c, i) => c.some((x, k) => x !== parameters[i].kept[k]));

export class Renderer extends Images {
  constructor(canvas, room) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no WebGL 2");
    if (!gl.getExtension("EXT_color_buffer_float") && !gl.getExtension("EXT_color_buffer_half_float")) throw new Error("no WebGL 2");
    super(gl, room);
    Object.assign(this, { loaded: new Set(), lights: new Set() });
    if (Math.max(room.width, room.height) > this.most) throw new Error("The room is too large for this device.");
    canvas.width = room.width;
    canvas.height = room.height;
    if (room.lamps) room.lamps.finest = Math.min(room.lamps.finest, room.finest); // sums of lamps have those of all light in them
    this.full = room.classes.filter((c) => c.scale === 1);
    this.small = room.classes.filter((c) => c.scale > 1);
    this.full.forEach((c, i) => (c.layer = i));
    this.small.forEach((c, i) => (c.layer = i));
    let layers = 0, rows = 0;
    room.mixtureLayers = room.mixtures.map((m) => (room.classes[m[0][0]].scale > 1 ? layers++ : -1));
    for (const c of room.classes) {
      c.base = rows * RECORD_COLUMNS;
      rows += Math.ceil(c.records * recordsEach(c) / RECORD_COLUMNS);
    }
    if (rows > this.most) throw new Error("The room is too large for this device.");
    const most = (list, key) => Math.max(1, ...list.map((x) => x[key]));
    const smallSize = [most(this.small, "width"), most(this.small, "height")];
    this.records = this.texture(gl.TEXTURE_2D, gl.RGBA32UI, RECORD_COLUMNS, Math.max(rows, 1), 0, gl.NEAREST);
    this.heads = this.texture(gl.TEXTURE_2D_ARRAY, gl.R32UI, room.width, room.height, Math.max(this.full.length, 1), gl.NEAREST);
    this.smallHeads = this.texture(gl.TEXTURE_2D_ARRAY, gl.R32UI, ...smallSize, Math.max(this.small.length, 1), gl.NEAREST);
    this.light = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA8, room.width, room.height, room.lights.length, gl.NEAREST);
    this.still = this.texture(gl.TEXTURE_2D, gl.RGBA8, room.width, room.height, 0, gl.NEAREST);
    this.mixtures = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA16F, ...smallSize, Math.max(layers, 1), gl.LINEAR);
    for (const original of [false, true]) this.layers(original, false);
    this.none = this.texture(gl.TEXTURE_2D, gl.RGBA8, 1, 1, 0, gl.NEAREST);
    this.checkMemory();
    this.frame = gl.createFramebuffer();
    for (const [make, ...how] of [[mixtureShader, false], [factorShader], [pictureShader, false, false]]) this.programOf(make, ...how);
    for (const target of room.targets) target.image = this.none, (target.hasImage = false);
  }

  putClass(info, { heads, records, rows }) {
    const { gl } = this;
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    gl.bindTexture(gl.TEXTURE_2D, this.records);
    if (rows) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, info.base / RECORD_COLUMNS, RECORD_COLUMNS, rows, gl.RGBA_INTEGER, gl.UNSIGNED_INT, records);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, info.scale === 1 ? this.heads : this.smallHeads);
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, info.layer, info.width, info.height, 1, gl.RED_INTEGER, gl.UNSIGNED_INT, heads);
    this.loaded.add(info);
    if (info.scale === 1) info.heads = heads; // for pointing at targets
  }

  putLight(index, image) {
    const { gl, room } = this;
    if (image.naturalWidth !== room.width || image.naturalHeight !== room.height) throw new Error(`${room.lights[index].file} is damaged.`);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.light);
    this.exactly(() => gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, index, room.width, room.height, 1, gl.RGBA, gl.UNSIGNED_BYTE, image));
    this.lights.add(index);
  }

  /* The light that a pixel has of a target before its colour: a floor that reflects a wall is more floor than wall. */
  lightOf(target, x, y) {
    const { gl, room } = this, code = new Uint8Array(4);
    const lights = new Set(room.groups.filter((g) => firstHit(room, g.mixture) === target && this.lights.has(g.light)).map((g) => g.light));
    return [...lights].reduce((sum, l) => {
      const { levels } = room.lights[l], white = whites(room.lights[l]);
      this.into(this.light, l, room.width, room.height);
      gl.readPixels(x, y, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, code);
      const [r, g, b] = Array.from(code, (c) => (c > levels ? Math.exp((c / levels - 1) * (255 / 48)) : srgbDecode(c / levels)));
      return sum + 0.2126 * white[0] * r + 0.7152 * white[1] * g + 0.0722 * white[2] * b;
    }, 0);
  }

  putStill(image) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.still);
    this.exactly(() => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, image));
  }

  putReduced(image) {
    const { gl } = this;
    if (Math.max(image.naturalWidth, image.naturalHeight) > this.most) throw new Error("The room is too large for this device.");
    this.reduced = this.texture(gl.TEXTURE_2D, gl.RGBA8, image.naturalWidth, image.naturalHeight, 0, gl.NEAREST);
    this.exactly(() => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, image));
  }

  /* The light of single lamps, which nothing needs before a lamp has another colour than in the terms of all light. */
  putLamps(image) {
    const { gl, room } = this, { lamps } = room, { terms } = lamps;
    if (image.naturalWidth !== lamps.width || image.naturalHeight !== lamps.height) throw new Error(`${lamps.file} is damaged.`);
    if (Math.max(image.naturalWidth, terms.length) > this.most) throw new Error("The room's lamps are too many for this device.");
    const columns = 3 + FACTORS_MOST, data = new Float32Array(4 * columns * terms.length), scale = (m) => room.classes[room.mixtures[m][0][0]];
    terms.sort((a, b) => a.group - b.group).forEach(({ parameter, gain, factors }, i) => {
      const t = lamps.tiles[gain], put = (column, values) => data.set(values, 4 * (columns * i + column));
      put(0, t ? [t.x, t.y, t.width, t.height] : [0, 0, 0, 0]);
      put(1, [t ? t.scale / lamps.finest : 1, t?.levels ?? 255, parameter, factors.length]);
      put(2, t ? whites(t) : [1, 1, 1]);
      factors.forEach((m, k) => put(3 + k, [room.mixtureLayers[m], scale(m).width, scale(m).height, scale(m).scale / lamps.finest]));
    });
    this.lampTerms = this.texture(gl.TEXTURE_2D, gl.RGBA32F, columns, terms.length, 0, gl.NEAREST);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, columns, terms.length, gl.RGBA, gl.FLOAT, data);
    this.programOf(lampShader);
    const tiles = this.texture(gl.TEXTURE_2D, gl.RGBA8, image.naturalWidth, image.naturalHeight, 0, gl.NEAREST);
    this.exactly(() => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, image));
    this.checkMemory();
    this.lampTiles = tiles;
  }

  /* Where the sums of groups are drawn: their texture, and its grid. Before and after the split, and by all light or single
   * lamps; those of lamps take memory once they are needed. */
  layers(original, relit) {
    const { gl, room } = this, finest = relit ? room.lamps.finest : room.finest;
    const size = [Math.ceil(room.width / finest), Math.ceil(room.height / finest)], key = (relit ? "lit" : "") + (original ? "originals" : "factors");
    if (!this[key]) {
      this[key] = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA16F, ...size, room.groups.length, gl.LINEAR);
      this.checkMemory();
    }
    return { texture: this[key], size, grid: [...size, finest] };
  }

  /* What is smaller than the picture: mixtures, then factors of groups. values.first: what else holds where the mixture is a
   * path's first hit. */
  drawFactors(original, values) {
    const { room } = this, colors = original ? this.rendered : values.colors, relit = !!this.lampTiles && isRelit(room, colors);
    const to = this.layers(original, relit), all = this.layers(original, false), { common, beyond } = relit ? shareLight(room, colors) : { common: [1, 1, 1] };
    room.mixtures.forEach((m, mixture) => {
      const c = room.classes[m[0][0]];
      if (c.scale === 1) return;
      this.into(this.mixtures, room.mixtureLayers[mixture], c.width, c.height);
      this.draw(this.programOf(mixtureShader, !!this.overs), { ...values, ...(firstHit(room, mixture) >= 0 ? values.first : {}), heads: this.smallHeads, mixture, original: original ? 1 : 0 });
    });
    room.groups.forEach(({ parameters }, group) => {
      if (common.some(Boolean)) {
        const color = (parameters ?? []).reduce((product, p) => product.map((x, k) => x * colors[p][k]), common);
        this.into(all.texture, group, ...all.size);
        this.draw(this.programOf(factorShader), { mixtures: this.mixtures, reduced: this.reduced, group, color });
      }
      if (relit) {
        const of = room.lamps.terms, first = of.findIndex((t) => t.group === group), count = of.filter((t) => t.group === group).length;
        this.into(to.texture, group, ...to.size);
        this.draw(this.programOf(lampShader), { mixtures: this.mixtures, tiles: this.lampTiles, terms: this.lampTerms, first, end: first + count, colors: beyond.flat(),
          all: all.texture, allSize: all.size, times: room.finest / room.lamps.finest, group: common.some(Boolean) ? group : -1 });
      }
    });
    return to;
  }

  get rendered() {
    return (this.room.parameters ?? []).map((p) => p.value);
  }

  /* Whether the light of single lamps is missing from the picture as rendered: of those that are off in it, for one. */
  get lacksLamps() {
    return !this.lampTiles && isRelit(this.room, this.rendered);
  }

  get complete() {
    return !this.lacksLamps && this.loaded.size === this.room.classes.length && this.lights.size === this.room.lights.length;
  }

  isReady(group) {
    const { room } = this, g = room.groups[group];
    const mixtures = room.terms.filter((t) => t.group === group).flatMap((t) => t.factors);
    if (g.mixture >= 0) mixtures.push(g.mixture);
    return !this.lacksLamps && (this.reduced || !room.reduced) && this.lights.has(g.light) && mixtures.every((m) => room.mixtures[m].every(([c]) =>
      this.loaded.has(room.classes[c]) && (room.classes[c].scale > 1 || this.lights.has(room.classes[c].albedo))));
  }

  isSeen(target) {
    return this.room.classes.some((c) => c.target === target && c.records);
  }

  /* Whether a target's own light is there. */
  canEdit(target) {
    return this.isSeen(target) && this.room.groups.every((g, i) => g.target !== target || this.isReady(i));
  }

  /* settings: by target how its texture lies, a matrix by columns and an offset; wrap: modes in u and v; overs: how its layers
   * lie; finish: the number of the one that is chosen; split: pixels from the left that stay as they were; light: how
   * the picture is developed; colors: of the parameters, of a target with a map with all its finishes. */
  render(settings, split, light, colors) {
    const { gl, room, overs, overEnd } = this, lie = (list, key) => list.flatMap((s) => s[key]), layers = settings.flatMap((s) => s.overs);
    const values = { colors, records: this.records, reduced: this.reduced || this.none, turn: lie(settings, "turn"), offset: lie(settings, "offset"), edge: [], edited: [], keeps: [],
      overs, overEnd, overTurn: lie(layers, "turn"), overOffset: lie(layers, "offset") };
    settings.forEach((s, t) => {
      const { image, hasImage, weights, products } = room.targets[t];
      values.edge.push(...s.wrap.map((mode) => ({ black: 1, clamp: -1 })[mode] || 0));
      for (const texture of hasImage ? [image, ...(products ? [weights, ...products] : [])] : []) this.wrap(texture, s.wrap);
      values.keeps.push(1);
      values.edited.push(hasImage || s.overs.length ? 1 : 0);
      values[`image${t}`] = image;
    });
    const shown = settings.map((s) => s.finish), mapped = room.targets.map((t) => !!t.products);
    const isMapped = mapped.includes(true) && !!this.lampTiles, passes = isMapped ? passesOf(room, mapped) : [shown];
    if (isMapped) this.drawGates(values, shown, mapped);
    else if (mapped.includes(true)) values.colors = chosenColors(room, shown, colors);
    const size = [room.width, room.height], partial = !this.complete, ready = room.groups.map((_, g) => (this.isReady(g) ? 1 : 0));
    let originals = this.layers(true, false), factors = this.layers(false, false);
    if (ready.includes(1)) {
      if (partial || split > 0) originals = this.drawFactors(true, values);
    }
    let develop = developMatrix(light);
    for (const isMeasured of light.autoExposure ? [true, false] : [false]) {
      passes.forEach((pass, i) => {
        const last = i === passes.length - 1, first = isMapped ? this.inPass(mapped, pass, shown) : {};
        if (ready.includes(1) && (isMapped || isMeasured || !light.autoExposure))
          factors = this.drawFactors(false, { ...values, colors: isMapped ? passColors(room, mapped, pass, colors) : values.colors, first });
        if (!last) {
          this.intoImage(this.sums[i % 2], ...size);
        } else if (isMeasured) {
          this.intoImage(this.measured ||= this.texture(gl.TEXTURE_2D, gl.RGBA16F, ...size, 0, gl.NEAREST), ...size);
        } else {
          gl.bindFramebuffer(gl.FRAMEBUFFER, null);
          gl.viewport(0, 0, ...size);
        }
        this.draw(this.programOf(pictureShader, isMapped, !!this.overs), {
          ...values, ...first, heads: this.heads, lights: this.light, factors: factors.texture, grid: factors.grid, originals: originals.texture,
          originalGrid: originals.grid, loaded: room.classes.map((c) => (this.loaded.has(c) && c.scale === 1 ? 1 : 0)),
          ready, partial: partial && !i ? 1 : 0, split: isMeasured ? 0 : split, gates: this.gates, finish: pass, more: i ? 1 : 0,
          last: last && !isMeasured ? 1 : 0, develop, view: Math.max(VIEWS.indexOf(light.view), 0), below: i ? this.sums[(i + 1) % 2] : this.still,
        });
      });
      if (isMeasured) develop = developMatrix(light, this.measure());
    }
  }

  /* The stops that bring the log-average of the luminance of `measured`, of pixels that are not black, to 0.18. */
  measure() {
    const { gl, room } = this, size = [room.width, room.height].map((x) => Math.ceil(x / METER_BLOCK)), blocks = new Float32Array(4 * size[0] * size[1]);
    this.intoImage(this.blocks ||= this.texture(gl.TEXTURE_2D, gl.RGBA16F, ...size, 0, gl.NEAREST), ...size);
    this.draw(this.programOf(METER), { picture: this.measured });
    gl.readPixels(0, 0, ...size, gl.RGBA, gl.FLOAT, blocks);
    let sum = 0, count = 0;
    for (let i = 0; i < blocks.length; i += 4) sum += blocks[i], count += blocks[i + 1];
    return count ? clamp(Math.log2(0.18) - sum / count, -30, 30) : 0;
  }

  /* What differs in a pass: the textures of first hits, and which original they keep where they are clear. */
  inPass(mapped, pass, shown) {
    const values = { keeps: pass.map((f, t) => (mapped[t] && f && f !== shown[t] ? 0 : 1)) };
    this.room.targets.forEach((t, i) => { if (mapped[i] && pass[i]) values[`image${i}`] = t.products[pass[i] - 1]; });
    return values;
  }

  /* The gates of mapped targets. */
  drawGates(values, shown, mapped) {
    const { gl, room } = this, { targets } = room, layers = targets.map((_, t) => t).filter((t) => targets[t].finishes), size = [room.width, room.height];
    if (!this.gates) {
      const most = (key) => Math.max(1, ...this.small.map((c) => c[key]));
      this.gates = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA16F, ...size, layers.length, gl.NEAREST);
      this.smallGates = this.texture(gl.TEXTURE_2D_ARRAY, gl.RGBA16F, most("width"), most("height"), Math.max(this.small.length, 1), gl.LINEAR);
      this.sums = [0, 1].map(() => this.texture(gl.TEXTURE_2D, gl.RGBA16F, ...size, 0, gl.NEAREST));
      this.checkMemory();
    }
    const own = { ...values, original: 0, shown: shown.flatMap((f) => [2, 3, 4].map((k) => (f === k ? 1 : 0))) };
    targets.forEach((t, i) => (mapped[i] ? (own[`image${i}`] = t.weights) : 0));
    this.small.forEach((c, layer) => {
      if (!mapped[c.target]) return;
      this.into(this.smallGates, layer, c.width, c.height);
      this.draw(this.programOf(smallGateShader), { ...own, heads: this.smallHeads, which: layer });
    });
    layers.forEach((t, layer) => {
      if (!mapped[t]) return;
      this.into(this.gates, layer, ...size);
      this.draw(this.programOf(gateShader), { ...own, heads: this.heads, sums: this.smallGates, which: t });
    });
  }
}
