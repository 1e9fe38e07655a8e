// ---- images on the graphics card ----

import { ADJUST, BLUR, SUM, SUM_SIDE, adjustNumbers, blurSizes } from "./adjust.js";
import { WRAPS } from "./edit.js";
import { HALVE, PREMULTIPLY, VERTEX } from "./glsl.js";
import { LAY, MOST_LAID, copyOf, paintingsOf } from "./lay.js";
import { PRODUCT, WEIGH } from "./maps.js";
import { isClear, isGrey, sizeOf } from "./pictures.js";

/* What is drawn, and how pictures become what is filtered: colours are adjusted, maps of finishes take images apart, repeats
 * are laid. An image is a texture, with room for its levels, its size and its format. */
export class Images {
  constructor(gl, room) {
    Object.assign(this, { gl, room, programs: new Map(), most: gl.getParameter(gl.MAX_TEXTURE_SIZE), overs: null, overEnd: room.targets.map(() => 0) });
  }

  texture(kind, format, width, height, layers, filter, levels = 1) {
    const { gl } = this, texture = gl.createTexture();
    gl.bindTexture(kind, texture);
    if (layers) gl.texStorage3D(kind, levels, format, width, height, layers);
    else gl.texStorage2D(kind, levels, format, width, height);
    for (const [key, value] of [["MIN_FILTER", filter], ["MAG_FILTER", filter], ["WRAP_S", gl.CLAMP_TO_EDGE], ["WRAP_T", gl.CLAMP_TO_EDGE]])
      gl.texParameteri(kind, gl[`TEXTURE_${key}`], value);
    return texture;
  }

  program(fragment) {
    const { gl } = this, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Error(`The room's shader does not compile: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error(`The room's shader does not link: ${gl.getProgramInfoLog(program)}`);
    const uniforms = new Map();
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const { name, type } = gl.getActiveUniform(program, i);
      uniforms.set(name.replace("[0]", ""), { at: gl.getUniformLocation(program, name), type });
    }
    return { program, uniforms };
  }

  /* A program that is compiled when it is first needed: of a text, or of a function of the room. */
  programOf(make, ...how) {
    if (!this.programs.has(make)) this.programs.set(make, {});
    return (this.programs.get(make)[how] ||= this.program(typeof make === "string" ? make : make(this.room, ...how)));
  }

