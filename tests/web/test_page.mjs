/* What the player's page does with pointers, keys, dropped files and its controls, and what these show. */
import { near, same, test } from "./tap.mjs";
import { CANVAS, STAGE, page } from "./dom.mjs";

const targets = [{ name: "Floor", share: 0.5, uv_scale: [2, 3], periodic: [0, 0] }, { name: "Rug", share: 0.1, uv_scale: [0, 0], periodic: [0, 0] },
  { name: "Hidden", share: 0, uv_scale: [1, 1], periodic: [0, 0] }];
const parameters = [{ name: "Lamp", value: [1, 0.5, 2], kept: [1, 0.5, 2] }, { name: "Spot", value: [0, 0, 0], kept: [2, 2, 2] }];

/* The left half is floor, then rug, then a part without a target. */
const room = (has = {}) => page({ targets, parameters }, { seen: (x) => (x < 39 ? 0 : x < 60 ? 1 : -1), ...has });
const FLOOR = { clientX: 140, clientY: 300 }, RUG = { clientX: 500, clientY: 300 }, NONE = { clientX: 700, clientY: 300 };
const moved = ({ clientX, clientY }, x, y = 0) => ({ clientX: clientX + x, clientY: clientY + y });

test("the target below the mouse is named, and chosen by a press that does not move", () => {
  const { element, $, send } = room({ canEdit: (t) => t !== 1 }), name = () => ($(".name").hidden ? null : $(".name").textContent), selected = [];
  element.addEventListener("retex-select", ({ detail }) => selected.push(detail.target));
  for (const [at, expected] of [[FLOOR, "Floor"], [RUG, "Rug"], [NONE, null], [FLOOR, "Floor"]]) {
    send("canvas", "pointermove", { ...at, pointerType: "mouse" });
    same(name(), expected);
  }
  send("canvas", "pointermove", { ...RUG, pointerType: "touch" }); // a finger that is not down
  same(name(), "Floor");
  send(".stage", "pointerleave");
  same(name(), null);
  send("[data-do=in]", "pointermove", { ...FLOOR, pointerType: "mouse" }); // a button is not the picture
  same(name(), null);
  const press = (at, by, end = "pointerup", on = "canvas") => {
    const before = selected.length;
    send(on, "pointerdown", { ...at, pointerId: 1 });
    if (by) send("canvas", "pointermove", { ...moved(at, by), pointerId: 1 });
    send("canvas", end, { ...moved(at, by), pointerId: 1 });
    return selected.slice(before);
  };
  same([press(FLOOR, 0), press(FLOOR, 6), press(FLOOR, -6)], [["Floor"], ["Floor"], ["Floor"]]);
  same([press(FLOOR, 7), press(RUG, 0), press(NONE, 0), press(FLOOR, 0, "pointercancel"), press(FLOOR, 0, "pointerup", "[data-do=in]")], [[], [], [], [], []]);
  press(FLOOR, 0);
  same([name(), $("[role=status]").textContent, element.zoom.times], ["Floor", "Floor", 1]);
});

test("a picture that is larger than the stage is dragged, from the seventh pixel on", () => {
  const { element, $, send } = room(), captured = [], stage = $(".stage");
  Object.assign(stage, { hasPointerCapture: (id) => captured.includes(id), setPointerCapture: (id) => captured.push(id) });
  const drag = (...steps) => {
    send("canvas", "pointerdown", { ...FLOOR, pointerId: 7 });
    steps.forEach(([x, y]) => send("canvas", "pointermove", { ...moved(FLOOR, x, y), pointerId: 7 }));
    send("canvas", "pointerup", { ...moved(FLOOR, ...steps.at(-1)), pointerId: 7 });
  };
  drag([30, 30]);
  same([element.zoom, captured], [{ times: 1, x: 0, y: 0 }, []]);
  element.panTo(-300, -200, 2);
  drag([3, -2], [4, 3], [14, -5], [10, -17]); // 5 pixels, 6 more: from here on it follows
  same([element.zoom, captured], [{ times: 2, x: -300 + 10 - 3, y: -200 - 17 + 2 }, [7]]);
  drag([3, 3]);
  same(element.zoom, { times: 2, x: -293, y: -215 });
});

