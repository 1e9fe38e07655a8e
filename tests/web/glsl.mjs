/* Runs the player's shaders: a translator of the part of GLSL ES 3.00 that they use into JavaScript. Floats are numbers,
 * integers BigInt, vectors lists, matrices lists of columns. GLSL converts nothing by itself, so the kind of a literal is
 * the kind of its value. */

const TOKEN = /\s+|\/\/.*|(\d*\.\d+(?:e[+-]?\d+)?|\d+\.(?:\d+)?|\d+e[+-]?\d+)|(\d+)u?|([A-Za-z_]\w*)|([-+*\/&|<>=!]=|&&|\|\||<<|>>|\+\+|[-+*\/&|<>=!?:;,.(){}[\]])/y;
const TYPES = new Set("void float int uint bool vec2 vec3 vec4 ivec2 ivec3 uvec4 mat2 sampler2D sampler2DArray usampler2D usampler2DArray".split(" "));
const LEVELS = [["||"], ["&&"], ["|"], ["&"], ["==", "!="], ["<", ">", "<=", ">="], ["<<", ">>"], ["+", "-"], ["*", "/"]];

function tokens(text) {
  const found = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < text.length) {
    const at = TOKEN.lastIndex, match = TOKEN.exec(text);
    if (!match) throw new Error(`GLSL: ${text.slice(at, at + 40)}`);
    const [, float, whole, word, sign] = match;
    if (float) found.push({ kind: "number", text: String(Number(float)) });
    else if (whole) found.push({ kind: "number", text: `${whole}n` });
    else if (word) found.push({ kind: "word", text: word });
    else if (sign) found.push({ kind: "sign", text: sign });
  }
  return found;
}

