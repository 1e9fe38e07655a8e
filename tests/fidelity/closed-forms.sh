#!/bin/sh
# Renders the scenes of tests/scenes and compares pixels with their closed forms, written in each scene's comments.
set -u
. tests/lib/tap.sh

check_scene() {
    name=$(basename "$1" .pov)
    settings=$(sed -n 's|^// size \([0-9]*x[0-9]*\) *spp \([0-9]*\) *tolerance \([^ ]*\) \([a-z]*\).*|\1 \2 \3 \4|p' "$1" | head -n 1)
    set -- "$1" $settings
    number=$((number + 1))
    if [ $# != 5 ]; then
        echo "not ok $number - $name: no line of size, spp and tolerance"
        return
    fi
    : >"$work/compared"
    grep '^// expect ' "$1" | while read -r _ _ pixel wanted; do
        retex-render -q --threads 1 --size "$2" --spp "$3" --crop "$pixel,1,1" "$1" -o "$work/pixel.exr" 2>>"$work/errors" || continue
        echo "$pixel $(make_values "$work/pixel.exr" 0,0) $wanted" >>"$work/compared"
    done
    lines=$(grep -c '^// expect ' "$1")
    awk -v tolerance="$4" -v mode="$5" -v lines="$lines" -v name="$name" -v number="$number" '
        { for (c = 0; c < 3; c++) {
            got = $(2 + c); wanted = $(5 + c); off = got - wanted; if (off < 0) off = -off
            bound = mode == "relative" ? tolerance * (wanted > 1e-3 ? wanted : 1e-3) : tolerance
            if (!(off <= bound)) { bad = 1; told = told "# " $1 ": " $2 " " $3 " " $4 ", should be " $5 " " $6 " " $7 "\n"; break } } }
        END { if (NR != lines || lines == 0) { bad = 1; told = told "# " NR " of " lines " pixels rendered\n" }
              printf "%s %d - %s\n%s", bad ? "not ok" : "ok", number, name, told }' "$work/compared"
}

for scene in tests/scenes/*.pov; do
    [ -z "${1-}" ] || [ "$(basename "$scene" .pov)" = "$1" ] || continue
    check_scene "$scene"
done
[ ! -s "$work/errors" ] || sort -u "$work/errors" | sed 's/^/# /'
finish
