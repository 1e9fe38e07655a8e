// ---- colours ----

const srgbDecode = (y) => (y <= 0.04045 ? y / 12.92 : ((y + 0.055) / 1.055) ** 2.4);
const srgbEncode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

/* "#rrggbb" as a display shows it, or "rgb(r,g,b)" with linear numbers from 0 to 1, as the tools take it. Or null. */
function parseColor(text) {
  const hex = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(text);
  if (hex) return hex.slice(1).map((x) => srgbDecode(parseInt(x, 16) / 255));
  const linear = /^rgb\(\s*([\d.]+)\s*,\s*([\d.]+)\s*,\s*([\d.]+)\s*\)$/.exec(text);
  return linear ? linear.slice(1).map(Number) : null;
}

const toHex = (linear) => "#" + linear.map((x) => Math.round(255 * srgbEncode(Math.min(Math.max(x, 0), 1))).toString(16).padStart(2, "0")).join("");

const plainTexture = () => ({
  source: null, label: "Original", image: null, scale: 1, rotate: 0, offset: [0, 0], tint: "#ffffff", flip: "", wrap: "repeat", repeat: "straight",
});
const REPEATS = ["straight", "mirror", "brick", "half-drop"], WRAPS = ["repeat", "mirror", "clamp", "black"];
const isShifted = (repeat) => repeat === "brick" || repeat === "half-drop";

/* What the options of a texture may be. */
const isPair = (x) => Array.isArray(x) && x.length === 2 && x.every(Number.isFinite);
const PLACING = {
  scale: (x) => (Number.isFinite(x) || isPair(x)) && ![x].flat().includes(0),
  rotate: Number.isFinite,
  offset: isPair,
  tint: (x) => !!parseColor(x),
  flip: (x) => /^(u|v|uv|)$/.test(x),
  wrap: (x) => { const modes = String(x).split(","); return modes.length < 3 && modes.every((m) => WRAPS.includes(m)); },
  repeat: (x) => REPEATS.includes(x),
  label: (x) => typeof x === "string",
};

/* What `options` change about how a texture lies. */
function placing(texture, options) {
  const placed = {};
  for (const key in PLACING) {
    placed[key] = options[key] ?? texture[key];
    if (!PLACING[key](placed[key])) throw new Error(`A texture's ${key} cannot be ${JSON.stringify(placed[key])}.`);
  }
  if (isShifted(placed.repeat) && placed.wrap.split(",").some((m) => m !== "repeat"))
    throw new Error(`A texture's repeat ${placed.repeat} needs wrap repeat.`);
  return placed;
}

const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

// ---- the element ----

const STYLE = `
:host { display: block; position: relative; font: 15px/1.4 system-ui, sans-serif; color: #222; background: #f6f5f3; --line: #0002; --accent: #2f5d50; }
* { box-sizing: border-box; }
[hidden] { display: none !important; }
.room { display: grid; grid-template-columns: minmax(0, 1fr) 300px; height: 100%; }
.stage { position: relative; overflow: hidden; background: #e9e7e3; min-height: 0; display: grid; place-items: center; cursor: pointer; touch-action: pan-y; }
.stage.zoomed { cursor: grab; touch-action: none; }
.view { position: relative; width: 100%; max-height: 100%; transform-origin: 0 0; }
.view img, .view canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; }
.view canvas { opacity: 0; transition: opacity .3s; }
.view canvas.shown { opacity: 1; }
.bar { position: absolute; inset: 0 0 auto; height: 3px; appearance: none; width: 100%; border: 0; background: transparent; }
.bar::-webkit-progress-bar { background: transparent; } .bar::-webkit-progress-value { background: var(--accent); } .bar::-moz-progress-bar { background: var(--accent); }
.tools { position: absolute; right: 10px; bottom: 10px; display: flex; gap: 2px; padding: 3px; border-radius: 12px; background: #fffd; box-shadow: 0 1px 6px #0003; }
.tools button { border: 0; background: none; min-width: 44px; height: 44px; padding: 0 6px; border-radius: 9px; }
svg { width: 22px; height: 22px; fill: none; stroke: currentColor; stroke-width: 1.7; display: block; margin: auto; }
.tools button:hover, .tools button[aria-pressed=true] { background: #0001; }
.name { position: absolute; left: 10px; top: 10px; padding: 4px 10px; border-radius: 10px; background: #fffd; pointer-events: none; }
.line { position: absolute; width: 2px; margin-left: -1px; background: #fff; box-shadow: 0 0 4px #0008; pointer-events: none; }
.split { position: absolute; height: 44px; margin: 0; background: none; appearance: none; cursor: ew-resize; }
.split::-webkit-slider-thumb { appearance: none; width: 44px; height: 44px; border-radius: 50%; background: #fffe; box-shadow: 0 1px 6px #0005; }
.split::-moz-range-thumb { width: 44px; height: 44px; border: 0; border-radius: 50%; background: #fffe; box-shadow: 0 1px 6px #0005; }
.split::-webkit-slider-runnable-track { background: none; }
.split:focus-visible { outline: none; } .split:focus-visible::-webkit-slider-thumb { outline: 3px solid var(--accent); } .split:focus-visible::-moz-range-thumb { outline: 3px solid var(--accent); }
.message { position: absolute; left: 16px; top: 16px; max-width: calc(100% - 32px); padding: 14px 20px; border-radius: 12px; background: #fff; box-shadow: 0 2px 14px #0004; }
.panel { padding: 18px; overflow: auto; border-left: 1px solid var(--line); background: #fff; min-height: 0; }
h2 { font-size: 13px; font-weight: 600; margin: 18px 0 6px; color: #555; } h2:first-child { margin-top: 0; }
.row { display: flex; flex-wrap: wrap; gap: 6px; }
button { font: inherit; color: inherit; cursor: pointer; }
.panel button, .file { min-height: 40px; padding: 6px 12px; border: 1px solid var(--line); border-radius: 10px; background: #fff; }
.panel button:hover, .file:hover { border-color: #0006; }
.panel [aria-pressed=true] { border-color: var(--accent); background: #2f5d5014; }
.panel :disabled, .file:has(:disabled) { opacity: .45; cursor: default; }
.swatch[aria-pressed=true] { outline: 3px solid var(--accent); outline-offset: -1px; }
.swatch { width: 44px; height: 44px; padding: 0 !important; background-size: cover !important; }
.file { display: inline-flex; align-items: center; cursor: pointer; }
.file:focus-within, :focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
.file input { position: absolute; opacity: 0; width: 1px; height: 1px; }
label.slider { display: grid; grid-template-columns: 86px 1fr 48px; align-items: center; gap: 8px; min-height: 40px; }
label.slider output { text-align: right; font-variant-numeric: tabular-nums; color: #555; }
input[type=range] { width: 100%; height: 30px; accent-color: var(--accent); margin: 0; }
input[type=color], select { width: 44px; height: 40px; padding: 2px; border: 1px solid var(--line); border-radius: 10px; background: #fff; }
select { font: inherit; color: inherit; width: 130px; padding: 2px 8px; }
.drop { outline: 3px dashed var(--accent); outline-offset: -8px; }
.quiet { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
@media (max-width: 760px), (max-aspect-ratio: 1/1) {
  .room { grid-template: auto minmax(0, 1fr) / minmax(0, 1fr); }
  .panel { border-left: 0; border-top: 1px solid var(--line); padding: 14px; }
  .tools { position: relative; inset: auto; width: 100%; justify-content: space-around; border-radius: 0; background: inherit; box-shadow: none; }
  .stage { grid-template-rows: auto auto; }
}
@media (prefers-reduced-motion: reduce) { * { transition: none !important; } }
@media (prefers-color-scheme: dark) {
  :host { color: #eee; background: #1b1b1a; --line: #fff3; --accent: #8fc7b5; }
  .stage { background: #111; } .panel, .panel button, .file, input[type=color], select, .message { background: #222221; }
  .tools, .name { background: #222d; } h2, label.slider output { color: #bbb; } .tools button:hover { background: #fff2; }
}`;

