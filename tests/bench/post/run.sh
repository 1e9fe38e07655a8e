#!/bin/sh
# How long a retexture takes, from start to the written file, and how much room a set takes, as in tables 4 to 6 of the
# paper: make bench-post. Prints a page, which is also $BUILD/bench/post.md, with the figures in post.csv; with
# BENCH_DOCS=1 both go to docs/ too.
#
# The living room with a new floor, and with new floor and wall, and an artist's living room, where it is there, with
# floor, and with floor and painting. Sets of each size are rendered and denoised once and kept in
# $BUILD/bench/post/sets, so that a second run only measures; a set made by other versions of renderer and filter has to
# be removed by hand. Then whole processes are measured in turn, every other turn backwards, so that a machine that gets
# slower or faster favours nothing: retex-combine from packs, sets and pipes into several formats; beside it, in the
# same turns, reading alone (post_floor), the same sum by oiiotool, and the scene rendered again.
#
# As it stands it takes about five hours on two cores the first time, half of it rendering and denoising, and 20 GB of
# disk. BENCH_SIZES, BENCH_SPP (else 32, and 8 from two million pixels on), BENCH_TURNS (5, of large pictures at most 3),
# BENCH_SCENES='living-room artist', BENCH_EDITS='one two', BENCH_LAYOUTS (else footprints; 'footprints paper') choose
# less, BENCH_ROWS='pack-jpg floor-pack' and so on few of the rows below, as often as BENCH_TURNS says, and
# BENCH_TABLE_SIZE and BENCH_TABLE_SPP what sizes are measured of (1920x1080, or the first of BENCH_SIZES
# where they are given, with 128 samples, or BENCH_SPP; `no': nothing), and BENCH_CONTROL_SPP with how many samples
# Rousselle's buffers are. With BENCH_RENDER=no what there is no set of is left out.
set -eu
bench='bench-post'
. tests/bench/post/lib.sh
records=$work/runs
turns=${BENCH_TURNS:-5} sizes=${BENCH_SIZES:-640x640 1080x1080 2048x2048 4096x3840}
scenes=${BENCH_SCENES:-living-room artist} edits=${BENCH_EDITS:-one two} layouts=${BENCH_LAYOUTS:-footprints}
table_size=${BENCH_TABLE_SIZE:-${BENCH_SIZES:-1920x1080}}
table_size=${table_size%% *} table_spp=${BENCH_TABLE_SPP:-${BENCH_SPP:-128}}
control_spp=${BENCH_CONTROL_SPP:-$table_spp}
all_rows='pack-jpg pack-exr pack-png pack-tif floor-pack set-jpg set-exr floor-set cat-pack cat-set pipe batch oiio render'
rows=${BENCH_ROWS:-$all_rows}
variants=12
if ! command -v oiiotool >/dev/null; then
    echo "$bench: there is no oiiotool (openimageio-tools)" >&2
    exit 2
fi
mkdir -p "$work/out"
: >"$records"

megapixels() { echo "$1" | awk -Fx '{ print int($1 * $2 / 1e6) }'; }
spp_of() { # SIZE
    spp=${BENCH_SPP:-8}
    [ -n "${BENCH_SPP:-}" ] || [ "$(megapixels "$1")" -ge 2 ] || spp=32
    echo "$spp"
}
targets_of() { # SCENE EDIT
    case $1-$2 in *-one) echo Floor ;; artist-two) echo Floor Painting ;; *) echo Floor Wall ;; esac
}
record() { # KIND KEY=VALUE... [FILE]: a line, with the object in FILE as the value of `run'
    printf '{"kind": "%s"' "$1" >>"$records"
    shift
    for pair; do
        case $pair in
        *=*) printf ', "%s": "%s"' "${pair%%=*}" "${pair#*=}" ;;
        *) printf ', "run": %s' "$(cat "$pair")" ;;
        esac
    done >>"$records"
    echo '}' >>"$records"
}

# ---- time ----

