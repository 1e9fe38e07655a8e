# retex-info --layers: a flat file for other programs, and scripts of nodes that read it.
$ skip-unless /usr/bin/python3 -c 'import numpy, OpenImageIO'

# One part, with what the set has; without what is black everywhere, the original, and what denoising reads.
$ ln -s "$SCENES" scenes; retex-render -q --size 40x30 --spp 16 -t Floor --layout paper --aov depth,uv scenes/cornell-box/cornell-box.pov -o set.exr; retex-info set.exr --layers flat.exr; /usr/bin/python3 "$TESTS/layers.py" set.exr flat.exr
> channels as expected
> values equal types equal
> albedo_Floor_1 albedo_Floor_2 albedo_Floor_3 albedo_Floor_4 albedo_Floor_5 dep_1 dep_2 dep_3 dep_4 dep_5 depth full_0 spread_Floor_1 spread_Floor_2 spread_Floor_3 spread_Floor_4 uv uv_Floor_1 uv_Floor_2 uv_Floor_3 uv_Floor_4 uv_Floor_5
$ retex-render -q --size 40x30 --spp 16 -t Floor scenes/cornell-box/cornell-box.pov -o f.exr; retex-info f.exr --layers f-flat.exr; /usr/bin/python3 "$TESTS/layers.py" f.exr f-flat.exr; retex-info - --layers from-pipe.exr <f.exr; cmp f-flat.exr from-pipe.exr; for n in 1 5; do retex-info --threads $n f.exr --layers $n.exr; cmp $n.exr f-flat.exr; done
> channels as expected
> values equal types equal
> albedo_Floor_broad1 albedo_Floor_broad2 albedo_Floor_interreflection1 albedo_Floor_interreflection2 albedo_Floor_quadrants albedo_Floor_sharp1 albedo_Floor_sharp2 albedo_Floor_sharp3 albedo_Floor_sharp4 axes_Floor_quadrants dep_Floor_broad1 dep_Floor_broad2 dep_Floor_broad_a1 dep_Floor_broad_a2 dep_Floor_broad_a3 dep_Floor_broad_a4 dep_Floor_quadrant1 dep_Floor_quadrant2 dep_Floor_quadrant3 dep_Floor_quadrant4 dep_Floor_sharp1 dep_Floor_sharp2 dep_Floor_sharp3 dep_Floor_sharp4 dep_Floor_sharp_a1 dep_Floor_sharp_a2 dep_Floor_sharp_a3 dep_Floor_sharp_a4 indep share_Floor_broad1 share_Floor_broad2 share_Floor_interreflection1 share_Floor_interreflection2 share_Floor_quadrant1 share_Floor_quadrant2 share_Floor_quadrant3 share_Floor_quadrant4 share_Floor_sharp1 share_Floor_sharp2 share_Floor_sharp3 share_Floor_sharp4 spread_Floor_broad1 spread_Floor_broad2 spread_Floor_interreflection1 spread_Floor_interreflection2 spread_Floor_sharp1 spread_Floor_sharp2 spread_Floor_sharp3 spread_Floor_sharp4 uv_Floor_broad1 uv_Floor_broad2 uv_Floor_interreflection1 uv_Floor_interreflection2 uv_Floor_quadrants uv_Floor_sharp1 uv_Floor_sharp2 uv_Floor_sharp3 uv_Floor_sharp4

# The picture of the script for Nuke, by a reader of our own: exact for a colour, near for a smooth texture.
$ retex-info set.exr --layers flat.exr --nuke -o 'a b.nk'; printf '%s\n' 'import numpy as n, OpenImageIO as o' 'x = (n.arange(256) + 0.5) / 256' 'u, v = n.meshgrid(x, x[::-1])' 'for name, a in ("smooth", [0.5 + 0.4 * n.sin(3 * u + 1), 0.2 + 0.6 * v * u, 0.5 + 0.3 * n.cos(4 * v)]), ("plain", [0 * u + 0.75, 0 * u + 0.5, 0 * u + 0.125]), ("waves", [0.5 + 0.4 * n.sin(6.2832 * u), 0.5 + 0.3 * n.cos(6.2832 * v), 0.5 + 0.2 * n.sin(6.2832 * (u + v))]):' '    i = o.ImageBuf(o.ImageSpec(256, 256, 3, o.FLOAT))' '    i.set_pixels(o.ROI(0, 256, 0, 256), n.ascontiguousarray(n.stack(a, -1), n.float32))' '    i.write(name + ".exr")' >textures.py; /usr/bin/python3 textures.py
$ for t in plain smooth; do /usr/bin/python3 "$TESTS/nuke.py" 'a b.nk' $t.exr nuke-$t.exr; retex-combine -q set.exr --texture Floor=$t.exr -o $t-picture.exr; done; retex-diff --fail-psnr 75 nuke-plain.exr plain-picture.exr >/dev/null && echo plain; retex-diff --fail-psnr 45 nuke-smooth.exr smooth-picture.exr >/dev/null && echo smooth
> 48 nodes
> 48 nodes
> plain
> smooth

