/* The player's view and state: what a place of the page shows, zoom, controls, links, and the order in which a room is
 * loaded. The page is replaced by the little of it that these functions use. */
import { resolveObjectURL } from "node:buffer";
import { deflateSync } from "node:zlib";
import { fails, near, random, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

/* An element of a page that has what is given, and takes everything else. */
const anything = (has = {}) => new Proxy(has, { get: (o, key) => (key in o ? o[key] : key === Symbol.toPrimitive ? undefined : () => {}) });

function element(RetexRoom, parts, has) {
  const made = Object.assign(Object.create(RetexRoom.prototype), has);
  made.$ = (selector) => (parts[selector] ||= anything({ style: anything(), classList: anything() }));
  return made;
}

test("zoom keeps the place under the pointer, from 1 to 12 times, and never shows what lies beyond", () => {
  const { RetexRoom } = player(), next = random(8), box = { left: 30, top: 20, width: 800, height: 600 };
  const view = { offsetLeft: 10, offsetTop: 50, offsetWidth: 780, offsetHeight: 500, style: {} };
  const room = element(RetexRoom, { ".stage": anything({ getBoundingClientRect: () => box, classList: anything() }), ".view": view },
    { zoom: { times: 1, x: 0, y: 0 }, moveLine: () => {} });
  const under = (x, y) => [(x - box.left - view.offsetLeft - room.zoom.x) / room.zoom.times, (y - box.top - view.offsetTop - room.zoom.y) / room.zoom.times];
  for (let k = 0; k < 200; k++) {
    const x = next(40, 820), y = next(70, 570), before = under(x, y), old = room.zoom.times, times = 2 ** (next(-100, 100) / 60);
    room.zoomBy(times, x, y);
    const { times: now, x: left, y: top } = room.zoom;
    near(now, Math.min(Math.max(old * times, 1), 12), 1e-9);
    if (left > 0 || top > 0 || left < 780 - 780 * now - 1e-9 || top < 500 - 500 * now - 1e-9) throw new Error(`beyond: ${left}, ${top}`);
    const free = left < 0 && top < 0 && left > 780 - 780 * now && top > 500 - 500 * now;
    if (free) near(under(x, y), before, 1e-6, "under the pointer");
    same(view.style.transform === "", now === 1);
  }
  room.panTo(0, 0, 1);
  room.zoomBy(2); // about the middle of the stage
  near(under(430, 320), [(430 - 40) / 1, (320 - 70) / 1], 1e-9);
});

test("a place of the page is the pixel there, and of its targets the one with most light, or the smaller one", () => {
  const { RetexRoom } = player(), heads = (list) => Uint32Array.from({ length: 12 }, (_, i) => 32 * 7 + (list.includes(i) ? 2 : 0));
  const targets = [{ share: 0.5 }, { share: 0.1 }, { share: 0.9 }], lights = [3, 3, 3];
  const room = element(RetexRoom, { canvas: { getBoundingClientRect: () => ({ left: 100, top: 50, width: 400, height: 300 }) } }, {
    room: { width: 4, height: 3, targets },
    renderer: { lightOf: (target) => lights[target], full: [{ target: 0, heads: heads([0, 1, 5]) }, { target: 1, heads: heads([5]) }, { target: 2, heads: heads([5, 11]) }, { target: 1 }] },
  });
  const at = (x, y) => room.targetAt(100 + 100 * x + 50, 50 + 100 * y + 50);
  same([at(0, 0), at(1, 0), at(2, 0), at(1, 1), at(3, 2)], [0, 0, -1, 1, 2]);
  lights[2] = 3.1; // it reflects the others
  same([at(1, 1), at(0, 0)], [2, 0]);
  same([room.targetAt(99, 100), room.targetAt(501, 100), room.targetAt(200, 49), room.targetAt(200, 350)], [-1, -1, -1, -1]);
  same([room.targetAt(100, 50), room.targetAt(499.9, 349.9)], [0, 2]);
});

test("controls: size is the inverse of scale in powers of two, and a pair keeps its proportions", () => {
  const { RetexRoom, plainTexture } = player(), asked = [];
  const room = element(RetexRoom, {}, { room: { targets: [{ name: "Floor" }] }, selected: 0, textures: [{ ...plainTexture(), scale: [2, 6], offset: [0.25, 0.5] }],
    place: (name, options) => asked.push([name, options]), setLight: (light) => asked.push(light) });
  for (const [set, value] of [["size", "1"], ["rotate", "45"], ["right", "0.1"], ["up", "-0.1"], ["exposure", "1.5"], ["warmth", "-1"]])
    room.setControl({ dataset: { set }, value });
  room.textures[0].scale = 3;
  room.setControl({ dataset: { set: "size" }, value: "-2" });
  same(asked, [["Floor", { scale: [0.5, 1.5] }], ["Floor", { rotate: 45 }], ["Floor", { offset: [0.1, 0.5] }], ["Floor", { offset: [0.25, -0.1] }],
    { exposure: 1.5 }, { warmth: -1 }, ["Floor", { scale: 4 }]]);
});

/* An element of three lamps: one of one colour, one that is off, one of several colours. */
function withLamps(RetexRoom, has = {}) {
  const parameters = [{ name: "Lamp", value: [1, 0.5, 2], kept: [1, 0.5, 2] }, { name: "Spot", value: [0, 0, 0], kept: [2, 2, 2] },
    { name: "sky", value: [1, 1, 1], kept: [1, 1, 1], several: true }];
  const events = [], room = element(RetexRoom, {}, { room: { parameters, lamps: {}, targets: [] }, colors: parameters.map((p) => p.value), said: [null, null, null],
    textures: [], light: {}, update: () => events.push("update"), draw: () => events.push("draw"), fail: (message) => message && events.push(message), say: (text) => events.push(text), ...has });
  return { room, events };
}

test("lamps are listed with their values and colours, and take others", async () => {
  const { RetexRoom } = player(), { room, events } = withLamps(RetexRoom);
  await room.setLight("Lamp", "3*rgb(1,1,1)");
  await room.setLight("SKY", "2");
  await room.setLight("Spot", 0.5);
  const luminance = 0.2126 + 0.5 * 0.7152 + 2 * 0.0722;
  same(room.lamps.map((l) => [l.name, l.value]), [["Lamp", "3*rgb(1,1,1)"], ["Spot", "0.5"], ["sky", "2"]]);
  near(room.lamps.map((l) => l.color), [Array(3).fill(3 * luminance), [1, 1, 1], [2, 2, 2]], 1e-12);
  room.lamps[0].color[0] = 7; // a copy
  same(events, ["update", "update", "update"]);
  for (const [wrong, message] of [["bleu", /expected numbers/], ["-1", /expected numbers/], ["1e29*1e2", /expected numbers/], ["50K", /kelvins/]])
    await fails(() => room.setLight("Lamp", wrong), message);
  await fails(() => room.setLight("lump", "1"), "The room has no 'lump'.");
  room.room.parameters[0].value = [1e20, 1e20, 1e20];
  await fails(() => room.setLight("Lamp", "1e30"), "The light of Lamp becomes too bright.");
  same(room.getState().lamps, { Lamp: "3*rgb(1,1,1)", Spot: "0.5", sky: "2" });
  await room.setLight("Spot", null);
  same(room.lamps[1], { name: "Spot", value: null, color: [0, 0, 0] });
  same(element(RetexRoom, {}, { room: {}, said: [], colors: [] }).lamps, []);
});

test("links have lamps, and a state names all others by a star", async () => {
  const { RetexRoom } = player({ location: { href: "https://x.org/p", hash: "" } }), { room } = withLamps(RetexRoom, { id: "" });
  await room.setState({ lamps: { "*": "0", lamp: "2*3000K", gone: "1" } });
  same(room.lamps.map((l) => l.value), ["2*rgb(1.754746,0.8492223,0.27115253)", "0", "0"]);
  same(new URL(room.link).hash, "#room=light:Lamp=2*rgb(1.754746,0.8492223,0.27115253);light:Spot=0;light:sky=0");
  await room.setState({});
  same(room.lamps.map((l) => l.value), [null, null, null]);
  same(new URL(room.link).hash, "#room=");
  await fails(() => room.setState({ lamps: { Lamp: "bleu" } }), /bleu/);
});

/* A floor with three finishes, a wall with two and a rug without, a lamp and light of none. */
function withFinishes(RetexRoom, has = {}) {
  const parameters = [], targets = [{ name: "Floor", finishes: ["matt", "Gloss", "a;b"], finish: 2 }, { name: "Rug" }, { name: "Wall", finishes: ["matt", "satin"], finish: 1 }];
  for (const lamp of ["Lamp", ""])
    for (const finishes of [[0, 0, 0], [1, 0, 1], [2, 0, 1], [3, 0, 1], [1, 0, 2], [2, 0, 2], [3, 0, 2]])
      parameters.push({ name: `${lamp}${finishes}`, lamp, finishes, value: [1, 1, 1], kept: [1, 1, 1] });
  const { room, events } = withLamps(RetexRoom, { id: "", room: { parameters, lamps: {}, targets }, said: [null], finishes: [2, 0, 1], setTexture: async () => {}, ...has });
  room.recolor();
  return { room, events, lit: () => room.colors.map((c, i) => c[0] && parameters[i].finishes.join("")).filter(Boolean) };
}

test("a finish is chosen by its name, and lamps go on as they are", async () => {
  const { RetexRoom } = player(), { room, events, lit } = withFinishes(RetexRoom);
  same([room.lamps, lit()], [[{ name: "Lamp", value: null, color: [1, 1, 1] }], ["000", "201", "000", "201"]]);
  await room.setFinish("Floor", "MATT");
  same([lit(), room.getState().finishes], [["000", "101", "000", "101"], { Floor: "matt" }]);
  await room.setFinish("Wall", "satin");
  await room.setLight("lamp", "0.25");
  same([lit(), room.getState().finishes], [["000", "102", "000", "102"], { Floor: "matt", Wall: "satin" }]);
  same([room.colors[0], room.colors[4], room.colors[7], room.colors[11]], [[0.25, 0.25, 0.25], [0.25, 0.25, 0.25], [1, 1, 1], [1, 1, 1]]);
  for (const [target, finish, message] of [["Floor", "gold", "Floor has no finish 'gold'."], ["Rug", "matt", "Rug has no finish 'matt'."], ["Roof", "matt", "The room has no 'Roof'."]])
    await fails(() => room.setFinish(target, finish), message);
  await room.setFinish("Rug");
  await room.setFinish("Floor", "Gloss"); // as rendered: nothing is said
  await room.setFinish("Wall", null);
  same([lit(), room.getState().finishes, room.lamps[0].value], [["000", "201", "000", "201"], {}, "0.25"]);
  same(events.filter((e) => e !== "update"), ["Floor: matt", "Wall: satin", "Rug: finish as rendered", "Floor: Gloss", "Wall: matt"]);
});

test("links have finishes; those that a room has not are left alone", async () => {
  const location = { href: "https://x.org/p", hash: "" }, { RetexRoom, parseEdit } = player({ location }), { room, lit } = withFinishes(RetexRoom, { renderer: {}, hasAttribute: () => false, loadLamps: () => {} });
  await room.setFinish("Floor", "a;b");
  await room.setFinish("Wall", "satin");
  same(new URL(room.link).hash, "#room=finish:Floor=a%253Bb;finish:Wall=satin");
  location.hash = new URL(room.link).hash;
  await room.setState({});
  same([lit(), new URL(room.link).hash], [["000", "201", "000", "201"], "#room="]);
  await room.restore();
  same([lit(), room.getState().finishes], [["000", "302", "000", "302"], { Floor: "a;b", Wall: "satin" }]);
  await room.setState(parseEdit("finish:floor=matt;finish:Wall=gold;finish:Rug=matt;finish:Roof=matt;light:Lamp=2"));
  same([lit(), room.getState().finishes, room.lamps[0].value], [["000", "101", "000", "101"], { Floor: "matt" }, "2"]);
});

test("the panel has the finishes of the target that it is for", async () => {
  const made = [], tag = () => ({ dataset: {}, append(...all) { Object.assign(this, { input: all[0], text: all[1] }); made.push(this); } });
  const { RetexRoom } = player({ document: { createElement: tag } }), { room } = withFinishes(RetexRoom, { renderer: {}, textures: [{}, {}, {}], selected: 0, loadLamps: () => {} });
  room.$(".finishes").dataset = {};
  room.$(".finishes").querySelectorAll = () => made.map((label) => label.input);
  room.$(".finishes").replaceChildren = (...labels) => made.splice(0, made.length, ...labels);
  const shown = () => (room.refreshFinishes(), [room.$(".finish").hidden, made.map((l) => (l.input.checked ? `*${l.text}` : l.text)), room.$("[data-do=rendered]").disabled]);
  same(shown(), [false, ["matt", "*Gloss", "a;b"], true]);
  same(made.map((label) => label.title), ["", "As rendered", ""]);
  await room.setControl({ dataset: { set: "finish" }, value: "a;b" });
  const [last] = made;
  same([shown(), made[0] === last], [[false, ["matt", "Gloss", "*a;b"], false], true]); // the one with the focus stays
  room.$(".finishes input:checked").focus = () => {};
  await room.command("rendered");
  same(shown(), [false, ["matt", "*Gloss", "a;b"], true]);
  room.selected = 2;
  same(shown(), [false, ["*matt", "satin"], true]);
  room.selected = 1;
  same(shown()[0], true);
  room.renderer = null;
  room.selected = 0;
  shown();
  same(made.map((l) => l.input.disabled), [true, true, true]);
});

test("a lamp's row: strength, warmth, off, and on again as it was", async () => {
  const { RetexRoom } = player(), { room, events } = withLamps(RetexRoom);
  room.$(".lamps").children = [{}, {}, {}];
  const control = (set, value, lamp = 0) => room.setControl({ dataset: { set }, value, closest: () => ({ dataset: { lamp: String(lamp) } }) });
  const values = () => room.lamps.map((l) => l.value);
  room.textures = [{}], room.selected = 0;
  await control("gain", "1");
  same(values(), ["2", null, null]);
  await control("mired", "370");
  same(values()[0], "2*rgb(1.9143814,0.8098837,0.19077155)");
  await room.switchLamp(0);
  same([values()[0].slice(0, 6), room.lamps[0].color], ["0*rgb(", [0, 0, 0]]);
  await room.switchLamp(0);
  same(values()[0].slice(0, 6), "2*rgb(");
  await room.setLight("Lamp", "2");
  await control("gain", "0"); // as rendered: nothing is said
  same(values(), [null, null, null]);
  await room.switchLamp(1); // off in the picture
  same([values()[1], room.lamps[1].color], ["1", [2, 2, 2]]);
  await room.switchLamp(1);
  same(values(), [null, null, null]);
  same(events.filter((e) => e.includes(":")), ["Lamp: off", "Lamp: on", "Spot: on", "Spot: off"]);
});

test("the light of lamps is loaded once, when one needs it, and again after it failed", async () => {
  const { RetexRoom } = player(), put = [], renderer = { lacksLamps: false, putLamps: (image) => { put.push(image); renderer.lampTiles = image; } };
  const { room, events } = withLamps(RetexRoom, { renderer });
  let asked = 0;
  room.room.parameters[1].value = [2, 2, 2];
  room.colors[1] = [2, 2, 2];
  room.getLamps = async () => { if (asked++ === 0) throw new Error("away"); return "image"; };
  await room.setLight("Lamp", "1"); // nothing that all light does not have
  same([asked, put], [0, []]);
  await fails(() => room.setLight("Lamp", "2"), "away");
  same(room.lamps[0].value, "2");
  await Promise.all([room.setLight("Lamp", "3"), room.setLight("sky", "0")]);
  await room.setLight("Lamp", "4");
  same([asked, put], [2, ["image"]]);
  same(events.filter((e) => e === "draw").length, 2);
  Object.assign(room, { lampsComing: null, renderer: { lacksLamps: true, putLamps: (image) => put.push(image) } });
  await room.setLight("Lamp", null);
  await room.setLight("sky", null);
  same(put, ["image", "image"]); // those of a picture in which a lamp is off
});

test("a room begins with its preset, unless the address has a state", async () => {
  const location = { hash: "", protocol: "https:", origin: "https://x.org", href: "https://x.org/shop/room.html" }, asked = [];
  const presets = { "https://x.org/shop/room/look.json": { "retex-preset": 1, edit: "Floor=a b/oak%253B-01abcdef.jpg;Floor.tiles=x.jpg,/y.jpg;over:Floor=https://y.org/z.png;Wall=tan;Wall.finish=m.png;light:Lamp=2" } };
  const fetch = async (url) => {
    asked.push(String(url));
    return presets[url] ? new Response(JSON.stringify(presets[url])) : new Response("", { status: 404 });
  };
  const { RetexRoom } = player({ location, document: { baseURI: location.href }, fetch });
  const put = [], failed = [], attributes = { preset: "room/look.json" }, room = element(RetexRoom, {}, { id: "", renderer: {}, abort: new AbortController(), textures: [],
    hasAttribute: (name) => name in attributes, getAttribute: (name) => attributes[name], setState: async (state) => put.push(state), fail: (message) => failed.push(message) });
  const begin = () => room.begin.call(Object.assign(room, { emit: () => {}, $: () => ({ classList: { add() {} } }) }));
  await begin();
  const [{ textures, lamps }] = put;
  same([textures.Floor.source, textures.Floor.tiles, textures["over:Floor"].source], ["room/a%20b/oak%253B-01abcdef.jpg", "room/x.jpg,https://x.org/y.jpg", "https://y.org/z.png"]);
  same([textures.Floor.label, textures["over:Floor"].label, textures.Wall.label], ["oak%3B.jpg", "z.png", undefined]);
  same([textures.Wall.source, textures.Wall.finish, { ...lamps }], ["tan", "room/m.png", { Lamp: "2" }]);
  location.hash = "#room=Floor=red";
  await begin();
  same([put.length, put[1].textures.Floor.source, asked.length], [2, "red", 1]);
  attributes["no-link"] = "";
  await begin();
  same([put.length, put[2].textures.Wall.source], [3, "tan"]);
  attributes.preset = "away.json";
  await begin();
  presets["https://x.org/shop/away.json"] = { "retex-preset": 2, edit: "" };
  await begin();
  same(failed, ["away.json, the room's look, could not be shown: away.json is missing (status 404).", "away.json, the room's look, could not be shown: it is no preset of version 1."]);
  delete attributes.preset;
  await begin();
  same(put.length, 3);
});

test("links have the state of this room beside others, and the state comes back", async () => {
  const location = { href: "https://x.org/p?q=1#room=%7B%7D&other%3D=1&part", hash: "" };
  const { RetexRoom, plainTexture } = player({ location });
  const room = element(RetexRoom, {}, { id: "a b=", room: { targets: [{ name: "Floor", uv_scale: [2, 3] }, { name: "Wall" }] },
    light: { exposure: 1, warmth: -0.5 }, said: [], colors: [], textures: [{ ...plainTexture(), source: "oak & ash.jpg", image: { width: 400, height: 200 }, scale: 2, rotate: 10, flip: "u" },
      { ...plainTexture(), image: 2 }] });
  const link = new URL(room.link), parts = link.hash.slice(1).split("&");
  same(parts.slice(0, 2), ["room=%7B%7D", "other%3D=1"]);
  same(parts.length, 3);
  if (!parts[2].startsWith("a%20b%3D=")) throw new Error(parts[2]);
  same(parts[2].slice("a%20b%3D=".length), "Floor=oak%20%2526%20ash.jpg;Floor.scale=2,6;Floor.rotate=10;Floor.flip=u;picture:exposure=1;warmth=-0.5");
  const colored = element(RetexRoom, {}, { id: "b", room: { targets: [{ name: "Sofa", uv_scale: [2, 3] }] }, light: {}, said: [], colors: [],
    textures: [{ ...plainTexture(), source: "tan", image: [1, 0, 0] }] });
  same(new URL(colored.link).hash.split("&").at(-1), "b=Sofa=tan"); // a colour has no proportions
  const state = room.getState();
  same(state, { textures: { Floor: { source: "oak & ash.jpg", scale: 2, rotate: 10, offset: [0, 0], flip: "u", wrap: "repeat", repeat: "straight" } },
    light: { exposure: 1, warmth: -0.5 }, lamps: {}, finishes: {} });
  const restored = [];
  Object.assign(room, { renderer: {}, hasAttribute: () => false, setState: async (all) => restored.push(all) });
  location.hash = link.hash;
  await room.restore();
  location.hash = `#${parts[2].split("=")[0]}=${encodeURIComponent(JSON.stringify(state))}`; // as links were once
  await room.restore();
  same(restored[0].textures.Floor, { source: "oak & ash.jpg", scale: [2, 6], rotate: 10, flip: "u" });
  same([restored[0].light, restored[1]], [state.light, state]);
  delete room.setState;
  const put = [];
  Object.assign(room, { setTexture: async (...all) => put.push(all), update: () => {}, light: {} });
  await room.setState(state);
  same(put, [["Floor", "oak & ash.jpg", (({ source, ...rest }) => rest)(state.textures.Floor)], ["Wall", null, {}]]);
  same(room.getState().light, { exposure: 1, warmth: -0.5 });
  room.setTexture = async (name) => { if (name === "Floor") throw new Error("away"); put.push(name); };
  await fails(() => room.setState({ light: { exposure: "x" } }), "away");
  same([room.getState().light, put.at(-1)], [{ exposure: 0, warmth: 0 }, "Wall"]); // the others are put all the same
  const light = { exposure: 0.5, warmth: 0, view: "Filmic", whiteBalance: 4000, autoExposure: true };
  room.setTexture = async () => {};
  await room.setState({ light: { ...light, view: "FILMIC" } });
  same(room.getState().light, light);
  same(new URL(room.link).hash.split("=").slice(1).join("=").replace(/^.*flip=u;/, ""), "picture:auto-exposure=yes;picture:exposure=0.5;picture:view=Filmic;picture:white-balance=4000");
  await fails(() => room.setState({ light: { exposure: 1, view: "Punchy" } }), "Pages have no view 'Punchy': expected Standard, Filmic, Neutral or Raw.");
  same(room.getState().light, { exposure: 1, warmth: 0 }); // and the others are put all the same
  for (const [key, value] of [["exposure", 31], ["exposure", "x"], ["whiteBalance", 999], ["autoExposure", 1], ["warmth", NaN]])
    await fails(() => room.setLight({ [key]: value }), `The light's ${key} cannot be ${JSON.stringify(value)}.`, key);
  await room.setLight({ view: "raw", exposure: null });
  same(room.getState().light, { exposure: 0, warmth: 0, view: "Raw" });
});

test("a white balance is Bradford's: its colour becomes white, and cones are scaled apart", () => {
  const { developMatrix, kelvinColor } = player(), of = (m, v) => m.map((row) => row.reduce((sum, x, k) => sum + x * v[k], 0)), times = (a, b) => a.map((row) => [0, 1, 2].map((j) => row.reduce((sum, x, k) => sum + x * b[k][j], 0)));
  const bradford = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];
  const xyz = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.072175], [0.0193339, 0.119192, 0.9503041]], cones = times(bradford, xyz);
  for (const whiteBalance of [2000, 3200, 6500, 15000]) {
    const flat = developMatrix({ exposure: 0, warmth: 0, whiteBalance }), matrix = [0, 3, 6].map((k) => flat.slice(k, k + 3)), lit = kelvinColor(whiteBalance);
    near(of(matrix, lit), [1, 1, 1], 1e-5, `${whiteBalance} K`);
    const scales = of(cones, [1, 1, 1]).map((x, k) => x / of(cones, lit)[k]);
    times(cones, matrix).forEach((row, k) => near(row, cones[k].map((x) => scales[k] * x), 1e-5, `${whiteBalance} K, cone ${k}`));
  }
  near(developMatrix({ exposure: 1, warmth: 0.5 }, -3), [0.25 * 2 ** 0.2, 0, 0, 0, 0.25, 0, 0, 0, 0.25 * 2 ** -0.2], 1e-12);
});

