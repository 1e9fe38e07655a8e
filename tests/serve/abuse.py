"""Ten thousand requests that are none: each is answered by a status 4xx, or its connection is closed."""
import hashlib
import os
import random
import re
import socket
import threading
import time

from serving import Tap, fetch, wait_until

BAD_PARTS = ["%2e%2e", "..", "%2F", "a%2Fb", "%5C", "%00", "a%00b", "%0d%0aX:y", "%C0%AF", "%C0%AE%C0%AE", "%ED%A0%80",
             "%FF", "%", "%4", "%zz", "%F4%90%80%80", "%C2%85", "a\\b", "%252e%252e%252f", "A" * 5000, "%41" * 1400,
             "*", "~root", "%7Eroot", "a%22b", "<script>", "%3Cscript%3E", "\xe4", "\x01", "%E2%80"]
TEMPLATES = ["/v1/{}", "/v1/{}/full.jpg", "/v1/small/Floor={}/full.jpg", "/v1/small/Floor=brick/{}",
             "/v1/small/Floor=brick;{}/full.jpg", "/v1/small/full.jpg?{}", "/v1/small/full.jpg?crop={}",
             "/iiif/3/{}", "/iiif/3/{}/info.json", "/iiif/3/small;Floor={}/full/max/0/default.jpg",
             "/iiif/3/small/{}/max/0/default.jpg", "/iiif/3/small/full/{}/0/default.jpg",
             "/iiif/3/small/full/max/{}/default.jpg", "/iiif/3/small/full/max/0/{}", "/{}", "/v1/../../{}",
             "/v1/small/../{}/passwd", "/../../../../etc/passwd{}"]
WRONG_URLS = ["/v1/small/99999x99999.jpg", "/v1/small/999999999x.jpg", "/v1/small/0x0.jpg", "/v1/small/x.jpg",
              "/v1/small/99999999999999999999x1.jpg", "/v1/small/-1x-1.jpg", "/v1/small/1e9x.jpg", "/v1/small/full.exe",
              "/v1/nothing/full.jpg", "/v1/small/Nothing=brick/full.jpg", "/v1/small/Floor=nothing/full.jpg",
              "/v1/small/Floor=rgb(nan,0,0)/full.jpg", "/v1/small/Floor=rgb(1e999,0,0)/full.jpg",
              "/v1/small/Floor=brick;floor=brick/full.jpg", "/v1/small/Floor=brick/full.jpg?Floor.scale=0",
              "/v1/small/Floor=brick/full.jpg?Floor.scale=1e400", "/v1/small/Floor=brick/full.jpg?Floor.wrap=x",
              "/v1/small/Floor=brick/full.jpg?Floor.colorspace=nothing", "/v1/small/Floor=%2Fetc%2Fpasswd/full.jpg",
              "/v1/small/full.jpg?crop=0,0,0,0", "/v1/small/full.jpg?crop=480,0,1,1", "/v1/small/full.jpg?quality=101",
              "/iiif/3/small/0,0,0,0/max/0/default.jpg", "/iiif/3/small/full/99999999,/0/default.jpg",
              "/iiif/3/small/pct:0,0,1e3,1/max/0/default.jpg", "/iiif/3/small/full/max/1e1/default.jpg",
              "/iiif/2/small/info.json", "//", "/v1//small", "/.git/config", "/index.html", "*",
              "http://x/v1", "v1", ""]


def request(line, *headers, end=b"\r\n\r\n"):
    text = [line.encode("latin-1") if isinstance(line, str) else line, b"Host: x", b"Connection: close", *headers]
    return b"\r\n".join(text) + end


