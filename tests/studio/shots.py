"""The pictures of docs/studio.md and the recording of README.md: shots.py OUT. The page of retex-studio, in headless
Chromium, from the scene of the living room to another floor and wall. Writes OUT/studio-STEP.jpg and OUT/studio.webp.
STUDIO_SIZE=640x360 and STUDIO_SPP=8 make a smaller render; STUDIO_CLEAR is for how many seconds a preview gets clearer."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time

from drive import TOP, Server, Studio, own_project

SIZE, SAMPLES = os.environ.get("STUDIO_SIZE", "1280x720"), int(os.environ.get("STUDIO_SPP", "64"))
WIDE = "960x600"  # of the recording's frames
FLOOR, WALL = (0.1, 0.92), (0.62, 0.2)  # places of the picture
LONG, SHORT = 1800, 700  # milliseconds
CLEAR = int(os.environ.get("STUDIO_CLEAR", "60"))  # seconds that a preview may take to be without grain

POINTER = """(() => { let e = document.querySelector('#pointer'); if (!e) { e = document.createElement('div'); e.id = 'pointer';
  Object.assign(e.style, { position: 'fixed', zIndex: 99, width: '26px', height: '26px', margin: '-13px', borderRadius: '16px',
    background: '#e0533fb0', border: '3px solid #fff', boxShadow: '0 0 4px #000', pointerEvents: 'none' }); }
  (document.querySelector('dialog[open]') || document.body).append(e); Object.assign(e.style, { left: '%fpx', top: '%fpx' }); })()"""


class Recorder(Studio):
    """Pictures of a walk: stills, and frames of a recording, in which clicks are seen before they are made."""

    def __init__(self, work, out):
        super().__init__()
        self.work, self.out, self.frames = work, out, []

    def frame(self, milliseconds):
        path = f"{self.work}/frame-{len(self.frames):03}.png"
        self.screenshot(path)
        self.frames.append((path, milliseconds))

    def point(self, x, y):
        """A frame in which one is about to click here."""
        self.run(POINTER % (x, y))
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        self.settle()
        self.frame(SHORT)
        self.run("document.querySelector('#pointer')?.remove()")

    def go(self, selector):
        quoted = json.dumps(selector)
        self.wait(f"document.querySelector({quoted}) && !document.querySelector({quoted}).disabled")
        self.still(selector)
        self.point(*self.run(f"(r => [r.x + r.width / 2, r.y + r.height / 2])(document.querySelector({quoted}).getBoundingClientRect())"))
        super().go(selector)  # the panel may be another since

    def still(self, selector):
        super().still(selector)
        time.sleep(0.3)

    def search(self, text):
        self.run(f"(e => {{ e.value = {json.dumps(text)}; e.dispatchEvent(new Event('input')); }})"
                 "(document.querySelector('#search'))")
        self.settle()

    def step(self, name):
        """A still for the docs, which is a longer frame too."""
        self.settle()
        self.run("document.querySelectorAll('#messages .message:not(.error)').forEach(e => e.remove())")
        self.frame(LONG)
        subprocess.run(["oiiotool", "--nosoftwareattrib", self.frames[-1][0], "--ch", "R,G,B", "--compression", "jpeg:82", "-o",
                        f"{self.out}/studio-{name}.jpg"], check=True)

    def record(self):
        parts = []
        for path, milliseconds in self.frames:
            subprocess.run(["oiiotool", "--nosoftwareattrib", path, "--ch", "R,G,B", "--resize", WIDE, "--compression",
                            "webp:70", "-o", f"{path}.webp"], check=True)
            parts.append((picture_chunks(f"{path}.webp"), milliseconds))
        with open(f"{self.out}/studio.webp", "wb") as file:
            file.write(animation(parts, *map(int, WIDE.split("x"))))


# ---- WebP: RIFF chunks ----

def chunk(name, data):
    return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) & 1)


def picture_chunks(path):
    """Those of a still that have its picture."""
    with open(path, "rb") as file:
        data = file.read()
    at, found = 12, b""
    while at < len(data):
        name, size = data[at:at + 4], struct.unpack("<I", data[at + 4:at + 8])[0]
        if name in (b"VP8 ", b"VP8L"):
            found += chunk(name, data[at + 8:at + 8 + size])
        at += 8 + size + (size & 1)
    return found


def animation(frames, width, height):
    """Frames, each whole, without end."""
    three = lambda value: struct.pack("<I", value)[:3]
    size = three(width - 1) + three(height - 1)
    chunks = chunk(b"VP8X", b"\2\0\0\0" + size) + chunk(b"ANIM", b"\xff\xff\xff\xff\0\0")
    for picture, milliseconds in frames:
        chunks += chunk(b"ANMF", three(0) + three(0) + size + three(milliseconds) + b"\2" + picture)
    return b"RIFF" + struct.pack("<I", len(chunks) + 4) + b"WEBP" + chunks


# ---- the walk ----

def clear(page):
    """Wait for a preview without grain, but not for ever."""
    page.wait("document.querySelector('#picture.shown')", 300)
    page.until("document.querySelector('#picture-note').textContent === ''", CLEAR)


def walk(page, server):
    page.open_studio(server)
    page.step("open")
    page.go(".browser button.row[aria-label^='living-room.pov']")
    clear(page)
    page.step("view")
    page.go("#next-button")
    page.surfaces()
    for number, (place, name) in enumerate(((FLOOR, "Floor"), (WALL, "Wall"))):
        page.point(*page.picture(*place))
        page.press_at(*page.picture(*place))
        page.wait(f"document.querySelector('#target-{number}')")
        page.surfaces()
        page.frame(SHORT)
    page.step("surfaces")
    page.go("#next-button")
    page.wait("document.querySelector('#finish-0-0') && !document.querySelector('#panel-body .spinner')", 300)
    page.step("light")
    page.go("#next-button")
    page.go("#next-button")
    for part in (0.05, 0.4, 0.8):
        page.wait(f"document.querySelector('.renders progress')?.value > {part} || document.querySelector('.renders .good')", 3600)
        page.frame(SHORT)
    page.wait("document.querySelector('.renders .good')", 3600)
    page.step("render")
    page.go("#next-button")
    page.wait("document.querySelector('retex-room')?.isComplete", 300)
    page.go("#root-1")
    for target, texture in (("Floor", "walnut"), ("Wall", "damask")):
        page.run(f"document.querySelector('retex-room').select({target!r})")
        page.search(texture)
        page.go("#swatch-0")
        page.wait(f"document.querySelector('retex-room').getState().textures[{target!r}]")
        page.run("document.querySelector('retex-room').toBlob().then(() => 0)")
        page.frame(SHORT)
    page.step("play")
    page.go("#next-button")
    page.go("#make-picture")
    page.wait("document.querySelector('.card a.button[download]')", 300)
    page.step("take")
    return not page.trouble()


def main(out):
    with tempfile.TemporaryDirectory() as work:
        os.mkdir(f"{work}/home")
        for name in os.listdir(f"{TOP}/scenes/living-room"):
            place = f"{TOP}/scenes/living-room/{name}"
            (shutil.copytree if os.path.isdir(place) else shutil.copy)(place, f"{work}/home/{name}")
        width, height = map(int, SIZE.split("x"))
        own_project(f"{work}/home", "living-room.pov", render={
            "width": width, "height": height, "samples": SAMPLES, "noise": 0, "denoise": True})
        server = Server(f"{work}/home", "--textures", f"{TOP}/scenes/textures")
        page = Recorder(work, out)
        try:
            page.size(1280, 800)
            good = walk(page, server)
            page.record()
        finally:
            page.close()
            server.close()
    sys.exit(0 if good else 1)


main(sys.argv[1])
