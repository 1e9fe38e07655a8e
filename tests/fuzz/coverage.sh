#!/bin/sh
# What the corpora of corpus/ reach of each parser: coverage.sh [NAME…]. $BUILD holds programs that are linked with
# libFuzzer. Prints a line of Markdown for each: branches of the compiled code, those of the sanitizers' checks among
# them, and the share of them that was run.
set -u
[ $# != 0 ] || set -- edit request ini manifest pack set scene gltf upload
. tests/fuzz/inputs.sh
begin
for name; do
    corpus=tests/fuzz/corpus/$name.tar.xz
    [ -e "$corpus" ] || continue
    mkdir "$work/corpus-$name"
    tar -C "$work/corpus-$name" -xJf "$corpus" || exit 2
    (cd "$work" && nice "$BUILD/tests/fuzz/fuzz_$name" -runs=0 -print_coverage=1 "corpus-$name") >"$work/$name.said" 2>&1
done
# a driver, and a parser: a folder, or how the names of its files begin
while read -r name part; do
    [ -e "$work/$name.said" ] || continue
    awk -v name="$name" -v part="$part" '
        /COVERED_FUNC/ && index($0, "/" part) {
            for (i = 1; i < NF; i++) if ($i == "edges:") { split($(i + 1), n, "/"); run += n[1]; all += n[2] }
        }
        END { if (all) printf "| `%s` | `%s` | %d | %.0f %% |\n", name, part, all, 100 * run / all }' "$work/$name.said"
done <<PARTS
scene renderer/sdl/
manifest tools/libretex/set/manifest
set tools/libretex/exr/
set tools/libretex/set/
pack tools/libretex/pack/
edit tools/libretex/edit/
request tools/serve/request/
ini renderer/job/ini
gltf tools/import/gltf/
upload tools/libretex/picture/
upload tools/studio/received
PARTS
