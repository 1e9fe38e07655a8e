"""Mutants of compiled code: one instruction of gcc's assembly of a C file is another one, or none.

Taken are instructions of lines of the file itself, not of headers: conditional jumps, sets and moves, and arithmetic.
At -O1 a condition of the source is one jump and an operator one instruction; -O2 would double loops and jumps, and
mutants of the copies make no difference. Both round in the same way, so all tests hold for either. A mutant is as long
as the original, so that it can be written into a program that is linked already: see linked.py."""

import hashlib
import os
import re
import subprocess

# Conditions in pairs of opposites. Parity is left out: it belongs to the comparison of floats that follows it.
CONDITIONS = {"e": "ne", "l": "ge", "g": "le", "b": "nb", "a": "be", "c": "nc", "s": "ns", "o": "no", "z": "nz",
              "nl": "l", "ng": "g", "ae": "b", "na": "a"}
CONDITIONS.update({value: key for key, value in list(CONDITIONS.items()) if value not in CONDITIONS})
JUMP = re.compile(r"j([a-z]+)$")
SET_OR_MOVE = re.compile(r"(set|cmov)([a-z]+?)([lqw]?)$")

# Arithmetic and its opposite, by the operation's name without the letter of its width.
OPPOSITES = [("add", "sub"), ("inc", "dec"), ("and", "or"), ("sal", "shr"), ("shl", "shr"), ("sar", "sal"),
             ("shr", "sal"), ("mul", "div"), ("min", "max")]
INTEGER = {a: b for a, b in OPPOSITES[:7]} | {"sub": "add", "dec": "inc", "or": "and"}
INTEGER_ALONE = ("imul", "neg", "not", "xor")  # these may only go
FLOAT = {"add": "sub", "sub": "add", "mul": "div", "div": "mul", "min": "max", "max": "min"}
FLOAT_OPERATION = re.compile(r"(v?)(add|sub|mul|div|min|max)([sp][sd])$")
FLOAT_LOGIC = re.compile(r"(xor|and)(p[sd])$")


def split_operands(text):
    """Operands of an instruction, at commas outside of brackets."""
    return [operand.strip() for operand in re.split(r",(?![^(]*\))", text)] if text else []


def jump_changes(name, operands):
    """What a conditional jump may become."""
    match = JUMP.match(name)
    if not match or match[1] not in CONDITIONS:
        return []
    return [("opposite", f"j{CONDITIONS[match[1]]} {operands[0]}"), ("always", f"jmp {operands[0]}"), ("never", "")]


def arithmetic_changes(name, operands):
    """What an arithmetic instruction may become."""
    rest = ", ".join(operands)
    if "rsp" in rest:
        return []  # the stack's own
    match = FLOAT_OPERATION.match(name)
    if match:
        found = [("opposite", f"{match[1]}{FLOAT[match[2]]}{match[3]} {rest}")]
        return found if match[1] else found + [("none", "")]
    match = FLOAT_LOGIC.match(name)
    if match:
        return [("none", "")] if operands[0] != operands[1] else []
    for width in ("l", "w", "b"):  # of 64 bits are addresses, mostly, and a wrong one ends any test
        stem = name[:-1]
        if name.endswith(width) and stem in INTEGER:
            return [("opposite", f"{INTEGER[stem]}{width} {rest}"), ("none", "")]
        if name.endswith(width) and stem in INTEGER_ALONE:
            return [("none", "")] if len(operands) < 3 and operands[0] != operands[-1] or len(operands) == 1 else []
    return []


def changes(name, operands):
    """(kind, instruction) of each mutant of an instruction; none for most instructions."""
    match = SET_OR_MOVE.match(name)
    if match and match[2] in CONDITIONS:
        return [("opposite", f"{match[1]}{CONDITIONS[match[2]]}{match[3]} " + ", ".join(operands))]
    return jump_changes(name, operands) or arithmetic_changes(name, operands)


class Mutant:
    """A change of one instruction. `place` is the line of the assembly; `level` is the processor's that it is for, or
    "" where all run it."""

    def __init__(self, path, line, function, text, level, place, old, kind, new):
        self.path, self.line, self.function, self.text, self.level = path, line, function, text, level
        self.place, self.old, self.kind, self.new = place, old, kind, new
        self.turn = 0  # of those that are otherwise the same
        self.decides = old.startswith(("j", "set", "cmov"))

    @property
    def what(self):
        """What stays the same if other lines or registers change."""
        return f"{self.old.split()[0]} {self.kind}"

    @property
    def name(self):
        """Of one mutant in the draw, and in the results."""
        return "\t".join((self.path, self.function, self.text, self.what, str(self.turn)))


def functions_of(source):
    """The function in which each line of a C file is, by its number from 1."""
    found, function = [""], ""
    for line in source:
        match = re.match(r"[A-Za-z_][\w \t*]*?\**(\w+)\(", re.sub(r"__attribute__\(\(\w+\)\) ", "", line))
        if match and match[1] != "__attribute__" and not line.rstrip().endswith(";"):
            function = match[1]
        found.append(function)
    return found


