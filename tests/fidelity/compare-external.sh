#!/bin/sh
# make compare-external on made-up pictures: the better one scores better, what cannot be compared is said.
set -u
. tests/lib/tap.sh
mkdir -p "$work/theirs" "$work/fidelity/truth" "$work/fidelity/retextured"
compare() {
    FIDELITY=$work/fidelity OUT=$work/out sh tests/external/compare.sh "$work/theirs" >"$work/said" 2>"$work/errors"
}
is() { [ "$1" = "$2" ] && echo 1; }
if ! command -v oiiotool >/dev/null; then
    skip "pictures of other methods" "oiiotool is not on this machine"
    finish
    exit
fi

compare
result "$(is "$?" 2)" "without truths it stops"
result "$(grep -c 'make fidelity' "$work/errors")" "and says what makes them"

make_picture "$work/fidelity/truth/room-oak.exr" size=32x24
make_picture "$work/fidelity/truth/room-brick.exr" size=32x24 seed=5
make_picture "$work/fidelity/retextured/room-oak-1024-footprints.exr" size=32x24 noise=0.001
compare
result "$(is "$?" 2)" "without pictures too"

make_picture "$work/theirs/room-oak.png" size=32x24 noise=0.05
make_picture "$work/theirs/room-brick.exr" size=32x24 seed=5 noise=0.1
make_picture "$work/theirs/room-unknown.png" size=32x24
compare
result "$(is "$?" 0)" "with both it scores"
sed 's/^/# /' "$work/said"
result "$(grep -c 'room-unknown' "$work/errors")" "a picture without a truth is named"
scored() { awk -F, "\$1 == \"$1\" { print ($2) }" "$work/out/scores.csv"; }
result "$(scored room-oak '$2 > 20 && $2 < 45 && $5 > $2 + 10 && $6 < $3')" "ours is nearer, and said to be"
result "$(scored room-brick '$2 > 10 && $5 == ""')" "a picture that we have none of is scored too"
result "$(is "$(oiiotool --info "$work/out/room-oak.png" | awk '{ print $3 "x" $5 }' | tr -d ,)" 104x52)" \
    "the sheet has three columns and two rows"

make_picture "$work/theirs/room-brick.exr" size=16x24
compare
result "$(grep -c 'room-brick.exr: cannot be compared' "$work/errors")" "another size is said"
finish
