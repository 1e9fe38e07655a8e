#!/bin/sh
# Lamps and textures changed after rendering, against the scenes rendered so: pictures, noise, sizes and times.
#
#   make fidelity-lamps     an hour on two cores, into $BUILD/fidelity-lamps; with BENCH_DOCS=1 the page, its figures and
#                           its pictures go to docs/ and docs/pictures/ too
#
# lamps.txt has the edits. Each is made from one set a scene, as rendered and denoised, and rendered again with as many
# samples. Then the living room with four, eight
# and sixteen lamps, kept apart and not. lamps.py computes the figures. What is there from an earlier run is not made
# again.
#
# LAMPS_SPP, LAMPS_TRUTH_SPP, LAMPS_HEIGHT, LAMPS_PICTURE_HEIGHT, LAMPS_PICTURE_SPP, LAMPS_SIZE, LAMPS_SIZE_SPP and
# LAMPS_COUNTS choose less, or more.
set -eu
. tests/fidelity/table/lib.sh
work=$build/fidelity-lamps
spp=${LAMPS_SPP:-128} truth_spp=${LAMPS_TRUTH_SPP:-2048} height=${LAMPS_HEIGHT:-96}
picture_height=${LAMPS_PICTURE_HEIGHT:-270} picture_spp=${LAMPS_PICTURE_SPP:-512}
size=${LAMPS_SIZE:-960x540} size_spp=${LAMPS_SIZE_SPP:-64} counts=${LAMPS_COUNTS:-4 8 16}
figures_python fidelity-lamps
mkdir -p "$work"

settings="$spp $truth_spp $height $picture_height $picture_spp $size $size_spp"
figures_settings fidelity-lamps "$work" "$settings"

targets() {
    case $1 in glass-caustics) echo '-t Floor' ;; *) echo '-t Floor -t Wall' ;; esac
}
# The statements of an edit as options: options OPTION STATEMENT...
options() {
    option=$1
    shift
    for statement; do printf ' %s %s' "$option" "$statement"; done
}

# Lamps are options already, textures are statements: both for retex-render and for retex-combine.
edit() { # WORK-NAME SCENE LAMPS TEXTURES
    name=$work/$1 scene=$2 file=scenes/$2/$2.pov size_of=$(wide "$2" "$height")
    # shellcheck disable=SC2046,SC2086 # words wanted
    {
        again="retex-render -q --plain $3 $(options --replace $4) $file"
        made "$name-again.exr" $again --size "$size_of" --spp "$spp" --seed 1
        truth "lamps-$1" "$size_of" "$truth_spp" $again
        for set in set denoised; do
            made "$name-$set.exr" retex-combine -q "$work/$scene-$set.exr" $3 $(options --texture $4)
        done
    }
}

while IFS='|' read -r scene name lamps textures; do
    case $scene in '#'*) continue ;; esac
    scene=$(echo "$scene" | tr -d ' ') name=$(echo "$name" | tr -d ' ')
    echo "fidelity-lamps: $scene $name" >&2
    # shellcheck disable=SC2046
    made "$work/$scene-set.exr" retex-render -q --size "$(wide "$scene" "$height")" $(targets "$scene") --lamps each \
        --spp "$spp" "scenes/$scene/$scene.pov"
    made "$work/$scene-denoised.exr" retex-denoise -q "$work/$scene-set.exr"
    edit "$scene-$name" "$scene" "$lamps" "$textures"
done <$here/table/lamps.txt

# ---- pictures of the living room, beside converged ones ----

# shellcheck disable=SC2046
made "$work/room.exr" retex-render -q --size "$(wide living-room "$picture_height")" -t Floor -t Wall --lamps each \
    --spp 64 --denoise scenes/living-room/living-room.pov
while IFS='|' read -r scene name lamps textures; do
    [ "$(echo "$scene" | tr -d ' ')" = living-room ] || continue
    name=$work/picture-$(echo "$name" | tr -d ' ')
    # shellcheck disable=SC2046,SC2086
    {
        made "$name-ours.exr" retex-combine -q "$work/room.exr" $lamps $(options --texture $textures)
        made "$name-new.exr" retex-render -q --size "$(wide living-room "$picture_height")" --plain $lamps \
            $(options --replace $textures) --spp "$picture_spp" --seed 1 scenes/living-room/living-room.pov
    }
done <$here/table/lamps.txt

# ---- a slider for the time of day ----

hours='14 15 16 17 18'
made "$work/suns.exr" retex-render -q --size "$(wide suns $((picture_height * 2 / 3)))" -t Floor --lamps each --spp 512 \
    --denoise docs/suns.pov
for hour in $hours; do
    made "$work/suns-$hour.exr" retex-combine -q "$work/suns.exr" --solo "Sun_$hour" --light "Sun_$hour=2" --light sky=20
done

# ---- bytes, times and memory ----

costs() { # NAME LAMPS OPTION...
    name=$work/$1 more=$(($2 - 3))
    shift 2
    [ ! -e "$name.pack-time" ] || return 0
    timed "$name.render-time" retex-render -q -I scenes/living-room -D Lamps=$more --size "$size" --spp "$size_spp" \
        -t Floor -t Wall "$@" $here/scenes/lamps-living-room.pov -o "$name.exr"
    timed "$name.denoise-time" retex-denoise -q "$name.exr" -o "$name-denoised.exr"
    for from in "$name-denoised.exr" "$name.retex"; do
        [ "$from" != "$name.retex" ] || timed "$name.pack-time" retex-pack -q "$name-denoised.exr" -o "$name.retex"
        timed "$from.combine-time" retex-combine -q "$from" --threads 1 \
            --texture Floor=scenes/textures/walnut-herringbone.jpg -o "$work/picture.exr"
        [ $# = 0 ] || timed "$from.light-time" retex-combine -q "$from" --threads 1 --light Lamp=3 --light Daylight=0.5 \
            --texture Floor=scenes/textures/walnut-herringbone.jpg -o "$work/picture.exr"
    done
    wc -c <"$name.exr" >"$name.exr-bytes"
    wc -c <"$name-denoised.exr" >"$name.denoised-bytes"
    wc -c <"$name.retex" >"$name.pack-bytes"
    rm "$name.exr" "$name-denoised.exr"
}
for count in $counts; do
    echo "fidelity-lamps: $count lamps" >&2
    costs "together-$count" "$count"
    costs "apart-$count" "$count" --lamps each
done

"$python" "$here/table/lamps.py" "$work" "$(figures_head fidelity-lamps)" "$settings" "$counts" "$hours" >"$work/lamps.md"
if [ -n "${BENCH_DOCS:-}" ]; then
    cp "$work/lamps.md" "$work/lamps.csv" docs/
    cp "$work"/lamps-*.jpg docs/pictures/
fi
