#!/bin/sh
# Runs fuzz drivers, one after the other: run.sh SECONDS [SEED [NAME…]] (of fuzz_NAME.c, or player; all by default).
# $BUILD holds the sanitized programs; what is found goes into $KEEP. Exit 1 when something was found. FUZZ_LIST is a
# file with names of more scenes to mutate, as they are below FUZZ_FOLDER; by default POV-Ray's samples.
set -u
seconds=$1 seed=${2-}
shift; [ $# = 0 ] || shift
[ -n "$seed" ] || seed=$(date +%s)
[ $# != 0 ] || set -- edit request ini manifest pack set scene gltf import upload player
. tests/fuzz/inputs.sh
begin
keep

cd "$work" || exit 2
status=0
for name; do
    if [ "$name" = player ]; then
        make_room "$work/room"
        (cd "$here" && nice node tests/fuzz/player.mjs "$seconds" "$seed" "$work/room" "$KEEP") || status=1
        continue
    fi
    # shellcheck disable=SC2046 # words wanted
    nice "$BUILD/tests/fuzz/fuzz_$name" --seconds "$seconds" --seed "$seed" --keep "$KEEP" $(seeds_of "$name") || status=1
done
exit $status
