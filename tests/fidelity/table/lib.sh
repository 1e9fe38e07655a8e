# shellcheck shell=sh
# shellcheck disable=SC2034,SC2154 # who sources it uses the former and gives the latter
# What the tables of fidelity share; sourced from the top of the repository. Pictures go below $work, are what view says,
# and are not made again where they are there.
. tests/figures/head.sh
. tests/fidelity/table/truth.sh
build=${BUILD:-build} here=tests/fidelity
all_scenes='cornell-box glass-caustics living-room kitchen globe glossy-pair horizon'
textures='checker wood grout text saturated constant dark photo'
images=$build/fidelity/textures
PATH=$build/bin:$PATH

# Makes FILE by a command that takes -o, unless it is there: made FILE COMMAND...
made() {
    file=$1
    shift
    [ -e "$file" ] || "$@" -o "$file"
}
# Processor seconds and peak kilobytes of a command, into FILE: timed FILE COMMAND...
timed() {
    file=$1
    shift
    /usr/bin/time -o "$file" -f '%U %S %M' "$@"
}
# The size of a scene's picture: that of its camera.
wide() { # SCENE HEIGHT
    case $1 in living-room) echo $(($2 * 16 / 9))x"$2" ;; *) echo $(($2 * 4 / 3))x"$2" ;; esac
}

scene_file() {
    case $1 in
    globe | glossy-pair | horizon) echo "$here/scenes/$1.pov" ;;
    *) echo "scenes/$1/$1.pov" ;;
    esac
}

targets_of() {
    case $1 in
    living-room | kitchen) echo 'Floor Wall' ;;
    globe) echo Globe ;;
    glossy-pair) echo 'Left Right' ;;
    horizon) echo Ground ;;
    *) echo Floor ;;
    esac
}

# What retex-render is told of a picture's size: a part of $part pixels of 512x384, where there is most to see. A table
# with a size of its own has a view of its own.
view() { # SCENE
    case $1 in
    glass-caustics) set -- 192 216 ;; # ball, caustic, brass, mirror
    kitchen) set -- 192 256 ;;        # cabinets, island, sun on the floor
    globe) set -- 302 186 ;;          # globe, rings, mirror, steel ball
    glossy-pair) set -- 262 246 ;;    # both panels, ball
    horizon) set -- 215 195 ;;        # horizon, columns, cone, mirror ball
    *) set -- 232 216 ;;              # boxes and shadow; sofa, table with glass, rug
    esac
    echo "--size 512x384 --crop $(($1 - ${part%x*} / 2)),$(($2 - ${part#*x} / 2)),${part%x*},${part#*x}"
}

target_flags() { for target in $(targets_of "$1"); do printf ' -t %s' "$target"; done; }

# The cell of a table: the texture for the first target, or the one three further on for the second.
cell() { # TEXTURE NUMBER
    case $1 in
    *-turned)
        set -- "${1%-turned}" "$2"
        printf ':rotate=30 '
        ;;
    esac
    set -- "$(echo "$textures $textures" | tr ' ' '\n' | awk -v n="$1" -v k="$2" \
        '{ name[NR] = $0 } END { for (i = 1; name[i] != n; i++); print name[i + 3 * (k - 1)] }')"
    ls "$images/$1".*
}

# One row a texture: where its picture goes, and what lies on each target.
batch() { # SCENE PREFIX SUFFIX TEXTURE…
    scene=$1 prefix=$2 suffix=$3
    shift 3
    echo "output $(targets_of "$scene")" | tr ' ' ','
    for texture; do
        row=$prefix$scene-$texture$suffix.exr number=0
        for target in $(targets_of "$scene"); do
            number=$((number + 1)) row=$row,$(cell "$texture" $number)
        done
        echo "$row"
    done
}

# Rendered along the same paths, all textures at once.
rendered() { # SCENE FOLDER SUFFIX SPP SEED TEXTURE…
    scene=$1 folder=$2 suffix=$3 spp=$4 seed=$5
    shift 5
    for last; do :; done
    [ ! -e "$folder/$scene-$last$suffix.exr" ] || return 0
    batch "$scene" "$folder/" "$suffix" "$@" >"$work/batch-$scene.csv"
    # shellcheck disable=SC2046 # words wanted
    retex-render -q $(view "$scene") --spp "$spp" --seed "$seed" $(target_flags "$scene") \
        --variants "$work/batch-$scene.csv" "$(scene_file "$scene")"
}

# ---- converged pictures ----

