"""Strangers' rooms in retex-studio, by clicks and keys alone, as TAP: a model is opened, its floor and a wall are taken, it is
rendered with 1280x720 pixels and 64 samples, denoised, gets another floor and wall, and its page is opened from a web server.
The first argument is the folder of the models, each NAME/FILE as models.csv has them or NAME.glb; ROOMS chooses some.

What a person does is counted: 2 s a click, 1 s a key, 5 s to read a panel that is new. What the machine does is told as
seconds that passed and as processor time of retex's tools, by stage. RETEX_WEB_SHOTS is a folder for pictures of each step."""
import glob
import os
import shutil
import sys
import tempfile
import time

from drive import TOP, Server, Studio, result
from browser import serve
from page import finish

CLICK, KEY, PANEL = 2, 1, 5  # seconds of a person
# Where the floor and a wall are in the picture, and the key of what a click takes: 1 the material, 3 the level.
ROOMS = {
    "voxel-room": ("its textures are an atlas", (0.5, 0.95), (0.12, 0.2), "3"),
    "dream-apartment": ("a closed room, by meshopt", (0.35, 0.88), (0.42, 0.12), "1"),
    "hotel-room": ("compressed by meshopt", (0.85, 0.85), (0.64, 0.25), "1"),
    "living-room": ("a scene", (0.6, 0.75), (0.84, 0.62), "1"),
}
FLOOR, WALL = "walnut", "damask"  # pictures of scenes/textures


class Walk:
    """One room's walk, with what it costs."""

    def __init__(self, page, server, name):
        self.page, self.server, self.name = page, server, name
        self.panels, self.stages = 0, []
        page.clicks = page.keys = 0

    def shot(self, step):
        self.page.shot(f"room-{self.name}-{step}")

    def panel(self):
        self.panels += 1

    def stage(self, name, code, seconds=1800):
        """What the machine is waited for."""
        begun, before = time.time(), self.server.processor_seconds()
        self.page.wait(code, seconds)
        self.stages.append((name, time.time() - begun, self.server.processor_seconds() - before))

    def told(self):
        person = CLICK * self.page.clicks + KEY * self.page.keys + PANEL * self.panels
        print(f"# {self.name}: {self.page.clicks} clicks, {self.page.keys} keys, {self.panels} panels: {person} s of a person; "
              + ", ".join(f"{name} {passed:.1f} s ({used:.1f} s of processors)" for name, passed, used in self.stages), flush=True)
        return person


def take_surfaces(walk, places, scope):
    page = walk.page
    page.go("#next-button")
    walk.panel()
    walk.stage("surfaces", "document.querySelector('#seen summary')")
    if scope != "1":
        page.go(f"label.scope:nth-of-type({scope})")
    for number, (place, name) in enumerate(zip(places, ("Floor", "Wall"))):
        page.press_at(*page.picture(*place))
        page.wait(f"document.querySelector('#target-{number}')")
        page.write(f"#target-{number}", name)
        page.surfaces()
    walk.shot("surfaces")


def lay(walk, target, texture):
    """A picture onto a surface, which is chosen in the player by a click on it."""
    page = walk.page
    page.run(f"document.querySelector('retex-room').select({target!r})")
    page.clicks += 1  # a click on the surface in the picture
    page.write("#search", texture)
    page.go("#swatch-0")
    walk.stage(f"laying on the {target.lower()}", f"document.querySelector('retex-room').getState().textures[{target!r}]", 60)


def walk_room(page, server, name, row, clean):
    walk = Walk(page, server, name)
    page.open_studio(server)
    walk.panel()
    page.go(f".browser button.row[aria-label^='{row}']")
    if not row.endswith(".pov"):
        walk.stage("import", "document.querySelector('.report li') || document.querySelector('.card.bad')", 300)
        walk.shot("open")
        if page.run("!!document.querySelector('#import-partial')"):
            walk.panel()
            page.go("#import-partial")
            walk.stage("import again", "document.querySelector('.report li')", 300)
            walk.shot("partial")
        page.go("#next-button")
    walk.panel()
    walk.stage("first picture", "document.querySelector('#picture.shown')", 300)
    walk.shot("view")
    take_surfaces(walk, *clean)
    for _ in range(2):
        page.go("#next-button")
        walk.panel()
    page.go("#next-button")
    walk.stage("render", "document.querySelector('.renders .good')")
    walk.shot("render")
    page.go("#next-button")
    walk.panel()
    walk.stage("page", "document.querySelector('retex-room')?.isComplete", 300)
    page.go("#root-1")
    lay(walk, "Floor", FLOOR)
    lay(walk, "Wall", WALL)
    page.settle()
    walk.shot("play")
    page.go("#next-button")
    walk.panel()
    page.go("#make-picture")
    walk.stage("picture", "document.querySelector('.card a.button[download]')", 300)
    page.go("#make-page")
    walk.stage("page to take away", "document.querySelector('#page-made')", 300)
    walk.shot("take")
    wrong = page.trouble()
    person = walk.told()
    project = page.saved(server)
    render = project["renders"][0]["settings"]["render"]
    result(not wrong and (render["width"], render["height"], render["samples"], render["denoise"]) == (1280, 720, 64, True) and person < 300,
           f"{name}: another floor and wall, in {person} s of a person")
    [made] = glob.glob(f"{server.work}/{server.folder}/web/*")
    visit(made, name)


def visit(folder, name):
    """The page that was taken away, in a visitor's browser."""
    page = Studio()
    try:
        page.size(1280, 800)
        page.open(serve(folder))
        page.until("Object.keys(document.querySelector('retex-room').getState().textures).length === 2", 120)
        page.shot(f"room-{name}-page")
        sources = [page.room("getState()")["textures"][target]["source"] for target in ("Floor", "Wall")]
        result(sources[0].startswith(f"textures/{FLOOR}") and sources[1].startswith(f"textures/{WALL}") and page.message() == "",
               f"{name}: its page is opened from a web server, with {sources}")
    finally:
        page.close()


def model_of(folder, name):
    if name == "living-room":
        found = [f"{os.environ.get('RETEX_SHARED', '../shared')}/scenes/living-room-bitterli/scene.pov"]
    else:
        found = glob.glob(f"{folder}/{name}/*.glb") + glob.glob(f"{folder}/{name}.glb")
    return found[0] if found and os.path.exists(found[0]) else None


def main():
    page = Studio()
    try:
        for name in os.environ.get("ROOMS", " ".join(ROOMS)).split():
            about, floor, wall, scope = ROOMS[name]
            found = model_of(sys.argv[1], name)
            if not found:
                result(True, f"{name}, {about} # SKIP it is not there")
                continue
            print(f"# {name}: {about}")
            page.size(1280, 800)
            with tempfile.TemporaryDirectory() as work:
                if found.endswith(".pov"):
                    shutil.copytree(os.path.dirname(found), work, dirs_exist_ok=True)
                else:
                    shutil.copy(found, work)
                server = Server(work, "--textures", f"{TOP}/scenes/textures", opened=os.path.basename(found))
                try:
                    walk_room(page, server, name, os.path.basename(found), ((floor, wall), scope))
                except SystemExit as error:
                    result(False, f"{name}: {error}")
                finally:
                    page.leave()
                    server.close()
    finally:
        page.close()
    finish()


main()
