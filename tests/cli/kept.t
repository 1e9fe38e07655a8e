# Files of version 1 of the formats, made once and kept: they stay whole, readable, and give the same pictures. Lamps,
# finishes, a scene unit and normals; packs, one with levels.
$ cp -r "$TESTS/../data/version-1" kept
% cd kept
$ for f in *.exr *.retex; do case $f in picture-*) ;; *) retex-info --check $f ;; esac done
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
% cd ..
$ retex-info --check - <kept/lamps.stream
> standard input: ok
$ retex-info kept/lamps.exr | grep -E '^(scene unit|lamp)'
> scene unit     0.5 m
$ retex-info kept/levels.retex | grep ^level | cut -c1-27
> level 1/3      160 x 4 pixe
% # The picture of ARGUMENT… is the one that was kept by NAME: same NAME ARGUMENT…
% same() {
%     name=$1
%     shift
%     retex-combine -q "$@" -o x.exr
%     retex-diff -q x.exr picture-$name.exr --fail-psnr 70 && echo $name
% }
% both='--texture:width=40cm:grout=1cm Floor=tan --texture Wall=rgb(.2,.3,.6)'
% lit='--light Lamp=2*2700K --light Sun=0.5 --finish Floor=polished'

# The pictures that were kept.
% cd kept
$ same lamps-laid lamps.exr $both $lit
> lamps-laid
$ for f in lamps.retex denoised.exr; do same $f $f $both $lit; done
> lamps.retex
> denoised.exr
$ same map lamps.exr --texture:finish=map.ppm Floor=tan
> map
$ for f in normals.exr normals.retex; do same $f $f --texture:normal=map.ppm Wall=map.ppm; done
> normals.exr
> normals.retex
$ same paper.exr paper.exr $both
> paper.exr
$ same levels levels.retex --texture Floor=tan --size 160x
> levels

# As streams, with samples, from other layouts, denoised and unpacked.
$ same lamps-laid - $lit <lamps.stream
> lamps-laid
$ same normals.exr normals.exr normals-samples.exr
> normals.exr
$ same paper.exr paper.exr paper-samples.exr
> paper.exr
$ same paper.exr paper.retex $both
> paper.exr
$ retex-denoise -q normals.exr -o d.exr
$ retex-info --check d.exr
> d.exr: ok
$ retex-pack -q --unpack levels.retex --level 3 -o u.exr
$ same levels u.exr --texture Floor=tan
> levels
% cd ..
