"""Images of the IIIF Image API 3.0 from retex-serve: their sizes, read from the received files, and their pixels."""
import json
import os

import numpy
import OpenImageIO as oiio

from serving import Tap, fetch, size_of

ROOM = (480, 270)

# Parameters, and the size that the standard's text says for 480x270, worked out by hand; or the status.
IMAGES = [
    ("full/max/0/default.jpg", (480, 270)),
    ("full/max/0/default.png", (480, 270)),
    ("full/max/0/default.webp", (480, 270)),
    ("full/max/0/color.jpg", (480, 270)),
    ("full/max/0/gray.jpg", (480, 270)),
    ("square/max/0/default.jpg", (270, 270)),
    ("125,15,120,140/max/0/default.jpg", (120, 140)),
    ("0,0,480,270/max/0/default.jpg", (480, 270)),
    ("400,200,200,200/max/0/default.jpg", (80, 70)),
    ("479,269,1,1/max/0/default.png", (1, 1)),
    ("479,269,1000,1000/max/0/default.png", (1, 1)),
    ("pct:0,0,100,100/max/0/default.jpg", (480, 270)),
    ("pct:25,10,50,40/max/0/default.jpg", (240, 108)),
    ("pct:41.6,7.5,66.6,100/max/0/default.jpg", (280, 250)),  # from 199.68 = 200 and 20.25 = 20
    ("full/150,/0/default.jpg", (150, 84)),  # 84.375
    ("full/,150/0/default.jpg", (267, 150)),  # 266.67
    ("full/pct:50/0/default.jpg", (240, 135)),
    ("full/pct:33.3/0/default.jpg", (160, 90)),  # 159.84, 89.91
    ("full/225,100/0/default.jpg", (225, 100)),
    ("full/100,225/0/default.jpg", (100, 225)),
    ("full/!225,100/0/default.jpg", (178, 100)),  # 177.78
    ("full/!100,225/0/default.jpg", (100, 56)),  # 56.25
    ("full/!1000,1000/0/default.jpg", (480, 270)),
    ("full/!480,100/0/default.jpg", (178, 100)),
    ("full/^max/0/default.jpg", (480, 270)),
    ("full/^240,/0/default.jpg", (240, 135)),
    ("full/480,270/0/default.jpg", (480, 270)),
    ("full/1,1/0/default.png", (1, 1)),
    ("square/90,/0/default.jpg", (90, 90)),
    ("125,15,120,140/90,/0/default.jpg", (90, 105)),
    ("125,15,120,140/,35/0/default.jpg", (30, 35)),
    ("125,15,120,140/!60,60/0/default.jpg", (51, 60)),  # 51.43
    ("full/max/90/default.jpg", (270, 480)),
    ("full/max/180/default.jpg", (480, 270)),
    ("full/max/270/default.jpg", (270, 480)),
    ("full/max/360/default.jpg", (480, 270)),
    ("full/max/!0/default.jpg", (480, 270)),
    ("full/max/!90/default.jpg", (270, 480)),
    ("full/150,/90/default.jpg", (84, 150)),
    ("125,15,120,140/90,/!270/gray.png", (105, 90)),
    ("full/pct:12.5/0/gray.webp", (60, 34)),  # 33.75
    ("0,256,256,256/32,2/0/default.jpg", (32, 2)),
    ("full/481,/0/default.jpg", 400),
    ("full/,271/0/default.jpg", 400),
    ("full/pct:101/0/default.jpg", 400),
    ("125,15,120,140/121,10/0/default.jpg", 400),
    ("full/^481,/0/default.jpg", 501),
    ("full/^!960,960/0/default.jpg", 501),
    ("480,0,10,10/max/0/default.jpg", 400),
    ("10,10,0,10/max/0/default.jpg", 400),
    ("full/0,0/0/default.jpg", 400),
    ("full/full/0/default.jpg", 400),
    ("full/max/45/default.jpg", 400),
    ("full/max/0/bitonal.jpg", 400),
    ("full/max/0/default.tif", 400),
]


def pixels(data, work):
    path = os.path.join(work, "received.png")
    with open(path, "wb") as file:
        file.write(data)
    image = oiio.ImageInput.open(path)
    values = image.read_image(oiio.UINT8)
    image.close()
    return values


def check_sizes(port, identifier):
    wrong, received = [], 0
    for parameters, expected in IMAGES:
        reply = fetch(port, f"/iiif/3/{identifier}/{parameters}")
        found = size_of(reply.body) if reply.status == 200 else reply.status
        received += reply.status == 200
        if found != expected:
            wrong.append(f"{parameters}: {found}, not {expected}")
        elif reply.status == 200 and reply["Access-Control-Allow-Origin"] != "*":
            wrong.append(f"{parameters}: no CORS header")
    Tap.note(f"{received} images of IIIF, {len(IMAGES) - received} refused")
    Tap.result(not wrong and received >= 40, "images of IIIF have the sizes that the standard says", "; ".join(wrong))


