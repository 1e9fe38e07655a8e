"""More than two hundred uploads that are made to hurt, while others ask for pictures: all of them are answered in time, and
pictures come as ever."""
import http.client
import os
import queue
import random
import statistics
import struct
import subprocess
import sys
import threading
import time
import zlib

from serving import Tap, fetch

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
import decoder  # noqa: E402, the pictures of cli/decoder

DEADLINE, PICTURES = 20, 200
ENDINGS = ("jpg", "tif", "exr", "bmp", "gif", "hdr", "tga", "webp", "avif", "heic", "jp2", "dpx", "fits", "ico", "iff", "ppm",
           "rla", "sgi", "tif several", "exr several", "gif several")


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(width, height, extra=b"", data=b"\0" * 99, depth=8, colour=0):
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)) +
            extra + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b""))


def made_to_hurt(work):
    """Pictures whose headers promise more than they have, or ask for more than anybody should give."""
    at, pictures = os.path.join(work, "made"), []

    def take(make, *arguments, **options):
        make(at, *arguments, **options)
        with open(at, "rb") as file:
            pictures.append(file.read())
    for tile in 16, 256, 4096, 4112, 30000, 40000, 65520, 1 << 20, 1 << 30:
        for channels, bits in (1, 8), (3, 16), (4, 32):
            take(decoder.tiff, 8, 8, channels, bits, zlib.compress(b""), tile=tile)
    for channels in 5, 64, 65, 128, 1000, 4096:
        for width in 8, 1000:
            take(decoder.tiff, width, width, channels, 8, zlib.compress(bytes(width * width * min(channels, 16))))
    for width, height in (1, 65535), (65535, 1), (65535, 65535), (5000, 5000), (0, 0), (1 << 31, 1 << 31):
        take(decoder.tiff, width, height, 3, 8, zlib.compress(bytes(1 << 20)))
    for scans in 2, 50, 199, 200, 201, 2000, 6000:
        take(decoder.jpeg, 64, 64, scans)
        take(decoder.jpeg, 4900, 5000, scans)
    for megabytes in 1, 100, 1000, 4000:
        take(decoder.png, megabytes)
    bomb = zlib.compress(bytes(60 << 20))
    for kind, start in (b"zTXt", b"a\0\0"), (b"iCCP", b"a\0\0"), (b"iTXt", b"a\0\1\0\0\0"):
        for count in 1, 20:
            pictures.append(png(8, 8, chunk(kind, start + bomb) * count))
    for width, height in (1 << 30, 1 << 30), (65536, 65536), (5000, 5000), (25000000, 1):
        for depth, colour in (8, 2), (16, 6), (1, 0):
            pictures.append(png(width, height, depth=depth, colour=colour))
    pictures.append(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999 +X 99999999\n" + bytes(99))
    pictures.append(b"#?RADIANCE\n" + b"A=B\n" * 100000 + b"\n-Y 8 +X 8\n" + bytes(256))
    for count in 1, 50000:  # frames
        pictures.append(b"GIF89a\x08\0\x08\0\x80\0\0\0\0\0\xff\xff\xff" +
                        b",\0\0\0\0\x08\0\x08\0\0\2\7\x84\x8f\xa9\xcb\xed\x0f\xa3\0" * count + b";")
    for size in 30000, 1 << 30:
        pictures.append(b"BM" + struct.pack("<IIIIiiHHIIiiII", 99, 0, 1078, 40, size, size, 1, 8, 0, 0, 0, 0, 0, 0) + bytes(1200))
    return pictures


def damaged(rng, work, reference, count):
    """Good pictures of all formats that OpenImageIO writes, and of several subimages, with some bytes changed, most of
    them near the beginning."""
    good, pictures = [reference], []
    for ending in ENDINGS:
        name, picture = os.path.join(work, "good." + ending.split()[0]), ["--pattern", "fill:topleft=1,0,0:bottomright=0,1,1",
                                                                          "96x64", "3"]
        several = picture + ["--siappend"] if ending.endswith("several") else []
        subprocess.run(["oiiotool", *picture, *several, "-d", "half" if ending[:3] == "exr" else "uint8", "-o", name],
                       check=True)
        with open(name, "rb") as file:
            good.append(file.read())
    for number in range(count):
        data = bytearray(good[number % len(good)])
        for _ in range(rng.randrange(1, 9)):
            data[min(int(rng.expovariate(1 / 200)) + 4, len(data) - 1)] = rng.choice([0, 1, 0x7f, 0xff, rng.randrange(256)])
        pictures.append(bytes(data))
    return pictures


def ask(server, client, path, body=None):
    """By a client of its own address: status, body and seconds."""
    began = time.monotonic()
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60,
                                            source_address=(f"127.0.0.{2 + client % 20}", 0))
    connection.request("POST" if body is not None else "GET", path, body)
    reply = connection.getresponse()
    result = reply.status, reply.read(), time.monotonic() - began
    connection.close()
    return result


