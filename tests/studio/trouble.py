"""What goes wrong while one works in the page of retex-studio, as TAP: each ends in a plain message, and nothing is lost.
Arguments choose checks by their names. RETEX_WEB_SHOTS is a folder for pictures of the page."""
import os
import resource
import signal
import sys
import time

from drive import SCENE, Server, Studio, each, own_project, result, small_scene
from page import finish

FLOOR, WALL, BALL = (0.2, 0.9), (0.1, 0.2), (0.5, 0.5)
LONG = {"width": 640, "height": 360, "samples": 4096, "noise": 0, "denoise": False}


def begin(page, work, *arguments, text=SCENE, step="surfaces", **change):
    """A server with the small scene, whose project may have been changed, and its page in a step."""
    name = small_scene(work, text)
    if change:
        own_project(work, name, **change)
    server = Server(work, *arguments, model=name)
    page.open_studio(server, "View")
    if step != "view":
        page.go(f"#step-{step}")
    if step == "surfaces":
        page.surfaces()
    return server


def take(page, place, number):
    page.press_at(*page.picture(*place))
    page.wait(f"document.querySelector('#target-{number}')")


FLOOR_TAKEN = [{"name": "Floor", "select": "Floor", "uv": "", "share": 0.4}]


# ---- files ----

def wrong_files(page, work):
    """Files that are no models, or broken ones, and pictures that are none."""
    broken = {"notes.txt": b"notes", "broken.glb": b"glTF\2\0\0\0", "cut.obj": b"v 0 0\nf 1 2 9\n", "room.pov": b"camera { location }",
              "none.exr": b"\x76\x2f\x31\x01\2"}
    for name, text in broken.items():
        with open(f"{work}/{name}", "wb") as file:
            file.write(text)
    server = Server(work)
    page.open_studio(server)
    page.files("#model-file", f"{work}/notes.txt")
    told = page.told("is no model")
    result("“notes.txt” is no model" in told, f"a file of another kind is told: {told}")
    page.shot("trouble-no-model")
    for name, wanted in (("broken.glb", "could not be read"), ("cut.obj", "could not be read"), ("room.pov", "room.pov:1"),
                         ("none.exr", "did not work")):
        page.open_studio(server)
        page.files("#model-file", f"{work}/{name}")
        told = page.told(wanted)
        result(wanted in told, f"{name}: {told[:160]}")
        page.shot(f"trouble-{name}")
        server.close()
        server = Server(work)
    result(server.close() == 0, "the server goes on")


def wrong_picture(page, work):
    """A file with a picture's name."""
    server = begin(page, work, step="view", targets=FLOOR_TAKEN, render={**LONG, "width": 64, "height": 36, "samples": 2})
    page.go("#step-render")
    page.go("#next-button")
    page.wait("document.querySelector('.renders .good')")
    page.go("#next-button")
    page.wait("document.querySelector('retex-room')?.isComplete && !document.querySelector('#add-pictures').disabled")
    with open(f"{work}/oak.jpg", "wb") as file:
        file.write(b"\xff\xd8 no picture")
    page.files("#panel-body input[type=file]", f"{work}/oak.jpg")
    told = page.told("oak")
    result("oak" in told, f"a picture that is none is told: {told}")
    page.shot("trouble-picture")
    server.close()


# ---- the disk, memory ----

def full_disk(page, work):
    """What cannot be saved is kept in the page, and saved when there is room."""
    server = begin(page, work)
    limit = lambda most: resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))
    limit(64)
    take(page, FLOOR, 0)
    told = page.told("could not be saved")
    shown = page.until("document.querySelector('#saved').textContent === 'Not saved'", 5)
    result("disk" in told and "Make room" in told and shown,
           f"a full disk is told: {told}")
    page.shot("trouble-full")
    limit(resource.RLIM_INFINITY)
    page.go(".message.error button:not(.icon)")
    result([t["name"] for t in page.saved(server)["targets"]] == ["Floor"], f"and the project is saved when there is room {[t['name'] for t in server.project()['targets']]}")
    server.close()


