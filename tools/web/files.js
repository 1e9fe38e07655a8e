// ---- files ----

const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; k++) n = n & 1 ? (n >>> 1) ^ 0xedb88320 : n >>> 1;
  return n;
});

export function crc32(bytes) {
  let crc = -1;
  for (let i = 0; i < bytes.length; i++) crc = crcTable[(crc ^ bytes[i]) & 255] ^ (crc >>> 8);
  return ~crc >>> 0;
}

/* Connections that break and servers that are busy are tried again, after .5, 1, 2 and 4 seconds. */
export async function fetchBytes(url, signal, cache = "default") {
  for (let wait = 500; ; wait *= 2) {
    let answer;
    try {
      answer = await fetch(url, { signal, cache });
      if (answer.ok) return new Uint8Array(await answer.arrayBuffer());
    } catch (error) {
      if (signal.aborted) throw error;
      if (location.protocol === "file:") throw new Error("This page must come from a web server, not from a file.");
      if (await isRefused(url, signal)) throw new Error(refusalOf(url));
      if (wait > 4000) throw new Error(`${nameOf(url)} could not be loaded. Is there a connection?`);
    }
    if (answer && !answer.ok && (answer.status < 500 || wait > 4000))
      throw Object.assign(new Error(`${nameOf(url)} is missing (status ${answer.status}).`), { status: answer.status });
    await new Promise((resolve) => setTimeout(resolve, wait));
    signal.throwIfAborted();
  }
}

/* Of what another site does not let pages read, browsers tell a page no more than of a broken connection: neither headers
 * nor status. Asked for without reading it, it arrives all the same. */
const isRefused = async (url, signal) => new URL(url, location.href).origin !== location.origin &&
  fetch(url, { signal, mode: "no-cors", cache: "no-store" }).then(() => !signal.aborted, () => false);

const refusalOf = (url) => `${new URL(url).host} answers, but does not let pages of ${location.origin} read ${nameOf(url)}: ` +
  "the header Access-Control-Allow-Origin is missing, or names another site.";