def malformed(rng):
    """The bytes of one request; None at its end: the client closes in the middle."""
    kind = rng.randrange(12)
    good = "GET /v1/small/64x.jpg HTTP/1.1"
    if kind < 5:
        url = rng.choice(TEMPLATES).format(rng.choice(BAD_PARTS))
        if rng.random() < 0.3:
            url += rng.choice(["/", "?", "&", ";", "%", "=", "?a=b&c", "/.."]) + rng.choice(BAD_PARTS)
        return request(f"{rng.choice(['GET', 'GET', 'HEAD'])} {url} HTTP/1.1")
    if kind == 5:
        return request(f"GET {rng.choice(WRONG_URLS)} HTTP/1.1")
    if kind == 6:  # bytes
        return bytes(rng.randrange(256) for _ in range(rng.randrange(1, 400))) + b"\r\n\r\n"
    if kind == 7:  # another method, or none
        return request(f"{rng.choice(['POST', 'PUT', 'DELETE', 'PATCH', 'TRACE', 'CONNECT', 'get', 'PRI', 'A' * 300])} "
                       "/v1/small/64x.jpg HTTP/1.1", b"Content-Length: 0")
    if kind == 8:  # bodies
        return request(good, rng.choice([b"Content-Length: 99999999999999999999", b"Content-Length: -1",
                                         b"Content-Length: 5", b"Content-Length: x", b"Transfer-Encoding: chunked",
                                         b"Transfer-Encoding: chunked\r\nContent-Length: 3"])) + b"zzz\r\n\r\n"
    if kind == 9:  # headers without end, or too large
        return request(good, *[b"X-%d: %s" % (i, b"y" * 1000) for i in range(100)])
    if kind == 10:  # half a request
        whole = request(good)
        return whole[:rng.randrange(1, len(whole) - 4)], None
    return request(rng.choice(["GET", "GET /", "GET / HTTP/9.9", "GET  / HTTP/1.1", "GET /v1/small x HTTP/1.1",
                               "GET /\x00 HTTP/1.1", "\x16\x03\x01\x02", "GET / HTTP/1.1\r\nHost", " GET / HTTP/1.1",
                               "GET /v1/\u00e4 HTTP/1.1", "GET / HTTP/", "GET / JUNK/1.1"]))


