"""Checks of retex-serve, as TAP: check.py ROOMS TEXTURES REFERENCE.png WORK SECONDS PART…

ROOMS has small.retex, of 480x270 with the targets Floor and Wall, and large.retex, of 1920x1080. REFERENCE.png is the
small room with the texture `brick` on Floor. SECONDS is the time of long parts. PART: iiif, abuse, strangers,
load, nginx, unit."""
import os
import sys

import abuse
import iiif
import load
import proxy
import strangers
import unit_file
from serving import Server, Tap


def main():
    rooms, textures, reference, work, seconds, *parts = sys.argv[1:]
    seconds, log = int(seconds), os.path.join(work, "server.log")
    if "iiif" in parts:
        server = Server(rooms, textures, log=log)
        iiif.check(server.port, "small;Floor=brick", reference, work)
        server.stop()
    if "abuse" in parts:
        server = Server(rooms, textures, "--timeout", "2", "-q", log=log)
        abuse.check(server, 10000)
        server.stop()
        folder = os.path.join(work, "uploads")
        os.makedirs(folder, exist_ok=True)
        server = Server(rooms, textures, "--timeout", "2", "--uploads", folder, "-q", log=log)
        with open(reference, "rb") as file:
            abuse.check_uploads(server, folder, file.read(), 2000)
        server.stop()
    if "strangers" in parts:
        folder = os.path.join(work, "strangers")
        os.makedirs(folder, exist_ok=True)
        server = Server(rooms, textures, "--uploads", folder, "--deadline", str(strangers.DEADLINE), "-q", log=log)
        with open(reference, "rb") as file:
            quiet = Server(rooms, textures, "-q", log=log)
            strangers.check(server, quiet, folder, work, file.read())
        server.stop()
        quiet.stop()
    if "load" in parts:
        server = Server(rooms, textures, "--picture-memory", "16", "--per-client", "0", "-q", log=log)
        load.check_clients(server, seconds, work)
        server.stop()
        load.check_queue(rooms, textures, log)
        load.check_kills(rooms, textures, log, 5)
        load.check_throughput(rooms, textures, work, log, 60)
    if "nginx" in parts:
        proxy.check(rooms, textures, work, log)
    if "unit" in parts:
        unit_file.check(work)
    Tap.finish()


main()
