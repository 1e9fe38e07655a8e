// ---- what an element shows: its style, its picture and its panel ----

import { BONDS, REPEATS } from "./edit.js";

export const STYLE = `
:host { display: block; position: relative; container: room / size; height: clamp(min(80svh, 640px), 56vw, 90svh); font: 15px/1.4 system-ui, sans-serif; color: #222; background: #f6f5f3; --line: #0002; --soft: #555; --paper: #fff; --accent: #2f5d50; }
* { box-sizing: border-box; }
[hidden] { display: none !important; }
.room { display: grid; grid-template-columns: minmax(0, 1fr) auto; height: 100%; }
.stage { position: relative; overflow: hidden; background: #e9e7e3; min-height: 0; container-type: size; display: grid; place-items: center; cursor: pointer; touch-action: pan-y; }
.stage.zoomed { cursor: grab; touch-action: none; }
.view { position: relative; --high: 100cqh; width: min(100%, var(--high) * var(--ratio)); aspect-ratio: var(--ratio); transform-origin: 0 0; }
.view img, .view canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; }
.view canvas { opacity: 0; transition: opacity .3s; }
.view canvas.shown { opacity: 1; }
.bar { position: absolute; inset: 0 0 auto; height: 3px; appearance: none; width: 100%; border: 0; background: transparent; }
.bar::-webkit-progress-bar { background: transparent; } .bar::-webkit-progress-value { background: var(--accent); } .bar::-moz-progress-bar { background: var(--accent); }
.tools { position: absolute; right: 10px; bottom: 10px; display: flex; gap: 2px; padding: 3px; border-radius: 12px; background: color-mix(in srgb, var(--paper) 88%, #0000); box-shadow: 0 1px 6px #0003; }
.tools button { border: 0; background: none; min-width: 44px; height: 44px; padding: 0 6px; border-radius: 9px; }
svg { width: 22px; height: 22px; fill: none; stroke: currentColor; stroke-width: 1.7; display: block; margin: auto; }
.tools button:hover, .tools [aria-pressed=true], .tools [aria-expanded=true] { background: #8883; }
.name { position: absolute; left: 50%; top: 12px; transform: translate(-50%); padding: 5px 14px; border-radius: 16px; background: var(--paper); box-shadow: 0 1px 6px #0003; pointer-events: none; }
.line { position: absolute; width: 2px; margin-left: -1px; background: #fff; box-shadow: 0 0 4px #0008; pointer-events: none; }
.line::before, .line::after { content: "After"; position: absolute; top: 14px; left: 12px; padding: 2px 10px; border-radius: 12px; background: #000a; color: #fff; font-size: 13px; }
.line::before { content: "Before"; left: auto; right: 12px; }
.split { position: absolute; height: 44px; margin: 0; background: none; appearance: none; cursor: ew-resize; --thumb: #fff url('data:image/svg+xml,<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 44 44" fill="none" stroke="%23333" stroke-width="2"><path d="M18 15l-7 7 7 7M26 15l7 7-7 7"/></svg>'); }
.split::-webkit-slider-thumb { appearance: none; width: 44px; height: 44px; border-radius: 50%; background: var(--thumb); box-shadow: 0 1px 6px #0005; }
.split::-moz-range-thumb { width: 44px; height: 44px; border: 0; border-radius: 50%; background: var(--thumb); box-shadow: 0 1px 6px #0005; }
.split::-webkit-slider-runnable-track { background: none; }
.split:focus-visible { outline: none; } .split:focus-visible::-webkit-slider-thumb { outline: 3px solid var(--accent); } .split:focus-visible::-moz-range-thumb { outline: 3px solid var(--accent); }
.message { position: absolute; inset: 14px 14px auto; width: fit-content; margin: auto; display: flex; gap: 8px; align-items: center; padding: 8px 8px 8px 20px; border-radius: 14px; background: var(--paper); box-shadow: 0 2px 14px #0004; }
.message button { border: 0; background: none; padding: 10px; }
.empty .panel, .empty .tools { display: none; }
.panel { width: 304px; padding: 20px; overflow: auto; border-left: 1px solid var(--line); background: var(--paper); min-height: 0; }
h2 { display: flex; font-size: 15px; font-weight: 600; margin: 24px 0 10px; } h2:first-child { margin-top: 0; }
h2 .chosen { margin-left: auto; padding-left: 12px; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; font-weight: 400; color: var(--soft); }
.row { display: flex; flex-wrap: wrap; gap: 8px; margin-bottom: 12px; } .row > * { flex: 1 0 auto; } .row:empty { display: none; }
button { font: inherit; color: inherit; cursor: pointer; }
.panel button, .file { min-height: 42px; padding: 6px 12px; border: 1px solid var(--line); border-radius: 10px; background: var(--paper); }
.panel button:hover, .file:hover { border-color: #0006; }
.panel [aria-pressed=true] { border-color: var(--accent); background: color-mix(in srgb, var(--accent) 9%, #0000); }
.panel :disabled, .file:has(:disabled) { opacity: .45; cursor: default; }
.swatches { display: grid; grid-template-columns: repeat(auto-fill, minmax(56px, 1fr)); } .colors { grid-template-columns: repeat(auto-fill, minmax(var(--round, 30px), 1fr)); }
.swatches > * { aspect-ratio: 1; width: 100% !important; height: auto !important; min-height: 0 !important; padding: 0 !important; background-size: cover !important; }
.colors > * { border-radius: 50% !important; }
.swatch[aria-pressed=true] { outline: 3px solid var(--accent); outline-offset: 2px; }
.colors input { padding: 4px !important; border: 0 !important; background: conic-gradient(#e55, #dc3, #4b4, #3bc, #55e, #c4c, #e55) !important; }
input::-webkit-color-swatch { border: 0; border-radius: inherit; } input::-webkit-color-swatch-wrapper { padding: 0; border-radius: inherit; }
.file { position: relative; display: flex; align-items: center; justify-content: center; cursor: pointer; }
.file:focus-within, :focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
.file input { position: absolute; opacity: 0; width: 1px; height: 1px; }
label.slider { display: grid; grid-template-columns: 86px 1fr 48px; align-items: center; gap: 8px; min-height: 42px; }
label.slider output { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; color: var(--soft); }
input[type=range] { width: 100%; height: 30px; accent-color: var(--accent); margin: 0; }
input[type=color], select { width: 44px; height: 36px; padding: 3px; border: 1px solid var(--line); border-radius: 10px; background: var(--paper); cursor: pointer; }
select { font: inherit; color: inherit; width: 130px; padding: 2px 8px; }
.lamp { display: grid; grid-template-columns: 1fr 42px; gap: 0 8px; margin-bottom: 14px; } .lamp label { grid-column: 1 / -1; }
.lamp button { display: flex; gap: 8px; justify-content: space-between; align-items: center; overflow-wrap: anywhere; text-align: left; } .lamp i { font-style: normal; color: var(--soft); } .lamp button + button { justify-content: center; padding: 0; } .lamp label.slider { grid-template-columns: 86px 1fr 56px; }
.finish { display: grid; grid-template-columns: 1fr 42px; gap: 0 8px; align-items: start; } .finish h2 { grid-column: 1 / -1; margin-top: 12px; } .finish button { padding: 0; }
.file:has(:checked) { border-color: var(--accent); background: color-mix(in srgb, var(--accent) 9%, #0000); }
.drop .stage::after { content: ""; position: absolute; inset: 10px; border: 3px dashed #fff; outline: 99vmax solid #0005; border-radius: 14px; pointer-events: none; }
.drop .name { top: 40%; padding: 12px 24px; border-radius: 24px; font-size: 18px; z-index: 1; }
.quiet { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
@container room (max-aspect-ratio: 11/10) or (max-width: 560px) {
  .room { grid-template: auto minmax(0, 1fr) / minmax(0, 1fr); } .room.wide { grid-template-rows: 1fr; }
  .panel { --round: 42px; width: auto; border-left: 0; border-top: 1px solid var(--line); padding: 16px; }
  .tools { position: relative; inset: auto; width: 100%; justify-content: space-around; border-radius: 0; background: inherit; box-shadow: none; }
  .stage { container-type: normal; grid-template-rows: minmax(0, 1fr) auto; }
  .view { --high: 58cqh; } .wide .view { --high: calc(100cqh - 50px); }
}
@media (prefers-reduced-motion: reduce) { * { transition: none !important; } }
@media (forced-colors: active) {
  .swatch, .colors input, .split { forced-color-adjust: none; } .name, .message, .tools { border: 1px solid; }
  .panel [aria-pressed=true], .tools [aria-pressed=true], .file:has(:checked) { outline: 3px solid Highlight; }
}
@media (prefers-color-scheme: dark) {
  :host { color: #eee; background: #1b1b1a; color-scheme: dark; --line: #fff3; --paper: #222221; --soft: #bbb; --accent: #8fc7b5; }
  .stage { background: #111; }
}`;