test("where a texture is clear, a pass with a map keeps the originals of other finishes black", () => {
  const { Renderer } = player(), targets = [{ products: ["a", "b"] }, { products: ["c", "d"] }, { products: ["e"] }, {}];
  const inPass = (mapped, pass, shown) => Renderer.prototype.inPass.call({ room: { targets } }, mapped, pass, shown);
  same(inPass([true, true, true, false], [1, 2, 0, 1], [1, 1, 1, 2]), { keeps: [1, 0, 1, 1], image0: "a", image1: "d" });
});

/* ---- textures that are made ---- */

/* A floor and a rug of unknown size, with what the renderer is given. */
function withTextures() {
  const { RetexRoom, plainTexture } = player(), made = [], overs = [];
  const targets = [{ name: "Floor", uv_scale: [2, 3], periodic: [0, 0], finishes: ["a", "b"], finish: 1, finish_roughness: [0.1, 0.5] }, { name: "Rug", uv_scale: [0, 0], periodic: [0, 0] }];
  const renderer = { most: 4096, putTexture: (index, image, how) => made.push([index, image?.name ?? image, how]), putOvers: (lists) => overs.push(lists.map((list) => list.map((o) => [o.image.name, ...o.adjust]))) };
  const room = element(RetexRoom, {}, { room: { targets }, renderer, finishes: [1, 0], said: [], colors: [], light: {}, textures: targets.map(() => ({ ...plainTexture(), put: {} })),
    update: () => {}, say: () => {}, fetchPicture: async (name) => { if (name.startsWith("gone")) throw new Error(`${name} is missing.`); return { name, width: 200, height: 100 }; } });
  return { room, made, overs };
}

