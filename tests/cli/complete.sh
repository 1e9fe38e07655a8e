#!/bin/sh
# The lines that cli/complete.t completes in each shell: complete.sh SHELL FOLDER.
exec "$TESTS/complete.py" "$1" "$2" \
    'retex-combine ' \
    'retex-combine my' \
    'retex-combine "my ro' \
    'retex-combine ~/ro' \
    'retex-combine room.exr --texture ' \
    'retex-combine room.exr --texture Fl' \
    'retex-combine my\ room.exr --texture W' \
    'retex-combine "my room.exr" --texture W' \
    'retex-combine room.exr --texture Floor=oa' \
    'retex-combine room.exr --texture=Floor=fo' \
    'retex-combine room.exr --texture:scale=2:wr' \
    'retex-combine room.exr --texture:wrap=mir' \
    'retex-combine room.exr --cros' \
    'retex-combine room.exr --cross ' \
    'retex-combine room.exr --batch ' \
    'retex-combine room.exr --batch-root=' \
    'retex-info --' \
    'retex-render box' \
    'retex-render --layout p' \
    'retex-render --layout=p' \
    'retex-render --aov depth,met' \
    'retex-render box.pov -t ' \
    'retex comb' \
    'retex help com' \
    'retex combine room.exr --texture ' \
    'retex-combine named.exr --texture A'
