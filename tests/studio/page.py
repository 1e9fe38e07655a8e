"""retex-studio in headless Chromium, by clicks and keys, from a model to a picture, as TAP. RETEX_WEB_SHOTS is a folder for
pictures of the page."""
import filecmp
import json
import os
import subprocess
import sys
import tempfile

from drive import TOP, Server, Studio, result
from browser import serve
from page import finish


FLOOR, WALL, TABLE = (0.45, 0.95), (0.3, 0.2), (0.2, 0.7)  # places of the picture


def choose(page, server):
    page.open_studio(server)
    page.shot("studio-open")
    page.go(".browser button.row")
    page.wait("document.querySelector('.report li')")
    result(page.saved(server)["import"]["done"] and not page.trouble(), "a model is opened by a click, and imported")
    page.shot("studio-imported")
    page.go("#next-button")
    page.go("#keep-view")
    page.shot("studio-view")
    page.go("#undo")
    result(page.saved(server)["cameras"] == [], "a kept view is undone")
    page.go("#next-button")
    page.wait("document.querySelector('#seen summary')")
    for number, place in enumerate((FLOOR, WALL)):
        page.click(*page.picture(*place))
        page.wait(f"document.querySelector('#target-{number}')")
    page.wait("document.querySelector('#seen summary')")
    page.call("Input.dispatchMouseEvent", type="mouseMoved", x=page.picture(*TABLE)[0], y=page.picture(*TABLE)[1])
    page.wait("document.querySelector('#under').textContent")
    result(page.run("document.querySelector('#under').textContent") == "Table", "the name of what is under the pointer")
    page.shot("studio-surfaces")
    found = page.saved(server)["targets"]
    result([t["name"] for t in found] == ["Floor", "Walls"], f"surfaces are taken by clicks {found}")
    page.run("document.querySelector('#picture').focus()")
    page.key("4", 52)
    page.click(*page.picture(*TABLE))
    page.settle()
    taken = [t["select"] if t["name"] == "Table" else t["name"] for t in page.saved(server)["targets"]]
    page.run("document.querySelector('#picture').focus()")
    page.call("Input.dispatchKeyEvent", type="keyDown", key="z", code="KeyZ", modifiers=2)
    page.settle()
    result(taken[-1] == "#5" and len(page.saved(server)["targets"]) == 2,
           f"the key 4 takes objects, and Ctrl-Z gives one back {taken}")
    page.put("#target-1", "Wände")
    result(page.saved(server)["targets"][1]["name"] == "Wände", "a surface is renamed")


def light_and_render(page, server):
    page.go("#next-button")
    page.go("#finish-0-0")
    page.go("#finish-0-1")
    page.go("#lamp-0")
    page.shot("studio-light")
    page.go("#next-button")
    page.put("#size", "own")
    page.put("#own-width", "160")
    page.put("#own-height", "90")
    page.put("#quality", "8")
    page.go("#guess")
    page.wait("document.querySelector('.forecast dl')")
    page.shot("studio-render")
    page.go("#next-button")
    page.wait("document.querySelector('.renders .good')", 200)
    project = page.saved(server)
    result(project["renders"][0]["done"] and not page.trouble(), "a render with a lamp and finishes, after an estimate")
    page.go("#next-button")
    page.wait("document.querySelector('retex-room') && document.querySelector('retex-room').textures.length")
    page.run("document.querySelector('retex-room').complete")


