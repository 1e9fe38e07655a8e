# shellcheck shell=sh
# shellcheck disable=SC2154 # who sources it gives the work folder, $work
# Converged pictures in files that outlive builds: in build/truth or, of small ones, in tests/fidelity/truths. Sourced from
# the top of the repository.
#
# A file's name has a digest of the view, the samples and the pixels of a small picture of the same textures: what changes
# pictures, in renderer, scene or texture, changes the small picture too, and the truth is rendered again.

truth_file() { # NAME SMALL-PICTURE WORD…: where that of this small picture is, or is to be
    key=$({
        name=$1 small=$2
        shift 2
        echo "$@"
        oiiotool --hash "$small" | grep SHA-1
    } | sha256sum | cut -c1-16)
    [ -e "tests/fidelity/truths/$1-$key.exr" ] && echo "$(pwd)/tests/fidelity/truths/$1-$key.exr" && return
    mkdir -p "${BUILD:-build}/truth"
    echo "$(cd "${BUILD:-build}" && pwd)/truth/$1-$key.exr"
}
# With KEEP_TRUTHS=1, as make figures has it, a new one replaces that of the same name in tests/fidelity/truths.
store_truth() { # NAME NEW FILE
    mv "$2" "$3"
    [ -n "${KEEP_TRUTHS:-}" ] || return 0
    rm -f "tests/fidelity/truths/$1"-????????????????.exr
    mv "$3" "tests/fidelity/truths/"
    ln -sfn "$(pwd)/tests/fidelity/truths/${3##*/}" "$work/truth/$1.exr"
}

# Of a picture that a command renders, which takes --size, --spp, --seed and -o: its file, in $kept, to which
# $work/truth/NAME.exr is a link.
find_truth() { # NAME VIEW COMMAND…
    truth_name=$1 truth_view=$2 # a caller has names of its own
    shift 2
    mkdir -p "$work/key" "$work/truth"
    "$@" --size 24x16 --spp 16 --seed 1000 -o "$work/key/$truth_name.exr"
    kept=$(truth_file "$truth_name" "$work/key/$truth_name.exr" "$truth_view")
    ln -sfn "$kept" "$work/truth/$truth_name.exr"
}
# One render as half floats: $work/truth/NAME.exr.
converged() { # NAME SIZE SPP SEED COMMAND…
    truth_name=$1 truth_view="--size $2 --spp $3 --seed $4"
    shift 4
    find_truth "$truth_name" "$truth_view" "$@"
    [ ! -e "$kept" ] || return 0
    # shellcheck disable=SC2086 # words wanted
    "$@" $truth_view -o "$work/key/$truth_name.exr"
    oiiotool "$work/key/$truth_name.exr" --ch R,G,B -d half -o "$work/key/$truth_name-new.exr"
    store_truth "$truth_name" "$work/key/$truth_name-new.exr" "$kept"
}
