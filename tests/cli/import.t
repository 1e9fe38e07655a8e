# retex-import: what becomes of models, compared with a scene that says the same in POV-Ray's words.
% . "$TESTS/import_look.sh"
$ /usr/bin/python3 $TESTS/import_models.py && reference

# Depth, colour and UV are the reference's: nothing is mirrored, each card is in its place.
$ for m in card.gltf card.glb second.gltf opaque.gltf words.gltf quantized.gltf quantized.glb card.obj card.dae; do
+     look $m && same ${m%.*}.exr reference.exr
+ done
$ for m in card.stl card.ply; do
+     look $m --up z && retex-diff -q --part depth --allow-inf --fail-abs 0.0005 card.exr reference.exr
+ done

# glTF's own camera is the reference's.
$ retex-import --exposure 0 -q card.glb -o own &&
+     retex-render -q --plain --spp 1 --size 96x72 --aov depth,albedo,uv own/own.pov -o own.exr &&
+     same own.exr reference.exr

# So is that of a 3DS file; it is z up there. Names of images may differ in case.
$ retex-import --exposure 0 -q card.3ds -o studio &&
+     retex-render -q --plain --spp 1 --size 96x72 --aov depth studio/studio.pov -o studio.exr &&
+     retex-diff -q --part depth --allow-inf --fail-abs 0.0005 studio.exr reference.exr
$ sed 's/F.png/TEXTURES\\f.PNG/' card.mtl >upper.mtl && sed 's/card.mtl/upper.mtl/' card.obj >upper.obj &&
+     retex-import --exposure 0 -q upper.obj -o upper && grep -c image_map upper/upper.pov
> 1

# A line of its materials that Assimp would refuse is left out; what stands behind it is read.
$ sed '1a anisotropicRotation 0' card.mtl >turns.mtl && sed 's/card.mtl/turns.mtl/' card.obj >turns.obj &&
+     retex-import --exposure 0 -q turns.obj -o turns && grep -c image_map turns/turns.pov
> 1

# A transform of the texture is one of its UV; a factor of its colours is in a new image.
$ look turned.gltf && look turned_uv.gltf && retex-diff -q --part albedo --fail-psnr 35 turned.exr turned_uv.exr
$ look tinted.gltf && look tinted_image.gltf &&
+     retex-diff -q --part albedo --fail-abs 0.004 tinted.exr tinted_image.exr
$ retex-diff -q --part albedo --fail-psnr 25 turned.exr card.exr || echo turned
> turned

# The scene: instances share a mesh, materials are targets.
$ cat own/own.pov
> // Made of card.glb by retex-import 0.1.0.
> //   retex-render own.pov --list-targets
> //   povray own.pov         (in this folder)
>
> #version 3.7;
>
> global_settings {
>   assumed_gamma 1
>   max_trace_level 12
>   radiosity { count 200 error_bound 0.5 recursion_limit 2 }
> }
> #default { finish { ambient 0 } }
> #ifdef (Retex) global_settings { retex_exposure   +0.00 } #end // stops, by which pictures are brighter
>
> // ---- camera ----
>
> #declare Camera_nodes_2 = camera {
>   location <0.75, 0.5, -2.5>
>   sky <0, 1, 0>
>   right x * 1.33333333
>   up y
>   angle 44.8272352
>   look_at <0.75, 0.5, -1.5>
> }
> // the view is from outside, on the side that shows most; 23 % of it is furniture, 0 % floor, 2 objects are seen
> #declare View_2 = camera {
>   location <3.402939, 1.796328, -1.603964>
>   right x * 4/3
>   up y
>   angle 40
>   look_at <0.625, 0.5, 0.625>
> }
> // the view is from outside, on the side that shows most; 35 % of it is furniture, 0 % floor, 2 objects are seen
> #declare View_3 = camera {
>   location <3.154121, 0.8981436, -1.404317>
>   right x * 4/3
>   up y
>   angle 40
>   look_at <0.625, 0.5, 0.625>
> }
> // the view is from outside; 24 % of it is furniture, 0 % floor, 2 objects are seen
> #declare View_4 = camera {
>   location <2.306852, 1.77239, -2.439708>
>   right x * 4/3
>   up y
>   angle 40
>   look_at <0.625, 0.5, 0.625>
> }
> camera { Camera_nodes_2 }
>
> // ---- light ----
>
> // Light that the model lacks: how bright it is, 0 where there is enough without.
> #declare Added_sky =      1.000;
> #if (Added_sky > 0)
> sky_sphere { pigment { gradient y color_map { [0 rgb 0.3*Added_sky] [1 rgb Added_sky] } scale 2 translate -y } }
> #end
>
> // ---- materials: each can be a target of retexturing ----
>
> #declare Wood = texture {
>   pigment { uv_mapping image_map { png "textures/Image.png" interpolate 2 } }
>   finish {
>     diffuse 0.96 specular albedo 0.04 roughness 1
>     #ifdef (Retex) retex { metallic 0 roughness 1 ior 1.5 } #end
>   }
> }
>
> // ---- objects ----
>
> #include "own-meshes.inc"
>
> object { Mesh_card texture { Wood } } // front
> object { Mesh_card texture { Wood } matrix <0, 0, 1, 0, 1, 0, -1, 0, 0, 1.25, 0, 0.25> } // side
$ retex-render --list-targets own/own.pov
>  34.41%  Mesh_card
>  34.41%  Wood
$ ls own own/textures
> own:
> own-meshes.inc
> own.pov
> textures
>
> own/textures:
> Image.png
$ cmp own/textures/Image.png F.png

