"""Links and pictures of the Markdown pages: prints each that leads nowhere, and exits with 1. links.py [FILE...]

A target is a file or folder of the repository, an anchor (#heading) of a page, or a URL, which is not opened. Anchors are
those of GitHub: headings in lower case, without punctuation, with hyphens for blanks. Every picture in docs/pictures must
be shown by a page. Pages are parsed by cmark."""
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as xml

PAGES = re.compile(r"(^|/)README\.md$|^(docs/)?[\w-]+\.md$")  # others are templates of such pages
SPACE = "{http://commonmark.org/xml/1.0}"


def texts(node):
    return "".join((child.text or "") if child.tag in (SPACE + "text", SPACE + "code") else texts(child) for child in node)


class Page:
    """The links, pictures and anchors of a page, as cmark parses it."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            source = file.read()
        # A row of a table is a paragraph for cmark: links in it are found alike.
        tree = xml.fromstring(subprocess.run(["cmark", "-t", "xml"], input=source.encode(), capture_output=True,
                                             check=True).stdout)
        self.links, self.pictures, self.anchors = [], [], set()
        counts = {}
        for node in tree.iter():
            if node.tag == SPACE + "link":
                self.links.append(node.get("destination"))
            elif node.tag == SPACE + "image":
                self.pictures.append(node.get("destination"))
            elif node.tag == SPACE + "heading":
                slug = re.sub(r"[^\w\- ]", "", texts(node).lower()).replace(" ", "-")
                count = counts.get(slug, 0)
                counts[slug] = count + 1
                self.anchors.add(f"{slug}-{count}" if count else slug)
        # What cmark did not take for a link, because its file name has a blank or its bracket no end.
        plain = re.sub(r"```(?:.|\n)*?```|`[^`\n]*`|^    .*$", "", source, flags=re.M)
        written = len(re.findall(r"\]\(", plain))
        self.broken = written - len(self.links) - len(self.pictures) + len(re.findall(r"<https?:", plain))


def files():
    """What git has; or, where the sources are no checkout, what lies beside this file's folder."""
    listed = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=False).stdout.split()
    return listed or [os.path.normpath(os.path.join(folder, name)) for folder, _, names in os.walk(".")
                      if not re.match(r"\./(build|\.git)(/|$)", folder) for name in names]


def main():
    tracked = files()
    paths = sys.argv[1:] or [path for path in tracked if PAGES.search(path) and os.path.exists(path)]
    pages = {os.path.normpath(path): Page(path) for path in paths}
    shown, wrong = set(), 0
    for path, page in pages.items():
        found = [] if page.broken == 0 else [f"{abs(page.broken)} links that are none"]
        for target in page.links + page.pictures:
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            file = os.path.normpath(os.path.join(os.path.dirname(path), name)) if name else path
            if not os.path.exists(file):
                found.append(f"no file {target}")
            elif anchor and (file not in pages or anchor not in pages[file].anchors):
                found.append(f"no anchor {target}")
            if target in page.pictures:
                shown.add(file)
                if os.path.exists(file) and not re.search(r"\.(jpg|png|svg|webp)$", file):
                    found.append(f"no picture {target}")
        for what in found:
            print(f"{path}: {what}")
        wrong |= bool(found)
    if not sys.argv[1:]:
        for path in tracked:
            if path.startswith("docs/pictures/") and os.path.exists(path) and path not in shown:
                print(f"{path}: no page shows it")
                wrong = 1
    return wrong


sys.exit(main())
