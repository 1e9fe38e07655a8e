#!/bin/sh
# docs/read_set.py, which reads sets by retex-set(5) alone, makes the pictures of retex-combine: sets of every kind with
# constant colours to 100 dB, textures nearly. READ_SET='lamps packed' takes the kinds whose name has one of these words.
set -u
. tests/lib/tap.sh
need_pictures "pictures of docs/read_set.py are those of retex-combine"
cd "$work" || exit 1
exec /usr/bin/python3 -B "$here/tests/docs/read_set.py" "$here"
