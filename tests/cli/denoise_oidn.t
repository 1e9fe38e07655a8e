# retex-denoise with Open Image Denoise, for which a stand-in answers: see tests/oidn/stand_in.c.
$ make_set s.exr 64 48 denoise
$ retex-denoise -q s.exr -o nlm.exr
$ retex-denoise -q --denoiser nlm s.exr -o x.exr
$ cmp nlm.exr x.exr
$ ln -s "$(dirname "$(command -v make_set)")"/../oidn/* .
$ ls *.so*
> libOpenImageDenoise.so.2
> older.so
$ for d in oidn both; do
+     RETEX_OIDN=./libOpenImageDenoise.so.2 retex-denoise -q --denoiser $d s.exr -o $d.exr
+     retex-info --check $d.exr
+     retex-info $d.exr | grep '^denoised'
+     cmp -s nlm.exr $d.exr && echo $d is nlm
+ done
> oidn.exr: ok
> denoised       yes
> both.exr: ok
> denoised       yes
= 1
$ cmp -s oidn.exr both.exr
= 1

# It is found by its usual names, that of version 2 first.
$ LD_LIBRARY_PATH=. retex-denoise -q --denoiser oidn s.exr -o x.exr
$ cmp oidn.exr x.exr
$ mkdir lib
$ cp -L libOpenImageDenoise.so.2 lib/libOpenImageDenoise.so
$ LD_LIBRARY_PATH=lib retex-denoise -q --denoiser oidn s.exr -o x.exr
$ cmp oidn.exr x.exr
$ cp -L older.so lib/libOpenImageDenoise.so
$ LD_LIBRARY_PATH=lib:. retex-denoise -q --denoiser oidn s.exr -o x.exr
$ cmp oidn.exr x.exr
$ RETEX_OIDN= LD_LIBRARY_PATH=. retex-denoise -q --denoiser oidn s.exr -o x.exr
$ cmp oidn.exr x.exr

# For every number of threads, in memory or not, under --safe, and from a pack: the same bits.
$ export RETEX_OIDN=./libOpenImageDenoise.so.2
+ for o in '--threads 1' '--threads 7' --safe '--memory 0'; do
+     retex-denoise -q --denoiser oidn s.exr $o -o x.exr
+     cmp oidn.exr x.exr
+ done
$ export RETEX_OIDN=./libOpenImageDenoise.so.2
+ make_set l.exr 40 250 footprints denoise
+ retex-pack -q --lossless l.exr -o l.retex
+ for d in oidn both; do
+     retex-denoise -q --denoiser $d l.exr -o a.exr
+     for i in l.exr l.retex; do
+         retex-denoise -q --denoiser $d --memory 0 $i -o b.exr
+         cmp a.exr b.exr
+     done
+ done
+ rm l.* a.exr b.exr

# What goes wrong is one line, and the output stays as it is.
$ cp nlm.exr x.exr
$ RETEX_OIDN=./absent.so retex-denoise --denoiser oidn s.exr -o x.exr
! retex-denoise: error: Open Image Denoise 2 cannot be loaded: ./absent.so: cannot open shared object file: No such file or directory
= 2
$ RETEX_OIDN=./older.so retex-denoise --denoiser both s.exr -o x.exr
! retex-denoise: error: ./older.so has no oidnSetFilterInt: Open Image Denoise 2 is needed
= 2
$ export RETEX_OIDN=./libOpenImageDenoise.so.2
+ for w in no-device nothing version-1 device no-filter commit filter silent memory nan infinite; do
+     for m in '' '--memory 0'; do
+         OIDN_STAND_IN=$w retex-denoise --denoiser oidn s.exr $m -o x.exr
+         test $? = 2 || echo $w $m
+     done
+ done 2>&1 | uniq -c | sed 's/^ *//'
> 2 retex-denoise: error: Open Image Denoise failed: unsupported hardware
> 2 retex-denoise: error: Open Image Denoise makes no device
> 2 retex-denoise: error: Open Image Denoise is of version 1: version 2 is needed
> 2 retex-denoise: error: Open Image Denoise failed: the device is broken
> 2 retex-denoise: error: Open Image Denoise failed: unknown filter type
> 2 retex-denoise: error: Open Image Denoise failed: the filter is broken
> 2 retex-denoise: error: Open Image Denoise failed: the network is broken
> 2 retex-denoise: error: Open Image Denoise failed: it does not say why
> 2 retex-denoise: error: Open Image Denoise failed: out of memory
> 4 retex-denoise: error: the result of Open Image Denoise has a number that is not finite
$ RETEX_OIDN=./libOpenImageDenoise.so.2 OIDN_STAND_IN=slow retex-denoise --denoiser oidn --max-time 0.4 s.exr -o x.exr
! retex-denoise: error: not done within the 0.4 s of --max-time
= 2
$ cmp nlm.exr x.exr
$ ls -A
> both.exr
> lib
> libOpenImageDenoise.so.2
> nlm.exr
> oidn.exr
> older.so
> s.exr
> x.exr
$ retex-denoise s.exr -o x.exr --denoiser OIDN
! retex-denoise: error: --denoiser: expected nlm, oidn or both, not 'OIDN'
= 2
$ retex-denoise --complete --denoiser '' | cut -f1
> nlm
> oidn
> both

# Lamps are filtered each for itself: a lamp alone stays what it is.
$ retex-render -q --size 64x48 --spp 16 --lamps each -t Floor "$SCENES/glass-caustics/glass-caustics.pov" -o l.exr
$ for d in nlm oidn; do
+     RETEX_OIDN=./libOpenImageDenoise.so.2 retex-denoise -q --denoiser $d l.exr -o $d.exr
+     for n in Lamp sky; do retex-combine -q $d.exr --solo $n -o $d-$n.exr; done
+ done
$ rm l.exr
$ for n in Lamp sky; do retex-diff -q nlm-$n.exr oidn-$n.exr --fail-psnr 24 || echo another $n; done
$ retex-diff -q nlm-Lamp.exr nlm-sky.exr --fail-psnr 24 || echo unlike
> unlike
