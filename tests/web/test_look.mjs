/* How textures look and lie in the player: scales, widths, turns, offsets, flips, wraps, light. The
 * references are the formulas of retex-sample(1) and the definition of sRGB. */
import { fails, near, random, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

/* ---- what may be asked of a texture ---- */

test("options of textures are checked, and the others stay", async () => {
  const { placing, plainTexture } = player(), plain = plainTexture();
  const good = { scale: [2, -1], rotate: -30.5, offset: [0, 0.5], flip: "uv", wrap: "clamp,black", repeat: "mirror", label: "Oak", width: [2, 3], grout: "", groutcolor: "red", vary: "", at: [1, -2] };
  same(placing(plain, good), { ...good, adjust: {} });
  same(placing({ ...plain, ...good }, { rotate: 1 }), { ...good, rotate: 1, adjust: {} });
  same(placing(plain, { scale: null }).scale, 1);
  const bad = [["scale", 0], ["scale", [1, 0]], ["scale", [1]], ["scale", "2"], ["scale", NaN], ["rotate", Infinity], ["rotate", "1"],
    ["offset", 1], ["offset", [1, null]], ["offset", [1, 2, 3]], ["tint", "rde"], ["width", 0], ["width", [1, -1]], ["grout", -1], ["groutcolor", "rde"],
    ["vary", "spin"], ["vary", 1e9], ["at", 1], ["hue", "red"], ["saturation", -1], ["gain", [1, 2]], ["gamma", 0], ["blur", 0.3], ["invert", 2], ["flip", "w"], ["flip", "vu"], ["wrap", "none"],
    ["wrap", "clamp,"], ["wrap", "clamp,clamp,clamp"], ["repeat", "tiles"], ["label", 3]];
  for (const [key, value] of bad)
    await fails(() => placing(plain, { [key]: value }), `A texture's ${key} cannot be ${JSON.stringify(value)}.`, key);
  await fails(() => placing(plain, { repeat: "brick", wrap: "clamp" }), "A texture's repeat brick needs wrap repeat.");
  await fails(() => placing(plain, { grout: 0.1 }), "A texture's grout needs width.");
  await fails(() => placing({ ...plain, wrap: "clamp,repeat" }, { vary: "turn" }), "A texture's vary needs wrap repeat.");
  await fails(() => placing({ ...plain, width: 1 }, { repeat: "mirror", grout: 0.1 }), "A texture's grout cannot be used with repeat mirror.");
  same(placing(plain, { colorspace: "sRGB", vary: "5,flip,TURN" }).vary, "turn,flip,5");
  await fails(() => placing(plain, { colorspace: "ACEScg" }), "A texture's colorspace is for the tools, not for this page.");
});

test("adjustments stay in the order in which they are made, until they change nothing", () => {
  const { placing, plainTexture } = player(), plain = plainTexture(), some = placing(plain, { tint: "tan", gamma: 2, gain: 2, invert: true });
  same(Object.entries(some.adjust), [["tint", "tan"], ["gamma", 2], ["gain", [2, 2, 2]], ["invert", "yes"]]);
  const others = placing({ ...plain, ...some }, { hue: "-90", tint: "#ffffff", gamma: 3, invert: false });
  same(Object.entries(others.adjust), [["gamma", 3], ["gain", [2, 2, 2]], ["hue", -90]]);
  same([placing({ ...plain, ...others }, {}).adjust, placing({ ...plain, ...others }, { gamma: null, gain: [1, 1, 1], hue: 0 }).adjust], [others.adjust, {}]);
});

/* ---- where textures lie ---- */

/* Where retex-sample looks in an image for these UV, by its man page: R (S u, T v) + (U, V), then flipped. */
function lies(t, scale, [u, v]) {
  const turn = (t.rotate * Math.PI) / 180, [x, y] = [scale[0] * u, scale[1] * v];
  const at = [Math.cos(turn) * x - Math.sin(turn) * y + t.offset[0], Math.sin(turn) * x + Math.cos(turn) * y + t.offset[1]];
  return at.map((x, k) => (t.flip.includes("uv"[k]) ? 1 - x : x));
}

/* The values that the player gives its shaders for these textures, and how it has set the wraps of images. */
function drawn(textures, targets, light = { exposure: 0, warmth: 0 }) {
  const wraps = [], passes = [];
  const gl = new Proxy({ texParameteri: (_, key, value) => wraps.push([key, value]) },
    { get: (o, key) => o[key] ?? (key === key.toUpperCase() ? key : () => {}) });
  const { RetexRoom, Renderer } = player({ performance: { now: () => 0 }, cancelAnimationFrame: () => {} });
  const room = { targets: targets.map((t) => ({ ...t, image: {}, hasImage: true })), classes: [], groups: [], lights: [], width: 100, height: 50, terms: [], mixtures: [] };
  const renderer = Object.assign(Object.create(Renderer.prototype), { gl, room, loaded: new Set(), lights: new Set(), programOf: () => 0, overEnd: [], factors: {}, originals: {} });
  renderer.draw = (_, values) => passes.push(values);
  const element = Object.assign(Object.create(RetexRoom.prototype), { textures, room, light, emit: () => {}, comparing: false });
  Object.defineProperty(element, "renderer", { value: renderer });
  element.draw(true);
  return { values: passes.at(-1), wraps };
}

const target = { uv_scale: [1, 1], periodic: [0, 0] };
const image = (width, height) => ({ naturalWidth: width, naturalHeight: height });
const texture = (changes) => ({ ...player().plainTexture(), put: {}, image: image(100, 100), ...changes });

/* Where the shader looks: turn * uv + offset, column by column as WebGL has matrices. */
const looks = ({ turn, offset }, t, [u, v]) =>
  [0, 1].map((k) => turn[4 * t + k] * u + turn[4 * t + 2 + k] * v + offset[2 * t + k]);

test("textures lie as retex-sample's formula says", () => {
  const next = random(7), number = () => next(-3000, 3000) / 1000;
  for (let k = 0; k < 60; k++) {
    const scale = [number() || 1, number() || 1];
    const t = texture({ scale, rotate: next(-400, 400), offset: [number(), number()], flip: ["", "u", "v", "uv"][k % 4] });
    const { values } = drawn([texture({}), t], [target, target]), uv = [number(), number()];
    near(looks(values, 1, uv), lies(t, scale, uv), 1e-9, JSON.stringify(t));
    near(looks(values, 0, uv), uv, 1e-12);
  }
});

test("one number as scale keeps the image's proportions on the surface", () => {
  // a unit of v is 3 scene units, of u 2, and the image twice as wide as high: it must be so on the surface
  const t = texture({ scale: 2, image: image(400, 200) });
  const { values } = drawn([t], [{ uv_scale: [2, 3] }]), origin = looks(values, 0, [0, 0]);
  const perUnit = [looks(values, 0, [1 / 2, 0])[0] - origin[0], looks(values, 0, [0, 1 / 3])[1] - origin[1]]; // repeats a scene unit
  near(perUnit[1] / perUnit[0], 2, 1e-12);
  near(looks(values, 0, [1, 0])[0] - origin[0], 2, 1e-12);
  // without a known scale of the UV, or for a colour
  same(drawn([texture({ scale: 2, image: image(300, 100) })], [{ uv_scale: [0, 0] }]).values.turn.map((x) => x + 0), [2, 0, 0, 6]);
  same(drawn([texture({ scale: 2, image: [1, 0, 0] })], [target]).values.turn.map((x) => x + 0), [2, 0, 0, 2]);
});

test("of two repeats in one image, one repeat is half of it", () => {
  for (const [repeat, share] of [["brick", [1, 0.5]], ["half-drop", [0.5, 1]]])
    for (const flip of ["", "u", "v", "uv"]) {
      const t = texture({ scale: [1, 1], rotate: 20, offset: [0.3, 0.7], flip, repeat, put: { period: share.map((x) => 1 / x) } });
      const plain = lies({ ...t, flip: "" }, [1, 1], [0.6, -0.2]);
      // flipped about the middle of one repeat, then one repeat is its share of the image
      const expected = plain.map((x, k) => (flip.includes("uv"[k]) ? 1 - x : x) * share[k]);
      near(looks(drawn([t], [target]).values, 0, [0.6, -0.2]), expected, 1e-12, `${repeat} ${flip}`);
    }
});

test("wraps and mirrored repeats, on each axis", () => {
  const modes = (changes) => drawn([texture(changes)], [target]);
  same(modes({ wrap: "mirror,clamp" }).wraps, [["TEXTURE_WRAP_S", "MIRRORED_REPEAT"], ["TEXTURE_WRAP_T", "CLAMP_TO_EDGE"]]);
  same(modes({ wrap: "black,repeat" }).wraps, [["TEXTURE_WRAP_S", "CLAMP_TO_EDGE"], ["TEXTURE_WRAP_T", "REPEAT"]]);
  same(modes({ wrap: "repeat,black", repeat: "mirror" }).wraps, [["TEXTURE_WRAP_S", "MIRRORED_REPEAT"], ["TEXTURE_WRAP_T", "CLAMP_TO_EDGE"]]);
  same(modes({ wrap: "clamp,black" }).values.edge, [-1, 1]);
  same(modes({ wrap: "mirror" }).values.edge, [0, 0]);
  same(modes({ wrap: "black", image: [1, 0, 0] }).values.edge, [0, 0]);
});

test("the light: stops and warmth as factors", () => {
  const at = (exposure, warmth) => drawn([texture({})], [target], { exposure, warmth }).values.develop;
  const factors = (r, g, b) => [r, 0, 0, 0, g, 0, 0, 0, b];
  same(at(0, 0), factors(1, 1, 1));
  near(at(2, 0), factors(4, 4, 4), 1e-12);
  near(at(-1, 1), factors(0.5 * 2 ** 0.4, 0.5, 0.5 / 2 ** 0.4), 1e-12);
  near(at(0, -0.5), factors(2 ** -0.2, 1, 2 ** 0.2), 1e-12);
});

/* By retex-edit(5): R (S a u, T b v), divided by the width, plus the offset; `at` is where the middle of the image is. */
test("widths are lengths on the target, and a whole number of repeats goes round what closes", () => {
  const { lie } = player(), plain = { scale: [1, 1], rotate: 0, offset: [0, 0], flip: "", width: [0.5, 0], at: "" }, unit = [2, 3], open = { uv_scale: unit, periodic: [0, 0] };
  const looksAt = ({ turn, offset }, [u, v]) => [0, 1].map((k) => turn[k] * u + turn[2 + k] * v + offset[k]), lies2 = (t, of = open, wrap = ["repeat", "repeat"], period = [1, 1]) => lie({ ...plain, ...t }, of, wrap, [200, 100], period);
  near(looksAt(lies2({}), [1, 1]), [2 / 0.5, 3 / 0.25], 1e-12);
  near(looksAt(lies2({ width: [0.5, 1], scale: [2, 3], rotate: 90, offset: [0.1, 0.2] }), [0.3, 0.4]), [-3 * 3 * 0.4 / 0.5 + 0.1, 2 * 2 * 0.3 / 1 + 0.2], 1e-12);
  near(looksAt(lies2({ rotate: 30, at: [0.7, -0.4] }, open, ["black", "black"]), [0.7 / 2, -0.4 / 3]), [0.5, 0.5], 1e-12);
  near(looksAt(lies2({ rotate: 30, flip: "u", offset: [0.25, 0], at: [0.7, -0.4] }), [0.7 / 2, -0.4 / 3]), [0.25, 0.5], 1e-12);
  near(looksAt(lies2({ width: null, scale: [3, 2], at: [0.7, -0.4] }), [0.7, -0.4]), [0.5, 0.5], 1e-12);
  const round = (t, ...more) => { const { turn } = lies2(t, { uv_scale: [2.2, 3], periodic: [1, 0] }, ...more); return [Math.hypot(turn[0], turn[1]), Math.hypot(turn[2], turn[3])]; };
  near(round({}), [4, 12], 1e-12); // 4.4 repeats become 4
  near(round({ width: [0.5, 1], rotate: 90 }), [2, 6], 1e-12); // 2.2 of its height
  near(round({ width: [0.5, 1], rotate: 20 }), [2.2 * Math.hypot(Math.cos(Math.PI / 9) / 0.5, Math.sin(Math.PI / 9)), 3 * Math.hypot(Math.sin(Math.PI / 9) / 0.5, Math.cos(Math.PI / 9))], 1e-12);
  near(round({ width: [0.7, 1] }, ["mirror", "repeat"]), [4, 3], 1e-12); // 3.1 are an even number
  near(round({ width: [0.3, 1] }, ["repeat", "repeat"], [3.5, 1]), [2, 3], 1e-12); // 7.3 in units of 3.5
  near(round({ width: [0.5, 1] }, ["clamp", "repeat"]), [4.4, 3], 1e-12);
});

test("absurd widths and places stay numbers that a shader can have", () => {
  const { lie } = player(), plain = { scale: [1, 1], rotate: 0, offset: [0, 0], flip: "", width: [1, 0], at: "" };
  for (const change of [{ width: [1e-320, 0] }, { width: [1e300, 0] }, { width: [1e-300, 1e300], rotate: 30 }, { at: [1e300, -1e300] }, { scale: [1e300, 1e-300] }, { offset: [1e300, 0] }])
    for (const wrap of [["repeat", "mirror"], ["black", "black"]]) {
      const { turn, offset } = lie({ ...plain, ...change }, { uv_scale: [1, 1], periodic: [1, 1] }, wrap, [200, 100], [1, 1]);
      if (![...turn, ...offset].every((x) => Math.abs(x) < 1e7) || turn.every((x) => Math.abs(x) < 1e-7)) throw new Error(JSON.stringify([change, turn, offset]));
    }
});

/* ---- images that are made ---- */

/* A canvas of pixels that are numbers; drawImage copies without scaling or notes the size. */
function canvases() {
  const made = [];
  const document = { createElement: () => {
    const canvas = { getContext: () => ({
      canvas,
      drawImage: (image, x, y, w, h) => {
        if (w !== undefined) canvas.drawn = [x, y, w, h];
        for (let row = 0; image.pixels && row < image.height; row++)
          for (let column = 0; column < image.width; column++) {
            const [cx, cy] = [column + x, row + y];
            if (cx >= 0 && cy >= 0 && cx < canvas.width && cy < canvas.height)
              (canvas.pixels ||= {})[[cx, cy]] = image.pixels[row * image.width + column];
          }
      },
      getImageData: () => ({ data: canvas.data || made.data }),
    }) };
    return canvas;
  } };
  return { document, made };
}

test("large images are made smaller in their proportions, and keep a pixel at least", () => {
  const { document } = canvases(), { smaller } = player({ document });
  const size = (w, h, most) => (({ width, height }) => [width, height])(smaller({ naturalWidth: w, naturalHeight: h }, most));
  same(size(8192, 4096, 4096), [4096, 2048]);
  same(size(3000, 6000, 4096), [2048, 4096]);
  same(size(100000, 3, 4096), [4096, 1]);
  same(size(10, 10, 1024), [1024, 1024]);
});

test("an image is clear if a pixel of it is not opaque", () => {
  const { document, made } = canvases(), { isClear } = player({ document });
  for (const [data, clear] of [[[0, 0, 0, 255, 9, 9, 9, 255], false], [[0, 0, 0, 255, 9, 9, 9, 254], true], [[1, 2, 3, 0], true]]) {
    made.data = data;
    same(isClear({}), clear);
  }
});
