#!/bin/sh
# A set with new values of lamps, against the scene rendered so along the same paths: in a room with a sun, a bulb that
# emits, a red lamp, one that is off, the sky, glass and a mirror. With original textures and constant ones, by default
# and with all bits; and that keeping lamps apart changes nothing where none is changed.
set -u
. tests/lib/tap.sh
. tests/fidelity/table/truth.sh

cat >"$work/room.pov" <<'POV'
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -4.5> look_at <0, 1, 0> angle 55 }
background { rgb <.09, .12, .15> }
#declare Floor = texture { pigment { checker rgb <.8, .5, .3> rgb <.3, .4, .6> scale .5 } finish { diffuse .9 } }
#declare Wall = texture { pigment { rgb <.7, .75, .6> } finish { diffuse .8 } }
plane { y, 0 texture { Floor } }
box { <-3, 0, 3> <3, 3, 3.1> texture { Wall } }
box { <-3.1, 0, -3> <-3, 3, 3> texture { Wall } }
sphere { <-.8, .6, .3>, .6 pigment { rgbf 1 } finish { reflection .08 } interior { ior 1.5 } }
sphere { <1, .5, .8>, .5 pigment { rgb .02 } finish { reflection .8 } }
#declare Sun = light_source { <3, 4, -3> <1, .9, .7> }
light_source { Sun }
#declare Bulb = sphere { <-1.8, 2, 1.5>, .15 pigment { rgb 1 } finish { emission <8, 6, 4> diffuse 0 } }
object { Bulb }
light_source { <2, 2.5, 1> <.6, 0, 0> fade_distance 1 fade_power 2 }
#declare Spare = light_source { <0, 2.5, -1> 0 }
light_source { Spare }
POV

render() { retex-render -q --threads 2 --spp 32 --size 96x72 -t Floor -t Wall "$@" "$work/room.pov"; }

# against LEAST OPTIONS-OF-THE-LAMPS TEXTURES NAME
against() {
    textures= replaced=
    for statement in $3; do textures="$textures --texture $statement" replaced="$replaced --replace $statement"; done
    # shellcheck disable=SC2086 # words wanted
    retex-combine -q "$work/set.exr" $2 $textures -o "$work/new.exr"
    # shellcheck disable=SC2086
    render --lamps each $2 $replaced --plain -o "$work/again.exr"
    psnr=$(figure "$work/new.exr" "$work/again.exr" psnr)
    echo "# $4, $2, ${3:-originals}: $psnr dB"
    result "$(at_least "$psnr" "$1")" "$4, $2, ${3:-originals}"
}

floor='Floor=rgb(.1,.6,.2)' both='Floor=rgb(.1,.6,.2) Wall=rgb(.5,.1,.8)'
for precision in '' --full-precision; do
    # shellcheck disable=SC2086
    render --lamps each $precision -o "$work/set.exr"
    least=55
    [ -z "$precision" ] || least=60
    for edit in '' "$floor" "$both"; do
        for lamps in '--solo Sun' '--solo light2' '--solo Bulb' '--solo Spare' '--solo sky' \
            '--light Sun=.2*#ff4020 --light Bulb=6*3000K' '--light light2=20*#4080ff --light Sun=0 --light sky=3' \
            '--light rest=2 --light Spare=.5*tomato'; do
            case $lamps$edit in *20*Wall*) few=10 ;; *) few=0 ;; esac # nearly all of it in five pixels; why is not known
            against $((least - few)) "$lamps" "$edit" "${precision:-default}"
        done
    done
done

# Denoised, a lamp has less noise, in its picture and in its light: against 32 times the samples.
retex-denoise -q "$work/set.exr" -o "$work/denoised.exr"
# denoises TRUTH NAME TEXTURE REPLACED
denoises() {
    # shellcheck disable=SC2086
    converged "$1" 96x72 1024 1 render --lamps each --solo Bulb $4 --plain
    for set in set denoised; do
        # shellcheck disable=SC2086
        retex-combine -q "$work/$set.exr" --solo Bulb $3 -o "$work/$set-bulb.exr"
    done
    noisy=$(figure "$work/set-bulb.exr" "$work/truth/$1.exr" psnr)
    denoised=$(figure "$work/denoised-bulb.exr" "$work/truth/$1.exr" psnr)
    echo "# the bulb alone, $2: $noisy dB, denoised $denoised dB"
    result "$(at_least "$denoised" "$(awk "BEGIN { print $noisy + 3 }")")" "a lamp denoised, $2"
}
denoises lamp-originals originals '' ''
denoises lamp-floor 'another floor' '--texture Floor=rgb(.1,.6,.2)' '--replace Floor=rgb(.1,.6,.2)'

