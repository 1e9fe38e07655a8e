# retex-render --mattes: masks of targets and Cryptomatte, decoded by a reader of our own.
$ skip-unless /usr/bin/python3 -c 'import numpy, OpenImageIO'

# The file: one part, metadata and manifests as the specification has them, largest coverage first.
% # What mattes.py says of a file: mattes WHAT FILE …
% mattes() { /usr/bin/python3 "$TESTS/mattes.py" "$@"; }
$ retex-render -q --size 64x48 --spp 64 -t Floor -t Wall -t Gauze -t Glass "$TESTS/mattes.pov" --mattes m.exr -o set.exr
$ mattes layout m.exr
> parts 1 channels 64 of Cryptomatte 48 floats True
> CryptoObject MurmurHash3_32 uint32_to_float32 manifest True ids known True ranked True
> CryptoMaterial MurmurHash3_32 uint32_to_float32 manifest True ids known True ranked True
> CryptoThroughObject MurmurHash3_32 uint32_to_float32 manifest True ids known True ranked True
> CryptoThroughMaterial MurmurHash3_32 uint32_to_float32 manifest True ids known True ranked True
$ for k in CryptoObject CryptoMaterial; do mattes names m.exr $k; done
> #7 Back Ball Cut Grid Ground Pane Pole Twin Veil
> #7 Core Floor Gauze Glass Lattice Polished Rust Shell Steel Twin Wall

# Seen directly, masks and the rest are the whole picture; nothing is more than whole, through glass and in mirrors
# neither.
$ mattes sums m.exr
> direct True
> CryptoObject at most 1.000000
> CryptoMaterial at most 1.000000
> CryptoThroughObject at most 1.000000
> CryptoThroughMaterial at most 1.000000
> target at most 1.000000
> layers over black 60 dB

# The matte of an object, and of a texture, is the picture of the scene in which it shines and all else is black: with
# two textures, copied, without a name, half clear, with holes, and where textures change into each other.
% # A picture NAME.exr of the scene in which what has the name alone shines: shining NAME OPTION…
% shining() {
%     name=$1
%     shift
%     retex-render -q --size 64x48 --plain -D "Emit=\"$name\"" "$@" "$TESTS/mattes.pov" -o "$name.exr"
% }
$ for n in Ground Back Cut Twin lone Veil Grid Pole; do
+     shining $n --spp 64 -D Direct=1
+     case $n in lone) object='#7' ;; *) object=$n ;; esac
+     echo $n.exr CryptoObject/$object
+ done >pairs
$ mattes same m.exr 80 $(cat pairs)
> CryptoObject/Ground same
> CryptoObject/Back same
> CryptoObject/Cut same
> CryptoObject/Twin same
> CryptoObject/#7 same
> CryptoObject/Veil same
> CryptoObject/Grid same
> CryptoObject/Pole same
$ for n in Floor Wall Shell Core Gauze Lattice Rust Steel; do
+     shining $n --spp 64 -D Direct=1
+     echo $n.exr CryptoMaterial/$n
+     case $n in Floor | Wall | Gauze) echo $n.exr mask_$n ;; esac
+ done >pairs
$ mattes same m.exr 80 $(cat pairs)
> CryptoMaterial/Floor same
> mask_Floor same
> CryptoMaterial/Wall same
> mask_Wall same
> CryptoMaterial/Shell same
> CryptoMaterial/Core same
> CryptoMaterial/Gauze same
> mask_Gauze same
> CryptoMaterial/Lattice same
> CryptoMaterial/Rust same
> CryptoMaterial/Steel same

