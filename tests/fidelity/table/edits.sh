#!/bin/sh
# Adjusted, laid and layered textures, against the same made beforehand by numpy, and against rendering them.
#
#   make fidelity-edits    ten minutes on two cores, into $BUILD/fidelity-edits; with BENCH_DOCS=1 the page and its
#                          pictures go to docs/ and docs/pictures/ too
#
# A floor of even light is seen from above and at a grazing angle. Each edit is laid over one set of each, and so is the
# picture that numpy made of it, as a plain texture. At the grazing angle --replace renders some of them: with the same
# seed, and with many samples, which is the truth. edits.py has numpy's side and computes the figures. What is there from
# an earlier run is not made again.
#
# EDITS_SPP, EDITS_TRUTH_SPP, EDITS_HEIGHT and EDITS_PICTURE_HEIGHT choose less, or more.
set -eu
. tests/fidelity/table/lib.sh
work=$build/fidelity-edits
spp=${EDITS_SPP:-64} truth_spp=${EDITS_TRUTH_SPP:-1024} height=${EDITS_HEIGHT:-240}
picture_height=${EDITS_PICTURE_HEIGHT:-270}
figures_python fidelity-edits
mkdir -p "$work"
settings="$spp $truth_spp $height $picture_height"
figures_settings fidelity-edits "$work" "$settings"
edits() { "$python" "$here/table/edits.py" "$@"; }

[ -e "$work/cases.txt" ] || edits --textures "$work"

views='above grazing'
for view in $views; do
    room() {
        retex-render -q --size "$((height * 16 / 9))x$height" -t Floor --declare "View=$view" "$here/scenes/floor.pov" \
            "$@"
    }
    made "$work/$view.exr" room --spp "$spp" --full-precision
    while read -r name plain options; do
        echo "fidelity-edits: $view, $name" >&2
        # shellcheck disable=SC2086 # words wanted
        made "$work/$view-$name-set.exr" retex-combine -q "$work/$view.exr" $options
        made "$work/$view-$name-made.exr" retex-combine -q "$work/$view.exr" --texture:"$plain" "Floor=$work/$name.exr"
        case $view-$name in grazing-plain | grazing-grout | grazing-brick | grazing-herringbone | grazing-logo) ;; *) continue ;; esac
        replaced=$(echo "$options" | sed 's/--texture/--replace/g')
        # shellcheck disable=SC2086 # words wanted
        made "$work/$view-$name-own.exr" room --spp "$spp" --plain $replaced
        # shellcheck disable=SC2086 # words wanted
        made "$work/$view-$name-truth.exr" room --spp "$truth_spp" --seed 1 --plain $replaced
    done <"$work/cases.txt"
done

# The pictures: one set, several edits.
made "$work/room.exr" retex-render -q --size "$(wide living-room "$picture_height")" --spp 64 --denoise -t Floor -t Wall \
    scenes/living-room/living-room.pov
edits --pictures "$work" | while read -r name options; do
    # shellcheck disable=SC2086 # words wanted
    made "$work/edits-$name.jpg" retex-combine -q "$work/room.exr" $options
done

edits "$work" "$(figures_head fidelity-edits)" "$settings" >"$work/edits.md"
if [ -n "${BENCH_DOCS:-}" ]; then
    cp "$work/edits.md" docs/
    cp "$work"/edits-*.jpg docs/pictures/
fi
