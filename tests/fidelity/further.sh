#!/bin/sh
# Light that meets a target more often than a set keeps hits apart, where much light does: in closed white rooms.
#
# - a closed form: in a hollow sphere of albedo b with a light in its middle, light is b + b^2 + ... of paths of so many
#   hits; retextured, the mean of the picture is that, to half a percent.
# - a closed room: with other albedos, and with a texture, the mean is that of --replace at the same seed, to 1.5 percent,
#   from the set, from its pack and in layout `paper`. Sets that keep the last order's light as it is are 28 percent off.
# - two targets: the same, to 1.5 percent where both are edited alike, to 2.5 where one is, to 5 where one becomes dark
#   and the other white: of many hits the set keeps the number, not the order in which they come.
# - originals: the picture is as rendered, to half precision.
set -u
. tests/lib/tap.sh

render() { retex-render -q --threads 2 --spp 256 --seed 3 "$@"; }

# The mean of a picture and of its colours.
mean() { make_values "$1" mean | awk '{ print ($1 + $2 + $3) / 3 }'; }

# off A B PERCENT NAME: the mean of picture A is off from that of B, or from the number B, by at most so much.
off() {
    case $2 in *.exr) wanted=$(mean "$2") ;; *) wanted=$2 ;; esac
    percent=$(awk "BEGIN { print 100 * ($(mean "$1") / $wanted - 1) }")
    echo "# $4: $percent percent"
    result "$(awk "BEGIN { print ($percent <= $3 && $percent >= -$3) }")" "$4"
}

sphere=tests/scenes/integrating-sphere.pov
render --size 16x16 --spp 1024 -t Floor "$sphere" -o "$work/sphere.exr"
for b in 0.2 0.8 0.9 0.95; do
    retex-combine -q "$work/sphere.exr" --texture "Floor=rgb($b,$b,$b)" -o "$work/new.exr"
    off "$work/new.exr" "$(awk "BEGIN { for (n = 1; n <= 15; n++) sum += $b ^ n; print sum }")" 0.5 "a sphere of albedo $b"
done

room() { # FLOOR WALL
    cat <<POV
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 40 }
#default { finish { diffuse 1 ambient 0 } }
camera { location <0, 1, -1.8> look_at <0, 1, 1> angle 75 }
light_source { <0.3, 1.8, -0.3>, rgb 1 }
#declare Floor = box { <-2, -0.1, -2>, <2, 0, 2> pigment { rgb $1 } }
#declare Wall = box { <-2, -0.05, -2>, <2, 2.2, 2> hollow pigment { rgb $2 } }
object { Wall }
object { Floor }
sphere { <0.7, 0.4, 0.8>, 0.4 pigment { rgb <0.2, 0.5, 0.7> } }
POV
}

# One target: floor and walls.
one() { room "$1" "$1" | sed 's/object { Wall }/#declare Room = union { object { Wall } object { Floor } } object { Room }/
    s/^object { Floor }$//'; }
for old in 0.5 0.7; do
    one $old >"$work/room.pov"
    for layout in footprints paper; do
        render --size 40x30 --layout $layout -t Room "$work/room.pov" -o "$work/$layout.exr"
    done
    retex-pack -q "$work/footprints.exr" -o "$work/footprints.retex"
    for new in rgb\(.5,.5,.5\) rgb\(.7,.7,.7\) rgb\(.9,.9,.9\) "$scenes/cornell-box/textures/encaustic-tiles.jpg"; do
        edit="Room=$new"
        render --size 40x30 --replace "$edit" "$work/room.pov" -o "$work/again.exr"
        for set in footprints.exr footprints.retex paper.exr; do
            retex-combine -q "$work/$set" --texture "$edit" -o "$work/new.exr"
            off "$work/new.exr" "$work/again.exr" 1.5 "$set: a closed room, $old to ${new##*/}"
        done
    done
done

room 0.5 0.5 >"$work/two.pov"
render --size 40x30 -t Floor -t Wall "$work/two.pov" -o "$work/two.exr"
for edit in 'Floor=rgb(.9,.9,.9) Wall=rgb(.9,.9,.9)' 'Floor=rgb(.2,.2,.2) Wall=rgb(.9,.9,.9)' 'Wall=rgb(.9,.9,.9)' 'Floor=rgb(.9,.9,.9)'; do
    replaced= textures=
    for statement in $edit; do replaced="$replaced --replace $statement" textures="$textures --texture $statement"; done
    case $edit in *.2*) most=5 ;; *' '*) most=1.5 ;; *) most=2.5 ;; esac
    # shellcheck disable=SC2086 # words wanted
    render --size 40x30 $replaced "$work/two.pov" -o "$work/again.exr"
    # shellcheck disable=SC2086
    retex-combine -q "$work/two.exr" $textures -o "$work/new.exr"
    off "$work/new.exr" "$work/again.exr" $most "two targets: $edit"
done
retex-combine -q "$work/two.exr" -o "$work/same.exr"
result "$(at_least "$(figure "$work/same.exr" "$work/two.exr" psnr)" 80)" 'two targets: originals change nothing'
finish
