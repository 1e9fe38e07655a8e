#!/bin/sh
# What must hold of any scene, in five random scenes: those of fifty whose turn it is on the day of the last commit.
# long/properties has all of them and more; properties.py says what is checked.
set -u
. tests/lib/tap.sh
need_pictures "properties of random scenes"
day=$(($(git show -s --format=%ct HEAD 2>/dev/null || echo 0) / 86400 % 10))
/usr/bin/python3 -B tests/fidelity/properties.py 1 50 $day
