/* The part of WebGL 2 that the player uses, on the CPU: textures, framebuffers and programs of tests/web/glsl.mjs. */
import { compile } from "./glsl.mjs";

export class WebGLTexture {
  store(format, width, height, layers) {
    Object.assign(this, { format, width, height, layers, wraps: ["CLAMP_TO_EDGE", "CLAMP_TO_EDGE"] });
    this.images = Array.from({ length: Math.max(layers, 1) }, () => [this.empty(width, height)]);
  }

  empty(width, height) {
    return { width, height, values: this.format.endsWith("UI") ? new Uint32Array(4 * width * height) : new Float64Array(4 * width * height) };
  }

  put(layer, x, y, width, height, data, each, convert) {
    const image = this.images[layer][0];
    for (let row = 0; row < height; row++)
      for (let column = 0; column < width; column++)
        for (let k = 0; k < each; k++)
          image.values[4 * ((y + row) * image.width + x + column) + k] = convert(data[each * (row * width + column) + k], k);
  }

  at(image, x, y) {
    const k = 4 * (y * image.width + x), { values } = image;
    return [values[k], values[k + 1], values[k + 2], values[k + 3]];
  }

  texel(x, y, layer = 0) {
    const image = this.images[layer][0];
    if (!(x >= 0 && y >= 0 && x < image.width && y < image.height)) throw new Error(`texel ${x}, ${y} of ${image.width} x ${image.height}`);
    return this.at(image, x, y);
  }

  /* Bilinear in one level. */
  smooth(image, [s, t]) {
    const wrap = (i, size, mode) => {
      if (mode === "CLAMP_TO_EDGE") return Math.min(Math.max(i, 0), size - 1);
      const period = mode === "MIRRORED_REPEAT" ? 2 * size : size, k = ((i % period) + period) % period;
      return k < size ? k : period - 1 - k;
    };
    const x = s * image.width - 0.5, y = t * image.height - 0.5, x0 = Math.floor(x), y0 = Math.floor(y), [fx, fy] = [x - x0, y - y0];
    const texel = (i, j) => this.at(image, wrap(x0 + i, image.width, this.wraps[0]), wrap(y0 + j, image.height, this.wraps[1]));
    const [a, b, c, d] = [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)];
    return a.map((_, k) => (a[k] * (1 - fx) + b[k] * fx) * (1 - fy) + (c[k] * (1 - fx) + d[k] * fx) * fy);
  }

  lookUp(place, lod) {
    const images = this.images[this.layers ? Math.round(place[2]) : 0], level = Math.min(Math.max(lod, 0), images.length - 1);
    const low = Math.floor(level), a = this.smooth(images[low], place);
    if (level === low) return a;
    return this.smooth(images[low + 1], place).map((x, k) => a[k] * (1 - level + low) + x * (level - low));
  }

  makeLevels() {
    this.images.forEach((images) => this.makeLevelsOf(images));
  }

  makeLevelsOf(images) {
    images.length = 1;
    for (let last; (last = images.at(-1)), Math.max(last.width, last.height) > 1; ) {
      const next = this.empty(Math.max(last.width >> 1, 1), Math.max(last.height >> 1, 1));
      for (let y = 0; y < next.height; y++)
        for (let x = 0; x < next.width; x++) {
          const [right, below] = [Math.min(2 * x + 1, last.width - 1), Math.min(2 * y + 1, last.height - 1)];
          const four = [[2 * x, 2 * y], [right, 2 * y], [2 * x, below], [right, below]].map(([i, j]) => this.at(last, i, j));
          for (let k = 0; k < 4; k++) next.values[4 * (y * next.width + x) + k] = (four[0][k] + four[1][k] + four[2][k] + four[3][k]) / 4;
        }
      images.push(next);
    }
  }
}

const decode = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const KINDS = { sampler2D: "SAMPLER_2D", usampler2D: "UNSIGNED_INT_SAMPLER_2D", mat2: "FLOAT_MAT2", vec2: "FLOAT_VEC2", vec3: "FLOAT_VEC3", vec4: "FLOAT_VEC4", float: "FLOAT", ivec2: "INT_VEC2" };
const chunks = (list, size) => Array.from({ length: list.length / size }, (_, i) => [...list].slice(i * size, (i + 1) * size));

