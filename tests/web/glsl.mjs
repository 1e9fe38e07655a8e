/* Runs the player's shaders: a translator of the part of GLSL ES 3.00 that they use into JavaScript. Every expression has its
 * type in GLSL, which converts nothing by itself: an operand of another type is an error here, too. All scalars are numbers,
 * vectors lists, matrices lists of columns. */

const TOKEN = /\s+|\/\/.*|(\d*\.\d+(?:e[+-]?\d+)?|\d+\.(?:\d+)?|\d+e[+-]?\d+)|(\d+u?)|([A-Za-z_]\w*)|([-+*\/&|<>=!]=|&&|\|\||<<|>>|\+\+|[-+*\/&|<>=!?:;,.(){}[\]])/y;
const LEVELS = [["||"], ["&&"], ["|"], ["&"], ["==", "!="], ["<", ">", "<=", ">="], ["<<", ">>"], ["+", "-"], ["*", "/"]];

function tokens(text) {
  const found = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < text.length) {
    const at = TOKEN.lastIndex, match = TOKEN.exec(text);
    if (!match) throw new Error(`GLSL: ${text.slice(at, at + 40)}`);
    const [, float, whole, word, sign] = match;
    if (float) found.push({ kind: "number", type: "float", text: String(Number(float)) });
    else if (whole) found.push({ kind: "number", type: whole.endsWith("u") ? "uint" : "int", text: String(parseInt(whole)) });
    else if (word) found.push({ kind: "word", text: word });
    else if (sign) found.push({ kind: "sign", text: sign });
  }
  return found;
}

/* ---- types ---- */

const PREFIXES = { float: "", int: "i", uint: "u", bool: "b" };
const SHAPES = { void: {}, mat2: { base: "float", matrix: true } };
for (const [base, prefix] of Object.entries(PREFIXES)) {
  SHAPES[base] = { base, size: 1 };
  for (const size of [2, 3, 4]) SHAPES[`${prefix}vec${size}`] = { base, size };
}
for (const name of ["sampler2D", "sampler2DArray", "usampler2D", "usampler2DArray"])
  SHAPES[name] = { sampler: true, texel: name[0] === "u" ? "uvec4" : "vec4", places: name.endsWith("Array") ? 3 : 2 };
const typeOf = (base, size) => (size === 1 ? base : `${PREFIXES[base]}vec${size}`);
const shapeOf = (part) => SHAPES[part.type] || {};

function expect(is, ...what) {
  if (!is) throw new Error(`GLSL: ${what.map((x) => x?.type || x).join(" ")}`);
}

/* ---- functions, each of the sizes of its arguments ---- */

const HELPERS = [], known = new Map();
function helper(text) {
  if (!known.has(text)) {
    known.set(text, `h${HELPERS.length}`);
    HELPERS.push(new Function(`return (${text})`)());
  }
  return known.get(text);
}
/* A formula of a, b and c, component by component; numbers are used for all components. */
function each(formula, parts, base) {
  const sizes = parts.map((p) => shapeOf(p).size), size = Math.max(...sizes), names = ["a", "b", "c"].slice(0, parts.length);
  expect(sizes.every((s) => s === size || s === 1), formula, "of", ...parts);
  const one = (i) => names.reduce((text, name, k) => (sizes[k] > 1 ? text.replace(new RegExp(`\\b${name}\\b`, "g"), `${name}[${i}]`) : text), formula);
  const body = size === 1 ? formula : `[${Array.from({ length: size }, (_, i) => one(i))}]`;
  return { code: `${helper(`(${names}) => ${body}`)}(${parts.map((p) => p.code)})`, type: typeOf(base, size) };
}

/* Integers have 32 bits. */
const WHOLE = { "+": "a + b", "-": "a - b", "*": "Math.imul(a, b)", "/": "a / b", "&": "a & b", "|": "a | b", "<<": "a << b", ">>": "a >> b" };
function arithmetic(sign, a, b) {
  const { base, matrix } = shapeOf(a), of = shapeOf(b);
  if (matrix) {
    expect(sign === "*" && (of.matrix || b.type === "vec2"), a, sign, b);
    const times = "[a[0][0] * V[0] + a[1][0] * V[1], a[0][1] * V[0] + a[1][1] * V[1]]", of2 = (v) => times.replace(/V/g, v);
    return { code: `${helper(`(a, b) => ${of.matrix ? `[${of2("b[0]")}, ${of2("b[1]")}]` : of2("b")}`)}(${a.code}, ${b.code})`, type: b.type };
  }
  const isBits = !"+-*/".includes(sign), isShift = sign === "<<" || sign === ">>";
  expect(base && base !== "bool" && of.size && (base === of.base || (isShift && of.base === "int")) && !(isBits && base === "float"), a, sign, b);
  if (base === "float") return each(`a ${sign} b`, [a, b], base);
  return each(base === "int" ? `(${WHOLE[sign]}) | 0` : sign === ">>" ? "a >>> b" : `(${WHOLE[sign]}) >>> 0`, [a, b], base);
}

