#!/usr/bin/python3
"""The public headers as an older release may have had them: shorten.py HEADERS FOLDER

Copies them into FOLDER, where every struct that begins with its size has lost its last member, and as many before it as
make it smaller: a member that lies in the padding of a struct cannot be told to be missing. Prints the calls that take
or fill such a struct."""
import os
import re
import subprocess
import sys

STRUCT = re.compile(r"typedef struct (Retex\w+) \{\s*size_t size;(.*?)\} \1;\s*"
                    r"(?:#define (RETEX_\w+_INIT)((?:[^\n]*\\\n)*[^\n]*))?", re.S)


def split(text, separator):
    """The pieces of a text between separators that are in no brackets."""
    pieces, depth = [""], 0
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        if letter == separator and not depth:
            pieces.append("")
        else:
            pieces[-1] += letter
    return pieces


def members(body):
    """One declaration a member."""
    made = []
    for declaration in split(re.sub(r"/\*.*?\*/", "", body, flags=re.S), ";")[:-1]:
        first, *more = split(declaration, ",")
        kind = re.match(r"\s*(?:const |unsigned |struct )*\w+", first).group(0)
        made += [first] + [kind + one for one in more]
    return made


def shorten(text, lost):
    def replace(match):
        name, body, macro, init = match.groups()
        kept = members(body)[:-lost[name]] if lost[name] else members(body)
        shorter = "".join(f"{one.strip()};\n" for one in ["size_t size", *kept])
        shorter = f"typedef struct {name} {{\n{shorter}}} {name};\n"
        if not macro:  # what the library fills
            return shorter
        values = split(init.replace("\\\n", " ").strip()[1:-1], ",")[:1 + len(kept)]
        return shorter + f"#define {macro} {{ {','.join(values)} }}\n"
    return STRUCT.sub(replace, text)


def write(headers, folder, lost):
    for path, text in headers.items():
        os.makedirs(os.path.dirname(f"{folder}/{path}"), exist_ok=True)
        with open(f"{folder}/{path}", "w", encoding="utf-8") as file:
            file.write(shorten(text, lost))


def sizes(folder, names):
    program = f"{folder}/sizes"
    text = '#include <retex/retex.h>\n#include <stdio.h>\nint main(void)\n{\n' + "".join(
        f'printf("%zu\\n", sizeof({name}));\n' for name in names) + "}\n"
    subprocess.run([*os.environ.get("CC", "cc").split(), "-I" + folder, "-xc", "-", "-o", program], input=text, text=True,
                   check=True)
    return [int(line) for line in subprocess.check_output([program], text=True).split()]


source, target = sys.argv[1:]
found = {}
for root, _, files in os.walk(source):
    for one in files:
        with open(f"{root}/{one}", encoding="utf-8") as file:
            found[os.path.relpath(f"{root}/{one}", source)] = file.read()
structs = [match.group(1) for text in found.values() for match in STRUCT.finditer(text)]
losses = dict.fromkeys(structs, 0)
write(found, target, losses)
whole = sizes(target, structs)
losses = dict.fromkeys(structs, 1)
while True:
    write(found, target, losses)
    same = [name for name, now, then in zip(structs, sizes(target, structs), whole) if now == then]
    if not same:
        break
    for name in same:
        losses[name] += 1
taking = re.compile(r"\b(retex_\w+)\([^;{]*?\b(?:" + "|".join(structs) + r")\b[^;{]*?\);")
print("\n".join(sorted({name for text in found.values()
                        for name in taking.findall(re.sub(r"/\*.*?\*/", "", text, flags=re.S))})))
