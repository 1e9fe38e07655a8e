#!/bin/sh
# How near retextures come to rendering again: seven scenes times eight textures, against converged pictures.
#
#   make fidelity            into $BUILD/fidelity; with BENCH_DOCS=1 the page and its figures go to docs/ too
#
# For each scene and texture (of two targets both change: the second takes the texture three further down the list) a
# truth is rendered, then at 128 and at 1024 samples and another seed: the picture rendered again, and sets of both
# layouts, retextured. fidelity.py takes the figures. In two scenes textures are also turned by 30 degrees. Everything is
# kept in $BUILD/fidelity, which fidelity-denoise and bench-storage read too, and not made twice: what is there from an
# earlier run counts (make figures removes what another build made).
#
# FIDELITY_SCENES, FIDELITY_SPP, FIDELITY_PART (pixels of 512x384) and FIDELITY_TRUTH_SPP choose less, or more.
set -eu
. tests/fidelity/table/lib.sh
samples=${FIDELITY_SPP-128 1024}
scenes=${FIDELITY_SCENES:-$all_scenes}
turned='wood-turned text-turned' # checked in:
turned_scenes='cornell-box horizon'
sets='footprints footprints-8 paper'
methods='footprints footprints-8 paper paper-cross-2 paper-cross-0'
parts_of_pictures fidelity

run() { # SCENE TEXTURE…: everything about some textures in a scene
    place=$1
    shift
    truths "$place" "$truth_spp" "$@"
    for count in $samples; do
        rendered "$place" "$work/again" "-$count" "$count" 1 "$@"
        for name in $sets; do make_set "$place" "$count" "$name"; done
        for name in $methods; do retextured "$place" "$count" "$name" "$@"; done
        for picture; do echo "$place $picture $count"; done
    done
}

for each in $scenes; do
    echo "fidelity: $each" >&2
    # shellcheck disable=SC2086
    run "$each" $textures
    case " $turned_scenes " in
    *" $each "*)
        # shellcheck disable=SC2086
        run "$each" $turned
        ;;
    esac
done >"$work/cells"
"$python" "$here/table/fidelity.py" "$work" "$(figures_head fidelity)" "$part" "$truth_spp" "$methods" <"$work/cells" \
    >"$work/fidelity.md"
[ "${BENCH_DOCS:-}" != 1 ] || cp "$work/fidelity.csv" "$work/fidelity.md" docs/
