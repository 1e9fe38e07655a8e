#!/bin/sh
# What a catalogue takes, thousands of pictures of a few sets, and on paper a million pictures a day: make
# bench-catalogues. Prints a page, which is also $BUILD/bench/catalogues.md, with the figures in catalogues.csv; with
# BENCH_DOCS=1 both go to docs/ too.
#
# The living room from a pack, as JPEG, by --batch: with one thread, with two, and in two processes with one thread each.
# Then what checking and recording take, of tiny pictures. Sets are rendered and denoised once, and
# kept in $BUILD/bench/catalogues/sets.
#
# As it stands it takes about ten minutes on two cores that are idle. BENCH_SIZE, BENCH_SPP, BENCH_PICTURES (of a turn),
# BENCH_TURNS, BENCH_VIEWS and BENCH_ROWS (of each view, for the tiny pictures) choose less.
set -eu
bench='bench-catalogues'
. tests/bench/post/lib.sh
here=tests/bench/catalogues work=$build/bench/catalogues sets=$build/bench/catalogues/sets
size=${BENCH_SIZE:-1080x1080} spp=${BENCH_SPP:-32} pictures=${BENCH_PICTURES:-48} turns=${BENCH_TURNS:-3}
views=${BENCH_VIEWS:-4} views_rows=${BENCH_ROWS:-6000}
records=$work/runs
PATH=$build/bin:$build/tests/bin:$PATH
rm -rf "$work/images" "$work/out"
mkdir -p "$work/images" "$sets"
: >"$records"

measure() { # KIND WHAT WAY TURN PICTURES COMMAND...: a line of the records
    keys="\"kind\": \"$1\", \"what\": \"$2\", \"way\": \"$3\", \"turn\": \"$4\", \"pictures\": $5"
    shift 5
    "$build/tests/bench/post_measure" "$work/run.json" "$@" >/dev/null ||
        { echo "$bench: $keys: failed" >&2 && exit 1; }
    bytes=0
    [ ! -d "$work/out" ] || bytes=$(find "$work/out" -type f -printf '%s\n' | awk '{ n += $1 } END { printf "%.0f", n }')
    echo "{$keys, \"bytes\": $bytes, \"run\": $(cat "$work/run.json")}" >>"$records"
}

# ---- pictures ----

# Files that no row before had: copies of the scenes' textures under other names.
for number in $(seq "$((2 * pictures))"); do
    image=$(ls scenes/textures/*.jpg | sed -n "$((number % 6 + 1))p")
    cp "$image" "$work/images/$number.jpg"
done
table() { # WHAT
    [ "$1" = two ] && echo output,Floor,Wall || echo output,Floor
    for number in $(seq "$pictures"); do
        case $1 in
        one) echo "out/$number.jpg,images/$number.jpg" ;;
        two) echo "out/$number.jpg,images/$number.jpg,images/$((pictures + number)).jpg" ;;
        placements) echo "out/$number.jpg,:rotate=$number:scale=1.$number images/1.jpg" ;;
        esac
    done
}
batch() { # WHAT TURN
    table "$1" >"$work/table.csv"
    cat "$pack" >/dev/null
    cd "$work"
    set -- "$1" "$2" retex-combine -q "$pack" --batch table.csv --mkdir
    what=$1 turn=$2
    shift 2
    for way in 1-thread 2-threads 2-processes; do
        rm -rf out
        case $way in
        *-threads | *-thread) measure pictures "$what" $way "$turn" "$pictures" "$@" --threads ${way%%-*} ;;
        *) measure pictures "$what" $way "$turn" "$pictures" \
            "$@" --threads 1 --shard 1/2 '|' "$@" --threads 1 --shard 2/2 ;;
        esac
    done
    rm -rf out
    cd "$OLDPWD"
}
for targets in Floor 'Floor Wall'; do
    denoised_set living-room footprints "$size" "$spp" "$targets"
    packed_set "$denoised"
    echo "{\"kind\": \"pack\", \"what\": \"$targets\", \"bytes\": $(stat -c %s "$pack")}" >>"$records"
    for turn in $(seq "$turns"); do
        echo "$bench: $targets, turn $turn" >&2
        case $targets in
        Floor) batch one "$turn" && batch placements "$turn" ;;
        *) batch two "$turn" ;;
        esac
    done
    # shellcheck disable=SC2046 # one argument a line
    measure render "$targets" 2-threads 1 1 retex-render -q --threads 2 --size "$size" --spp "$spp" \
        $(texture_options --replace $targets) scenes/living-room/living-room.pov -o "$work/again.exr"
done

# ---- what is beside the pictures ----

rm -rf "$work/images" "$work"/*.exr "$work/table.csv"
cp -r scenes/textures "$work/textures"
cd "$work"
for view in $(seq "$views"); do
    make_set "view$view.exr" 64 48 "$view"
    "$python" -c "images = 'brick', 'fans', 'damask', 'walnut-herringbone'
print('output,floor,wall')
for k in range($views_rows):
    print(f'view$view/{k // 100}/{k}.jpg,textures/{images[k * 4 // $views_rows]}.jpg,\"rgb(0.{k % 10},0.5,{k / $views_rows})\"')" >"view$view.csv"
done
step() { # NAME OPTION...
    name=$1
    shift
    for view in $(seq "$views"); do
        measure step "$name" "view $view" 1 "$views_rows" retex-combine -q "view$view.exr" --batch "view$view.csv" \
            --manifest manifest --mkdir --threads 1 "$@"
    done
}
echo "$bench: $views views of $views_rows rows" >&2
step plan --plan
step make
step resume --resume
step verify --verify
echo "{\"kind\": \"manifest\", \"pictures\": $((views * views_rows)), \"bytes\": $(stat -c %s manifest)}" >>"$records"
cd "$OLDPWD"
rm -rf "$work/textures" "$work"/view* "$work/manifest" "$work/run.json"

"$python" $here/page.py "$records" "$out/catalogues.csv" "$(figures_head $bench)" "$size" "$spp" |
    tee "$out/catalogues.md"
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "$out/catalogues.csv" "$out/catalogues.md" docs/
fi
