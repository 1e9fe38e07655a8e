# Limits: what a scene, a picture or a set may take. What ends at one says which option raises it.
$ cp "$TESTS/../data/white-6000.png" big.png
$ cp -r "$SCENES/cornell-box" .
$ make_set set.exr 64 48
$ echo 'sphere{0,1} light_source{-9*z rgb 1} camera{location -3*z look_at 0}' >ball.pov

# Steps, of walks over a scene too.
$ echo '#while(1) #end' >endless.pov; retex-render --max-steps 100000 endless.pov -o x.exr
! retex-render: error: endless.pov:1:9: the scene takes more than the 100000 steps of --max-steps; is a loop endless?
= 2
$ printf '%s\n' '#declare O=union{#for(I,1,1000) sphere{I*x,.4} #end}' \
+     '#for(I,1,1000) #declare P=min_extent(O); #declare P=max_extent(O); #end' >extent.pov
$ retex-render --max-steps 200000 extent.pov -o x.exr
! retex-render: error: extent.pov:2:64: the scene takes more than the 200000 steps of --max-steps; is a loop endless?
= 2
$ {
+     echo '#declare O=union{}'
+     for k in $(seq 24); do echo '#declare O=union{object{O} object{O}}'; done
+     echo 'object{O}'
+ } >nothing.pov
$ retex-render --max-steps 1000000 nothing.pov -o x.exr
! retex-render: error: nothing.pov:26:9: the scene takes more than the 1000000 steps of --max-steps; is a loop endless?
= 2
$ (
+     head -c 4000000 /dev/zero | tr '\0' ' '
+     echo '// nothing'
+ ) >blank.inc
$ echo '#while(1) #include "blank.inc" #end' >include.pov
$ retex-render --max-steps 1000000 include.pov -o x.exr
! retex-render: error: include.pov:1:9: the scene takes more than the 1000000 steps of --max-steps; is a loop endless?
= 2
$ awk 'BEGIN {
+     print "polygon { 4001"
+     for (i = 0; i < 4000; i++)
+         print "<" (i * 7919) % 4001 "," (i * i * 31) % 4001 ">,"
+     print "<0,0> }"
+ }' >polygon.pov
$ retex-render --max-steps 1000000 polygon.pov -o x.exr
! retex-render: error: polygon.pov:4002:7: the scene takes more than the 1000000 steps of --max-steps; is a loop endless?
= 2
$ RETEX_MAX_STEPS=1000 retex-render endless.pov -o x.exr
! retex-render: error: endless.pov:1:9: the scene takes more than the 1000 steps of --max-steps; is a loop endless?
= 2
$ RETEX_MAX_STEPS=x retex-render endless.pov -o x.exr
! retex-render: error: RETEX_MAX_STEPS: expected a whole number from 1, not 'x'
= 2
$ RETEX_MAX_STEPS=10 retex-render -q --max-steps 100000 --size 8x6 --spp 1 ball.pov -o x.exr && rm x.exr

