"""Who can use the page of retex-studio, and what it costs, as TAP: axe-core in each of its states, the whole road by the
keyboard, processor time of a page that nobody touches, and answers while a render takes all cores. AXE is the path of
axe.min.js; where there is none, that part is skipped. Arguments choose checks by their names. RETEX_WEB_SHOTS is a folder for pictures."""
import json
import os
import time

from drive import TOP, Server, each, own_project, result, small_scene
from page import finish

SMALL = {"width": 96, "height": 54, "samples": 2, "noise": 0, "denoise": False}
STATES = (("bright", "light", 1280, 800), ("dark", "dark", 1280, 800), ("phone", "light", 390, 844))
# The element that has the focus, also inside of the player.
FOCUS = "(() => { let e = document.activeElement; while (e?.shadowRoot?.activeElement) e = e.shadowRoot.activeElement; return e; })()"


def write_project(work, **change):
    own_project(work, small_scene(work), **{"render": SMALL, **change})


# ---- axe ----

def serious(page):
    """What axe finds that is serious or worse."""
    found = page.run("axe.run(document, { resultTypes: ['violations'] }).then(r => r.violations"
                     ".filter(v => ['serious', 'critical'].includes(v.impact))"
                     ".map(v => `${v.id}: ${v.nodes.slice(0, 3).map(n => n.target.flat().join(' ')).join('; ')}`))")
    for line in found:
        print("#", line[:300])
    return found


def judge(page, state, axe):
    """The page as it is, in light and dark, and on a phone."""
    if not page.run("!!window.axe"):
        page.run(axe)
    wrong = []
    for name, scheme, width, height in STATES:
        page.size(width, height, phone=width < 800)
        page.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        page.settle()
        page.shot(f"access-{state}-{name}")
        wrong += [f"{name}: {line}" for line in serious(page)]
    page.size(1280, 800)
    page.call("Emulation.setEmulatedMedia", features=[])
    page.settle()
    result(not wrong, f"axe finds nothing serious: {state}")


def axe(page, work):
    if not os.path.exists(os.environ.get("AXE", "")):
        result(True, "axe finds nothing serious # SKIP axe-core is not there")
        return
    with open(os.environ["AXE"], encoding="utf-8") as file:
        text = file.read() + "; 0"
    server = Server(work, "--textures", f"{TOP}/scenes/textures")
    page.open_studio(server)
    judge(page, "open", text)
    server.close()
    os.mkdir(f"{work}/room.pov.studio")
    server = Server(work, model=small_scene(work))
    page.open_studio(server)
    page.wait("document.querySelector('#foreign').open")
    judge(page, "foreign", text)
    page.go("#foreign-open")
    server.close()
    write_project(work)
    server = Server(work, "--textures", f"{TOP}/scenes/textures", model=small_scene(work))
    page.open_studio(server, "View")
    page.go("#keep-view")
    judge(page, "view", text)
    page.go("#step-surfaces")
    page.surfaces()
    page.press_at(*page.picture(0.2, 0.9))
    page.wait("document.querySelector('#target-0')")
    page.run("document.querySelector('#seen').open = true")
    judge(page, "surfaces", text)
    page.go("#step-light")
    page.wait("document.querySelector('#finish-0-0')")
    judge(page, "light", text)
    page.go("#step-render")
    page.go("#guess")
    page.wait("document.querySelector('.forecast dl')")
    page.go("#next-button")
    page.wait("document.querySelector('.renders .good')")
    judge(page, "render", text)
    page.go("#next-button")
    page.wait("document.querySelector('retex-room')?.isComplete")
    page.go("#root-1")
    page.go("#swatch-1")
    page.wait("document.querySelector('#picture-width')")
    judge(page, "play", text)
    page.go("#step-take")
    page.go("#make-picture")
    page.wait("document.querySelector('.card a.button[download]')")
    judge(page, "take away", text)
    page.go("#help-button")
    page.run("document.querySelector('#commands').open = true")
    judge(page, "help and commands", text)
    server.close()


# ---- the keyboard ----

def tab_to(page, selector, most=80):
    """Go on by Tab to an element; with Shift where that is nearer is not tried."""
    quoted = json.dumps(selector)
    page.wait(f"document.querySelector({quoted}) && !document.querySelector({quoted}).disabled")
    for _ in range(most):
        if page.run(f"{FOCUS}?.matches({quoted})"):
            seen = page.run(f"(e => {{ const s = getComputedStyle(e); return s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) >= 1; }})({FOCUS})")
            if not seen:
                print(f"# the focus is not seen on {selector}")
            return seen
        page.hit("Tab")
    print(f"# Tab does not come to {selector}; it is on {page.run(f'{FOCUS}?.outerHTML?.slice(0, 120)')}")
    return False


