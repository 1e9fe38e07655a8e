#!/bin/sh
# A colour that --solve is to give a region: no combination of a numpy grid of colours and lamps comes nearer by more than
# half a CIEDE2000, in a grey room, one with lamps, and a closed box, for colours that can be had and that cannot.
# SOLVE_RANDOM='SEED COUNT' takes problems at random.
set -u
. tests/lib/tap.sh
room() { retex-render -q --size 48x36 --spp 32 "$@"; }
room -t Floor -t Back -t Ball -t Ceiling -t Right tests/golden/room.pov -o "$work/grey.exr"
room -t Floor -t Back -t Ball -D Lamps=1 --lamps each tests/golden/room.pov -o "$work/lamps.exr"
room -t Floor -t Rest --lamps each tests/cli/closed_box.pov -o "$work/box.exr"
# shellcheck disable=SC2086 # two words
/usr/bin/python3 -B tests/fidelity/solve.py "$work" ${SOLVE_RANDOM:-}
