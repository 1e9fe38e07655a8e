"""What goes wrong for visitors of a page with a room: odd pictures, bad connections, links, odd rooms. For element.py."""
import base64
import functools
import http.server
import json
import os
import subprocess
import threading

from page import PART, ROOM, psnr, result

BROKEN = {}  # part of a path: how many times it breaks yet, and with which status, 0: in the middle
GREEN_CMYK = (  # a JPEG file of four colours
    "/9j/7gAOQWRvYmUAZAAAAAAC/9sAQwANCQoLCggNCwoLDg4NDxMgFRMSEhMnHB4XIC4pMTAuKS0sMzpKPjM2RjcsLUBXQUZMTlJT"
    "UjI+WmFaUGBKUVJP/9sAQwEODg4TERMmFRUmTzUtNU9PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09PT09P"
    "T09PT09P/8AAFAgAEAAQBAEiAAIRAQMRAQQiAP/EABYAAQEBAAAAAAAAAAAAAAAAAAAFBv/EABQQAQAAAAAAAAAAAAAAAAAAAAD/"
    "xAAUAQEAAAAAAAAAAAAAAAAAAAAG/8QAFBEBAAAAAAAAAAAAAAAAAAAAAP/aAA4EAQACEQMRBAAAPwCKATmTcgP/2Q==")
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 10"><rect width="20" height="10" fill="#0d0"/></svg>"""