/* Formulas, and from which argument on a number may stand beside vectors. */
const BY_COMPONENT = {
  min: ["b < a ? b : a", 1], max: ["b > a ? b : a", 1], clamp: ["a < b ? b : a > c ? c : a", 1], mix: ["a * (1 - c) + b * c", 2], pow: ["Math.pow(a, b)"],
  atan: ["Math.atan2(a, b)"], exp2: ["2 ** a"], fract: ["a - Math.floor(a)"],
  ...Object.fromEntries("exp floor ceil sqrt cos sin abs log2 sign".split(" ").map((name) => [name, [`Math.${name}(a)`]])),
};
const WITH_INTEGERS = new Set(["min", "max", "clamp", "abs", "sign"]);
const bits = new DataView(new ArrayBuffer(4));
const LIBRARY = {
  bitsToFloat: (b) => (bits.setUint32(0, b), bits.getFloat32(0)),
  inverse: ([[a, b], [c, d]]) => { const e = a * d - b * c; return [[d / e, -b / e], [-c / e, a / e]]; },
  size: (sampler) => (sampler.layers ? [sampler.width, sampler.height, sampler.layers] : [sampler.width, sampler.height]),
  store: (x, places, value) => places.forEach((k, i) => { x[k] = value[i]; }),
};

/* A call of what GLSL has. */
function call(name, args) {
  const [a, b, c] = args, shapes = args.map(shapeOf), codes = args.map((p) => p.code).join(", "), wrong = [name, ...args];
  const convert = { float: "Number(a)", int: "Math.trunc(a) | 0", uint: "Math.trunc(a) >>> 0" };
  if (SHAPES[name]?.size) {
    const { base, size } = SHAPES[name], parts = args.map((p, k) => (shapes[k].base === base ? p : each(convert[base], [p], base)));
    const total = shapes.reduce((sum, s) => sum + s.size, 0);
    if (total === size && size === 1) return parts[0];
    const names = parts.map((_, k) => `a${k}`), list = parts.flatMap((_, k) => (shapes[k].size === 1 ? names[k] : Array.from({ length: shapes[k].size }, (_, i) => `${names[k]}[${i}]`)));
    expect(total >= size || total === 1, ...wrong);
    const made = total === 1 ? Array(size).fill(names[0]) : list.slice(0, size);
    return { code: `${helper(`(${names}) => ${size === 1 ? made[0] : `[${made}]`}`)}(${parts.map((p) => p.code)})`, type: name };
  }
  if (BY_COMPONENT[name]) {
    const [formula, scalars = 3] = BY_COMPONENT[name], chosen = name === "mix" && shapes[2]?.base === "bool";
    expect(args.length === new Set(formula.match(/\b[abc]\b/g)).size, ...wrong);
    shapes.forEach((s, k) => expect((s.size === shapes[0].size || (s.size === 1 && k >= scalars && !chosen)) && (s.base === shapes[0].base || (chosen && k === 2)), ...wrong));
    expect(shapes[0].base === "float" || (shapes[0].base === "int" && WITH_INTEGERS.has(name)), ...wrong);
    return each(chosen ? "c ? b : a" : formula, args, shapes[0].base);
  }
  const isVectors = (count) => args.length === count && shapes.every((s) => s.base === "float" && s.size === shapes[0].size && s.size > 1);
  const range = Array.from({ length: shapes[0]?.size || 0 }, (_, k) => k), number = (text, type = "float") => ({ code: `${helper(text)}(${codes})`, type });
  switch (name) {
    case "length": return expect(isVectors(1), ...wrong), number(`(a) => Math.hypot(${range.map((k) => `a[${k}]`)})`);
    case "dot": return expect(isVectors(2), ...wrong), number(`(a, b) => ${range.map((k) => `a[${k}] * b[${k}]`).join(" + ")}`);
    case "any": return expect(shapes[0].base === "bool" && shapes[0].size > 1, ...wrong), number(`(a) => ${range.map((k) => `a[${k}]`).join(" || ")}`, "bool");
    case "lessThan": case "greaterThan": return expect(isVectors(2), ...wrong), each(name === "lessThan" ? "a < b" : "a > b", args, "bool");
    case "uintBitsToFloat": {
      expect(shapes[0].base === "uint", ...wrong);
      return { code: shapes[0].size > 1 ? `${codes}.map(L.bitsToFloat)` : `L.bitsToFloat(${codes})`, type: typeOf("float", shapes[0].size) };
    }
    case "inverse": return expect(a.type === "mat2", ...wrong), { code: `L.inverse(${codes})`, type: "mat2" };
    case "transpose": return expect(a.type === "mat2", ...wrong), number("(a) => [[a[0][0], a[1][0]], [a[0][1], a[1][1]]]", "mat2");
    case "mat2": return expect(args.length === 4 && args.every((p) => p.type === "float"), ...wrong), number("(a, b, c, d) => [[a, b], [c, d]]", "mat2");
    case "textureSize": return expect(shapes[0].sampler && b.type === "int", ...wrong), { code: `L.size(${a.code})`, type: `ivec${shapes[0].places}` };
    case "texelFetch": return expect(shapes[0].sampler && b.type === `ivec${shapes[0].places}` && c.type === "int", ...wrong), { code: `${a.code}.texel(...${b.code})`, type: shapes[0].texel };
    case "texture": case "textureLod": {
      expect(shapes[0].sampler && b.type === `vec${shapes[0].places}` && (name === "texture" || c.type === "float"), ...wrong);
      return { code: `${a.code}.lookUp(${b.code}, ${c ? c.code : 0})`, type: shapes[0].texel };
    }
    default: throw new Error(`GLSL: there is no ${name}`);
  }
}

