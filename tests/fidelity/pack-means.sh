#!/bin/sh
# A pack, and a folder for browsers, keep the mean of light, by channel, to a tenth of a percent: of all light, of each lamp
# alone and of each finish, whatever their quality; in two rooms, of several seeds, against the set and with one colour on
# all targets, by pack-means.py.
set -u
. tests/lib/tap.sh

# keeps NAME QUALITY OPTIONS...
keeps() {
    name=$1 quality=$2
    shift 2
    rm -rf "$work/page"
    retex-pack -q --quality "$quality" "$work/set.exr" -o "$work/set.retex"
    retex-pack -q --quality "$quality" "$work/set.exr" --web "$work/page"
    for packed in set.retex page; do
        /usr/bin/python3 -B tests/fidelity/pack-means.py "$work/set.exr" "$work/$packed" .1 "$@" >"$work/means"
        status=$?
        sed 's/^[^#]/# &/' "$work/means"
        result $((!status)) "$name, quality $quality: $packed"
    done
}

grey='--texture Floor=rgb(.5,.5,.5) --texture Back=rgb(.5,.5,.5)'
for seed in 1; do
    retex-render -q --size 96x96 --spp 16 --seed $seed -D Lamps=1 -t Floor -t Back --lamps each tests/golden/room.pov \
        -o "$work/set.exr"
    for quality in 60 90; do
        keeps "a room with lamps, seed $seed" $quality "$grey" "$grey --solo rest" "$grey --solo light1" \
            "$grey --solo light2" "$grey --light light1=0.9999"
    done
done
grey='--texture Floor=rgb(.5,.5,.5) --texture Wall=rgb(.5,.5,.5)'
for seed in 2; do
    retex-render -q --size 96x72 --spp 16 --seed $seed -t Floor -t Wall -l Lamp --finish Floor=original,Gloss,Coated \
        tests/cli/finishes.pov -o "$work/set.exr"
    for quality in 60 90; do
        keeps "a room with finishes, seed $seed" $quality "$grey" "$grey --finish Floor=Gloss" \
            "$grey --finish Floor=Coated" "$grey --solo Lamp"
    done
done
finish