# The mask cuts: the picture's right half is a hole.
$ look masked.gltf && retex-diff -q --part albedo --fail-psnr 25 masked.exr card.exr || echo a hole
> a hole

# Images of roughness and metallic vary over the surface.
$ retex-import --exposure 0 -q varying.gltf -o varying && grep -A8 declare.Steel varying/varying.pov
> #declare Steel = texture {
>   pigment { rgb 1 }
>   finish {
>     diffuse 0.6195 specular 0.25 roughness 0.007881 metallic reflection { 0.1884 metallic }
>     #ifdef (Retex) retex { metallic 1 roughness 0.75 ior 1.5
>       metallic_map { image_map { png "textures/Image_metallic.png" gamma 1 interpolate 2 } }
>       roughness_map { image_map { png "textures/Image_2_roughness.png" gamma 1 interpolate 2 } } } #end
>   }
> }
$ retex-render -q --plain --spp 1 --size 96x72 --aov uv,roughness,metallic varying/varying.pov -o varying.exr &&
+     /usr/bin/python3 $TESTS/import_finish.py varying.exr

# Maps and normals on a second set of UV are what they are on the first.
$ retex-import --exposure 0 -q varying_second.gltf -o second && grep -c second_uv second/second.pov second/second-meshes.inc
> second/second.pov:2
> second/second-meshes.inc:1
$ retex-render -q --plain --spp 1 --size 96x72 --aov uv,roughness,metallic second/second.pov -o second.exr &&
+     for part in roughness metallic; do retex-diff -q --part $part --fail-abs 0.0005 second.exr varying.exr; done
$ for m in bumpy bumpy_second; do
+     retex-import --exposure 0 -q -f $m.gltf -o bumps &&
+         retex-render -q --plain --spp 1 --size 96x72 --aov normal bumps/bumps.pov -o $m.exr
+ done
$ retex-diff -q --part normal --fail-abs 0.0005 bumpy.exr bumpy_second.exr

# Colours of vertices multiply an image, as a factor of its colours does.
$ look colored.gltf && retex-diff -q --part albedo --fail-abs 0.01 colored.exr tinted.exr

# Clear coat and sheen.
$ retex-import --exposure 0 -q coated.gltf -o coated && grep -A9 declare.Silk coated/coated.pov
> #declare Silk = texture {
>   pigment { rgb 1 }
>   finish {
>     diffuse 0.96 specular albedo 0.04 roughness 1
>     #ifdef (Retex) retex { metallic 0 roughness 1 ior 1.5
>       clearcoat 0.5 clearcoat_roughness 0.25
>       clearcoat_map { image_map { png "textures/Image_clearcoat.png" gamma 1 interpolate 2 } }
>       clearcoat_normal_map { image_map { png "textures/Image_2.png" gamma 1 interpolate 2 } } 0.5
>       sheen rgb <0.5, 0.25, 0.125> sheen_roughness 0.75 } #end
>   }

