# retex-combine --error: the error to be expected, in numbers and as a picture, and mistakes.
$ make_set s.exr 48 32
$ cp "$SCENES/textures/brick.jpg" .
$ retex-combine s.exr --threads 1 --texture floor=brick.jpg --error e.exr -o y.exr 2>&1 |
+     sed 's/[0-9.]* s$/N s/; s/error [0-9][0-9.e-]* rms/error N rms/'
> retex-combine: y.exr: Floor <- brick.jpg, 48 x 32, expected error N rms, N s
$ retex-combine -q s.exr --texture floor=brick.jpg -o z.exr
$ cmp y.exr z.exr
$ retex-diff -q e.exr e.exr
$ retex-diff -q e.exr y.exr --fail-psnr 60
= 1

# A constant colour is exact; the more contrast, the more error.
$ retex-combine s.exr --texture 'floor=rgb(0.9,0,0)' --texture 'wall=rgb(0,1,0.5)' --error 0.exr -o 0.png 2>&1 |
+     grep -o 'expected error 0 rms'
> expected error 0 rms

# The same bits whatever the number of threads, and through a pipe.
$ for n in 1 2 7; do
+     retex-combine -q s.exr --threads $n --texture:scale=3:rotate=20 wall=brick.jpg --error $n.exr -o 0.png
+ done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr
$ retex-combine -q - --texture:scale=3:rotate=20 wall=brick.jpg --error pipe.exr <s.exr >p.exr
$ cmp 1.exr pipe.exr
# Little of a set and its samples is in memory here too: of 94 megabytes of samples and as much of the set.
$ make_set big.exr 1024 1280
$ retex-sample -q big.exr --texture 'Wall=rgb(1,.5,.2)' -o wall.exr
$ make_peak alone retex-combine -q --threads 2 big.exr --texture floor=brick.jpg --error e.exr -o y.png
$ make_peak both retex-combine -q --threads 2 big.exr wall.exr --texture floor=brick.jpg --error f.exr -o z.png
$ for f in alone both; do awk '{ print ($1 < 100 ? "little" : $1) }' $f; done
> little
> little
$ rm big.exr wall.exr
$ rm ?.exr ?.png pipe.exr
$ make_set s.exr 48 32

$ printf 'output,floor\nx.png,brick.jpg\n' >batch.csv
$ retex-combine -q s.exr --batch batch.csv --error x.exr
! retex-combine: error: --error and --batch exclude each other
= 2
$ retex-combine -q s.exr --error x.exr -o x.png
! retex-combine: error: --error needs the textures: name them with --texture
= 2
$ retex-sample -q s.exr --texture floor=brick.jpg -o a.exr
$ retex-combine -q s.exr a.exr --error x.exr -o x.png
! retex-combine: error: --error needs the textures: name them with --texture
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error x.exr -o x.exr
! retex-combine: error: x.exr: the output and --error are the same file
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error ./x.exr -o x.exr
! retex-combine: error: ./x.exr: the output and --error are the same file
= 2
$ mkdir folder
$ retex-combine -q s.exr --texture floor=brick.jpg --error folder/../x.exr -o "$PWD/x.exr"
! retex-combine: error: folder/../x.exr: the output and --error are the same file
= 2
$ cp s.exr old.exr
$ ln old.exr hard.exr
$ ln -s old.exr soft.exr
$ for f in hard soft ./old; do retex-combine -q s.exr --texture floor=brick.jpg --error $f.exr -o old.exr; done
! retex-combine: error: hard.exr: the output and --error are the same file
! retex-combine: error: soft.exr: the output and --error are the same file
! retex-combine: error: ./old.exr: the output and --error are the same file
= 2
$ cmp s.exr old.exr
$ retex-combine -q s.exr --texture floor=brick.jpg --error folder/x.exr -o ./y.exr
$ retex-combine -q s.exr --texture floor=brick.jpg --error folder/y.exr -o y.exr
$ cmp folder/x.exr folder/y.exr
$ rm -r folder ?.exr
$ make_set s.exr 48 32
$ retex-combine -q s.exr --texture floor=brick.jpg --error - >/dev/null
! retex-combine: error: the output and --error cannot both be standard output
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error brick.jpg -o x.png
! retex-combine: error: brick.jpg: --error would replace the texture
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error s.exr -o x.png
! retex-combine: error: s.exr: --error would replace the set
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error nowhere/x.exr -o x.png
! retex-combine: error: cannot write nowhere/x.exr: No such file or directory
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error x -o x.png
! retex-combine: error: x: cannot tell the picture's format: the name has no ending, such as .png or .exr
= 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# Neither file is left alone where the other cannot be written.
$ retex-combine -q s.exr --texture floor=brick.jpg --error /dev/full -o full.png
! retex-combine: error: cannot write /dev/full: No space left on device
= 2
$ ls full.png
! ls: cannot access 'full.png': No such file or directory
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error full.exr -o /dev/full
! retex-combine: error: cannot write /dev/full: No space left on device
= 2
$ ls full.exr
! ls: cannot access 'full.exr': No such file or directory
= 2
$ retex-combine -q s.exr --texture floor=brick.jpg --error full.exr -o - >/dev/full
! retex-combine: error: cannot write standard output: No space left on device
= 2
$ ls full.exr
! ls: cannot access 'full.exr': No such file or directory
= 2

# The error that is told is the root mean square of all numbers of the picture of it.
$ skip-without oiiotool openimageio-tools
$ retex-combine s.exr --texture floor=brick.jpg --error e.exr -o y.exr 2>&1 |
+     sed -n 's/.*error \([0-9.e-]*\) rms.*/\1/p' >told
$ oiiotool e.exr --printstats |
+     awk '$2 == "Avg:" || $2 == "StdDev:" { for (c = 3; c < 6; c++) sum += $c * $c }
+          END { printf "%g\n", sqrt(sum / 3) }' |
+     paste - told | awk '{ print ($1 / $2 > 0.99 && $1 / $2 < 1.01) ? "same" : $0 }'
> same
