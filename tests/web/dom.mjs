/* The player's element in a page without a browser: jsdom, which has the elements, their selectors, events and focus, but
 * lays nothing out. Where things lie is given; the renderer keeps what it is asked to draw. */
import Module, { createRequire } from "node:module";
import { player } from "./player.mjs";

process.env.NODE_PATH = "/usr/share/nodejs"; // where Debian's packages lie, which other builds of Node do not know
Module._initPaths();
const { JSDOM } = createRequire(import.meta.url)("jsdom");

export const STAGE = { left: 30, top: 20, width: 800, height: 600, bottom: 620 }, CANVAS = { left: 40, top: 70, width: 780, height: 500 };
const lying = (element, box) => (element.getBoundingClientRect = () => box);

/* An element of a room that is loaded: what tools write of it, and `given` in place of what the browser gives. Its pixels are
 * 78 by 50, ten of the page's each; `seen` has the target of a pixel, -1 for none. */
export function page(room, { seen = () => 0, canEdit = () => true, given = {} } = {}) {
  const { window } = new JSDOM("<body></body>", { url: "https://x.org/p#other=1", pretendToBeVisual: true });
  const { document } = window, { finishesAsRendered, plainTexture } = player({
    globalThis: window, document, location: window.location, history: window.history, customElements: window.customElements, CustomEvent: window.CustomEvent, Blob: window.Blob,
    addEventListener: window.addEventListener.bind(window), removeEventListener: window.removeEventListener.bind(window), devicePixelRatio: 1,
    requestAnimationFrame: window.requestAnimationFrame.bind(window), cancelAnimationFrame: window.cancelAnimationFrame.bind(window),
    ResizeObserver: class { observe() {} }, ...given,
  });
  const element = document.createElement("retex-room"), $ = element.$, drawn = [], view = $(".view");
  lying($(".stage"), STAGE);
  lying($("canvas"), CANVAS);
  for (const [key, value] of Object.entries({ offsetLeft: 10, offsetTop: 50, offsetWidth: 780, offsetHeight: 500 })) Object.defineProperty(view, key, { value });
  const full = room.targets.map((_, target) => ({ target, heads: Uint32Array.from({ length: 78 * 50 }, (_, i) => (seen(i % 78, Math.floor(i / 78)) === target ? 1 : 0)) }));
  document.body.append(element);
  Object.assign(element, {
    room: { width: 78, height: 50, ...room }, said: (room.parameters || []).map(() => null), finishes: finishesAsRendered(room),
    textures: room.targets.map(() => ({ ...plainTexture(), put: {} })),
    renderer: { most: 4096, full, canEdit, isSeen: (t) => full[t].heads.some(Boolean), lampTiles: [], putTexture: () => {}, putOvers: () => {},
      render: (settings, split, light, colors) => drawn.push({ settings, split, light: { ...light }, colors }) },
  });
  element.recolor();
  element.refresh();
  /* An event of the user's, at a place of the page. Returns whether the page would do nothing else with it. */
  const send = (to, type, has = {}) => {
    const event = new window.MouseEvent(type, { bubbles: true, composed: true, cancelable: true, ...has });
    for (const [key, value] of Object.entries(has)) if (event[key] !== value) Object.defineProperty(event, key, { value });
    return !(typeof to === "string" ? $(to) : to).dispatchEvent(event);
  };
  return { window, element, $, $$: (selector) => [...element.shadowRoot.querySelectorAll(selector)], drawn, send };
}
