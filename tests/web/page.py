"""What tests do with a page that shows a room, and their results as TAP."""
import base64
import json
import os
import subprocess
import time

from browser import Browser

number = 0


def result(good, name):
    global number
    number += 1
    print(f"{'ok' if good else 'not ok'} {number} - {name}", flush=True)


def psnr(a, b):
    text = subprocess.run(["retex-diff", "--json", a, b], capture_output=True, text=True, check=False).stdout
    return json.loads(text)["psnr"]


def finish():
    print(f"1..{number}")


ROOM = "document.querySelector('retex-room')"
PART = ROOM + ".shadowRoot.querySelector"


class Page(Browser):
    """A browser that shows a page with one room. base: the address that textures' names continue."""

    def __init__(self, base, *options):
        super().__init__(*options)
        self.base = base

    def room(self, code):
        return self.run(f"{ROOM}.{code}")

    def save(self, path):
        data = self.room("toBlob().then(x => x.arrayBuffer()).then(a => { let s = ''; for (const c of new Uint8Array(a)) "
                         "s += String.fromCharCode(c); return btoa(s); })")
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def put(self, target, texture, options="{scale: [1, 1]}"):
        source = "null" if texture is None else json.dumps(self.base + texture)
        self.room(f"setTexture('{target}', {source}, {options})")

    def middle(self, selector):
        box = self.run(f"(() => {{ const r = {PART}({json.dumps(selector)}).getBoundingClientRect(); "
                       "return [r.x, r.y, r.width, r.height]; })()")
        return box[0] + box[2] / 2, box[1] + box[3] / 2

    def press(self, selector, touch=False):
        self.run(f"{PART}({json.dumps(selector)}).scrollIntoView({{block: 'nearest'}})")
        if touch:
            self.touch(selector)
        else:
            self.click(*self.middle(selector))
        self.settle()

    def touch(self, selector):
        """Tap until it is noticed: the browser drops taps while a swipe moves the page or a slow script runs."""
        self.run(f"window.seen = 0; {PART}({json.dumps(selector)}).addEventListener('click', () => window.seen++, "
                 "{once: true})")
        for _ in range(4):
            time.sleep(0.5)
            self.tap([self.middle(selector)])
            if self.until("window.seen > 0", 3):
                return

    def settle(self):
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 60))))")

    def until(self, code, seconds=20):
        end = time.time() + seconds
        while time.time() < end:
            if self.run(code):
                return True
            time.sleep(0.1)
        return False

    def state(self):
        return self.room("getState()")

    def message(self):
        return self.run(f"{PART}('.message').hidden ? '' : {PART}('.message').textContent")

    def shot(self, name):
        folder = os.environ.get("RETEX_WEB_SHOTS")
        if folder:
            os.makedirs(folder, exist_ok=True)
            self.screenshot(f"{folder}/{name}.png")