# Retexturing keeps them: with the original colour it is the plain picture, with another one that of a new render.
$ for m in coated:Silk colored:Wood second:Steel; do
+     n=${m%:*} t=${m#*:}
+     [ -d $n ] || retex-import --exposure 0 -q $n.gltf -o $n
+     for o in "--plain -o plain.exr" "-t $t -o set.exr" "--plain --replace $t=rgb(.2,.5,.1) -o again.exr"; do
+         retex-render -q --spp 4 --size 64x48 $n/$n.pov $o
+     done
+     retex-combine -q set.exr -o same.exr
+     retex-combine -q set.exr --texture "$t=rgb(.2,.5,.1)" -o green.exr
+     retex-diff -q --fail-abs 0.0001 same.exr plain.exr
+     retex-diff -q --fail-psnr 55 green.exr again.exr
+ done

% # The normal in the middle of the picture of the scene `bumpy`.
% middle_normal() {
%     grep '^camera' reference.pov >>bumpy/bumpy.pov
%     retex-render -q --plain --spp 1 --size 96x72 --crop 40,36,1,1 --aov normal bumpy/bumpy.pov -o bumpy.exr
%     oiiotool -q bumpy.exr --subimage normal -o bumpy.exr
%     make_values bumpy.exr 0,0
% }

# Normal maps: of glTF, with their scale; of OBJ, where the picture tells that it has normals or heights. Heights that
# rise by 1 over the picture's width, a hundredth of it high, 30 times: a slope of .3.
$ for m in bumpy.gltf bumpy.obj ramp.obj; do
+     retex-import --exposure 0 -q -f $m -o bumpy && grep retex_normal_map bumpy/bumpy.pov
+     middle_normal | awk '{ printf "%.2f %.2f %.2f\n", $1, $2, $3 }'
+ done
>   #ifdef (Retex) normal { retex_normal_map { image_map { png "textures/Leaning.png" gamma 1 interpolate 2 } } 0.5 } #end
> -0.29 -0.15 -0.95
>   #ifdef (Retex) normal { retex_normal_map { image_map { png "textures/Leaning.png" gamma 1 interpolate 2 } } } #end
> -0.51 -0.25 -0.82
>   #ifdef (Retex) normal { retex_normal_map { image_map { png "textures/Ramp_normals.png" gamma 1 interpolate 2 } } } #end
> -0.29 0.00 -0.96

# Heights in glTF, by extras of the material: white is .3 units high. Numbers rise evenly over the card, which is 1
# wide, sRGB by 2.4 / 1.055 ((u + .055) / 1.055)^1.4, at u = .589. Heights grow with the scene. At half the strength,
# the normal is in the middle between that of the slope and the plain one.
$ for m in ramp_numbers ramp_colors ramp_weak ramp_none; do
+     retex-import --exposure 0 -q -f $m.gltf -o bumpy && grep retex_height_map bumpy/bumpy.pov
+     middle_normal | awk '{ printf "%.2f %d %.2f\n", $1, ($2^2 > 1e-5), $3 }'
+ done
>   #ifdef (Retex) normal { retex_height_map { image_map { png "textures/Ramp.png" gamma 1 interpolate 2 } } 0.3 strength 1 } #end
> -0.29 0 -0.96
>   #ifdef (Retex) normal { retex_height_map { image_map { png "textures/Ramp.png" interpolate 2 } } 0.3 strength 1 } #end
> -0.32 0 -0.95
>   #ifdef (Retex) normal { retex_height_map { image_map { png "textures/Ramp.png" gamma 1 interpolate 2 } } -0.6 strength 0.5 } #end
> 0.27 0 -0.96
> 0.00 0 -1.00
$ retex-import --exposure 0 -q --scale 10 ramp_numbers.gltf -o large && grep -o '} 3 strength 1' large/large.pov
> } 3 strength 1

