"""Damages the level in the pack l.retex, for levels.t: levels.py byte|other|none OUTPUT.

byte: a byte of its part radiance/dep_Left_sharp.jpg is another; other: another pack is in its place, n.retex; none: it is missing.
"""
import io
import struct
import sys
import zipfile

what, path = sys.argv[1:]
old = zipfile.ZipFile("l.retex")
level = old.getinfo("level-3.retex")
if what == "byte":
    data = bytearray(open("l.retex", "rb").read())
    part = old.read(level)
    start = data.index(part)
    with zipfile.ZipFile(io.BytesIO(part)) as inner:
        entry = inner.getinfo("radiance/dep_Left_sharp.jpg")
    name, extra = struct.unpack_from("<HH", part, entry.header_offset + 26)
    data[start + entry.header_offset + 30 + name + extra + entry.compress_size // 2] ^= 1
    open(path, "wb").write(data)
else:
    with zipfile.ZipFile(path, "w") as new:
        for entry in old.infolist():
            if entry.filename != level.filename:
                new.writestr(entry, old.read(entry))
            elif what == "other":
                new.writestr(entry, open("n.retex", "rb").read())
