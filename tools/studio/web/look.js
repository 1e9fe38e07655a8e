/* How a room looks, as the player's links have it: an edit of retex-edit(5), whose pictures are addresses below files/. */

const OPTIONS = ["scale", "rotate", "offset", "flip", "wrap", "repeat", "width", "colorspace", "finish", "normal", "grout",
  "groutcolor", "vary", "tiles", "at", "hue", "saturation", "gain", "gamma", "contrast", "blur", "invert", "tint", "colorize"];
const FILES = "files/";

const decoded = (part) => part.replace(/%(25|26|2e|3b)/gi, (_, code) => String.fromCharCode(parseInt(code, 16)));

/* A path of the project as an address of the page, and back. */
export const addressOf = (path) => FILES + path.split("/").map(encodeURIComponent).join("/");
export const pathOf = (address) =>
  (address.startsWith(FILES) ? address.slice(FILES.length).split("/").map(decodeURIComponent).join("/") : address);

/* { textures: [{ target, layer, source, options: [[word, value]] }], lamps, finishes, picture, warmth }, pictures as
 * paths. */
export function readLook(text) {
  const textures = new Map(), lamps = [], finishes = [], picture = [];
  let warmth = 0;
  for (const statement of text ? text.split(/[;&]/) : []) {
    const equals = statement.indexOf("=");
    if (equals < 1) continue;
    const key = statement.slice(0, equals), value = decoded(statement.slice(equals + 1));
    const [, kind, name] = /^(light|finish|picture):(.*)$/s.exec(key) || [];
    if (kind) ({ light: lamps, finish: finishes, picture })[kind].push([decoded(name), value]);
    else if (key === "warmth") warmth = Number(value) || 0;
    else {
      const word = OPTIONS.find((o) => key.endsWith(`.${o}`)), whole = decoded(word ? key.slice(0, -word.length - 1) : key);
      const [, number, below] = /^over([2-4]?):(.*)$/s.exec(whole) || [];
      const texture = textures.get(whole) || { target: below ?? whole, layer: below === undefined ? 0 : Number(number || 1), source: "", options: [] };
      textures.set(whole, texture);
      if (!word) texture.source = pathOf(value);
      else texture.options.push([word, ["finish", "normal", "tiles"].includes(word) ? value.split(",").map(pathOf).join() : value]);
    }
  }
  const order = (a, b) => (a.target < b.target ? -1 : a.target > b.target ? 1 : a.layer - b.layer);
  return { textures: [...textures.values()].filter((t) => t.source).sort(order), lamps, finishes, picture, warmth };
}

/* The options of one texture as --texture takes them, and as cells of tables do. */
export const optionText = ({ layer, options }) =>
  [...(layer ? ["over"] : []), ...options.map(([word, value]) => `${word}=${value}`)].map((o) => `:${o}`).join("");

/* The look as options of retex-combine. */
export function lookArgs(text) {
  const { textures, lamps, finishes, picture } = readLook(text);
  return [
    ...textures.flatMap((t) => [`--texture${optionText(t)}`, `${t.target}=${t.source}`]),
    ...lamps.flatMap(([name, value]) => ["--light", `${name}=${value}`]),
    ...finishes.flatMap(([name, value]) => ["--finish", `${name}=${value}`]),
    ...picture.flatMap(([key, value]) => (key === "auto-exposure" ? (value === "yes" ? ["--auto-exposure"] : []) : [`--${key}`, value])),
  ];
}

const escaped = (text) => text.replace(/[%;&]/g, (sign) => `%${sign.charCodeAt(0).toString(16)}`);

/* The look as a preset of retex-edit(5), for any folder: its pictures are those of this one. Warmth is the player's. */
export function presetOf(text, folder) {
  const absolute = (address) => (address.startsWith(FILES) ? pathOf(address).replace(/^(?!\/)/, `${folder}/`) : address);
  const statements = text.split(/[;&]/).filter((s) => s && !s.startsWith("warmth=")).map((statement) => {
    const equals = statement.indexOf("="), value = decoded(statement.slice(equals + 1));
    return `${statement.slice(0, equals)}=${escaped(value.includes(FILES) ? value.split(",").map(absolute).join() : value)}`;
  });
  return JSON.stringify({ "retex-preset": 1, edit: statements.join(";") }, null, 1);
}

/* The text of the player's link, out of its address. */
export function lookOfLink(link, key = "room") {
  const part = new URL(link).hash.slice(1).split("&").find((p) => p.startsWith(`${key}=`));
  return part ? decodeURIComponent(part.slice(key.length + 1)) : "";
}
