/* The types of the player, by TypeScript: for programs without React, and in the JSX of React 18 and 19, of whose types
 * the stand-in below has what matters. */
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { same, test } from "./tap.mjs";

const REACT = `declare namespace React {
  interface RefObject<T> { current: T | null }
  interface HTMLAttributes<T> { id?: string; className?: string; onClick?: (event: { currentTarget: T }) => void }
  type DetailedHTMLProps<E extends HTMLAttributes<T>, T> = E & { ref?: RefObject<T>; key?: string };
  namespace JSX {
    interface Element { type: string }
    interface ElementChildrenAttribute { children: {} }
    interface IntrinsicElements { div: DetailedHTMLProps<HTMLAttributes<HTMLDivElement>, HTMLDivElement> }
  }
}
export = React;
export as namespace React;
`;
const RUNTIME = `import * as React from "./index";
export namespace JSX {
  type Element = React.JSX.Element;
  interface IntrinsicElements extends React.JSX.IntrinsicElements {}
}
export function jsx(type: any, props: any): JSX.Element;
export const jsxs: typeof jsx;
`;

/* What the compiler says of a program, by the numbers of its errors and lines. */
function errors(name, text, hasReact) {
  const folder = mkdtempSync(`${tmpdir()}/retex-types-`), modules = `${folder}/node_modules`;
  mkdirSync(`${modules}/retex-room`, { recursive: true });
  for (const file of ["retex-room.d.ts", "package.json"]) copyFileSync(`tools/web/${file}`, `${modules}/retex-room/${file}`);
  if (hasReact) {
    mkdirSync(`${modules}/react`);
    writeFileSync(`${modules}/react/index.d.ts`, REACT);
    writeFileSync(`${modules}/react/jsx-runtime.d.ts`, RUNTIME);
  }
  writeFileSync(`${folder}/${name}`, text);
  const { stdout, error } = spawnSync("tsc", ["--noEmit", "--strict", "--target", "es2020", "--moduleResolution", "node", "--jsx", "react-jsx",
    name], { cwd: folder, encoding: "utf8" });
  rmSync(folder, { recursive: true });
  if (error) throw error;
  return [...stdout.matchAll(/^(.*)\((\d+),\d+\): error (TS\d+)/gm)].map(([, file, line, code]) => `${file}:${line} ${code}`);
}

test("a program without React", () => {
  same(errors("plain.ts", `import { RetexRoom } from "retex-room";
const room: RetexRoom = document.querySelector("retex-room")!;
room.setTexture("Floor", "oak.jpg", { scale: 2 });
room.setTexture(3, "oak.jpg");
room.addEventListener("retex-error", (event) => event.detail.message.trim());
`, false), ["plain.ts:4 TS2345"]);
});

test("what is listened to in an effect of React is given back", () => {
  same(errors("effect.ts", `import { RetexRoom, RetexRoomEvents } from "retex-room";
declare function useEffect(effect: () => void | (() => void)): void;
declare const room: RetexRoom;
useEffect(() => {
  const onChange = (event: RetexRoomEvents["retex-change"]) => console.log(event.detail.textures);
  const onPress = (event: KeyboardEvent) => console.log(event.key);
  room.addEventListener("retex-change", onChange);
  room.addEventListener("keydown", onPress, { passive: true });
  return () => {
    room.removeEventListener("retex-change", onChange);
    room.removeEventListener("keydown", onPress, true);
  };
});
room.removeEventListener("retex-select", (event: CustomEvent<{ wrong: number }>) => event.detail.wrong);
document.addEventListener("retex-error", (event) => event.detail.message.trim());
document.removeEventListener("retex-error", (event) => event.detail.none);
`, false), ["effect.ts:14 TS2769", "effect.ts:16 TS2339"]);
});

test("JSX of React", () => {
  same(errors("page.tsx", `import type { RetexRoom } from "retex-room";
import type { RefObject } from "react";
const ref: RefObject<RetexRoom> = { current: null };
export const good = <retex-room id="one" ref={ref} src="room/" textures="a.jpg #f80" preset="look.json" panel="closed" no-link="" />;
export const wrong = <retex-room src={3} />;
export const odd = <retex-room panel="open" />;
export const unknown = <retex-house />;
export const place = <retex-room onClick={(event) => event.currentTarget.place("Floor", { rotate: 30 })} />;
`, true), ["page.tsx:5 TS2322", "page.tsx:6 TS2322", "page.tsx:7 TS2339"]);
});
