/* How the player lays repeats of a texture: the cells of a layout fill its image once, whatever the bond, and have the sizes
 * that retex-edit(5) gives them. test_textures compares pictures with those of the tools. */
import { near, random, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

const { layoutOf, plainTexture, rint } = player(), MOST = 4096, TEXELS = 2 ** 24;
const lay = (laid, image, most = MOST, texels = TEXELS) => layoutOf({ ...plainTexture(), ...laid }, image, most, texels);

test("halves are rounded to even numbers, as rint of C does", () => {
  same([0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 7.5, 8.5, 4.4, 4.6].map(rint), [0, 2, 2, 4, 4, 6, 8, 8, 4, 5]);
  same([-0.5, -1.5, -2.5, -4.5, -6.5, -4.4].map((x) => rint(x) + 0), [0, -2, -2, -4, -6, -4]);
});

/* How often each texel of a layout's image lies in a cell: a repeat and the joints at its right and above. */
function filled({ size: [width, height], block, joint, blocks }) {
  const times = new Uint8Array(width * height), around = (x, n) => ((x % n) + n) % n;
  for (const { x, y, stands } of blocks) {
    const [wide, high] = stands ? [block[1] + joint[1], block[0] + joint[0]] : [block[0] + joint[0], block[1] + joint[1]];
    for (let v = y; v < y + high; v++) for (let u = x; u < x + wide; u++) times[around(v, height) * width + around(u, width)]++;
  }
  return times;
}

const BONDS = ["straight", "brick", "half-drop", "herringbone", "basket"];
for (const repeat of BONDS)
  test(`cells fill the image once: ${repeat}`, () => {
    const next = random(BONDS.indexOf(repeat) + 1);
    for (let k = 0; k < 40; k++) {
      const image = [next(3, 60), next(3, 60)], width = [next(10, 90) / 10, next(10, 90) / 10], grout = k % 3 ? next(1, 100) / 100 * Math.min(...width) : 0;
      const vary = ["", "flip,3", "turn,shift,8"][k % 3], what = JSON.stringify([image, width, grout, vary]);
      const layout = lay({ repeat, width, grout, vary: vary || (repeat === "straight" ? "flip,1" : "") }, image), { size, block, joint, period } = layout;
      same(filled(layout).every((times) => times === 1), true, what);
      /* Of a bond that turns both sides of a repeat have the texels of its shorter side. */
      const isTurned = BONDS.indexOf(repeat) > 2, short = width[1] < width[0] ? 1 : 0;
      const texel = isTurned ? [0, 1].map(() => (width[short] + grout) / (block[short] + joint[short])) : width.map((w, i) => (w + grout) / (block[i] + joint[i]));
      near(period.map((p, i) => p * width[i]), size.map((s, i) => s * texel[i]), 1e-9, what);
      near(layout.grout, texel.map((t) => grout / t), 1e-9, what);
      same([Math.min(...joint) > 0, isTurned || joint.every((j, i) => j === 0 || j < grout / (width[i] / image[i]) + 1)], [grout > 0, true], what);
      if (!isTurned) same(block, image, what);
    }
  });

test("the second of a half-drop's columns is half a repeat lower, whole texels", () => {
  for (const [high, joint, y] of [[8, 0, -4], [9, 0, -4], [8, 1, -4], [9, 2, -5]])
    same(lay({ repeat: "half-drop", width: [1, 1], grout: joint / high, vary: "" }, [10, high]).blocks.map((b) => b.y + 0), [0, y]);
});

test("repeats that turn are as long as to half a percent, or else as a whole number of quarters of their width", () => {
  for (const [ratio, texels] of [[3, [3, 1]], [3.01, [3, 1]], [2.5, [5, 2]], [7 / 3, [7, 3]], [2.25, [9, 4]], [2.7, [11, 4]], [1.1, [4, 4]]]) {
    const { block } = lay({ repeat: "herringbone", width: [ratio, 1], vary: "" }, [480, 120]);
    near(block[0] / block[1], texels[0] / texels[1], 1e-12, String(ratio));
    near(lay({ repeat: "herringbone", width: [1, ratio], vary: "" }, [120, 480]).block, [...block].reverse(), 0);
  }
});

test("joints have whole texels, as many as they need", () => {
  for (const [grout, joints] of [[0, [0, 0]], [0.01, [1, 1]], [0.25, [1, 2]], [0.26, [2, 3]], [1, [4, 8]]])
    same(lay({ repeat: "straight", width: [2, 1], grout, vary: "" }, [8, 8]).joint, joints, String(grout));
});

test("joints of colours are as sharp as those of pictures, in few enough texels", () => {
  for (const [repeat, grout, least] of [["straight", 0.1, 500], ["straight", 0.004, 500], ["brick", 0.1, 500], ["hexagon", 0.1, 400], ["basket", 0.1, 400], ["herringbone", 0.1, 150]]) {
    const { block, size: [width, height], grout: texels } = lay({ repeat, width: [1.2, 0.6], grout, vary: "flip" }, [1, 1]);
    same([block[repeat === "hexagon" ? 0 : 1] >= least, width * height <= 10 * 2 ** 20], [true, true], `${repeat} ${grout}: ${block} of ${width} x ${height}`);
    if (repeat === "straight") near(texels[0], Math.round(texels[0]), 0.05, repeat);
  }
});

test("hexagons: middles half a pitch apart from row to row, as high as is even", () => {
  for (const [width, grout, image] of [[2, 0, [40, 60]], [2, 0.3, [40, 60]], [1, 0.1, [33, 20]], [3, 1, [7, 9]]]) {
    const { size, block, joint, blocks, period, grout: ideal, hexagon } = lay({ repeat: "hexagon", width: [width, width], grout, vary: "" }, image);
    const texels = Math.max(1, Math.floor(Math.min(image[0], image[1] * Math.sqrt(0.75)))), needed = grout ? Math.ceil(grout * texels / width - 1e-6) : 0;
    const pitch = texels + needed + (texels + needed) % 2, row = Math.round(pitch * Math.sqrt(0.75)), texel = (width + grout) / pitch;
    same([size, block, joint, blocks.map(({ x, y }) => [x, y]), hexagon], [[pitch, 2 * row], [pitch - needed, image[1]], [needed, needed], [[0, 0], [pitch / 2, row]], { pitch, row }]);
    near([period, ideal], [[(width + grout) / width, 2 * Math.sqrt(0.75) * (width + grout) / width], [grout / texel, grout / texel]], 1e-9);
  }
});

test("a bond has as many copies as 16 a side, 256 repeats and a square image allow", () => {
  for (const [repeat, image, counts] of [["straight", [20, 20], [16, 16]], ["straight", [20, 100], [16, 16]], ["brick", [20, 10], [11, 11]], ["brick", [20, 100], [16, 8]], ["brick", [40, 10], [8, 16]]]) {
    const { size, blocks, period } = lay({ repeat, width: "", vary: "flip,1" }, image), each = repeat === "brick" ? 2 : 1;
    const own = [image[0], each * image[1]];
    same([size, blocks.length, period], [own.map((s, i) => s * counts[i]), each * counts[0] * counts[1], [counts[0], each * counts[1]]], repeat);
    blocks.forEach(({ x, y, column, row }, i) => {
      const copy = Math.floor(i / each), [across, up] = [copy % counts[0], Math.floor(copy / counts[0])], half = i % each;
      same([x, y, column, row], [across * own[0] + half * image[0] / 2, up * own[1] + half * image[1], half + across * each, up], `${repeat} ${i}`);
    });
  }
});

test("an image that a page cannot hold is coarser, and no coarser than it must be", () => {
  for (const [laid, image, most, texels] of [[{ repeat: "brick" }, [3000, 2000], 4096, TEXELS], [{ repeat: "brick" }, [3000, 2000], 1000, TEXELS], [{ repeat: "half-drop" }, [3000, 200], 4096, 2 ** 18],
    [{ repeat: "herringbone", width: [4, 1] }, [800, 200], 512, TEXELS], [{ repeat: "straight", vary: "flip,2" }, [500, 400], 4096, TEXELS / 4]]) {
    const { size } = lay({ width: "", vary: "", ...laid }, image, most, texels), what = JSON.stringify([laid, most, size]);
    same(size[0] <= most && size[1] <= most && size[0] * size[1] <= texels, true, what);
    same(Math.max(...size) > 0.9 * most || size[0] * size[1] > 0.8 * texels, true, what);
  }
});