def malformed_upload(rng, image):
    """An upload that is none: damaged, cut, with wrong lengths, or chunks that are none."""
    body = bytearray(image)
    kind = rng.choice([0, 0, 0, 0, 1, 1, 2, 2, 2, 3, 4, 5, 6, 7])
    if kind == 0:  # damaged at some places, its header among them
        for _ in range(rng.randrange(1, 40)):
            body[rng.randrange(min(len(body), rng.choice([64, 700, len(body)])))] = rng.randrange(256)
    elif kind == 1:
        body = body[:rng.randrange(len(body))]
    elif kind == 2:
        begin = rng.choice([b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n", b"GIF89a", b"BM", b"II*\0", b"MM\0*", b"#?RADIANCE\n",
                            b"\x76\x2f\x31\x01", b"RIFF", b"<svg", b"%PDF", b""])
        body = begin + bytes(rng.randrange(256) for _ in range(rng.randrange(2000)))
    length = b"Content-Length: %d" % len(body)
    if kind == 3:
        length = b"Content-Length: %d" % rng.choice([0, 1, len(body) // 2, 2 * len(body), 1 << 40])
        return request("POST /v1/uploads HTTP/1.1", length) + bytes(body), None
    if kind == 4:
        chunks = rng.choice([b"zz\r\n", b"-1\r\n", b"ffffffffffffffff\r\n", b"3\r\nabcd\r\n", b"0\r\n\r\n"])
        return request("POST /v1/uploads HTTP/1.1", b"Transfer-Encoding: chunked") + chunks, None
    if kind == 5:
        return request("POST /v1/uploads HTTP/1.1", b"Content-Length: 0")
    if kind == 6:
        return request(f"POST /v1/uploads{rng.choice(['/', '/x', '?a=b', '%00', '/..'])} HTTP/1.1", length) + bytes(body)
    return request("POST /v1/uploads HTTP/1.1", length, b"Content-Type: " + b"x" * rng.randrange(3000)) + bytes(body)


def exchange(port, data, is_last=True):
    """The statuses that come back; closing is none. Who says that this was the last byte is not answered after work."""
    close = isinstance(data, tuple)
    received = b""
    with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
        try:
            connection.sendall(data[0] if close else data)
            if close:
                return []
            if is_last:
                connection.shutdown(socket.SHUT_WR)
            while chunk := connection.recv(65536):
                received += chunk
        except TimeoutError:
            return [0]
        except OSError:  # closed, or reset because it sent more than was read
            pass
    statuses = [int(status) for status in re.findall(rb"HTTP/1\.[01] (\d{3}) ", received)]
    return [1] if received and not statuses else statuses


def send_slowly(port, results):
    """One byte now and then, for ever: the server must cut it off."""
    began = time.monotonic()
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
            for byte in b"GET /v1/small/64x.jpg HTTP/1.1\r\nX: " + b"y" * 1000:
                connection.sendall(bytes([byte]))
                time.sleep(0.3)
                connection.setblocking(False)
                try:
                    if connection.recv(1) == b"":
                        break
                except BlockingIOError:
                    pass
                finally:
                    connection.settimeout(20)
    except OSError:
        pass
    results.append(time.monotonic() - began)


def check_uploads(server, folder, image, count):
    """Bodies of uploads. Images that are damaged where no decoder notices are kept; nothing partial is."""
    rng, bad, kept, statuses = random.Random(7), [], 0, {}
    before = server.memory()
    for _ in range(count):
        data = malformed_upload(rng, image)
        for status in exchange(server.port, data, is_last=False):
            statuses[status] = statuses.get(status, 0) + 1
            kept += status == 201
            if not (status in (200, 201, 503, 507) or 400 <= status < 500):
                bad.append((status, data[:200]))
    wait_until(lambda: not any(name.startswith(".") for name in os.listdir(folder)), 5)
    names = os.listdir(folder)
    right = all(hashlib.sha256(open(os.path.join(folder, name), "rb").read()).hexdigest() == name[:64] for name in names)
    Tap.note(f"{count} malformed uploads: {statuses}; {len(names)} files; memory {before:.0f} MB before, "
             f"{server.memory():.0f} MB after")
    busy = 3 * statuses.get(503, 0) > sum(statuses.values())  # some, for those who left without a word keep their place
    Tap.result(not bad and not busy and server.is_alive(), "malformed uploads are refused or kept", f"{len(bad)}: {bad[:3]}")
    Tap.result(right and len(names) == kept, "the folder has the images that were accepted, whole", f"{len(names)} {kept}")


def check(server, count):
    """The server has a timeout of 2 seconds."""
    port = server.port
    good = fetch(port, "/v1/small/Floor=brick/64x.png")
    rng, bad, lock = random.Random(1), [], threading.Lock()
    slow, answered, closed = [], [0], [0]
    senders = [threading.Thread(target=send_slowly, args=(port, slow)) for _ in range(20)]

    def run(number):
        own = random.Random(number)
        for _ in range(number, count, 8):
            data = malformed(own)
            try:
                statuses = exchange(port, data)
            except OSError as error:
                statuses = [str(error)]
            with lock:
                answered[0] += len(statuses) > 0
                closed[0] += not statuses
                future = b"HTTP/9.9" in data  # which is what 505 is for
                if any(not isinstance(s, int) or not (400 <= s < 500 or (s == 505 and future)) for s in statuses):
                    bad.append((statuses, data if isinstance(data, tuple) else data[:120]))

    for _ in range(200):  # what the first requests allocate is no growth
        exchange(port, malformed(rng))
    before = server.memory()
    workers = [threading.Thread(target=run, args=(number,)) for number in range(8)]
    for thread in senders + workers:
        thread.start()
    for thread in senders + workers:
        thread.join()
    Tap.note(f"{count} malformed requests: {answered[0]} refused, {closed[0]} closed; memory {before:.0f} MB before, "
             f"{server.memory():.0f} MB after; slow senders cut off after {min(slow):.1f} to {max(slow):.1f} s")
    Tap.result(not bad, "malformed requests are refused by 4xx or closed", f"{len(bad)}: {bad[:5]}")
    Tap.result(max(slow) < 15, "slow senders are cut off")
    Tap.result(server.is_alive() and server.memory() < before + 16, "the server lives, and has not grown")
    again = fetch(port, "/v1/small/Floor=brick/64x.png")
    Tap.result(good.status == again.status == 200 and good.body == again.body, "and serves the same picture")
