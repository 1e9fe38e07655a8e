# retex-import: normal maps of glTF on cards whose front or back is seen, against glTF's rule in numpy.
$ /usr/bin/python3 $TESTS/import_bumps.py &&
+     retex-import --exposure 0 -q bumps.glb -o bumps &&
+     retex-render -q --plain --spp 1 --size 160x120 --aov normal bumps/bumps.pov -o bumps.exr &&
+     oiiotool -q bumps.exr --subimage normal -o normals.exr && /usr/bin/python3 $TESTS/import_bumps.py normals.exr
> front UV 0 as expected
> front UV 1 as expected
> front UV 2 as expected
> front UV 3 as expected
> turned UV 0 as expected
> turned UV 1 as expected
> turned UV 2 as expected
> turned UV 3 as expected
> reversed UV 0 as expected
> reversed UV 1 as expected
> reversed UV 2 as expected
> reversed UV 3 as expected
> mirrored UV 0 as expected
> mirrored UV 1 as expected
> mirrored UV 2 as expected
> mirrored UV 3 as expected
