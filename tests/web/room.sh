# Sourced by tests of the player, in the repository's root: what tap.sh has, and rooms. Sets $work.
. tests/lib/tap.sh

# needs_browser NAME: without Chromium, test NAME is skipped, and the script ends.
needs_browser() {
    tools/setup.sh web >&2 2>&1 && return
    skip "$1" "chromium or python3-websocket is not installed"
    finish
    exit
}
# living_room SIZE SPP: $work/room.exr with the targets Floor and Wall, its folder $work/room, and $work/textures.
living_room() {
    retex-render -q --size "$1" --spp "$2" --denoise -t Floor -t Wall "$scenes/living-room/living-room.pov" \
        -o "$work/room.exr"
    retex-pack -q "$work/room.exr" --web "$work/room"
    cp -r "$scenes/textures" "$work/textures"
}
# small_room NAME SIZE OPTION…: $work/NAME, a folder of the scene in standard input, with little light.
small_room() {
    name=$1 size=$2
    shift 2
    cat >"$work/$name.pov"
    retex-render -q --size "$size" --spp 4 "$@" "$work/$name.pov" -o "$work/$name.exr"
    retex-pack -q "$work/$name.exr" --web "$work/$name"
}