# A lamp shines with glTF's strength.
$ retex-import --exposure 0 glowing.gltf -o glowing && grep -A3 declare.Lamp glowing/glowing.pov
> #declare Lamp = texture {
>   pigment { rgb <1, 0.5, 0.25> }
>   finish {
>     diffuse 0 emission rgb 4
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote glowing/glowing.pov
$ retex-render -q --plain --spp 1 --size 96x72 --crop 40,36,1,1 glowing/glowing.pov -o lamp.exr &&
+     make_values lamp.exr 0,0
> 4 2 1

# A screen shines with its picture, and is grey.
$ retex-import --exposure 0 -q screen.gltf -o screen && grep -A6 declare.Screen screen/screen.pov
> #declare Screen = texture {
>   pigment { rgb 0.2 }
>   finish {
>     diffuse 0.96 specular albedo 0.04 roughness 0.001961 reflection { 0.0225, 0.5625 falloff 5 }
>     #ifdef (Retex) emission rgb 0.5 #end
>     #ifdef (Retex) retex { metallic 0 roughness 0.25 ior 1.5
>       emission_map { image_map { png "textures/Image.png" interpolate 2 } } } #end

# Names become identifiers.
$ retex-import --exposure 0 names.obj -o names && grep declare names/names.pov
> #declare View_2 = camera {
> #declare View_3 = camera {
> #declare View_4 = camera {
> #declare Added_sky =      1.000;
> #declare Sphere = texture {
> #declare Sphere_2 = texture {
> #declare Material_2nd = texture {
> #declare Material = texture {
! retex-import: 3 faces lie on others of the same corners: one of each is kept
! retex-import: no camera in the model: the view is from outside, on the side that shows most; 15 % of it is furniture, 0 % floor, 1 object is seen, from -1.006,0.7955,-1.877 to 0.5,0.5,0, 40 degrees
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: 4 materials, 1 mesh, 1 object, 1 triangle
! retex-import: wrote names/names.pov

# Missing images are told, and the scene is made without them where that is asked for; files outside of the model's
# folder are not read.
$ retex-import --exposure 0 below/missing.gltf -o missing
! retex-import: warning: there is no image `http://example.org/wood.png`
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: error: below/missing.gltf: 1 image is lost, see above; --partial makes the scene without it
= 2
$ ls -d missing*
! ls: cannot access 'missing*': No such file or directory
= 2
$ retex-import --exposure 0 --partial below/missing.gltf -o missing
! retex-import: warning: there is no image `http://example.org/wood.png`
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote missing/missing.pov
$ retex-import --exposure 0 below/out.gltf -o out
! retex-import: error: below/out.gltf: the model names the file `../secret.png`, which is outside of its folder; -I DIR adds folders that may be read
= 2
$ ls -d out*
! ls: cannot access 'out*': No such file or directory
= 2
$ retex-import --exposure 0 -q --partial below/out.gltf -o out
! retex-import: warning: there is no image `../secret.png`
$ rm -r out
$ retex-import --exposure 0 below/out.gltf -I . -o out && ls out/textures
> Secret.png
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote out/out.pov
$ retex-import --exposure 0 below/buffer.gltf -o buffer
! retex-import: error: below/buffer.gltf: the model names the file `below/../F.png`, which is outside of its folder; -I DIR adds folders that may be read
= 2

# A light that is lost. One that is black is none.
$ for m in ambient black; do retex-import --exposure 0 -q $m.dae -o $m; echo $?; done
> 2
> 0
! retex-import: warning: ambient lights are left out
! retex-import: error: ambient.dae: objects, cameras or lights are lost, see above; --partial makes the scene without them
# Images of opacity may be lost as others.
$ retex-import --exposure 0 -q holes.obj -o holes
! retex-import: warning: there is no image `gone.png`
! retex-import: error: holes.obj: 1 image is lost, see above; --partial makes the scene without it
= 2
$ for m in holes holes_torn; do
+     retex-import --exposure 0 -q --partial $m.obj -o $m 2>&1 | grep -c '`.*`'
+     grep -c image_map $m/$m.pov
+ done
> 1
> 1
> 1
> 1
# Damaged images are left out.
$ for m in torn no_image; do
+     retex-import --exposure 0 -q --partial $m.gltf -o $m 2>err
+     echo $?
+     grep -c 'warning: the image .* cannot be read' err
+     grep -c image_map $m/$m.pov
+     ls $m
+ done
> 0
> 1
> 0
> torn-meshes.inc
> torn.pov
> 0
> 1
> 0
> no_image-meshes.inc
> no_image.pov

# Damaged models: one line, and nothing is left.
$ for m in short.glb empty.obj noise.fbx huge.gltf cycle.gltf faces.obj far.obj; do
+     retex-import --exposure 0 $m -o damaged
+     echo $?
+ done
> 2
> 2
> 2
> 2
> 2
> 2
> 2
! retex-import: error: short.glb: its JSON text: premature end of input near '"bufferVi'
! retex-import: error: empty.obj: OBJ-file is too small.
! retex-import: error: noise.fbx: FBX-Parser unexpected end of file
! retex-import: error: huge.gltf: GLTF: Accessor with offset/length (0/4000000000) is out of range.
! retex-import: error: cycle.gltf: its nodes lie within one another more than 4000 deep, or within themselves
! retex-import: error: faces.obj: OBJ: vertex index out of range
! retex-import: error: far.obj: its surfaces reach farther than 1e+15
$ ls -d damaged*
! ls: cannot access 'damaged*': No such file or directory
= 2
$ retex-import --exposure 0 nothing.glb -o damaged
! retex-import: error: cannot read nothing.glb: No such file or directory
= 2

# Too little memory: one line. Which one depends on who notices it first.
$ retex-import --exposure 0 --max-memory 60 large.obj -o little 2>err
= 2
$ grep -c max-memory err
> 1
$ wc -l <err
> 1
$ ls -d little*
! ls: cannot access 'little*': No such file or directory
= 2

# What exists stays.
$ retex-import --exposure 0 card.glb -o own
! retex-import: error: own exists; --force writes into it
= 2
$ echo mine >own/mine.txt
$ retex-import --exposure 0 -q --force card.gltf -o own/ && cat own/mine.txt && head -n 1 own/own.pov && ls -d own*
> mine
> // Made of card.gltf by retex-import 0.1.0.
> own
> own.exr

# A folder of a stranger's archive leads nowhere else, by what it is or by what is in it.
$ mkdir mine theirs && echo mine >mine/theirs.pov && echo mine >mine/Image.png && cp -r mine kept &&
+     ln -s mine link && ln -s ../mine theirs/textures && ln -s ../mine/theirs.pov theirs/theirs.pov
$ for out in link link/ ./link; do retex-import --exposure 0 -q --force card.gltf -o $out; done
! retex-import: error: cannot write into link: it is a link; name the folder that it leads to
! retex-import: error: cannot write into link: it is a link; name the folder that it leads to
! retex-import: error: cannot write into ./link: it is a link; name the folder that it leads to
= 2
$ retex-import --exposure 0 -q --force card.gltf -o theirs
! retex-import: error: cannot write theirs/textures/Image.png: there is a link on the way
= 2
$ diff -r mine kept && rm theirs/textures && ls -d link* theirs*
> link
> theirs
$ retex-import --exposure 0 -q --force card.gltf -o theirs && diff -r mine kept && head -n 1 theirs/theirs.pov && ls -F theirs
> // Made of card.gltf by retex-import 0.1.0.
> textures/
> theirs-meshes.inc
> theirs.pov

$ retex-import --exposure 0 card.glb
! retex-import: error: no output: give a folder to make, -o NAME
= 2
$ retex-import --exposure 0 card.glb -o .
! retex-import: error: -o .: expected the name of a folder to make
= 2
$ retex-import --exposure 0 card.glb -o -
! retex-import: error: -o -: expected the name of a folder to make
= 2
$ retex-import --exposure 0 card.glb -o room.pov
! retex-import: error: -o room.pov: expected the name of a folder to make, without .pov: -o room makes room/room.pov
= 2
$ retex-import --exposure 0 card.glb -f -o rooms/Hall.POV/
! retex-import: error: -o rooms/Hall.POV/: expected the name of a folder to make, without .pov: -o rooms/Hall makes rooms/Hall/Hall.pov
= 2
$ ls -d room*
! ls: cannot access 'room*': No such file or directory
= 2
$ retex-import --exposure 0 -o x
! retex-import: error: no model given
= 2
$ retex-import --exposure 0 - -o x
! retex-import: error: a model is read from a file, for it may name others
= 2
$ retex-import --exposure 0 --up x card.glb -o x
! retex-import: error: --up: expected y or z, not 'x'
= 2
$ retex-import --exposure 0 --camera 2 card.glb -o x
! retex-import: error: --camera 2: the model has 1 camera, the first is Camera_nodes_2
= 2
$ retex-import --exposure 0 --camera 1 card.glb -o x
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote x/x.pov

# A sky. Seen from inside, its left is on the left: the picture's middle is in direction x, its right half towards -z.
$ retex-import --exposure 0 --sky F.png card.glb -o sky && grep sky_sphere sky/sky.pov && ls sky/textures
> sky_sphere { pigment { image_map { png "textures/sky.png" map_type 1 interpolate 2 } scale <-1, 1, 1> } }
> Image.png
> sky.png
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote sky/sky.pov
# Dispersion: n of blue is 1.60825 and of red 1.59175; sheen's roughness by the mean of alpha; a line for what is left
# out.
$ retex-import --exposure 0 -q prism.gltf -o prism
$ grep -o 'interior.*' prism/prism.pov
> interior { ior 1.6 dispersion 1.0198 }
$ retex-import --exposure 0 velvet.gltf -o velvet
! retex-import: warning: images of the reflectance are left out
! retex-import: warning: the material `velvet`: its iridescence is left out
! retex-import: warning: the extension X?[31m is left out
! retex-import: warning: of images of the roughness of sheen, the mean is taken
! retex-import: other views: View_2 from outside, View_3 from outside, View_4 from outside; --camera of retex-render takes one
! retex-import: no light in the model: a soft sky lights it
! retex-import: 1 material, 1 mesh, 2 objects, 2 triangles
! retex-import: wrote velvet/velvet.pov
$ grep -o 'sheen.*' velvet/velvet.pov
> sheen rgb 0.5 sheen_roughness 0.348 } #end
# Integers that do not lie within their buffer are refused.
$ retex-import --exposure 0 -q beyond.glb -o beyond
! retex-import: error: beyond.glb: the numbers of accessors[1], TEXCOORD_0, do not lie within their buffer, or are of a type that glTF does not know there
= 2
$ ls -d beyond
! ls: cannot access 'beyond': No such file or directory
= 2
# What Assimp would misread is the reference too: sparse accessors, strides of zero or with a point, names that are not
# UTF-8 or have NULs, NULs behind the text, chunks behind the others. So are the eighth UV and morph targets
# at weights of the mesh or of its nodes.
$ for m in sparse_words.gltf sparse.gltf stride_zero.gltf stride_point.gltf latin.gltf nul.gltf padded.glb \
+     unaligned.glb chunk_after.glb eighth.gltf morph.gltf morph_nodes.gltf morph_rest.gltf; do
+     look $m
+     same ${m%.*}.exr reference.exr
+ done
$ for m in morph morph_nodes; do
+     retex-diff -q --part normal --fail-abs 0.0005 $m.exr reference.exr || echo $m leans
+ done
# What cannot be read ends in one line.
$ for m in sparse_beyond.gltf stride_huge.gltf longs.gltf comma.gltf chunk_between.glb chunk_before.glb; do
+     retex-import --exposure 0 $m -o odd
+ done
! retex-import: error: sparse_beyond.gltf: the numbers of accessors[1], TEXCOORD_0, do not lie within their buffer, or are of a type that glTF does not know there
! retex-import: error: stride_huge.gltf: the numbers of accessors[1], TEXCOORD_0, do not lie within their buffer, or are of a type that glTF does not know there
! retex-import: error: longs.gltf: the numbers of accessors[1], TEXCOORD_0, do not lie within their buffer, or are of a type that glTF does not know there
! retex-import: error: comma.gltf: its JSON text: string or '}' expected near '}'
! retex-import: error: chunk_between.glb: GLTF: Buffer view with offset/length (80/12) is out of range.
! retex-import: error: chunk_before.glb: No suitable reader found for the file format of file "chunk_before.glb".
= 2
$ ls -d odd*
! ls: cannot access 'odd*': No such file or directory
= 2
# Images that an extension names: WebP and AVIF are read, a line tells of those of KTX2 that are used and have no
# other in their place. What is lost is not told without end.
$ for m in ktx webp; do retex-import --exposure 0 -q --partial $m.gltf -o $m; grep -c image_map $m/$m.pov; done
> 0
> 1
! retex-import: warning: the image `wood.ktx2` of the material `wood` is lost: KTX2 is not read; `npx @gltf-transform/cli ktxdecompress OLD NEW` converts the model
$ look avif.gltf
$ retex-diff -q --part albedo --fail-abs 0.02 avif.exr reference.exr
$ retex-import --exposure 0 -q --safe avif.gltf -o odd
! retex-import: warning: the image `F.avif` cannot be read: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-import: error: avif.gltf: 1 image is lost, see above; --partial makes the scene without it
= 2
# What would shine by it all over is lit in place of that.
$ retex-import --exposure 0 -q --partial ktx_unlit.gltf -o unlit 2>/dev/null
$ grep -c emission unlit/unlit.pov
> 0
= 1
$ retex-import --exposure 0 -q ktx_some.gltf -o odd
! retex-import: warning: the image `a.ktx2` of the materials `bumps`, `materials[2]`, `oak 0`, `oak 1` and 3 more is lost: KTX2 is not read; `npx @gltf-transform/cli ktxdecompress OLD NEW` converts the model
! retex-import: warning: the image `images[3]` of the material `coat` is lost: KTX2 is not read; `npx @gltf-transform/cli ktxdecompress OLD NEW` converts the model
! retex-import: error: ktx_some.gltf: 2 images are lost, see above; --partial makes the scene without them
= 2
$ retex-import --exposure 0 -q gone.gltf -o odd 2>&1 | tail -n 3
> retex-import: warning: there is no image `gone 15.png`
> retex-import: warning: 4 more images are lost
> retex-import: error: gone.gltf: 20 images are lost, see above; --partial makes the scene without them
$ retex-render -q --plain --spp 1 --size 96x72 --crop 40,36,1,1 --aov albedo webp/webp.pov -o red.exr &&
+     oiiotool -q red.exr --subimage albedo -o red.exr && make_values red.exr 0,0 |
+     awk '{ print ($1 > .9 && $2 < .05 && $3 < .05) }'
> 1
# UV that are not there, and a third set of them: a line each.
$ for m in ninth lacking without three; do retex-import --exposure 0 -q $m.gltf -o uv_$m; done
! retex-import: warning: of meshes without the set of UV that their images ask for, the first one is taken
! retex-import: warning: of meshes without the set of UV that their images ask for, the first one is taken
! retex-import: warning: images on meshes without UV show one colour
! retex-import: warning: images of emission with a third set of UV are left out
! retex-import: warning: normal maps with a third set of UV are left out
# A camera of 3DS, z up, rolled: up is z turned by a quarter about k = (2, 3, -6) / 7, k x z + k (k.z), (9, -32, 36) / 49.
$ retex-import --exposure 0 -q rolled.3ds -o rolled && grep '  sky\|  look_at' rolled/rolled.pov
>   sky <0.1836735, 0.7346939, -0.6530612>
>   look_at <0.2857143, -0.8571429, 0.4285714>
>   look_at <0.5, 0.5, 0>
>   look_at <0.5, 0.5, 0>
>   look_at <0.5, 0.5, 0>
>   look_at <0.5, 0.5, 0>
# Lights of 3DS, z up: half of the angles of the cones, and the direction of the spot, (0, .6, -.8), as the file has it.
$ retex-import --exposure 0 -q lights.3ds -o lights
$ grep light_source lights/lights.pov
> light_source { <1, 3, 2>, rgb <2, 1, 0.5> }
> light_source { <-4, 5, 0>, rgb <0.25, 0.5, 1> spotlight radius 15 falloff 25 point_at <-4, 4.2, 0.6> }
