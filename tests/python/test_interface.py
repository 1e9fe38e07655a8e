"""The structures and calls that the package declares are those of the public headers."""
import ctypes
import glob
import os
import re

import lib

from retex import interface, library

HEADERS = lib.ROOT + "/tools/libretex/include"
CC = os.environ.get("CC", "gcc")


def text_of_headers():
    text = ""
    for path in sorted(glob.glob(HEADERS + "/retex/*.h")):
        with open(path, encoding="utf-8") as file:
            text += file.read()
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.S)


def compiled(lines):
    """What a C program prints that includes the headers."""
    with open("probe.c", "w", encoding="utf-8") as file:
        file.write("#include <stdio.h>\n#include <stddef.h>\n#include <retex/retex.h>\nint main(void)\n{\n")
        file.write("\n".join(lines) + "\n    return 0;\n}\n")
    lib.run(*CC.split(), "-std=c11", "-I" + HEADERS, "probe.c", "-o", "probe")
    return lib.run("./probe").splitlines()


def test_structures():
    """Sizes, and places and sizes of all members, of the structures"""
    structures = [kind for kind in vars(interface).values() if isinstance(kind, type(ctypes.Structure))]
    assert len(structures) > 10
    for structure in structures:
        name = structure.__name__
        fields = [field for field, _ in structure._fields_]
        expected = [f"{name} {ctypes.sizeof(structure)}"]
        lines = [f'    printf("{name} %zu\\n", sizeof({name}));']
        for field in fields:
            place = getattr(structure, field)
            expected.append(f"{name}.{field} {place.offset} {place.size}")
            lines.append(f'    printf("{name}.{field} %zu %zu\\n", offsetof({name}, {field}), '
                         f"sizeof((({name} *)0)->{field}));")
        assert compiled(lines) == expected, name
        body = re.search(r"typedef struct " + name + r" \{(.*?)\}", text_of_headers(), re.S)
        in_header = re.findall(r"(\w+)(?:\[[^\]]*\])*(?=[,;])",
                               re.sub(r"\(\*(\w+)\)\([^)]*\)", r"\1", body[1]))
        assert in_header == fields, (name, in_header)


def test_constants():
    """Codes of errors and other numbers"""
    names = [code.name for code in library.Code]
    lines = [f'    printf("{name} %d\\n", RETEX_{name});' for name in names]
    assert compiled(lines) == [f"{code.name} {code.value}" for code in library.Code]
    assert sorted(re.findall(r"\bRETEX_(E[A-Z]+) = -", text_of_headers())) == sorted(names)
    assert compiled(['    printf("%d %d\\n", RETEX_MAX_TARGETS, RETEX_PICTURE_STRIP);']) == \
        [f"{library.MAX_TARGETS} {library.STRIP}"]


def test_written():
    """Structures and calls are those that the headers have now"""
    made = lib.run("/usr/bin/python3", lib.PACKAGE + "/interface.py", HEADERS)
    with open(lib.PACKAGE + "/retex/interface.py", encoding="utf-8") as file:
        assert made == file.read(), "run tools/python/interface.py tools/libretex/include >tools/python/retex/interface.py"


def kind_of(text):
    """A C parameter or result as a class of ctypes, roughly: pointers are pointers."""
    text = text.strip()
    if "*" in text or "[" in text or text.startswith("RetexRowSink"):
        return "pointer"
    names = {"int": "c_int", "uint64_t": "c_ulong", "size_t": "c_ulong", "void": "None"}
    return names[text.rsplit(" ", 1)[0] if " " in text else text]


def kind_in_python(kind):
    if kind is None:
        return "None"
    pointers = (ctypes._Pointer, ctypes.c_void_p, ctypes.c_char_p)
    return "pointer" if issubclass(kind, pointers) else kind.__name__


def test_calls():
    """Results and arguments of the calls"""
    text = text_of_headers()
    assert len(interface.CALLS) > 50
    for name, (arguments, result) in interface.CALLS.items():
        prototype = re.search(r"\n((?:const )?\w+ \**)" + name + r"\(([^;]*?)\);", text)
        assert prototype, name
        expected = [kind_of(part) for part in prototype[2].split(",")]
        assert [kind_in_python(kind) for kind in arguments] == expected, (name, expected)
        assert kind_in_python(result) == kind_of(prototype[1].strip()), name


def test_version():
    """The version is that of the tools"""
    import retex
    assert lib.run("retex", "--version") == f"retex {retex.__version__}\n"
    with open(lib.PACKAGE + "/pyproject.toml", encoding="utf-8") as file:
        assert f'\nversion = "{retex.__version__}"\n' in file.read()


lib.main(globals())
