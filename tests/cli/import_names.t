# retex-import: what models match by names, with names that are missing, the same, or the same but for characters that
# identifiers cannot have. Where things are is what the nodes' matrices say.
% judge() { /usr/bin/python3 $TESTS/import_names.py "$@"; }
$ judge

# Cameras and lights of glTF: of each node of the scene that is shown, whatever its name.
$ for m in named unnamed empty same alike numbers; do
+     retex-import --exposure 0 -q $m.gltf -o $m && judge places $m
+ done
# They light the scene, and can be chosen by name before number.
$ retex-import --exposure 0 -v numbers.gltf --camera 1 -o one
! retex-import: camera 3 of 3 is used, Camera_1; --camera takes another one
! retex-import: 64 of 64 other views show more than Camera_1
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: 1 material, 1 mesh, 1 object, 2 triangles
! retex-import: wrote one/one.pov
$ retex-import --exposure 0 -q numbers.gltf --camera 2 -o two
$ retex-import --exposure 0 -q numbers.gltf --camera 3 -o three
$ grep -h '^camera' one/one.pov two/two.pov three/three.pov
> camera { Camera_1 }
> camera { Camera_3 }
> camera { Camera_3 }

# Of Collada and FBX: the same, unless a camera and a light have one name, which Assimp then does not tell apart.
$ for m in studio_dae.dae lamps_fbx.fbx; do
+     retex-import --exposure 0 -q $m -o ${m%.*} && judge places ${m%.*}
+ done
$ retex-import --exposure 0 --partial shared_fbx.fbx -o shared_fbx && judge places shared_fbx
! retex-import: warning: cameras and lights that cannot be told from others of the same name are left out
! retex-import: no camera in the model: the view is from outside, on the side that shows most; 22 % of it is furniture, 0 % floor, 1 object is seen, from 2.443,1.407,-1.559 to 0.5,0.5,0, 40 degrees
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: 1 material, 1 mesh, 1 object, 2 triangles
! retex-import: wrote shared_fbx/shared_fbx.pov

# Cards side by side, each with its own colour, by materials and images of any name.
$ for m in cards_colors.gltf cards_images.gltf cards_folders.gltf cards_obj.obj cards_dae.dae cards_3ds.3ds; do
+     n=${m%.*}
+     retex-import --exposure 0 -q $m -o $n && cat eye.inc >>$n/$n.pov &&
+         retex-render -q --plain --spp 1 --size 120x10 --aov albedo $n/$n.pov -o $n.exr &&
+         judge cards $n.exr
+ done
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
$ judge places cards_3ds
$ grep -o 'radius.*falloff [0-9]*' cards_3ds/cards_3ds.pov
> radius 14.99 falloff 15
> radius 15 falloff 25

# What people type: materials have their names, of the first that has it.
$ sed -n '/retex_names/,/#end/p' cards_colors/cards_colors.pov
> #ifdef (Retex) global_settings { retex_names {
>   "Wand_gr_n" "Wand grün"
>   "Wand_gr_n_2" "Wand-grün"
>   "Wand_gr_n_3" "wand_grön"
>   "Material" "木"
> } } #end
$ retex-render --list-targets cards_colors/cards_colors.pov | sed 's/.*%  //' | grep -v ^Mesh | sort
> Material_2
> Wand grün
> Wand-grün
> Wand_gr_n_4
> wand_grön
> 木

# They are names of targets too, in all steps, beside names that differ from them in such characters only.
$ cp -r cards_colors room
$ mv room/cards_colors.pov room/room.pov
$ cat eye.inc >>room/room.pov
$ echo 'light_source { <0, 5, -20> rgb 1 }' >>room/room.pov
$ retex-render -q --spp 4 --size 120x10 --denoise -t 'Wand grün' -t WAND-grün -t Wand_gr_n=Wand_gr_n_4 -t '木' \
+     -t 'wand (alt)=wand_grön' room/room.pov -o set.exr
$ retex-info --json set.exr | tr '{' '\n' | sed -n 's/.*"name": *"\([^"]*\)", *"idents": *"\([^"]*\)".*/\1: \2/p'
> Wand grün: Wand_gr_n
> WAND-grün: Wand_gr_n_2
> Wand_gr_n: Wand_gr_n_4
> 木: Material
> wand (alt): Wand_gr_n_3
$ retex-info -q --check set.exr
$ retex-pack -q set.exr -o set.retex
$ retex-info -q --check set.retex
$ retex-render -q --plain --spp 4 --size 120x10 -t 'Wand grün' -t '木' --replace 'Wand grün=rgb(.2,.3,.4)' \
+     --replace '木=rgb(.5,.6,.1)' room/room.pov -o truth.exr
$ retex-render -q --spp 4 --size 120x10 -t 'Wand grün' -t '木' room/room.pov -o two.exr
$ retex-combine -q two.exr --texture 'Wand grün=rgb(.2,.3,.4)' --texture '木=rgb(.5,.6,.1)' -o new.exr
$ retex-diff -q --fail-psnr 55 new.exr truth.exr
$ cat >table.csv <<'END'
+ output,wand grün,木
+ row.exr,"rgb(.2,.3,.4)","rgb(.5,.6,.1)"
+ END
$ retex-combine -q two.exr --batch table.csv
$ retex-diff -q --fail-abs 0 row.exr new.exr
$ retex-sample -q two.exr --texture 'Wand grün=rgb(.2,.3,.4)' --texture 'Material=rgb(.5,.6,.1)' |
+     retex-combine -q - -o piped.exr
$ retex-diff -q --fail-abs 1e-5 piped.exr new.exr
$ retex-render -q --layout paper --spp 4 --size 120x10 -t 'Wand grün' -t Wand_gr_n_4 room/room.pov -o paper.exr
$ retex-combine -q paper.exr --texture 'Wand_gr_n=rgb(.2,.3,.4)' -o paper-new.exr
$ retex-combine -q paper.exr --texture 'Wand grün=rgb(.2,.3,.4)' -o same.exr
$ cmp paper-new.exr same.exr
$ retex-render -q --layout paper -t 'Wand gr' room/room.pov -o x.exr
! retex-render: error: no texture, pigment, material or object `Wand gr` in the scene; similar: Wand grün
= 2
$ retex-render -q -t 'a:b=Material' room/room.pov -o x.exr
! retex-render: error: target `a:b=Material`: a name has letters, digits, spaces and `_-.+()` only
= 2
# A name as it is comes before an identifier that differs in case.
$ cat >alike.pov <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 retex_names { "A_b" "a b" "A_b_2" "a_b" } }
+ #declare A_b = texture { pigment { rgb 1 } }
+ #declare A_b_2 = texture { pigment { rgb .5 } }
+ camera { location -9*z look_at 0 }
+ light_source { -9*z rgb 1 }
+ sphere { -x, 1 texture { A_b } }
+ sphere { x, 1 texture { A_b_2 } }
+ END
$ for t in a_b 'a b' A_b A_B; do
+     retex-render -q --spp 1 --size 16x12 -t "$t" alike.pov -o alike-set.exr &&
+         retex-info --json alike-set.exr | grep -o '"idents": *"[^"]*"' | tr -d ' '
+ done
> "idents":"A_b_2"
> "idents":"A_b"
> "idents":"A_b"
! retex-render: error: `A_B` could be `A_b` or `A_b_2`: write it as the scene does
= 2
