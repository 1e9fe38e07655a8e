#!/bin/sh
# Size of stored sets against what they lose: make bench-storage. Prints a page, which is also $BUILD/bench/storage.md,
# with its figures in storage.csv and, where python3-matplotlib is installed, plotted in storage.png; with BENCH_DOCS=1
# they go to docs/ and docs/pictures/ too.
#
# Sets of our four scenes in both layouts, rendered and denoised once and kept in $BUILD/bench/storage-SIZE, are stored
# as packs of all codecs and several qualities, as EXR with lossless and with DWAA compression, and with each image of
# light as a JPEG of its own; and as they were rendered, with their noise, as packs of the default quality. Each is given
# several textures, and its pictures are compared with those of the set that was stored and, where there are converged
# pictures, with these.
#
# As it stands it takes about an hour on two cores, a third of it rendering once. BENCH_SIZE (640x480), BENCH_SPP (128),
# BENCH_SCENES, BENCH_LAYOUTS='footprints paper', BENCH_TEXTURES (some of checker wood grout text saturated constant
# dark photo), BENCH_QUALITIES, BENCH_LEVELS (of DWAA), BENCH_JPEG_QUALITIES and BENCH_CODECS choose less.
# BENCH_TRUTH_SPP renders converged pictures of so many samples, once; BENCH_TRUTH is a folder that has some,
# SCENE-TEXTURE.exr as make fidelity leaves them in $BUILD/fidelity/truth, which are of BENCH_SIZE=128x96.
set -eu
export LC_ALL=C
case ${BUILD:-build} in /*) ;; *) BUILD=$PWD/${BUILD:-build} ;; esac
export BUILD
. tests/fidelity/table/lib.sh
post=tests/bench/post python=${PYTHON:-/usr/bin/python3}
size=${BENCH_SIZE:-640x480} set_spp=${BENCH_SPP:-128}
scenes=${BENCH_SCENES:-cornell-box glass-caustics living-room kitchen} layouts=${BENCH_LAYOUTS:-footprints paper}
looks=${BENCH_TEXTURES:-wood text saturated photo}
qualities=${BENCH_QUALITIES:-30 50 70 80 90 95 98 100} levels=${BENCH_LEVELS:-10 45 150 500}
jpeg_qualities=${BENCH_JPEG_QUALITIES:-50 75 90 95 98 100}
# What retex-pack has it says where it is asked for something else.
codecs=${BENCH_CODECS:-$(retex-pack --codec '?' x -o x 2>&1 | sed -n 's/.*this version has: //p' | tr -d ,)}
work=$build/bench/storage-$size out=$build/bench
truth=${BENCH_TRUTH:-$work/truth} records=$work/runs
if [ -z "$codecs" ]; then
    echo "bench-storage: retex-pack does not say which codecs it has; name them in BENCH_CODECS" >&2
    exit 2
fi
if ! "$python" -c 'import numpy, OpenImageIO' 2>/dev/null; then
    echo "bench-storage: $python needs numpy and OpenImageIO (python3-numpy, python3-openimageio)" >&2
    exit 2
fi
mkdir -p "$work/sets" "$work/retextured" "$work/truth"
: >"$records"

psnr() { # A B: or null where the two cannot be compared
    # shellcheck disable=SC2020 # characters wanted
    { retex-diff --json "$1" "$2" 2>/dev/null || :; } | tr ',{}' '\n\n\n' |
        awk -F: '$1 ~ /"psnr"/ { figure = $2 } END { print figure == "" ? "null" : figure }'
}
picture() { echo "$work/retextured/$1$scene-$2.exr"; } # PREFIX TEXTURE
retextures() { # FILE PREFIX: its pictures with all textures
    # shellcheck disable=SC2086 # words wanted
    batch "$scene" "$work/retextured/$2" '' $looks >"$work/batch.csv"
    retex-combine -q "$1" --batch "$work/batch.csv"
}
record() { # METHOD LEVEL: the pictures beginning with stored-, and the sizes in $work/sizes.json
    for look in $looks; do
        made=$(picture stored- "$look") real=$truth/$scene-$look.exr unpacked=$(picture set- "$look")
        against='null' of_set='null'
        if [ -e "$real" ]; then against=$(psnr "$real" "$made") of_set=$(psnr "$real" "$unpacked"); fi
        printf '{"scene": "%s", "layout": "%s", "set": "%s", "method": "%s", "level": "%s", "texture": "%s", ' \
            "$scene" "$layout" "$kind" "$1" "$2" "$look"
        printf '"psnr": %s, "truth": %s, "set_truth": %s, "stored": %s}\n' "$(psnr "$unpacked" "$made")" "$against" \
            "$of_set" "$(cat "$work/sizes.json")"
    done >>"$records"
    echo "$scene $layout $kind $1 $2" >&2
}
packed() { # METHOD LEVEL OPTION...: of retex-pack
    method=$1 level=$2
    shift 2
    retex-pack -q "$set" "$@" -o "$work/stored.retex"
    "$python" $post/stored.py "$work/stored.retex" "$work/stored.retex" >"$work/sizes.json"
    retextures "$work/stored.retex" stored-
    record "$method" "$level"
}
coded() { # METHOD LEVEL: of other programs; not in the page where the file can no longer be read as a set
    "$python" $post/coded.py "$set" "$work/stored.exr" "$1" "$2" >"$work/sizes.json"
    if retextures "$work/stored.exr" stored-; then record "$1" "$2"; fi
}
as_it_is() { # the set itself
    retextures "$set" set-
    retextures "$set" stored-
    "$python" $post/stored.py "$set" "$set" >"$work/sizes.json"
    record exr ''
}
measure_rendered() { # of $scene and $layout
    kind=rendered set=$work/sets/$scene-$set_spp-$layout.exr
    make_set "$scene" "$set_spp" "$layout"
    as_it_is
    for codec in $codecs; do packed "pack-$codec" 90 --codec "$codec" --quality 90; done
}
measure_denoised() {
    kind=denoised set=$work/sets/$scene-$set_spp-$layout-denoised.exr
    [ -e "$set" ] || retex-denoise -q "$work/sets/$scene-$set_spp-$layout.exr" -o "$set"
    as_it_is
    packed lossless '' --lossless
    for codec in $codecs; do
        for quality in $qualities; do packed "pack-$codec" "$quality" --codec "$codec" --quality "$quality"; done
    done
    for level in $levels; do coded dwaa "$level"; done
    coded dwaa-all 45
    for quality in $jpeg_qualities; do coded jpeg "$quality"; done
}

for scene in $scenes; do
    # shellcheck disable=SC2086
    [ -z "${BENCH_TRUTH_SPP:-}" ] || truth "$scene" "$BENCH_TRUTH_SPP" $looks
    for layout in $layouts; do
        echo "bench-storage: rendering $scene, $layout" >&2
        measure_rendered
        measure_denoised
    done
done
rm -rf "$work/retextured" "$work"/stored.* "$work"/*.json "$work"/batch*.csv
"$python" $post/storage_page.py "$records" "$out/storage.csv" "$(figures_head bench-storage)" "$size" "$set_spp" | tee "$out/storage.md"
if "$python" -c 'import matplotlib' 2>/dev/null; then
    "$python" $post/storage_plot.py "$out/storage.csv" "$out/storage.png"
else
    echo "bench-storage: no figure, for $python has no matplotlib (python3-matplotlib)" >&2
    rm -f "$out/storage.png"
fi
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "$out/storage.csv" "$out/storage.md" docs/
    [ ! -e "$out/storage.png" ] || cp "$out/storage.png" docs/pictures/
fi
