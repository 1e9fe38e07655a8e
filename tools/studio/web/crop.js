/* A part of the picture to try: [left, top, width, height] in parts of the picture, 0 to 1. It is drawn by dragging, and
 * moved and sized by keys. */

const LEAST = 0.02;
export const MIDDLE = [0.35, 0.35, 0.3, 0.3];
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/* Between two corners. */
export function partBetween([ax, ay], [bx, by]) {
  const [left, right] = [ax, bx].map((x) => clamp(x, 0, 1)).sort((a, b) => a - b);
  const [top, bottom] = [ay, by].map((y) => clamp(y, 0, 1)).sort((a, b) => a - b);
  const width = Math.max(right - left, LEAST), height = Math.max(bottom - top, LEAST);
  return [Math.min(left, 1 - width), Math.min(top, 1 - height), width, height];
}

export const partMoved = ([x, y, w, h], right, down) => [clamp(x + right, 0, 1 - w), clamp(y + down, 0, 1 - h), w, h];
export const partSized = ([x, y, w, h], right, down) => [x, y, clamp(w + right, LEAST, 1 - x), clamp(h + down, LEAST, 1 - y)];

/* In whole pixels of the render, at least 16 each way. */
export function partPixels([x, y, w, h], { width, height }) {
  const across = clamp(Math.round(w * width), Math.min(16, width), width), down = clamp(Math.round(h * height), Math.min(16, height), height);
  return [clamp(Math.round(x * width), 0, width - across), clamp(Math.round(y * height), 0, height - down), across, down];
}

const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const STEP = 0.02;

/* place: lies over the picture; frame: the part in it. onChange(part) is called with each new part. */
export class Crop {
  constructor(place, frame, onChange) {
    Object.assign(this, { place, frame, onChange });
    let start = null;
    const at = (event) => {
      const box = place.getBoundingClientRect();
      return [(event.clientX - box.x) / box.width, (event.clientY - box.y) / box.height];
    };
    place.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      start = at(event);
      place.setPointerCapture(event.pointerId);
    });
    place.addEventListener("pointermove", (event) => {
      const now = at(event);
      if (start && Math.hypot(now[0] - start[0], now[1] - start[1]) > LEAST) this.change(partBetween(start, now));
    });
    for (const name of ["pointerup", "pointercancel"]) place.addEventListener(name, () => (start = null));
    frame.addEventListener("keydown", (event) => {
      const [right, down] = KEYS[event.key] || [];
      if (right === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      this.change((event.shiftKey ? partSized : partMoved)(this.part, right * STEP, down * STEP));
    });
    this.put(MIDDLE);
  }

  put(part) {
    this.part = part;
    ["left", "top", "width", "height"].forEach((side, k) => (this.frame.style[side] = `${100 * part[k]}%`));
  }

  change(part) {
    this.show("");
    this.put(part);
    this.onChange(part);
  }

  /* The rendered part lies where it belongs. */
  show(address) {
    this.frame.style.backgroundImage = address ? `url("${address}")` : "";
  }
}
