"""Checks <retex-room> as part of other pages in headless Chromium, and prints TAP: element.py FOLDER.

FOLDER has folders of rooms, room/ and those of web-element.sh, and pictures, textures/."""
import json
import sys

from browser import serve
from page import PART, ROOM, Page, finish, result
from refused import check_refused
from trouble import check_trouble

work = sys.argv[1]
url = serve(work)
EVENTS = ["still", "ready", "complete", "change", "select", "draw", "error"]


def write(name, body, head=""):
    listen = f"""window.seen = []; for (const name of {json.dumps(EVENTS)}) document.addEventListener('retex-' + name,
        event => seen.push([name, event.detail, event.target.id]));"""
    with open(f"{work}/{name}", "w", encoding="utf-8") as file:
        file.write(f"<!doctype html><html lang=en><meta name=viewport content='width=device-width'><title>A page</title>{head}"
                   f"<script>{listen}</script>{body}<script type=module src='room/retex-room.js'></script>")


def check_events(page):
    write("plain.html", "<retex-room id=one src=room></retex-room>")
    page.open(url + "plain.html")
    names = [name for name, *_ in page.run("seen") if name in ("still", "ready", "complete", "error")]
    result(names == ["still", "ready", "complete"], f"events while loading, in this order: {names}")
    details = {name: detail for name, detail, _ in page.run("seen")}
    result(details["ready"] == {"targets": page.room("targets")} == {"targets": ["Floor", "Wall"]}, "retex-ready names the targets")
    page.run("seen.length = 0")
    page.room("setTexture('Floor', '#804020', {rotate: 30})")
    page.settle()
    seen = page.run("seen")
    result([d for n, d, _ in seen if n == "change"] == [page.state()], "retex-change has the state")
    result([d["milliseconds"] > 0 for n, d, _ in seen if n == "draw"] == [True], "retex-draw: once, with its time")
    result({i for *_, i in seen} == {"one"}, "events bubble to the page, and come from the element")
    page.room("select('Floor')")
    result(page.run("seen.at(-1)")[:2] == ["select", {"target": "Floor"}], "retex-select has the target")
    for name, code, words in (
            ("a target that is none", "setTexture('Roof', '#000000')", "no 'Roof'"),
            ("a picture that is missing", "setTexture('Floor', 'nothing.jpg')", "nothing.jpg is missing"),
            ("an offset that is none", "setTexture('Floor', '#000000', {offset: 3})", "offset")):
        before = page.state()
        said = page.run(f"{ROOM}.{code}.then(() => '', e => e.message)")
        result(words in said and page.state() == before, f"{name} is refused, and nothing changes: {said}")


def check_methods(page):
    page.room("setTexture('Floor', 'textures/brick.jpg', {scale: [2, 3], flip: 'u', label: 'Bricks'})")
    page.room("place('Floor', {rotate: 45})")
    state = page.state()["textures"]
    result(list(state) == ["Floor"] and state["Floor"]["scale"] == [2, 3] and state["Floor"]["rotate"] == 45 and
           state["Floor"]["flip"] == "u", "place() leaves the rest as it was")
    result("Floor: Bricks" in page.run(f"{PART}('canvas').getAttribute('aria-label')"), "a label is used")
    later = page.run(f"""(async () => {{
        const slow = {ROOM}.setTexture('Wall', 'textures/fans.jpg'), fast = {ROOM}.setTexture('Wall', '#112233');
        await Promise.all([slow, fast]);
        return {ROOM}.getState().textures.Wall.source;
    }})()""")
    result(later == "#112233", "of two textures at once the one asked for last is kept")
    page.room("setState({})")
    picture = "toBlob().then(b => b.arrayBuffer()).then(a => String(new Uint8Array(a)))"
    plain = page.room(picture)
    page.room("setState({textures: {Floor: {source: 'textures/brick.jpg'}, Wall: {source: '#112233'}}})")
    edited = page.room(picture)
    page.run(f"{ROOM}.command('compare'), {PART}('.split').value = 100")
    result(edited != plain and page.room(picture) == plain, "before and after: the side before is the picture with its originals")
    page.run(f"{ROOM}.command('compare'), {PART}('.split').value = 50")
    kind = page.room("toBlob('image/jpeg', 0.8).then(b => [b.type, b.size > 2000])")
    result(kind == ["image/jpeg", True], "toBlob() in another format")
    state, link = page.state(), page.room("link")
    page.room("setState({})")
    result(page.state()["textures"] == {}, "setState() of nothing: the originals")
    page.room(f"setState({json.dumps(state)})")
    result(page.state() == state, "setState() of getState()")
    write("no-link.html", "<retex-room src=room/ no-link></retex-room>")
    page.open(link.replace("plain.html", "no-link.html"))
    result(page.state()["textures"] == {}, "no-link: the address is not read")
    page.run(f"seen.length = 0; window.room = {ROOM}; room.remove(); document.body.append(room)")
    result(page.until("seen.some(e => e[0] === 'complete')", 120) and page.room("targets.length") == 2, "moved, it loads again")
    page.run("seen.length = 0; room.setAttribute('src', 'nothing')")
    result(page.until("seen.some(e => e[0] === 'error')") and page.run("seen.at(-1)")[1]["message"] == page.message() != "",
           f"retex-error has the message: {page.message()}")
    page.press("[data-do=close]")
    result(page.message() == "", "the message can be closed")
    page.run("seen.length = 0; room.setAttribute('src', 'room'); setTimeout(() => room.remove(), 30)")
    page.run("new Promise(done => setTimeout(done, 1500))")
    result(not page.run("seen.filter(e => e[0] === 'error')"), "removed while it loads: no error")