test("layers lie on each other, move down when one is taken away, and come back from states", async () => {
  const { room, overs } = withTextures(), names = () => Object.entries(room.getState().textures).map(([key, { source }]) => `${key} ${source}`);
  await fails(() => room.setTexture("over2:Floor", "b.png"), "over2:Floor: there is no layer below it.");
  await room.setTexture("over:Floor", "a.png", { at: [1, 2], width: 0.5, hue: 20, gain: [1, 0.5, 1] });
  await room.setTexture("over2:Floor", "b.png", { flip: "u" });
  await room.setTexture("over3:Floor", "c.png");
  await room.setTexture("Floor", "wood.png");
  const state = room.getState();
  same(state.textures["over:Floor"], { source: "a.png", scale: 1, rotate: 0, offset: [0, 0], flip: "", width: 0.5, at: [1, 2], hue: 20, gain: [1, 0.5, 1] });
  await room.setTexture("over:Floor", "d.png");
  room.place("over2:Floor", { rotate: 30, saturation: 0 });
  await room.setTexture("over:Floor", null);
  same(names(), ["Floor wood.png", "over:Floor b.png", "over2:Floor c.png"]);
  same([room.textures[0].overs.map((o) => [o.flip, o.rotate, o.wrap]), overs.at(-1)], [[["u", 30, "black"], ["", 0, "black"]], [[["b.png", ["saturation", 0]], ["c.png"]], []]]);
  for (const [action, message] of [
    [() => room.setTexture("over:Floor", "tan"), "over:Floor must be an image, not a colour."],
    [() => room.setTexture("over:Floor", "e.png", { repeat: "brick" }), "over:Floor lies there once: it has no repeat."],
    [() => room.setTexture("over:Floor", "e.png", { grout: 0.1, width: 1 }), "over:Floor lies there once: it has no grout."],
    [() => room.setTexture("over:Rug", "e.png", { width: 1 }), "The size of over:Rug is not known: width cannot be used on it, only scale."],
    [() => room.setTexture("Floor", "e.png", { finish: "map.png" }), "Floor: finish cannot be used below layers."],
    [async () => room.place("over3:Floor", {}), "There is no over3:Floor."], [() => room.setTexture("over:Roof", "e.png"), "The room has no 'Roof'."]]) {
    const before = room.getState();
    await fails(action, message);
    same(room.getState(), before, message);
  }
  await room.setState(state);
  same(room.getState().textures, state.textures);
  await fails(() => room.setState({ textures: { "over:Floor": { source: "gone.png" }, "over2:Floor": { source: "b.png" }, Rug: { source: "tan" } } }), "gone.png is missing.");
  same(names(), ["over:Floor b.png", "Rug tan"]);
  room.selected = 0;
  await room.command("original");
  same(names(), ["Rug tan"]);
});

