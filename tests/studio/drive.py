"""A server of retex-studio and its page in headless Chromium, driven as a person does: by clicks, keys and files."""
import json
import os
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
sys.path[:0] = [f"{TOP}/tests/web", HERE]
from page import Page, result  # noqa: E402

# Floor and wall, and things in a row; the floor fills the lower half of the picture.
SCENE = """camera { location <0, 1, -3> look_at <0, 1, 0> angle 50 }
light_source { <1, 3, -2> color rgb 2 }
#declare Floor = texture { pigment { color rgb <.5, .4, .3> } }
#declare Wall = texture { pigment { color rgb .7 } }
#declare Ball = texture { pigment { color rgb <.6, .3, .2> } }
plane { y, 0 texture { Floor } }
plane { z, 2 texture { Wall } }
sphere { <0, 1, 0>, .4 texture { Ball } }
"""
KEYS = {"Tab": 9, "Enter": 13, "Escape": 27, " ": 32, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}


class Server:
    """A retex-studio in a folder, which is its home; with a model, or without one, and then what will be opened."""

    running = []

    def __init__(self, work, *arguments, model="", opened="room.obj", environment=None):
        self.work, self.arguments, self.environment = work, arguments, environment
        self.model, name = model, model or opened
        self.folder, self.project_file = f"{name}.studio", f"{work}/{name}.studio.json"
        address = f"{work}/.address"
        if os.path.exists(address):
            os.remove(address)
        self.process = subprocess.Popen(
            ["retex-studio", *([model] if model else []), "--no-browser", "-o", address, *arguments], cwd=work,
            env={**os.environ, "HOME": work, **(environment or {})})
        self.running.append(self)
        while not os.path.exists(address):
            if self.process.poll() is not None:
                raise SystemExit("retex-studio has ended")
            time.sleep(0.02)
        with open(address, encoding="utf-8") as file:
            self.url = file.read().strip()

    def project(self):
        with open(self.project_file, encoding="utf-8") as file:
            return json.load(file)

    def children(self):
        """Processes of tools that run: name by number."""
        with open(f"/proc/{self.process.pid}/task/{self.process.pid}/children", encoding="utf-8") as file:
            numbers = file.read().split()
        found = {}
        for number in numbers:
            try:
                with open(f"/proc/{number}/cmdline", encoding="utf-8") as file:
                    found[int(number)] = file.read().replace("\0", " ").strip()
            except OSError:
                pass
        return found

    def rest(self, seconds=60):
        """Wait until neither it nor its tools have computed for as long as the test will look."""
        before, end = self.ticks(), time.time() + seconds
        while time.time() < end:
            time.sleep(5)
            now = self.ticks()
            if now - before <= 1:
                return
            before = now

    def ticks(self):
        """Processor time of the server and of the tools that it runs, in ticks."""
        total = 0
        for number in (self.process.pid, *self.children()):
            with open(f"/proc/{number}/stat", encoding="utf-8") as file:
                fields = file.read().rpartition(")")[2].split()
            total += int(fields[11]) + int(fields[12])
        return total

    def processor_seconds(self):
        """Of the server, of the tools that it runs, and of those that have ended."""
        with open(f"/proc/{self.process.pid}/stat", encoding="utf-8") as file:
            ended = sum(map(int, file.read().rpartition(")")[2].split()[13:15]))
        return (self.ticks() + ended) / os.sysconf("SC_CLK_TCK")

    def close(self):
        if self in self.running:
            self.running.remove(self)
            self.process.terminate()
        return self.process.wait(60)


