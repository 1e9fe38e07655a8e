#!/bin/sh
# Lets calls for memory, files and threads fail on every road of roads.txt, one at a time. RETEX_FAULTS=all: every call of
# our own (of a kind on a road at most 2000, spread evenly: only packs come to so many), and 500 of the libraries'; else
# a few of each.
set -u
. tests/lib/tap.sh
RETEX_OIDN=$BUILD/tests/oidn/libOpenImageDenoise.so.2
export RETEX_OIDN
mkdir -p "$work/run/out" "$work/run/log" "$work/run/tmp"
cp tests/faults/good.pov tests/faults/image.pov tests/faults/t.png tests/faults/model.gltf \
    tests/faults/compressed.gltf tests/data/lamp.ies "$work/run"
most=3 libraries=0
[ "${RETEX_FAULTS:-}" != all ] || { most=2000 libraries=500; }
(
    cd "$work/run" &&
    printf 'output,F\nout/a.png,t.jpg\nout/b.jpg,"rgb(.7,.2,.1)"\n' >table.csv &&
    printf 'output,F\nmade/a.png,t.jpg\nmade/b.jpg,"rgb(.7,.2,.1)"\n' >made.csv &&
    retex-render -q --size 16x12 --spp 2 -t F good.pov -o set.exr &&
    retex-pack -q set.exr -o set.retex &&
    retex-render -q --size 16x12 --spp 2 -t F --lamps each good.pov -o lamps.exr &&
    retex-pack -q lamps.exr -o lamps.retex &&
    retex-combine -q set.exr --texture F='rgb(.3,.5,.2)' -o t.jpg &&
    retex-sample -q set.exr --texture F=t.jpg -o samples.exr &&
    mkdir made && retex-combine -q set.exr --batch made.csv --manifest made/manifest &&
    retex-sample -q set.exr --texture F=t.jpg -o - >samples.stream
) || { echo "1..1"; echo "not ok 1 - inputs"; exit 1; }
"$BUILD/tests/faults/faults" "$here/tests/faults/roads.txt" "$BUILD/tests/faults/shim.so" "$here/tests/faults/known.txt" \
    "${FAULTS_MOST:-$most}" "${FAULTS_LIBRARIES:-$libraries}" "$work/run"