test("a texture is made again when its texels change, and not when it is placed", async () => {
  const { room, made, overs } = withTextures(), count = async (action) => { const before = [made.length, overs.length]; await action(); return [made.length - before[0], overs.length - before[1]]; };
  same(await count(() => room.setTexture("Floor", "wood.png", { tiles: ["x.png", "y.png"], vary: "turn" })), [1, 0]);
  same([made.at(-1)[2].tiles.map((t) => t.name), made.at(-1)[2].layout.blocks.length > 100], [["x.png", "y.png"], true]);
  for (const options of [{ rotate: 20 }, { scale: 3 }, { offset: [1, 2] }, { flip: "u" }, { at: [1, 1] }]) same(await count(() => room.place("Floor", options)), [0, 0], JSON.stringify(options));
  for (const options of [{ saturation: 0.5 }, { vary: "turn,3" }, { width: 0.5 }, { grout: 0.1 }, { groutcolor: "red" }, { repeat: "brick" }, { blur: 0.1 }]) same(await count(() => room.place("Floor", options)), [1, 0], JSON.stringify(options));
  same(made.at(-1)[2].adjust, [["saturation", 0.5], ["blur", 0.1]]);
  same(await count(() => room.setTexture("over:Floor", "logo.png")), [0, 1]);
  same(await count(() => room.place("over:Floor", { at: [0, 1], rotate: 5 })), [0, 0]);
  same(await count(() => room.place("over:Floor", { invert: true })), [0, 1]);
  const before = room.getState();
  for (const options of [{ grout: 3 }, { repeat: "herringbone", width: [300, 0.5] }, { wrap: "clamp" }, { width: null }]) {
    same(await count(() => fails(async () => room.place("Floor", options), /./)), [0, 0], JSON.stringify(options));
    same(room.getState(), before);
  }
  await fails(() => room.setTexture("Floor", "wood.png", { tiles: "x.png", finish: "map.png" }), "finish cannot be used with tiles, which have no map of their own.");
  await fails(() => room.setTexture("Floor", "wood.png", { tiles: "x.png,gone.png" }), "gone.png is missing.");
  same(room.getState(), before);
});

