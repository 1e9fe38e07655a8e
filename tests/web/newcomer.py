"""What docs/web.md promises a newcomer, in headless Chromium, as TAP: newcomer.py ROOM OWN FOLDER PHOTO.

ROOM: the address of a room's page; OWN: of the page with an element of one's own. A photograph is dropped on the floor,
and the picture that is downloaded is compared with that of retex-combine. FOLDER has room.exr."""
import subprocess
import sys
import time

from page import PART, ROOM, Page, finish, psnr, result

room, own, work, photo = sys.argv[1:]


def place_on(page, target):
    """A place of the window where this target is seen."""
    return page.run(f"""(() => {{
        const r = {PART}('canvas').getBoundingClientRect(), want = {ROOM}.targets.indexOf('{target}');
        for (let y = r.bottom - 9; y > r.top; y -= 8) for (let x = r.left + 9; x < r.right; x += 8)
            if ([[0, 0], [8, 0], [-8, 0], [0, 8], [0, -8]].every(([a, b]) => {ROOM}.targetAt(x + a, y + b) === want)) return [x, y];
    }})()""")


def main():
    page = Page(room)
    try:
        page.size(1440, 900)
        begin = time.time()
        page.open(room)
        print(f"# the page is loaded after {time.time() - begin:.1f} s")
        x, y = place_on(page, "Floor")
        begin = time.time()
        for kind in ("dragEnter", "dragOver", "drop"):
            page.call("Input.dispatchDragEvent", type=kind, x=x, y=y, data={"items": [], "files": [photo], "dragOperationsMask": 1})
        name = photo.rsplit("/", 1)[1]
        lies = page.until(f"{ROOM}.textures[{ROOM}.targets.indexOf('Floor')].label === '{name}'", 60)
        page.save(f"{work}/mine.png")
        print(f"# the photograph is seen {time.time() - begin:.1f} s after it was dropped")
        result(lies, "a photograph of one's own is dropped on the floor")
        page.shot("newcomer")
        u, v = page.run(f"{ROOM}.scaleOf({ROOM}.targets.indexOf('Floor'))")
        subprocess.run(["retex-combine", "-q", f"{work}/room.exr", f"--texture:scale={u},{v}", f"Floor={photo}", "-o",
                        f"{work}/combined.png"], check=True)
        decibels = psnr(f"{work}/combined.png", f"{work}/mine.png")
        result(decibels > 38, f"it is retex-combine's picture: {decibels:.1f} dB")
        page.open(own)
        result(page.until(f"({ROOM}.getState().textures.Floor || {{}}).source === 'oak.jpg'", 60) and
               page.state()["textures"]["Floor"]["rotate"] == 90, "a page of one's own, with its script")
        page.shot("own-page")
    finally:
        page.close()
    finish()


main()
