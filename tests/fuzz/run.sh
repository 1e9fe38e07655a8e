#!/bin/sh
# Runs fuzz drivers, one after the other: run.sh SECONDS [SEED [NAME…]] (of fuzz_NAME.c; all by default). $BUILD holds
# the sanitized programs; what is found goes into $KEEP. Exit 1 when something was found. FUZZ_LIST is a file with names of
# more scenes to mutate, as they are below FUZZ_FOLDER; by default POV-Ray's samples.
set -u
seconds=$1 seed=${2-} here=$(pwd)
shift; [ $# = 0 ] || shift
[ -n "$seed" ] || seed=$(date +%s)
[ $# != 0 ] || set -- edit request ini manifest pack set scene gltf import
case $BUILD in /*) ;; *) BUILD=$here/$BUILD ;; esac
case $KEEP in /*) ;; *) KEEP=$here/$KEEP ;; esac
mkdir -p "$KEEP"
KEEP=$(cd "$KEEP" && pwd)

# What scenes read: includes and a light distribution as they are, and in the place of every texture a picture of a few
# pixels.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/textures"
for include in scenes/*/*.inc; do cp "$include" "$work"; done # of two that have one name the last
for texture in scenes/*/textures/*.jpg; do
    "$BUILD/tests/bin/make_picture" "$work/textures/${texture##*/}" size=6x5 || exit 2
done
cp tests/data/lamp.ies "$work"
scenes=
for scene in tests/fuzz/seeds/*.pov tests/scenes/*.pov scenes/*/*.pov; do scenes="$scenes $here/$scene"; done

# Samples, and what lies beside them; of two files that have one name the last.
list=${FUZZ_LIST:-../shared/pov/known-scenes.txt} folder=${FUZZ_FOLDER:-/usr/share/doc/povray/examples}
if [ -r "$list" ] && [ -d "$folder" ]; then
    sed 's|[^/]*$||' "$list" | sort -u | while read -r place; do
        find "$folder/$place" -maxdepth 1 -type f ! -name '*.pov' ! -name '*.ini' -size -200k -exec cp {} "$work" \;
    done
    while read -r scene; do
        [ ! -r "$folder/$scene" ] || scenes="$scenes $folder/$scene"
    done <"$list"
fi

cd "$work" || exit 2
status=0
for name; do
    arguments="--seconds $seconds --seed $seed --keep $KEEP"
    [ "$name" != scene ] || arguments="$arguments --words $here/renderer/sdl/lang/words.c
        --words $here/renderer/sdl/lang/function_builtin.c $scenes"
    # shellcheck disable=SC2086 # words wanted
    nice "$BUILD/tests/fuzz/fuzz_$name" $arguments || status=1
done
exit $status
