#!/bin/sh
# make parity: POV-Ray's sample scenes against POV-Ray. SCENES='chess2 camera/' selects scenes whose names contain a word;
# PARITY_JOBS=2 renders so many at a time; PARITY_TIMES=again measures POV-Ray's time again. A run of all scenes with
# BENCH_DOCS=1 writes docs/parity.md and docs/parity.csv.
set -eu
export LC_ALL=C PYTHONDONTWRITEBYTECODE=1
. tests/figures/head.sh
build=${BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
out=$build/parity
# shellcheck disable=SC2086 # words wanted
/usr/bin/python3 tests/parity/parity.py "$build" "$out" tests/long/examples.txt ${SCENES:-}
[ "${BENCH_DOCS:-}" = 1 ] && [ -z "${SCENES:-}" ] || exit 0
{
    cat tests/parity/page.md
    echo
    figures_head 'parity BENCH_DOCS=1'
    echo
    cat "$out/parity.md"
} >docs/parity.md
cp "$out/parity.csv" docs/parity.csv
