"""Projects of strangers in the page of retex studio: what is damaged ends with a plain message, what is right asks first, and
no script of the folder is run."""
import http.server
import json
import os
import threading
import time

from drive import SCENE, Server, each, result
from page import finish

SET = "room.pov.studio/renders/1.exr"
SETTINGS = {"view": None, "targets": [{"name": "Floor", "select": "Floor", "uv": "", "share": 0.5}], "lamps": [], "finishes": {},
            "render": {"width": 160, "height": 90, "samples": 1, "noise": 0, "denoise": False}}
# What a script of the folder would do: read a file of the user by the studio, and take it elsewhere.
SCRIPT = """const top = new URL("../../../../", import.meta.url);
const post = (p, v) => fetch(new URL(p, top), { method: "POST", body: JSON.stringify(v) }).then((a) => a.json());
await post("api/open", { path: "b.pov" });
await post("api/jobs", { tool: "retex-combine", args: ["s.exr", "--texture", "Floor=$(id >pwned).png", "--save-preset", "b.pov.studio/.bash_profile", "-o", "-"] });
location.href = "%s/stolen";
"""


class Elsewhere:
    """A server of another origin, and what it was asked for."""

    def __init__(self):
        asked = self.asked = []

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):  # pylint: disable=invalid-name
                asked.append(self.path)
                self.send_error(404)

            def log_message(self, *_):  # pylint: disable=arguments-differ
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def gift(work, elsewhere, project, page):
    """A scene with a project and a page, as in a stranger's archive. page: the folder of the player's room."""
    write(f"{work}/room.pov", SCENE)
    write(f"{work}/b.pov", SCENE)
    os.symlink(".", f"{work}/b.pov.studio")
    write(f"{work}/room.pov.studio.json", json.dumps({"retex-studio": 1, "model": "room.pov", **project}))
    write(f"{work}/{page}/retex-room.js", SCRIPT % elsewhere.url)
    write(f"{work}/{page}/index.html", f"<script type=module src=retex-room.js></script><img src={elsewhere.url}/seen>")


def jobs(page):
    return [j["tool"] for j in page.run("fetch('api/jobs').then(a => a.json())")]


def untouched(work, elsewhere):
    return not elsewhere.asked and not os.path.exists(f"{work}/.bash_profile")


def options(page, work):
    elsewhere = Elsewhere()
    gift(work, elsewhere, {"renders": [{"set": "--help", "done": True, "args": []}]}, "room.pov.studio/pages/--help")
    server = Server(work, model="room.pov")
    page.open_studio(server)
    told = page.told("damaged")
    result(told.startswith('the project is damaged: "renders[0].set" is not as it should be'), f"a set that is an option is told {told}")
    time.sleep(3)
    result(jobs(page) == [] and untouched(work, elsewhere), "nothing is run for it")


def asks(page, work):
    elsewhere = Elsewhere()
    renders = [{"set": SET, "settings": SETTINGS, "done": True}]
    gift(work, elsewhere, {**SETTINGS, "renders": renders, "textures": {"folders": [f"{work}/home"], "widths": {}}}, "room.pov.studio/pages/1")
    server = Server(work, model="room.pov")
    page.open_studio(server)
    page.wait("document.querySelector('#foreign').open")
    text = " ".join(page.run("document.querySelector('#foreign').textContent").split())
    wanted = ("your retex-studio has not made its folder", "retex-render", f"-- {SET}", "retex-pack", f"{work}/home")
    result(all(words in text for words in wanted), f"it is asked whether to go on, with what would be run {text}")
    page.hit("Escape")
    time.sleep(3)
    result(page.run("document.querySelector('#foreign').open") and jobs(page) == [], "nothing is run before the answer")
    page.go("#foreign-open")
    page.wait("document.querySelector('#panel-title').textContent !== 'Open'")
    result(not page.run("document.querySelector('#foreign').open"), "the answer is taken")
    page.wait("fetch('api/jobs').then(a => a.json()).then(l => window.packed = l.some(j => j.tool === 'retex-pack')) && window.packed")
    time.sleep(3)
    result(untouched(work, elsewhere), "no script of the folder is run")
    page.events.clear()
    for address in f"{server.url}files/room.pov.studio/pages/1/index.html", f"{server.url}files/room.pov.studio/pages/1/retex-room.js":
        page.call("Runtime.evaluate", expression=f"(() => {{ const a = document.createElement('a'); a.href = {json.dumps(address)}; document.body.append(a); a.click(); }})()")
        time.sleep(1)
        page.call("Runtime.evaluate", awaitPromise=True, expression=f"import({json.dumps(address)}).catch(() => 0)")
    result(untouched(work, elsewhere), "nor where a window is led to it")


def ends(page, work):
    elsewhere = Elsewhere()
    gift(work, elsewhere, {}, "room.pov.studio/pages/1")
    server = Server(work, model="room.pov")
    page.open_studio(server)
    page.wait("document.querySelector('#foreign').open")
    page.go("#foreign-end")
    result(server.process.wait(30) == 0, "the answer no ends the program")
    result(os.path.exists(f"{work}/room.pov.studio.json") and untouched(work, elsewhere), "and leaves all as it was")
    again = Server(work, model="room.pov")
    page.open_studio(again)
    page.wait("document.querySelector('#foreign').open")
    result(True, "the next time it is asked again")


def own(page, work):
    """One's own project is not asked for."""
    write(f"{work}/room.pov", SCENE)
    server = Server(work, model="room.pov")
    page.open_studio(server, "View")
    page.wait("document.querySelector('#picture.shown')")
    server.close()
    server = Server(work, model="room.pov")
    page.open_studio(server, "View")
    page.wait("document.querySelector('#picture.shown')")
    result(not page.run("document.querySelector('#foreign').open"), "one's own project is opened without a question")


each([options, asks, ends, own])
finish()
