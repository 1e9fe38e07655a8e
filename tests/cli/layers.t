# retex-info --layers: a flat file for other programs.
$ skip-unless /usr/bin/python3 -c 'import numpy, OpenImageIO'

# One part, with what the set has; without what is black everywhere, the original, and what denoising reads.
$ ln -s "$SCENES" scenes
$ retex-render -q --size 40x30 --spp 16 -t Floor --layout paper --aov depth,uv scenes/cornell-box/cornell-box.pov \
+     -o set.exr
$ retex-info set.exr --layers flat.exr
$ /usr/bin/python3 "$TESTS/layers.py" set.exr flat.exr
> channels as expected
> values equal types equal
> albedo_Floor_1 albedo_Floor_2 albedo_Floor_3 albedo_Floor_4 albedo_Floor_5 dep_1 dep_2 dep_3 dep_4 dep_5 depth full_0 spread_Floor_1 spread_Floor_2 spread_Floor_3 spread_Floor_4 uv uv_Floor_1 uv_Floor_2 uv_Floor_3 uv_Floor_4 uv_Floor_5
$ retex-render -q --size 40x30 --spp 16 -t Floor scenes/cornell-box/cornell-box.pov -o f.exr
$ retex-info f.exr --layers f-flat.exr
$ /usr/bin/python3 "$TESTS/layers.py" f.exr f-flat.exr
> channels as expected
> values equal types equal
> albedo_Floor_broad1 albedo_Floor_broad2 albedo_Floor_interreflection1 albedo_Floor_interreflection2 albedo_Floor_quadrants albedo_Floor_sharp1 albedo_Floor_sharp2 albedo_Floor_sharp3 albedo_Floor_sharp4 axes_Floor_quadrants dep_Floor_broad1 dep_Floor_broad2 dep_Floor_broad_a1 dep_Floor_broad_a2 dep_Floor_broad_a3 dep_Floor_broad_a4 dep_Floor_quadrant1 dep_Floor_quadrant2 dep_Floor_quadrant3 dep_Floor_quadrant4 dep_Floor_sharp1 dep_Floor_sharp2 dep_Floor_sharp3 dep_Floor_sharp4 dep_Floor_sharp_a1 dep_Floor_sharp_a2 dep_Floor_sharp_a3 dep_Floor_sharp_a4 indep share_Floor_broad1 share_Floor_broad2 share_Floor_interreflection1 share_Floor_interreflection2 share_Floor_quadrant1 share_Floor_quadrant2 share_Floor_quadrant3 share_Floor_quadrant4 share_Floor_sharp1 share_Floor_sharp2 share_Floor_sharp3 share_Floor_sharp4 spread_Floor_broad1 spread_Floor_broad2 spread_Floor_interreflection1 spread_Floor_interreflection2 spread_Floor_sharp1 spread_Floor_sharp2 spread_Floor_sharp3 spread_Floor_sharp4 uv_Floor_broad1 uv_Floor_broad2 uv_Floor_interreflection1 uv_Floor_interreflection2 uv_Floor_quadrants uv_Floor_sharp1 uv_Floor_sharp2 uv_Floor_sharp3 uv_Floor_sharp4
$ retex-info - --layers from-pipe.exr <f.exr
$ cmp f-flat.exr from-pipe.exr
$ for n in 1 5; do
+     retex-info --threads $n f.exr --layers $n.exr
+     cmp $n.exr f-flat.exr
+ done

# What cannot be.
$ retex-info set.exr --layers x.png
! retex-info: error: --layers writes OpenEXR: expected a name that ends in .exr, not `x.png`
= 2
$ retex-info set.exr --layers x.exr --json
! retex-info: error: --json, --check and --layers exclude each other
= 2
$ retex-info set.exr --layers set.exr
! retex-info: error: set.exr: --layers would replace the set
= 2
$ retex-info set.exr --layers x.exr -o x.exr
! retex-info: error: x.exr: --layers and the answer are the same file
= 2
$ retex-info set.exr --layers nowhere/x.exr
! retex-info: error: cannot write nowhere/x.exr: No such file or directory
= 2
$ ls x.exr
! ls: cannot access 'x.exr': No such file or directory
= 2

# Of each lamp there is one layer. Each times its value, they add up to the picture, also by other values.
$ cat >lamps.pov <<'END'
+ camera{location <0,1.5,-4> look_at <0,.8,0>} background{rgb <.1,.13,.16>}
+ #declare F=texture{pigment{checker rgb <.8,.5,.3> rgb .4}} plane{y,0 texture{F}}
+ #declare Sun=light_source{<3,4,-3>,<1,.9,.7>}
+ light_source{Sun}
+ #declare Off=light_source{<-2,3,-2>,0}
+ light_source{Off}
+ #declare Bulb=sphere{<-1,1,1>,.3 pigment{rgb 1} finish{emission <6,5,4>}} object{Bulb}
+ END
$ for t in '-t F' '' '-t F --denoise'; do
+     retex-render -q --size 32x24 --spp 16 $t --lamps each lamps.pov -o lamps.exr
+     retex-info lamps.exr --layers flat.exr
+     /usr/bin/python3 "$TESTS/lamp_layers.py" lamps.exr flat.exr flat.exr
+ done
> lamps Sun Off Bulb sky
> R equal
> G equal
> B equal
> lamps Sun Off Bulb sky
> R equal
> G equal
> B equal
> lamps Sun Off Bulb sky
> R equal
> G equal
> B equal
$ retex-combine -q lamps.exr --light Sun=2 --light sky=0 -o relit.exr
$ /usr/bin/python3 "$TESTS/lamp_layers.py" lamps.exr flat.exr relit.exr Sun=2 sky=0
> lamps Sun Off Bulb sky
> R equal
> G equal
> B equal

# A pack with loss has no pictures of lamps; one without loss has them, and one without lamps needs none.
$ retex-render -q --size 32x24 --spp 16 -t F --lamps each lamps.pov -o lamps.exr
$ retex-pack -q lamps.exr -o loss.retex
$ retex-info loss.retex --layers loss.exr
! retex-info: error: the set has no picture of the lamp Sun: packs with loss leave them out; take the set before packing, or one of retex-pack --no-lamps
= 2
$ ls loss.exr
! ls: cannot access 'loss.exr': No such file or directory
= 2
$ retex-pack -q lamps.exr --lossless -o whole.retex
$ retex-info whole.retex --layers whole.exr
$ retex-info lamps.exr --layers flat.exr
$ cmp whole.exr flat.exr
$ sed 's/light_source{Off}//' lamps.pov >lit.pov
$ retex-render -q --size 32x24 --spp 16 -t F --lamps each lit.pov -o lit.exr
$ retex-pack -q lit.exr --no-lamps -o none.retex
$ retex-info none.retex --layers none.exr
$ ls none.exr
> none.exr
