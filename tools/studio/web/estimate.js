/* What a render will take, by two small ones. */

/* The line through two points, at x; never below what was measured at the larger one. */
function extended([x1, y1], [x2, y2], x) {
  const slope = x2 > x1 ? Math.max(0, (y2 - y1) / (x2 - x1)) : 0;
  return Math.max(y2 + slope * (x - x2), 0);
}

/* trials: two of { pixels, samples, seconds, setup, memory, bytes }, the smaller first; seconds are those of rendering,
 * setup those before. render: { width, height, samples, noise, denoise }. With `noise` samples are the most there can be. */
export function estimate(trials, { width, height, samples }) {
  const [small, large] = trials, pixels = width * height;
  const seconds = extended([small.pixels * small.samples, small.seconds], [large.pixels * large.samples, large.seconds], pixels * samples);
  return {
    seconds: Math.max(small.setup, large.setup) + seconds,
    memory: extended([small.pixels, small.memory], [large.pixels, large.memory], pixels),
    bytes: extended([small.pixels, small.bytes], [large.pixels, large.bytes], pixels),
  };
}

/* Of the JSON that --stats prints. */
export function trialOf(text, pixels, samples, bytes) {
  const stats = JSON.parse(text);
  return {
    pixels, samples, bytes, seconds: stats.render_seconds + (stats.denoise_seconds || 0),
    setup: stats.parse_seconds + stats.build_seconds, memory: stats.peak_memory_bytes,
  };
}

const few = (x) => (x < 10 ? Number(x.toPrecision(2)) : Math.round(x));

export function durationText(seconds) {
  if (seconds < 1) return "less than a second";
  if (seconds < 90) return `${Math.round(seconds)} seconds`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} minutes`;
  return `${few(seconds / 3600)} hours`;
}

export function bytesText(bytes) {
  if (bytes < 1e3) return `${bytes} bytes`;
  const step = bytes < 1e6 ? 1 : bytes < 1e9 ? 2 : 3;
  return `${few(bytes / 1000 ** step)} ${["KB", "MB", "GB"][step - 1]}`;
}
