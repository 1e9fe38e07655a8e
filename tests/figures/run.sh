#!/bin/sh
# The pages with measured figures in docs/, made anew: make figures.
#
#   make figures                          all of pages.txt, in at most 100 minutes on two cores
#   make figures PAGES='fidelity speed'   some
#   make figures FULL=1                   larger pictures, more turns, the paper's sizes: more than a day, for a release
#
# A page is made by one build on one machine. Its head names them, and the command. A page that the present build has
# made is not made again, and one that was interrupted goes on where it stopped, as far as its script keeps what it has
# rendered. What another build rendered is removed first, except converged pictures, which are kept by what they depend
# on, in build/truth, and those of an ordinary run in tests/fidelity/truths. A page that takes twice its minutes is
# stopped. Last, the texts take over the new figures (quote.py).
set -eu
cd "$(dirname "$0")/../.."
build=${BUILD:-build} full=${FULL:-} python=${PYTHON:-/usr/bin/python3}
pages=${PAGES:-$(sed -n 's/^\([a-z-]*\) |.*/\1/p' tests/figures/pages.txt)}
work=$build/figures
mkdir -p "$work"

column() { echo "$row" | cut -d '|' -f "$1" | sed 's/^ *//; s/ *$//'; } # NUMBER: of the page's row

# What the figures are of: the programs themselves.
programs() { cat "$build"/bin/retex-* | sha256sum | cut -c1-16; }
made_by=$(programs)
key="$made_by${full:+ full}"
if [ "$(cat "$work/key" 2>/dev/null)" != "$key" ]; then
    kept=$(grep -v '^#' tests/figures/pages.txt | cut -d '|' -f 5)
    # shellcheck disable=SC2086 # patterns wanted
    (cd "$build" && rm -rf $kept)
    rm -f "$work"/*
    echo "$key" >"$work/key"
fi
status=0
for page in $pages; do
    row=$(grep "^$page |" tests/figures/pages.txt) || {
        echo "figures: there is no page $page; see tests/figures/pages.txt" >&2
        exit 2
    }
    target=$(column 2) minutes=$(column 3) less=$(column 6) flags="PAGES=$page" keep=1
    material=$(column 7)
    if [ -n "$material" ] && ! [ -e "$material" ]; then
        echo "figures: docs/$page.md stays as it is: there is no $material"
        continue
    fi
    if [ -n "$full" ]; then less='' flags="$flags FULL=1" minutes=100000 keep=; fi
    if [ -e "$work/$page.done" ]; then
        echo "figures: docs/$page.md is of this build"
        continue
    fi
    echo "figures: docs/$page.md, $minutes minutes" >&2
    begun=$(date +%s) ended=0
    # shellcheck disable=SC2086 # the table quotes its words
    eval timeout "$((2 * minutes))m" env -u MAKEFLAGS -u MFLAGS $less FIGURES_COMMAND='"make figures $flags"' \
        KEEP_TRUTHS="$keep" BENCH_DOCS=1 make BUILD="$build" "$target" >"$work/$page.log" 2>&1 || ended=$?
    took=$(awk -v s=$(($(date +%s) - begun)) 'BEGIN { printf "%.1f", s / 60 }')
    if [ "$(programs)" != "$made_by" ]; then
        echo "figures: the programs were built anew while docs/$page.md was made: it is of no single build" >&2
        exit 1
    fi
    case $ended in
    0)
        : >"$work/$page.done"
        echo "figures: docs/$page.md took $took minutes"
        ;;
    124)
        echo "figures: $page was stopped after twice its $minutes minutes; see $work/$page.log" >&2
        status=1
        ;;
    *)
        echo "figures: $page failed after $took minutes; see $work/$page.log" >&2
        status=1
        ;;
    esac
done
"$python" tests/figures/quote.py --update
exit $status
