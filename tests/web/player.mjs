/* The player without a browser: all that its modules export. What the browser gives is replaced by `world`: its names are
 * those that the modules see. */
import { readFileSync } from "node:fs";

const script = readFileSync(`${process.env.BUILD || "build"}/tests/web/player.js`, "utf8");

export function player(world = {}) {
  const load = new Function(...Object.keys(world), `${script}\nreturn player;`);
  return load(...Object.values(world));
}