# The same with what is seen through glass and in mirrors, up to the picture's noise.
$ for n in Floor Wall Gauze; do
+     shining $n --spp 256
+     echo $n.exr mask_$n+mask_${n}_transmitted+mask_${n}_reflected
+     echo $n.exr CryptoThroughMaterial/$n
+ done >pairs
$ mattes same m.exr 48 $(cat pairs)
> mask_Floor+mask_Floor_transmitted+mask_Floor_reflected same
> CryptoThroughMaterial/Floor same
> mask_Wall+mask_Wall_transmitted+mask_Wall_reflected same
> CryptoThroughMaterial/Wall same
> mask_Gauze+mask_Gauze_transmitted+mask_Gauze_reflected same
> CryptoThroughMaterial/Gauze same
$ for n in Ground Cut Twin; do
+     shining $n --spp 256
+     echo $n.exr CryptoThroughObject/$n
+ done >pairs
$ mattes same m.exr 48 $(cat pairs)
> CryptoThroughObject/Ground same
> CryptoThroughObject/Cut same
> CryptoThroughObject/Twin same

# Behind glass and in mirrors apart, by what is seen first.
$ mattes where m.exr mask_Floor_transmitted Pane
> mask_Floor_transmitted only in Pane True
$ mattes where m.exr mask_Floor_reflected Pane Ball
> mask_Floor_reflected only in Pane Ball True

# By the picture's lens and filter.
$ retex-render -q --size 64x48 --spp 64 -D Lens=1 --filter gaussian "$TESTS/mattes.pov" --mattes l.exr -o p.exr
$ for n in Ground Cut; do
+     shining $n --spp 64 -D Lens=1 --filter gaussian -D Direct=1
+     echo $n.exr CryptoObject/$n
+ done >pairs
$ mattes same l.exr 80 $(cat pairs)
> CryptoObject/Ground same
> CryptoObject/Cut same

# The same for every number of threads, and in the pieces of a crop; nothing else changes.
$ for n in 1 5; do
+     retex-render -q --threads $n --size 40x30 --spp 4 -t Floor "$TESTS/mattes.pov" --mattes t$n.exr -o s$n.exr
+ done
$ cmp t1.exr t5.exr
$ retex-render -q --size 40x30 --spp 4 -t Floor "$TESTS/mattes.pov" -o s.exr
$ cmp s.exr s1.exr
$ retex-render -q --size 40x30 --spp 4 -t Floor --crop 10,5,20,20 "$TESTS/mattes.pov" --mattes crop.exr -o s3.exr
$ oiiotool t1.exr --cut 20x20+10+5 --fullpixels -o cut.exr
$ oiiotool --diff crop.exr cut.exr | tail -1
> PASS

# With frames, and ranks of its own: names beyond them are lost.
$ retex-render -q --size 40x30 --spp 4 --plain --frames 1-2 --matte-ranks 1 "$TESTS/mattes.pov" --mattes f%d.exr \
+     -o f%d.png
$ mattes layout f2.exr | sed -n 1p
> parts 1 channels 20 of Cryptomatte 16 floats True
$ retex-render -q --size 40x30 --spp 4 --plain --matte-ranks 9 "$TESTS/mattes.pov" --mattes r.exr -o r.png
$ mattes layout r.exr | sed -n 1p
> parts 1 channels 84 of Cryptomatte 80 floats True
$ ls f*.exr
> f1.exr
> f2.exr

# Names as the scene says them, beyond ASCII; without targets there is the rest.
$ cat >names.pov <<'END'
+ camera{location -5*z} light_source{<2,5,-9>,1} #ifdef (Retex) global_settings{retex_names{"Ball" "Bäll (1)"}} #end
+ #declare Ball=sphere{0,1 pigment{rgb .5}} object{Ball}
+ END
$ retex-render -q --size 16x12 --spp 4 --plain names.pov --mattes n.exr -o n.png
$ mattes names n.exr CryptoObject
> Bäll (1)
$ mattes sums n.exr | sed -n 1p
> direct True

