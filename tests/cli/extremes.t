# Colours, places, sizes and lights of any magnitude: what retex-render writes, all other tools accept.
$ cat >inf.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 }
+ camera { location <0,1,-3> look_at 0 } light_source { <-2,4,-3> rgb 1 }
+ #declare F = texture { pigment { rgb .5 } finish { diffuse .8 } } plane { y, -1 texture { F } }
+ sphere { 0, 1 pigment { rgb 1e308*10 } finish { emission 1e308 } }
+ END
$ retex-render -q --size 16x12 --spp 4 --aov albedo -t F inf.pov -o inf.exr 2>err
$ sed 's/[0-9]* \(contr\|numbers\)/N \1/' err
> retex-render: warning: N contributions were not finite and were left out
> retex-render: warning: N numbers were not finite, or beyond 1e18, and were stored as 0 or as that
$ retex-info -q --check inf.exr && retex-denoise -q inf.exr -o d.exr
$ retex-diff -q --part albedo inf.exr d.exr
$ python3 "$TESTS/extremes.py" 25 1000
> 10 sets of 25 scenes, 0 wrong
