#!/bin/sh
# retex-combine --error: what it expects, against what a retexture is really off by from --replace at the same seed. In
# every scene of the house, with all bits of sets, measured over seeds 1 to 4, and in one as sets are rounded:
#
# - the expected error of the whole picture is the true one to a factor of 1.4. It was 0.77 to 0.82 times that under
#   glass, and 0.82 to 1.14 times elsewhere.
# - Spearman's rank correlation over blocks of 8x8 pixels is at least 0.75. The least was 0.78, under glass
#   and in the kitchen. In the rounded set it is 0.89; it was 0.47 when spreads did not include rounding.
set -u
. tests/lib/tap.sh
size=${FIDELITY_SIZE:-96x72} spp=${FIDELITY_SPP:-32} precision=--full-precision

check_scene() { # SCENE TARGET=IMAGE…
    scene=$1
    shift
    targets= textures= replacements=
    for each; do
        targets="$targets -t ${each%%=*}"
        textures="$textures --texture ${each%%=*}=$scenes/textures/${each#*=}"
        replacements="$replacements --replace ${each%%=*}=$scenes/textures/${each#*=}"
    done
    # shellcheck disable=SC2086 # words wanted
    for what in "$targets" "$replacements"; do
        retex-render -q $precision --threads 2 --size "$size" --spp "$spp" --seed 3 $what "$scenes/$scene/$scene.pov" \
            -o "$work/$([ "$what" = "$targets" ] && echo set || echo again).exr"
    done
    # shellcheck disable=SC2086
    retex-combine -q "$work/set.exr" $textures --error "$work/error.exr" -o "$work/retextured.exr"
    found=$(make_ranks "$work/error.exr" "$work/retextured.exr" "$work/again.exr")
    echo "# $scene, $*: rank correlation, expected, true: $found"
    result "$(echo "$found" | awk '{ print (NF == 3 && $1 >= 0.75 && $2 < 1.4 * $3 && $3 < 1.4 * $2) }')" \
        "$scene $* $precision"
}

check_scene cornell-box Floor=brick.jpg
check_scene glass-caustics Floor=terrazzo.jpg
check_scene living-room Floor=walnut-herringbone.jpg
check_scene living-room Floor=travertine.jpg Wall=damask.jpg
check_scene kitchen Floor=terrazzo.jpg Wall=fans.jpg
precision=
check_scene cornell-box Floor=brick.jpg
finish
