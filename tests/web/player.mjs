/* The player without a browser: the script that `make` puts together of tools/web, whose functions are taken out of it.
 * What the browser gives is replaced by `world`: its names are those that the script sees. */
import { readFileSync } from "node:fs";

const script = readFileSync(`${process.env.BUILD || "build"}/gen/retex-room.js`, "utf8").replace(/\bexport *\{ *RetexRoom *\};?\s*$/, "");
const names = ["crc32", "isDamaged", "fetchBytes", "fetchChecked", "nameOf", "inflate", "mostBytes", "decodePlane", "decodeClass",
  "decodePicture", "RECORD_COLUMNS", "checkManifest", "Renderer", "RetexRoom", "srgbDecode", "readColor", "parseColor", "parseEdit", "editText", "parseLamp", "lampText", "lampColor", "lampsOf", "parameterColors", "kelvinColor", "miredOf", "kelvinOf", "isRelit", "wordsOf",
  "plainTexture", "placing", "lie", "layoutOf", "paintingsOf", "looksOf", "Images", "isClear", "smaller", "mixtureShader", "factorShader", "lampShader", "pictureShader", "gateShader", "smallGateShader", "passesOf", "firstHitOf", "WEIGH", "PRODUCT", "readFolder", "droppedFiles", "hasRoughness", "developMatrix", "checkedLight"];

export function player(world = {}) {
  const load = new Function(...Object.keys(world), `${script}\nreturn { ${names.join(", ")} };`);
  return load(...Object.values(world));
}
