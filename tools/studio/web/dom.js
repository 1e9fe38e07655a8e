/* Elements without a framework. */

/* An element: properties; `on…` are listeners, `class`, `aria-…`, `data-…`, `role`, `for` attributes; children are nodes
 * and texts, and lists of them; null and false are none. */
export function h(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === null || value === undefined) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (/^(class|role|for|list|form|aria-.*|data-.*|max|min|step)$/.test(name)) element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children.flat(Infinity).filter((c) => c !== null && c !== undefined && c !== false));
  return element;
}

const SVG = "http://www.w3.org/2000/svg";
export function icon(path) {
  const svg = document.createElementNS(SVG, "svg"), line = document.createElementNS(SVG, "path");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  line.setAttribute("d", path);
  svg.append(line);
  return svg;
}

export const ICONS = {
  open: "M3 7h6l2 2h10v10H3z", view: "M2 12s4-6 10-6 10 6 10 6-4 6-10 6S2 12 2 12zm10-2.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5z",
  surfaces: "M3 17l6-10h12l-6 10zM12 7l-6 10M9.6 12H18", light: "M9 18h6M10 21h4M12 3a6 6 0 0 0-3.5 10.9V16h7v-2.1A6 6 0 0 0 12 3z",
  render: "M4 5h16v12H4zM8 21h8M8 13l3-3 2 2 3-3", play: "M4 4h7v7H4zM13 4h7v7h-7zM4 13h7v7H4zM13 13h7v7h-7z",
  take: "M12 4v11M7 11l5 5 5-5M5 20h14", undo: "M9 7L4 12l5 5M4 12h10a6 6 0 0 1 6 6", redo: "M15 7l5 5-5 5M20 12H10a6 6 0 0 0-6 6",
  quit: "M12 4v8M7.5 7a7 7 0 1 0 9 0", help: "M9 9a3 3 0 1 1 4.5 2.6c-1 .6-1.5 1.2-1.5 2.4M12 17.5v.5", close: "M6 6l12 12M18 6L6 18", done: "M5 12l5 5 9-10",
  remove: "M5 7h14M10 7V4h4v3M7 7l1 13h8l1-13", smooth: "M5 19C9 5 15 19 19 5M5 5h.1M9 8h.1M6 11h.1M15 16h.1M18 13h.1M18 19h.1", pause: "M9 5v14M15 5v14", go: "M8 5l10 7-10 7z", picture: "M4 5h16v14H4zM4 16l5-5 4 4 3-3 4 4",
  folder: "M3 7h6l2 2h10v10H3z", file: "M6 3h8l4 4v14H6zM14 3v4h4", warn: "M12 4L2.5 20h19zM12 10v4M12 17v.5",
};

export const button = (text, onclick, properties = {}, path = "") =>
  h("button", { type: "button", onclick, ...properties }, path && icon(ICONS[path]), text && h("span", {}, text));
export const iconButton = (label, path, onclick, properties = {}) =>
  h("button", { type: "button", class: "icon", title: label, "aria-label": label, onclick, ...properties }, icon(ICONS[path]));

/* A text as a file of the browser. */
export function download(name, text) {
  const address = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

/* A label with its field; hint below. */
let fields = 0;
export function field(text, input, hint = "") {
  input.id ||= `field-${++fields}`;
  const about = hint && h("p", { class: "hint", id: `${input.id}-hint` }, hint);
  if (about) input.setAttribute("aria-describedby", about.id);
  return h("div", { class: "field" }, h("label", { for: input.id }, text), input, about);
}

/* A list to choose one of: [[value, text]]. */
export const choice = (id, options, value, onchange) =>
  h("select", { id, onchange: (e) => onchange(e.target.value) },
    options.map(([v, text]) => h("option", { value: v, selected: String(v) === String(value) }, text)));

/* A field of a number; what is none, or out of bounds, is put right and not passed on. */
export function numberField(id, value, least, most, onchange, step = 1) {
  return h("input", { id, type: "number", inputMode: "decimal", value: value ?? "", min: least, max: most, step,
    onchange: (e) => {
      const x = Number(e.target.value);
      if (e.target.value !== "" && x >= least && x <= most) onchange(x);
      else e.target.value = value ?? "";
    } });
}

export const check = (id, text, checked, onchange, properties = {}) =>
  h("label", { class: "check", for: id }, h("input", { id, type: "checkbox", checked, onchange: (e) => onchange(e.target.checked), ...properties }), h("span", {}, text));

/* Put new children in the place of others; what had the focus has it again, by its id. */
export function refill(parent, ...children) {
  const had = parent.contains(document.activeElement) ? document.activeElement : null;
  const scroll = parent.scrollTop;
  parent.replaceChildren(...children.flat(Infinity).filter(Boolean));
  parent.scrollTop = scroll;
  if (!had?.id) return;
  const again = parent.querySelector(`#${CSS.escape(had.id)}`);
  again?.focus({ preventScroll: true });
  if (again && had.value !== undefined && /^(text|search|number)$/.test(again.type) && again.type !== "number") {
    again.setSelectionRange(again.value.length, again.value.length);
  }
}
