// ---- pictures: what they are like, and those of visitors ----

import { decodeImage, isDamaged } from "./files.js";

/* The size of a picture, or of a colour. */
export const sizeOf = (source) => [source.naturalWidth || source.width || 1, source.naturalHeight || source.height || 1];

const drawingContext = (width, height) => Object.assign(document.createElement("canvas"), { width, height }).getContext("2d");

/* Whether a picture may show what lies below it. */
export function isClear(image) {
  const context = drawingContext(64, 64);
  context.drawImage(image, 0, 0, 64, 64);
  return context.getImageData(0, 0, 64, 64).data.some((x, i) => i % 4 === 3 && x < 255);
}

export const DRAWING = "image/svg+xml", MOST_SIDE = 4096;

/* A visitor's picture. Drawings may have no size of their own. A JPEG file has no transparent parts, but if its end is
 * missing the browser leaves some. */
export async function decodePicture(blob, name) {
  const image = await decodeImage(blob, name), bytes = new Uint8Array(await blob.arrayBuffer());
  if (isDamaged(bytes) || (bytes[0] === 255 && isClear(image))) throw new Error(`${name} is damaged.`);
  return blob.type === DRAWING ? smaller(image, 1024) : image;
}

/* A picture in a canvas whose longer side has so many pixels. */
export function smaller(image, most) {
  const times = most / Math.max(image.naturalWidth, image.naturalHeight);
  const size = [image.naturalWidth, image.naturalHeight].map((x) => Math.max(1, Math.round(x * times))), context = drawingContext(...size);
  context.imageSmoothingQuality = "high";
  context.drawImage(image, 0, 0, ...size);
  return context.canvas;
}

/* Whether a map is grey: its value then goes through the list of finishes. Else red is the second, green the third, blue
 * the fourth, and the rest the first. JPEG stores colours and not grey. */
export function isGrey(image) {
  const [width, height] = [image.naturalWidth || image.width, image.naturalHeight || image.height].map((x) => Math.min(x, 1024));
  const context = drawingContext(width, height);
  context.drawImage(image, 0, 0, width, height);
  const { data } = context.getImageData(0, 0, width, height), far = (a, b) => Math.abs(data[a] - data[b]) > 2.6;
  return !data.some((_, i) => i % 4 === 0 && (far(i, i + 1) || far(i + 1, i + 2)));
}
