/* Mutants of JavaScript: node --expose-internals operators.js FILE…, as JSON, one a line: the file, the line, the function,
 * what is done and the texts before and after. Node's own parser says what is an operator. */
"use strict";
const { readFileSync } = require("node:fs");
const { parse } = require("internal/deps/acorn/acorn/dist/acorn");
const { fullAncestor } = require("internal/deps/acorn/acorn-walk/dist/walk");

const OPPOSITES = { "===": "!==", "!==": "===", "==": "!=", "!=": "==", "<": ">=", ">=": "<", ">": "<=", "<=": ">", "&&": "||", "||": "&&",
  "??": "&&", "+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "**": "*", "<<": ">>", ">>": "<<", ">>>": "<<", "&": "|", "|": "&",
  "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "++": "--", "--": "++" };

/* The name of what holds a piece of the tree: a function, a method, or what a function is given to. */
function nameOf(ancestors) {
  for (const node of [...ancestors].reverse()) {
    if (node.type === "FunctionDeclaration") return node.id ? node.id.name : "default";
    if (node.type === "MethodDefinition" || node.type === "PropertyDefinition") return node.key.name || "key";
    if (node.type === "VariableDeclarator" && node.id.name && /Function/.test(node.init && node.init.type)) return node.id.name;
  }
  return "module";
}

/* Where an operator stands: between its operands, outside of comments. */
function operatorAt(text, from, to, operator) {
  const blank = text.slice(from, to).replace(/\/\*[^]*?\*\/|\/\/.*/g, (comment) => " ".repeat(comment.length));
  return from + blank.indexOf(operator);
}

for (const file of process.argv.slice(2)) {
  const text = readFileSync(file, "utf8"), tree = parse(text, { ecmaVersion: "latest", sourceType: "module", locations: true });
  const tell = (node, ancestors, what, start, end, by) => console.log(JSON.stringify({ path: file, line: node.loc.start.line,
    function: nameOf(ancestors), text: text.split("\n")[text.slice(0, start).split("\n").length - 1].trim().split(/\s+/).join(" "),
    what, start, end, by }));
  fullAncestor(tree, (node, _, ancestors) => {
    const by = OPPOSITES[node.operator];
    if (["BinaryExpression", "LogicalExpression", "AssignmentExpression"].includes(node.type) && by) {
      const start = operatorAt(text, node.left.end, node.right.start, node.operator);
      tell(node, ancestors, `${node.operator} opposite`, start, start + node.operator.length, by);
    } else if (node.type === "UpdateExpression") {
      const start = node.prefix ? node.start : node.end - 2;
      tell(node, ancestors, `${node.operator} opposite`, start, start + 2, by);
    } else if (node.type === "UnaryExpression" && "!-".includes(node.operator)) {
      tell(node, ancestors, `${node.operator} none`, node.start, node.start + 1, " ");
    }
    if (node.test)
      for (const value of ["true", "false"])
        if (value === "false" || /If|Conditional/.test(node.type))
          tell(node, ancestors, `condition ${value}`, node.test.start, node.test.end, `(${text.slice(node.test.start, node.test.end)}, ${value})`);
  });
}