def run_all(jobs, count):
    """Run functions on so many threads; their results in order."""
    waiting, results = queue.Queue(), [None] * len(jobs)
    for number, job in enumerate(jobs):
        waiting.put((number, job))

    def work():
        while True:
            try:
                number, job = waiting.get_nowait()
            except queue.Empty:
                return
            try:
                results[number] = job(number)
            except OSError as error:
                results[number] = (0, str(error).encode(), 0)
    threads = [threading.Thread(target=work) for _ in range(count)]
    for thread in threads:
        thread.start()
    return threads, results


def pictures_of(server):
    """Ordinary pictures of a texture of the server, each another one."""
    return [lambda n, k=k: ask(server, n, f"/v1/small/Floor=brick;Wall=rgb(.2,{k / 1000:.3f},.3)/320x.jpg")
            for k in range(PICTURES)]


def p99(results):
    return statistics.quantiles([seconds for _, _, seconds in results], n=100)[98]


def check(server, quiet, folder, work, reference):
    """The quiet server is one that nobody sends anything: for the right pictures, and their times."""
    rng = random.Random(5)
    crafted = made_to_hurt(work)
    crafted += damaged(rng, work, reference, 230 - len(crafted))
    for each in server, quiet:
        fetch(each.port, "/v1/small/Floor=brick/full.png")
    threads, before = run_all(pictures_of(quiet), PICTURES)
    for thread in threads:
        thread.join()
    senders, sent = run_all([lambda n, body=body: ask(server, n, "/v1/uploads", body) for body in crafted], 12)
    threads, meanwhile = run_all(pictures_of(server), PICTURES)
    for thread in threads + senders:
        thread.join()
    Tap.result(server.is_alive(), "the server lives")
    wrong = [(status, round(seconds, 1)) for status, _, seconds in sent
             if status not in (200, 201, 413, 415, 503, 507) or seconds > DEADLINE + 5]
    Tap.result(not wrong, f"{len(crafted)} uploads are answered within the deadline", str(wrong))
    counts = {status: sum(status == s[0] for s in sent) for status in sorted({s[0] for s in sent})}
    Tap.note(f"uploads by status {counts}, the slowest {max(s[2] for s in sent):.1f} s")
    Tap.result(all(m[0] == 200 for m in meanwhile), "pictures are made meanwhile", str([m[0] for m in meanwhile]))
    Tap.result([m[1] for m in meanwhile] == [b[1] for b in before], "each is right")
    Tap.note(f"99 of 100 pictures within {p99(before):.3f} s without uploads, {p99(meanwhile):.3f} s with")
    Tap.result(p99(meanwhile) < 3 * p99(before) + 0.05, "and takes at most three times as long")
    Tap.result(not [name for name in os.listdir(folder) if name.startswith(".")], "nothing incomplete is left")
