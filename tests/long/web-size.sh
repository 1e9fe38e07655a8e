#!/bin/sh
# What browsers load of a room of 1600x900 pixels with two targets, and how much of it until the first target can be
# changed. Fewer samples leave more noise, which takes more bytes: 4 a pixel take a quarter more than 16. cli/web has the
# player's own size.
set -u
. tests/lib/tap.sh
retex-render -q --size 1600x900 --spp 16 --denoise -t Floor -t Wall "$scenes/living-room/living-room.pov" -o "$work/room.exr"
retex-pack "$work/room.exr" --web "$work/room" 2>"$work/said"
sed 's/^/# /' "$work/said"
player=$(cat "$work/room/retex-room.js" "$work/room/index.html" | wc -c)
result "$(at_most "$(awk 'NR == 2 { print $10 }' "$work/said") + $player" 2.6e6)" "until the first target can be changed: 2.6 MB"
result "$(at_most "$(awk 'NR == 2 { print $4 }' "$work/said") + $player" 5e6)" "in all: 5 MB"
finish
