/** A target's texture lies as these say; see README.md. */
export interface RetexPlacing {
  /** A number keeps the picture's proportions; a pair has the meaning of retex-combine's. */
  scale?: number | [number, number];
  /** Degrees. */
  rotate?: number;
  offset?: [number, number];
  repeat?: "straight" | "mirror" | "brick" | "half-drop" | "herringbone" | "basket" | "hexagon";
  /** "repeat", "mirror", "clamp" or "black", or two for u and v: "clamp,repeat". */
  wrap?: string;
  flip?: "" | "u" | "v" | "uv";
  label?: string;
  /** Of a repeat, in scene units, or with units, "60cm"; a pair is width and height. "" or null: none, and so for those below. */
  width?: number | [number, number] | string | null;
  /** Where the middle of the image lies, in scene units with a width, else in UV. */
  at?: [number, number] | string | null;
  /** The width of joints, in scene units. */
  grout?: number | string | null;
  groutcolor?: string | null;
  /** "turn", "flip", "shift" and a number that picks others: "turn,flip,3". */
  vary?: string | null;
  /** Adjustments of colours, which are made in the order in which they are first given. Degrees. */
  hue?: number | null;
  saturation?: number | null;
  /** Linear; one number for all three. */
  gain?: number | [number, number, number] | null;
  gamma?: number | null;
  contrast?: number | null;
  /** A part of the picture's width, to 0.25. */
  blur?: number | null;
  invert?: boolean | "yes" | null;
  /** A colour: "#rrggbb", "tomato", "rgb(0.8,0.1,0.1)" with linear numbers. */
  tint?: string | null;
  colorize?: string | null;
}

export interface RetexTextureOptions extends RetexPlacing {
  /** A picture that says which of the target's finishes is where: grey through the list of finishes, or red, green and
   * blue for the second, third and fourth; or "none". */
  finish?: Blob | string;
  /** URLs of more pictures for the repeats, a list or divided by commas. */
  tiles?: string | string[];
  /** A normal map. Pages do not show it; it stays in states and links, for the tools. */
  normal?: string;
}

export interface RetexLight {
  /** Stops, -30 to 30. */
  exposure: number;
  /** -1 to 1. */
  warmth: number;
  /** Kelvins of the light that becomes white, 1000 to 25000. */
  whiteBalance?: number | null;
  /** Whether the log-average of the picture's luminance is brought to 0.18 before `exposure`. */
  autoExposure?: boolean | null;
  /** How linear colours are shown. */
  view?: "Standard" | "Filmic" | "Neutral" | "Raw" | null;
}

/** A lamp whose light the set keeps apart. */
export interface RetexLamp {
  readonly name: string;
  /** As in links, "1.5*rgb(1.9143814,0.8098837,0.19077155)"; null as rendered. */
  readonly value: string | null;
  /** Linear. */
  readonly color: [number, number, number];
}

export interface RetexState {
  /** By target; layers are "over:Floor" to "over4:Floor". */
  textures: Record<string, RetexTextureOptions & { source: string }>;
  light: RetexLight;
  /** Values of lamps by name; "*" is all that are not named. */
  lamps?: Record<string, string>;
  /** Names of finishes by target; those that are not named are as rendered. */
  finishes?: Record<string, string>;
}

/** Events of <retex-room>. */
export interface RetexRoomEvents {
  "retex-still": CustomEvent<{}>;
  "retex-ready": CustomEvent<{ targets: string[] }>;
  "retex-complete": CustomEvent<{}>;
  "retex-change": CustomEvent<RetexState>;
  "retex-select": CustomEvent<{ target: string }>;
  "retex-draw": CustomEvent<{ milliseconds: number }>;
  "retex-error": CustomEvent<{ message: string }>;
}

/** The element <retex-room src="FOLDER/">. */
export class RetexRoom extends HTMLElement {
  readonly targets: string[];
  readonly lamps: RetexLamp[];
  readonly complete: Promise<void>;
  readonly link: string;
  /** A list is the files of one texture: the base colour and the roughness, by their names. A target "over:Floor" is a layer
   * on Floor, "over2:Floor" to "over4:Floor" are those on it. */
  setTexture(target: string, source: Blob | File[] | string | null, options?: RetexTextureOptions): Promise<void>;
  /** Another map of finishes on the texture that lies there; null: none. */
  setMap(target: string, map: Blob | string | null): Promise<void>;
  place(target: string, options: RetexPlacing): void;
  setLight(light: Partial<RetexLight>): Promise<void>;
  /** A lamp's new value: 0, 2.5, "#ffd0a0", "3000K", "1.5*3000K"; null: as rendered. */
  setLight(lamp: string, value: string | number | null): Promise<void>;
  /** One of a target's finishes, by name; null: as rendered. */
  setFinish(target: string, finish: string | null): Promise<void>;
  getState(): RetexState;
  setState(state: Partial<RetexState>): Promise<void>;
  toBlob(type?: string, quality?: number): Promise<Blob | null>;
  select(target: string): void;
}

declare global {
  interface HTMLElementTagNameMap {
    "retex-room": RetexRoom;
  }
  /** They bubble: the element, those around it and the document have them, to add and to remove. */
  interface GlobalEventHandlersEventMap extends RetexRoomEvents {}
}

/** Attributes of the element, for JSX. */
export interface RetexRoomAttributes {
  /** The room's folder. */
  src?: string;
  /** URLs of pictures, and colours, to offer, separated by blanks. */
  textures?: string;
  /** The URL of a preset, as of retex-combine --save-preset: how the room looks at first. */
  preset?: string;
  panel?: "closed";
  "no-link"?: "" | boolean;
}

// For React 18 and 19. Programs without React have no such module, which the comments let pass.
// @ts-ignore
declare module "react" {
  namespace JSX {
    interface IntrinsicElements {
      // @ts-ignore
      "retex-room": DetailedHTMLProps<HTMLAttributes<RetexRoom>, RetexRoom> & RetexRoomAttributes;
    }
  }
}
