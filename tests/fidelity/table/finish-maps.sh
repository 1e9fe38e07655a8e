#!/bin/sh
# Maps of finishes, chosen after rendering, against scenes rendered with them: noise, expected error and pictures.
#
#   make fidelity-maps  ten minutes on two cores, into $BUILD/fidelity-maps; with BENCH_DOCS=1 the page and its pictures
#                       go to docs/ and docs/pictures/ too
#
# Two floors: varnished planks with matt joints, and stone with an inlay of brass. Each is laid over one set of a scene,
# and rendered with the same finishes and the same seed by --replace. Two converged pictures of it, with noise of their
# own, are the truth. finish-maps.py makes the textures and computes the figures. What is there from an earlier run is
# not made again.
#
# MAPS_SPP, MAPS_TRUTH_SPP, MAPS_HEIGHT, MAPS_PICTURE_HEIGHT and MAPS_PICTURE_SPP choose less, or more.
set -eu
. tests/fidelity/table/lib.sh
work=$build/fidelity-maps
spp=${MAPS_SPP:-128} truth_spp=${MAPS_TRUTH_SPP:-2048} height=${MAPS_HEIGHT:-96}
picture_height=${MAPS_PICTURE_HEIGHT:-270} picture_spp=${MAPS_PICTURE_SPP:-256}
scenes='living-room kitchen' floors='planks inlay'
figures_python fidelity-maps
mkdir -p "$work"
settings="$spp $truth_spp $height $picture_height"
figures_settings fidelity-maps "$work" "$settings"

finishes() { case $1 in planks) echo matt,polished ;; *) echo polished,metal ;; esac } # FLOOR

[ -e "$work/inlay-map.png" ] || "$python" "$here/table/finish-maps.py" --textures "$work"

for scene in $scenes; do
    for floor in $floors; do
        name=$work/$scene-$floor
        room() {
            retex-render -q --threads 1 --finish Floor="$(finishes "$floor")" -t Floor "scenes/$scene/$scene.pov" "$@"
        }
        small() { room --size "$(wide "$scene" "$height")" "$@"; }
        laid() { room --replace:finish="$work/$floor-map.png" Floor="$work/$floor.png" "$@"; }
        echo "fidelity-maps: $scene, $floor" >&2
        made "$name.exr" small --spp "$spp" --seed 1
        made "$name-set.exr" retex-combine -q "$name.exr" --texture:finish="$work/$floor-map.png" \
            Floor="$work/$floor.png" --error "$name-error.exr"
        made "$name-own.exr" laid --size "$(wide "$scene" "$height")" --spp "$spp" --seed 1
        truth "maps-$scene-$floor" "$(wide "$scene" "$height")" "$truth_spp" laid
        made "$name-mask-1.exr" small --replace Floor=white --spp 1 --aov albedo
        made "$name-mask-2.exr" small --replace Floor=black --spp 1 --aov albedo
    done
done

for floor in $floors; do
    room() {
        retex-render -q --size "$(wide living-room "$picture_height")" --finish Floor="$(finishes "$floor")" \
            -t Floor scenes/living-room/living-room.pov "$@"
    }
    made "$work/picture-$floor.exr" room --spp 64 --denoise
    made "$work/picture-$floor-ours.exr" retex-combine -q "$work/picture-$floor.exr" \
        --texture:finish="$work/$floor-map.png" Floor="$work/$floor.png"
    made "$work/picture-$floor-new.exr" room --spp "$picture_spp" --replace:finish="$work/$floor-map.png" Floor="$work/$floor.png"
done

"$python" "$here/table/finish-maps.py" "$work" "$(figures_head fidelity-maps)" "$settings" "$scenes" "$floors" \
    >"$work/finish-maps.md"
if [ -n "${BENCH_DOCS:-}" ]; then
    cp "$work/finish-maps.md" docs/
    cp "$work"/finish-maps-*.jpg docs/pictures/
fi
