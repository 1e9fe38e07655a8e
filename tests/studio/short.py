"""The page of retex-studio in a browser, in some seconds: a scene is opened, surfaces are taken by clicks and keys, undone
and saved, also when the window closes."""
import tempfile

from drive import Server, Studio, result, small_scene
from page import finish

FLOOR, WALL, BALL = (0.2, 0.9), (0.1, 0.2), (0.5, 0.5)


def names(project):
    return [t["name"] for t in project["targets"]]


def walk(page, server):
    page.open_studio(server, "View")
    page.wait("document.querySelector('#picture.shown')")
    page.go("#step-surfaces")
    page.surfaces()
    for number, place in enumerate((FLOOR, WALL)):
        page.press_at(*page.picture(*place))
        page.wait(f"document.querySelector('#target-{number}')")
    result(names(page.saved(server)) == ["Floor", "Wall"], f"surfaces are taken by clicks {names(server.project())}")
    page.run("document.querySelector('#picture').focus()")
    page.hit("z", 2)
    page.wait("!document.querySelector('#target-1')")
    result(names(page.saved(server)) == ["Floor"], "one is given back by Ctrl-Z")
    page.surfaces()
    page.press_at(*page.picture(*BALL))
    page.wait("document.querySelector('#target-1')")
    result(not page.trouble(), "nothing went wrong on the way")
    asked = page.leave()
    for _ in range(20):
        if len(names(server.project())) == 2:
            break
        page.settle()
    result(not asked and names(server.project()) == ["Floor", "Ball"],
           f"the last change is saved when the window closes, without a question {names(server.project())}")


def main():
    with tempfile.TemporaryDirectory() as work:
        server = Server(work, model=small_scene(work))
        page = Studio()
        try:
            page.size(1280, 800)
            walk(page, server)
        finally:
            page.close()
            result(server.close() == 0, "a signal ends the server")
    finish()


main()
