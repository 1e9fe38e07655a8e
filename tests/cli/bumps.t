# Bumps on targets. A set's own picture is the plain one; a retexture is near the replaced render of the same paths; the
# picture does not depend on the number of threads.
$ retex-render -q --size 64x48 --spp 16 --threads 2 -t Floor -t Wall "$TESTS/bumps.pov" -o set.exr
$ retex-combine -q set.exr -o own.exr
$ retex-render -q --size 64x48 --spp 16 --threads 1 --plain -t Floor -t Wall "$TESTS/bumps.pov" -o plain.exr
$ retex-diff -q own.exr plain.exr --fail-psnr 80
$ retex-combine -q set.exr --texture 'Wall=rgb(.2,.5,.8)' -o wall.exr
$ retex-render -q --size 64x48 --spp 16 --plain -t Floor -t Wall --replace 'Wall=rgb(.2,.5,.8)' "$TESTS/bumps.pov" \
+     -o wall-again.exr
$ retex-diff -q wall.exr wall-again.exr --fail-psnr 50
$ ln -s "$SCENES" scenes
$ retex-combine -q set.exr --texture Floor=scenes/textures/brick.jpg -o floor.exr
$ retex-render -q --size 64x48 --spp 16 --plain -t Floor -t Wall \
+     --replace Floor=scenes/textures/brick.jpg "$TESTS/bumps.pov" -o floor-again.exr
$ retex-diff -q floor.exr floor-again.exr --fail-psnr 35
$ retex-render -q --size 64x48 --spp 2 --plain --threads 1 "$TESTS/bumps.pov" -o 1.exr
$ retex-render -q --size 64x48 --spp 2 --plain --threads 7 "$TESTS/bumps.pov" -o 7.exr
$ cmp 1.exr 7.exr

# Matte surfaces that a mesh lights have bumps as well.
$ cat >wall.pov <<'END'
+ #version 3.7;
+ camera { location -3*z look_at 0 }
+ triangle { <-9,9,-9>, <9,9,-9>, <0,9,9> pigment { rgb 1 } finish { emission 5 diffuse 0 } }
+ plane { -z, 0 pigment { rgb .7 } finish { ambient 0 } normal { bumps Size scale .3 } }
+ END
$ for size in 0 .6; do
+     retex-render -q --size 64x48 --spp 64 --plain -D Size=$size wall.pov -o wall$size.exr
+ done
$ retex-diff -q wall0.exr wall.6.exr --fail-psnr 25
= 1

# Errors.
$ echo 'sphere { 0, 1 normal { average } }' >bad.pov
$ retex-render bad.pov -o x.exr
! retex-render: error: bad.pov:1:32: `average` needs a normal_map
= 2
$ echo 'sphere { 0, 1 normal { gradient x slope_map { } } }' >bad.pov
$ retex-render bad.pov -o x.exr
! retex-render: error: bad.pov:1:47: expected `[` and an entry of the slope_map, found `}`
= 2
$ echo 'sphere { 0, 1 normal { bump_map { png "none.png" } } }' >bad.pov
$ retex-render bad.pov -o x.exr
! retex-render: error: bad.pov:1:39: cannot find the image `none.png` in the scene's folder or the include path
= 2