# A pack of it: each lamp alone and several, also where the lamp that is off is turned on; against the set.
retex-pack -q "$work/denoised.exr" -o "$work/denoised.retex"
for lamps in '--solo Sun' '--solo light2' '--solo Bulb --light Bulb=6' '--solo Spare' \
    '--light Sun=.2*#ff4020 --light Bulb=6*3000K'; do
    for edit in '' "$both"; do
        textures=
        for statement in $edit; do textures="$textures --texture $statement"; done
        for set in exr retex; do
            # shellcheck disable=SC2086
            retex-combine -q "$work/denoised.$set" $lamps $textures -o "$work/of-$set.exr"
        done
        psnr=$(figure "$work/of-retex.exr" "$work/of-exr.exr" psnr)
        echo "# packed, $lamps, ${edit:-originals}: $psnr dB"
        result "$(at_least "$psnr" 42)" "packed, $lamps, ${edit:-originals}"
    done
done

render -l Sun -l Bulb --light-share 0 -o "$work/set.exr"
render -o "$work/none.exr"
result "$(at_least "$(figure "$work/set.exr" "$work/none.exr" psnr)" 120)" 'the picture is the same'
for edit in '' "$floor" "$both"; do
    textures=
    for statement in $edit; do textures="$textures --texture $statement"; done
    for set in set none; do
        # shellcheck disable=SC2086
        retex-combine -q "$work/$set.exr" $textures -o "$work/$set.png"
    done
    cmp -s "$work/set.png" "$work/none.png"
    result $((!$?)) "no lamp is changed: the same bytes, ${edit:-originals}"
done

# The first step of a slider changes next to nothing, whatever is edited, in a set and in a pack: a ten thousandth of the
# light is 80 dB.
retex-pack -q "$work/set.exr" -o "$work/set.retex"
for edit in '' "$floor" "$both"; do
    textures=
    for statement in $edit; do textures="$textures --texture $statement"; done
    for set in exr retex; do
        # shellcheck disable=SC2086
        retex-combine -q "$work/set.$set" $textures -o "$work/before.exr"
        for lamp in Sun=.9999 Bulb=1.0001 rest=.9999; do
            # shellcheck disable=SC2086
            retex-combine -q "$work/set.$set" $textures --light $lamp -o "$work/step.exr"
            psnr=$(figure "$work/step.exr" "$work/before.exr" psnr)
            echo "# $set, $lamp, ${edit:-originals}: $psnr dB"
            result "$(at_least "$psnr" 70)" "$set: a first step to $lamp, ${edit:-originals}"
        done
    done
done

# Sixteen lamps. With two targets they keep nearly all that few lamps keep. With four, or the set would have more parts
# than readers take, their light has one further hit in all combinations, and the original colours from the third on.
many() { # TARGETS OPTION...
    targets=
    for target in $1; do targets="$targets -t $target"; done
    shift
    # shellcheck disable=SC2086
    retex-render -q --threads 2 --spp 16 --size 48x27 -I scenes/living-room -D Lamps=13 $targets --lamps each "$@" \
        tests/fidelity/scenes/lamps-living-room.pov
}
sixteen() { # LEAST-SUM LEAST TARGETS
    many "$3" --full-precision -o "$work/many.exr"
    retex-combine -q "$work/many.exr" --texture 'Floor=rgb(.1,.6,.2)' -o "$work/all.exr"
    files= # each lamp alone, to be added up
    for lamp in $(retex-info "$work/many.exr" | sed -n 's/^parameter //p'); do
        retex-combine -q "$work/many.exr" --solo "$lamp" --texture 'Floor=rgb(.1,.6,.2)' -o "$work/lamp-$lamp.exr"
        files="$files $work/lamp-$lamp.exr${files:+ --add}"
    done
    # shellcheck disable=SC2086
    oiiotool $files -o "$work/sum.exr"
    psnr=$(figure "$work/sum.exr" "$work/all.exr" psnr)
    echo "# sixteen lamps, $3: their sum $psnr dB"
    result "$(at_least "$psnr" "$1")" "sixteen lamps add up, $3"
    for lamps in '--solo Pendant' '--light Candle=20 --light Daylight=.1'; do
        # shellcheck disable=SC2086
        retex-combine -q "$work/many.exr" $lamps --texture 'Floor=rgb(.1,.6,.2)' -o "$work/new.exr"
        # shellcheck disable=SC2086
        many "$3" $lamps --replace 'Floor=rgb(.1,.6,.2)' --plain -o "$work/again.exr"
        psnr=$(figure "$work/new.exr" "$work/again.exr" psnr)
        echo "# sixteen lamps, $3, $lamps: $psnr dB"
        result "$(at_least "$psnr" "$2")" "sixteen lamps, $lamps, $3"
    done
}
sixteen 55 55 'Floor Wall'
sixteen 37 37 'Floor Wall Paint Ceiling'
finish