# Memory: of the scene, of what is built of it, of images before they are decoded, of the film.
$ {
+     echo '#declare O=sphere{0,.1}'
+     echo '#for(I,1,22) #declare O=union{object{O translate x*pow(2,I)} object{O translate -x*pow(2,I)}} #end'
+     echo 'object{O}'
+ } >parts.pov
$ make_peak peak retex-render --max-memory 300M parts.pov -o x.exr
! retex-render: error: parts.pov:3:9: the scene takes more than the 300 MB of --max-memory
= 2
$ awk '{ print ($1 < 400 ? "little" : $1) }' peak
> little
$ echo '#declare A=array[300000000]' >array.pov; retex-render --max-memory 1G array.pov -o x.exr
! retex-render: error: array.pov:1:27: the scene takes more than the 1024 MB of --max-memory
= 2
$ awk 'function texture(n) { return "texture { pigment { rgb <." n ",1,0> } }" }
+ BEGIN {
+     print "camera { location -9*z look_at 0 } light_source { -9*z, 1 }"
+     for (i = 0; i < 10000; i++) {
+         printf "mesh2 { vertex_vectors { 3, <%d,0,0>,<%d,1,0>,<%d,0,1> } ", i, i, i
+         printf "texture_list { 3, %s,%s,%s } ", texture(i % 5), texture(i % 3), texture(i % 7)
+         print "face_indices { 1, <0,1,2>,0,1,2 } }"
+     }
+ }' >molecule.pov
$ nm -D "$(dirname "$(command -v retex-diff)")/../lib/libretex.so.2" | grep -q 'asan\|tsan' && echo 4G >room || echo 47M >room
$ retex-render -q --plain --max-memory $(cat room) --threads 1 --spp 1 --size 8x6 molecule.pov -o x.exr && rm x.exr
# Equal colours are kept once; others stay what they are, as in patterns.
$ cat >colors.pov <<'END'
+ camera { orthographic location <19.5,19.5,-9> right 40*x up 40*y direction z }
+ #for (I, 0, 39)
+     #for (J, 0, 39)
+         #declare C = rgb <I/40,J/40,.5>;
+         box {
+             <I-.5,J-.5,0>, <I+.5,J+.5,1>
+             pigment { #if (Pattern) gradient x color_map { [0 C] [1 C] } #else C #end }
+         }
+     #end
+ #end
+ END
$ for p in 0 1; do
+     retex-render -q --plain --spp 1 --size 40x40 --ambient --aov albedo -D Pattern=$p colors.pov \
+         -o colors-$p.exr 2>&1 | grep -v black
+ done
= 1
$ retex-diff -q --part albedo --fail-abs 0.0001 colors-0.exr colors-1.exr
$ printf '%s\n' '#for(I,0,N-1) sphere{I*x,1 pigment{image_map{png "big.png"}}} #end' >image.pov
$ make_peak peak retex-render --max-memory 500M -D N=1 image.pov -o x.exr
! retex-render: error: image.pov:2:1: image.pov:1: image_map: big.png: the picture is too large: 6000 x 6000 pixels, more than --max-memory has room for
= 2
$ awk '{ print ($1 < 200 ? "little" : $1) }' peak
> little
$ for t in "retex-sample set.exr -o x.exr" "retex-combine set.exr -o x.png"; do
+     make_peak peak $t --max-memory 300M --texture floor=big.png
+     awk '{ print ($1 < 200 ? "little" : $1) }' peak
+ done
> little
> little
! retex-sample: error: big.png: the picture is too large: 6000 x 6000 pixels, more than --max-memory has room for
! retex-combine: error: big.png: the picture is too large: 6000 x 6000 pixels, more than --max-memory has room for
$ retex-render --max-memory 300M --replace floor=big.png cornell-box/cornell-box.pov -o x.exr
! retex-render: error: big.png: the picture is too large: 6000 x 6000 pixels, more than --max-memory has room for
= 2
$ retex-render -q --max-memory 2G --size 8x6 --spp 1 --replace floor=big.png cornell-box/cornell-box.pov -o x.exr &&
+     rm x.exr
$ retex-render --max-memory 100M --max-pixels 1000000000 --size 20000x20000 --plain --spp 1 ball.pov -o x.exr 2>err
= 2
$ sed 's/[0-9.]* GB/N GB/; s/are [0-9.]*:/are N:/' err
> retex-render: error: 20000x20000 pixels need N GB of memory, there are N: render parts with --crop, or raise --max-memory
$ make_set large.exr 1000 1000 footprints denoise
$ for t in "retex-denoise large.exr -o x.exr" "retex-pack --lossless large.exr -o x.retex" \
+     "retex-diff large.exr large.exr"; do
+     make_peak peak $t --max-memory 60M
+     awk '{ print ($1 < 160 ? "little" : $1) }' peak
+ done
> little
> little
> little
! retex-denoise: error: out of memory: this takes more than the 60 MB of --max-memory
! retex-pack: error: out of memory: this takes more than the 60 MB of --max-memory
! retex-diff: error: out of memory: this takes more than the 60 MB of --max-memory

# Pixels.
$ retex-render --max-pixels 1000 --size 100x100 ball.pov -o x.exr
! retex-render: error: 100x100 pixels are more than the 1000 of --max-pixels
= 2
$ retex-render -q --max-pixels 1000 --size 100x100 --crop 0,0,10,10 --spp 1 ball.pov -o x.exr && rm x.exr
$ retex-combine --max-pixels 5000 set.exr --texture floor=big.png -o x.png
! retex-combine: error: big.png: the picture is too large: 6000 x 6000 pixels, more than the 5000 of --max-pixels
= 2
$ retex-render --max-pixels 5000 --size 8x6 image.pov -D N=1 -o x.exr
! retex-render: error: image.pov:2:1: image.pov:1: image_map: big.png: the picture is too large: 6000 x 6000 pixels, more than the 5000 of --max-pixels
= 2
$ retex-diff --max-pixels 5000 big.png big.png
! retex-diff: error: big.png: the picture is too large: 6000 x 6000 pixels, more than the 5000 of --max-pixels
= 2
$ for t in "retex-info set.exr" "retex-combine set.exr -o x.png" \
+     "retex-sample set.exr --texture floor=rgb(1,0,0) -o x.exr" "retex-denoise set.exr -o x.exr" \
+     "retex-pack set.exr -o x.retex"; do
+     $t --max-pixels 3071
+ done
! retex-info: error: set.exr is too large: 64 x 48 pixels, more than the 3071 of --max-pixels
! retex-combine: error: set.exr is too large: 64 x 48 pixels, more than the 3071 of --max-pixels
! retex-sample: error: set.exr is too large: 64 x 48 pixels, more than the 3071 of --max-pixels
! retex-denoise: error: set.exr is too large: 64 x 48 pixels, more than the 3071 of --max-pixels
! retex-pack: error: set.exr is too large: 64 x 48 pixels, more than the 3071 of --max-pixels
= 2

# Time: reading, building, rendering, and what comes after. Finished rows are kept.
$ retex-render --max-time 0.5 --max-steps 1000000000000 endless.pov -o x.exr
! retex-render: error: not done within the 0.5 s of --max-time
= 2
$ retex-render -q --max-time 1 --spp 1000000 cornell-box/cornell-box.pov -o x.exr
! retex-render: error: not done within the 1 s of --max-time
= 2
$ echo 'exec retex-render -q --threads 1 --size 16x4096 -t floor cornell-box/cornell-box.pov "$@"' >long
$ chmod +x long
$ ./long --spp 8 -o long.exr
$ for o in --resume ''; do
+     for t in 1 2 4 8 16 32; do
+         ./long $o --spp 512 --max-time $t -o i.exr 2>err
+         ! grep -q bands err || break
+     done
+     sed 's/[0-9]* of 256/N of 256/; s/[0-9]* s of/T s of/' err
+     rm i.exr.partial
+ done
> retex-render: error: not done within the T s of --max-time; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
> retex-render: error: not done within the T s of --max-time; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
$ t=2; until ./long --resume --spp 8 --max-time $t -o i.exr 2>/dev/null; do t=$((t + 1)); done
$ cmp i.exr long.exr; rm i.exr; ls i.*
! ls: cannot access 'i.*': No such file or directory
= 2

$ for t in "retex-denoise --radius 10 large.exr -o x.exr" "retex-pack large.exr -o x.retex"; do $t --max-time 0.3; done
! retex-denoise: error: not done within the 0.3 s of --max-time
! retex-pack: error: not done within the 0.3 s of --max-time
= 2
$ sleep 5 | retex-combine - -o x.png --max-time 0.3
! retex-combine: error: not done within the 0.3 s of --max-time
= 2

# What gives bytes without end is not read to its end: devices, and pipes of what is no picture and no set.
$ for f in /dev/zero /dev/urandom /dev/full; do
+     timeout 20 retex-combine set.exr --texture floor=$f -o x.png
+     timeout 20 retex-combine $f -o x.png
+     timeout 20 retex-diff $f set.exr
+ done
! retex-combine: error: cannot read /dev/zero: it is a device
! retex-combine: error: cannot read /dev/zero: it is a device
! retex-diff: error: cannot read /dev/zero: it is a device
! retex-combine: error: cannot read /dev/urandom: it is a device
! retex-combine: error: cannot read /dev/urandom: it is a device
! retex-diff: error: cannot read /dev/urandom: it is a device
! retex-combine: error: cannot read /dev/full: it is a device
! retex-combine: error: cannot read /dev/full: it is a device
! retex-diff: error: cannot read /dev/full: it is a device
= 2
$ yes | timeout 20 retex-info -
! retex-info: error: standard input is not a set: neither an OpenEXR file nor a pack
= 2
$ timeout 20 retex-combine - -o x.png </dev/zero
! retex-combine: error: cannot read standard input: it is a device
= 2
$ yes '#' | timeout 20 retex-combine set.exr --batch -
! retex-combine: error: -: more than the 64 MB that a table may have
= 2
$ timeout 20 retex-render /dev/zero -o x.exr
! retex-render: error: /dev/zero: cannot read `/dev/zero`: it is a device or a pipe
= 2
$ retex-info - </dev/null
! retex-info: error: standard input is not a set: it is empty
= 2
$ retex-info - <set.exr | head -1
> layout         paper
$ cat set.exr | retex-info - | head -1
> layout         paper

# What is no limit.
$ for o in "--max-memory 0" "--max-memory much" "--max-memory 1GB" "--max-time 0" "--max-time -1" "--max-pixels 0" \
+     "--max-pixels 1e6" "--max-steps 1.5"; do
+     retex-render $o ball.pov -o x.exr
+ done
! retex-render: error: --max-memory: expected a size such as 512M, 4G or a number of MB, not '0'
! retex-render: error: --max-memory: expected a size such as 512M, 4G or a number of MB, not 'much'
! retex-render: error: --max-memory: expected a size such as 512M, 4G or a number of MB, not '1GB'
! retex-render: error: --max-time: expected a number of seconds, not '0'
! retex-render: error: --max-time: expected a number of seconds, not '-1'
! retex-render: error: --max-pixels: expected a whole number from 1, not '0'
! retex-render: error: --max-pixels: expected a whole number from 1, not '1e6'
! retex-render: error: --max-steps: expected a whole number from 1, not '1.5'
= 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# --safe sets 2 GB, 60 s and the pixels of an 8K picture, unless others are given, in any order and in the environment.
$ s='#declare S = "x"; #for (I, 1, 20) #declare S = concat(S, S); #end'
+ echo "$s #declare A = array[10000]; #for (I, 0, 9999) #declare A[I] = concat(S, \"\"); #end" >strings.pov
$ echo '#declare A = array[1000]; #for (I, 0, 999) #declare A[I] = array[100000]; #end' >arrays.pov
# The process reaches the limit with what it holds beside the scene: the first to notice says so.
$ for f in strings arrays; do
+     {
+         make_peak peak retex-render --safe --plain $f.pov -o x.exr
+         retex-render --safe --max-memory 300M --plain $f.pov -o x.exr
+         RETEX_SAFE=1 RETEX_MAX_MEMORY=200M retex-render --plain $f.pov -o x.exr
+         echo $?
+     } 2>&1 | sed 's/error: out of memory: this/error: '$f.pov:1:1:' the scene/; s/1:[0-9]*:/1:N:/'
+     awk '{ print ($1 < 2200 ? "below the limit" : $1) }' peak
+ done
> retex-render: error: strings.pov:1:N: the scene takes more than the 2048 MB of --max-memory
> retex-render: error: strings.pov:1:N: the scene takes more than the 300 MB of --max-memory
> retex-render: error: strings.pov:1:N: the scene takes more than the 200 MB of --max-memory
> 2
> below the limit
> retex-render: error: arrays.pov:1:N: the scene takes more than the 2048 MB of --max-memory
> retex-render: error: arrays.pov:1:N: the scene takes more than the 300 MB of --max-memory
> retex-render: error: arrays.pov:1:N: the scene takes more than the 200 MB of --max-memory
> 2
> below the limit
$ for o in '--safe' '--safe --max-pixels 40000000' '--max-pixels 268435456 --safe' ''; do
+     retex-render -q $o --plain --spp 1 --max-time 0.1 --size 7680x4321 ball.pov -o x.exr 2>&1 | cut -c-60
+     rm -f x.exr.partial
+ done
> retex-render: error: 7680x4321 pixels are more than the 3317
> retex-render: error: not done within the 0.1 s of --max-time
> retex-render: error: not done within the 0.1 s of --max-time
> retex-render: error: not done within the 0.1 s of --max-time
$ RETEX_SAFE=1 retex-render --plain --max-time 1 --size 7680x4321 ball.pov -o x.exr
! retex-render: error: 7680x4321 pixels are more than the 33177600 of --max-pixels
= 2
$ RETEX_MAX_PIXELS=33180000 retex-render --safe --plain --max-time 1 --size 7680x4321 ball.pov -o x.exr
! retex-render: error: 7680x4321 pixels are more than the 33180000 of --max-pixels
= 2
$ RETEX_SAFE=1 retex-combine set.exr --texture floor=big.png -o x.png
! retex-combine: error: big.png: the picture is too large: 6000 x 6000 pixels, more than the 33177600 of --max-pixels
= 2
