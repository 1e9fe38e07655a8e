# retex-diff: it must fail on whatever is wrong, for goldens trust it.
$ make_picture a.exr
$ make_picture b.exr
$ retex-diff a.exr b.exr
> psnr 120.00 relmse 0 mae 0 flip 0 (p99 0) max 0 rel 0 at 0,0 B
$ retex-diff -q a.exr b.exr
$ retex-diff a.exr a.exr --fail-psnr 120 --fail-relmse 0 --fail-flip 0 --fail-abs 0 --fail-rel 0 -q

# Small noise: differs when nothing is said, passes limits that allow it, fails limits that do not.
$ make_picture noisy.exr noise=0.004
$ retex-diff -q noisy.exr a.exr
= 1
$ retex-diff -q noisy.exr a.exr --fail-psnr 45 --fail-relmse 1e-3 --fail-flip 0.05 --fail-abs 0.006 --fail-rel 0.06
$ retex-diff -q noisy.exr a.exr --fail-psnr 60
= 1
$ retex-diff -q noisy.exr a.exr --fail-relmse 1e-6
= 1
$ retex-diff -q noisy.exr a.exr --fail-flip 0.001
= 1
$ retex-diff -q noisy.exr a.exr --fail-abs 0.001
= 1
$ retex-diff -q noisy.exr a.exr --fail-rel 0.001
= 1
# A limit of one kind is none of another: the largest difference is 0.0044, the largest relative one 0.038.
$ retex-diff noisy.exr a.exr --fail-abs 0.03 --fail-rel 0.03 | sed 's/.*: //'
> the largest relative difference, 0.0379092, is above 0.03
$ retex-diff -q noisy.exr a.exr --fail-rel 0.04
$ retex-diff noisy.exr a.exr --fail-abs 0.001 | sed 's/.*: //; s/[0-9.e-]*, is/X, is/'
> the largest difference, X, is above 0.001

# NaN and infinity fail, even in both, even with generous limits.
$ make_picture nan.exr nan
$ retex-diff nan.exr a.exr --fail-psnr 1 | sed 's/.*: //'
> 1 samples are NaN or infinite
$ retex-diff -q nan.exr a.exr --fail-psnr 1
= 1
$ retex-diff -q a.exr nan.exr --fail-abs 1000
= 1
$ retex-diff -q nan.exr nan.exr
= 1
$ retex-diff -q nan.exr nan.exr --allow-inf
= 1
$ make_picture inf.exr inf
$ retex-diff -q inf.exr a.exr --fail-psnr 1
= 1
$ retex-diff -q inf.exr inf.exr
= 1
$ retex-diff -q inf.exr inf.exr --allow-inf
$ retex-diff -q inf.exr a.exr --allow-inf --fail-psnr 1
= 1

# Size: smaller, larger, transposed.
$ make_picture wide.exr size=65x40
$ retex-diff wide.exr a.exr --fail-psnr 1
> sizes differ: 65 x 40 and 64 x 40
= 1
$ make_picture turned.exr size=40x64
$ retex-diff -q a.exr turned.exr --fail-psnr 1
= 1

# Mirrored and swapped channels.
$ make_picture mirrored.exr mirror
$ retex-diff -q mirrored.exr a.exr --fail-psnr 30
= 1
$ make_picture swapped.exr swap
$ retex-diff -q swapped.exr a.exr --fail-psnr 30
= 1

# Channels missing here or there.
$ make_picture rg.exr channels=RG
$ retex-diff rg.exr a.exr --fail-psnr 1
> channel B is missing in the first
= 1
$ retex-diff a.exr rg.exr --fail-psnr 1
> channel B is missing in the second
= 1
$ make_picture rgba.exr channels=RGBA
$ retex-diff rgba.exr a.exr --fail-psnr 1
> channel A is missing in the second
= 1
$ make_picture xyz.exr channels=XYZ
$ retex-diff -q xyz.exr a.exr --fail-abs 1000
= 1

# Alpha and other channels that psnr does not look at must be the same unless --fail-abs or --fail-rel say otherwise.
$ make_picture noisy4.exr channels=RGBA noise=0.004
$ retex-diff -q noisy4.exr rgba.exr --fail-psnr 45
= 1
$ retex-diff -q noisy4.exr rgba.exr --fail-psnr 45 --fail-abs 0.006
$ make_picture xyz2.exr channels=XYZ noise=0.004
$ retex-diff -q xyz.exr xyz2.exr --fail-psnr 20
= 1
$ retex-diff -q xyz.exr xyz2.exr --fail-abs 0.006

# Other formats are R,G,B,A.
$ make_picture a.png
$ make_picture b.png noise=0.004
$ retex-diff -q a.png a.png
$ retex-diff -q a.png b.png
= 1
$ retex-diff -q a.png a.exr --fail-psnr 48
$ retex-diff -q a.png a.exr --fail-abs 0.006 # channels meet by name, in whatever order files have them
$ make_picture m.png mirror
$ retex-diff -q a.png m.png --fail-psnr 30
= 1
$ make_picture grey.png grey
$ retex-diff -q a.png grey.png --fail-psnr 30
= 1

