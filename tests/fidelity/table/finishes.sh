#!/bin/sh
# Finishes chosen after rendering, against the scenes rendered with them: noise, times, sizes and pictures.
#
#   make fidelity-finishes  an hour on two cores, into $BUILD/fidelity-finishes; with BENCH_DOCS=1 the page, its figures
#                           and its pictures go to docs/ and docs/pictures/ too
#
# Each finish is taken from one set a scene, and rendered alone with as many samples. Two converged pictures of each,
# with noise of their own, are the truth. Then sets of the living room without finishes, with three, and with six
# combinations. finishes.py computes the figures. What is there from an earlier run is not made again.
#
# FINISHES_SPP, FINISHES_TRUTH_SPP, FINISHES_HEIGHT, FINISHES_PICTURE_HEIGHT, FINISHES_PICTURE_SPP, FINISHES_SIZE and FINISHES_SIZE_SPP choose
# less, or more.
set -eu
. tests/fidelity/table/lib.sh
work=$build/fidelity-finishes
spp=${FINISHES_SPP:-128} truth_spp=${FINISHES_TRUTH_SPP:-2048} height=${FINISHES_HEIGHT:-96}
picture_height=${FINISHES_PICTURE_HEIGHT:-270} picture_spp=${FINISHES_PICTURE_SPP:-256} size=${FINISHES_SIZE:-960x540} size_spp=${FINISHES_SIZE_SPP:-64}
scenes='living-room kitchen' floors='original,satin,polished,metal' walls='original,satin'
figures_python fidelity-finishes
mkdir -p "$work"
settings="$spp $truth_spp $height $picture_height $size $size_spp"
figures_settings fidelity-finishes "$work" "$settings"

# ---- one set against renders of their own ----

for scene in $scenes; do
    echo "fidelity-finishes: $scene" >&2
    [ -e "$work/$scene.exr" ] || {
        timed "$work/$scene-time" retex-render -q --threads 1 --size "$(wide "$scene" "$height")" --spp "$spp" --seed 1 \
            --finish Floor=$floors -t Floor -t Wall "scenes/$scene/$scene.pov" -o "$work/$scene.exr"
        retex-denoise -q "$work/$scene.exr" -o "$work/$scene-denoised.exr"
    }
    for finish in $(echo $floors | tr ',' ' '); do
        name=$work/$scene-$finish
        truth "finishes-$scene-$finish" "$(wide "$scene" "$height")" "$truth_spp" \
            retex-render -q --finish Floor="$finish" --plain "scenes/$scene/$scene.pov"
        made "$name-set.exr" retex-combine -q "$work/$scene.exr" --finish Floor="$finish"
        made "$name-denoised.exr" retex-combine -q "$work/$scene-denoised.exr" --finish Floor="$finish"
        [ -e "$name-own.exr" ] || {
            timed "$name-own-time" retex-render -q --threads 1 --size "$(wide "$scene" "$height")" --spp "$spp" --seed 1 \
                --finish Floor="$finish" -t Floor -t Wall "scenes/$scene/$scene.pov" -o "$name-own.exr"
        }
    done
done

# ---- pictures of the living room ----

room() { retex-render -q --size "$(wide living-room "$picture_height")" scenes/living-room/living-room.pov "$@"; }
made "$work/room.exr" room --finish Floor=$floors --finish Wall=original -t Floor -t Wall --spp 64 --denoise
for finish in original satin polished metal; do
    made "$work/picture-$finish-ours.exr" retex-combine -q "$work/room.exr" --finish Floor=$finish \
        --texture Floor=scenes/textures/walnut-herringbone.jpg
    made "$work/picture-$finish-new.exr" room --finish Floor=$finish --plain --spp "$picture_spp" \
        --replace Floor=scenes/textures/walnut-herringbone.jpg
done

# ---- bytes and times ----

costs() { # NAME CHOSEN OPTION...
    name=$work/costs-$1 chosen=$2
    shift 2
    [ ! -e "$name.retex.combine-time" ] || return 0
    timed "$name.render-time" retex-render -q --size "$size" --spp "$size_spp" -t Floor -t Wall "$@" \
        scenes/living-room/living-room.pov -o "$name.exr"
    timed "$name.denoise-time" retex-denoise -q "$name.exr" -o "$name-denoised.exr"
    timed "$name.pack-time" retex-pack -q "$name-denoised.exr" -o "$name.retex"
    wc -c <"$name.exr" >"$name.exr-bytes"
    wc -c <"$name-denoised.exr" >"$name.denoised-bytes"
    wc -c <"$name.retex" >"$name.pack-bytes"
    for from in "$name-denoised.exr" "$name.retex"; do
        # shellcheck disable=SC2086 # words wanted
        timed "$from.combine-time" retex-combine -q "$from" --threads 1 $chosen \
            --texture Floor=scenes/textures/walnut-herringbone.jpg -o "$work/picture.exr"
    done
    rm "$name.exr" "$name-denoised.exr"
}
costs none ''
costs three '--finish Floor=polished' --finish Floor=original,satin,polished
costs six '--finish Floor=polished' --finish Floor=original,satin,polished --finish Wall=$walls

"$python" "$here/table/finishes.py" "$work" "$(figures_head fidelity-finishes)" "$settings" "$scenes" "$floors" \
    >"$work/finishes.md"
if [ -n "${BENCH_DOCS:-}" ]; then
    cp "$work/finishes.md" "$work/finishes.csv" docs/
    cp "$work"/finishes-*.jpg docs/pictures/
fi
