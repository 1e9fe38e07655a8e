#!/bin/sh
# retex-render --control: an unbiased picture from few new samples and an old set. Cornell box, floor of brick, against
# the truth at 4096 samples.
#
# - the mean of 24 seeds at 8 samples is the truth: what it is off by is what is left of the noise of 24, and what the
#   set itself, which all of them share, is off by. Within 10 %, for both are estimates; measured 0.8 and 0.86 times the
#   sum. So for both ways to find alpha that are right on average;
# - at as many samples it is nearer to the truth than --replace, by 8.5 dB at 8 samples and at 2 (measured 9.2 dB); with
#   the paper's single control by 3.8 and 5 dB at 8 (4.4 and 5.8 dB), by 5.5 dB at 2 (6.2 dB);
# - a set of another size, another scene, filter, depth or the same seed is refused.
set -u
. tests/lib/tap.sh
. tests/fidelity/table/truth.sh
scene=$scenes/cornell-box/cornell-box.pov new=Floor=$scenes/textures/brick.jpg
render() { retex-render -q --threads 2 --size 40x30 "$@"; }

converged control-brick 40x30 4096 7777 render --replace "$new" "$scene"
converged control-original 40x30 4096 7777 render --plain "$scene"
render --spp 1024 --seed 1000 -t Floor --control-data unbiased "$scene" -o "$work/set.exr"
left=$(figure "$work/set.exr" "$work/truth/control-original.exr" relmse)
echo "# the set: relMSE $left"

for mode in unbiased halves; do
    one=0
    for seed in $(seq 24); do
        render --spp 8 --seed "$seed" --control "$work/set.exr" --control-mode $mode --replace "$new" "$scene" \
            -o "$work/one-$seed.exr"
        one=$(echo "$one $(figure "$work/one-$seed.exr" "$work/truth/control-brick.exr" relmse)" | awk '{ print $1 + $2 / 24 }')
    done
    make_mean "$work/mean.exr" "$work"/one-*.exr
    mean=$(figure "$work/mean.exr" "$work/truth/control-brick.exr" relmse)
    echo "# $mode: relMSE of one picture of 8 samples $one, of the mean of 24 $mean"
    result "$(awk "BEGIN { print ($mean > 0 && $mean <= 1.1 * ($one / 24 + $left)) }")" "$mode: right on average"
done

for case in 8:8.5:unbiased 8:3.8:halves 8:5:biased 2:8.5:unbiased 2:5.5:biased; do
    spp=${case%%:*} mode=${case##*:} gain=${case#*:} gain=${gain%%:*}
    render --spp "$spp" --seed 5 --replace "$new" "$scene" -o "$work/plain.exr"
    render --spp "$spp" --seed 5 --control "$work/set.exr" --control-mode "$mode" --replace "$new" "$scene" \
        -o "$work/controlled.exr"
    plain=$(figure "$work/plain.exr" "$work/truth/control-brick.exr" psnr)
    found=$(figure "$work/controlled.exr" "$work/truth/control-brick.exr" psnr)
    echo "# $spp samples: --replace $plain dB, --control $mode $found dB"
    result "$(awk "BEGIN { print ($found >= $plain + $gain) }")" "$mode: better than --replace at $spp samples"
done

refused() { # NAME OPTION…
    name=$1; shift
    said=$(retex-render -q --threads 2 --size 40x30 --spp 1 --control "$work/set.exr" --replace "$new" "$scene" "$@" \
        -o "$work/x.exr" 2>&1) && said=
    echo "# $said"
    result "$([ "$(echo "$said" | wc -l)" = 1 ] && [ -n "$said" ] && echo 1)" "$name: refused"
}
refused "another size" --size 41x30
refused "another filter" --filter gaussian
refused "another depth" --max-depth 3
refused "another target" -t Wall=White -t Floor
refused "the same seed" --seed 1000
cp "$scene" "$work/other.pov"
scene=$work/other.pov
refused "another scene" -I "$scenes/cornell-box"
finish