# Names of compounds, copies, and textures that were named again: the innermost of objects, the outermost of textures.
$ cat >names.pov <<'END'
+ camera{location -9*z} light_source{<2,5,-9>,1}
+ #declare P=pigment{rgb .5}
+ #declare Oak=texture{pigment{P}}
+ #declare Planks=texture{Oak scale 2}
+ #declare Raw=texture{pigment{rgb .3}}
+ #declare Sawn=texture{Raw scale 3}
+ #declare Leg=cylinder{-y,y,.5 texture{Planks}}
+ #declare Chair=union{object{Leg translate -2*x} sphere{2*x,1 texture{Sawn}} box{-.5,.5 pigment{P}}}
+ object{Chair}
+ #declare Top=texture{Raw}
+ texture{pigment{rgbt .5}}
+ sphere{2*y,.5 texture{Top}}
+ END
$ retex-render -q --size 32x24 --spp 4 --plain names.pov --mattes n.exr -o n.png
$ for k in CryptoObject CryptoMaterial; do mattes names n.exr $k; done
> #4 Chair Leg
> P Planks Sawn Top

# Within a closed room a ray ends somewhere, however often it divides in glass.
$ cat >room.pov <<'END'
+ camera{location -4*z} light_source{<0,3,-3>,1}
+ #declare Room=box{-5,5 pigment{rgb .5}}
+ object{Room}
+ #declare Glass=sphere{-x,1 pigment{rgbt 1} finish{diffuse 0 reflection{0,1 fresnel}} interior{ior 1.5}}
+ object{Glass} object{Glass translate 2*x}
+ #declare Chrome=box{<-1,-2,0>,<1,-1.2,1> pigment{rgb .1} finish{diffuse .1 reflection .7}}
+ object{Chrome}
+ END
$ retex-render -q --size 32x24 --spp 4 --plain room.pov --mattes n.exr -o n.png
$ for k in CryptoObject CryptoThroughObject CryptoThroughMaterial; do
+     mattes whole n.exr $k
+ done
> CryptoObject whole True
> CryptoThroughObject whole True
> CryptoThroughMaterial whole True

# A file says whether it has names of more than 31 bytes.
$ retex-render -q --size 16x12 --spp 4 --plain -t A_name_of_many_bytes=P names.pov --mattes long.exr -o n.png
$ for f in n long; do od -An -tx1 -j4 -N4 $f.exr; done
>  02 00 00 00
>  02 04 00 00

# What cannot be.
$ cp "$TESTS/mattes.pov" s.pov
$ retex-render s.pov --mattes m.png -o x.exr
! retex-render: error: --mattes writes OpenEXR: expected a name that ends in .exr, not `m.png`
= 2
$ retex-render s.pov --mattes a.exr -o a.exr
! retex-render: error: a.exr: the output and the file of --mattes are the same file
= 2
$ retex-render s.pov --mattes s.pov -o a.exr
! retex-render: error: --mattes writes OpenEXR: expected a name that ends in .exr, not `s.pov`
= 2
$ retex-render s.pov --mattes nowhere/a.exr -o x.exr
! retex-render: error: cannot write nowhere/a.exr: No such file or directory
= 2
$ retex-render s.pov --matte-ranks 4 -o x.exr
! retex-render: error: --matte-ranks is of the file that --mattes writes
= 2
$ retex-render s.pov --mattes a.exr --matte-ranks 33 -o x.exr
! retex-render: error: --matte-ranks: expected 1 to 32, not `33`
= 2
$ retex-render s.pov --mattes a.exr --list-targets
! retex-render: error: --mattes cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants or --control
= 2
$ retex-render -t Floor -t Floor_reflected=Wall s.pov --mattes a.exr -o x.exr
! retex-render: error: two masks would be the channel mask_Floor_reflected.R: give one target another name
= 2
$ retex-render s.pov --frames 1-2 --mattes a.exr -o x%d.exr
! retex-render: error: --mattes: 2 frames need a number in the name, as name-%04d.exr, not `a.exr`
= 2
$ ls a.exr x.exr
! ls: cannot access 'a.exr': No such file or directory
! ls: cannot access 'x.exr': No such file or directory
= 2