def check_sizes(page):
    """The picture keeps its proportions in every size, and is not larger than the element."""
    write("sizes.html", "<retex-room src=room/ textures='textures/brick.jpg'></retex-room>")
    page.open(url + "sizes.html")
    for size in ("", "width: 900px; height: 320px", "width: 480px; height: 420px", "width: 330px; height: 700px",
                 "width: 1200px; height: 500px"):
        for panel in (True, False):
            page.run(f"{ROOM}.style.cssText = '{size}'; {ROOM}.togglePanel({str(panel).lower()})")
            page.settle()
            box, of, tools, shown = page.run(f"""['canvas', ':host', '.tools', '.panel'].map(s => {{
                const e = s === ':host' ? {ROOM} : {PART}(s), r = e.getBoundingClientRect(); return [r.x, r.y, r.right, r.bottom]; }})""")
            ratio = (box[2] - box[0]) / (box[3] - box[1])
            inside = all(b[0] >= of[0] - 1 and b[1] >= of[1] - 1 and b[2] <= of[2] + 1 and b[3] <= of[3] + 1 for b in (box, tools))
            part = (box[2] - box[0]) * (box[3] - box[1]) / ((of[2] - of[0]) * (of[3] - of[1]))
            result(abs(ratio * 9 / 16 - 1) < 0.01 and inside and part > 0.17 and panel == (shown[2] > shown[0]),
                   f"{size or 'no size'}, controls {'shown' if panel else 'hidden'}: {ratio:.2f}, {100 * part:.0f} % of the element")
    page.shot("sizes")
    write("picture.html", "<retex-room src=room/ panel=closed></retex-room>")
    page.open(url + "picture.html")
    told = f"{PART}('[data-do=panel]').getAttribute('aria-expanded')"
    result(page.run(f"{PART}('.panel').hidden && {PART}('.stage').offsetWidth === {ROOM}.offsetWidth && {told} === 'false'"),
           "panel=\"closed\": the picture alone, and so the button says")
    page.press("[data-do=panel]")
    result(page.run(f"!{PART}('.panel').hidden && {told} === 'true'"),
           "and its button shows the controls")
    write("part.html", "<retex-room src=room/></retex-room>", "<style>retex-room::part(panel) { display: none }</style>")
    page.open(url + "part.html")
    result(page.run(f"{PART}('.stage').offsetWidth === {ROOM}.offsetWidth"), "::part(panel) hidden: no place is left for it")


def drag(page, kind, x, y, files):
    page.call("Input.dispatchDragEvent", type=kind, x=x, y=y, data={"items": [], "files": files, "dragOperationsMask": 1})


