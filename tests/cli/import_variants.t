# retex-import: variants of glTF files. Those of colours and finishes come from one render.
$ /usr/bin/python3 $TESTS/import_variants.py

# What there is to choose from.
$ retex-import --exposure 0 --list-variants variants.gltf
> Red
> Print
> Wet floor
> Brass
> Glass
> As it is
> Wet red
$ retex-import --exposure 0 --list-variants Red.gltf
$ retex-import --exposure 0 --list-variants odd.gltf
> variants[0]
> variants[1]
> A
> A
$ retex-import --exposure 0 --variant blue -o none variants.gltf
! retex-import: error: variants.gltf: it has no variant `blue`; there are `Red`, `Print`, `Wet floor`, `Brass`, `Glass`, `As it is`, `Wet red`
= 2
$ retex-import --exposure 0 --variant Red -o none Red.gltf
! retex-import: error: Red.gltf: it has no variants
= 2
$ cat >card.obj <<'END'
+ v 0 0 0
+ v 1 0 0
+ v 0 1 0
+ f 1 2 3
+ END
$ retex-import --exposure 0 --variant Red -o none card.obj
! retex-import: error: card.obj: only glTF files have variants
= 2
$ retex-import --exposure 0 --list-variants card.obj
$ retex-import --exposure 0 -o none many.gltf
! retex-import: error: many.gltf: it has more than 1024 variants; choose one of them by --variant
= 2
$ ls none
! ls: cannot access 'none': No such file or directory
= 2

# One variant is the file that has its materials.
% look() { retex-import --exposure 0 -q "$@" && retex-render -q --plain --spp 64 --size 64x48 $2/$2.pov -o $2.exr; }
$ for v in Red Print 'Wet floor' Brass Glass 'As it is' 'wet RED'; do
+     rm -rf one file
+     n=$v
+     [ "$v" != 'wet RED' ] || n='Wet red'
+     look -o one --variant "$v" variants.gltf
+     look -o file "$n.gltf"
+     retex-diff -q --fail-abs 0 one.exr file.exr || echo "$v"
+     mv one.exr "is-$(echo $n | tr ' ' _).exr"
+ done

# All of them from one render: as the table says.
$ retex-import --exposure 0 -o all variants.gltf 2>&1 | grep variant
> retex-import: 6 variants, from one render, in the scene's folder: retex-render 'all.pov' -t Floor --finish Floor=original,Floor_Wet_floor_finish -t Seat --finish Seat=original,Seat_Brass_finish | retex-combine - --batch 'all-variants.csv'
> retex-import: the variant `Glass` needs a scene of its own: --variant 'Glass'
$ cat all/all-variants.csv
> output,Floor,Seat,finish:Floor,finish:Seat
> Default.png,,,original,original
> Red.png,,"rgb(0.7,0.05,0.05)",original,original
> Print.png,,":scale=2,3:rotate=22.9183121:offset=1.26825504,-1.96318305 textures/Image.png",original,original
> Wet_floor.png,"rgb(0.1,0.15,0.08)",,Floor_Wet_floor_finish,original
> Brass.png,,"rgb(0.8,0.6,0.2)",original,Seat_Brass_finish
> As_it_is.png,,,original,original
> Wet_red.png,"rgb(0.1,0.15,0.08)","rgb(0.7,0.05,0.05)",Floor_Wet_floor_finish,original
% cd all
$ sed -i 's/\.png,/.exr,/' all-variants.csv
$ retex-render -q --spp 256 --size 64x48 -t Floor --finish Floor=original,Floor_Wet_floor_finish -t Seat \
+     --finish Seat=original,Seat_Brass_finish all.pov | retex-combine -q - --batch all-variants.csv
$ for v in Red Print Wet_floor Brass As_it_is Wet_red; do
+     retex-diff -q --fail-psnr 37 $v.exr ../is-$v.exr || echo $v
+ done
$ retex-diff -q --fail-psnr 37 Default.exr As_it_is.exr || echo Default
$ for v in Red Print Wet_floor Brass Wet_red; do
+     retex-diff -q --fail-psnr 30 $v.exr As_it_is.exr && echo $v is as it was
+ done
= 1
% cd ..

# Mappings that lead nowhere change nothing. Colours of vertices would be lost.
$ retex-import --exposure 0 -q -o astray astray.gltf && ls astray
> astray-meshes.inc
> astray.pov
$ retex-import --exposure 0 -o odd odd.gltf 2>&1 | grep -c variant
> 0
= 1

# What Assimp leaves out of a material is that material's.
$ retex-import --exposure 0 -q -o order order.gltf && grep emission order/order.pov
>     diffuse 0 emission rgb 7
