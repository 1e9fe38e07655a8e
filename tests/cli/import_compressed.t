# retex-import: glTF files whose meshes are compressed, compared with a scene that says the same in POV-Ray's words.
% . "$TESTS/import_look.sh"
$ /usr/bin/python3 $TESTS/import_compressed.py && reference

# Draco: indices of any type, strips and fans that are triangles in its data, data that two meshes share, integers.
$ for m in draco_bytes draco_words draco_longs draco_strip draco_fan draco_integers; do
+     look $m.gltf && same $m.exr reference.exr
+ done
$ retex-diff -q --part normal --allow-inf --fail-abs 0.0005 draco_integers.exr reference.exr
$ for m in strip fan; do retex-import --exposure 0 draco_$m.gltf -o $m 2>&1 | grep -o '[0-9]* triangles'; done
> 4 triangles
> 4 triangles

# A second set of UV, and colours of bytes, which are what a factor is.
$ for m in draco_sets tint; do look $m.gltf; done
$ retex-diff -q --part albedo --fail-abs 0.01 draco_sets.exr tint.exr

# What cannot be decoded ends in one line.
$ for m in short lost other beyond type; do
+     retex-import --exposure 0 draco_$m.gltf -o odd
+     echo $?
+ done
> 2
> 2
> 2
> 2
> 2
! retex-import: error: draco_short.gltf: meshes[0].primitives[0], compressed by KHR_draco_mesh_compression: Failed to decode point attributes.
! retex-import: error: draco_lost.gltf: meshes[0].primitives[0], compressed by KHR_draco_mesh_compression: its data do not lie within their buffer
! retex-import: error: draco_other.gltf: meshes[0].primitives[0], compressed by KHR_draco_mesh_compression: it has no TEXCOORD_0, or not as numbers of the type that its accessor says
! retex-import: error: draco_beyond.gltf: meshes[0].primitives[0], compressed by KHR_draco_mesh_compression: its data do not lie within their buffer
! retex-import: error: draco_type.gltf: meshes[0].primitives[0], compressed by KHR_draco_mesh_compression: it has no TEXCOORD_0, or not as numbers of the type that its accessor says
$ ls -d odd*
! ls: cannot access 'odd*': No such file or directory
= 2
$ for m in newer version short huge stride wide mode filter third inverse buffer; do
+     retex-import --exposure 0 meshopt_$m.glb -o odd
+     echo $?
+ done
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
! retex-import: error: meshopt_newer.glb: bufferViews[0] is compressed by KHR_meshopt_compression, which cannot be read: compress it by EXT_meshopt_compression, or not at all
! retex-import: error: meshopt_version.glb: bufferViews[0], compressed by EXT_meshopt_compression: its data are damaged, or of a newer version
! retex-import: error: meshopt_short.glb: bufferViews[0], compressed by EXT_meshopt_compression: its data do not lie within their buffer
! retex-import: error: meshopt_huge.glb: bufferViews[0], compressed by EXT_meshopt_compression: what it says of its data cannot be
! retex-import: error: meshopt_stride.glb: bufferViews[0], compressed by EXT_meshopt_compression: what it says of its data cannot be
! retex-import: error: meshopt_wide.glb: bufferViews[0], compressed by EXT_meshopt_compression: what it says of its data cannot be
! retex-import: error: meshopt_mode.glb: bufferViews[0], compressed by EXT_meshopt_compression: what it says of its data cannot be
! retex-import: error: meshopt_filter.glb: bufferViews[0], compressed by EXT_meshopt_compression: what it says of its data cannot be
! retex-import: error: meshopt_third.glb: bufferViews[2], compressed by EXT_meshopt_compression: what it says of its data cannot be
! retex-import: error: meshopt_inverse.glb: bufferViews[0], compressed by EXT_meshopt_compression: what it says of its data cannot be
! retex-import: error: meshopt_buffer.glb: bufferViews[0], compressed by EXT_meshopt_compression: its data do not lie within their buffer
$ ls -d odd*
! ls: cannot access 'odd*': No such file or directory
= 2

# Changed bytes: a scene, or one line of error and no folder.
% try() {
%     retex-import --exposure 0 -q $1 -o flip 2>said
%     case $?.$(grep -c error: said).$(ls -d flip 2>/dev/null) in
%     0.0.flip) echo a scene ;;
%     2.1.) echo an error ;;
%     *) cat said ;;
%     esac
%     rm -rf flip
% }
$ for m in flips/*.glb; do try $m; done | sort | uniq -c | awk '{ print $2, $3, ($1 > 9) }'
> a scene 1
> an error 1

# meshoptimizer: floats, integers, both kinds of indices, views that are not compressed beside others.
$ for m in meshopt meshopt_sequence meshopt_exponential meshopt_integers meshopt_mixed; do
+     look $m.glb && same $m.exr reference.exr
+ done

# Normals that the octahedral filter stored in bytes and in words.
$ for m in floats bytes words; do look normals_$m.glb; done
$ retex-diff -q --part normal --allow-inf --fail-abs 0.02 normals_bytes.exr normals_floats.exr &&
+     retex-diff -q --part normal --allow-inf --fail-abs 0.0005 normals_words.exr normals_floats.exr
$ retex-diff -q --part normal --allow-inf --fail-abs 0.02 normals_floats.exr reference.exr || echo they lean
> they lean