test("lengths with units are those of scene units", async () => {
  const { room, made } = withTextures(), lies = () => room.settings()[0].turn.map((x) => Math.round(1e9 * x) / 1e9 + 0);
  room.room.unit = 0.01; // a scene unit is a centimetre
  await room.setTexture("Floor", "wood.png", { width: "50mm,1 in", grout: "5mm", at: "1m,2m" });
  const [layout, turn] = [made.at(-1)[2].layout, lies()], { width, grout, at } = room.getState().textures.Floor;
  same([width, grout, at], ["0.05m,0.0254m", "0.005m", "1m,2m"]);
  room.place("Floor", { width: [5, 2.54], grout: 0.5, at: [100, 200] });
  same([made.at(-1)[2].layout, lies()], [layout, turn]);
  for (const [options, message] of [[{ grout: "5mm" }, "A texture's lengths all have a unit, or none has."], [{ width: null, grout: null, at: "1m,2m" }, "A texture's at with lengths needs width."]])
    await fails(async () => room.place("Floor", options), message);
});

test("grout needs a width, which the control measures", async () => {
  const { room } = withTextures(), control = (set, value) => room.setControl({ dataset: { set }, value });
  Object.assign(room, { selected: 0, fail: () => {} });
  await room.setTexture("Floor", "wood.png", { scale: [4, -6] });
  await control("grout", "0.1");
  const { width, scale, grout } = room.getState().textures.Floor;
  same([width, scale, grout], [[0.5, 0.5], [1, -1], 0.05]);
  await control("lightness", "1");
  await control("saturation", "0.5");
  await control("tint", "#ff0000");
  await control("lightness", "0");
  await control("repeat", "basket");
  const { repeat, ...others } = room.getState().textures.Floor;
  same([repeat, Object.entries(others).slice(-2)], ["basket", [["saturation", 0.5], ["tint", "#ff0000"]]]);
});