class Studio(Page):
    def __init__(self, *options):
        super().__init__("", *options)
        self.clicks = self.keys = 0  # of the person

    # ---- what a person does ----

    def wait(self, code, seconds=90):
        if not self.until(f"(() => {{ try {{ return !!({code}); }} catch {{ return false; }} }})()", seconds):
            self.shot("studio-waits")
            raise SystemExit(f"this did not come: {code}")

    def press_at(self, x, y, times=1):
        self.clicks += times
        self.click(x, y, times)

    def go(self, selector):
        """Click a control that can be used."""
        quoted = json.dumps(selector)
        self.wait(f"document.querySelector({quoted}) && !document.querySelector({quoted}).disabled")
        self.still(selector)
        x, y = self.run(f"(() => {{ const e = document.querySelector({quoted}); e.scrollIntoView({{block: 'nearest'}}); "
                        "const r = e.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()")
        self.press_at(x, y)
        self.settle()

    def still(self, selector):
        """Wait until it stays where it is: panels are drawn anew."""
        where = f"(r => [r.x, r.y])(document.querySelector({json.dumps(selector)})?.getBoundingClientRect() || {{}}).join()"
        before = None
        for _ in range(40):
            now = self.run(where)
            if now == before:
                return
            before = now
            time.sleep(0.1)

    def hit(self, name, modifiers=0):
        """A key: 8 is with Shift, 2 with Ctrl."""
        self.keys += 1
        code = KEYS.get(name, ord(name.upper()[0]))
        text = "\r" if name == "Enter" else name if len(name) == 1 and not modifiers & 2 else ""
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=name if len(name) > 1 else "",
                      windowsVirtualKeyCode=code, modifiers=modifiers, **({"text": text} if text and kind == "keyDown" else {}))

    def write(self, selector, text):
        """Put a text into a field, and leave it."""
        self.go(selector)
        self.hit("a", 2)
        self.keys += len(text)
        self.call("Input.insertText", text=text)
        self.hit("Tab")
        self.settle()

    def put(self, selector, value):  # pylint: disable=arguments-differ
        self.run(f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.value = {json.dumps(value)}; "
                 "e.dispatchEvent(new Event('change')); })()")
        self.settle()

    def files(self, selector, *paths):
        """Choose files, as in the browser's dialog."""
        found = self.call("Runtime.evaluate", expression=f"document.querySelector({json.dumps(selector)})")
        self.call("DOM.setFileInputFiles", files=[os.path.abspath(p) for p in paths], objectId=found["result"]["objectId"])
        self.settle()

    def picture(self, across, down):
        """A place of the preview, as parts of its width and height."""
        return self.run("(() => { const r = document.querySelector('#picture').getBoundingClientRect(); "
                        f"return [r.x + r.width * {across}, r.y + r.height * {down}]; }})()")

    def address(self):
        """Of the page; "" while it goes from one to another."""
        try:
            history = self.call("Page.getNavigationHistory")
        except RuntimeError:
            return ""
        return history["entries"][history["currentIndex"]]["url"]

    def leave(self):
        """Close the page's window, or as good as that; whether the browser had to ask."""
        self.events.clear()
        self.call("Runtime.evaluate", expression="setTimeout(() => (location.href = 'about:blank'))")
        asked = False
        for _ in range(50):
            time.sleep(0.1)
            if any(e["method"] == "Page.javascriptDialogOpening" for e in self.events):
                asked = True
                self.events.clear()
                self.call("Page.handleJavaScriptDialog", accept=True)
            elif self.address() == "about:blank":
                break
        return asked

    # ---- what a person sees ----

    def open_studio(self, server, title="Open"):
        self.call("Page.navigate", url=server.url)
        self.wait(f"document.querySelector('#panel-title').textContent === {json.dumps(title)}")

    def saved(self, server):
        """The project, when the page says that all is saved."""
        self.wait("document.querySelector('#saved').textContent === 'All is saved'")
        return server.project()

    def told(self, words, seconds=30):
        """The message or card that has these words; "" if none comes."""
        code = ("[...document.querySelectorAll('#messages .message, [role=alert], [role=status]')].filter(e => e.checkVisibility())"
                f".map(e => e.textContent).find(t => t.includes({json.dumps(words)})) || ''")
        self.until(f"!!({code})", seconds)
        return self.run(code)

    def surfaces(self):
        """Wait until surfaces can be clicked."""
        self.wait("document.querySelector('#seen summary')")

    def trouble(self):
        """Whether something is wrong that nobody asked for."""
        wrong = [e["params"] for e in self.events if e["method"] in ("Runtime.exceptionThrown", "Log.entryAdded")]
        self.events.clear()
        for found in wrong:
            print("#", str(found)[:300])
        return bool(wrong) or self.run("[...document.querySelectorAll('.message.error')].map(e => e.textContent).join()")


def small_scene(work, text=SCENE, name="room.pov"):
    with open(f"{work}/{name}", "w", encoding="utf-8") as file:
        file.write(text)
    return name


def own_project(work, name, **members):
    """A project of this model that the user's own studio has made."""
    server = Server(work, model=name)
    server.close()
    with open(server.project_file, "w", encoding="utf-8") as file:
        json.dump({"retex-studio": 1, "model": name, **members}, file)


def each(checks):
    """Each check with a folder of its own, and with one browser; those that are named, or all."""
    page = Studio()
    try:
        page.size(1280, 800)
        for check in checks:
            if sys.argv[1:] and check.__name__ not in sys.argv[1:]:
                continue
            with tempfile.TemporaryDirectory() as work:
                page.size(1280, 800)
                page.events.clear()
                try:
                    check(page, work)
                except SystemExit as error:
                    result(False, f"{check.__name__}: {error}")
                page.leave()
                for server in list(Server.running):
                    server.close()
    finally:
        page.close()
