#!/bin/sh
# Links, anchors and pictures of all Markdown pages lead somewhere; and links.py finds each kind that does not.
set -u
. tests/lib/tap.sh
links() { /usr/bin/python3 -B "$here/tests/docs/links.py" "$@"; }
links >"$work/found"
status=$?
sed 's/^/# /' "$work/found"
result "$([ $status = 0 ] && echo 1)" "all links, anchors and pictures exist"

# finds TEXT MESSAGE: of a page with that text links.py prints the message, and exits with 1.
finds() {
    printf '# The head of it\n\n## Twice\n\n## Twice\n\n%s\n' "$1" >"$work/page.md"
    links "$work/page.md" >"$work/found"
    status=$?
    result "$([ $status = 1 ] && grep -qF "page.md: $2" "$work/found" && echo 1)" "found: $2"
}
accepts() {
    printf '# The head of `it`, (now)\n\n## Twice\n\n## Twice\n\n%s\n' "$1" >"$work/page.md"
    result "$(links "$work/page.md" && echo 1)" "accepted: $1"
}
touch "$work/there.jpg" "$work/there.txt"
finds '[a](missing.md)' 'no file missing.md'
finds '| ![a](missing.jpg) | b |' 'no file missing.jpg'
finds '![a](there.txt)' 'no picture there.txt'
finds '[a](#tail-of-it)' 'no anchor #tail-of-it'
finds '[a](#twice-2)' 'no anchor #twice-2'
finds '[a](there too.jpg)' '1 links that are none'
accepts '[a](#the-head-of-it-now) [b](#twice-1) [c](page.md#twice) ![d](there.jpg) [e](https://example.com)'
accepts '`[a](missing.md)`'
finish
