#!/bin/sh
# What must hold of any scene, in two hundred random scenes: more than two thousand checks. PROPERTIES_SCENES='201 900'
# takes others, PROPERTIES='mirrored scaled' some properties; so a run that was stopped goes on.
set -u
. tests/lib/tap.sh
need_pictures "properties of random scenes"
# shellcheck disable=SC2086 # words wanted
nice /usr/bin/python3 -B tests/fidelity/properties.py ${PROPERTIES_SCENES:-1 200}