def check_drop(page):
    """A file dragged from the desktop: over the wall, over the controls, away, dropped."""
    page.size(1280, 800)
    write("drop.html", "<retex-room src=room/ style='height: 95vh'></retex-room>")
    page.open(url + "drop.html")
    page.room("select('Floor')")
    photo = [f"{work}/textures/fans.jpg"]
    x, y, width, height = page.run(f"(r => [r.x, r.y, r.width, r.height])({PART}('canvas').getBoundingClientRect())")
    wall, panel = (x + width * 0.25, y + height * 0.3), page.middle(".panel")
    said = f"({PART}('.room').classList.contains('drop') && !{PART}('.name').hidden ? {PART}('.name').textContent : '')"
    for kind in ("dragEnter", "dragOver"):
        drag(page, kind, *wall, photo)
    page.settle()
    result(page.run(said) == "Put it on: Wall", f"dragged over the wall: {page.run(said)}")
    page.shot("drop")
    for _ in range(5):  # the browser tells the page of a drag to another place only with the next event
        drag(page, "dragOver", *panel, photo)
        if page.until(f"{said} === 'Put it on: Floor'", 1):
            break
    result(page.run(said) == "Put it on: Floor", f"dragged over the controls: {page.run(said)}")
    leave = "{bubbles: true, cancelable: true, relatedTarget: %s}"
    page.run(f"{PART}('.panel').dispatchEvent(new DragEvent('dragleave', {leave % (PART + '(`.stage`)')}))")
    inside = page.run(said)
    page.run(f"{PART}('.panel').dispatchEvent(new DragEvent('dragleave', {leave % 'null'}))")
    result(inside != "" and page.run(said) == "", "dragged away: the words go, not before")
    for place, target in ((wall, "Wall"), (panel, "Wall")):
        page.room("setState({})")
        for kind in ("dragEnter", "dragOver", "drop"):
            drag(page, kind, *place, photo)
        result(page.until(f"{ROOM}.textures[{ROOM}.targets.indexOf('{target}')].label === 'fans.jpg'") and page.run(said) == "",
               f"dropped on the {'controls' if place == panel else 'wall'}: it lies on the {target}")


CONTRAST = """(() => {
    const context = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
    const paint = colors => { context.clearRect(0, 0, 1, 1); for (const c of colors) context.fillStyle = c, context.fillRect(0, 0, 1, 1);
        return [...context.getImageData(0, 0, 1, 1).data].slice(0, 3); };
    const luminance = rgb => { const [r, g, b] = rgb.map(x => x / 255).map(x => x <= .04045 ? x / 12.92 : ((x + .055) / 1.055) ** 2.4);
        return .2126 * r + .7152 * g + .0722 * b; };
    const root = ROOM.shadowRoot, found = [];
    for (const e of root.querySelectorAll('*')) {
        const own = [...e.childNodes].some(n => n.nodeType === 3 && n.data.trim()) || e.tagName === 'svg';
        if (!own || ['STYLE', 'OPTION'].includes(e.tagName) || !e.getClientRects().length || e.closest('.quiet, :disabled')) continue;
        const colors = [];
        for (let p = e; p; p = p.parentElement || p.getRootNode().host) colors.unshift(getComputedStyle(p).backgroundColor);
        const back = luminance(paint(['#fff', ...colors])), front = luminance(paint(['#fff', ...colors, getComputedStyle(e).color]));
        found.push([(Math.max(front, back) + .05) / (Math.min(front, back) + .05), e.textContent.trim() || e.parentElement.title]);
    }
    return found.sort((a, b) => a[0] - b[0]);
})()""".replace("ROOM", ROOM)

TREE = """group Picture
image The room. Floor: brick.jpg, Wall: Original.
group View
button Before and after
button Zoom out
button Zoom in
button Full screen
button Download the picture
button Copy a link to this room
button Controls
heading Surface
group Surface
button Floor
button Wall
heading Texture brick
group Texture
button brick
button walnut herringbone
group Colours
button Colour #e9e4da
button Colour #b9a48c
button Colour #7d5f48
button Colour #8b9a86
button Colour #44525c
button Colour #2b2b2b
ColorWell Any colour
button Your photo…
button Original
slider Size
slider Turn
slider Shift right
slider Shift up
combobox Repeats
slider Grout
slider Saturation
slider Lightness
ColorWell Tint
heading Light
slider Brightness
slider Warmth""".split("\n")


