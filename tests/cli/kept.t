# Files of version 1 of both formats, made once and kept: they stay whole, readable, and give the same pictures.
$ cp -r "$TESTS/../data/version-1" v1; cd v1; for f in *.exr *.retex; do case $f in picture-*) ;; *) retex-info --check $f;; esac; done; retex-info --check - <footprints.stream
> footprints.exr: ok
> paper-samples.exr: ok
> paper.exr: ok
> footprints.retex: ok
> paper.retex: ok
> standard input: ok
$ cd v1; for f in footprints.exr paper.exr footprints.retex; do retex-combine -q $f --texture 'Floor=rgb(.9,.2,.1)' -o x.exr; retex-diff -q x.exr picture-$f.exr --fail-psnr 70 && echo $f; done
> footprints.exr
> paper.exr
> footprints.retex
$ cd v1; retex-combine -q - -o x.exr <footprints.stream; retex-diff -q x.exr picture-footprints.exr.exr --fail-psnr 70; retex-combine -q paper.retex --texture 'Floor=rgb(.9,.2,.1)' -o x.exr; retex-diff -q x.exr picture-paper.exr.exr --fail-psnr 70; retex-combine -q paper.exr paper-samples.exr -o x.exr; retex-diff -q x.exr picture-paper.exr.exr --fail-psnr 70
$ cd v1; for f in footprints.exr paper.exr; do retex-denoise -q $f -o d.exr; retex-combine -q d.exr -o x.exr; retex-combine -q $f -o y.exr; retex-diff -q x.exr y.exr --fail-psnr 20; done; retex-pack -q --unpack paper.retex -o u.exr; retex-diff -q u.exr paper.exr --fail-psnr 120
