"""Checks in headless Chromium which of the rooms in a folder <retex-room> loads, and prints TAP: sizes.py FOLDER.

FOLDER has many/, a room of 640x360 with others of 320x180 and 160x90 beside it, and pictures, textures/."""
import json
import os
import sys

from browser import serve
from page import PART, ROOM, Page, finish, psnr, result

work = sys.argv[1]
url = serve(work)
with open(f"{work}/many/room.json", encoding="utf-8") as manifest:
    WHOLE = json.load(manifest)
SMALL, LOOK = [s["file"] for s in WHOLE["smaller"]], "setTexture('Floor', 'textures/brick.jpg', {scale: [4, 4], rotate: 30})"


def files_of(manifest):
    """Names of what a room loads, but the light of its lamps."""
    with open(f"{work}/many/{manifest}", encoding="utf-8") as file:
        room = json.load(file)
    entries = [room["picture"], room["reduced"], *room["lights"], *room["classes"]]
    return {entry["file"] for entry in entries if entry}


def show(page, width, pixels=1, folder="many"):
    page.call("Emulation.setDeviceMetricsOverride", width=900, height=700, deviceScaleFactor=pixels, mobile=False)
    with open(f"{work}/size.html", "w", encoding="utf-8") as file:
        file.write("<!doctype html><html lang=en><title>A page</title><style>body { margin: 0 } retex-room { display: block; "
                   f"width: {width}px; height: {width * 9 / 16}px }} retex-room::part(panel) {{ display: none }}</style>"
                   f"<retex-room panel=closed src={folder}></retex-room><script type=module src=many/retex-room.js></script>")
    page.open(url + "size.html?" + str(width))


def size(page):
    return page.run(f"{PART}('canvas').width")


def loaded(page):
    """Names and bytes of what came from the folder, without the player."""
    found = page.run("performance.getEntriesByType('resource').filter(e => /many[/]/.test(e.name) && !/js$/.test(e.name))"
                     ".map(e => [e.name.replace(/.*[/]/, ''), e.encodedBodySize])")
    return {name for name, _ in found}, sum(count for _, count in found)


def check_choice(page):
    taken = {}
    for width, pixels, wanted, name in ((160, 1, 160, SMALL[1]), (160, 2, 320, SMALL[0]), (320, 2, 640, "room.json"), (700, 1, 640, "room.json")):
        show(page, width, pixels)
        names, taken[wanted] = loaded(page)
        needed = files_of(name) | {name, "room.json"}
        result(size(page) == wanted and names == needed,
               f"{width} px wide with {pixels} pixels each: the room of {wanted}, and nothing of others {names ^ needed}")
    result(taken[160] < 0.2 * taken[640] and taken[320] < 0.5 * taken[640], f"bytes that are loaded: {taken}")


def check_growth(page):
    show(page, 160)
    page.room(LOOK)
    page.room("setLight({exposure: 0.5})")
    before = page.state()
    for _ in range(4):
        page.room("zoomBy(1.5)")
    result(page.until(f"{PART}('canvas').width === 640 && {ROOM}.isComplete"), "zoomed, the whole room comes")
    page.settle()
    result(page.state() == before and page.room("zoom.times") > 5, "with the textures, the light and the zoom that were there")
    page.save(f"{work}/grown.png")
    show(page, 640)
    page.room(LOOK)
    page.room("setLight({exposure: 0.5})")
    page.save(f"{work}/fresh.png")
    found = psnr(f"{work}/grown.png", f"{work}/fresh.png")
    result(found is None or found > 60, f"and is what it is when it is loaded at once: {found} dB")
    show(page, 160)
    page.room(LOOK)
    page.save(f"{work}/taken.png")
    result(size(page) == 640, "a picture that is taken away is of the whole room")
    show(page, 160)
    page.run(f"{ROOM}.style.width = '640px', {ROOM}.style.height = '360px'")
    page.room("setTexture('Floor', 'textures/brick.jpg')")  # while it grows
    result(page.until(f"{PART}('canvas').width === 640 && {ROOM}.isComplete"), "an element that grows gets a larger room")
    result(page.state()["textures"]["Floor"]["source"] == "textures/brick.jpg", "with the texture that was on the way")


def check_failure(page):
    show(page, 160)
    page.room(LOOK)
    missing = f"{work}/many/{WHOLE['lights'][0]['file']}"
    os.rename(missing, missing + "-away")
    page.room("zoomBy(6)")
    came = page.until(f"{ROOM}.largest === 160 && {ROOM}.isComplete", 40)
    result(came and size(page) == 160 and not page.message(), f"if a larger room does not come, the smaller one stays: {page.message()}")
    result(page.state()["textures"]["Floor"]["rotate"] == 30, "with its textures")
    os.rename(missing + "-away", missing)


def main():
    page = Page(url)
    try:
        check_choice(page)
        check_growth(page)
        check_failure(page)
    finally:
        page.close()
    finish()


main()
