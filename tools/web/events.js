// ---- events: pointers, keys, files that are dropped ----

import { droppedFiles } from "./folders.js";

/* What an element listens to. */
export const withEvents = (Base) => class extends Base {
  listen(root) {
    const stage = this.$(".stage"), canvas = this.$("canvas"), pointers = new Map();
    let moved = 0, pinch = 0;
    root.addEventListener("input", ({ target }) => {
      if (target.classList.contains("split")) this.moveLine(), this.draw(false);
      else if (target.dataset.set) this.setControl(target);
    });
    root.addEventListener("click", ({ target }) => {
      const button = target.closest("[data-do]");
      if (button) this.try(() => this.command(button.dataset.do));
    });
    const isPicture = (event) => !event.target.closest("button, input");
    stage.addEventListener("pointerdown", (event) => {
      if (!isPicture(event)) return;
      pointers.set(event.pointerId, event);
      moved = pointers.size > 1 ? 99 : 0;
      pinch = 0;
    });
    stage.addEventListener("pointermove", (event) => {
      const last = pointers.get(event.pointerId);
      if (!last) {
        if (event.pointerType === "mouse" && isPicture(event)) this.hover(event);
        return;
      }
      const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
      moved += Math.abs(dx) + Math.abs(dy);
      pointers.set(event.pointerId, event);
      if (pointers.size === 2) {
        const [a, b] = pointers.values(), far = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (pinch) this.zoomBy(far / pinch, (a.clientX + b.clientX) / 2, (a.clientY + b.clientY) / 2);
        pinch = far;
      } else if (moved > 6 && this.zoom.times > 1) {
        if (!stage.hasPointerCapture(event.pointerId)) stage.setPointerCapture(event.pointerId);
        this.panTo(this.zoom.x + dx, this.zoom.y + dy);
      }
    });
    const end = (event) => {
      if (!pointers.delete(event.pointerId) || event.type !== "pointerup" || moved > 6) return;
      const target = this.targetAt(event.clientX, event.clientY);
      if (target < 0 || !this.renderer.canEdit(target)) return;
      this.select(this.targets[target]);
      this.note(this.targets[target]);
    };
    stage.addEventListener("pointerup", end);
    stage.addEventListener("pointercancel", end);
    stage.addEventListener("pointerleave", () => (this.$(".name").hidden = true));
    stage.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && this.zoom.times === 1 && event.deltaY > 0) return; // the page scrolls
      event.preventDefault();
      this.zoomBy(2 ** (-event.deltaY / 300), event.clientX, event.clientY);
    }, { passive: false });
    stage.addEventListener("dblclick", (event) => isPicture(event) && (this.zoom.times > 1 ? this.panTo(0, 0, 1) : this.zoomBy(2.5, event.clientX, event.clientY)));
    stage.addEventListener("keydown", (event) => {
      if (event.target !== stage) return;
      const step = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] }[event.key];
      if (step) this.panTo(this.zoom.x + step[0], this.zoom.y + step[1]);
      else if (event.key === "+" || event.key === "=") this.zoomBy(1.5);
      else if (event.key === "-") this.zoomBy(1 / 1.5);
      else if (event.key === "0") this.panTo(0, 0, 1);
      else return;
      event.preventDefault();
    });
    const room = this.$(".room"), dropAt = (event) => {
      const target = this.targetAt(event.clientX, event.clientY);
      return target >= 0 && this.renderer.canEdit(target) ? target : this.selected;
    };
    const isMap = (event) => !!event.target.closest?.(".finish") && !this.$("[data-set=map]").disabled;
    const drag = (event, on) => {
      event.preventDefault();
      room.classList.toggle("drop", on && !!this.renderer);
      this.hover(event);
      const where = isMap(event) ? `Map of finishes: ${this.targets[this.selected]}` : `Put it on: ${this.targets[dropAt(event)]}`;
      if (on && this.renderer) this.$(".name").hidden = false, (this.$(".name").textContent = where);
    };
    room.addEventListener("dragover", (event) => drag(event, true));
    room.addEventListener("dragleave", (event) => room.contains(event.relatedTarget) || drag(event, false));
    room.addEventListener("drop", (event) => {
      drag(event, false);
      if (!event.dataTransfer.files.length || !this.renderer) return;
      const dropped = droppedFiles(event.dataTransfer), asMap = isMap(event);
      if (!asMap) this.select(this.targets[dropAt(event)]);
      const name = this.targets[this.selected];
      this.try(async () => {
        const files = await dropped;
        if (files.length) await (asMap ? this.setMap(name, files[0]) : this.setTexture(name, files));
      });
    });
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.abort?.abort();
      this.renderer = null;
      canvas.classList.remove("shown");
      this.refresh();
      this.fail("The graphics card was needed elsewhere. The room comes back when it is free; reload the page if it does not.");
    });
    canvas.addEventListener("webglcontextrestored", () => this.isConnected && this.load(this.textures[0] && this.textures));
    new ResizeObserver(() => this.panTo(this.zoom.x, this.zoom.y)).observe(stage);
  }

  hover(event) {
    const target = this.targetAt(event.clientX, event.clientY), label = this.$(".name");
    label.hidden = target < 0;
    if (target >= 0) label.textContent = this.targets[target];
    clearTimeout(this.noting);
  }
};