const icon = (name, text, path) => `<button data-do="${name}" title="${text}" aria-label="${text}"><svg aria-hidden="true" viewBox="0 0 24 24"><path d="${path}"/></svg></button>`;

const TOOLS = [
  ["compare", "Before and after", "M4 5h16v14H4zM12 2v20"],
  ["out", "Zoom out", "M5 12h14"],
  ["in", "Zoom in", "M5 12h14M12 5v14"],
  ["full", "Full screen", "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5"],
  ["download", "Download the picture", "M12 4v11M7 11l5 5 5-5M5 20h14"],
  ["link", "Copy a link to this room", "M10 14l4-4M8 11l-3 3a3.5 3.5 0 0 0 5 5l3-3M16 13l3-3a3.5 3.5 0 0 0-5-5l-3 3"],
  ["panel", "Controls", "M4 7h9m4 0h3M4 17h3m4 0h9M15 4.5v5M9 14.5v5"],
].map((tool) => icon(...tool)).join("");

const slider = (name, text, low, high, step) => `<label class="slider"><span>${text}</span><input type="range" min="${low}" max="${high}" step="${step}" value="0" data-set="${name}"><output aria-hidden="true"></output></label>`;

export const LAMP_ROW = `<button><span></span><i aria-hidden="true"></i></button><button title="As rendered">↺</button>
${slider("gain", "Strength", -5, 5, 0.1)}${slider("mired", "Warmth", 100, 550, 5)}`;

