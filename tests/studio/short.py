"""The page of retex-studio in a browser, in some seconds: a scene is opened, surfaces are taken by clicks and keys, undone
and saved, also when the window closes; a model whose first picture is black is not called ready."""
import tempfile

from drive import Server, Studio, own_project, result, small_scene
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


def boxes(work, *bounds):
    """Closed boxes as OBJ, each of its low and high corners, the second of them black: added light does not show within."""
    with open(f"{work}/boxes.mtl", "w", encoding="utf-8") as file:
        file.write("newmtl Grey\nKd 0.5 0.5 0.5\nnewmtl Black\nKd 0 0 0\nKs 0 0 0\n")
    with open(f"{work}/boxes.obj", "w", encoding="utf-8") as file:
        print("mtllib boxes.mtl", file=file)
        for number, (low, high) in enumerate(bounds):
            for k in range(8):
                print("v", *((low, high)[k >> axis & 1][axis] for axis in (2, 1, 0)), file=file)
            print(f"o Box{number}\nusemtl {'Black' if number == 1 else 'Grey'}", file=file)
            for face in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
                print("f", *(8 * number + k + 1 for k in face), file=file)
    return "boxes.obj"


def find_black(page, work):
    """An eye within a closed black box."""
    own_project(work, boxes(work, ((0, 0, 0), (4, .1, 4)), ((1, .1, 1), (2, 1, 2)), ((3, .1, 2), (3.5, .6, 3))),
                **{"import": {"camera": "1.5,0.5,-1.5:1.8,0.5,-1.5"}})
    server = Server(work, model="boxes.obj")
    try:
        page.open_studio(server)
        page.wait("document.querySelector('#import-trouble')")
        said = page.run("document.querySelector('#messages').textContent")
        result("black" in page.told("picture is black") and "ready" not in said and not page.run("!!document.querySelector('#step-open .tick')"),
               f"a model whose picture is black is not called ready: {said}")
        page.wait("document.querySelectorAll('#own-views img').length > 2")
        page.shot("studio-black")
        page.go("#import-other-view")
        page.wait("document.querySelector('#step-open .tick')")
        page.shot("studio-not-black")
        result(page.saved(server)["import"]["camera"] == "outside" and not page.run("!!document.querySelector('#import-trouble')"),
               "from outside it is")
    finally:
        server.close()


def main():
    with tempfile.TemporaryDirectory() as work:
        server = Server(work, model=small_scene(work))
        page = Studio()
        try:
            page.size(1280, 800)
            walk(page, server)
        finally:
            result(server.close() == 0, "a signal ends the server")
        page.leave()
        with tempfile.TemporaryDirectory() as other:
            try:
                find_black(page, other)
            finally:
                page.close()
    finish()


main()
