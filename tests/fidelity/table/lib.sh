# shellcheck shell=sh
# shellcheck disable=SC2034,SC2154 # who sources it uses the former and gives the latter
# What the tables of fidelity share; sourced from the top of the repository. Pictures go below $work, are $size pixels,
# or the part of so large a picture that view says, and are not made again where they are there.
. tests/figures/head.sh
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

view() { echo "--size $size"; } # SCENE

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

# Converged pictures: $work/truth/SCENE-TEXTURE.exr, links into $build/truth, where they outlive builds. A name there has
# a digest of the view, the samples and the pixels of a small picture of the same textures. Whatever changes pictures,
# in renderer, scene or texture, changes the small picture too, and the truth is rendered again.
truth() { # SCENE SPP TEXTURE…
    scene=$1 spp=$2
    shift 2
    mkdir -p "$work/key" "$work/truth" "$build/truth"
    for texture; do rm -f "$work/key/$scene-$texture.exr"; done
    (
        view() { echo '--size 24x16'; }
        rendered "$scene" "$work/key" '' 16 1000 "$@"
    )
    for texture; do
        shift
        key=$({
            echo "$(view "$scene") $spp"
            oiiotool --hash "$work/key/$scene-$texture.exr" | grep SHA-1
        } | sha256sum | cut -c1-16)
        kept=$PWD/$build/truth/$scene-$texture-$key.exr
        case $build in /*) kept=$build/truth/$scene-$texture-$key.exr ;; esac
        ln -sfn "$kept" "$work/truth/$scene-$texture.exr"
        [ -e "$kept" ] || set -- "$@" "$texture"
    done
    [ $# -gt 0 ] || return 0
    rm -rf "$work/truth.new"
    mkdir "$work/truth.new"
    rendered "$scene" "$work/truth.new" '' "$spp" 1000 "$@"
    for texture; do mv "$work/truth.new/$scene-$texture.exr" "$(readlink "$work/truth/$scene-$texture.exr")"; done
    rmdir "$work/truth.new"
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