# A truth of a table is made of two converged pictures (truth.py), and is a link in $work/truth to where truth.sh keeps it.
keep_truth() { # NAME A.exr B.exr FILE
    "${python:-/usr/bin/python3}" -B $here/table/truth.py "$2" "$3" "$4.part.exr"
    rm "$2" "$3"
    store_truth "$1" "$4.part.exr" "$4"
}

# Of a scene under several textures, rendered along the same paths: $work/truth/SCENE-TEXTURE.exr.
truths() { # SCENE SPP TEXTURE…
    scene=$1 spp=$2
    shift 2
    mkdir -p "$work/key" "$work/truth"
    for texture; do rm -f "$work/key/$scene-$texture.exr"; done
    (
        view() { echo '--size 24x16'; }
        rendered "$scene" "$work/key" '' 16 1000 "$@"
    )
    for texture; do
        shift
        kept=$(truth_file "$scene-$texture" "$work/key/$scene-$texture.exr" "$(view "$scene") $spp")
        ln -sfn "$kept" "$work/truth/$scene-$texture.exr"
        [ -e "$kept" ] || set -- "$@" "$texture"
    done
    [ $# -gt 0 ] || return 0
    rm -rf "$work/truth.new"
    mkdir "$work/truth.new"
    rendered "$scene" "$work/truth.new" -1 "$spp" 1000 "$@"
    rendered "$scene" "$work/truth.new" -2 "$spp" 2000 "$@"
    for texture; do
        keep_truth "$scene-$texture" "$work/truth.new/$scene-$texture-1.exr" "$work/truth.new/$scene-$texture-2.exr" \
            "$(readlink "$work/truth/$scene-$texture.exr")"
    done
    rmdir "$work/truth.new"
}

# Of one picture, which a command renders that takes --size, --spp, --seed and -o: $work/truth/NAME.exr.
truth() { # NAME SIZE SPP COMMAND…
    truth_name=$1 truth_view="--size $2 --spp $3"
    shift 3
    find_truth "$truth_name" "$truth_view" "$@"
    [ ! -e "$kept" ] || return 0
    for number in 1 2; do
        # shellcheck disable=SC2086 # words wanted
        "$@" $truth_view --seed "${number}000" -o "$work/key/$truth_name-$number.exr"
    done
    keep_truth "$truth_name" "$work/key/$truth_name-1.exr" "$work/key/$truth_name-2.exr" "$kept"
}

# A set of layout footprints, footprints-8 or paper: $work/sets/SCENE-SPP-NAME.exr, of seed 1, or of another that ends
# its name: footprints-seed3.
make_set() { # SCENE SPP NAME
    [ ! -e "$work/sets/$1-$2-$3.exr" ] || return 0
    scene=$1 spp=$2 name=$3 seed=1
    case $name in *-seed*) seed=${name##*-seed} ;; esac
    shift 3
    case ${name%-seed*} in
    footprints-8) set -- --clusters 8 ;;
    paper) set -- --layout paper ;;
    esac
    # shellcheck disable=SC2046
    retex-render -q $(view "$scene") --spp "$spp" --seed "$seed" $(target_flags "$scene") "$@" \
        "$(scene_file "$scene")" -o "$work/sets/$scene-$spp-$name.exr"
}

# A set under all textures: $work/retextured/SCENE-TEXTURE-SPP-METHOD.exr. A method is a set's name; paper-cross-N is
# paper with its cross terms limited.
retextured() { # SCENE SPP METHOD TEXTURE…
    scene=$1 spp=$2 method=$3
    shift 3
    for last; do :; done
    [ ! -e "$work/retextured/$scene-$last-$spp-$method.exr" ] || return 0
    batch "$scene" "$work/retextured/" "-$spp-$method" "$@" >"$work/batch-$scene.csv"
    set -- "$work/sets/$scene-$spp-$method.exr" --batch "$work/batch-$scene.csv"
    case $method in
    paper-cross-*)
        shift
        set -- --cross "${method##*-}" "$work/sets/$scene-$spp-paper.exr" "$@"
        ;;
    esac
    retex-combine -q "$@"
}

# For tables that share the pictures of $build/fidelity: the folder, its settings and what is in it.
parts_of_pictures() { # NAME: of the make target
    figures_python "$1"
    part=${FIDELITY_PART:-144x112} truth_spp=${FIDELITY_TRUTH_SPP:-4096}
    work=$build/fidelity
    mkdir -p "$work/truth" "$work/again" "$work/sets" "$work/retextured"
    figures_settings "$1" "$work" "$part $truth_spp"
}
