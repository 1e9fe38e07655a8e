#!/bin/sh
# The pages with measured figures in docs/, made anew: make figures.
#
#   make figures                          all of pages.txt; takes more than a day on two cores
#   make figures PAGES='fidelity speed'   some
#   make figures FIGURES=small            smaller pictures, fewer turns; a few hours
#
# A page is made by one build on one machine. Its head names them, and the command. A page that the present build has
# made is not made again, and one that was interrupted goes on where it stopped, as far as its script keeps what it has
# rendered. What another build rendered is removed first, except converged pictures: build/truth holds them by what they
# depend on. Last, the texts take over the new figures (quote.py).
set -eu
cd "$(dirname "$0")/../.."
build=${BUILD:-build} size=${FIGURES:-whole} python=${PYTHON:-/usr/bin/python3}
case $size in whole | small) ;; *)
    echo "figures: FIGURES is whole or small, not $size" >&2
    exit 2
    ;;
esac
pages=${PAGES:-$(sed -n 's/^\([a-z-]*\) |.*/\1/p' tests/figures/pages.txt)}
work=$build/figures
mkdir -p "$work"

# What the figures are of: the programs themselves.
programs() { cat "$build"/bin/retex-* | sha256sum | cut -c1-16; }
made_by=$(programs)
status=0
for page in $pages; do
    row=$(grep "^$page |" tests/figures/pages.txt) || {
        echo "figures: there is no page $page; see tests/figures/pages.txt" >&2
        exit 2
    }
    target=$(echo "$row" | cut -d '|' -f 2 | tr -d ' ')
    less='' flags="PAGES=$page"
    [ "$size" = whole ] || {
        less=$(echo "$row" | cut -d '|' -f 4-)
        flags="$flags FIGURES=small"
    }
    key="$made_by $size"
    if [ "$(cat "$work/$page" 2>/dev/null)" = "$key" ]; then
        echo "figures: docs/$page.md is of this build"
        continue
    fi
    if [ "$(cat "$work/$page.begun" 2>/dev/null)" != "$key" ]; then
        # shellcheck disable=SC2086,SC2046 # patterns wanted
        (cd "$build" && rm -rf $(echo "$row" | cut -d '|' -f 3))
        echo "$key" >"$work/$page.begun"
    fi
    echo "figures: docs/$page.md" >&2
    # shellcheck disable=SC2086 # the table quotes its words
    if eval env -u MAKEFLAGS -u MFLAGS $less FIGURES_COMMAND='"make figures $flags"' BENCH_DOCS=1 make BUILD="$build" "$target" \
        >"$work/$page.log" 2>&1; then
        [ "$(programs)" = "$made_by" ] || {
            echo "figures: the programs were built anew while docs/$page.md was made: it is of no single build" >&2
            exit 1
        }
        echo "$key" >"$work/$page"
    else
        echo "figures: $page failed; see $work/$page.log" >&2
        status=1
    fi
done
"$python" tests/figures/quote.py --update
exit $status
