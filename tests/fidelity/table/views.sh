#!/bin/sh
# How well retex-import judges views: of models with cameras of their own, which people chose, the share of all other
# views that it takes for better. Prints model, camera and percentile, and the median of the first cameras.
# Usage: views.sh FOLDER...   folders with a .glb or .gltf file each
import=${BUILD:-build}/bin/retex-import
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
for folder; do
    for model in "$folder"/*.glb "$folder"/*.gltf; do
        camera=0
        while [ -f "$model" ] && [ $((camera += 1)) -le 9 ]; do
            told=$("$import" -f -v --partial --camera $camera "$model" -o "$work/x" 2>&1) || break
            echo "$told" | awk -v of="$(basename "$folder")" -v n=$camera '/other views show more than/ {
                printf "%s\t%s\t%.1f %%\t%d\n", of, $NF, 100 * $2 / $4, n }'
        done
    done
done | tee "$work/table"
awk -F '\t' '$4 == 1 { print $3 + 0 }' "$work/table" | sort -n |
    awk '{ v[NR] = $1 } END { if (NR) printf "median of %d first cameras: %.1f %%\n", NR, (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'
