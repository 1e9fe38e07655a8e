"""Runs of a program: measure.py RECORDS KEY=VALUE... -- RUN [-- RUN]..., a RUN being KEY=VALUE... retex-render ... -o OUT

Several runs take turns, a tenth of a second each on all cores, while the others are stopped: so the machine's speed,
which may move by a fifth within seconds, is the same for all. Each needs an OUT of its own.

Appends a line of JSON to RECORDS for each run: the keys, those of all and its own; wall seconds, while it was not
stopped, and processor seconds of the whole process; processor seconds until the scene was read and prepared
(reading_cpu), the size of OUT in bytes and what --stats says. Where the program fails, status tells, for a render that
is refused tells something as well. This imports little: what it has in memory would count as the program's peak.
"""
import itertools
import json
import os
import select
import signal
import sys
import threading
import time

TICK = 0.02
SLICE = 0.1


class Run:
    """A process that goes on for a slice at a time."""

    def __init__(self, words, stats):
        first = next(i for i, word in enumerate(words) if "=" not in word)
        self.keys, self.command = dict(pair.split("=", 1) for pair in words[:first]), words[first:]
        self.out, self.stats = self.command[self.command.index("-o") + 1], stats
        self.process, self.status, self.wall, self.used = 0, None, 0, None
        self.seen = []
        for path in (self.stats, self.out):
            if os.path.exists(path):
                os.remove(path)

    def start(self):
        self.began = time.monotonic()
        self.process = os.posix_spawnp(
            self.command[0], [self.command[0], "-q", "--stats", self.stats, *self.command[1:]], os.environ)
        self.ended = select.poll()
        self.ended.register(os.pidfd_open(self.process), select.POLLIN)
        threading.Thread(target=self.watch, daemon=True).start()

    def watch(self):
        """Processor time so far, every tick, for nothing tells afterwards how much of it was reading."""
        ticks = os.sysconf("SC_CLK_TCK")
        while self.status is None:
            try:
                with open(f"/proc/{self.process}/stat", encoding="ascii") as file:
                    used = file.read().rpartition(")")[2].split()[11:13]
            except OSError:
                return
            self.seen.append((time.monotonic() - self.began, sum(map(int, used)) / ticks))
            time.sleep(TICK)

    def go_on(self, alone):
        """For a slice, or to its end where it is alone: whether it ended."""
        began = time.monotonic()
        if self.process:
            os.kill(self.process, signal.SIGCONT)
        else:
            self.start()
        ended = bool(self.ended.poll(None if alone else 1000 * SLICE))
        if ended:
            _, self.status, self.used = os.wait4(self.process, 0)
        else:
            os.kill(self.process, signal.SIGSTOP)
        self.wall += time.monotonic() - began
        return ended

    def record(self):
        found = self.keys | {"wall": self.wall, "cpu": self.used.ru_utime + self.used.ru_stime,
                             "status": os.waitstatus_to_exitcode(self.status)}
        if not found["status"]:
            found["bytes"] = os.path.getsize(self.out)
            with open(self.stats, encoding="ascii") as file:
                found |= json.load(file)
            read = found["parse_seconds"] + found["build_seconds"]
            found["reading_cpu"] = next((cpu for at, cpu in self.seen if at >= read),
                                        self.seen[-1][1] if self.seen else 0)
        return found


def take_turns(runs):
    going = runs
    try:
        while going:
            going = [run for run in going if not run.go_on(len(going) == 1)]
    finally:
        for run in going:
            if run.process and run.status is None:
                os.kill(run.process, signal.SIGKILL)


def main(records, *rest):
    groups = [list(words) for split, words in itertools.groupby(rest, lambda word: word == "--") if not split]
    keys = dict(pair.split("=", 1) for pair in groups[0])
    runs = [Run(words, f"{records}.stats-{number}") for number, words in enumerate(groups[1:])]
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    take_turns(runs)
    failed = []
    for run in runs:
        record = keys | run.record()
        with open(records, "a", encoding="ascii") as file:
            file.write(json.dumps(record) + "\n")
        named = " ".join(f"{key}={value}" for key, value in (keys | run.keys).items())
        print(f"{named}: {record['wall']:.2f} s, {record['cpu']:.2f} s of processors", file=sys.stderr)
        if record["status"]:
            failed.append(f"{named}: {run.command[0]} failed")
    if failed:
        sys.exit("\n".join(failed))


main(*sys.argv[1:])
