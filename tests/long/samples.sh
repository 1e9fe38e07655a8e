#!/bin/sh
# POV-Ray's samples of samples.txt, unchanged, retextured: scenes that were not made for this project. Prints TAP.
#
# - identity: the set recombined without textures is its picture;
# - retexture: against a converged --replace, the retexture of a set of 128 samples is at most 0.3 dB worse than
#   --replace with the same samples, or what samples.txt allows. Most are not worse at all. Where light is smooth and the
#   texture has several edges in one pixel, the shape of footprints is what is seen: four discs do not fill a pixel
#   evenly. That is .8 dB at 54 dB in the logo, and with --clusters 8 .1 dB. In object_pattern, edges of the pattern
#   cut pixels too, and broad footprints are too few: with --clusters 5+1 it is as good as rendering again.
#
# SAMPLES='biscuit logo' selects scenes whose names contain a word.
set -u
. tests/lib/tap.sh
examples=${POVRAY_EXAMPLES:-/usr/share/doc/povray/examples} spp=128 truth_spp=${SAMPLES_TRUTH_SPP:-1024}
size=${SAMPLES_SIZE:-96x72}
check() { # WHAT SCENE TARGET TEXTURE LOSS
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
    render --plain --replace "$3=$texture" --spp "$spp" -o "$work/again.exr" 2>/dev/null
    retex-combine -q "$work/set.exr" --texture "$3=$texture" -o "$work/retextured.exr"
    again=$(figure "$work/again.exr" "$work/truth.exr" psnr) ours=$(figure "$work/retextured.exr" "$work/truth.exr" psnr)
    changed=$(figure "$work/set.exr" "$work/truth.exr" psnr)
    echo "# $name: $3 retextured $ours dB, rendered again $again dB; the original is $changed dB from it"
    result "$(at_least "$ours" "$again - $5")" "$name: as good as rendering again"
}

while read -r what scene target texture loss; do
    case $what in '#'*) continue ;; esac
    for word in ${SAMPLES:-$scene}; do
        case $scene in *"$word"*) check "$what" "$scene" "$target" "$texture" "${loss:-0.3}" ;; esac
    done
done <tests/long/samples.txt
finish
