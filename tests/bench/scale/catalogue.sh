#!/bin/sh
# The cost of a catalogue beside its pictures: catalogue.sh [ROWS [VIEWS]]. Pictures are tiny (64x48), so that planning,
# recording, resuming and verifying are what is measured. Prints wall and processor seconds and the peak memory of the
# largest process, of one run for each view.
set -eu
rows=${1:-6000} views=${2:-4}
build=${BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
PATH=$build/bin:$build/tests/bin:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r scenes/textures "$work/textures"
cd "$work"
for view in $(seq "$views"); do
    make_set "view$view.exr" 64 48 "$view"
    /usr/bin/python3 -c "images = 'brick', 'fans', 'damask', 'walnut-herringbone'
print('output,floor,wall')
for k in range($rows):
    print(f'view$view/{k // 100}/{k}.jpg,textures/{images[k * 4 // $rows]}.jpg,\"rgb(0.{k % 10},0.5,{k / $rows})\"')" >"view$view.csv"
done
measure() { # NAME OPTION...
    name=$1
    shift
    for view in $(seq "$views"); do
        /usr/bin/time -f '%e %U %S %M' -a -o "$name" retex-combine "view$view.exr" --batch "view$view.csv" \
            --manifest manifest --mkdir --threads 1 "$@" >/dev/null 2>>log
    done
    awk -v name="$name" '{ wall += $1; cpu += $2 + $3; if ($4 > peak) peak = $4 }
        END { printf "%s: %.1f s, processor %.1f s, %.0f MB\n", name, wall, cpu, peak / 1024 }' "$name"
}
measure plan --plan
measure make -q
measure resume --resume
measure verify --verify
echo "$((rows * views)) pictures, manifest of $(wc -c <manifest) bytes"