class Breaking(http.server.SimpleHTTPRequestHandler):
    """Files, some of which do not arrive."""

    def do_GET(self):
        for part, (times, status) in BROKEN.items():
            if part not in self.path or not times:
                continue
            BROKEN[part] = times - 1, status
            if status:
                return self.send_error(status)
            with open(self.translate_path(self.path), "rb") as file:
                data = file.read()
            self.send_response(200)
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            self.wfile.write(data[:len(data) // 2])
            self.close_connection = True
            return None
        return super().do_GET()

    def log_message(self, *_):
        pass


def breaking_server(folder):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Breaking, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}/"


def make_pictures(folder):
    """Green ones, and files that are none. The turned one is a photograph of a camera held upright."""
    os.makedirs(folder, exist_ok=True)
    green = "--pattern constant:color=0,.7,0"
    for options in (f"{green} 8000x900 3 -o huge.jpg", f"{green} 1x1 3 -o tiny.png", f"{green} 8000x1 3 -o line.png",
                    f"{green} 40x40 3 --pattern constant:color=1,0,0 40x40 3 --siappend -o moves.gif",
                    "--pattern fill:top=1,0,0:bottom=0,.7,0 200x400 3 --attrib Orientation 6 --compression jpeg:100 -o turned.jpg",
                    "turned.jpg --reorient --compression jpeg:100 -o upright.jpg"):
        subprocess.run(["oiiotool", *options.replace("-o ", "-d uint8 -o ").split()], cwd=folder, check=True)
    with open(f"{folder}/huge.jpg", "rb") as file:
        start = file.read()[:3000]
    for name, data in (("cut.jpg", start), ("empty.png", b""), ("text.jpg", b"hello\n"), ("drawing.svg", DRAWING.encode()),
                       ("cmyk.jpg", base64.b64decode(GREEN_CMYK))):
        with open(f"{folder}/{name}", "wb") as file:
            file.write(data)


def pixel(page, x, y):
    """What is seen at this part of the picture."""
    return page.room(f"""toBlob().then(() => {{
        const c = document.createElement('canvas').getContext('2d', {{willReadFrequently: true}}), from = {PART}('canvas');
        c.drawImage(from, 0, 0);
        return [...c.getImageData(Math.floor(from.width * {x}), Math.floor(from.height * {y}), 1, 1).data].slice(0, 3); }})""")


def is_green(rgb):
    return rgb[1] > 40 and rgb[1] > 2 * max(rgb[0], rgb[2])


def check_pictures(page, url, work, write):
    write("odd.html", "<retex-room src=room/ textures='odd/drawing.svg' style='height: 95vh'></retex-room>")
    make_pictures(f"{work}/odd")
    page.size(1280, 800)
    page.open(url + "odd.html")
    left, top, width, height = page.run(f"(r => [r.x, r.y, r.width, r.height])({PART}('canvas').getBoundingClientRect())")
    wall = {"x": left + width * 0.25, "y": top + height * 0.3}

    def drop(name):
        page.room("setState({})")
        page.room("fail(null)")
        for kind in ("dragEnter", "dragOver", "drop"):
            page.call("Input.dispatchDragEvent", type=kind, **wall,
                      data={"items": [], "files": [f"{work}/odd/{name}"], "dragOperationsMask": 1})
        page.until(f"!!{ROOM}.textures[1].image || !{PART}('.message').hidden", 60)
    for name in ("huge.jpg", "tiny.png", "line.png", "moves.gif", "cmyk.jpg", "drawing.svg"):
        drop(name)
        seen = pixel(page, 0.25, 0.3)
        result(is_green(seen) and not page.message(), f"{name} dropped on the wall: it is seen, {seen} {page.message()}")
    for name in ("turned.jpg", "upright.jpg"):
        drop(name)
        page.save(f"{work}/{name}.png")
    decibels = psnr(f"{work}/turned.jpg.png", f"{work}/upright.jpg.png")
    result(decibels > 30, f"a photograph lies as it was taken: {decibels:.1f} dB")
    for name in ("cut.jpg", "empty.png", "text.jpg"):
        drop(name)
        result(name in page.message() and page.room("textures[1].image") is None, f"{name} is refused: {page.message()}")
    page.room("fail(null)")
    page.press(".swatch")
    result(page.until(f"{ROOM}.textures[1].label === 'drawing.svg'") and is_green(pixel(page, 0.25, 0.3)),
           "an offered drawing without a size")
    labels = page.room("""setTexture('Wall', 'data:image/gif;base64,R0lGODlhAQABAIAAAAD/AP///yH5BAAAAAAALAAAAAABAAEAAAICRAEAOw==')
        .then(() => [room.textures[1].label], error => [error.message])""".replace("room.tex", f"{ROOM}.tex"))
    labels.append(page.room("setTexture('Wall', '50%.jpg').catch(error => error.message)"))
    result(labels[0] == "Picture" and labels[1].startswith("50%.jpg is missing"), f"addresses that are no names of files: {labels}")


def check_connection(page, work):
    """Files that stop in the middle, a busy server, a slow line."""
    url = breaking_server(work)
    page.call("Network.enable")
    page.call("Network.setCacheDisabled", cacheDisabled=True)
    for name, part, times in (("that breaks twice", "sharp", (2, 0)), ("to a busy server", "indep", (1, 503)),
                              ("that breaks at first", "room.json", (1, 0))):
        BROKEN.clear()
        BROKEN[part] = times
        page.open(url + "plain.html")
        result(page.room("renderer && !!document.querySelector('retex-room').renderer.complete") and not page.message() and
               BROKEN[part][0] == 0, f"a connection {name}: the files are asked for again {page.message()}")
    BROKEN["sharp"] = 999, 0
    page.open(url + "plain.html")
    result("could not be loaded" in page.message() and page.run(f"{PART}('img').naturalWidth > 0 && !{PART}('img').hidden"),
           f"a connection that stays away: {page.message()}")
    BROKEN.clear()
    page.call("Network.emulateNetworkConditions", offline=False, latency=200, downloadThroughput=30000, uploadThroughput=30000)
    page.open(url + "plain.html", "1")
    shown = page.until("window.seen && seen.some(e => e[0] === 'still')", 60)
    bar = page.run(f"(b => [b.hidden, b.value])({PART}('.bar'))")
    done = page.until("seen.some(e => e[0] === 'complete')", 60)
    result(shown and bar[0] is False and 0 < bar[1] < 1 and done,
           f"a slow line: the picture first, at {100 * bar[1]:.0f} % of the bytes, with a bar")
    page.call("Network.emulateNetworkConditions", offline=False, latency=0, downloadThroughput=-1, uploadThroughput=-1)


def check_links(page, url, write):
    write("two.html", "<retex-room id=hall src=room/></retex-room><retex-room id=den src=room/></retex-room>")
    both = "Promise.all([hall.complete, den.complete])"
    page.open(url + "two.html#top", both)
    page.run("hall.setTexture('Floor', '#ff0000').then(() => history.replaceState(null, '', hall.link))")
    page.run("den.setTexture('Wall', '#0000ff').then(() => history.replaceState(null, '', den.link))")
    link = page.run("location.href")
    page.open(link, both)
    states = [[(n, t["source"]) for n, t in page.run(f"{room}.getState().textures").items()] for room in ("hall", "den")]
    result(states == [[("Floor", "#ff0000")], [("Wall", "#0000ff")]], f"two rooms on a page: one link has both, {states}")
    page.open(url + "plain.html")
    source = f"({ROOM}.getState().textures.Floor || {{}}).source"
    page.run(f"{ROOM}.id = ''")
    for color in ("#ff0000", "#0000ff"):
        page.room(f"setTexture('Floor', '{color}')")
        page.run(f"history.pushState(null, '', {ROOM}.link)")
    page.run("history.back()")
    result(page.until(f"{source} === '#ff0000'"), "back: the room of the link before")
    page.run("history.forward()")
    result(page.until(f"{source} === '#0000ff'"), "forward again")
    page.room("setState({textures: {Floor: {source: 'gone.jpg'}, Wall: {source: '#00ff00'}}}).catch(e => 0)")
    result(page.room("getState().textures.Wall.source") == "#00ff00", "a texture that is gone does not keep the others away")
    page.run("Object.defineProperty(navigator, 'clipboard', {value: undefined})")
    page.room("command('link')")
    said = page.run(f"{PART}('.name').textContent")
    result("address bar" in said, f"without a clipboard: {said}")


def check_places(page, url):
    """Rooms of one target and of eight, one target of which nothing is seen, of a pixel, of 4000 pixels across."""
    for name, count in (("one", 1), ("unseen", 2), ("pixel", 1), ("wide", 1), ("eight", 8)):
        page.open(f"{url}{name}/index.html")
        targets, last = page.room("targets"), "A" if count < 8 else "H"
        page.room(f"setTexture('{last}', '#00ff00')")
        seen = page.room(f"""toBlob().then(() => {{
            const c = Object.assign(document.createElement('canvas'), {{width: 256, height: 192}}).getContext('2d');
            c.drawImage({PART}('canvas'), 0, 0, 256, 192);
            const d = c.getImageData(0, 0, 256, 192).data;
            return d.filter((x, i) => i % 4 === 1 && x > 30 && x > 2 * d[i - 1]).length; }})""")
        page.shot(f"room-{name}")
        result(len(targets) == count and not page.message() and seen > 50, f"room '{name}': {last} is green in {seen} pixels")
        off = page.run(f"[...{ROOM}.shadowRoot.querySelectorAll('.targets button')].filter(b => b.disabled).map(b => [b.textContent, b.title])")
        result(off == ([["B", "Not seen in this picture"]] if name == "unseen" else []), f"room '{name}': what cannot be changed: {off}")


def check_forced(page, url):
    """Colours of the system in place of the page's: what is offered, and what is chosen, is still seen. No full screen."""
    page.call("Emulation.setEmulatedMedia", features=[{"name": "forced-colors", "value": "active"}])
    page.open(url + "access.html")
    page.room("setTexture('Floor', '#7d5f48')")
    page.room("select('Floor')")
    page.settle()
    colors = page.run(f"[...{ROOM}.shadowRoot.querySelectorAll('.colors .swatch')].map(e => getComputedStyle(e).backgroundColor)")
    rings = page.run(f"[...{ROOM}.shadowRoot.querySelectorAll('.panel [aria-pressed]')].map(e => "
                     "[e.getAttribute('aria-pressed') === 'true', getComputedStyle(e).outlineStyle !== 'none'])")
    page.shot("forced")
    result(len(set(colors)) == len(colors) == 6 and all(a == b for a, b in rings) and any(a for a, _ in rings),
           "colours of the system: offered colours are seen, and what is chosen")
    page.call("Emulation.setEmulatedMedia", features=[])
    script = page.call("Page.addScriptToEvaluateOnNewDocument",
                       source="Object.defineProperty(Document.prototype, 'fullscreenEnabled', {get: () => false})")["identifier"]
    page.open(url + "plain.html")
    page.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
    result(page.run(f"{PART}('[data-do=full]').hidden"), "no button for full screen on a phone that has none")


def check_trouble(page, url, work, write):
    check_pictures(page, url, work, write)
    check_links(page, url, write)
    check_places(page, url)
    check_forced(page, url)
    check_connection(page, work)
