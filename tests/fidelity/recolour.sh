#!/bin/sh
# What a set must be able to do, in every scene of the house, at small size. Prints TAP and the figures behind it.
#
# - identity: the set recombined without textures is its picture, to half precision. From the terms alone, with the
#   beauty part black, it is too with constant-colour originals, to 60 dB. For textured originals the figure is printed:
#   terms multiply averages.
# - replace: --replace is the render of a scene edited by hand, to 80 dB at the same seed.
# - recolour: in both layouts, retextured with constants, the picture is --replace's at the same seed, to 50 dB and
#   relMSE 1e-4, all targets or one that is edited alone.
# - packs: of quality 100 and without loss they keep what makes up for the averages of a target that is not edited.
# - energy: what lies beyond the last order is below 0.1%.
set -u
. tests/lib/tap.sh
size=${FIDELITY_SIZE:-48x36} spp=${FIDELITY_SPP:-16}

# Numbers of sets are not rounded to their noise, which would hide what the method itself loses.
render() { retex-render -q --full-precision --threads 2 --size "$size" --spp "$spp" --seed 3 "$@"; }

# The scene with another pigment in `#declare NAME = texture`, as its author would edit it: edited SCENE NAME PIGMENT.
edited() {
    awk -v name="$2" -v pigment="$3" '
        $1 == "#declare" && $2 == name { inside = 1 }
        inside && /image_map/ { sub(/image_map *[{][^}]*[}]/, pigment); inside = 0 }
        { print }' "$scenes/$1/$1.pov"
}

check_scene() { # SCENE TARGET…
    scene=$1; shift
    file=$scenes/$scene/$scene.pov
    flags= originals= all=
    for target; do flags="$flags -t $target"; done

    # shellcheck disable=SC2086 # words wanted
    render $flags "$file" -o "$work/set.exr" || { result 0 "$scene renders"; return; }
    folded=$(retex-info --json "$work/set.exr" | tr ',{}' '\n\n\n' | awk -F: '$1 == "\"folded\"" { print $2 + 0 }')
    echo "# $scene: energy beyond the last order: $(awk "BEGIN { print 100 * $folded }")%"
    result "$(at_most "$folded" 0.001)" "$scene: energy beyond the last order is below 0.1%"

    retex-combine -q "$work/set.exr" -o "$work/same.exr"
    same=$(figure "$work/same.exr" "$work/set.exr" psnr)
    echo "# $scene: recombined without textures: $same dB"
    result "$(at_least "$same" 80)" "$scene: the picture with all originals is exact"

    # textured originals, kept and put back by hand
    make_blind_set "$work/set.exr" "$work/blind.exr"
    retex-combine -q "$work/blind.exr" -o "$work/same.exr"
    for target; do
        image=$(awk -v name="$target" '$1 == "#declare" && $2 == name { inside = 1 }
            inside && /image_map/ { split($0, part, "\""); print part[2]; exit }' "$file")
        originals="$originals --texture $target=$scenes/$scene/$image"
    done
    # shellcheck disable=SC2086
    retex-combine -q "$work/blind.exr" $originals -o "$work/again.exr"
    echo "# $scene: identity of textured originals, from terms: kept $(figure "$work/same.exr" "$work/set.exr" psnr) dB," \
        "put back $(figure "$work/again.exr" "$work/set.exr" psnr) dB"

    # constant originals
    cp "$file" "$work/plain.pov"
    for target; do
        scenes_file=$work/plain.pov
        awk -v name="$target" '$1 == "#declare" && $2 == name { inside = 1 }
            inside && /image_map/ { sub(/image_map *[{][^}]*[}]/, "rgb <0.5, 0.3, 0.2>"); inside = 0 } { print }' "$scenes_file" >"$work/next.pov"
        mv "$work/next.pov" "$scenes_file"
        all="$all --texture $target=rgb(0.5,0.3,0.2)"
    done
    # shellcheck disable=SC2086
    render -I "$scenes/$scene" $flags "$work/plain.pov" -o "$work/constant.exr"
    make_blind_set "$work/constant.exr" "$work/blind.exr"
    retex-combine -q "$work/blind.exr" -o "$work/same.exr"
    # shellcheck disable=SC2086
    retex-combine -q "$work/blind.exr" $all -o "$work/again.exr"
    same=$(figure "$work/same.exr" "$work/constant.exr" psnr) again=$(figure "$work/again.exr" "$work/constant.exr" psnr)
    echo "# $scene: identity of constant originals, from terms: kept $same dB, put back $again dB"
    result "$(at_least "$same" 60)" "$scene: constant originals, kept"
    result "$(at_least "$again" 60)" "$scene: constant originals, put back"

    # another image, by hand and by --replace
    edited "$scene" "$1" "image_map { jpeg \"$scenes/textures/terrazzo.jpg\" interpolate 2 }" >"$work/edited.pov"
    render --plain -I "$scenes/$scene" -I "$scenes/textures" "$work/edited.pov" -o "$work/hand.exr"
    render --replace "$1=$scenes/textures/terrazzo.jpg" "$file" -o "$work/replaced.exr"
    hand=$(figure "$work/replaced.exr" "$work/hand.exr" psnr)
    echo "# $scene: --replace against the scene edited by hand: $hand dB"
    result "$(at_least "$hand" 80)" "$scene: --replace is the scene edited by hand"

    # shellcheck disable=SC2086
    render --layout paper $flags "$file" -o "$work/paper.exr"
    for color in near-black=0.01,0.01,0.01 white=1,1,1 red=0.8,0.02,0.02; do
        value="rgb(${color#*=})"
        choices=
        for target; do choices="$choices $target"; done
        [ $# = 1 ] || choices="$choices all"
        for choice in $choices; do
            textures= replacements=
            for target; do
                case $choice in all | "$target") ;; *) continue ;; esac
                textures="$textures --texture $target=$value" replacements="$replacements --replace $target=$value"
            done
            # shellcheck disable=SC2086
            render --plain $flags $replacements "$file" -o "$work/truth.exr"
            for set in set paper; do
                # shellcheck disable=SC2086
                retex-combine -q "$work/$set.exr" $textures -o "$work/retextured.exr"
                same "$work/retextured.exr" "$work/truth.exr" 50 "$scene: $choice ${color%%=*}, $set"
            done
        done
    done
}

check_packs() { # SCENE TARGET, after check_scene
    retex-combine -q "$work/set.exr" --texture "$2=rgb(1,1,1)" -o "$work/retextured.exr"
    for option in --quality=100 --lossless; do
        retex-pack -q $option "$work/set.exr" -o "$work/set.retex"
        retex-combine -q "$work/set.retex" --texture "$2=rgb(1,1,1)" -o "$work/unpacked.exr"
        same "$work/unpacked.exr" "$work/retextured.exr" 50 "$1: $2 white, pack $option"
    done
}

case ${1:-all} in
all)
    check_scene cornell-box Floor
    check_scene glass-caustics Floor
    check_scene living-room Floor Wall
    check_scene kitchen Floor Wall
    check_packs kitchen Floor
    ;;
*) check_scene "$@" ;;
esac
finish