def check_access(page):
    """What screen readers are told, in which order, and what people see who need contrast or calm."""
    write("access.html", "<retex-room src=room/ textures='textures/brick.jpg textures/walnut-herringbone.jpg'></retex-room>")
    page.size(1280, 800)
    page.open(url + "access.html")
    page.room("setTexture('Floor', 'textures/brick.jpg')")
    page.room("select('Floor')")
    page.settle()
    nodes = {n["nodeId"]: n for n in page.call("Accessibility.getFullAXTree")["nodes"]}
    read = []

    def walk(node):
        role, name = (node.get(k, {}).get("value", "") for k in ("role", "name"))
        if not node.get("ignored") and role in {line.split()[0] for line in TREE} | {"checkbox", "link", "textbox"}:
            read.append((f"{role} {name}", {p["name"]: p["value"].get("value") for p in node.get("properties", [])}, node))
        for child in node.get("childIds", []):
            walk(nodes[child])
    walk(next(n for n in nodes.values() if not n.get("parentId")))
    names = [line for line, *_ in read]
    wrong = [f"{a!r} is not {b!r}" for a, b in zip(names + [""] * 99, TREE) if a != b][:3] + names[len(TREE):]
    result(not wrong, f"screen readers read {len(names)} things, as they are seen {wrong or ''}")
    states = {line: properties for line, properties, _ in read}
    result(states["button Floor"].get("pressed") == "true" and states["button Wall"].get("pressed") == "false" and
           states["button brick"].get("pressed") == "true" and states["button Controls"].get("expanded") is True,
           "and what is chosen")
    values = [n.get("value", {}).get("value") for line, _, n in read if line == "slider Size"]
    result(page.run(f"{PART}('[data-set=size]').getAttribute('aria-valuetext')") == "1.00×" and len(values) == 1, "values as words")
    page.run("document.activeElement.blur()")
    order = []
    for _ in range(40):
        page.key("Tab", 9)
        order.append(page.run(f"(e => e && (e.getAttribute('aria-label') || e.dataset.set || e.textContent.trim()))({ROOM}.shadowRoot.activeElement)"))
    order = order[:order.index(None)] if None in order else order
    wanted = [line.split(" ", 1)[1] for line in TREE if line.split()[0] not in ("image", "heading") and line not in
              ("group View", "group Surface", "group Texture", "group Colours")]
    sets = {"Your photo…": "file", "Size": "size", "Turn": "rotate", "Shift right": "right", "Shift up": "up", "Repeats": "repeat",
            "Grout": "grout", "Saturation": "saturation", "Lightness": "lightness", "Tint": "tint", "Brightness": "exposure", "Warmth": "warmth"}
    wanted = [sets.get(w, w) for w in wanted]
    result(order == wanted, f"Tab goes through all {len(wanted)} in this order {'' if order == wanted else order}")
    for scheme in ("light", "dark"):
        page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        page.settle()
        found = page.run(CONTRAST)
        result(len(found) > 25 and found[0][0] >= 4.5, f"{scheme}: contrast of words and icons is at least 4.5: {found[0]}")
    moves = f"""[...{ROOM}.shadowRoot.querySelectorAll('*')].filter(e => /[1-9]/.test(getComputedStyle(e).transitionDuration) ||
        getComputedStyle(e).animationName !== 'none').map(e => e.tagName)"""
    before = page.run(moves)
    page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
    result(before == ["CANVAS"] and page.run(moves) == [], "with reduced motion nothing moves by itself")
    page.call("Emulation.setEmulatedMedia", features=[])
    page.size(390, 844, True)
    page.open(url + "access.html")
    page.room("setTexture('Floor', 'textures/brick.jpg')")
    page.room("select('Floor')")
    small = page.run(f"""[...{ROOM}.shadowRoot.querySelectorAll('button, select, label, input[type=color]')]
        .map(e => [e.getBoundingClientRect(), e]).filter(([r]) => r.width && Math.min(r.width, r.height) < 36)
        .map(([r, e]) => [r.width, r.height, e.outerHTML.slice(0, 60)])""")
    result(not small, f"on a phone every control is at least 36 pixels wide and high {small or ''}")
    wide = page.run("document.documentElement.scrollWidth")
    result(wide <= 390, "and nothing is wider than the phone")


def main():
    page = Page(url)
    try:
        page.size(1280, 800)
        check_events(page)
        check_methods(page)
        check_sizes(page)
        check_drop(page)
        check_access(page)
        page.size(1280, 800)
        check_refused(page, url, work, write)
        check_trouble(page, url, work, write)
        bad = [e["params"]["exceptionDetails"]["text"] for e in page.events if e.get("method") == "Runtime.exceptionThrown"]
        result(not bad, f"no script fails {bad or ''}")
    finally:
        page.close()
    finish()


main()
