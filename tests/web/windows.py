"""Pages with rooms in windows of many sizes, and which surface is chosen, as TAP, for long/web-windows: windows.py FOLDER.

FOLDER has hall/, a room with targets Floor, Wall and Side and a floor that reflects the others, one/ with one target,
object.exr, which object each pixel of hall/ shows, and textures/."""
import os
import sys

import numpy as np
import OpenImageIO as oiio
from browser import serve
from page import PART, ROOM, Page, finish, result

work = sys.argv[1]
url = serve(work)
WINDOWS = [(1280, 800), (1440, 800), (800, 1200), (390, 844), (360, 640)]
TEXTURES = [f"/textures/{name}" for name in sorted(os.listdir(work + "/textures")) if name.endswith(".jpg")]
PRESSED = f"[...{PART}('.targets').children].filter(b => b.getAttribute('aria-pressed') === 'true').map(b => b.textContent)"


def offers(count):
    """So many addresses."""
    return " ".join(f"{TEXTURES[i % len(TEXTURES)]}?{i}" for i in range(count))


def write(name, body):
    with open(f"{work}/{name}", "w", encoding="utf-8") as file:
        file.write(f"<!doctype html><html lang=en><title>A page</title><meta name=viewport content='width=device-width'>{body}"
                   "<script type=module src='hall/retex-room.js'></script>")


def check_windows(page):
    """The page that retex-pack writes, and an element between other things, with few and many textures."""
    with open(work + "/hall/index.html", encoding="utf-8") as file:
        index = file.read()
    for room in ("hall", "one"):
        for count in (0, 3, 60):
            name = f"{room}/list-{count}.html"
            with open(f"{work}/{name}", "w", encoding="utf-8") as file:
                file.write(index.replace('src="."', f'src="." textures="{offers(count)}"'))
            page.size(*WINDOWS[0])
            page.open(url + name)
            wrong = []
            for width, height in WINDOWS:
                for factor in (1, 2, 3):
                    page.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=factor,
                              mobile=False)
                    page.settle()
                    page.run(f"{PART}('[data-set=warmth]').scrollIntoView(), {PART}('[data-set=file]').focus()")
                    seen = page.run(f"""(() => {{ const e = document.documentElement, p = {PART}('.panel');
                        return [e.scrollWidth, e.scrollHeight, innerWidth, innerHeight, scrollX + scrollY, p.scrollHeight - p.clientHeight]; }})()""")
                    if seen[:2] != seen[2:4] or seen[4] or (count == 60) > (seen[5] > 0):
                        wrong.append((width, height, factor, seen))
            result(not wrong, f"{room}, {count} textures: the page is as large as its window, the list scrolls inside {wrong or ''}")
    write("between.html", f"<h1>Rooms</h1><retex-room src=hall textures='{offers(60)}'></retex-room><p id=below>Below</p>")
    page.open(url + "between.html")
    wrong = []
    for width, height in WINDOWS:
        page.size(width, height)
        page.settle()
        room, below, high = page.run(f"[{ROOM}.getBoundingClientRect().bottom + scrollY, below.getBoundingClientRect().bottom + scrollY, "
                                     "document.documentElement.scrollHeight]")
        if not room < below <= high <= max(below + 32, height):
            wrong.append((width, height, room, below, high))
    result(not wrong, f"an element between others: nothing of it reaches below them {wrong or ''}")


def check_pointed(page):
    """The surface that a pixel shows is chosen, not what that reflects."""
    file = oiio.ImageInput.open(work + "/object.exr")
    file.seek_subimage(1, 0)
    objects = file.read_image(1, 0, 0, 1, "float")[:, :, 0].astype(int)
    page.size(1280, 800)
    page.open(url + "hall/index.html")
    chosen = np.array(page.run(f"""(() => {{ const b = {PART}('canvas').getBoundingClientRect(), all = [];
        for (let y = 0; y < 90; y++) for (let x = 0; x < 160; x++)
            all.push({ROOM}.targetAt(b.left + (x + .5) * b.width / 160, b.top + (y + .5) * b.height / 90));
        return all; }})()""")).reshape(90, 160)
    names = page.room("targets")
    for number, name in enumerate(("Floor", "Wall", "Side", "Side")):
        shown = objects == objects[85, 80] + number
        share = (chosen[shown] == names.index(name)).mean()
        result(shown.sum() > 200 and share > 0.95, f"{name}: {100 * share:.1f} % of its {shown.sum()} pixels choose it")
    return chosen, names


