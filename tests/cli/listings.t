# What is listed of a scene, with combinations of -t, -l, --finish, --camera and --crop: a sample, by the day of the last
# commit; long/listings runs all of them with sanitizers.
$ skip-unless /usr/bin/python3 -c ''
% day=$(($(git -C "$TESTS" show -s --format=%ct HEAD 2>/dev/null || echo 0) / 86400))
% sample() { /usr/bin/python3 -B "$TESTS/../lib/listings.py" "$(command -v retex-render)" 30 $day "$@"; }
$ sample "$SCENES"/*/*.pov "$TESTS"/../golden/room.pov "$TESTS/finishes.pov" >told
$ grep '^not ok\|^1' told
> 1..6

# Targets and their finishes leave the shares of lamps as they are.
% lamps() { retex-render -q --size 64x36 --list-lamps "$@" "$SCENES/living-room/living-room.pov"; }
$ lamps >plain
$ lamps -t Floor -t Wall | cmp - plain
$ lamps -t Floor -t Wall --finish Floor=matt,metal --finish Wall=original,satin --show Wall=satin | cmp - plain
$ lamps -l Lamp -l Garden -t Floor | sed 's/^[ 0-9.]*%  //'
> Lamp  several colours
> Garden  rgb(2.8,3.1,3.2)
> rest  all other light

# A rectangle has shares of its own; one that does not lie in the picture is refused by its own numbers.
$ cat >two.pov <<'END'
+ #version 3.7;
+ camera { orthographic location -z right 2*x up y }
+ #declare Left = box { <-.8,-.4,0>, <-.2,.4,.1> pigment { rgb 1 } finish { emission rgb <1,2,4> diffuse 0 } }
+ #declare Right = box { <.2,-.4,0>, <.8,.4,.1> pigment { rgb 1 } finish { emission 3 diffuse 0 } }
+ object { Left } object { Right }
+ END
$ retex-render -q --list-lamps --size 600x300 two.pov
>  39.17%  Left  rgb(1,2,4)
>  60.83%  Right  rgb(3,3,3)
$ retex-render -q --list-lamps --size 600x300 --crop 0,0,300,300 two.pov
> 100.00%  Left  rgb(1,2,4)
>   0.00%  Right  rgb(3,3,3)
$ retex-render -q --list-lamps --size 600x300 --crop 420,150,1,1 two.pov
>   0.00%  Left  rgb(1,2,4)
> 100.00%  Right  rgb(3,3,3)
$ retex-render -q --list-lamps --size 600x300 --crop 420,150,1,151 two.pov
! retex-render: error: crop 420,150,1,151 does not lie inside the picture of 600x300
= 2

# What is left of other light is not listed where it would be 0.00 %.
$ retex-render -q --list-lamps --size 64x32 -l Left --light Left=1e5 two.pov
> 100.00%  Left  rgb(1e+05,2e+05,4e+05)
$ retex-render -q --list-lamps --size 64x32 -l Left --light Left=1e3 two.pov
>  99.85%  Left  rgb(1e+03,2e+03,4e+03)
>   0.15%  rest  all other light

# Skies: of one colour, also where that is multiplied, or of several.
$ for c in '<.4,.5,1>' '<0,.5,1>' 0 '1 transmit .5'; do
+     echo "camera { } plane { y, -1 } background { rgb .2 } sky_sphere { pigment { rgb $c } }" >sky.pov
+     retex-render -q --list-lamps -l sky --size 16x8 sky.pov 2>&1
+ done
> 100.00%  sky  rgb(0.133,0.214,1)
> 100.00%  sky  rgb(0,0.214,1), by which a new one is multiplied
>   0.00%  sky  rgb(0,0,0), by which a new one is multiplied
> 100.00%  sky  rgb(0.517,0.517,0.517)
$ echo 'camera { } sky_sphere { pigment { gradient y color_map { [0 rgb 1] [1 rgb <0,0,1>] } } }' >sky.pov
$ retex-render -q --list-lamps --size 16x8 sky.pov
> 100.00%  sky  several colours
