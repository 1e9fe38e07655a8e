# retex-import: what models match by names, with names that are missing, the same, or the same but for characters that
# identifiers cannot have. Where things are is what the nodes' matrices say.
$ /usr/bin/python3 $TESTS/import_names.py

# Cameras and lights of glTF: of each node of the scene that is shown, whatever its name.
$ for m in named unnamed empty same alike numbers; do retex-import -q $m.gltf -o $m && /usr/bin/python3 $TESTS/import_names.py places $m; done
# They light the scene, and can be chosen by name before number.
$ retex-import -v numbers.gltf --camera 1 -o one; retex-import -q numbers.gltf --camera 2 -o two; retex-import -q numbers.gltf --camera 3 -o three; grep -h '^camera' one/one.pov two/two.pov three/three.pov
> camera { Camera_1 }
> camera { Camera_2 }
> camera { Camera_1 }
! retex-import: camera 3 of 3 is used, Camera_1; --camera takes another one
! retex-import: 1 material, 1 mesh, 1 object, 2 triangles
! retex-import: wrote one/one.pov

# Of Collada and FBX: the same, unless a camera and a light have one name, which Assimp then does not tell apart.
$ for m in studio_dae.dae lamps_fbx.fbx; do retex-import -q $m -o ${m%.*} && /usr/bin/python3 $TESTS/import_names.py places ${m%.*}; done
$ retex-import shared_fbx.fbx -o shared_fbx && /usr/bin/python3 $TESTS/import_names.py places shared_fbx
! retex-import: warning: cameras and lights that cannot be told from others of the same name are left out
! retex-import: no camera in the model: the scene is framed
! retex-import: no light in the model: a soft sky lights it
! retex-import: 1 material, 1 mesh, 1 object, 2 triangles
! retex-import: wrote shared_fbx/shared_fbx.pov

# Cards side by side, each with its own colour, by materials and images of any name.
$ for m in cards_colors.gltf cards_images.gltf cards_folders.gltf cards_obj.obj cards_dae.dae cards_3ds.3ds; do n=${m%.*}; retex-import -q $m -o $n && cat eye.inc >>$n/$n.pov && retex-render -q --plain --spp 1 --size 120x10 --aov albedo $n/$n.pov -o $n.exr && /usr/bin/python3 $TESTS/import_names.py cards $n.exr; done
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
> 0 1 2 3 4 5
$ /usr/bin/python3 $TESTS/import_names.py places cards_3ds; grep -o 'radius.*falloff [0-9]*' cards_3ds/cards_3ds.pov
> radius 14.99 falloff 15
> radius 15 falloff 25
