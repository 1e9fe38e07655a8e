"""No page of measured figures is older than its subject by more than 25 changes: ages.py

pages.txt, beside this file, names each page's subject. The page says from which commit it was made. Since then there may
be 25 commits that touched the subject, and no more. Changes of it that are not committed yet count as another one.
Prints a line for each page that is older, or is of no
commit of this repository, and exits with 1. Pages whose material is not there cannot be made. Without the repository's
history, as in a source package, there is nothing to check.
"""
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
MOST = 25


def git(*words):
    return subprocess.run(["git", *words], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, encoding="utf-8", check=False)


def pages():
    with open(os.path.join(HERE, "pages.txt"), encoding="utf-8") as file:
        for line in file:
            if not line.startswith("#"):
                columns = [column.strip() for column in line.split("|")]
                if all(map(os.path.exists, filter(None, columns[6:]))):
                    yield columns[0], columns[3].split()


def wrong(page, subject):
    """What is wrong with a page, or None."""
    missing = [path for path in subject if not os.path.exists(path)]
    if missing or not subject:
        return f"tests/figures/pages.txt: {page}: there is no {' '.join(missing) or 'subject'}"
    if not os.path.exists(f"docs/{page}.md"):
        return f"there is no docs/{page}.md: make figures PAGES={page}"
    with open(f"docs/{page}.md", encoding="utf-8") as file:
        found = re.search(r"(?:from|with)\s+commit\s+(\w+)(\s+with\s+changes)?", file.read())
    if not found:
        return f"docs/{page}.md does not say from which commit it was made"
    if found[2]:
        return f"docs/{page}.md was made from commit {found[1]} with changes: of no commit"
    if git("merge-base", "--is-ancestor", found[1], "HEAD").returncode:
        return f"docs/{page}.md was made from commit {found[1]}, which HEAD does not stand on"
    changed = git("status", "--porcelain", "--", *subject).stdout != ""
    count = int(git("rev-list", "--count", f"{found[1]}..HEAD", "--", *subject).stdout or 0) + changed
    if count > MOST:
        return (f"docs/{page}.md was made from commit {found[1]}, {count} changes of "
                f"{', '.join(subject)} ago: make figures PAGES={page}")
    return None


def main():
    if git("rev-parse", "--is-shallow-repository").stdout.strip() != "false":
        return 0
    found = list(filter(None, (wrong(page, subject) for page, subject in pages())))
    for line in found:
        print(line)
    return 1 if found else 0


sys.exit(main())
