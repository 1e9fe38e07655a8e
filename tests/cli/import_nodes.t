# retex-import: instances, hidden nodes, and what materials of glTF files do without.
% . "$TESTS/import_look.sh"
$ /usr/bin/python3 $TESTS/import_nodes.py && reference

# Each instance is an object: rotations of floats, of words, of bytes, and of words that are compressed.
$ for m in instances instances_words instances_bytes instances_packed; do
+     look $m.gltf && same $m.exr reference.exr
+ done
$ retex-import --exposure 0 instances.gltf -o instances && grep -c '^object' instances/instances.pov
> 2
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote instances/instances.pov
$ for m in uneven beyond many sum nan child; do
+     retex-import --exposure 0 -q instances_$m.gltf -o odd
+     echo $?
+ done
> 2
> 2
> 2
> 2
> 2
> 2
! retex-import: error: instances_uneven.gltf: the instances of nodes[0], by EXT_mesh_gpu_instancing: their attributes are not equally many
! retex-import: error: instances_beyond.gltf: the instances of nodes[0], by EXT_mesh_gpu_instancing: they are more than 250000, or their numbers do not lie within their buffer
! retex-import: error: instances_many.gltf: the instances of nodes[0], by EXT_mesh_gpu_instancing: they are more than 250000, or their numbers do not lie within their buffer
! retex-import: error: instances_sum.gltf: the instances of nodes[1], by EXT_mesh_gpu_instancing: they are more than 250000
! retex-import: error: instances_nan.gltf: the instances of nodes[0], by EXT_mesh_gpu_instancing: their places are no numbers
! retex-import: error: instances_child.gltf: it refers to nodes[3], but has 3 of them
$ ls -d odd*
! ls: cannot access 'odd*': No such file or directory
= 2

# What is hidden is not there, nor what is below it; its light is off. Its camera is there.
$ look hidden.gltf && same hidden.exr reference.exr
$ retex-import --exposure 0 hidden.gltf -o hidden && grep -c '^light_source' hidden/hidden.pov &&
+     grep '^camera' hidden/hidden.pov && retex-import --exposure 0 -q --camera watchman hidden.gltf -o seen &&
+     grep '^camera' seen/seen.pov
> 1
> camera { Camera_nodes_2 }
> camera { Camera_watchman }
! retex-import: camera 1 of 2 is used, Camera_nodes_2; --camera takes another one
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote hidden/hidden.pov
$ for m in circle all; do retex-import --exposure 0 -q hidden_$m.gltf -o odd; echo $?; done
> 2
> 2
! retex-import: error: hidden_circle.gltf: its nodes lie within one another more than 4000 deep, or within themselves
! retex-import: error: hidden_all.gltf: there are no surfaces in it

# A scale of 0 makes a thing flat, which is seen; two of them make it a line, which is not.
$ look flat.gltf && same flat.exr reference.exr
$ retex-import --exposure 0 -q line.gltf -o line && grep -c '^object' line/line.pov
> 1

# Accessors without a view are 0.
$ look zeros.gltf && same zeros.exr reference.exr
! retex-import: warning: skins are left out: meshes stay as they were bound

# Points and lines are told, also where there is nothing else.
$ retex-import --exposure 0 -q lines.gltf -o lines
! retex-import: warning: points and lines are left out
$ grep -c '^object' lines/lines.pov
> 2
$ retex-import --exposure 0 -q points.gltf -o points
! retex-import: error: points.gltf: there are no surfaces in it
= 2

# A line for each material and what it does without, if that shows; not without end.
$ retex-import --exposure 0 -q without.gltf -o without
! retex-import: warning: the material `pan`: its anisotropy is left out
! retex-import: warning: the material `soap`: its iridescence is left out
! retex-import: warning: the material `soap`: its diffuse transmission is left out
! retex-import: warning: the material `materials[3]`: its extension EXT_materials_?fur is left out
! retex-import: warning: the extension EXT_mesh_features is left out
$ retex-import --exposure 0 -q without_many.gltf -o many 2>&1 | tail -n 3
> retex-import: warning: the material `pan 15`: its anisotropy is left out
> retex-import: warning: the like is left out 4 more times
> retex-import: warning: the extension EXT_mesh_features is left out
$ retex-import --exposure 0 -q extensions.gltf -o extensions 2>&1 | tail -n 2
> retex-import: warning: the extension EXT_unknown_15 is left out
> retex-import: warning: the like is left out 2 more times

# Light of the attenuation's colour is what is left behind its distance, here 2: exp((fade_color - 1) 2 / fade_distance).
$ retex-import --exposure 0 -q absorbs.gltf -o absorbs
$ grep -o 'fade_power.*>' absorbs/absorbs.pov | tr -d '<>,' |
+     awk '{ for (k = 0; k < 3; k++) printf "%.3f\n", exp(($(7 + k) - 1) * 2 / $4) }'
> 0.250
> 0.500
> 0.800

# Where nothing is mirrored there is no reflection; all of many nodes are there.
$ retex-import --exposure 0 wide.gltf --up y -o wide 2>&1 | grep objects
> retex-import: no camera in the model: the view is from outside, on the side that shows most; 0 % of it is furniture, 0 % floor, 0 objects are seen, from 694.6,4136,-8830 to 0.5,0.5,-2500, 40 degrees
> retex-import: 2 materials, 2 meshes, 5000 objects, 4 triangles
$ grep -c reflection wide/wide.pov
> 1
