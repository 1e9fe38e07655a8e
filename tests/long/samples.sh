#!/bin/sh
# POV-Ray's samples of samples.txt, unchanged, retextured: scenes that were not made for this project. Prints TAP.
#
# - identity: the set recombined without textures is its picture;
# - retexture: against a converged --replace, the retexture of a set of 128 samples is at most 0.5 dB worse than
#   --replace with as many samples and another seed. The worst is the logo, .45 dB at 54 dB: pixels at its edges have more
#   surfaces than clusters. With --clusters 8 it is .3 dB better than rendering again.
#
# SAMPLES='biscuit logo' selects scenes whose names contain a word.
set -u
. tests/lib/tap.sh
examples=${POVRAY_EXAMPLES:-/usr/share/doc/povray/examples} spp=128 truth_spp=${SAMPLES_TRUTH_SPP:-1024}
size=${SAMPLES_SIZE:-96x72}
check() { # WHAT SCENE TARGET TEXTURE
    scene=$examples/$2.pov texture=$scenes/textures/$4 name="$1, $(basename "$2")"
    if [ ! -e "$scene" ]; then
        skip "$name" "there is no $scene"
        return
    fi
    render() { nice retex-render -q --lenient --size "$size" "$@" "$scene"; }
    render --spp "$spp" --full-precision -t "$3" -o "$work/set.exr" 2>"$work/said" || {
        sed 's/^/# /' "$work/said"
        result 0 "$name: a set"
        return
    }
    retex-combine -q "$work/set.exr" -o "$work/same.exr"
    result "$(at_least "$(figure "$work/same.exr" "$work/set.exr" psnr)" 80)" "$name: identity"
    render --plain --replace "$3=$texture" --spp "$truth_spp" --seed 7 -o "$work/truth.exr" 2>/dev/null
    render --plain --replace "$3=$texture" --spp "$spp" --seed 3 -o "$work/again.exr" 2>/dev/null
    retex-combine -q "$work/set.exr" --texture "$3=$texture" -o "$work/retextured.exr"
    again=$(figure "$work/again.exr" "$work/truth.exr" psnr) ours=$(figure "$work/retextured.exr" "$work/truth.exr" psnr)
    changed=$(figure "$work/set.exr" "$work/truth.exr" psnr)
    echo "# $name: $3 retextured $ours dB, rendered again $again dB; the original is $changed dB from it"
    result "$(at_least "$ours" "$again - 0.5")" "$name: as good as rendering again"
}

while read -r what scene target texture; do
    case $what in '#'*) continue ;; esac
    for word in ${SAMPLES:-$scene}; do
        case $scene in *"$word"*) check "$what" "$scene" "$target" "$texture" ;; esac
    done
done <tests/long/samples.txt
finish
