"""Mutants in programs that are linked already: the bytes of an instruction are replaced in a copy of the program.

A tree beside the one that is built has all its files as hard links; a program with a mutant is a new file there. So
what is built stays as it is, whenever a run stops."""

import os
import shutil
import subprocess

PROGRAMS = ("bin", "lib", "plugins", "tests/unit", "tests/bin")


def symbols(path):
    """{name: [(address, size)]} of the functions of a program or object."""
    found = {}
    text = subprocess.run(["nm", "-S", "--defined-only", path], capture_output=True, text=True, check=False).stdout
    for line in text.splitlines():
        words = line.split()
        if len(words) == 4 and words[2] in "tT":
            found.setdefault(words[3], []).append((int(words[0], 16), int(words[1], 16)))
    return found


def offset_of(path, address):
    """Where in a file an address of its code is."""
    text = subprocess.run(["readelf", "-lW", path], capture_output=True, text=True, check=True).stdout
    for line in text.splitlines():
        words = line.split()
        if words and words[0] == "LOAD":
            offset, start, size = (int(words[i], 16) for i in (1, 2, 4))
            if start <= address < start + size:
                return offset + address - start
    raise ValueError(f"{path} has no code at {address:x}")


class Programs:
    """All programs of a build, and where objects are in them."""

    def __init__(self, built, tree):
        self.built, self.tree, self.places, self.changed = built, tree, {}, []
        shutil.rmtree(tree, ignore_errors=True)
        for name in PROGRAMS + ("gen", "tests/oidn", "tests/web"):
            source = os.path.join(built, name)
            if os.path.isdir(source):
                shutil.copytree(source, os.path.join(tree, name), symlinks=True, copy_function=os.link)

    def all(self):
        """The names of the programs, but for unit tests."""
        found = []
        for folder in PROGRAMS:
            for name in sorted(os.listdir(os.path.join(self.built, folder))):
                path = os.path.join(self.built, folder, name)
                if folder != "tests/unit" and not os.path.islink(path) and not name.endswith((".a", ".d")):
                    found.append(f"{folder}/{name}")
        return found

    def place(self, program, path):
        """Where in a program's file the code of an object begins, or None where it is not in it."""
        if (program, path) in self.places:
            return self.places[program, path]
        if program not in self.places:
            self.places[program] = symbols(os.path.join(self.built, program))
        if path not in self.places:
            self.places[path] = symbols(path)
        votes = {}
        for name, own in self.places[path].items():
            for address, size in self.places[program].get(name, []):
                if size == own[0][1] and len(own) == 1:
                    votes[address - own[0][0]] = votes.get(address - own[0][0], 0) + size
        place = max(votes, key=votes.get) if votes else None
        total = sum(own[0][1] for own in self.places[path].values())
        if place is not None and votes[place] * 2 > total:
            place = offset_of(os.path.join(self.built, program), place)
        else:
            place = None  # only functions of the same name
        self.places[program, path] = place
        return place

    def change(self, program, path, change):
        """Write a mutant of an object into a program; whether the object is in it."""
        place = self.place(program, path)
        if place is None:
            return False
        with open(os.path.join(self.built, program), "rb") as file:
            data = bytearray(file.read())
        if data[place + change[0][0]] != change[0][1]:
            raise ValueError(f"{program}: the code of {path} is not where it should be")
        for offset, _, byte in change:
            data[place + offset] = byte
        copy = os.path.join(self.tree, program)
        os.unlink(copy)
        with open(copy, "wb") as file:
            file.write(data)
        os.chmod(copy, 0o755)
        self.changed.append(program)
        return True

    def restore(self):
        """All programs without a mutant again."""
        for program in self.changed:
            os.unlink(os.path.join(self.tree, program))
            os.link(os.path.join(self.built, program), os.path.join(self.tree, program))
        self.changed = []
