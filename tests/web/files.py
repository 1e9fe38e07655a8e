"""Checks a folder that retex-pack --web wrote, whose messages are standard input: files.py FOLDER. Sizes and checksums
are those of the manifest and of those of smaller rooms, each file is named once, the sizes that were printed are the files',
and there are no other files than the player's."""
import json
import os
import re
import sys
import zlib

folder = sys.argv[1]
printed = sys.stdin.read()  # until retex-pack has ended
with open(f"{folder}/room.json", encoding="utf-8") as file:
    room = json.load(file)
def files_of(room):
    return [room["picture"], room["reduced"], *room["lights"], *room["classes"]]


entries = files_of(room)
for smaller in room.get("smaller", []):
    with open(f"{folder}/{smaller['file']}", encoding="utf-8") as file:
        other = json.load(file)
    assert (other["width"], other["height"], other["id"]) == (smaller["width"], smaller["height"], room["id"])
    entries += [smaller, *files_of(other)]
assert len({e["file"] for e in entries}) == len(entries), sorted(e["file"] for e in entries)
for entry in entries:
    with open(f"{folder}/{entry['file']}", "rb") as file:
        data = file.read()
    assert (len(data), zlib.crc32(data)) == (entry["bytes"], entry["crc32"]), entry["file"]
total, still, first = map(int, re.findall(r" (\d+) ", printed.splitlines()[1]))
own = os.path.getsize(f"{folder}/room.json")
assert total == own + sum(e["bytes"] for e in files_of(room))
assert still == own + room["picture"]["bytes"] and still < first < total
print(*sorted(set(os.listdir(folder)) - {e["file"] for e in entries}))