def other_level():
    """The ending of functions that this processor never runs: kernels are compiled once a level, see retex/host/cpu.h."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        return "_avx2" if "avx512f" in file.read() else "_avx512"


def mutants_of(path, assembly):
    """All mutants of a C file, of which gcc's assembly is given."""
    with open(path, encoding="utf-8") as file:
        source = file.read().splitlines()
    functions = functions_of(source)
    own, line, found, turns, in_text, other = set(), 0, [], {}, True, other_level()
    runs, level = True, ""
    for place, text in enumerate(assembly):
        words = text.split("#")[0].split(None, 1)
        if not words:
            continue
        if words[0] in (".text", ".section", ".data", ".bss"):
            in_text = words[0] == ".text"
        elif text[0] not in "\t .#":
            runs = not text.split(":")[0].endswith(other)
            level = "baseline" if text.split(":")[0].endswith("_baseline") else ""
        elif words[0] == ".file":
            match = re.match(r'(\d+) (?:".*" )?"(.*)"', words[1])
            if match and os.path.normpath(match[2]) == path:
                own.add(match[1])
        elif words[0] == ".loc":
            file, number = words[1].split()[:2]
            line = int(number) if file in own else 0
        elif line and in_text and runs and text[0] == "\t" and words[0][0] != "." and "GOTPCREL" not in text:
            operands = split_operands(words[1].strip() if len(words) > 1 else "")
            for kind, new in changes(words[0], operands):
                mutant = Mutant(path, line, functions[line], " ".join(source[line - 1].split()), level,
                                place, " ".join(words).strip(), kind, new)
                turns[mutant.name] = mutant.turn = turns.get(mutant.name, -1) + 1
                found.append(mutant)
    return found


def draw(mutants, count, seed):
    """`count` of them by seed, one of an instruction, decisions and arithmetic by turns. Each has its place in the draw
    by its name: a change elsewhere does not move it."""
    sorts = {True: [], False: []}
    taken = set()
    for mutant in sorted(mutants, key=lambda one: hashlib.sha256(f"{seed}\t{one.name}".encode()).digest()):
        if (mutant.path, mutant.place) not in taken:
            taken.add((mutant.path, mutant.place))
            sorts[mutant.decides].append(mutant)
    found = [mutant for pair in zip(*sorts.values()) for mutant in pair]
    return (found + max(sorts.values(), key=len)[len(found) // 2:])[:count]


def section(path, name, work):
    """The bytes of a section of an object."""
    out = os.path.join(work, "section")
    open(out, "wb").close()
    subprocess.run(["objcopy", "-O", "binary", "-j", name, "--set-section-flags", f"{name}=alloc,load,readonly", path,
                    out], check=True, capture_output=True)
    with open(out, "rb") as file:
        return file.read()


def assemble(lines, work):
    """The object of an assembly."""
    source, made = os.path.join(work, "mutant.s"), os.path.join(work, "mutant.o")
    with open(source, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    subprocess.run(["as", "-o", made, source], check=True, capture_output=True)
    return made


def without_lines(assembly):
    """The assembly without what debuggers read; lines stay where they are."""
    kept, debug = [], False
    for text in assembly:
        words = text.split()
        if words and words[0] in (".section", ".text", ".data", ".bss"):
            debug = len(words) > 1 and words[1].startswith(".debug")
        drop = debug or bool(words) and (words[0] in (".loc", ".file") or words[0].startswith(".cfi"))
        kept.append("" if drop else text)
    return kept


class Code:
    """The code of one object, and of its mutants."""

    def __init__(self, path, assembly, work):
        self.lines, self.work = without_lines(assembly), work
        self.bytes = section(assemble(self.lines, work), ".text", work)
        if self.bytes != section(path, ".text", work):
            raise ValueError(f"{path} is not of its assembly")
        self.digest = hashlib.sha256(self.bytes).hexdigest()[:16]

    def place(self, lines, place):
        """Where an instruction is in the code, and how long."""
        lines = list(lines)
        lines[place] = f".L_from: {lines[place]}\n.L_to: .pushsection .places\n" \
            ".long .L_from - .Ltext0, .L_to - .L_from\n.popsection"
        found = section(assemble(lines, self.work), ".places", self.work)
        return int.from_bytes(found[:4], "little"), int.from_bytes(found[4:8], "little")

    def mutate(self, mutant):
        """[(offset, old byte, new byte)], or None where the mutant does not fit into the place of the original, or
        is the same."""
        start, length = self.place(self.lines, mutant.place)
        lines = list(self.lines)
        lines[mutant.place] = mutant.new
        try:
            padding = length - (self.place(lines, mutant.place)[1] if mutant.new else 0)
            lines[mutant.place] = f".skip {padding}, 0x90\n{mutant.new}"
            changed = section(assemble(lines, self.work), ".text", self.work) if padding >= 0 else b""
        except subprocess.CalledProcessError:
            return None
        if len(changed) != len(self.bytes):
            return None
        places = [i for i in range(start, start + length) if changed[i] != self.bytes[i]]
        return [(i, self.bytes[i], changed[i]) for i in places] or None