# Sets: part by part.
$ make_set s.exr
$ make_set t.exr 48 32 2
$ retex-diff -q --all-parts --allow-inf s.exr s.exr
$ retex-diff -q --all-parts s.exr s.exr
= 1
$ retex-diff --part depth s.exr t.exr --allow-inf --fail-abs 2 | sed 's/ max .*/ …/'
> max 0.9864 rel 0.9854 at 1,9 R
$ retex-diff -q --part t0_dep1 s.exr t.exr
= 1
$ retex-diff --part nothing s.exr t.exr
! retex-diff: error: neither file has a part 'nothing'
= 2
$ retex-diff --part depth s.exr a.exr
> part 'depth' is missing in the second
= 1
$ retex-diff --all-parts a.exr s.exr --fail-psnr 1 | tail -n 1
> part 'picture' is missing in the second

# JSON.
$ retex-diff --json a.exr b.exr
> {"differs": false, "part": "picture", "width": 64, "height": 40, "channels": 3, "psnr": 120, "relmse": 0, "mae": 0, "flip_mean": 0, "flip_p99": 0, "max_abs": 0, "max_rel": 0, "nonfinite": 0, "worst": {"x": 0, "y": 0, "channel": "B"}, "reason": "", "why": ""}
$ retex-diff --json noisy.exr a.exr | grep -o '"flip[^,]*' | cut -c1-17
> "flip_mean": 0.01
> "flip_p99": 0.022
$ retex-diff --json wide.exr a.exr
> {"differs": true, "part": "picture", "width": 65, "height": 40, "channels": 3, "psnr": null, "relmse": null, "mae": null, "flip_mean": null, "flip_p99": null, "max_abs": null, "max_rel": null, "nonfinite": 0, "worst": null, "reason": "sizes differ: 65 x 40 and 64 x 40", "why": "sizes differ: 65 x 40 and 64 x 40"}
= 1
# A name that is no UTF-8 does not spoil the JSON.
$ sed -z '0,/^R$/s//\xff/' a.exr >odd.exr
$ retex-diff --json odd.exr a.exr | grep -o '.why.*'
> "why": "channel � is missing in the second"}

# Errors are not differences.
$ retex-diff a.exr
! retex-diff: error: two files are needed; try --help
= 2
$ retex-diff a.exr b.exr c.exr
! retex-diff: error: two files are enough; is -o c.exr meant?
= 2
$ retex-diff a.exr none.exr
! retex-diff: error: cannot read none.exr: No such file or directory
= 2
$ head -c 1000 a.exr >cut.exr
$ retex-diff -q a.exr cut.exr 2>err
= 2
$ grep -c 'retex-diff: error: .*cut.exr.*damaged' err
> 1
$ echo text >text.exr
$ retex-diff -q a.exr text.exr 2>err
= 2
$ grep -c 'retex-diff: error: text.exr' err
> 1
$ retex-diff - a.exr <b.exr -q
$ retex-diff - -
! retex-diff: error: A and B cannot both be standard input
= 2
$ retex-diff a.exr b.exr --fail-psnr nan
! retex-diff: error: --fail-psnr: expected a number from 0 to 120, not 'nan'
= 2

# -o: the file has what standard output would have, also where the pictures differ; after an error it is as before.
$ for o in '' --json '-q' '--all-parts --fail-abs 1'; do
+     retex-diff a.exr noisy.exr $o >out
+     s=$?
+     echo old >x
+     retex-diff a.exr noisy.exr $o -o x
+     echo "$s $?"
+     cmp out x
+     retex-diff $o --output=- a.exr noisy.exr | cmp out -
+ done
> 1 1
> 1 1
> 1 1
> 0 0
$ echo old >x
$ retex-diff a.exr text.exr -o x 2>&1 | head -c 25
> retex-diff: error: text.e
$ retex-diff a.exr noisy.exr --part none -o x
! retex-diff: error: neither file has a part 'none'
= 2
$ retex-diff a.exr noisy.exr -o none/x
! retex-diff: error: cannot write none/x: No such file or directory
= 2
$ retex-diff a.exr noisy.exr -o /dev/full
! retex-diff: error: cannot write /dev/full: No space left on device
= 2
$ cat x
> old
$ ls -A | grep tmp
= 1
$ ln -s x link
$ mkdir folder
$ for o in folder ''; do retex-diff a.exr a.exr -o "$o"; done
! retex-diff: error: cannot write folder: Is a directory
! retex-diff: error: --output: the name is empty
= 2
$ retex-diff a.exr a.exr -o link
$ ls -l link | grep -c 'link -> x'
> 1
$ cmp x link
$ retex-diff a.exr a.exr | cmp - x

# The limit of pixels counts for parts of OpenEXR files and packs.
$ make_set fp.exr 48 32 footprints
$ retex-pack -q --lossless fp.exr -o fp.retex
$ for f in fp.exr fp.retex; do retex-diff $f $f --max-pixels 1000; done
! retex-diff: error: fp.exr is too large: 48 x 32 pixels, more than the 1000 of --max-pixels
! retex-diff: error: fp.retex is too large: 48 x 32 pixels, more than the 1000 of --max-pixels
= 2