test("two fingers zoom about their middle by what their distance grows, and choose nothing", () => {
  const { element, send } = room(), selected = [];
  element.addEventListener("retex-select", ({ detail }) => selected.push(detail.target));
  const finger = (type, pointerId, clientX, clientY) => send("canvas", type, { pointerId, clientX, clientY, pointerType: "touch" });
  finger("pointerdown", 1, 300, 300);
  finger("pointerdown", 2, 400, 300);
  finger("pointermove", 2, 400, 300);
  same(element.zoom.times, 1);
  const middle = () => [(425 - STAGE.left - 10 - element.zoom.x) / element.zoom.times, (300 - STAGE.top - 50 - element.zoom.y) / element.zoom.times], before = middle();
  finger("pointermove", 2, 550, 300); // from 100 to 250 pixels
  near(element.zoom.times, 2.5, 1e-9);
  near(middle(), before, 1e-9);
  finger("pointermove", 1, 550, 300); // on one place, and apart again
  finger("pointermove", 1, 550, 425);
  finger("pointermove", 1, 550, 362.5);
  near(element.zoom.times, 1, 1e-9);
  finger("pointerup", 2, 550, 300);
  finger("pointerup", 1, 550, 300);
  same(selected, []);
  finger("pointerdown", 1, 300, 300);
  finger("pointerdown", 2, 310, 300); // another pinch begins with its own distance
  finger("pointermove", 2, 340, 300);
  same(element.zoom.times, 1);
});

test("the wheel, a double click and keys zoom and move", () => {
  const { element, $, send } = room(), wheel = (deltaY, ctrlKey = false) => send("canvas", "wheel", { deltaY, ctrlKey, ...FLOOR }), key = (name, to = ".stage") => send(to, "keydown", { key: name });
  same([wheel(100), element.zoom.times], [false, 1]); // the page scrolls
  same([wheel(100, true), element.zoom.times], [true, 1]);
  same([wheel(-300), element.zoom.times], [true, 2]);
  same([wheel(150), +element.zoom.times.toFixed(9)], [true, +Math.SQRT2.toFixed(9)]);
  element.panTo(0, 0, 1);
  send("canvas", "dblclick", FLOOR);
  near([element.zoom.times, (140 - 40 - element.zoom.x) / 2.5], [2.5, 100], 1e-9);
  send("[data-do=in]", "dblclick", FLOOR);
  near(element.zoom.times, 2.5, 1e-9);
  send("canvas", "dblclick", FLOOR);
  same(element.zoom, { times: 1, x: 0, y: 0 });
  element.panTo(-300, -200, 2);
  for (const [name, x, y] of [["ArrowLeft", -240, -200], ["ArrowRight", -300, -200], ["ArrowUp", -300, -140], ["ArrowDown", -300, -200]])
    same([key(name), element.zoom.x, element.zoom.y], [true, x, y], name);
  same([key("x"), key("ArrowLeft", "[data-do=in]"), key("+", ".split"), element.zoom.x, element.zoom.times], [false, false, false, -300, 2]);
  for (const [name, times] of [["+", 3], ["=", 4.5], ["-", 3], ["0", 1]]) {
    same(key(name), true);
    near(element.zoom.times, times, 1e-9, name);
  }
  same($(".view").style.transform, "");
});

test("buttons do what they say", async () => {
  const { element, $, send, drawn, window } = room(), press = (name) => send(`[data-do=${name}] path`, "click");
  press("in");
  near(element.zoom.times, 1.5, 1e-9);
  press("out");
  near(element.zoom.times, 1, 1e-9);
  same([$("[data-do=full]").hidden, $(".split").hidden, $(".line").hidden], [true, true, true]); // jsdom has no full screen
  press("compare");
  same([$(".split").hidden, $(".line").hidden, $("[data-do=compare]").getAttribute("aria-pressed"), element.shadowRoot.activeElement], [false, false, "true", $(".split")]);
  $(".split").value = 25;
  send(".split", "input");
  same([$(".line").style.left, $(".line").style.top, $(".line").style.height], [`${CANVAS.left - STAGE.left + CANVAS.width / 4}px`, "50px", "500px"]);
  element.draw(true);
  same(drawn.at(-1).split, 78 / 4);
  press("compare");
  element.draw(true);
  same([$(".split").hidden, drawn.at(-1).split], [true, 0]);
  press("panel");
  same([$(".panel").hidden, $(".room").classList.contains("wide"), $("[data-do=panel]").getAttribute("aria-expanded")], [true, true, "false"]);
  press("panel");
  same([$(".panel").hidden, $(".room").classList.contains("wide"), $("[data-do=panel]").getAttribute("aria-expanded")], [false, false, "true"]);
  element.fail("A message.");
  same([$(".message").hidden, $("[role=alert]").textContent], [false, "A message."]);
  press("close");
  same($(".message").hidden, true);
  await element.setLight({ exposure: 1 });
  await element.command("link"); // jsdom has no clipboard
  same([window.location.hash, $("[role=status]").textContent], ["#other=1&room=picture:exposure=1", "The link is in the address bar."]);
  element.id = "hall/2";
  same(new URL(element.link).hash, "#other=1&room=picture:exposure=1&hall%2F2=picture:exposure=1");
});