/* Translates a shader; returns the text of its functions and its uniforms. */
function translate(text) {
  const list = tokens(text.replace(/^#version.*$/m, "").replace(/\bprecision \w+ \w+;/g, ""));
  let at = 0, returned;
  const uniforms = [], functions = {}, scopes = [new Map([["gl_FragCoord", "vec4"]])];
  const peek = (k = 0) => list[at + k]?.text, take = (text) => {
    if (text !== undefined && peek() !== text) throw new Error(`GLSL: ${peek()} instead of ${text}`);
    return list[at++].text;
  };
  const accept = (text) => peek() === text && !!take();
  const declare = (name, type) => scopes.at(-1).set(name, type), inScope = (body) => {
    scopes.push(new Map());
    const made = body();
    scopes.pop();
    return made;
  };
  const variable = (name) => {
    const scope = scopes.findLast((s) => s.has(name));
    expect(scope, "there is no", name);
    return { code: name.replace(/^(?!gl_)/, "$$$&"), type: scope.get(name) };
  };
  /* A vector that has a name is copied, as others may change parts of it. */
  const copied = (part, type) => {
    expect(part.type === type, part, "for", type);
    return /^\$\w+$/.test(part.code) && shapeOf(part).size > 1 ? `[...${part.code}]` : part.code;
  };

  function primary() {
    if (accept("(")) {
      const inner = expression();
      take(")");
      return { ...inner, code: `(${inner.code})` };
    }
    if (accept("-")) {
      const of = postfix();
      expect(["float", "int"].includes(shapeOf(of).base) && !shapeOf(of).matrix, "-", of);
      return each("-a", [of], shapeOf(of).base);
    }
    if (accept("!")) {
      const of = postfix();
      expect(of.type === "bool", "!", of);
      return { code: `!${of.code}`, type: "bool" };
    }
    const { kind, type } = list[at], word = take();
    if (kind === "number") return { code: word, type };
    if (word === "true" || word === "false") return { code: word, type: "bool" };
    if (!accept("(")) return variable(word);
    const args = [];
    while (!accept(")")) args.push(expression()), accept(",");
    const own = functions[word];
    if (!own) return call(word, args);
    expect(own.parameters.join() === args.map((p) => p.type).join(), word, ...args);
    return { code: `$${word}(${args.map((p) => p.code).join(", ")})`, type: own.type };
  }
  /* Parts of a vector: `v.x` is a number. */
  function swizzle(of, name) {
    const { base, size, matrix } = shapeOf(of), places = [...name].map((c) => Math.max("xyzw".indexOf(c), "rgba".indexOf(c)));
    expect(size > 1 && !matrix && places.every((k) => k >= 0 && k < size), of, ".", name);
    if (places.length === 1) return { code: `${of.code}[${places}]`, type: base };
    return { code: `${helper(`(a) => [${places.map((k) => `a[${k}]`)}]`)}(${of.code})`, type: typeOf(base, places.length), stored: `L.store(${of.code}, [${places}], ` };
  }
  function indexed(of) {
    const index = expression(), { base, size, matrix } = shapeOf(of);
    take("]");
    expect((index.type === "int" || index.type === "uint") && (matrix || size > 1 || of.type.endsWith("[]")), of, "[", index, "]");
    return { code: `${of.code}[${index.code}]`, type: of.type.endsWith("[]") ? of.type.slice(0, -2) : matrix ? "vec2" : base };
  }
  function postfix() {
    let left = primary();
    for (;;) {
      if (accept("[")) left = indexed(left);
      else if (accept(".")) left = swizzle(left, take());
      else return left;
    }
  }
  function binary(level) {
    if (level === LEVELS.length) return postfix();
    let left = binary(level + 1);
    while (LEVELS[level].includes(peek())) {
      const sign = take(), right = binary(level + 1);
      if (level === 0 || level === 1 || level === 4 || level === 5) {
        const { base, size } = shapeOf(left);
        expect(left.type === right.type && size === 1 && (level < 4 ? base === "bool" : level === 4 || base !== "bool"), left, sign, right);
        left = { code: `(${left.code} ${sign} ${right.code})`, type: "bool" };
      } else left = arithmetic(sign, left, right);
    }
    return left;
  }
  function expression() {
    const left = binary(0);
    if (!accept("?")) return left;
    const yes = expression();
    take(":");
    const no = expression();
    expect(left.type === "bool" && yes.type === no.type, left, "?", yes, ":", no);
    return { code: `(${left.code} ? ${yes.code} : ${no.code})`, type: yes.type };
  }
  function condition() {
    const is = expression();
    expect(is.type === "bool", "a condition of", is);
    return is.code;
  }
  function assignment() {
    const left = postfix(), sign = take();
    if (sign === "++") return expect(left.type === "int", left, "++"), `${left.code}++`;
    const right = expression(), value = copied(sign === "=" ? right : arithmetic(sign[0], left, right), left.type);
    return left.stored ? `${left.stored}${value})` : `${left.code} = ${value}`;
  }
  function declaration() {
    const names = [];
    accept("const");
    const type = take();
    do {
      const name = take(), value = accept("=") ? ` = ${copied(expression(), type)}` : "";
      declare(name, type);
      names.push(`$${name}${value}`);
    } while (accept(","));
    return `let ${names.join(", ")}`;
  }
  const simple = () => (peek() === "const" || (SHAPES[peek()] && list[at + 1].kind === "word") ? declaration() : assignment());
  function statement() {
    if (peek() === "{") return inScope(block);
    if (accept("if")) {
      take("(");
      const is = condition();
      take(")");
      const yes = statement();
      return `if (${is}) ${yes}${accept("else") ? ` else ${statement()}` : ""}`;
    }
    if (accept("for")) return inScope(() => {
      take("(");
      const begin = simple();
      take(";");
      const is = condition();
      take(";");
      const step = assignment();
      take(")");
      return `for (${begin}; ${is}; ${step}) ${statement()}`;
    });
    if (accept(";")) return ";";
    const text = accept("continue") ? "continue" : accept("discard") ? "return $result = null" : accept("return") ? `return ${copied(expression(), returned)}` : simple();
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
        declare(name, isList ? `${type}[]` : type);
      } while (accept(","));
      take(";");
    } else if (accept("out")) {
      declare(peek(1), take());
      code += `let $${take()};\n`;
      take(";");
    } else {
      returned = take();
      const name = take(), parameters = [], names = [];
      take("(");
      while (!accept(")")) parameters.push(take()), names.push(take()), accept(",");
      expect(!functions[name], "two functions", name);
      functions[name] = { type: returned, parameters };
      code += `function $${name}(${names.map((n) => `$${n}`).join(", ")}) ${inScope(() => (names.forEach((n, k) => declare(n, parameters[k])), block()))}\n`;
    }
  }
  return { code, uniforms };
}

/* Compiles a fragment shader: its uniforms, and a function of their values, by name, that returns one of a place on the
 * picture that returns the colour there. */
export function compile(text) {
  const { code, uniforms } = translate(text);
  const make = new Function("L", "H", "U", `const [${HELPERS.map((_, k) => `h${k}`)}] = H, { ${uniforms.map(({ name }) => `${name}: $${name}`).join(", ")} } = U;
    let gl_FragCoord;\n${code}\nreturn (place) => { gl_FragCoord = place; $main(); return $result; };`);
  return { uniforms, run: (values) => make(LIBRARY, HELPERS, values) };
}