/* A context for a canvas, whose picture comes into canvas.values: four numbers of each pixel, rows from the bottom. */
export function context(canvas) {
  const bound = {}, units = [];
  let unit = 0, frame = null, used, view;
  const converter = (format) => (format === "SRGB8_ALPHA8" ? (x, k) => (k < 3 ? decode(x / 255) : x / 255) : format === "RGBA8" ? (x) => x / 255 : (x) => x);
  const gl = {
    TEXTURE0: 0,
    getExtension: () => ({}), getParameter: () => 4096, getError: () => 0, isContextLost: () => false, getShaderParameter: () => true,
    createTexture: () => new WebGLTexture(), createFramebuffer: () => ({}), createShader: (kind) => ({ kind }), createProgram: () => ({}),
    shaderSource: (shader, text) => (shader.text = text),
    attachShader: (program, shader) => { if (shader.kind === "FRAGMENT_SHADER") Object.assign(program, compile(shader.text), { values: {} }); },
    getProgramParameter: (program, what) => (what === "ACTIVE_UNIFORMS" ? program.uniforms.length : true),
    getActiveUniform: (program, i) => ({ name: program.uniforms[i].name, type: KINDS[program.uniforms[i].type] || program.uniforms[i].type }),
    getUniformLocation: (program, name) => program.uniforms.find((u) => u.name === name),
    useProgram: (program) => (used = program),
    activeTexture: (number) => (unit = number),
    bindTexture: (kind, texture) => { bound[kind] = texture; (units[unit] ||= {})[kind] = texture; },
    texStorage2D: (kind, levels, format, width, height) => bound[kind].store(format, width, height, 0),
    texStorage3D: (kind, levels, format, width, height, layers) => bound[kind].store(format, width, height, layers),
    texParameteri: (kind, key, value) => {
      if (key === "TEXTURE_WRAP_S") bound[kind].wraps[0] = value;
      if (key === "TEXTURE_WRAP_T") bound[kind].wraps[1] = value;
    },
    texSubImage2D: (kind, level, x, y, ...rest) => {
      const [width, height, , , data] = rest.length === 3 ? [rest[2].naturalWidth, rest[2].naturalHeight, 0, 0, rest[2].rgba] : rest;
      bound[kind].put(0, x, y, width, height, data, 4, converter(bound[kind].format));
    },
    texSubImage3D: (kind, level, x, y, layer, width, height, depth, format, type, data) =>
      bound[kind].put(layer, x, y, width, height, data.rgba || data, format === "RED_INTEGER" ? 1 : 4, converter(bound[kind].format)),
    copyTexSubImage2D: (kind, level) => { bound[kind].images[0][level] = { ...frame.texture.images[frame.layer][0] }; },
    generateMipmap: (kind) => bound[kind].makeLevels(),
    bindFramebuffer: (_, framebuffer) => (frame = framebuffer),
    framebufferTextureLayer: (_, attachment, texture, level, layer) => Object.assign(frame, { texture, layer }),
    framebufferTexture2D: (_, attachment, kind, texture) => Object.assign(frame, { texture, layer: 0 }),
    readPixels: (x, y, width, height, format, type, data) => {
      const from = frame.texture.images[frame.layer][0], most = data instanceof Uint8Array ? 255 : 1; /* values are 0 to 1 */
      for (let row = 0; row < height; row++) data.set(from.values.subarray(4 * ((y + row) * from.width + x), 4 * ((y + row) * from.width + x + width)).map((v) => (most > 1 ? Math.round(v * most) : v)), 4 * row * width);
    },
    viewport: (...box) => (view = box),
    uniformMatrix2fv: (at, _, value) => gl.set(at, chunks(value, 4).map(([a, b, c, d]) => [[a, b], [c, d]])),
    uniform2fv: (at, value) => gl.set(at, chunks(value, 2)), uniform3fv: (at, value) => gl.set(at, chunks(value, 3)), uniform4fv: (at, value) => gl.set(at, chunks(value, 4)),
    uniform2iv: (at, value) => gl.set(at, chunks(value, 2)),
    uniform1f: (at, value) => gl.set(at, [value]), uniform1i: (at, value) => gl.uniform1iv(at, [value]),
    uniform1iv: (at, value) => gl.set(at, at.type === "bool" ? value.map(Boolean) : value),
    set: (at, list) => (used.values[at.name] = at.isList ? list : list[0]),
    drawArrays: () => {
      const values = { ...used.values };
      for (const { type, name } of used.uniforms)
        if (/sampler/.test(type)) values[name] = units[values[name]]?.[/Array/.test(type) ? "TEXTURE_2D_ARRAY" : "TEXTURE_2D"];
      const shade = used.run(values), [left, low, width, height] = view;
      const to = frame ? frame.texture.images[frame.layer][0] : (canvas.picture = { width, height, values: new Float64Array(4 * width * height) });
      for (let y = Math.max(low, 0); y < Math.min(low + height, to.height); y++)
        for (let x = Math.max(left, 0); x < Math.min(left + width, to.width); x++)
          shade([x + 0.5, y + 0.5, 0, 1])?.forEach((v, k) => { to.values[4 * (y * to.width + x) + k] = v; });
    },
  };
  return new Proxy(gl, { get: (o, key) => (key in o ? o[key] : typeof key === "string" && key === key.toUpperCase() ? key : () => {}) });
}
