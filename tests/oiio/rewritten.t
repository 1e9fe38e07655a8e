# Sets that another program wrote anew, in other compressions and in tiles, are the same sets: their checksums are those
# of values. What is damaged in them is seen by who reads all and who reads row by row, tiles of any height.
$ make_set s.exr 64 72 footprints denoise
$ retex-combine -q s.exr --texture 'Floor=rgb(1,0.5,0.2)' -o s.png
$ for c in none rle zips zip piz; do oiiotool s.exr --compression $c -o $c.exr; done
$ for t in 32x32 20x24 9x11 64x72; do oiiotool s.exr --tile ${t%x*} ${t#*x} --compression none -o t$t.exr; done
$ for f in none rle zips zip piz t*; do
+     retex-info --check ${f%.exr}.exr
+     retex-combine -q ${f%.exr}.exr --texture 'Floor=rgb(1,0.5,0.2)' -o x.png
+     cmp s.png x.png
+ done
> none.exr: ok
> rle.exr: ok
> zips.exr: ok
> zip.exr: ok
> piz.exr: ok
> t20x24.exr: ok
> t32x32.exr: ok
> t64x72.exr: ok
> t9x11.exr: ok
$ for f in none piz t32x32 t20x24 t9x11 t64x72; do make_bandless <$f.exr >bandless-$f.exr; done
$ for f in bandless-*; do
+     retex-info --check $f
+     retex-combine -q $f --texture 'Floor=rgb(1,0.5,0.2)' -o x.png
+     cmp s.png x.png
+ done
> bandless-none.exr: ok
> bandless-piz.exr: ok
> bandless-t20x24.exr: ok
> bandless-t32x32.exr: ok
> bandless-t64x72.exr: ok
> bandless-t9x11.exr: ok
$ rm x.png
% # FILE with two other bytes, AT bytes from its beginning: how those who read it end.
% damaged() {
%     cp $1 d.exr
%     printf 'XY' | dd of=d.exr bs=1 seek=$2 conv=notrunc 2>/dev/null
%     retex-info --check d.exr 2>>err
%     info=$?
%     retex-pack -q --lossless d.exr -o x.retex 2>>err
%     pack=$?
%     retex-denoise -q --memory 1 d.exr -o x.exr 2>>err
%     echo $info $pack $?
% }
$ for f in none t32x32 t20x24 t9x11 t64x72; do
+     at=$(($(wc -c <$f.exr) - 250000))
+     damaged $f.exr $at
+     damaged bandless-$f.exr $at
+ done
> 1 2 2
> 1 2 2
> 1 2 2
> 1 2 2
> 1 2 2
> 1 2 2
> 1 2 2
> 1 2 2
> 1 2 2
> 1 2 2
$ sort err | uniq -c | sed 's/^ *//'
> 8 retex-denoise: error: d.exr: the checksum of part guide_normal is wrong
> 2 retex-denoise: error: d.exr: the checksum of part noise_Wall_sharp is wrong
> 8 retex-info: error: d.exr: the checksum of part guide_normal is wrong
> 2 retex-info: error: d.exr: the checksum of part noise_Wall_sharp is wrong
> 8 retex-pack: error: d.exr: the checksum of part guide_normal is wrong
> 2 retex-pack: error: d.exr: the checksum of part noise_Wall_sharp is wrong
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2