/* Translates a shader; returns the text of its functions and its uniforms. */
function translate(text) {
  const list = tokens(text.replace(/^#version.*$/m, "").replace(/\bprecision \w+ \w+;/g, ""));
  let at = 0;
  const uniforms = [];
  const peek = (k = 0) => list[at + k]?.text, take = (text) => {
    if (text !== undefined && peek() !== text) throw new Error(`GLSL: ${peek()} instead of ${text}`);
    return list[at++].text;
  };
  const accept = (text) => peek() === text && !!take();

  function primary() {
    if (accept("(")) {
      const inner = expression();
      take(")");
      return `(${inner})`;
    }
    if (accept("-")) return `G.negative(${postfix()})`;
    if (accept("!")) return `!${postfix()}`;
    return list[at].kind === "number" ? take() : take().replace(/^(?!gl_|true$|false$)/, "$$$&");
  }
  /* Parts of a vector: `v.x` is a number. */
  function swizzle(left, name) {
    const places = [...name].map((c) => Math.max("xyzw".indexOf(c), "rgba".indexOf(c)));
    return places.length === 1 ? `${left}[${places}]` : `G.swizzle(${left}, [${places}])`;
  }
  function postfix() {
    let left = primary();
    for (;;) {
      if (accept("(")) {
        const args = [];
        while (!accept(")")) args.push(expression()), accept(",");
        left = `${left}(${args.join(", ")})`;
      } else if (accept("[")) {
        left += `[${expression()}]`;
        take("]");
      } else if (accept(".")) left = swizzle(left, take());
      else return left;
    }
  }
  function binary(level) {
    if (level === LEVELS.length) return postfix();
    let left = binary(level + 1);
    while (LEVELS[level].includes(peek())) {
      const sign = take(), right = binary(level + 1);
      left = level === 0 || level === 1 || level === 4 || level === 5 ? `(${left} ${sign} ${right})` : `G["${sign}"](${left}, ${right})`;
    }
    return left;
  }
  function expression() {
    const left = binary(0);
    if (!accept("?")) return left;
    const yes = expression();
    take(":");
    return `(${left} ? ${yes} : ${expression()})`;
  }
  function assignment() {
    const left = postfix(), sign = take(), swizzled = /^G\.swizzle\((\$\w+), (\[[\d,]+\])\)$/.exec(left);
    if (sign === "++") return `${left}++`;
    const value = sign === "=" ? expression() : `G["${sign[0]}"](${left}, ${expression()})`;
    return swizzled ? `G.store(${swizzled[1]}, ${swizzled[2]}, ${value})` : `${left} = ${value}`;
  }
  function declaration() {
    const names = [];
    accept("const");
    take();
    do names.push(`$${take()}${accept("=") ? ` = ${expression()}` : ""}`); while (accept(","));
    return `let ${names.join(", ")}`;
  }
  const simple = () => (peek() === "const" || (TYPES.has(peek()) && list[at + 1].kind === "word") ? declaration() : assignment());
  function statement() {
    if (peek() === "{") return block();
    if (accept("if")) {
      take("(");
      const condition = expression();
      take(")");
      const yes = statement();
      return `if (${condition}) ${yes}${accept("else") ? ` else ${statement()}` : ""}`;
    }
    if (accept("for")) {
      take("(");
      const begin = simple();
      take(";");
      const condition = expression();
      take(";");
      const step = assignment();
      take(")");
      return `for (${begin}; ${condition}; ${step}) ${statement()}`;
    }
    if (accept(";")) return ";";
    const text = accept("continue") ? "continue" : accept("discard") ? "return $result = null" : accept("return") ? `return ${expression()}` : simple();
    take(";");
    return `${text};`;
  }
  function block() {
    take("{");
    let body = "";
    while (!accept("}")) body += `${statement()}\n`;
    return `{\n${body}}`;
  }

  let code = "";
  while (at < list.length) {
    if (accept("uniform")) {
      const type = take();
      do {
        const name = take(), isList = accept("[");
        if (isList) take(), take("]");
        uniforms.push({ type, name, isList });
      } while (accept(","));
      take(";");
    } else if (accept("out")) {
      take();
      code += `let $${take()};\n`;
      take(";");
    } else {
      take();
      const name = take(), parameters = [];
      take("(");
      while (!accept(")")) take(), parameters.push(`$${take()}`), accept(",");
      code += `function $${name}(${parameters.join(", ")}) ${block()}\n`;
    }
  }
  return { code, uniforms };
}

/* ---- what GLSL has ---- */

/* A function of a, b and c, part by part where one is a vector. Each is made of its formula's text, so that the engine
 * compiles it for itself: most of the time is spent here. */
const each = (formula) => new Function("a", "b", "c", `const f = (a, b, c) => ${formula}, A = Array.isArray(a), B = Array.isArray(b), C = Array.isArray(c);
  if (!A && !B && !C) return f(a, b, c);
  const values = [], { length } = A ? a : B ? b : c;
  for (let i = 0; i < length; i++) values.push(f(A ? a[i] : a, B ? b[i] : b, C ? c[i] : c));
  return values;`);
const isMatrix = (x) => Array.isArray(x) && Array.isArray(x[0]);
const SIGNS = Object.fromEntries("+ - * / & | << >>".split(" ").map((sign) => [sign, each(`a ${sign} b`)]));
const times = (m, v) => v.map((_, row) => v.reduce((sum, x, column) => sum + m[column][row] * x, 0));
const G = {
  negative: each("-a"),
  ...SIGNS,
  "*": (a, b) => (!isMatrix(a) ? SIGNS["*"](a, b) : isMatrix(b) ? b.map((column) => times(a, column)) : times(a, b)),
  swizzle: (x, places) => places.map((k) => x[k]),
  store: (x, places, value) => places.forEach((k, i) => { x[k] = value[i]; }),
};

const floats = (x) => Number(x), wholes = (x) => BigInt(Math.trunc(Number(x)));
const vector = (size, convert) => (...args) => {
  const flat = [];
  for (const x of args) {
    if (Array.isArray(x)) for (const y of x) flat.push(convert(y));
    else flat.push(convert(x));
  }
  return flat.length === 1 ? Array(size).fill(flat[0]) : flat.slice(0, size);
};
const bits = new DataView(new ArrayBuffer(4)), bitsToFloat = (b) => (bits.setUint32(0, Number(b)), bits.getFloat32(0));
const BUILT_IN = {
  float: floats, int: wholes, vec2: vector(2, floats), vec3: vector(3, floats), vec4: vector(4, floats), ivec2: vector(2, wholes), ivec3: vector(3, wholes),
  mat2: (a, b, c, d) => [[a, b], [c, d]],
  transpose: (m) => [[m[0][0], m[1][0]], [m[0][1], m[1][1]]],
  inverse: ([[a, b], [c, d]]) => { const e = a * d - b * c; return [[d / e, -b / e], [-c / e, a / e]]; },
  mix: each('typeof c === "boolean" ? (c ? b : a) : a * (1 - c) + b * c'), clamp: each("a < b ? b : a > c ? c : a"),
  min: each("b < a ? b : a"), max: each("b > a ? b : a"),
  pow: each("Math.pow(a, b)"), atan: Math.atan2, exp2: each("2 ** a"), fract: each("a - Math.floor(a)"),
  length: (x) => Math.hypot(...x), dot: (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0), any: (x) => x.some(Boolean),
  lessThan: each("a < b"), greaterThan: each("a > b"), uintBitsToFloat: (x) => (Array.isArray(x) ? x.map(bitsToFloat) : bitsToFloat(x)),
  texelFetch: (sampler, place) => sampler.texel(...place.map(Number)),
  textureSize: (sampler) => (sampler.layers ? [sampler.width, sampler.height, sampler.layers] : [sampler.width, sampler.height]).map(BigInt),
  texture: (sampler, place) => sampler.lookUp(place, 0), textureLod: (sampler, place, lod) => sampler.lookUp(place, lod),
  ...Object.fromEntries("exp floor ceil sqrt cos sin abs log2 sign".split(" ").map((name) => [name, each(`Math.${name}(a)`)])),
};

/* Compiles a fragment shader: its uniforms, and a function of their values, by name, that returns one of a place on the
 * picture that returns the colour there. */
export function compile(text) {
  const { code, uniforms } = translate(text), own = uniforms.map((u) => u.name);
  const built = Object.keys(BUILT_IN).filter((name) => !new RegExp(`function \\$${name}\\(`).test(code));
  const make = new Function("G", "B", "U", `const { ${built.map((n) => `${n}: $${n}`).join(", ")} } = B, { ${own.map((n) => `${n}: $${n}`).join(", ")} } = U;
    let gl_FragCoord;\n${code}\nreturn (place) => { gl_FragCoord = place; $main(); return $result; };`);
  return { uniforms, run: (values) => make(G, BUILT_IN, values) };
}