# Coordinates beyond 0 to 1 repeat; footprints with all cross terms; names that need quotes.
$ printf '%s\n' 'camera{location <0,2,-3> look_at 0} light_source{<2,5,-3>,1}' '#declare F=texture{pigment{image_map{png "t.png"} rotate 90*x scale .4} finish{diffuse .7 reflection{.2 metallic} phong .3}}' 'plane{y,0 texture{F}} sphere{<0,.6,0>,.6 texture{F}}' >beyond.pov; make_picture t.png 8 8 >/dev/null 2>&1 || oiiotool --pattern checker 8x8 3 -o t.png; retex-render -q --size 32x24 --spp 16 -t F --layout paper beyond.pov -o 'b"$[x].exr'; retex-info 'b"$[x].exr' --layers 'l"$[x].exr' --nuke -o b.nk; grep -c 'floor(r)\|floor(g)' b.nk; /usr/bin/python3 "$TESTS/nuke.py" b.nk plain.exr nuke-b.exr; retex-combine -q 'b"$[x].exr' --texture F=plain.exr -o b-picture.exr; retex-diff --fail-psnr 60 nuke-b.exr b-picture.exr >/dev/null && echo same; /usr/bin/python3 "$TESTS/nuke.py" b.nk waves.exr nuke-w.exr; retex-combine -q 'b"$[x].exr' --texture F=waves.exr -o w-picture.exr; retex-diff --fail-psnr 23 nuke-w.exr w-picture.exr >/dev/null && echo waves
> 10
> 73 nodes
> same
> 73 nodes
> waves

# The script for Blender is run by long/compositor; here, that it is Python and has the same terms.
$ retex-info set.exr --layers flat.exr --blender -o set.py; /usr/bin/python3 -m py_compile set.py; sed -n '/^HITS/,/^]/p;/^TERMS/,/^]/p' set.py; retex-info 'b"$[x].exr' --layers 'l"$[x].exr' --blender | sed -n '/^REPEATS/p;/^LAYERS/s/.*\///p;s/^    ("cross[^"]*", \(.*\)),$/\1/p'
> HITS = [
>     (1, "uv_Floor_1", "spread_Floor_1"),
>     (2, "uv_Floor_2", "spread_Floor_2"),
>     (3, "uv_Floor_3", "spread_Floor_3"),
>     (4, "uv_Floor_4", "spread_Floor_4"),
>     (5, "uv_Floor_5", ""),
> ]
> TERMS = [
>     ("full_0", []),
>     ("dep_1", [1]),
>     ("dep_2", [1, 2]),
>     ("dep_3", [1, 2, 3]),
>     ("dep_4", [1, 2, 3, 4]),
>     ("dep_5", [1, 2, 3, 4, 5]),
> ]
> l\x22$[x].exr"
> REPEATS = (True, True)
> [1]
> [2]
> [1, 2]
> [1, 3]
> [2, 3]

# What cannot be.
$ retex-info f.exr --layers x.exr --blender; retex-info set.exr --nuke; retex-info set.exr --blender; retex-info set.exr --layers x.png; retex-info set.exr --layers x.exr --nuke --blender; retex-info set.exr --layers x.exr --json; retex-info set.exr --layers set.exr; retex-info set.exr --layers x.exr -o x.exr; retex-info set.exr --layers nowhere/x.exr; ls x.exr
! retex-info: error: f.exr has 1 target in layout footprints: scripts rebuild sets of one target in layout paper
! retex-info: error: --nuke prints a script that reads a file of layers: add --layers FILE.exr
! retex-info: error: --blender prints a script that reads a file of layers: add --layers FILE.exr
! retex-info: error: --layers writes OpenEXR: expected a name that ends in .exr, not `x.png`
! retex-info: error: one script at a time: --blender or --nuke
! retex-info: error: --json, --check and --layers exclude each other
! retex-info: error: set.exr: --layers would replace the set
! retex-info: error: x.exr: --layers and the answer are the same file
! retex-info: error: cannot write nowhere/x.exr: No such file or directory
! ls: cannot access 'x.exr': No such file or directory
= 2

# Of each lamp there is one layer. Each times its value, they add up to the picture, also by other values.
$ printf '%s\n' 'camera{location <0,1.5,-4> look_at <0,.8,0>} background{rgb <.1,.13,.16>}' '#declare F=texture{pigment{checker rgb <.8,.5,.3> rgb .4}} plane{y,0 texture{F}}' '#declare Sun=light_source{<3,4,-3>,<1,.9,.7>} light_source{Sun} #declare Off=light_source{<-2,3,-2>,0} light_source{Off}' '#declare Bulb=sphere{<-1,1,1>,.3 pigment{rgb 1} finish{emission <6,5,4>}} object{Bulb}' >lamps.pov; for t in '-t F' '' '-t F --denoise'; do retex-render -q --size 32x24 --spp 16 $t --lamps each lamps.pov -o lamps.exr; retex-info lamps.exr --layers flat.exr; /usr/bin/python3 "$TESTS/lamp_layers.py" lamps.exr flat.exr flat.exr; done
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
$ retex-combine -q lamps.exr --light Sun=2 --light sky=0 -o relit.exr; /usr/bin/python3 "$TESTS/lamp_layers.py" lamps.exr flat.exr relit.exr Sun=2 sky=0
> lamps Sun Off Bulb sky
> R equal
> G equal
> B equal

# A pack with loss has no pictures of lamps; one without loss has them, and one without lamps needs none.
$ retex-render -q --size 32x24 --spp 16 -t F --lamps each lamps.pov -o lamps.exr; retex-pack -q lamps.exr -o loss.retex; retex-info loss.retex --layers loss.exr; ls loss.exr
! retex-info: error: the set has no picture of the lamp Sun: packs with loss leave them out; take the set before packing, or one of retex-pack --no-lamps
! ls: cannot access 'loss.exr': No such file or directory
= 2
$ retex-pack -q lamps.exr --lossless -o whole.retex; retex-info whole.retex --layers whole.exr; retex-info lamps.exr --layers flat.exr; cmp whole.exr flat.exr; sed 's/light_source{Off}//' lamps.pov >lit.pov; retex-render -q --size 32x24 --spp 16 -t F --lamps each lit.pov -o lit.exr; retex-pack -q lit.exr --no-lamps -o none.retex; retex-info none.retex --layers none.exr; ls none.exr
> none.exr