def press(page, selector, key="Enter"):
    good = tab_to(page, selector)
    page.hit(key)
    page.settle()
    return good


def keyboard(page, work):
    """From a model to a picture without a pointer."""
    write_project(work)
    server = Server(work, "--textures", f"{TOP}/scenes/textures", opened="room.pov")
    small_scene(work)
    page.open_studio(server)
    page.keys = page.clicks = 0
    good = [press(page, ".browser button.row[aria-label^='room.pov']")]
    page.wait("document.querySelector('#panel-title').textContent === 'View' && document.querySelector('#picture.shown')")
    good.append(tab_to(page, "#picture"))
    page.hit("ArrowLeft")
    page.wait("document.querySelector('#own-view') && !document.querySelector('#own-view').disabled")
    good.append(press(page, "#keep-view"))
    result(all(good) and page.saved(server)["cameras"][0]["name"] == "View 1", "a model is opened, and a view kept, by keys")
    good = [press(page, "#next-button")]
    page.surfaces()
    good += [press(page, "#seen summary"), press(page, "#seen-0")]
    page.wait("document.querySelector('#target-0')")
    good.append(tab_to(page, "#target-0"))
    page.hit("a", 2)
    page.call("Input.insertText", text="Ground")
    good.append(press(page, "#next-button"))
    page.wait("document.querySelector('#finish-0-0')")
    result(all(good) and page.saved(server)["targets"][0]["name"] == "Ground", "a surface is taken and named by keys")
    good = [press(page, "#next-button"), press(page, "#next-button")]
    page.wait("document.querySelector('.renders .good')", 200)
    result(all(good), "it is rendered by keys")
    good = [press(page, "#next-button")]
    page.wait("document.querySelector('retex-room')?.isComplete")
    good += [press(page, "#root-1"), press(page, "#swatch-1", " ")]
    page.wait("document.querySelector('retex-room').getState().textures.Ground")
    good.append(press(page, "#next-button"))
    good.append(press(page, "#make-picture"))
    page.wait("document.querySelector('.card a.button[download]')")
    result(all(good) and page.clicks == 0, f"a picture lies on it, and is taken away, by keys: {page.keys} of them in all")
    result(not page.trouble(), "nothing went wrong on the way")
    server.close()


# ---- time ----

def idle(page, work):
    """A page that nobody touches takes no processor time: neither the server, nor the preview, nor the browser."""
    write_project(work)
    server = Server(work, model=small_scene(work))
    page.open_studio(server, "View")
    for step in ("view", "surfaces"):
        page.go(f"#step-{step}")
        page.wait("document.querySelector('#picture.shown')")
        server.rest()
        server_before, browser_before = server.ticks(), page.processor_seconds()
        time.sleep(5)
        ticks, browser = server.ticks() - server_before, page.processor_seconds() - browser_before
        result(ticks <= 1, f"in the step {step}, the server and the preview take no processor time: {ticks} ticks in 5 s")
        result(browser < 0.15, f"nor does the browser: {browser:.2f} s in 5 s")
    server.close()


def answers(page, work):
    """The page answers while a render takes all cores."""
    write_project(work, render={**SMALL, "width": 640, "height": 360, "samples": 65536},
                  targets=[{"name": "Floor", "select": "Floor", "uv": "", "share": 0.4}])
    server = Server(work, model=small_scene(work))
    page.open_studio(server, "View")
    page.go("#step-render")
    page.go("#next-button")
    page.wait("document.querySelector('.renders progress')")
    server.rest(4)  # it does not: all cores are taken
    times = page.run("(async () => { const times = []; for (let k = 0; k < 40; k++) { const begin = performance.now(); "
                     "await (await fetch('api/state')).json(); times.push(performance.now() - begin); "
                     "await new Promise(done => setTimeout(done, 20)); } return times.sort((a, b) => a - b); })()")
    result(times[36] < 100, f"answers while it renders: half in {times[20]:.0f} ms, nine of ten in {times[36]:.0f} ms")
    shown = []
    for step in ("view", "light", "render") * 4:
        shown.append(page.run(f"new Promise(done => {{ const begin = performance.now(), title = document.querySelector('#panel-title'); "
                              "new MutationObserver((_, o) => { o.disconnect(); done(performance.now() - begin); })"
                              f".observe(title, {{childList: true, characterData: true, subtree: true}}); document.querySelector('#step-{step}').click(); }})"))
        time.sleep(0.1)
    shown.sort()  # the browser has to draw it, beside the render: its share of the cores counts
    result(shown[9] < 1000, f"a click shows another step: half in {shown[6]:.0f} ms, nine of twelve in {shown[9]:.0f} ms")
    page.go("#step-render")
    page.go(".renders button:not(.icon)")
    page.wait("document.querySelector('.renders button.primary')")
    server.close()


def main():
    each([axe, keyboard, idle, answers])
    finish()


main()