def full_render(page, work):
    """A render that the disk has no room for."""
    server = begin(page, work, step="view", targets=FLOOR_TAKEN, render={**LONG, "samples": 2})
    page.go("#step-render")
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (20000, resource.RLIM_INFINITY))
    page.go("#next-button")
    told = page.told("Make room")
    result("nothing was lost" in told or "Make room" in told, f"a render without room: {told}")
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    page.go(".renders button.primary")
    page.wait("document.querySelector('.renders .good')")
    result(page.saved(server)["renders"][0]["done"], "it goes on when there is room")
    server.close()


def memory_limit(page, work):
    """A render that needs more memory than it may have."""
    server = begin(page, work, "--max-memory", "256M", step="view", targets=FLOOR_TAKEN,
                   render={**LONG, "width": 7680, "height": 4320, "samples": 1})
    page.go("#step-render")
    page.go("#next-button")
    told = page.told("memory")
    result("smaller" in told, f"too little memory is told, with what to do: {told}")
    page.shot("trouble-memory")
    page.put("#size", "640x360")
    result(page.saved(server)["render"]["width"] == 640, "and another size can be chosen")
    server.close()


# ---- windows, servers, models ----

def closed_tab(page, work):
    """A change a moment before, and a render, outlive the window."""
    server = begin(page, work, render=LONG)
    take(page, FLOOR, 0)
    page.saved(server)
    page.go("#step-render")
    page.go("#next-button")
    page.wait("document.querySelector('.renders progress')")
    page.go("#step-surfaces")
    page.surfaces()
    take(page, WALL, 1)
    asked = page.leave()
    time.sleep(0.3)
    names = [t["name"] for t in server.project()["targets"]]
    result(names == ["Floor", "Wall"], f"a change of the last moment is saved when the window closes {names}")
    result(not asked, "without a question")
    page.open_studio(server, "View")
    page.go("#step-render")
    page.wait("document.querySelector('.renders progress')?.value > 0")
    result(True, "the render went on, and another window shows it")
    page.go(".renders button:not(.icon)")
    page.wait("document.querySelector('.renders button.primary')")
    result(server.project()["renders"][0]["done"] is False, "it is stopped there, and can go on")
    server.close()


def second_window(page, work):
    """Two windows that change the same project."""
    server = begin(page, work)
    other = Studio()
    try:
        other.size(1280, 800)
        other.open_studio(server, "View")
        take(page, FLOOR, 0)
        page.saved(server)
        told = other.told("Another window")
        result("Another window" in told, f"a second window is told: {told}")
        other.go("#step-surfaces")
        other.surfaces()
        other.wait("document.querySelector('#target-0')")
        result(True, "and shows what the first has done")
        for window, place in ((page, WALL), (other, BALL)):  # at once
            window.press_at(*window.picture(*place))
        other.until("document.querySelector('#conflict').open", 5)
        losers = [w for w in (page, other) if w.run("document.querySelector('#conflict').open")]
        result(len(losers) <= 1, "of two changes at once, one is asked about")
        for window in losers:
            window.go("#take-over")
            window.saved(server)
        names = [t["name"] for t in server.project()["targets"]]
        result(len(names) == 2 and names[0] == "Floor", f"the choice is what is saved {names}")
    finally:
        other.close()
        server.close()


def killed_tool(page, work):
    """The preview's process is killed, and a render's."""
    server = begin(page, work, targets=FLOOR_TAKEN, render=LONG)
    preview = next(n for n, line in server.children().items() if "--live" in line)
    os.kill(preview, signal.SIGKILL)
    told = page.told("preview has stopped")
    result("preview has stopped" in told, f"a preview that ends is told: {told}")
    page.shot("trouble-preview")
    page.go(".message.error button:not(.icon)")
    page.wait("document.querySelector('#picture-note').textContent.includes('clearer') || document.querySelector('#picture.shown')")
    page.until("!document.querySelector('.message.error')", 5)
    result(any("--live" in line for line in server.children().values()), "and started again")
    page.go("#step-render")
    page.go("#next-button")
    page.wait("document.querySelector('.renders progress')?.value > 0.001")
    os.kill(next(n for n, line in server.children().items() if "--live" not in line), signal.SIGKILL)
    told = page.told("ended")
    result("ended" in told and "signal" not in told, f"a render that is killed is told plainly: {told}")
    page.shot("trouble-killed-render")
    page.go(".renders button.primary")
    page.wait("document.querySelector('.renders progress')")
    result(True, "and goes on")
    server.close()