  /* Codes of images are numbers here: the browser must not convert them. */
  exactly(upload) {
    const { gl } = this;
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    upload();
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.BROWSER_DEFAULT_WEBGL);
  }

  wrap(texture, modes) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    modes.forEach((mode, k) => gl.texParameteri(gl.TEXTURE_2D, k ? gl.TEXTURE_WRAP_T : gl.TEXTURE_WRAP_S,
      { repeat: gl.REPEAT, mirror: gl.MIRRORED_REPEAT }[mode] || gl.CLAMP_TO_EDGE));
  }

  checkMemory() {
    if (this.gl.getError() === this.gl.OUT_OF_MEMORY) throw new Error("The graphics card has not enough memory for this room.");
  }

  /* Draw with one program; values by name: numbers, arrays, or [kind, texture]. */
  draw({ program, uniforms }, values) {
    const { gl } = this;
    gl.useProgram(program);
    let unit = 0;
    for (const [name, { at, type }] of uniforms) {
      const value = values[name];
      if (value instanceof WebGLTexture) {
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(type === gl.SAMPLER_2D || type === gl.UNSIGNED_INT_SAMPLER_2D ? gl.TEXTURE_2D : gl.TEXTURE_2D_ARRAY, value);
        gl.uniform1i(at, unit++);
      } else if (type === gl.FLOAT_MAT2) gl.uniformMatrix2fv(at, false, value);
      else if (type === gl.FLOAT_VEC2) gl.uniform2fv(at, value);
      else if (type === gl.FLOAT_VEC3) gl.uniform3fv(at, value);
      else if (type === gl.FLOAT_VEC4) gl.uniform4fv(at, value);
      else if (type === gl.INT_VEC2) gl.uniform2iv(at, value);
      else if (type === gl.FLOAT) gl.uniform1f(at, value);
      else if (Array.isArray(value)) gl.uniform1iv(at, value);
      else gl.uniform1i(at, value);
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  into(texture, layer, width, height) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture, 0, layer);
    gl.viewport(0, 0, width, height);
  }

  intoImage(texture, width, height) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.imageFrame ||= gl.createFramebuffer());
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, width, height);
  }

  image(format, size) {
    const { gl } = this, levels = Math.floor(Math.log2(Math.max(...size))) + 1;
    return { texture: this.texture(gl.TEXTURE_2D, format, ...size, 0, gl.LINEAR, levels), size, format };
  }

  /* An image that a program draws. */
  drawn(format, size, make, values) {
    const { gl } = this, image = this.image(format, size);
    this.intoImage(image.texture, ...size);
    this.draw(this.programOf(make), values);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, null, 0);
    return image;
  }

  free(...images) {
    for (const image of images) if (image) this.gl.deleteTexture(image.texture);
  }

  /* Make an image's levels, with which it is filtered. Of odd sizes browsers leave texels out. */
  withLevels(image) {
    const { gl } = this, isOdd = image.size.some((x) => x & (x - 1));
    for (let from = image, level = 1; isOdd && Math.max(...from.size) > 1; level++) {
      const next = this.drawn(image.format, from.size.map((x) => Math.max(x >> 1, 1)), HALVE, { image: from.texture });
      this.intoImage(next.texture, ...next.size);
      gl.bindTexture(gl.TEXTURE_2D, image.texture);
      gl.copyTexSubImage2D(gl.TEXTURE_2D, level, 0, 0, 0, 0, ...next.size);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, null, 0);
      this.free(from !== image && from, Math.max(...next.size) === 1 && next);
      from = next;
    }
    gl.bindTexture(gl.TEXTURE_2D, image.texture);
    if (!isOdd) gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    this.checkMemory();
    return image;
  }

  // ---- what textures are made of ----

  /* A picture, or a linear colour. Texels are multiplied by what they cover, for they are averaged so. */
  upload(source) {
    const { gl } = this;
    if (Array.isArray(source)) {
      const color = this.image(gl.RGBA16F, [1, 1]);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 1, 1, gl.RGBA, gl.FLOAT, new Float32Array([...source, 1]));
      return color;
    }
    const straight = this.image(gl.SRGB8_ALPHA8, sizeOf(source));
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, source);
    if (!isClear(source)) return straight;
    const image = this.drawn(straight.format, straight.size, PREMULTIPLY, { straight: straight.texture });
    this.free(straight);
    return image;
  }

  /* An image with other colours, in its place. adjust: pairs of a word and a value, in their order; wrap: what lies beyond the
   * image, for blurs. */
  adjusted(image, adjust, wrap) {
    const numbers = adjust.map(adjustNumbers), isApart = (k) => ["blur", "colorize"].includes(adjust[k][0]);
    for (let i = 0, end; i < adjust.length; i = end) {
      const old = image, mean = adjust[i][0] === "colorize" ? this.sumOf(old) : null;
      for (end = i + 1; end < adjust.length && adjust[i][0] !== "blur" && !isApart(end); end++);
      const some = numbers.slice(i, end);
      image = adjust[i][0] === "blur" ? this.blurred(old, adjust[i][1], wrap) : this.drawn(old.format, old.size, ADJUST, {
        image: old.texture, mean: mean?.texture || this.none, count: some.length, kinds: some.map((x) => x.kind), values: some.flatMap((x) => x.value),
      });
      this.free(mean, image !== old && old);
    }
    return image;
  }

  /* One texel in the proportions of all. */
  sumOf(image) {
    let sum = null;
    do {
      const of = sum || image;
      sum = this.drawn(this.gl.RGBA16F, of.size.map((x) => Math.ceil(x / SUM_SIDE)), SUM, { image: of.texture });
      if (of !== image) this.free(of);
    } while (Math.max(...sum.size) > 1);
    return sum;
  }

  blurred(image, part, wrap) {
    if (Math.max(...image.size) === 1) return image; // a colour
    const sigma = part * image.size[0], blur = (from, down) => {
      const how = blurSizes(sigma, from.size[down]), size = from.size.map((x, k) => (k === down ? how.made : x));
      return this.drawn(image.format, size, BLUR, { image: from.texture, down, wrap: WRAPS.indexOf(wrap[down]), sigma: how.sigma, stride: how.stride });
    };
    const across = blur(image, 0), small = blur(across, 1);
    this.free(across);
    if (String(small.size) === String(image.size)) return small;
    this.wrap(small.texture, wrap);
    const whole = this.drawn(image.format, image.size, LAY, copyOf(small, image.size));
    this.free(small);
    return whole;
  }

  /* One image of many repeats of others. */
  laid(tiles, laid, layout) {
    const { gl } = this, [width, height] = layout.size, paintings = paintingsOf(laid, layout, tiles), program = this.programOf(LAY);
    const image = this.image((tiles.find((t) => t.format === gl.RGBA16F) || tiles[0]).format, layout.size), modulo = (x, n) => ((x % n) + n) % n;
    tiles.forEach((tile, k) => {
      if (paintings.some((p) => p.tile === k && p.values.lod > 0)) this.withLevels(tile);
      this.wrap(tile.texture, Array(2).fill(layout.isShifted ? "repeat" : "clamp"));
    });
    this.intoImage(image.texture, width, height);
    for (const { tile, x, y, size, origin, values } of paintings)
      for (let left = modulo(x, width); left > -size[0]; left -= width) // what ends beyond the image begins on its other side
        for (let top = modulo(height - y - size[1], height); top > -size[1]; top -= height) {
          gl.viewport(left, top, ...size);
          this.draw(program, { ...values, tile: tiles[tile].texture, origin: [left + origin[0], top + origin[1]] });
        }
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, null, 0);
    return image;
  }

  /* A new texture: an image, or a linear colour; null: the original. tiles: more images; adjust: their colours; laid, layout:
   * how repeats are laid, or null; wrap: modes in u and v; map: an image of its finishes, or null, and its channel. */
  putTexture(index, source, { tiles = [], adjust = [], laid = {}, layout = null, wrap = ["repeat", "repeat"], map = null, channel = null } = {}) {
    const { gl } = this, target = this.room.targets[index];
    for (const texture of [target.image, target.weights, ...(target.products ?? [])]) if (texture && texture !== this.none) gl.deleteTexture(texture);
    Object.assign(target, { image: this.none, weights: null, products: null, hasImage: !!source });
    if (!source) return;
    const all = [source, ...tiles].map((one) => this.adjusted(this.upload(one), adjust, wrap));
    const filtered = (images, groutcolor) => {
      const image = this.withLevels(layout ? this.laid(images, { ...laid, groutcolor }, layout) : images[0]);
      if (layout) this.free(...images);
      return image.texture;
    };
    if (map) {
      const parts = this.takeApart(target, all[0], map, wrap, channel).map((part, k) => filtered([part], k === 1 ? laid.groutcolor : "#000000"));
      Object.assign(target, { weights: parts[0], products: parts.slice(1) });
    }
    target.image = filtered(all, laid.groutcolor);
  }

  /* The weights of finishes, and the image where it has each finish: the larger size of image and map counts. */
  takeApart(target, image, map, wrap, channel) {
    const { gl } = this, own = sizeOf(map), count = target.finishes.length, codes = this.texture(gl.TEXTURE_2D, gl.RGBA8, ...own, 0, gl.NEAREST);
    this.exactly(() => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, map));
    const weights = this.drawn(gl.RGBA16F, own, WEIGH, {
      codes, count, grey: !channel && isGrey(map) ? 1 : 0, rough: channel ? 1 : 0, channel: channel || [0, 0, 0, 0],
      roughness: [0, 1, 2, 3].map((k) => target.finish_roughness?.[k] ?? -1),
    });
    for (const { texture } of [weights, image]) this.wrap(texture, wrap);
    const size = image.size.map((x, k) => Math.max(x, own[k]));
    const parts = [0, ...target.finishes.map((_, k) => k + 1)].map((finish) =>
      this.drawn(finish ? image.format : gl.RGBA8, size, PRODUCT, { image: image.texture, weights: weights.texture, size, finish }));
    gl.deleteTexture(codes);
    this.free(weights);
    return parts;
  }

  /* Layers of all targets, lists of { image, adjust }: layers of one texture, as large as the largest of them, in powers of two. */
  putOvers(lists) {
    const { gl } = this, all = lists.flat(), end = lists.map((_, t) => lists.slice(0, t + 1).flat().length);
    gl.deleteTexture(this.overs);
    Object.assign(this, { overs: null, overEnd: end });
    if (!all.length) return;
    const size = [0, 1].map((k) => 2 ** Math.ceil(Math.log2(Math.max(...all.map(({ image }) => sizeOf(image)[k])))));
    while (Math.max(...size) > this.most || all.length * size[0] * size[1] > MOST_LAID) size[size[1] > size[0] ? 1 : 0] /= 2;
    const overs = this.texture(gl.TEXTURE_2D_ARRAY, gl.SRGB8_ALPHA8, ...size, all.length, gl.LINEAR, Math.floor(Math.log2(Math.max(...size))) + 1);
    all.forEach(({ image, adjust }, k) => {
      const made = this.adjusted(this.upload(image), adjust, ["black", "black"]), values = copyOf(made, size);
      if (values.lod > 0) this.withLevels(made);
      this.into(overs, k, ...size);
      this.draw(this.programOf(LAY), values);
      this.free(made);
    });
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, overs);
    gl.generateMipmap(gl.TEXTURE_2D_ARRAY);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    this.checkMemory();
    this.overs = overs;
  }
}