export const BODY = `
<div class="room">
  <div class="stage" part="stage" tabindex="0" role="group" aria-label="Picture">
    <div class="view"><img alt="" hidden><canvas role="img" aria-label="The room"></canvas></div>
    <div class="line" hidden></div>
    <input class="split" type="range" min="0" max="100" step="1" value="50" aria-label="Before and after" hidden>
    <progress class="bar" max="1" value="0" aria-label="Loading"></progress>
    <div class="name" aria-hidden="true" hidden></div>
    <div class="message" hidden><span role="alert"></span>${icon("close", "Close the message", "M6 6l12 12M18 6L6 18")}</div>
    <div class="tools" role="group" aria-label="View">
${TOOLS}
    </div>
  </div>
  <div class="panel" part="panel">
    <h2 id="what">Surface</h2>
    <div class="row targets" role="group" aria-labelledby="what"></div>
    <div class="finish" hidden>
      <h2><span id="how">Finish</span><span class="chosen map" id="map"></span></h2>
      <div class="row finishes" role="radiogroup" aria-labelledby="how"></div>
      <button data-do="rendered" title="As rendered" aria-label="Finish: as rendered">↺</button>
      <label class="file">Map of finishes…<input type="file" accept="image/*" data-set="map" aria-describedby="map"></label>
      <button data-do="unmap" title="Remove the map" aria-label="Remove the map of finishes">×</button>
    </div>
    <h2><span id="with">Texture</span><span class="chosen"></span></h2>
    <div class="row swatches images" role="group" aria-labelledby="with"></div>
    <div class="row swatches colors" role="group" aria-label="Colours"><input type="color" value="#c8b9a6" data-set="color" title="Any colour" aria-label="Any colour"></div>
    <div class="row">
      <label class="file">Your photo…<input type="file" accept="image/*" multiple data-set="file"></label>
      <button data-do="original">Original</button>
    </div>
    <div class="placing">
      ${slider("size", "Size", -3, 3, 0.01)}${slider("rotate", "Turn", -180, 180, 1)}
      ${slider("right", "Shift right", -1, 1, 0.01)}${slider("up", "Shift up", -1, 1, 0.01)}
      <label class="slider"><span>Repeats</span><select data-set="repeat">${[...REPEATS, ...BONDS].map((x) => `<option value="${x}">${x[0].toUpperCase() + x.slice(1)}</option>`).join("")}</select></label>
      ${slider("grout", "Grout", 0, 0.2, 0.005)}${slider("saturation", "Saturation", 0, 2, 0.05)}${slider("lightness", "Lightness", -2, 2, 0.05)}
      <label class="slider"><span>Tint</span><input type="color" data-set="tint"></label>
    </div>
    <h2>Light</h2>
    <div class="lamps"></div>
    ${slider("exposure", "Brightness", -2, 2, 0.05)}${slider("warmth", "Warmth", -1, 1, 0.05)}
  </div>
  <div class="quiet" role="status" aria-live="polite"></div>
</div>`;
