"""tools/serve/nginx.conf with Debian's nginx, as an ordinary process: what it keeps, and what it does while the server
behind it is slow or gone; images that visitors send."""
import http.server
import json
import os
import re
import signal
import socket
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import heads
from serving import Server, Tap, end_with_the_checks, fetch, wait_until


TRUST = ["--trusted-proxy", "127.0.0.1"]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Nginx:
    """nginx with the project's file, in which only places, ports and rates are others."""

    def __init__(self, backend, work, rate="5000r/s", uploads=False):
        self.port = free_port()
        folder = os.path.join(work, f"nginx-{self.port}")
        os.makedirs(folder)
        with open("tools/serve/nginx.conf", encoding="utf-8") as file:
            text = file.read()
        for found, replaced in [("/var/cache/nginx/retex", f"{folder}/cache"), ("rate=50r/s", f"rate={rate}"),
                                ("listen 80;", f"listen 127.0.0.1:{self.port};"),
                                ("server 127.0.0.1:8080;", f"server 127.0.0.1:{backend};")]:
            if text.count(found) != 1:
                raise RuntimeError(f"tools/serve/nginx.conf: no `{found}`")
            text = text.replace(found, replaced)
        if uploads:  # the part that is a comment
            text, count = re.subn(r"(?<=    # With --uploads of retex-serve:\n)(    # .*\n)+",
                                  lambda part: re.sub("^    # ", "    ", part[0], flags=re.M), text)
            if count != 1:
                raise RuntimeError("tools/serve/nginx.conf: no location of uploads in a comment")
        temporary = "".join(f"{name}_temp_path {folder}/{name};\n" for name in
                            ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
        user = "user root;\n" if os.geteuid() == 0 else ""
        with open(os.path.join(folder, "nginx.conf"), "w", encoding="utf-8") as file:
            file.write(f"{user}daemon off;\nworker_processes 2;\npid {folder}/pid;\nerror_log {folder}/error.log;\n"
                       f"events {{}}\nhttp {{\n{temporary}access_log off;\n{text}\n}}\n")
        self.process = subprocess.Popen(["/usr/sbin/nginx", "-p", folder, "-c", f"{folder}/nginx.conf",
                                         "-e", f"{folder}/error.log"])
        end_with_the_checks(self.process)
        if not wait_until(self.is_up):
            raise RuntimeError("nginx did not start")

    def is_up(self):
        try:
            return fetch(self.port, "/").status == 404
        except OSError:
            return False

    def stop(self):
        self.process.send_signal(signal.SIGQUIT)
        self.process.wait()


def check_cache(nginx, server, path):
    first, second = fetch(nginx.port, path), fetch(nginx.port, path)
    direct = fetch(server.port, path)
    Tap.result((first["X-Cache-Status"], second["X-Cache-Status"]) == ("MISS", "HIT") and
               first.body == second.body == direct.body and first.status == second.status == 200,
               "nginx: the second request is a hit",
               f"{first.status} {first['X-Cache-Status']} {second['X-Cache-Status']}")
    Tap.result(second["ETag"] == direct["ETag"] != "" and second["Cache-Control"] == direct["Cache-Control"] != "",
               "nginx: ETag and Cache-Control pass")
    same = fetch(nginx.port, path, headers={"If-None-Match": second["ETag"]})
    Tap.result(same.status == 304 and not same.body, "nginx: 304 passes", str(same.status))
    part = fetch(nginx.port, path, headers={"Range": "bytes=10-19"})
    Tap.result(part.status == 206 and part.body == direct.body[10:20], "nginx: ranges of kept pictures")
    head = fetch(nginx.port, path, method="HEAD")
    Tap.result(head.status == 200 and head["Content-Length"] == str(len(direct.body)) and not head.body, "nginx: HEAD")
    Tap.result("Content-Encoding" not in fetch(nginx.port, path, headers={"Accept-Encoding": "gzip"}).headers,
               "nginx: pictures are not compressed again")
    plain = fetch(nginx.port, "/iiif/3/small/info.json")
    Tap.result(f'"id": "http://127.0.0.1:{nginx.port}/iiif/3/small"'.encode() in plain.body,
               "nginx: info.json has the URL that the client knows")
    types = [fetch(nginx.port, path.rsplit(".", 1)[0], headers={"Accept": accept})["Content-Type"]
             for accept in ("image/png", "image/webp", "image/png", "*/*")]
    Tap.result(types == ["image/png", "image/webp", "image/png", "image/jpeg"],
               "nginx: keeps each type that is accepted", str(types))


def check_refusals(nginx):
    statuses = [fetch(nginx.port, path).status for path in
                ("/metrics", "/", "/v1/%2e%2e/x", "/v1/small%2Ffull.jpg", "/v1/small/Floor=a%2Fb/full.jpg", "/v1/%00")]
    Tap.result(all(400 <= status < 500 for status in statuses), "nginx: metrics and strange paths are refused",
               str(statuses))
    statuses = [fetch(nginx.port, path, method="POST").status for path in ("/v1/small/64x.jpg", "/v1/uploads")]
    Tap.result(statuses == [403, 403], "nginx: only GET and HEAD", str(statuses))
    fixed = [fetch(nginx.port, "/@2026-11.a/v1/small/Floor=fans;Wall=rgb(.1,.2%2c.3)/64x.jpg") for _ in range(2)]
    Tap.result(fixed[1].status == 200 and fixed[1]["Cache-Control"] == "public, max-age=31536000, immutable" and
               fixed[1]["X-Cache-Status"] == "HIT", "nginx: URLs with a release never change")
    Tap.result("immutable" not in fetch(nginx.port, "/@2026-11.a/v1/small/Floor=nothing/64x.jpg")["Cache-Control"],
               "nginx: errors are not immutable")


def check_heads(nginx, server):
    """What nginx refuses, and what it passes on, reaches the server as one request or none."""
    right = fetch(server.port, "/v1/small/64x.png").body
    faults = heads.faults(nginx.port, proxied=True)
    Tap.result(not faults, "nginx: requests that programs may read differently are refused", "; ".join(faults))
    bodies = {fetch(nginx.port, "/v1/small/64x.png").body for _ in range(8)}
    Tap.result(bodies == {right}, "nginx: and its connections to the server are as before")


def check_shared(nginx):
    """What a client tells of other addresses changes neither what nginx keeps nor who is limited."""
    def ids(port, **more):
        return re.search(rb'"id": "([^"]*)"', fetch(port, "/iiif/3/small;Wall=brick/info.json", headers=more).body)[1].decode()
    told = {"X-Forwarded-Proto": "https", "X-Forwarded-Host": "evil.example", "X-Forwarded-For": "192.0.2.1"}
    Tap.result([ids(nginx.port, **told), ids(nginx.port)] == [f"http://127.0.0.1:{nginx.port}/iiif/3/small;Wall=brick"] * 2,
               "nginx: info.json has nothing of a client's headers", ids(nginx.port))


def check_lock(nginx, server):
    """Sixteen ask for the same new picture at once; the server makes one."""
    def counted():
        return sum(int(n) for n in re.findall(r'retex_serve_requests_total\{route="picture",status="200"\} (\d+)',
                                              fetch(server.port, "/metrics").body.decode()))
    before, replies = counted(), []
    threads = [threading.Thread(target=lambda: replies.append(
        fetch(nginx.port, "/v1/small/Floor=terrazzo;Wall=rgb(.4,.5,.6)/full.png").status)) for _ in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    Tap.result(replies == [200] * 16 and counted() == before + 1, "nginx: of equal requests one reaches the server",
               f"{counted() - before}")


def check_stale(nginx, rooms, textures, server, log, path):
    """The server's answers are old after a second. It is killed: old pictures are served; restarted: revalidated."""
    kept = fetch(nginx.port, path)
    etag, port = kept["ETag"], server.port
    time.sleep(2.5)
    server.kill()
    stale = [fetch(nginx.port, path) for _ in range(3)]
    Tap.result(all(r.status == 200 and r.body == kept.body for r in stale) and
               {r["X-Cache-Status"] for r in stale} <= {"STALE", "UPDATING"},
               "nginx: a killed server's pictures are served", str([(r.status, r["X-Cache-Status"]) for r in stale]))
    Tap.result(fetch(nginx.port, "/v1/small/Floor=rgb(1,1,1)/99x.jpg").status == 502, "nginx: others are 502")
    server = Server(rooms, textures, "--max-age", "1", *TRUST, "-q", log=log, port=port)

    def is_fresh():  # nginx asks in the background, and the server opens the room first
        reply = fetch(nginx.port, path)
        return reply.body == kept.body and reply["ETag"] == etag and reply["X-Cache-Status"] in ("HIT", "REVALIDATED")

    Tap.result(wait_until(is_fresh, 60), "nginx: after a restart they are fresh again")
    return server


def check_torn(nginx, rooms, textures, server, log):
    """Killed while pictures are sent through nginx: nothing incomplete is kept."""
    port, paths = server.port, [f"/v1/large/Floor=rgb(.{n},.2,.3)/full.png" for n in range(1, 6)]
    right = [fetch(port, path).body for path in paths]
    for path in paths:
        def ask(wanted=path):
            try:
                fetch(nginx.port, wanted)
            except Exception:  # part of a reply
                pass
        thread = threading.Thread(target=ask)
        thread.start()
        time.sleep(0.01)
        server.kill()
        thread.join()
        server = Server(rooms, textures, *TRUST, "-q", log=log, port=port)
    bodies = [fetch(nginx.port, path).body for path in paths for _ in range(2)]
    Tap.result(bodies == [body for body in right for _ in range(2)], "nginx: no torn picture is kept",
               str([len(body) for body in bodies]))
    return server


def check_rate(server, work):
    nginx = Nginx(server.port, work, rate="1r/s")
    statuses = [fetch(nginx.port, "/v1/small/64x.jpg").status for _ in range(230)]
    Tap.result(statuses[:150] == [200] * 150 and 429 in statuses, "nginx: too many requests of one address are refused",
               f"{statuses.count(200)} served")
    nginx.stop()


def check_uploads(rooms, textures, work, log):
    folder = os.path.join(work, "uploads-nginx")
    os.makedirs(folder)
    server = Server(rooms, textures, "--uploads", folder, *TRUST, log=log)
    nginx = Nginx(server.port, work, uploads=True)
    with open(os.path.join(textures, "brick.jpg"), "rb") as file:
        image = file.read()
    sent = fetch(nginx.port, "/v1/uploads", "POST", body=image)
    name = json.loads(sent.body)["texture"] if sent.status == 201 else "none"
    pictures = [fetch(nginx.port, f"/v1/small/Floor={texture}/64x.png").body for texture in (name, "brick")]
    Tap.result(sent.status == 201 and pictures[0] == pictures[1], "nginx: an image that is sent is a texture",
               f"{sent.status} {sent.body[:200]}")
    statuses = [fetch(nginx.port, "/v1/uploads", method, body=body).status for method, body in
                (("POST", iter([image[:5000], image[5000:]])), ("POST", bytes(15 << 20)), ("POST", bytes(17 << 20)),
                 ("PUT", image), ("OPTIONS", None), ("GET", None))]
    Tap.result(statuses == [200, 415, 413, 403, 204, 403], "nginx: images in chunks pass, large ones and others do not",
               str(statuses))
    nginx.stop()
    slow = Nginx(server.port, work, rate="1r/s", uploads=True)
    with ThreadPoolExecutor(12) as threads:
        statuses = sorted(threads.map(lambda _: fetch(slow.port, "/v1/uploads", "POST", body=image).status, range(12)))
    Tap.result(set(statuses) == {200, 429}, "nginx: too many images of one address are refused", str(statuses))
    slow.stop()
    server.stop()


class SlowBackend(http.server.BaseHTTPRequestHandler):
    """Answers after more seconds than nginx waits by default, as a cold room on a busy machine does."""
    SECONDS, count = 65, 0

    def do_GET(self):
        SlowBackend.count += 1
        self.rfile.read(int(self.headers.get("Content-Length", 0)))
        time.sleep(self.SECONDS)
        self.send_response(200)
        for name, value in ("Content-Length", "4"), ("Cache-Control", "public, max-age=60"):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(b"slow")

    do_POST = do_GET

    def log_message(self, *_):
        pass


def ask_slowly(work):
    """Two ask for the same picture, one sends an image; returns what gives their statuses."""
    backend = http.server.ThreadingHTTPServer(("127.0.0.1", 0), SlowBackend)
    threading.Thread(target=backend.serve_forever, daemon=True).start()
    nginx, threads = Nginx(backend.server_port, work, uploads=True), ThreadPoolExecutor(3)
    answers = [threads.submit(fetch, nginx.port, path, method, timeout=200, body=body) for path, method, body in
               (("/v1/slow/full.jpg", "GET", None), ("/v1/slow/full.jpg", "GET", None), ("/v1/uploads", "POST", b"x"))]

    def statuses():
        found = [answer.result().status for answer in answers]
        nginx.stop()
        backend.shutdown()
        return found
    return statuses


def check(rooms, textures, work, log):
    slow_statuses = ask_slowly(work)
    check_uploads(rooms, textures, work, log)
    server = Server(rooms, textures, *TRUST, "-q", log=log)
    nginx = Nginx(server.port, work)
    try:
        check_cache(nginx, server, "/v1/small/Floor=brick;Wall=rgb(.2,.3,.4)/200x.jpg")
        check_refusals(nginx)
        check_heads(nginx, server)
        check_shared(nginx)
        check_lock(nginx, server)
        check_rate(server, work)
        server = check_torn(nginx, rooms, textures, server, log)
        server.stop()
        server = Server(rooms, textures, "--max-age", "1", *TRUST, "-q", log=log, port=server.port)
        server = check_stale(nginx, rooms, textures, server, log, "/v1/small/Floor=damask/200x.jpg")
    finally:
        nginx.stop()
        server.stop()
    statuses = slow_statuses()
    Tap.result(statuses == [200] * 3 and SlowBackend.count == 2,
               f"nginx: waits longer than {SlowBackend.SECONDS} s for a picture, and for an image that is decoded",
               f"{statuses}, {SlowBackend.count} requests")