test("another address is another state, as long as the element is in the page", async () => {
  const { element, window } = room(), visit = async (hash) => {
    window.location.hash = hash;
    await new Promise((done) => setTimeout(done, 30));
    return element.textures.map((t) => t.source);
  };
  same(await visit("#room=Rug=tan"), [null, "tan", null]);
  same(await visit("#hall=Rug=red"), [null, "tan", null]);
  same(await visit("#room=Floor=red"), ["red", null, null]);
  element.remove();
  same(await visit("#room=Rug=tan"), ["red", null, null]);
});

test("of two pictures the one that was chosen last stays, whichever comes first", async () => {
  const { element } = room(), coming = {};
  element.fetchPicture = (name) => new Promise((done) => (coming[name] = () => done({ name, width: 4, height: 4 })));
  const both = ["slow.png", "quick.png"].map((name) => element.setTexture("Floor", name));
  coming["quick.png"]();
  await both[1];
  coming["slow.png"]();
  await both[0];
  same(element.textures[0].source, "quick.png");
});

test("the smallest room that has the screen's pixels is loaded, and a larger one with its textures once they are seen", async () => {
  const { element } = room(), loads = [], rooms = [200, 400, 800, 1600].map((width) => ({ width, height: width / 2 })), picked = () => element.pickRoom().width;
  element.setRooms({ ...rooms[3], smaller: [rooms[2], rooms[0], rooms[1]] });
  const at = (box, times) => (element.$(".stage").getBoundingClientRect = () => box, (element.zoom.times = times), picked());
  same([at(STAGE, 1), at(STAGE, 1.04), at(STAGE, 1.06), at(STAGE, 9), at({ ...STAGE, width: 100 }, 1)], [800, 800, 1600, 1600, 200]);
  same([at({ ...STAGE, height: 100 }, 1), at({ ...STAGE, height: 106 }, 1)], [200, 400]); // its height decides
  element.largest = 400;
  same(at(STAGE, 9), 400);
  Object.assign(element, { largest: undefined, room: { ...element.room, width: 200 }, isComplete: true });
  element.load = (kept, instead) => (loads.push([kept, element.largest]), instead);
  at(STAGE, 1);
  element.grow();
  same(loads, []);
  await new Promise((done) => setTimeout(done, 350));
  same(loads, [[element.textures, undefined]]);
  element.loadLarger()(); // it did not come
  same(loads.slice(1), [[element.textures, undefined], [element.textures, 200]]);
  Object.assign(element, { largest: undefined, wholeWanted: true });
  same(picked(), 1600);
});

test("a picture is downloaded whole, and comparing goes on", async () => {
  const clicked = [], given = { URL: class extends URL { static createObjectURL = (blob) => `blob:${blob}`; static revokeObjectURL() {} } };
  const { element, $, drawn, window } = room({ given });
  window.HTMLAnchorElement.prototype.click = function () { clicked.push([this.download, this.href]); };
  $("canvas").toBlob = (done, type) => done(type);
  await element.command("compare");
  await element.command("download");
  same([clicked, drawn.at(-1).split, element.comparing], [[["room.png", "blob:image/png"]], 0, true]);
  element.draw(true);
  same(drawn.at(-1).split, 39);
  element.renderer = null;
  $("img").src = "https://x.org/room/picture.jpg";
  await element.command("download");
  same(clicked[1], ["room.jpg", "https://x.org/room/picture.jpg"]);
});

