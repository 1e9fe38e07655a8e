#!/bin/sh
# Size of stored sets against what they lose: make bench-storage. Prints a page, which is also $BUILD/bench/storage.md,
# with its figures in storage.csv and, where python3-matplotlib is installed, plotted in storage.png; with BENCH_DOCS=1
# they go to docs/ and docs/pictures/ too.
#
# The sets of four scenes of make fidelity in both layouts, and denoised, are stored as packs of all codecs and several
# qualities, as EXR with lossless and with DWAA compression, and with each image of light as a JPEG of its own; and as they
# were rendered, with their noise, as packs of the default quality. Each is given several textures, and its pictures are
# compared with those of the set that was stored and with truths.
#
# It shares $BUILD/fidelity with make fidelity and fidelity-denoise, and renders what is not there. FIDELITY_PART,
# FIDELITY_TRUTH_SPP, BENCH_SCENES, BENCH_LAYOUTS='footprints paper', BENCH_TEXTURES (some of checker wood grout text
# saturated constant dark photo), BENCH_QUALITIES, BENCH_LEVELS (of DWAA), BENCH_JPEG_QUALITIES and BENCH_CODECS choose
# less.
set -eu
export LC_ALL=C
case ${BUILD:-build} in /*) ;; *) BUILD=$PWD/${BUILD:-build} ;; esac
export BUILD
. tests/fidelity/table/lib.sh
post=tests/bench/post set_spp=128
scenes=${BENCH_SCENES:-cornell-box glass-caustics living-room kitchen} layouts=${BENCH_LAYOUTS:-footprints paper}
looks=${BENCH_TEXTURES:-wood text saturated photo}
qualities=${BENCH_QUALITIES:-30 50 70 80 90 95 98 100} levels=${BENCH_LEVELS:-10 45 150 500}
jpeg_qualities=${BENCH_JPEG_QUALITIES:-50 75 90 95 98 100}
# What retex-pack has it says where it is asked for something else.
codecs=${BENCH_CODECS:-$(retex-pack --codec '?' x -o x 2>&1 | sed -n 's/.*this version has: //p' | tr -d ,)}
out=$build/bench stored=$build/bench/storage
if [ -z "$codecs" ]; then
    echo "bench-storage: retex-pack does not say which codecs it has; name them in BENCH_CODECS" >&2
    exit 2
fi
parts_of_pictures bench-storage
records=$stored/runs
mkdir -p "$stored"
: >"$records"

retextures() { # FILE PREFIX: its pictures with all textures
    # shellcheck disable=SC2086 # words wanted
    batch "$scene" "$stored/$2" '' $looks >"$stored/batch.csv"
    retex-combine -q "$1" --batch "$stored/batch.csv"
}
record() { # METHOD LEVEL: the pictures beginning with stored-, and the sizes in $stored/sizes.json
    # shellcheck disable=SC2086
    "$python" -B $post/scored.py "$work/truth" "$stored" "$stored/sizes.json" "$scene" "$layout" "$kind" "$1" "$2" \
        $looks >>"$records"
    echo "$scene $layout $kind $1 $2" >&2
}
packed() { # METHOD LEVEL OPTION...: of retex-pack
    method=$1 level=$2
    shift 2
    retex-pack -q "$set" "$@" -o "$stored/stored.retex"
    "$python" $post/stored.py "$stored/stored.retex" "$stored/stored.retex" >"$stored/sizes.json"
    retextures "$stored/stored.retex" stored-
    record "$method" "$level"
}
coded() { # METHOD LEVEL: of other programs; not in the page where the file can no longer be read as a set
    "$python" $post/coded.py "$set" "$stored/stored.exr" "$1" "$2" >"$stored/sizes.json"
    if retextures "$stored/stored.exr" stored-; then record "$1" "$2"; fi
}
as_it_is() { # the set itself
    retextures "$set" set-
    retextures "$set" stored-
    "$python" $post/stored.py "$set" "$set" >"$stored/sizes.json"
    record exr ''
}
measure_rendered() { # of $scene and $layout
    kind=rendered set=$work/sets/$scene-$set_spp-$layout.exr
    make_set "$scene" "$set_spp" "$layout"
    as_it_is
    for codec in $codecs; do packed "pack-$codec" 90 --codec "$codec" --quality 90; done
}
measure_denoised() {
    name=denoised
    [ "$layout" = footprints ] || name=$layout-denoised
    kind=denoised set=$work/sets/$scene-$set_spp-$name.exr
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
    truths "$scene" "$truth_spp" $looks
    for layout in $layouts; do
        echo "bench-storage: $scene, $layout" >&2
        measure_rendered
        measure_denoised
    done
done
rm -f "$stored"/*.exr "$stored"/*.retex "$stored"/*.json "$stored"/batch.csv
"$python" $post/storage_page.py "$records" "$out/storage.csv" "$(figures_head bench-storage)" "$part" "$set_spp" \
    "$truth_spp" | tee "$out/storage.md"
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