# Different textures, in two sizes, so that no row of the table has all those of the row before.
batch_table() { # TARGET...
    echo "output $*" | tr ' ' ','
    images=$(ls scenes/textures/*.jpg)
    count=$(echo "$images" | wc -l)
    for number in $(seq $variants); do
        row=$work/out/variant-$number.jpg shift=$number
        for t in "$@"; do
            row="$row,:scale=$(((number + 5) / 6)) $(echo "$images" | sed -n "$((shift % count + 1))p")"
            shift=$((shift + 2))
        done
        echo "$row"
    done
}
command_of() { # ROW TARGET...: of the case's files, one argument a line
    row=$1 made=$work/out/$1
    shift
    case $row in
    pack-*) printf '%s\n' retex-combine -q "$pack" -o "$made.${row#*-}" ;;
    set-*) printf '%s\n' retex-combine -q "$measured" -o "$made.${row#*-}" ;;
    cat-pack) printf '%s\n' cat "$pack" '|' retex-combine -q - -o "$made.jpg" ;;
    cat-set) printf '%s\n' cat "$measured" '|' retex-combine -q - -o "$made.jpg" ;;
    pipe) printf '%s\n' retex-sample -q "$pack" -o - ;;
    batch) printf '%s\n' retex-combine -q "$pack" --batch "$work/out/variants.csv" ;;
    floor-pack) printf '%s\n' "$build/tests/bench/post_floor" "$pack" ;;
    floor-set) printf '%s\n' "$build/tests/bench/post_floor" "$measured" ;;
    oiio) "$python" $here/oiio_chain.py "$measured" "$samples" "$made.exr" ;;
    render) printf '%s\n' retex-render -q --size "$size" --spp "$spp" "$file" -o "$made.exr" ;;
    samples) printf '%s\n' retex-sample -q "$measured" -o "$made.exr" ;;
    esac
    case $row in
    batch | floor-* | oiio) ;;
    render) texture_options --replace "$@" ;;
    *) texture_options --texture "$@" ;;
    esac
    [ "$row" != pipe ] || printf '%s\n' '|' retex-combine -q - -o "$made.jpg"
}
run() { # ROW TARGET...: one measurement of the case at hand, which writes a new file: ext4 takes longer to replace one
    echo "$named $1, turn $turn" >&2
    rm -f "$work/out/$1".*
    given=$(command_of "$@")
    # No argument has a line feed in it.
    IFS='
'
    # shellcheck disable=SC2086
    "$build/tests/bench/post_measure" "$work/run.json" $given >/dev/null ||
        echo "$bench: $named $1 failed" >&2
    unset IFS
    record time "scene=$scene" "edit=$edit" "layout=$layout" "size=$size" "row=$1" "turn=$turn" "$work/run.json"
}
agreement() { # WHAT A B: how far two pictures differ
    retex-diff --json "$2" "$3" >"$work/run.json" || [ $? = 1 ]
    record agreement "scene=$scene" "edit=$edit" "layout=$layout" "size=$size" "what=$1" "$work/run.json"
}
is_wanted() { # SIZE SPP TARGETS [SUFFIX]: there is a set, or it may be rendered
    [ "${BENCH_RENDER:-}" != no ] || [ -e "$sets/$(set_name "$scene" "$layout" "$1" "$2" "$3")${4:-}.exr" ]
}
# The set that is measured, in $measured; its pack, in $pack.
prepare() { # TARGETS
    denoised_set "$scene" "$layout" "$size" "$spp" "$1"
    measured=$denoised
    packed_set "$measured"
    retex-info --json "$measured" >"$work/info.json"
    record case "scene=$scene" "edit=$edit" "targets=$1" "layout=$layout" "size=$size" "spp=$spp" \
        "set_bytes=$(stat -L -c %s "$measured")" "pack_bytes=$(stat -c %s "$pack")" "$work/info.json"
}
# One case, all its turns, of large pictures at most three. What takes long is run in the first turn only: rendering,
# and oiiotool and the variants where pictures are large.
measure_case() {
    targets=$(targets_of "$scene" "$edit") spp=$(spp_of "$size") file=$(scene_file "$scene")
    named="$scene $edit $layout $size"
    is_wanted "$size" "$spp" "$targets" -denoised || return 0
    prepare "$targets"
    file=$(scene_file "$scene") samples=$work/out/samples.exr turn=1
    # shellcheck disable=SC2086
    batch_table $targets >"$work/out/variants.csv"
    case " $rows " in
    # shellcheck disable=SC2086
    *' oiio '*) run samples $targets ;;
    esac
    is_large='' case_turns=$turns
    [ "$(megapixels "$size")" -lt 4 ] || is_large=1
    [ -z "$is_large" ] || [ "$turns" -le 3 ] || [ -n "${BENCH_ROWS:-}" ] || case_turns=3
    for turn in $(seq "$case_turns"); do
        order=$rows
        [ $((turn % 2)) = 1 ] || order=$(echo "$rows" | tr ' ' '\n' | tac)
        cat "$measured" "$pack" >/dev/null
        for row in $order; do
            case $turn-$is_large-$row in
            1-*) ;;
            *-render | *-1-oiio | *-1-batch) continue ;;
            esac
            # shellcheck disable=SC2086
            run "$row" $targets
        done
    done
    [ ! -e "$work/out/oiio.exr" ] || agreement oiio "$work/out/oiio.exr" "$work/out/set-exr.exr"
    [ ! -e "$work/out/set-exr.exr" ] || agreement pack "$work/out/pack-exr.exr" "$work/out/set-exr.exr"
    rm -f "$work"/out/*
}

# ---- size ----

stored() { # WHAT FILE SET
    "$python" $here/stored.py "$2" "$3" >"$work/run.json"
    record stored "scene=$scene" "edit=$edit" "layout=$layout" "what=$1" "$work/run.json"
}
stored_as() { # WHAT FILE SET COMMAND...: of a file that is made for it
    what=$1 its_file=$2 manifest=$3
    shift 3
    "$@"
    stored "$what" "$its_file" "$manifest"
    rm "$its_file"
}
measure_sizes() {
    targets=$(targets_of "$scene" "$edit")
    is_wanted "$table_size" "$table_spp" "$targets" || return 0
    echo "$scene $edit $layout: sizes" >&2
    rendered_set "$scene" "$layout" "$table_size" "$table_spp" "$targets"
    denoised_set "$scene" "$layout" "$table_size" "$table_spp" "$targets"
    file=$sets/$(set_name "$scene" "$layout" "$table_size" "$table_spp" "$targets").exr
    made=$work/out/made
    stored exr-rendered "$file" "$file"
    stored exr "$denoised" "$denoised"
    stored_as dwaa-rendered "$made.exr" "$file" oiiotool -a "$file" --compression dwaa:45 -o "$made.exr"
    stored_as dwaa "$made.exr" "$denoised" oiiotool -a "$denoised" --compression dwaa:45 -o "$made.exr"
    stored_as pack-rendered "$made.retex" "$made.retex" retex-pack -q "$file" -o "$made.retex"
    stored_as pack "$made.retex" "$made.retex" retex-pack -q "$denoised" -o "$made.retex"
    stored_as lossless-rendered "$made.retex" "$made.retex" retex-pack -q --lossless "$file" -o "$made.retex"
    stored_as lossless "$made.retex" "$made.retex" retex-pack -q --lossless "$denoised" -o "$made.retex"
}
measure_control() {
    for mode in biased unbiased; do
        file=$sets/$scene-control-$mode-$table_size-$control_spp.exr
        [ -e "$file" ] || retex-render -q --plain --control-data $mode --size "$table_size" --spp "$control_spp" \
            "$(scene_file "$scene")" -o "$file"
        record stored "scene=$scene" "what=control-$mode" "bytes=$(stat -L -c %s "$file")"
    done
}

for scene in $scenes; do
    scene_is_there "$scene" || continue
    for layout in $layouts; do
        for edit in $edits; do
            for size in $sizes; do measure_case; done
            [ "$table_size" = no ] || measure_sizes
        done
    done
    [ "$table_size" = no ] || measure_control
done
rm -rf "$work/out" "$work"/*.json
"$python" $here/page.py "$records" "$out/post.csv" "$(figures_head bench-post)" "$table_size" "$table_spp" "$control_spp" |
    tee "$out/post.md"
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "$out/post.md" "$out/post.csv" docs/
fi
