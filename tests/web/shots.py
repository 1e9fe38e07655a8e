"""Takes the pictures of docs/web.md: shots.py FOLDER PAGE.html OUT. FOLDER is served; PAGE shows a room with the targets
Floor and Wall and offers textures/. Writes OUT/web-desktop.png, web-phone.png and web-compare.png."""
import sys

from browser import Browser, serve

folder, page, out = sys.argv[1:]
url = serve(folder)
room = "document.querySelector('retex-room')"
browser = Browser(timeout=900)
try:
    for name, size, floor, wall in (("desktop", (1440, 900), "walnut-herringbone", None),
                                    ("phone", (390, 844), "terrazzo", "damask"),
                                    ("compare", (900, 620), "fans", "travertine")):
        browser.size(*size, phone=name == "phone")
        browser.open(url + page)
        for target, texture in (("Floor", floor), ("Wall", wall)):
            if texture:
                browser.run(f"{room}.setTexture('{target}', '{url}textures/{texture}.jpg')")
        browser.run(f"{room}.select('Floor')")
        if name == "compare":
            browser.run(f"{room}.command('compare')")
        browser.run(f"{room}.toBlob().then(() => new Promise(done => setTimeout(done, 800)))")
        browser.screenshot(f"{out}/web-{name}.png")
finally:
    browser.close()