/* ---- loading ---- */

const FILES = { // bytes of images are their width and height here
  "picture.jpg": [20, 10], "indep.jpg": [20, 10], "floor.jpg": [20, 10], "wall.jpg": [20, 10], "reduced.jpg": [16, 5],
  "floor.z": deflateSync(Buffer.from([...Array(10).fill([255, 255, 15]).flat(), 0, 0, 0, 0])),
  "wall.z": deflateSync(Buffer.from([...Array(10).fill([255, 255, 15]).flat(), 0, 0, 0, 0])),
  "between.z": deflateSync(Buffer.from([...Array(5).fill([255, 3]).flat(), 0, 0, 0, 0, 0, 0, 0])),
};

function manifest(crc32) {
  const file = (name) => ({ file: name, bytes: FILES[name].length, crc32: crc32(Uint8Array.from(FILES[name])) });
  const target = (name, share) => ({ name, share, uv_min: [0, 0], uv_max: [1, 1], uv_scale: [1, 1], periodic: [0, 0] });
  const light = (name, of) => ({ ...file(name), white: 1, levels: 255, target: of });
  const footprints = (weights) => [{ first: 0.1, per_octave: 4, sigma_first: 0, angle_steps: 60, weights }];
  const full = (name, of, albedo) => ({ ...file(name), kind: "sharp", target: of, scale: 1, width: 20, height: 10, albedo, spreads: 2, records: 200, footprints: footprints(["one", null]) });
  return {
    retex_web: 1, width: 20, height: 10, filter: "box", finest: 2, picture: file("picture.jpg"),
    targets: [target("Wall", 0.2), target("Floor", 0.5)],
    lights: [light("indep.jpg", -1), light("wall.jpg", 0), light("floor.jpg", 1)],
    reduced: { ...file("reduced.jpg"), tiles: [{ x: 0, y: 0, width: 10, height: 5, scale: 2, white: 1, levels: 255 }] },
    classes: [full("wall.z", 0, 1), full("floor.z", 1, 2),
      { ...file("between.z"), kind: "interreflection", target: 0, scale: 2, width: 10, height: 5, albedo: 0, spreads: 3, records: 50, footprints: footprints([0.25, 0.5]) }],
    mixtures: [[[0, 0]], [[1, 0]], [[2, 0]]],
    groups: [{ light: 0, mixture: -1, target: -1 }, { light: 1, mixture: 0, target: 0 }, { light: 2, mixture: 1, target: 1 }],
    terms: [{ group: 0, gain: -1, factors: [] }, { group: 1, gain: 0, factors: [2] }, { group: 2, gain: -1, factors: [] }],
  };
}