def is_chosen(page, name, where):
    """It is selected, it alone is shown as that, and a texture goes to it."""
    before = page.run(f"{ROOM}.targets[{ROOM}.selected]"), page.run(PRESSED)
    page.run(f"{PART}('.swatch:not([data-source^=\"#\"])').click()")
    lies = page.until(f"{ROOM}.getState().textures['{name}']?.source === '{TEXTURES[0]}?0'", 20)
    page.room("setState({})")
    result(before == (name, [name]) and lies, f"{where}: {before[0]}, shown as {before[1]}")


def check_chosen(page, chosen, names):
    write("chosen.html", f"<retex-room id=a src=hall textures='{offers(3)}'></retex-room><retex-room id=b src=hall textures='{offers(3)}'></retex-room>")
    page.size(1280, 800)
    page.open(url + "chosen.html", f"Promise.all([{ROOM}.complete, b.complete])")
    is_chosen(page, "Side" if page.run(f"{ROOM}.room.targets[2].share > Math.max({ROOM}.room.targets[0].share, {ROOM}.room.targets[1].share)") else
              page.run(f"{ROOM}.room.targets.reduce((a, c) => c.share > a.share ? c : a).name"), "at first what shows most")
    for name in names:
        y, x = np.argwhere(chosen == names.index(name)).mean(axis=0) if name == "Floor" else next(
            (y, x) for y, x in np.argwhere(chosen == names.index(name)) if (chosen[y - 1:y + 2, x - 1:x + 2] == names.index(name)).all() and 0 < y < 89)
        left, top, width, height = page.run(f"(() => {{ const r = {PART}('canvas').getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; }})()")
        page.click(left + (x + 0.5) * width / 160, top + (y + 0.5) * height / 90)
        page.settle()
        is_chosen(page, name, "a click on the picture")
    page.run(f"[...{PART}('.targets').children].find(b => b.textContent === 'Wall').click()")
    is_chosen(page, "Wall", "its button")
    page.run("b.select('Floor')")
    is_chosen(page, "Wall", "another is chosen in the other room of the page")
    page.run(f"{ROOM}.setTexture('Floor', '{TEXTURES[1]}').then(() => (window.link = {ROOM}.link))")
    page.until("window.link")
    page.room("setState({})")
    page.run("location.href = link")
    page.until(f"{ROOM}.getState().textures.Floor")
    is_chosen(page, "Wall", "a link changed another's texture")
    page.run("history.back()")
    page.settle()
    is_chosen(page, "Wall", "back")
    page.run(f"{ROOM}.loadLarger()")
    page.run(f"{ROOM}.complete.then(() => 1)")
    is_chosen(page, "Wall", "the room came again, as it does after the graphics card was lost")
    page.run(f"{ROOM}.setAttribute('src', 'one')")
    page.run(f"{ROOM}.complete.then(() => 1)")
    is_chosen(page, "Floor", "another room with one surface")
    page.run(f"{ROOM}.setAttribute('src', 'hall')")
    early = page.until(f"{ROOM}.renderer?.canEdit(2)", 20)
    page.run(f"{ROOM}.select('Side')")
    page.run(f"{ROOM}.complete.then(() => 1)")
    if early:
        is_chosen(page, "Side", "chosen while the room loads")
    page.run(f"window.slow = {ROOM}.setTexture('Side', '{TEXTURES[2]}?slow'), {ROOM}.select('Floor'), slow.then(() => 1)")
    result(page.run(f"{ROOM}.getState().textures.Side?.source") == f"{TEXTURES[2]}?slow", "a texture that comes late goes where it was asked for")
    page.room("setState({})")
    is_chosen(page, "Floor", "and the one chosen since stays")
    write("reload.html", f"<retex-room src=hall textures='{offers(3)}'></retex-room>")
    page.open(url + "reload.html#room=Wall%3Dtan")
    page.run("location.reload()")
    page.open(url + "reload.html#room=Wall%3Dtan")
    result(list(page.state()["textures"]) == ["Wall"], "a link of one surface changes that one, after a reload too")


def main():
    page = Page(url)
    try:
        check_windows(page)
        check_chosen(page, *check_pointed(page))
    finally:
        page.close()
    finish()


main()
