#!/bin/sh
# Normal maps, chosen after rendering, against scenes rendered with them: noise, expected error and pictures.
#
#   make fidelity-normals  ten minutes on two cores, into $BUILD/fidelity-normals; with BENCH_DOCS=1 the page and its
#                          pictures go to docs/ and docs/pictures/ too
#
# Three surfaces of the living room: its wall, which is matt, and its floor with two of the built-in finishes. Two maps
# are laid over one set of each: bevelled tiles, whose normals are tilted by 10 degrees, and waves of up to 30. The same
# is rendered by --replace with the same seed. Two converged pictures of it, with noise of their own, are the truth.
# normal-maps.py makes the textures and computes the figures. What is there from an earlier run is not made again.
#
# NORMALS_SPP, NORMALS_TRUTH_SPP, NORMALS_HEIGHT, NORMALS_PICTURE_HEIGHT and NORMALS_PICTURE_SPP choose less, or more.
set -eu
. tests/fidelity/table/lib.sh
work=$build/fidelity-normals
spp=${NORMALS_SPP:-128} truth_spp=${NORMALS_TRUTH_SPP:-2048} height=${NORMALS_HEIGHT:-96}
picture_height=${NORMALS_PICTURE_HEIGHT:-270} picture_spp=${NORMALS_PICTURE_SPP:-256}
scene=scenes/living-room/living-room.pov surfaces='Wall=original Floor=matt Floor=polished' maps='tiles waves'
figures_python fidelity-normals
mkdir -p "$work"
settings="$spp $truth_spp $height $picture_height"
figures_settings fidelity-normals "$work" "$settings"

[ -e "$work/waves-map.png" ] || "$python" "$here/table/normal-maps.py" --textures "$work"

for surface in $surfaces; do
    target=${surface%=*} finish=${surface#*=} name=$work/$surface
    room() {
        retex-render -q --threads 1 --finish "$surface,normals" -t "$target" "$scene" "$@"
    }
    small() { room --size "$(wide living-room "$height")" "$@"; }
    made "$name.exr" small --spp "$spp" --seed 1
    made "$name-flat.exr" retex-combine -q "$name.exr" --texture "$target=$work/tiles.png"
    made "$name-mask-1.exr" small --replace "$target=white" --spp 1 --aov albedo
    made "$name-mask-2.exr" small --replace "$target=black" --spp 1 --aov albedo
    for map in $maps; do
        laid() { room --replace:normal="$work/$map-map.png" "$target=$work/tiles.png" "$@"; }
        echo "fidelity-normals: $target, $finish, $map" >&2
        made "$name-$map-set.exr" retex-combine -q "$name.exr" --texture:normal="$work/$map-map.png" \
            "$target=$work/tiles.png" --error "$name-$map-error.exr"
        made "$name-$map-own.exr" laid --size "$(wide living-room "$height")" --spp "$spp" --seed 1
        truth "normals-$target-$finish-$map" "$(wide living-room "$height")" "$truth_spp" laid
    done
done

room() {
    retex-render -q --size "$(wide living-room "$picture_height")" --finish Wall=normals -t Wall "$scene" "$@"
}
made "$work/picture.exr" room --spp 64 --denoise
for map in $maps; do
    made "$work/picture-$map-ours.exr" retex-combine -q "$work/picture.exr" --texture:normal="$work/$map-map.png" \
        Wall="$work/tiles.png"
    made "$work/picture-$map-new.exr" room --spp "$picture_spp" --replace:normal="$work/$map-map.png" Wall="$work/tiles.png"
done

"$python" "$here/table/normal-maps.py" "$work" "$(figures_head fidelity-normals)" "$settings" "$surfaces" "$maps" \
    >"$work/normal-maps.md"
if [ -n "${BENCH_DOCS:-}" ]; then
    cp "$work/normal-maps.md" docs/
    cp "$work"/normal-maps-*.jpg docs/pictures/
fi
