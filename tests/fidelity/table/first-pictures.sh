#!/bin/sh
# First pictures of rooms of other people: as retex-import shows them without an option.
#
#   make fidelity-first      into $BUILD/fidelity-first; with BENCH_DOCS=1 the page and its pictures go to docs/ too
#
# The rooms are not in the repository. first-pictures.csv lists them: where each is from, at which revision, its licence
# and its hash, whether a person found the picture good, and why not. `blind` models were looked at once, when all rules
# were made; by `unseen` ones the last rules were found: a lamp for white windows, and what could not be imported. $RETEX_FIRST, or ../shared/first, is a folder in
# which each has a folder of its name. Those that are not there, or are others, are told and left out. FIRST names some,
# FIRST_SPP the samples. FIRST_OLD is the folder bin of an older build, whose pictures stand at the left.
set -eu
. tests/figures/head.sh
build=${BUILD:-build}
from=${RETEX_FIRST:-${RETEX_SHARED:-../shared}/first} work=$(cd "$build" && pwd)/fidelity-first
if [ ! -d "$from" ]; then
    echo "fidelity-first: there is no $from: skipped" >&2
    exit
fi
figures_python fidelity-first
mkdir -p "$work"
"$python" tests/fidelity/table/first-pictures.py "$work" "$from" "$(cd "$build" && pwd)/bin" "${FIRST_OLD:-}" \
    "$(figures_head fidelity-first)" "${FIRST_SPP:-32}" ${FIRST:-}
if [ "${BENCH_DOCS:-0}" = 1 ]; then
    cp "$work/first-pictures.md" docs/
    cp "$work"/first-pictures-*.jpg docs/pictures/
fi
