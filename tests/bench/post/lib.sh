# shellcheck shell=sh
# shellcheck disable=SC2034,SC2154 # who sources it uses the former and gives the latter
# What measuring retextures and sizes share; sourced from the top of the repository. Sets are rendered once and kept in
# $sets; what is made of them is made anew where the tools are newer.
export LC_ALL=C
. tests/figures/head.sh
build=${BUILD:-build} here=tests/bench/post
case $build in /*) ;; *) build=$PWD/$build ;; esac
PATH=$build/bin:$PATH
out=$build/bench work=$build/bench/post sets=$build/bench/post/sets
python=${PYTHON:-/usr/bin/python3}
artist=${RETEX_SHARED:-../shared}/scenes/living-room-bitterli/scene.pov
mkdir -p "$work" "$sets"

scene_file() { # SCENE
    case $1 in artist) echo "$artist" ;; *) echo "scenes/$1/$1.pov" ;; esac
}
scene_is_there() { # SCENE
    [ ! -e "$(scene_file "$1")" ] || return 0
    echo "$bench: no $(scene_file "$1"): $1 is left out" >&2
    return 1
}
texture() { # TARGET: what lies on it where nothing else is said
    case $1 in Floor) set -- walnut-herringbone ;; Wall) set -- damask ;; *) set -- fans ;; esac
    echo "scenes/textures/$1.jpg"
}
texture_options() { # OPTION TARGET...: one a line
    option=$1
    shift
    for t in "$@"; do printf '%s\n' "$option" "$t=$(texture "$t")"; done
}

# A file that there is, and newer than the program it comes from: FILE PROGRAM
is_made() { [ -n "$(find "$1" -newer "$build/bin/$2" 2>/dev/null)" ]; }

set_name() { echo "$1-$(echo "$5" | tr ' ' '+')-$2-$3-$4"; } # SCENE LAYOUT SIZE SPP TARGETS

# A set as rendered: $sets/NAME.exr
rendered_set() { # SCENE LAYOUT SIZE SPP TARGETS
    file=$sets/$(set_name "$@").exr
    [ ! -e "$file" ] || return 0
    echo "$bench: rendering ${file##*/}" >&2
    # shellcheck disable=SC2046,SC2086 # words wanted
    retex-render -q --layout "$2" --size "$3" --spp "$4" $(for t in $5; do echo "-t $t"; done) "$(scene_file "$1")" \
        -o "$file"
}
# Denoised: $sets/NAME-denoised.exr. The one as rendered stays only where it was before.
denoised_set() { # as above
    denoised=$sets/$(set_name "$@")-denoised.exr
    [ ! -e "$denoised" ] || return 0
    file=$sets/$(set_name "$@").exr is_kept=
    [ ! -e "$file" ] || is_kept=1
    rendered_set "$@"
    retex-denoise -q "$file" -o "$denoised"
    [ -n "$is_kept" ] || rm "$file"
}
# Its pack beside it.
packed_set() { # SET.exr
    pack=${1%.exr}.retex
    is_made "$pack" retex-pack || retex-pack -q "$1" -o "$pack"
}