def play(page, server):
    page.go("#root-1")
    page.run("document.querySelector('retex-room').select('Floor')")
    page.go("#swatch-1")
    page.wait("document.querySelector('retex-room').getState().textures.Floor")
    page.put("#picture-width", "40")
    page.wait("document.querySelector('retex-room').getState().textures.Floor.width")
    look = page.saved(server)["look"]
    result(look.startswith("Floor=files/") and "damask" in look and "Floor.width=0.4m" in look,
           f"a picture lies on the floor, 40 cm wide: {look}")
    page.shot("studio-play")
    page.go("#step-take")
    page.go("#make-picture")
    page.wait("document.querySelector('.card a.button[download]')")
    page.go("#make-page")
    page.wait("document.querySelector('#page-made')")
    page.shot("studio-take")
    page.run("document.querySelector('#commands').open = true")
    lines = page.run("document.querySelector('#commands pre').textContent").splitlines()
    [line] = [line for line in lines if line.startswith("retex-combine")]
    subprocess.run(["sh", "-c", line], cwd=server.work, check=True)
    made = f"{server.work}/{server.folder}/pictures"
    result(filecmp.cmp(f"{made}/{os.listdir(made)[0]}", f"{server.work}/{server.folder}/picture.png", shallow=False),
           "the command that is shown makes the same file")
    [line] = [line for line in lines if line.startswith("retex-pack")]
    web = page.run("document.querySelector('#page-title ~ .path').textContent")
    os.rename(f"{server.work}/{web}", f"{server.work}/taken")
    subprocess.run(["sh", "-c", line], cwd=server.work, check=True)
    same = subprocess.run(["diff", "-r", "taken", web], cwd=server.work, check=False).returncode == 0
    result(same, "and the other one the same page")
    result(not page.trouble(), "nothing went wrong on the way")


def taken_away(page, server):
    """The page that was made, on a web server that knows nothing of the studio."""
    page.open(serve(f"{server.work}/taken"))
    page.wait("document.querySelector('retex-room').getState().textures.Floor")
    floor = page.room("getState()")["textures"]["Floor"]
    result(floor["source"].startswith("textures/damask-") and floor["width"] == "0.4m" and page.message() == "",
           f"a page that is taken away begins with its look: {floor}")
    page.shot("studio-taken")


def others(page, server):
    """Another window, and a job that fails."""
    changed = {**server.project(), "presets": [{"name": "Empty", "look": ""}]}
    with open(server.project_file, "w", encoding="utf-8") as file:
        json.dump(changed, file)
    page.wait("document.querySelector('#messages').textContent.includes('Another window')")
    page.wait("[...document.querySelectorAll('#panel input')].some(e => e.value === 'Empty')")
    page.run("document.querySelector('#keep-look').click()")  # it is saved a little later
    with open(server.project_file, "w", encoding="utf-8") as file:
        json.dump({**changed, "look": ""}, file)
    page.wait("document.querySelector('#conflict').open")
    page.shot("studio-conflict")
    page.go("#take-over")
    result(len(page.saved(server)["presets"]) == 2, "a change by another window is told, and can be taken over")
    os.rename(f"{server.work}/{server.project()['renders'][0]['set']}", f"{server.work}/away.exr")
    page.go("#make-pack")
    page.wait("document.querySelector('.message.error')")
    told = page.run("document.querySelector('.message.error').textContent")
    result("no longer where it was" in told, f"a job that fails is told with what to do: {told}")
    page.shot("studio-failed")
    page.size(390, 844, phone=True)
    page.settle()
    page.shot("studio-phone")
    result(page.run("document.documentElement.scrollWidth") <= 390, "a phone shows all of its width")
    names = page.run("[...document.querySelectorAll('button, input, select')].filter(e => e.checkVisibility() && !e.textContent.trim() "
                     "&& !e.getAttribute('aria-label') && !(e.labels && e.labels.length)).map(e => e.outerHTML)")
    result(names == [], f"all controls have names {names}")


def main():
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([sys.executable, "-B", f"{TOP}/tests/cli/import_room.py"], cwd=work, check=True)
        for name in os.listdir(work):
            if name != "room.obj":
                os.remove(f"{work}/{name}")
        server = Server(work, "--textures", f"{TOP}/scenes/textures")
        page = Studio()
        try:
            page.size(1280, 800)
            choose(page, server)
            light_and_render(page, server)
            play(page, server)
            others(page, server)
            page.close()
            page = Studio()  # a visitor's
            taken_away(page, server)
        finally:
            page.close()
            result(server.close() == 0, "a signal ends the server")
    finish()


main()
