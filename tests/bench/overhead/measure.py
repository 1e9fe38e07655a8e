"""One run of a program: measure.py RECORDS KEY=VALUE... -- retex-render OPTIONS... -o OUT SCENE

Appends a line of JSON to RECORDS: the keys, wall and processor seconds of the whole process, processor seconds until
the scene was read and prepared (reading_cpu), the size of OUT in bytes and what --stats says. Where the program fails,
status tells, for a render that is refused tells something as well. This imports little: what it has in memory would
count as the program's peak.
"""
import json
import os
import sys
import threading
import time

TICK = 0.02


def watch(process, began, seen, over):
    """Processor time so far, every tick, for nothing tells afterwards how much of it was reading."""
    ticks = os.sysconf("SC_CLK_TCK")
    while not over.wait(TICK):
        try:
            with open(f"/proc/{process}/stat", encoding="ascii") as file:
                used = file.read().rpartition(")")[2].split()[11:13]
        except OSError:
            return
        seen.append((time.monotonic() - began, sum(map(int, used)) / ticks))


def until(moment, seen):
    return next((cpu for at, cpu in seen if at >= moment), 0 if not seen else seen[-1][1])


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
    seen, over = [], threading.Event()
    watcher = threading.Thread(target=watch, args=(process, began, seen, over))
    watcher.start()
    _, status, used = os.wait4(process, 0)
    record["wall"], record["cpu"] = time.monotonic() - began, used.ru_utime + used.ru_stime
    over.set()
    watcher.join()
    record["status"] = os.waitstatus_to_exitcode(status)
    if not record["status"]:
        record["bytes"] = os.path.getsize(out)
        with open(stats, encoding="ascii") as file:
            record.update(json.load(file))
        record["reading_cpu"] = until(record["parse_seconds"] + record["build_seconds"], seen)
    with open(records, "a", encoding="ascii") as file:
        file.write(json.dumps(record) + "\n")
    named = " ".join(rest[:split])
    print(f"{named}: {record['wall']:.2f} s, {record['cpu']:.2f} s of processors", file=sys.stderr)
    if record["status"]:
        sys.exit(f"{named}: {command[0]} failed")


main(*sys.argv[1:])
