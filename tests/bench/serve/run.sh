#!/bin/sh
# What retex-serve's answers cost: make bench-serve. Writes $BUILD/bench/serve.csv; with BENCH_DOCS=1 also
# docs/serve.csv, from which docs/serve.md takes its figures (make figures PAGES=serve).
#
# The living room with two targets, from packs: new pictures, kept ones, 64 clients of wrk, and pictures per processor
# time beside `retex-combine --batch`. Processor time, so that other programs on the machine matter little. Sets are
# rendered once, some minutes, and kept; the rest takes a quarter of an hour. BENCH_SIZE, BENCH_COUNT (new pictures of a
# kind) and BENCH_SECONDS choose less.
set -eu
bench='bench-serve'
. tests/bench/post/lib.sh
work=$build/bench/serve
tools/setup.sh serve >&2
rm -rf "$work"
mkdir -p "$work/rooms"
for room in "small 480x270 32" "large ${BENCH_SIZE:-1920x1080} 4"; do
    # shellcheck disable=SC2086 # words wanted
    set -- $room
    denoised_set living-room footprints "$2" "$3" 'Floor Wall'
    packed_set "$denoised"
    ln -s "$pack" "$work/rooms/$1.retex"
done
"$python" -B tests/serve/costs.py "$work/rooms" scenes/textures "$work" "${BENCH_SECONDS:-120}" "${BENCH_COUNT:-12}" \
    "$work/costs.csv" >&2
{
    cat "$work/costs.csv"
    echo "large,size,${BENCH_SIZE:-1920x1080}"
    echo "pack,bytes,$(stat -L -c %s "$work/rooms/large.retex")"
    echo "measured,by,\"$(figures_head bench-serve | sed 's/ made this page from/ measured them with/')\""
} >"$out/serve.csv"
cat "$out/serve.csv"
[ -z "${BENCH_DOCS:-}" ] || cp "$out/serve.csv" docs/serve.csv
