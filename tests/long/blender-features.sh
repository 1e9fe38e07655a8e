#!/bin/sh
# Scenes of one feature each, exported by the add-on for Blender: their regions are those of Cycles' picture, or it is told
# what is left out. docs/blender-features.md has the table.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null; then
    skip "features of Blender" "Blender is not installed"
    finish
    exit
fi
in_blender() { blender -b --factory-startup -noaudio "$@"; }
maker=tests/long/blender-features.py addon=tools/blender/retex_export.py samples=64
names=$(in_blender --python $maker -- "$work" 2>/dev/null | sed -n 's/^feature //p')
# shellcheck disable=SC2086 # words
in_blender --python $maker -- "$work" $samples $names >"$work/build.log" 2>&1
result "$(echo "$names" | wc -l | awk '{ print ($1 >= 20) }')" "there are scenes of at least 20 features"

# compare CYCLES RETEX: the median and the largest difference of 8 x 6 regions, and the share within 5 %.
compare() {
    /usr/bin/python3 - "$@" <<'END'
import sys
import numpy as np
import OpenImageIO as oiio
theirs, ours = (oiio.ImageBuf(path).get_pixels(oiio.FLOAT)[:, :, :3].astype(float) for path in sys.argv[1:])
means = [(theirs[y:y + 20, x:x + 20].mean(), ours[y:y + 20, x:x + 20].mean()) for y in range(0, 120, 20)
         for x in range(0, 160, 20)]
apart = np.array([abs(b / a - 1) for a, b in means if a > .02])
print(f"{100 * np.median(apart):.1f} {100 * apart.max():.1f} {100 * np.mean(apart < .05):.0f}")
END
}

for name in $names; do
    in_blender "$work/$name.blend" --python $addon -- -o "$work/$name" >"$work/$name.log" 2>&1
    retex-render -q --plain --spp $samples --size 160x120 "$work/$name/$name.pov" -o "$work/$name-retex.exr"
    told=$(sed -n 's/^warning: //p' "$work/$name.log" | paste -sd ';')
    # shellcheck disable=SC2046 # words
    set -- $(compare "$work/$name.exr" "$work/$name-retex.exr")
    echo "# | $(echo "$name" | tr _ ' ') | ${1:-none} % | ${2:-none} % | ${3:-0} % | $told |"
    good=$([ "${3:-0}" -eq 100 ] || [ -n "$told" ] && echo 1)
    [ -n "$good" ] || sed 's/^/# /' "$work/$name.log"
    result "${good:-0}" "$name: all regions within 5 % of Cycles, or told"
done
finish