test("files that are dropped are a texture of the target below them, or the map of finishes", async () => {
  const finishes = { finishes: ["matt", "gloss"], finish: 1 }, { element, $, send } = page({ targets: [{ ...targets[0], ...finishes }, targets[1], targets[2]] }, { seen: (x) => (x < 39 ? 0 : x < 60 ? 1 : -1) });
  const put = [], dataTransfer = { items: [], files: ["a.png", "b.png"] }, drop = (to, at, has = {}) => send(to, "drop", { ...at, dataTransfer, ...has });
  element.setTexture = async (name, files) => put.push([name, files]);
  element.setMap = async (name, file) => put.push([name, file, "map"]);
  same([send("canvas", "dragover", RUG), $(".room").classList.contains("drop"), $(".name").hidden, $(".name").textContent], [true, true, false, "Put it on: Rug"]);
  send("canvas", "dragover", NONE); // what is chosen
  same($(".name").textContent, "Put it on: Floor");
  send("canvas", "dragleave", { relatedTarget: $(".stage") });
  same($(".room").classList.contains("drop"), true);
  send(".room", "dragleave", { relatedTarget: element.parentElement });
  same($(".room").classList.contains("drop"), false);
  same(drop("canvas", RUG), true);
  drop("canvas", RUG, { dataTransfer: { items: [], files: [] } });
  await new Promise((done) => setTimeout(done));
  same([put, element.selected], [[["Rug", ["a.png", "b.png"]]], 1]);
  element.select("Floor");
  drop(".finish", NONE); // without a texture a map has nothing to lie on
  element.textures[0].image = {};
  element.refresh();
  send(".finish", "dragover", NONE);
  same($(".name").textContent, "Map of finishes: Floor");
  drop(".finish", RUG);
  element.renderer = null;
  drop("canvas", RUG);
  await new Promise((done) => setTimeout(done));
  same([put.slice(1), element.selected], [[["Floor", ["a.png", "b.png"]], ["Floor", "a.png", "map"]], 0]);
});

test("a graphics card that is lost is told, and the room comes back with its textures", () => {
  const { element, $, send } = room(), loads = [];
  element.load = (kept) => loads.push(kept);
  $("canvas").classList.add("shown");
  same(send("canvas", "webglcontextlost"), true);
  same([element.renderer, $("canvas").classList.contains("shown"), $(".message").hidden, $("[data-set=exposure]").disabled], [null, false, false, true]);
  send("canvas", "webglcontextrestored");
  same(loads, [element.textures]);
  element.remove();
  send("canvas", "webglcontextrestored");
  same(loads.length, 1);
});

test("the panel shows the target that is chosen and how its texture lies", async () => {
  const { element, $, $$, send } = room({ canEdit: (t) => t !== 1 }), value = (key) => $(`[data-set=${key}]`).value, told = (key) => $(`[data-set=${key}]`).parentElement.querySelector("output").textContent;
  same($$(".targets button").map((b) => [b.textContent, b.getAttribute("aria-pressed"), b.disabled, b.title]),
    [["Floor", "true", false, ""], ["Rug", "false", true, ""], ["Hidden", "false", false, "Not seen in this picture"]]);
  same([$(".placing").hidden, $(".chosen:not(.map)").textContent, $("[data-set=grout]").disabled], [true, "Original", false]);
  await element.setTexture("Floor", "#e9e4da");
  same([$(".placing").hidden, $$(".swatch").filter((b) => b.getAttribute("aria-pressed") === "true").map((b) => b.dataset.source)], [true, ["#e9e4da"]]);
  Object.assign(element.textures[0], { image: { width: 200, height: 100 }, label: "oak_plank-2k.jpg", scale: [0.5, 2], rotate: -12.4, offset: [0.25, -0.5], width: "2", grout: "0.5", adjust: { saturation: 0.3, gain: [2], tint: "#80c0ff" } });
  element.refresh();
  same([$(".placing").hidden, $(".chosen:not(.map)").textContent], [false, "oak plank 2k"]);
  same(["size", "rotate", "right", "up", "grout", "saturation", "lightness"].map(told), ["2.00×", "-12°", "0.25", "-0.50", "25 %", "0.3×", "2×"]);
  near(["size", "right", "up", "saturation", "lightness"].map((key) => Number(value(key))), [1, 0.25, -0.5, 0.3, 1], 1e-9);
  same([value("tint"), value("repeat")], ["#80c0ff", "straight"]);
  $("[data-set=size]").focus(); // a slider that is being moved is left alone, and tells the value
  element.textures[0].scale = 0.25;
  element.textures[0].adjust.tint = "#102030";
  element.refresh();
  same([value("size"), told("size")], ["1", "4.00×"]);
  $("[data-set=tint]").focus();
  element.textures[0].adjust.tint = "#ffeedd";
  element.refresh();
  same([value("size"), value("tint")], ["2", "#ffeedd"]);
  for (const [changes, disabled] of [[{ repeat: "mirror" }, true], [{ repeat: "brick" }, false], [{ wrap: "clamp" }, true], [{ wrap: "repeat" }, false]]) {
    Object.assign(element.textures[0], changes);
    element.refresh();
    same($("[data-set=grout]").disabled, disabled, JSON.stringify(changes));
  }
  send($$(".targets button")[1], "click");
  same([element.selected, $("[data-set=grout]").disabled, $("[data-set=file]").disabled, $$(".swatch").every((b) => b.disabled)], [1, true, true, true]);
  same($("canvas").getAttribute("aria-label"), "The room. Floor: oak_plank-2k.jpg, Rug: Original, Hidden: Original.");
});

