#!/bin/sh
# How near retextures come to rendering again: seven scenes times eight textures, against converged pictures.
#
#   make fidelity            all of it, some hours on two cores, into $BUILD/fidelity; with BENCH_DOCS=1 the page and its
#                            figures go to docs/ too
#
# For each scene and texture (of two targets both change: the second takes the texture three further down the list) a
# converged picture is rendered, then at 128 and at 1024 samples and another seed: the picture rendered again, and sets
# of both layouts, retextured. The figure is PSNR against the converged picture (retex-diff: sRGB-encoded, clipped).
# In two scenes textures are also turned by 30 degrees. Everything is kept in $BUILD/fidelity and not made twice: what is
# there from an earlier run counts (make figures removes what another build made).
#
# FIDELITY_SCENES, FIDELITY_SPP, FIDELITY_SIZE and FIDELITY_TRUTH_SPP choose less, or more.
set -eu
. tests/fidelity/table/lib.sh
size=${FIDELITY_SIZE:-128x96} truth_spp=${FIDELITY_TRUTH_SPP:-8192} samples=${FIDELITY_SPP-128 1024}
scenes=${FIDELITY_SCENES:-$all_scenes}
turned='wood-turned text-turned' # checked in:
turned_scenes='cornell-box horizon'
sets='footprints footprints-8 paper'
methods='footprints footprints-8 paper paper-cross-2 paper-cross-0'
work=$build/fidelity
mkdir -p "$work/truth" "$work/again" "$work/sets" "$work/retextured"

score() { # SCENE TEXTURE SPP METHOD FILE
    # shellcheck disable=SC2020 # characters wanted
    retex-diff --json "$work/truth/$1-$2.exr" "$5" | tr ',{}' '\n\n\n' |
        awk -F: -v s="$1" -v t="$2" -v n="$3" -v m="$4" '
            $1 ~ /"psnr"/ { printf "%s,%s,%s,%s,%.2f\n", s, t, n, m, $2; found = 1 }
            END { exit !found }'
}

run() { # SCENE TEXTURE…: everything about some textures in a scene
    place=$1
    shift
    truth "$place" "$truth_spp" "$@"
    for count in $samples; do
        rendered "$place" "$work/again" "-$count" "$count" 1 "$@"
        for name in $sets; do make_set "$place" "$count" "$name"; done
        for name in $methods; do retextured "$place" "$count" "$name" "$@"; done
        for picture; do
            score "$place" "$picture" "$count" again "$work/again/$place-$picture-$count.exr"
            for name in $methods; do
                score "$place" "$picture" "$count" "$name" "$work/retextured/$place-$picture-$count-$name.exr"
            done
        done
    done
}

table=$work/fidelity.csv
{
    echo 'scene,texture,samples,method,psnr'
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
    done
} >"$table.new"
mv "$table.new" "$table"
awk -f "$here/table/report.awk" -v head="$(figures_head fidelity)" -v size="$size" -v truth="$truth_spp" "$table" \
    >"$work/fidelity.md"
[ "${BENCH_DOCS:-}" != 1 ] || cp "$work/fidelity.csv" "$work/fidelity.md" docs/