/* Loads a room whose files are FILES with changes; returns what happened. */
async function load(changes = {}, change = (room) => room, hash = "") {
  const files = { ...FILES, ...changes }, log = [], puts = [];
  class WebGLTexture {}
  const gl = anything({ getParameter: () => 4096, getExtension: () => ({}), getShaderParameter: () => true, getError: () => 0,
    getProgramParameter: (_, what) => (what === "count" ? 0 : true), ACTIVE_UNIFORMS: "count", createTexture: () => new WebGLTexture(),
    texSubImage2D: (...all) => all.length === 9 && puts.push(["records", all[3]]), OUT_OF_MEMORY: 1 });
  class Image {
    async decode() {
      const [width, height] = new Uint8Array(await resolveObjectURL(this.src).arrayBuffer());
      Object.assign(this, { naturalWidth: width, naturalHeight: height });
    }
  }
  const world = {
    Image, WebGLTexture, devicePixelRatio: 1, performance: { now: () => 0 }, cancelAnimationFrame: () => {}, requestAnimationFrame: () => 1, location: { protocol: "https:", hash },
    document: { baseURI: "https://x.org/" }, setTimeout: (action) => action(),
    fetch: async (url) => {
      const name = String(url).replace("https://x.org/rooms/one/", "");
      if (!log.includes(`fetch ${name}`)) log.push(`fetch ${name}`);
      const room = name === "room.json" && (changes[name] ?? Buffer.from(JSON.stringify(change(manifest(made.crc32), made.crc32))));
      return { ok: true, arrayBuffer: async () => Uint8Array.from(room || files[name]).buffer };
    },
  };
  const made = player(world);
  const stage = anything({ getBoundingClientRect: () => ({ width: 20, height: 10 }) });
  const room = element(made.RetexRoom, { canvas: anything({ getContext: () => gl, classList: anything() }), ".stage": stage }, {
    textures: [], light: { exposure: 0, warmth: 0 }, zoom: { times: 1 }, selected: 0, id: "",
    getAttribute: () => "rooms/one", hasAttribute: () => false, refresh: () => {}, say: () => {},
    emit: (name) => name !== "retex-draw" && log.push(name), fail: (message) => message && log.push(`failed: ${message}`),
  });
  await room.load();
  await room.whenComplete;
  return { room, log, puts };
}

