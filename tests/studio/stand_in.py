"""A stand-in for the server of retex studio, for tests of its page: it keeps files and a project, and runs the tools, but
has no preview process: pictures and surfaces of the preview are made up. The calls are those of tools/studio/README.md."""
import hashlib
import http.server
import json
import os
import queue
import struct
import subprocess
import threading
import time
import urllib.parse

TYPES = {"html": "text/html", "js": "text/javascript", "css": "text/css", "json": "application/json", "png": "image/png",
         "jpg": "image/jpeg"}
KINDS = {"glb": "model", "gltf": "model", "obj": "model", "pov": "scene", "retex": "set", "exr": "set", "jpg": "picture",
         "png": "picture"}
POLICY = ("default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; "
          "connect-src 'self' blob: data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'")


def half(value):
    return struct.pack("<e", value)


class StandIn:
    """surfaces: [(text, name)], which the made-up picture shows as columns. live: what --live says of the camera."""

    def __init__(self, page, work, textures, surfaces):
        self.page, self.work, self.textures, self.surfaces = page, work, textures, surfaces
        self.model = None
        self.jobs, self.queues, self.lines = [], [], []
        self.picture, self.answers, self.number = None, {}, 0
        self.changed = threading.Condition()
        self.refuse = None  # (address, status, message): answered once
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), self.handler())
        self.server.daemon_threads = True
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_port}/token/"

    # ---- files ----

    @property
    def folder(self):
        return os.path.splitext(self.model)[0] + ".studio"

    def path(self, text):
        return text if text.startswith("/") else os.path.join(self.work, text)

    @property
    def project_file(self):
        return self.path(f"{self.folder}.json")

    def etag(self):
        with open(self.project_file, "rb") as file:
            return '"' + hashlib.sha256(file.read()).hexdigest()[:16] + '"'

    def list(self, path):
        at, entries = self.path(path), []
        os.makedirs(at, exist_ok=True)
        for name in sorted(os.listdir(at)):
            full = os.path.join(at, name)
            is_folder = os.path.isdir(full)
            kind = "folder" if is_folder else KINDS.get(name.rpartition(".")[2], "other")
            entries.append({"name": name, "path": os.path.join(path, name) if path else name, "kind": kind,
                            "bytes": os.path.getsize(full), "mtime": os.path.getmtime(full)})
        return {"path": path or self.work, "parent": None, "entries": entries}

    # ---- events and jobs ----

    def tell(self, name, value):
        for listener in self.queues:
            listener.put(f"event: {name}\ndata: {json.dumps(value)}\n\n")

    def start(self, tool, args, label):
        job = {"job": len(self.jobs) + 1, "tool": tool, "args": args, "label": label, "state": "running", "progress": 0,
               "stage": "", "lines": [], "stdout": "", "status": None, "seconds": 0}
        self.jobs.append(job)
        output = args[args.index("-o") + 1] if "-o" in args else args[-1]
        os.makedirs(os.path.dirname(self.path(output)) or self.work, exist_ok=True)
        threading.Thread(target=self.work_on, args=(job,), daemon=True).start()
        return {"job": job["job"]}

    def work_on(self, job):
        begin = time.time()
        with subprocess.Popen([job["tool"], *job["args"]], cwd=self.work, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            job["process"] = process
            for line in process.stderr:
                if line.startswith("{"):
                    said = json.loads(line)
                    job["progress"], job["stage"] = said.get("fraction", 0), said.get("stage", "")
                else:
                    job["lines"].append(line.rstrip("\n"))
                job["seconds"] = time.time() - begin
                self.tell("job", self.shown(job))
            job["stdout"] = process.stdout.read()
        job.update(status=process.returncode, seconds=time.time() - begin,
                   state="done" if process.returncode == 0 else "stopped" if process.returncode < 0 else "failed")
        self.tell("job", self.shown(job))

    @staticmethod
    def shown(job):
        return {key: value for key, value in job.items() if key != "process"}

    # ---- the preview ----

    def preview(self, line):
        self.lines.append(line)
        word, *rest = line.split()
        if word == "view":
            width, height, samples = int(rest[0]), int(rest[1]), int(rest[3])
            self.publish("picture", {"picture": samples, "width": width, "height": height}, self.stripes(width, height))
        elif word == "denoise" and self.picture:
            self.publish("picture", {**self.picture[0], "denoised": 1}, self.picture[1])
        elif word == "surfaces":
            width, height = int(rest[0]), int(rest[1])
            self.publish("surfaces", *self.planes(width, height))
        elif word == "uv":
            width, height = int(rest[0]), int(rest[1])
            self.publish("uv", *self.coordinates(width, height))

    def publish(self, kind, head, data):
        with self.changed:
            self.number += 1
            made = {**head, "number": self.number, "bytes": len(data)}, data
            if kind == "picture":
                self.picture = made
            else:
                self.answers[kind] = made
            self.changed.notify_all()

    def column(self, x, width):
        return x * len(self.surfaces) // width

    def stripes(self, width, height):
        tones = [(0.5, 0.32, 0.2), (0.55, 0.55, 0.5), (0.12, 0.2, 0.3), (0.3, 0.36, 0.22)]
        rows = []
        for y in range(height):
            fade = 0.4 + 0.6 * y / height
            row = b"".join(b"".join(half(c * fade) for c in tones[self.column(x, width) % 4]) + half(1)
                           for x in range(width))
            rows.append(row)
        return b"".join(rows)

    def planes(self, width, height):
        share = 1 / len(self.surfaces)
        kinds = ["material", "object", "flat", "level"]
        listed = [{"kind": kind, "text": text + suffix, "name": name, "share": share} for kind, suffix in
                  zip(kinds, ["", "/object", "/flat:1", "/level:1"]) for text, name in self.surfaces]
        data = b""
        for k in range(len(kinds)):
            row = b"".join(struct.pack("<H", k * len(self.surfaces) + self.column(x, width) + 1) for x in range(width))
            data += row * height
        return {"surfaces": listed, "width": width, "height": height}, data

    def coordinates(self, width, height):
        data = struct.pack("<H", 1) * (width * height)
        data += b"".join(struct.pack("<f", 4 * x / width) for x in range(width)) * height
        data += b"".join(struct.pack("<f", 2 - 2 * y / height) * width for y in range(height))
        return {"uv": [{"target": "Floor", "unit": [1, 1]}], "width": width, "height": height}, data

    def wait(self, kind, after):
        end = time.time() + 20
        with self.changed:
            while True:
                made = self.picture if kind == "picture" else self.answers.get(kind)
                if made and made[0]["number"] > after:
                    return made
                if not self.changed.wait(max(0, end - time.time())):
                    return None

    # ---- requests ----

    def state(self):
        if not self.model:
            return {"version": "test", "model": None, "textures": [self.textures]}
        project = None
        if os.path.exists(self.project_file):
            with open(self.project_file, encoding="utf-8") as file:
                project = json.load(file)
        return {"version": "test", "model": {"path": self.model, "name": self.model}, "folder": self.folder,
                "textures": [self.textures], "project": project}

    def get(self, path, query):
        if path == "api/state":
            return self.state()
        if path == "api/folder":
            return self.list(query.get("path", ""))
        if path == "api/jobs":
            return {"jobs": [self.shown(job) for job in self.jobs]}
        return None

    def post(self, path, query, body):
        if path == "api/upload":
            os.makedirs(self.path("inbox" if not self.model else f"{self.folder}/files"), exist_ok=True)
            made = f"{self.folder}/files/{query['name']}" if self.model else query["name"]
            with open(self.path(made), "wb") as file:
                file.write(body)
            return {"path": made}
        value = json.loads(body or b"{}")
        if path == "api/open":
            self.model = value["path"]
            return {}
        if path == "api/jobs":
            return self.start(value["tool"], value["args"], value["label"])
        if path.endswith("/stop"):
            self.jobs[int(path.split("/")[2]) - 1]["process"].terminate()
            return {}
        if path == "api/preview/start":
            camera = {"eye": [1.284, 1.5, -2.437], "at": [4.171, 0.724, -2.184], "angle": 70, "up": [0, 1, 0], "right": [1, 0, 0],
                      "bounds": [[0, 0, -4], [5, 2.6, 0]]}
            self.started = value
            self.publish("live", {"live": 1, "camera": camera, "width": 640, "height": 360}, b"")
            return {}
        if path == "api/preview":
            self.preview(value["line"])
            return {}
        return None

    def handler(stand_in):  # pylint: disable=no-self-argument
        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_):
                pass

            def answer(self, data, kind="application/json", status=200, **headers):
                data = json.dumps(data).encode() if not isinstance(data, bytes) else data
                self.send_response(status)
                for name, value in {"Content-Type": kind, "Content-Length": len(data),
                                    "Content-Security-Policy": POLICY, **headers}.items():
                    self.send_header(name.replace("_", "-"), str(value))
                self.end_headers()
                try:
                    self.wfile.write(data)
                except OSError:
                    pass  # the page no longer waits for it

            def parts(self):
                url = urllib.parse.urlsplit(self.path)
                path = url.path.removeprefix("/token/")
                query = {k: v[0] for k, v in urllib.parse.parse_qs(url.query).items()}
                if stand_in.refuse and path == stand_in.refuse[0]:
                    _, status, message = stand_in.refuse
                    stand_in.refuse = None
                    self.rfile.read(int(self.headers.get("Content-Length") or 0))
                    self.answer({"error": message}, status=status)
                    return None, query
                return path, query

            def file(self, path):
                if not os.path.isfile(path):
                    return self.answer({"error": "no such file"}, status=404)
                with open(path, "rb") as file:
                    return self.answer(file.read(), TYPES.get(path.rpartition(".")[2], "application/octet-stream"))

            def do_GET(self):
                path, query = self.parts()
                if path is None:
                    return None
                if path == "api/events":
                    return self.events()
                if path == "api/project":
                    with open(stand_in.project_file, "rb") as file:
                        return self.answer(file.read(), ETag=stand_in.etag())
                if path in ("api/preview/picture", "api/preview/answer"):
                    made = stand_in.wait(query.get("kind", "picture"), int(query["after"]))
                    if not made:
                        return self.answer(b"", status=204)
                    head = json.dumps(made[0])
                    if path == "api/preview/picture":
                        return self.answer(made[1], "application/octet-stream", Retex_Picture=head)
                    return self.answer(head.encode() + b"\n" + made[1], "application/octet-stream")
                if path == "api/thumb":
                    return self.file(stand_in.path(query["path"]))
                if path.startswith("files/"):
                    return self.file(stand_in.path(urllib.parse.unquote(path[6:])))
                found = stand_in.get(path, query)
                return self.answer(found) if found is not None else self.file(f"{stand_in.page}/{path or 'index.html'}")

            def do_POST(self):
                path, query = self.parts()
                if path is not None:
                    body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
                    self.answer(stand_in.post(path, query, body))

            def do_PUT(self):
                path, _ = self.parts()
                if path is None:
                    return None
                body = self.rfile.read(int(self.headers["Content-Length"]))
                known = stand_in.etag() if os.path.exists(stand_in.project_file) else None
                if self.headers.get("If-Match") != known or (known is None and self.headers.get("If-None-Match") != "*"):
                    return self.answer({"error": "another window has changed the project"}, status=412)
                with open(stand_in.project_file, "wb") as file:
                    file.write(body)
                stand_in.tell("project", {"etag": stand_in.etag()})
                return self.answer({}, ETag=stand_in.etag())

            def events(self):
                listener = queue.Queue()
                stand_in.queues.append(listener)
                self.send_response(200)
                self.send_header("Content-Type", "text/event-stream")
                self.send_header("Connection", "close")
                self.end_headers()
                try:
                    while True:
                        self.wfile.write(listener.get().encode())
                        self.wfile.flush()
                except OSError:
                    stand_in.queues.remove(listener)

        return Handler
