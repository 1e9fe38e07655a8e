// ---- the room itself, and smaller ones beside it for small screens ----

const GROW_AFTER = 300; // ms, when a zoom or a size stands
const NEARLY = 0.95; // of the pixels of the screen are enough

/* Which of the rooms in a folder an element loads. */
export const withSizes = (Base) => class extends Base {
  /* The manifest's own room and those that it names, the smallest first. */
  setRooms(whole) {
    this.rooms = [...(whole.smaller || []), whole].sort((a, b) => a.width - b.width);
  }

  /* The smallest that has a pixel for each of the screen's, or the largest that can be had. */
  pickRoom() {
    const { width, height } = this.$(".stage").getBoundingClientRect(), whole = this.rooms.at(-1);
    const seen = Math.min(width, (height * whole.width) / whole.height) * devicePixelRatio * this.zoom.times;
    const rooms = this.largest ? this.rooms.filter((room) => room.width <= this.largest) : this.rooms;
    return (!this.wholeWanted && rooms.find((room) => room.width >= NEARLY * seen)) || rooms.at(-1);
  }

  get mustGrow() {
    return this.isComplete && this.isConnected && this.pickRoom().width > this.room.width;
  }

  /* Another one where the place or the zoom has grown; what is shown stays until it is there. */
  grow() {
    clearTimeout(this.growing);
    if (this.mustGrow) this.growing = setTimeout(() => this.mustGrow && this.loadLarger(), GROW_AFTER);
  }

  /* If it does not come, the one that was there comes again. */
  loadLarger() {
    const { width } = this.room;
    return this.load(this.textures, () => {
      this.largest = width;
      return this.load(this.textures);
    });
  }

  /* The whole room, for pictures that are taken away. */
  async growWhole() {
    this.wholeWanted = true;
    await this.complete;
    if (this.mustGrow) this.loadLarger();
    await this.complete;
  }
};