const TOOLS = [
  ["compare", "Before and after", "M4 5h16v14H4zM12 2v20"],
  ["out", "Zoom out", "M5 12h14"],
  ["in", "Zoom in", "M5 12h14M12 5v14"],
  ["full", "Full screen", "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5"],
  ["download", "Download the picture", "M12 4v11M7 11l5 5 5-5M5 20h14"],
  ["link", "Copy a link to this room", "M10 14l4-4M8 11l-3 3a3.5 3.5 0 0 0 5 5l3-3M16 13l3-3a3.5 3.5 0 0 0-5-5l-3 3"],
].map(([name, text, path]) => `<button data-do="${name}" title="${text}" aria-label="${text}"><svg aria-hidden="true" viewBox="0 0 24 24"><path d="${path}"/></svg></button>`).join("");

const slider = (name, text, low, high, step) => `<label class="slider"><span>${text}</span><input type="range" min="${low}" max="${high}" step="${step}" value="0" data-set="${name}"><output></output></label>`;

const BODY = `
<div class="room">
  <div class="stage" part="stage" tabindex="0" role="group" aria-label="Picture">
    <div class="view"><img alt="" hidden><canvas role="img" aria-label="The room"></canvas></div>
    <div class="name" aria-hidden="true" hidden></div>
    <div class="line" hidden></div>
    <input class="split" type="range" min="0" max="100" step="1" value="50" aria-label="Before and after" hidden>
    <progress class="bar" max="1" value="0" aria-label="Loading"></progress>
    <div class="message" role="alert" hidden></div>
    <div class="tools" role="group" aria-label="View">
${TOOLS}
    </div>
  </div>
  <div class="panel" part="panel">
    <h2 id="what">Surface</h2>
    <div class="row targets" role="group" aria-labelledby="what"></div>
    <h2 id="with">Texture</h2>
    <div class="row swatches" role="group" aria-labelledby="with"></div>
    <div class="row" style="margin-top:6px">
      <label class="file">Your photo…<input type="file" accept="image/*" data-set="file"></label>
      <input type="color" value="#c8b9a6" data-set="color" title="One colour" aria-label="One colour">
      <button data-do="original">Original</button>
    </div>
    <div class="placing">
      ${slider("size", "Size", -3, 3, 0.01)}${slider("rotate", "Turn", -180, 180, 1)}
      ${slider("right", "Shift right", -1, 1, 0.01)}${slider("up", "Shift up", -1, 1, 0.01)}
      <label class="slider"><span>Repeats</span><select data-set="repeat">${REPEATS.map((x) => `<option value="${x}">${x[0].toUpperCase() + x.slice(1)}</option>`).join("")}</select></label>
      <label class="slider"><span>Tint</span><input type="color" data-set="tint"><output></output></label>
    </div>
    <h2>Light</h2>
    ${slider("exposure", "Brightness", -2, 2, 0.05)}${slider("warmth", "Warmth", -1, 1, 0.05)}
  </div>
  <div class="quiet" role="status" aria-live="polite"></div>
</div>`;

const NO_WEBGL = "This browser cannot change textures: it has no WebGL 2. The picture is as it was rendered.";

