"""What requests cost retex-serve, as CSV: costs.py ROOMS TEXTURES WORK SECONDS COUNT OUT.csv

ROOMS has small.retex, of 480x270 with the targets Floor and Wall, and large.retex, of 1920x1080. COUNT is the number of
new pictures of each kind; SECONDS is how long 64 clients of wrk ask. Processor time is what the server says that it has
used; times by the clock depend on what else the machine does."""
import csv
import http.client
import os
import random
import sys

import load
from serving import Server, fetch, metric

KINDS = {"full.jpg": "/v1/large/{}/full.jpg", "full.png": "/v1/large/{}/full.png",
         "full.webp": "/v1/large/{}/full.webp", "640x.jpg": "/v1/large/{}/640x.jpg",
         "tile": "/iiif/3/large;{}/512,512,512,512/max/0/default.jpg"}
REPEATS = 500  # of answers that need no picture


class Costs:
    def __init__(self, rooms, textures, log, count):
        self.names = sorted(os.path.splitext(name)[0] for name in os.listdir(textures))
        self.rng, self.count, self.figures = random.Random(4), count, []
        self.server = Server(rooms, textures, "--threads", "1", "--picture-memory", "512", "-q", log=log)

    def new_edits(self):
        return f"Floor={self.rng.choice(self.names)};Wall=rgb({load.color(self.rng)})"

    def measure(self, what, paths, status=200, headers=None):
        """Processor time and bytes of an answer, means of all paths, on one connection."""
        connection, received = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=600), 0
        before = metric(self.server, "processor_seconds_total")
        for path in paths:
            connection.request("GET", path, headers=headers or {})
            reply = connection.getresponse()
            received += len(reply.read())
            if reply.status != status:
                sys.exit(f"{what}: {path}: {reply.status}")
        seconds = metric(self.server, "processor_seconds_total") - before
        connection.close()
        self.add(what, processor_ms=1000 * seconds / len(paths), bytes=received / len(paths))

    def add(self, what, **figures):
        self.figures += [(what, name, f"{value:.6g}") for name, value in figures.items()]

    def measure_all(self):
        self.measure("first", [KINDS["full.jpg"].format(self.new_edits())])
        for name in self.names:  # so that all images are read
            fetch(self.server.port, f"/v1/large/Floor={name};Wall=rgb(0,0,0)/64x.jpg")
        for what, path in KINDS.items():
            self.measure(what, [path.format(self.new_edits()) for _ in range(self.count)])
        kept = KINDS["full.jpg"].format("Floor=" + self.names[0])
        etag = fetch(self.server.port, kept)["ETag"]
        self.measure("kept", [kept] * REPEATS)
        self.measure("304", [kept] * REPEATS, 304, {"If-None-Match": etag})
        self.server.stop()


def main():
    rooms, textures, work, seconds, count, out = sys.argv[1:]
    log = os.path.join(work, "server.log")
    costs = Costs(rooms, textures, log, int(count))
    costs.measure_all()
    server = Server(rooms, textures, "--picture-memory", "16", "--per-client", "0", "-q", log=log)
    _, figures = load.measure_clients(server, int(seconds), work)
    server.stop()
    costs.add("clients", seconds=int(seconds), **figures)
    for what, rows in ("batch", 5 * int(count)), ("batch-short", 2 * int(count)):
        ratios, same = load.measure_throughput(rooms, textures, work, log, rows)
        if not same:
            sys.exit("the server's pictures are not the batch's")
        costs.add(what, rows=rows, least=ratios[0], median=ratios[1], most=ratios[-1])
    with open(out, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["what", "figure", "value"])
        table.writerows(costs.figures)


main()
