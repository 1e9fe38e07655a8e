"""One run of a program: measure.py RECORDS KEY=VALUE... -- retex-render OPTIONS... -o OUT SCENE

Appends a line of JSON to RECORDS: the keys, wall and processor seconds of the whole process, the size of OUT in bytes
and what --stats says. Without an OUT, or where the program fails, that is in it too, for a render that is refused tells
something as well. It imports little: what this process had in memory would count as the program's peak.
"""
import json
import os
import sys
import time


def main(records, *rest):
    split = rest.index("--")
    record, command = dict(pair.split("=", 1) for pair in rest[:split]), list(rest[split + 1:])
    out = command[command.index("-o") + 1]
    stats = records + ".stats"
    for path in (stats, out):
        if os.path.exists(path):
            os.remove(path)
    began = time.monotonic()
    process = os.posix_spawnp(command[0], [command[0], "-q", "--stats", stats, *command[1:]], os.environ)
    _, status, used = os.wait4(process, 0)
    record["wall"], record["cpu"] = time.monotonic() - began, used.ru_utime + used.ru_stime
    record["status"] = os.waitstatus_to_exitcode(status)
    if not record["status"]:
        record["bytes"] = os.path.getsize(out)
        with open(stats, encoding="ascii") as file:
            record.update(json.load(file))
    with open(records, "a", encoding="ascii") as file:
        file.write(json.dumps(record) + "\n")
    named = " ".join(rest[:split])
    print(f"{named}: {record['wall']:.2f} s, {record['cpu']:.2f} s of processors", file=sys.stderr)
    if record["status"]:
        sys.exit(f"{named}: {command[0]} failed")


main(*sys.argv[1:])