/* What people call the file of an address. */
export function nameOf(url) {
  const name = /^(data|blob):/.test(url) ? "Picture" : String(url).split(/[?#]/)[0].split("/").pop();
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

/* A file of the room, whose size and checksum the manifest has. A damaged one may be a cache's. */
export async function fetchChecked(base, entry, signal) {
  for (const cache of ["default", "reload"]) {
    const bytes = await fetchBytes(new URL(entry.file, base), signal, cache);
    if (bytes.length === entry.bytes && crc32(bytes) === entry.crc32) return bytes;
  }
  throw new Error(`${entry.file} is damaged.`);
}

/* Browsers show what is left of a damaged picture, without a word. What its markers, lengths and checksums tell is looked
 * up here; of changes in between, such as in the codes of a JPEG, nobody is told. */
export function isDamaged(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  try {
    if (view.getUint32(0) === 0x89504e47)
      for (let at = 8, type = 0, length = 0; type !== 0x49454e44; at += length + 12) {
        length = view.getUint32(at);
        type = view.getUint32(at + 4);
        if (view.getUint32(at + 8 + length) !== crc32(bytes.subarray(at + 4, at + 8 + length))) return true;
      }
    else if (view.getUint16(0) === 0xffd8)
      for (let at = 2, code = 0, inScan = false; code !== 0xd9; ) {
        const isMarker = view.getUint8(at++) === 255;
        if (!isMarker && !inScan) return true;
        if (!isMarker) continue;
        while ((code = view.getUint8(at++)) === 255);
        if (code < 2 || (code >= 0xd0 && code < 0xda)) continue;
        at += view.getUint16(at);
        inScan = code === 0xda;
      }
    else if (view.getUint32(0) === 0x52494646) return view.getUint32(4, true) + 8 > bytes.length;
    return false;
  } catch {
    return bytes.length > 4; // it ends before what it promises
  }
}

export async function decodeImage(blob, name) {
  const image = new Image();
  image.src = URL.createObjectURL(blob);
  try {
    await image.decode();
    if (!image.naturalWidth) throw image; // a drawing without a size
  } catch {
    throw new Error(`${name} is no picture that this browser reads.`);
  } finally {
    URL.revokeObjectURL(image.src);
  }
  return image;
}

export const decodeJpeg = (bytes, name) => decodeImage(new Blob([bytes], { type: "image/jpeg" }), name);

/* most: more bytes than a whole file has. */
export async function inflate(bytes, name, most) {
  const parts = [];
  try {
    const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
    for (let part; !(part = await reader.read()).done && most > 0; most -= part.value.length) parts.push(part.value);
    if (most <= 0) throw reader.cancel();
  } catch {
    throw new Error(`${name} is damaged.`);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

export const mostBytes = (c) => 1 + c.footprints.length * (16 + c.height * (((c.width + 7) >> 3) + c.width * (c.spreads + 8 + 2)));

// ---- footprints ----

/* The integers of one plane, in the pixels where `present` is 1. */
export function decodePlane(stream, present, width, height, out, shift, mask) {
  const head = stream.data[stream.at++], predictor = head & 15, size = head >> 4;
  out.fill(0);
  if (!size) return;
  const count = stream.count, data = stream.data, first = stream.at;
  let last = 0, at = 0;
  for (let y = 0, i = 0; y < height; y++)
    for (let x = 0; x < width; x++, i++) {
      if (!present[i]) continue;
      let residual = data[first + at];
      for (let k = 1; k < size; k++) residual |= data[first + k * count + at] << (8 * k);
      residual = (residual >>> 1) ^ -(residual & 1);
      at++;
      const left = x > 0 && present[i - 1], upper = y > 0 && present[i - width];
      let guess = 0;
      if (!predictor) guess = 0;
      else if (left && upper && present[i - width - 1]) {
        const a = out[i - 1], b = out[i - width], c = out[i - width - 1];
        if (predictor === 1) guess = a;
        else if (predictor === 2) guess = b;
        else if (predictor === 3 || (c < Math.max(a, b) && c > Math.min(a, b))) guess = a + b - c;
        else guess = c >= Math.max(a, b) ? Math.min(a, b) : Math.max(a, b);
      } else guess = left ? out[i - 1] : upper ? out[i - width] : last;
      const s = shift ? shift[i] : 0;
      guess = (guess + ((1 << s) >> 1)) >> s;
      out[i] = last = ((guess + residual) << s) & mask;
    }
  stream.at += count * size;
  if (stream.at > data.length) throw new Error("Footprints are damaged.");
}

export const RECORD_COLUMNS = 2048;
export const LOG_OFFSET = 24, LOG_STEPS = 2048;

/* The derivative of mean UV at pixel i, to the right or down, of u or v, by its neighbours within 64 rows: half the difference
 * of both or, with one of them only, by two on its side. On a periodic axis differences go the shorter way round. */
function stepAt({ present, uv }, i, down, axis, { width, height }, periodic) {
  const x = i % width, y = (i - x) / width, far = down ? width : 1, place = down ? y & 63 : x;
  const count = down ? Math.min(height - (y - place), 64) : width;
  const has = (k) => place + k >= 0 && place + k < count && present[i + k * far];
  const d = [-2, -1, 0, 1].map((k) => {
    const step = has(k) && has(k + 1) ? (uv[axis][i + (k + 1) * far] - uv[axis][i + k * far]) / 262144 : 0;
    return periodic[axis] ? step - Math.round(step) : step;
  });
  if (has(-1) && has(1)) return 0.5 * (d[1] + d[2]);
  if (has(-1)) return has(-2) ? 1.5 * d[1] - 0.5 * d[0] : d[1];
  return has(2) ? 1.5 * d[2] - 0.5 * d[3] : d[2];
}

/* How many records a footprint takes in a pixel: those with axes have a second one. */
export const recordsEach = (info) => (info.spreads === 4 ? 2 : 1);

/* All footprints of a class as records of four 32-bit numbers, pixel by pixel, and for each pixel where its records
 * begin, times 32, plus how many there are. */
export function decodeClass(info, data, base, periodic = []) {
  const { width, height } = info, pixels = width * height, stream = { data, at: 0, count: 0 };
  const footprints = info.footprints.map((f) => {
    const present = new Uint8Array(pixels), rowBytes = (width + 7) >> 3;
    stream.count = 0;
    for (let y = 0, i = 0; y < height; y++)
      for (let x = 0; x < width; x++, i++)
        stream.count += present[i] = (data[stream.at + y * rowBytes + (x >> 3)] >> (x & 7)) & 1;
    stream.at += rowBytes * height;
    const coded = (bytes) => {
      decodePlane(stream, present, width, height, bytes, null, 255);
      return bytes;
    };
    const spread = Array.from({ length: info.spreads === 4 ? 2 : info.spreads }, () => coded(new Uint8Array(pixels)));
    const uv = [0, 1].map((k) => {
      const shift = new Uint8Array(pixels), out = new Int32Array(pixels);
      for (let i = 0; i < pixels; i++)
        shift[i] = Math.min(Math.max(Math.floor((spread[k][i] - 1 + f.sigma_first) / f.per_octave), 0), 24);
      decodePlane(stream, present, width, height, out, shift, -1);
      return out;
    });
    const weights = f.weights.map((first) => (typeof first === "number" ? coded(new Uint8Array(pixels)) : null));
    return { f, present, spread, uv, weights };
  });
  if (stream.at !== data.length) throw new Error(`${info.file} is damaged.`);
  const most = footprints.reduce((m, { f, weights }) =>
    Math.max(m, ...f.weights.map((w, k) => (w === "one" ? 1 : weights[k] ? w * weights[k].reduce((a, b) => Math.max(a, b), 0) : 0))), 1e-6);
  for (const p of footprints) {
    const { f } = p;
    p.log = Uint16Array.from({ length: 256 }, (_, k) => k ? Math.min(Math.max(
      Math.round((Math.log2(f.first) + (k - 1) / f.per_octave + LOG_OFFSET) * LOG_STEPS), 1), 65535) : 0);
    p.rho = Uint8Array.from({ length: 256 }, (_, k) => f.angle_steps ? 128 + Math.round(127 *
      Math.sin(Math.min(Math.max((k - 128) / f.angle_steps, -1), 1) * Math.PI / 2)) : 128);
    p.share = f.weights.map((w) => Uint16Array.from({ length: 256 }, (_, k) =>
      w === "one" ? 4095 : w ? Math.round(Math.min(k * w / most, 1) * 4095) : 0));
    if (f.weights.includes("one")) p.share = p.share.map((t, k) => f.weights[k] === "one" ? t.fill(Math.round(4095 / most)) : t);
  }
  const total = footprints.reduce((n, p) => n + p.present.reduce((a, b) => a + b, 0), 0);
  if (total !== info.records) throw new Error(`${info.file} is damaged.`);
  const rows = Math.ceil(total * recordsEach(info) / RECORD_COLUMNS);
  const records = new Uint32Array(rows * RECORD_COLUMNS * 4), floats = new Float32Array(records.buffer);
  const heads = new Uint32Array(pixels);
  let at = 0;
  for (let i = 0; i < pixels; i++) {
    const begin = at;
    for (const p of footprints) {
      if (!p.present[i]) continue;
      const w = [0, 1].map((k) => (p.share[k] ? p.share[k][p.weights[k] ? p.weights[k][i] : 0] : 0));
      floats[4 * at] = p.uv[0][i] / 262144;
      floats[4 * at + 1] = p.uv[1][i] / 262144;
      records[4 * at + 2] = p.log[p.spread[0][i]] | (p.log[p.spread[1][i]] << 16);
      records[4 * at + 3] = (info.spreads === 3 ? p.rho[p.spread[2][i]] : 128) | (w[0] << 8) | (w[1] << 20);
      at++;
      if (info.spreads < 4) continue;
      for (let k = 0; k < 4; k++) floats[4 * at + k] = stepAt(p, i, k > 1, k & 1, info, periodic);
      at++;
    }
    heads[i] = (base + begin) * 32 + at - begin;
  }
  return { heads, records, rows };
}
