#!/usr/bin/python3
"""Writes retex/interface.py: what the package uses of the public headers, for ctypes.

interface.py HEADER-FOLDER >retex/interface.py

Structures and calls are those that the files of the package name. Pointers to structures that it does not name are
opaque. A change of the headers needs a new interface.py, which tests/python/test_interface.py demands."""
import os
import pathlib
import re
import subprocess
import sys
import textwrap

PACKAGE = pathlib.Path(__file__).parent / "retex"
NUMBERS = {"int": "c_int", "long": "c_long", "unsigned": "c_uint", "unsigned int": "c_uint", "size_t": "c_size_t",
           "uint32_t": "c_uint32", "uint64_t": "c_uint64", "float": "c_float", "double": "c_double", "char": "c_char"}


def filled(text, indent):
    """A statement on lines of at most 120 characters."""
    return textwrap.fill(text, 120, subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False)


class Headers:
    """The public headers: structures by name, calls, and what sizes of arrays are."""

    def __init__(self, folder):
        command = [*os.environ.get("CC", "gcc").split(), "-std=c11", "-E", "-P", "-I" + folder, "-include",
                   "retex/retex.h", "-xc", "/dev/null"]
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
        text = re.sub(r"^#.*|__attribute__\s*\(\(.*?\)\)", "", text, flags=re.M)
        self.structures = dict(re.findall(r"typedef struct (Retex\w+) \{([^{}]*)\} \1;", text))
        self.enums = set(re.findall(r"typedef enum (Retex\w+)", text))
        self.functions = {name: f"{result}({arguments})" for result, name, arguments in
                          re.findall(r"typedef ([\w ]+?) (Retex\w+)\(([^;]*)\);", text)}
        self.calls = {name: (result, arguments) for result, name, arguments in
                      re.findall(r"^((?:const )?\w+ \**)(retex_\w+)\(([^;{}]*)\);", text, flags=re.M)}
        self.sizes = {}
        for body in re.findall(r"enum(?: \w+)? \{([^{}]*)\}", text):
            value = -1
            for entry in filter(None, (part.strip() for part in body.split(","))):
                name, _, given = entry.partition("=")
                value = self.number(given) if given else value + 1
                self.sizes[name.strip()] = value

    def number(self, text):
        """A constant expression of the headers."""
        return eval(text, {"__builtins__": {}}, self.sizes)  # pylint: disable=eval-used


class Interface:
    def __init__(self, headers, sources):
        self.headers = headers
        self.named = {name for name in headers.structures if re.search(rf"\b{name}\b", sources)}
        self.calls = sorted(name for name in headers.calls if re.search(rf"\b{name}\b", sources))
        self.written = []

    def function(self, text):
        """A function of the headers, as a type of ctypes."""
        result, arguments = re.fullmatch(r"(\w+) ?\((.*)\)", text, re.S).groups()
        kinds = [self.kind(*self.split(part)) for part in arguments.split(",")]
        return f"CFUNCTYPE({', '.join(['None' if result == 'void' else self.kind(result, 0, []), *kinds])})"

    @staticmethod
    def split(declaration):
        """Type, number of stars, and sizes of a declaration; the name is dropped."""
        declaration = re.sub(r"\bconst\b", " ", declaration)
        sizes = re.findall(r"\[([^\]]*)\]", declaration)
        words = re.sub(r"\[[^\]]*\]", "", declaration)
        stars = words.count("*")
        words = words.replace("*", " ").split()
        return " ".join(words[:-1] if len(words) > 1 and words[-1] != "int" else words), stars, sizes

    def kind(self, name, stars, sizes):
        """A type of the headers as one of ctypes."""
        if stars and name in self.headers.functions:
            return self.function(self.headers.functions[name])
        if name in self.headers.enums:
            name = "int"
        known = NUMBERS.get(name)
        if name in self.named or (name in self.headers.structures and not stars):
            self.write(name)
            known = name
        if stars and (known == "c_char" and stars + len(sizes) >= 1):
            known, stars = "c_char_p", stars - 1
        elif stars and not known:
            known, stars = "c_void_p", stars - 1
        for _ in range(stars):
            known = f"POINTER({known})"
        for size in reversed(sizes):
            known = f"{known} * {self.headers.number(size)}" if known.isidentifier() else \
                f"({known}) * {self.headers.number(size)}"
        return known

    def parameter(self, declaration):
        """The type of a parameter: arrays are pointers. A function is passed as it is."""
        name, stars, sizes = self.split(declaration)
        if name in self.headers.functions:
            return "c_void_p"
        if name == "char" and stars == 2 and "const" not in declaration:  # text that the caller frees
            return "POINTER(c_void_p)"
        return self.kind(name, stars + len(sizes), [])

    def members(self, body):
        """Name and type of each member."""
        for line in filter(None, (" ".join(part.split()) for part in body.split(";"))):
            callback = re.fullmatch(r"(\w+) \(\*(\w+)\)\((.*)\)", line)
            if callback:
                yield callback[2], self.function(f"{callback[1]}({callback[3]})")
                continue
            first, *others = [part.strip() for part in line.split(",")]
            kind = re.match(r"(?:const )?[\w ]*?\w+(?= )[ ]", first)[0]
            for part in [first, *(kind + other for other in others)]:
                yield re.search(r"(\w+)(?:\[[^\]]*\])*$", part)[1], self.kind(*self.split(part))

    def write(self, name):
        """The class of a structure, once, after those that it is made of."""
        if any(name == other for other, _ in self.written):
            return
        members = list(self.members(self.headers.structures[name]))
        if not any(name == other for other, _ in self.written):
            pairs = ", ".join(f'("{member}", {kind})' for member, kind in members)
            self.written.append((name, f"class {name}(ctypes.Structure):\n{filled(f'    _fields_ = [{pairs}]', 16)}\n"))

    def text(self):
        calls = []
        for name in self.calls:
            result, arguments = self.headers.calls[name]
            kinds = [self.parameter(part) for part in arguments.split(",") if part.strip() != "void"]
            returned = "None" if result.strip() == "void" else self.kind(*self.split(result + " result"))
            calls.append(filled(f'    "{name}": ([{", ".join(kinds)}], {returned}),', 8) + "\n")
        for name in sorted(self.named):
            self.write(name)
        classes = "".join(f"\n\n{text}" for _, text in self.written)
        used = sorted(set(re.findall(r"\b(?:CFUNCTYPE|POINTER|c_\w+)\b", classes + "".join(calls))))
        return (f'"""What the package uses of the public headers. Written by tools/python/interface.py."""\n'
                f"import ctypes\nfrom ctypes import {', '.join(used[:8])}\nfrom ctypes import {', '.join(used[8:])}\n"
                f"from typing import Any, Dict, List, Tuple\n"
                f"{classes}\n\n#: Arguments and result of each call.\n"
                f"CALLS: Dict[str, Tuple[List[Any], Any]] = {{\n{''.join(calls)}}}\n")


texts = [path.read_text("utf-8") for path in sorted(PACKAGE.glob("*.py")) if path.name != "interface.py"]
print(Interface(Headers(sys.argv[1]), "\n".join(texts)).text(), end="")
