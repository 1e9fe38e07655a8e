// ---- the view: what is seen where, zoom ----

import { clamp } from "./values.js";

/* How an element's picture lies on the stage. */
export const withView = (Base) => class extends Base {
  moveLine() {
    const { left, top, width, height } = this.$("canvas").getBoundingClientRect(), stage = this.$(".stage").getBoundingClientRect();
    const split = this.$(".split");
    const bottom = Math.min(top + height, stage.bottom) - stage.top;
    Object.assign(split.style, { left: `${left - stage.left - 22}px`, width: `${width + 44}px`, top: `${bottom - 52}px` });
    const x = left - stage.left + (width * split.value) / 100;
    Object.assign(this.$(".line").style, { left: `${x}px`, top: `${top - stage.top}px`, height: `${height}px` });
  }

  zoomBy(times, x, y) {
    const stage = this.$(".stage").getBoundingClientRect(), z = this.zoom, next = clamp(z.times * times, 1, 12);
    const view = this.$(".view"), left = view.offsetLeft, top = view.offsetTop;
    const px = (x ?? stage.left + stage.width / 2) - stage.left - left, py = (y ?? stage.top + stage.height / 2) - stage.top - top;
    this.panTo(px - ((px - z.x) * next) / z.times, py - ((py - z.y) * next) / z.times, next);
  }

  panTo(x, y, times = this.zoom.times) {
    const view = this.$(".view"), width = view.offsetWidth, height = view.offsetHeight;
    this.zoom = { times, x: clamp(x, width - width * times, 0), y: clamp(y, height - height * times, 0) };
    view.style.transform = times > 1 ? `translate(${this.zoom.x}px, ${this.zoom.y}px) scale(${times})` : "";
    this.$(".stage").classList.toggle("zoomed", times > 1);
    this.moveLine();
    this.grow();
  }

  /* The target that is seen at a place of the window, or -1: of several in a pixel the one with most light, or the smaller
   * one. */
  targetAt(x, y) {
    const box = this.$("canvas").getBoundingClientRect(), room = this.room;
    if (!room || !this.renderer) return -1;
    const px = Math.floor(((x - box.left) / box.width) * room.width), py = Math.floor(((y - box.top) / box.height) * room.height);
    if (px < 0 || py < 0 || px >= room.width || py >= room.height) return -1;
    const classes = this.renderer.full.filter((c) => c.heads && c.heads[py * room.width + px] & 31), seen = [...new Set(classes.map((c) => c.target))];
    if (seen.length < 2) return seen[0] ?? -1;
    const lights = seen.map((t) => this.renderer.lightOf(t, px, py)), most = Math.max(...lights);
    return seen.filter((_, i) => lights[i] === most).reduce((a, b) => (room.targets[a].share < room.targets[b].share ? a : b));
  }
};