def killed_server(page, work):
    """The server sleeps, and is killed: changes are kept in the page, and saved, or taken away as a file."""
    server = begin(page, work)
    take(page, FLOOR, 0)
    page.saved(server)
    server.process.send_signal(signal.SIGSTOP)
    take(page, WALL, 1)
    time.sleep(1)
    server.process.send_signal(signal.SIGCONT)
    result(len(page.saved(server)["targets"]) == 2, "a change while the server sleeps is saved when it wakes")
    began = time.time()
    server.process.kill()
    told = page.told("does not answer")
    result("retex studio" in told and time.time() - began < 10, f"a server that is killed is told in {time.time() - began:.1f} s: {told}")
    take(page, BALL, 2)
    page.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=f"{work}/kept")
    page.go("#keep-file")
    page.shot("trouble-server")
    for _ in range(50):
        if os.path.exists(f"{work}/kept/{os.path.basename(server.project_file)}"):
            break
        time.sleep(0.1)
    result(page.leave(), "the browser asks before a window with changes closes")
    server.process.wait()
    Server.running.remove(server)
    os.replace(f"{work}/kept/{os.path.basename(server.project_file)}", server.project_file)
    server = Server(work, model="room.pov")
    page.open_studio(server, "View")
    page.go("#step-surfaces")
    page.wait("document.querySelector('#target-2')")
    result(True, "nothing is lost: the file has what was changed last")
    server.close()


def quit_studio(page, work):
    """Ending it from the page."""
    server = begin(page, work)
    take(page, FLOOR, 0)
    page.go("#quit-button")
    page.shot("trouble-quit")
    page.go("#quit-end")
    ended = server.process.wait(30)
    result(ended == 0 and [x["name"] for x in server.project()["targets"]] == ["Floor"], "Quit saves, and ends the server")
    told = page.run("document.body.innerText")
    result("You can close this window" in told, "and the page says so")
    result(not page.leave(), "without a question when it closes")
    Server.running.remove(server)


def changed_model(page, work):
    """The model's file is saved anew by another program, and taken away."""
    server = begin(page, work)
    take(page, FLOOR, 0)
    page.saved(server)
    small_scene(work, SCENE.replace("<0, 1, 0>, .4", "<0, 1, 0>, .6"))
    told = page.told("has changed", 10)
    result("has changed" in told, f"a model that changes is told where one works: {told}")
    page.shot("trouble-model")
    result([t["name"] for t in page.saved(server)["targets"]] == ["Floor"], "the surfaces stay")
    server.close()


def opened_model(page, work):
    """A model that was opened from the page has not changed."""
    small_scene(work)
    server = Server(work)
    page.open_studio(server)
    page.go(".browser button.row[aria-label^='room.pov']")
    page.wait("document.querySelector('#picture.shown')")
    time.sleep(1)
    result(page.run("document.querySelector('#bar').hidden"), "a model that was just opened is not said to have changed")
    server.close()


# ---- much of it ----

def many_surfaces(page, work):
    """Fifty clicks on fifty things: eight are taken, more are told."""
    balls = "".join(f"sphere {{ <{x / 4 - 1.1:.2f}, {0.3 + y / 3:.2f}, 0>, .1 texture {{ pigment {{ color rgb <{x / 10}, {y / 6}, .4> }} }} }}\n"
                    for y in range(5) for x in range(10))
    server = begin(page, work, text=SCENE + balls)
    page.run("document.querySelector('#picture').focus()")
    page.hit("4")
    for y in range(5):
        for x in range(10):
            page.press_at(*page.picture(0.155 + 0.0766 * x, 0.88 - 0.181 * y))
    page.settle()
    targets = page.saved(server)["targets"]
    result(len(targets) == 8 and len({t["name"] for t in targets}) == 8, f"eight are taken: {[t['name'] for t in targets]}")
    told = page.told("8 surfaces", 2)
    result("8 surfaces" in told, f"more are told: {told}")
    page.shot("trouble-many")
    messages = page.run("document.querySelectorAll('#messages .message').length")
    result(messages <= 2, f"once, not each time: {messages} messages")
    result(page.run("document.querySelectorAll('ol.targets li').length") == 8, "the list shows eight")
    server.close()


def main():
    each([wrong_files, wrong_picture, full_disk, full_render, memory_limit, closed_tab, second_window, killed_tool, killed_server,
          quit_studio, changed_model, opened_model, many_surfaces])
    finish()


main()
