# Sourced by scripts that run fuzz drivers, in the repository's root, $here: folders, and what the drivers read
# beside their inputs.
here=$(pwd)

# begin: $BUILD as a path from the root, and $work, a folder with the inputs that goes at the end.
begin() {
    case $BUILD in /*) ;; *) BUILD=$here/$BUILD ;; esac
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    make_inputs "$work"
}

# keep: $KEEP, the folder for what is found, as a path from the root.
keep() {
    mkdir -p "$KEEP"
    KEEP=$(cd "$KEEP" && pwd)
}

# make_inputs FOLDER: includes and a light distribution as they are, and in the place of every texture a picture of a few
# pixels; samples of FUZZ_LIST, and what lies beside them; of two files that have one name the last.
make_inputs() {
    mkdir "$1/textures"
    for include in scenes/*/*.inc; do cp "$include" "$1"; done
    for texture in scenes/*/textures/*.jpg; do
        "$BUILD/tests/bin/make_picture" "$1/textures/${texture##*/}" size=6x5 || exit 2
    done
    cp tests/data/lamp.ies "$1"
    scenes=
    for scene in tests/fuzz/seeds/*.pov tests/scenes/*.pov scenes/*/*.pov; do scenes="$scenes $here/$scene"; done
    list=${FUZZ_LIST:-../shared/pov/known-scenes.txt} folder=${FUZZ_FOLDER:-/usr/share/doc/povray/examples}
    [ -r "$list" ] && [ -d "$folder" ] || return 0
    sed 's|[^/]*$||' "$list" | sort -u | while read -r place; do
        find "$folder/$place" -maxdepth 1 -type f ! -name '*.pov' ! -name '*.ini' -size -200k -exec cp {} "$1" \;
    done
    while read -r scene; do
        [ ! -r "$folder/$scene" ] || scenes="$scenes $folder/$scene"
    done <"$list"
}

# seeds_of NAME: the words and seeds of a driver that it does not have itself.
seeds_of() {
    [ "$1" != scene ] || echo "--words $here/renderer/sdl/lang/words.c \
        --words $here/renderer/sdl/lang/function_builtin.c $scenes"
}

# make_room FOLDER: a room with two targets and its lamps, as the player reads it.
make_room() {
    PATH=$BUILD/bin:$PATH
    retex-render -q --size 48x27 --spp 4 --lamps each -t Floor -t Wall "$here/scenes/living-room/living-room.pov" \
        -o room.exr && retex-pack -q room.exr --web "$1"
}