test("a room is loaded: its picture, then the target that shows most, then the others, then the other light", async () => {
  const { room, log, puts } = await load();
  same(log, ["fetch room.json", "fetch picture.jpg", "retex-still", "fetch reduced.jpg", "fetch between.z", "fetch floor.z", "fetch floor.jpg", "retex-ready",
    "fetch wall.z", "fetch wall.jpg", "fetch indep.jpg", "retex-complete"]);
  same([room.targets, room.selected, room.renderer.complete], [["Wall", "Floor"], 1, true]);
  // each class has its rows of the records after those of the classes before it
  same(room.room.classes.map((c) => [c.base, c.layer]), [[0, 0], [2048, 1], [4096, 0]]);
  // the first two are unpacked at the same time
  same([puts.slice(0, 2).sort(), puts.slice(2)], [[["records", 1], ["records", 2]], [["records", 0]]]);
  same(room.textures.map((t) => t.label), ["Original", "Original"]);
});

test("the light of lamps comes when one is changed; with what is needed first, where one is off in the picture; and by links", async () => {
  FILES["lamps.jpg"] = [10, 5];
  const lit = (value) => (room, crc32) => ({ ...room, parameters: [{ name: "Lamp", value, kept: [1, 1, 1] }],
    lamps: { file: "lamps.jpg", bytes: 2, crc32: crc32(Uint8Array.from(FILES["lamps.jpg"])), width: 10, height: 5, finest: 2,
      tiles: [{ x: 0, y: 0, width: 10, height: 5, scale: 2, white: 1, levels: 255 }], terms: [{ group: 0, gain: 0, parameter: 0, factors: [] }] } });
  const late = await load({}, lit([1, 1, 1]));
  same([late.log.includes("fetch lamps.jpg"), late.log.at(-1), late.room.renderer.complete], [false, "retex-complete", true]);
  await late.room.setLight("Lamp", "2");
  same([late.log.at(-1), !!late.room.renderer.lampTiles], ["fetch lamps.jpg", true]);
  const off = (await load({}, lit([0, 0, 0]))).log;
  same(off.slice(3, 5), ["fetch lamps.jpg", "fetch reduced.jpg"]);
  const linked = (await load({}, lit([1, 1, 1]), "#room=light:Lamp=3")).log;
  const needed = linked.filter((text) => !text.startsWith("retex-change"));
  same(needed.slice(8, 10), ["fetch lamps.jpg", "fetch wall.z"]);
  for (const [file, size] of [["lamps.jpg", [10, 6]], ["lamps.jpg", [10]]])
    same((await load({ [file]: size }, lit([0, 0, 0]))).log.at(-1), "failed: lamps.jpg is damaged.");
});

test("the light of finishes is needed for the picture as rendered, and a link chooses one", async () => {
  const shiny = (room, crc32) => ({ ...room, targets: room.targets.map((t, i) => (i ? { ...t, finishes: ["matt", "satin"], finish: 1 } : t)),
    parameters: [[0, 0], [0, 1], [0, 2]].map((finishes, i) => ({ name: `${i}`, lamp: "", finishes, value: Array(3).fill(i < 2 ? 1 : 0), kept: Array(3).fill(i ? 0.5 : 1) })),
    lamps: { file: "lamps.jpg", bytes: 2, crc32: crc32(Uint8Array.from(FILES["lamps.jpg"])), width: 10, height: 5, finest: 2,
      tiles: [{ x: 0, y: 0, width: 10, height: 5, scale: 2, white: 1, levels: 255 }], terms: [{ group: 0, gain: 0, parameter: 2, factors: [] }] } });
  const { room, log } = await load({}, shiny, "#room=finish:Floor=satin");
  same([log.slice(3, 5), log.at(-1)], [["fetch lamps.jpg", "fetch reduced.jpg"], "retex-complete"]);
  same([room.colors, room.renderer.rendered, room.lamps], [[[1, 1, 1], [0, 0, 0], [1, 1, 1]], [[1, 1, 1], [1, 1, 1], [0, 0, 0]], []]);
});

test("a target can be changed once all that its light needs is there", async () => {
  const { room } = await load(), { renderer } = room, [wall, floor, between] = room.room.classes;
  same([0, 1].map((t) => renderer.canEdit(t)), [true, true]);
  renderer.loaded.delete(wall);
  same([0, 1].map((t) => renderer.canEdit(t)), [false, true]);
  renderer.loaded.add(wall).delete(between); // a factor of the wall's term
  same([0, 1].map((t) => renderer.canEdit(t)), [false, true]);
  renderer.loaded.add(between);
  renderer.lights.delete(2); // the albedo of the floor's footprints, and its light
  same([0, 1, renderer.complete].map((t) => (t === false ? t : renderer.canEdit(t))), [true, false, false]);
  renderer.lights.add(2);
  floor.records = 0;
  same([renderer.isSeen(1), renderer.canEdit(1)], [false, false]);
});

test("damaged rooms are told", async () => {
  const told = async (changes) => (await load(changes)).log.filter((text) => text.startsWith("failed"));
  same(await told({ "room.json": Buffer.from("{") }), ["failed: room.json is damaged."]);
  same(await told({ "room.json": Buffer.from('{"retex_web": 1}') }), ["failed: room.json is damaged."]);
  same(await told({ "picture.jpg": [20, 11] }), ["failed: picture.jpg is damaged."]);
  same(await told({ "floor.z": [1, 2, 3] }), ["failed: floor.z is damaged."]);
  same(await told({ "wall.jpg": [10, 20] }), ["failed: wall.jpg is damaged."]);
});
