#!/bin/sh
# What a page of retex-pack --web loads, and how near its pictures come to those of retex-combine: make bench-web. Prints
# a page, which is also $BUILD/bench/web-figures.md, with the figures in web-figures.csv; with BENCH_DOCS=1 both go to
# docs/ too.
#
# The pictures are those of tests/web/reference.py, which is the shaders' arithmetic in numpy; tests/long/web compares
# what browsers draw. Sets are rendered and denoised once and kept in $BUILD/bench/web. BENCH_ROOMS (SIZE-SAMPLES of the
# living room, for what is loaded), BENCH_SMALL and BENCH_SMALL_SPP (height, a multiple of 36, and samples of pictures
# that are compared) choose less, or more.
set -eu
export LC_ALL=C
. tests/figures/head.sh
build=${BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
PATH=$build/bin:$PATH
work=$build/bench/web out=$build/bench
rooms=${BENCH_ROOMS:-480x270-64 960x540-32 1600x900-16}
small=${BENCH_SMALL:-288} small_spp=${BENCH_SMALL_SPP:-64}
figures_python bench-web
mkdir -p "$work"
figures_settings bench-web "$work" "$rooms $small $small_spp"
"$python" tests/bench/web/figures.py "$work" "$out/web-figures.csv" "$(figures_head bench-web)" "$rooms" "$small" "$small_spp" |
    tee "$out/web-figures.new"
mv "$out/web-figures.new" "$out/web-figures.md"
[ "${BENCH_DOCS:-}" != 1 ] || cp "$out/web-figures.md" "$out/web-figures.csv" docs/