test("offers are colours and pictures, which are put on what is chosen", async () => {
  const { element, $, $$, send } = room(), put = [];
  element.setAttribute("textures", " red-oak_2.jpg  #112233 ");
  element.offered = null;
  $$(".swatch").forEach((b) => b.remove());
  element.refresh();
  same($$(".swatch").map((b) => [b.parentElement.className.split(" ").at(-1), b.dataset.source, b.getAttribute("aria-label")]).slice(0, 2),
    [["images", "red-oak_2.jpg", "red oak 2"], ["colors", "#112233", "Colour #112233"]]);
  same([$$(".swatch").length, $$(".colors > *").at(-1) === $("[data-set=color]"), $$(".swatch")[0].style.background.includes("https://x.org/red-oak_2.jpg")], [8, true, true]);
  element.setTexture = async (...args) => put.push(args);
  send($$(".swatch")[1], "click");
  const files = (set, list) => {
    const input = $(`[data-set=${set}]`);
    Object.defineProperty(input, "files", { value: list, configurable: true });
    send(input, "input");
  };
  element.setMap = async (...args) => put.push([...args, "map"]);
  files("file", []);
  files("map", []);
  files("file", ["x", "y"]);
  files("map", ["m"]);
  await new Promise((done) => setTimeout(done));
  same(put, [["Floor", "#112233"], ["Floor", ["x", "y"]], ["Floor", "m", "map"]]);
});

test("rows of lamps show what is said of them, and the picture's label too", async () => {
  const { element, $, $$, send } = room(), row = (i) => [...$$(".lamp")[i].querySelectorAll("button i, output")].map((x) => x.textContent), label = () => $("canvas").getAttribute("aria-label");
  same([row(0), row(1)], [["on", "1×", "own"], ["off", "off", "own"]]);
  same($$(".lamp").map((r) => [r.getAttribute("aria-label"), ...[...r.querySelectorAll("input")].map((x) => x.getAttribute("aria-label"))]),
    [["Lamp", "Lamp: strength", "Lamp: warmth"], ["Spot", "Spot: strength", "Spot: warmth"]]);
  same([label(), $$(".lamp button:nth-of-type(2)").map((b) => b.disabled)], ["The room. Floor: Original, Rug: Original, Hidden: Original.", [true, true]]);
  await element.setLight("Lamp", "0.3333*3000K");
  await element.setLight("Spot", "12.345");
  same([row(0), row(1)], [["on", "0.33×", "2990 K"], ["on", "12.3×", "own"]]);
  same([label(), $$(".lamp button:nth-of-type(2)").map((b) => b.disabled)], ["The room. Floor: Original, Rug: Original, Hidden: Original, Lamp: changed, Spot: changed.", [false, false]]);
  send($$(".lamp button")[0], "click");
  await new Promise((done) => setTimeout(done));
  same([row(0)[0], element.lamps[0].color, label().includes("Lamp: off")], ["off", [0, 0, 0], true]);
  send($$(".lamp button")[1], "click"); // as rendered
  await new Promise((done) => setTimeout(done));
  same([element.lamps[0].value, row(0), element.shadowRoot.activeElement === $$(".lamp button")[0]], [null, ["on", "1×", "own"], true]);
  $$("[data-set=gain]")[1].value = -1;
  send($$("[data-set=gain]")[1], "input");
  await new Promise((done) => setTimeout(done));
  same(element.lamps[1], { name: "Spot", value: "0.5", color: [1, 1, 1] });
});
