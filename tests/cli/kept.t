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

# The same of version 2: lamps, finishes, a scene unit and normals; packs, one with levels.
$ cp -r "$TESTS/../data/version-2" v2; cd v2; for f in *.exr *.retex; do case $f in picture-*) ;; *) retex-info --check $f;; esac; done; retex-info --check - <lamps.stream; retex-info lamps.exr | grep -E '^(scene unit|lamp)'; retex-info levels.retex | grep ^level | cut -c1-27
> denoised.exr: ok
> lamps.exr: ok
> normals-samples.exr: ok
> normals.exr: ok
> paper-samples.exr: ok
> paper.exr: ok
> lamps.retex: ok
> levels.retex: ok
> normals.retex: ok
> paper.retex: ok
> standard input: ok
> scene unit     0.5 m
> level 1/3      160 x 4 pixe
$ printf 'f=$1; shift; retex-combine -q "$@" -o x.exr; retex-diff -q x.exr picture-$f.exr --fail-psnr 70 && echo $f' >v2/same
$ cd v2; E='--texture:width=40cm:grout=1cm Floor=tan --texture Wall=rgb(.2,.3,.6)'; L='--light Lamp=2*2700K --light Sun=0.5 --finish Floor=polished'; N='--texture:normal=map.ppm Wall=map.ppm'; for f in lamps.exr lamps.retex denoised.exr; do sh same $f $f $E $L; done; sh same map lamps.exr --texture:finish=map.ppm Floor=tan; for f in normals.exr normals.retex; do sh same $f $f $N; done; sh same paper.exr paper.exr $E; sh same levels levels.retex --texture Floor=tan --size 160x
> lamps.exr
> lamps.retex
> denoised.exr
> map
> normals.exr
> normals.retex
> paper.exr
> levels
$ cd v2; E='--texture:width=40cm:grout=1cm Floor=tan --texture Wall=rgb(.2,.3,.6)'; sh same lamps.exr - --light 'Lamp=2*2700K' --light Sun=0.5 --finish Floor=polished <lamps.stream; sh same normals.exr normals.exr normals-samples.exr; sh same paper.exr paper.exr paper-samples.exr; sh same paper.exr paper.retex $E; retex-denoise -q normals.exr -o d.exr; retex-info --check d.exr; retex-pack -q --unpack levels.retex --level 3 -o u.exr; sh same levels u.exr --texture Floor=tan
> lamps.exr
> normals.exr
> paper.exr
> paper.exr
> d.exr: ok
> levels
