"""Rooms that are not there, or that another site does not let the page read. For element.py."""
import functools
import http.server
import threading

from browser import Quiet
from page import PART, ROOM, result


class Generous(Quiet):
    """A site whose files pages of others may read."""

    def end_headers(self):
        self.send_header("Access-Control-Allow-Origin", "*")
        super().end_headers()


def site(folder, kind):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(kind, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"127.0.0.1:{server.server_port}"


def controls(page):
    """Buttons and fields that are seen."""
    return page.run(f"[...{ROOM}.shadowRoot.querySelectorAll('.panel button, .panel input, .tools button')].filter(e => e.checkVisibility()).length")


def check_refused(page, url, work, write):
    closed, free = site(work, Quiet), site(work, Generous)
    origin = url.rstrip("/")
    header = "the header Access-Control-Allow-Origin is missing, or names another site."
    for name, what, src, said in (
            ("missing", "a folder that is not there", "nowhere", f"There is no room in {url}nowhere/: room.json is missing (status 404)."),
            ("refused", "another site that refuses", f"http://{closed}/room",
             f"{closed} answers, but does not let pages of {origin} read room.json: {header}"),
            ("missing-elsewhere", "another site without the room", f"http://{free}/nowhere",
             f"There is no room in http://{free}/nowhere/: room.json is missing (status 404).")):
        write(f"{name}.html", f"<retex-room src={src} style='height: 95vh'></retex-room>")
        page.open(url + f"{name}.html")
        result(page.message() == said, f"{what} is told: {page.message()}")
        result(controls(page) == 0, f"{what} has no controls: {controls(page)}")
        page.shot(name)
        page.press("[data-do=close]")
        result(not page.message() and controls(page) == 0, f"{what}: the message is closed, and there are none yet")
    page.run(f"{ROOM}.setAttribute('src', 'http://{free}/room')")
    page.run(f"{ROOM}.complete")
    result(not page.message() and controls(page) > 5 and not page.run(f"{PART}('img').hidden"), f"then a room that is there: {page.message()}")