def check_pixels(port, identifier, reference, work):
    """Lossless images are parts of the picture that retex-combine makes, turned and mirrored."""
    with open(reference, "rb") as file:
        whole = pixels(file.read(), work)
    cases = {"full/max/0": whole, "125,15,120,140/max/0": whole[15:155, 125:245], "square/max/0": whole[:, 105:375],
             "full/max/90": numpy.rot90(whole, -1), "full/max/180": numpy.rot90(whole, 2),
             "full/max/270": numpy.rot90(whole, 1), "full/max/!0": whole[:, ::-1],
             "full/max/!90": numpy.rot90(whole[:, ::-1], -1), "0,0,7,9/max/!270": numpy.rot90(whole[:9, 6::-1], 1)}
    wrong = []
    for parameters, expected in cases.items():
        found = pixels(fetch(port, f"/iiif/3/{identifier}/{parameters}/default.png").body, work)
        if found.shape != expected.shape or numpy.abs(found.astype(int) - expected).max() > 0:
            wrong.append(parameters)
    Tap.result(not wrong, "regions, rotations and mirrored images have retex-combine's pixels", " ".join(wrong))
    gray = pixels(fetch(port, f"/iiif/3/{identifier}/full/max/0/gray.png").body, work)
    rgb = numpy.broadcast_to(gray, whole.shape) if gray.shape[2] == 1 else gray
    luma = whole.astype(float) @ [0.2126, 0.7152, 0.0722]
    Tap.result((rgb[..., 0] == rgb[..., 2]).all() and numpy.abs(rgb[..., 1] - luma).mean() < 12,
               "gray images are gray and as bright")


def check_tiles(port, identifier, reference, work):
    """The tiles that a viewer computes from info.json, by the standard's implementation notes, cover the picture."""
    reply = fetch(port, f"/iiif/3/{identifier}/info.json")
    info = json.loads(reply.body)
    Tap.result(reply["Content-Type"] == 'application/ld+json;profile="http://iiif.io/api/image/3/context.json"' and
               info["id"] == f"http://127.0.0.1:{port}/iiif/3/{identifier}" and
               (info["width"], info["height"]) == ROOM and info["type"] == "ImageService3",
               "info.json describes the image")
    side, wrong = info["tiles"][0]["width"], []
    with open(reference, "rb") as file:
        whole = pixels(file.read(), work)
    for factor in info["tiles"][0]["scaleFactors"]:
        step = side * factor
        for y in range(0, ROOM[1], step):
            for x in range(0, ROOM[0], step):
                width, height = min(step, ROOM[0] - x), min(step, ROOM[1] - y)
                size = -(-width // factor), -(-height // factor)
                path = f"/iiif/3/{identifier}/{x},{y},{width},{height}/{size[0]},{size[1]}/0/default.png"
                tile = fetch(port, path)
                if size_of(tile.body) != size:
                    wrong.append(path)
                elif factor == 1 and (pixels(tile.body, work) != whole[y:y + height, x:x + width]).any():
                    wrong.append(path)
    for size in info["sizes"]:
        path = f"/iiif/3/{identifier}/full/{size['width']},{size['height']}/0/default.jpg"
        if size_of(fetch(port, path).body) != (size["width"], size["height"]):
            wrong.append(path)
    Tap.result(not wrong, "all tiles and sizes of info.json are served", " ".join(wrong))


def check_http(port, identifier):
    base = fetch(port, f"/iiif/3/{identifier}")
    Tap.result(base.status == 303 and base["Location"] == f"http://127.0.0.1:{port}/iiif/3/{identifier}/info.json",
               "the base URI redirects to info.json")
    image = fetch(port, f"/iiif/3/{identifier}/square/100,/!360/color.jpg")
    link = f'<http://127.0.0.1:{port}/iiif/3/{identifier}/105,0,270,270/100,100/!0/default.jpg>;rel="canonical"'
    Tap.result(link in image["Link"] and 'level2.json>;rel="profile"' in image["Link"], "links are canonical",
               image["Link"])
    same = fetch(port, image["Link"].split(">")[0][1:].split(str(port), 1)[1])
    Tap.result(same.body == image.body and same["ETag"] == image["ETag"] != "", "the canonical URL gives the same")
    again = fetch(port, f"/iiif/3/{identifier}/square/100,/!0/default.jpg", headers={"If-None-Match": image["ETag"]})
    Tap.result(again.status == 304 and not again.body, "an image that the client has is not sent again")
    plain = fetch(port, f"/iiif/3/{identifier}/info.json", headers={"Accept": "application/json"})
    Tap.result(plain["Content-Type"] == "application/json" and "Accept" in plain["Vary"], "info.json as plain JSON")


def check(port, identifier, reference, work):
    check_sizes(port, identifier)
    check_pixels(port, identifier, reference, work)
    check_tiles(port, identifier, reference, work)
    check_http(port, identifier)
