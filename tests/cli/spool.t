# While a set is rendered, finished rows go to a temporary file; nothing of it is left behind, and when it can hold no
# more, that is said.
$ cp -r "$SCENES/cornell-box" .
% small() { retex-render -q --size 96x64 --spp 2 -t floor cornell-box/cornell-box.pov "$@"; }
$ small -o a.exr
$ small --threads 1 -o - >b.exr
$ small -o - | cmp - b.exr
$ retex-info --check a.exr | tail -1
> a.exr: ok
$ ls -A
> a.exr
> b.exr
> cornell-box
$ (trap '' XFSZ; ulimit -f 8; small -o c.exr)
! retex-render: error: cannot write a temporary file in .: File too large
= 2
$ ls c.exr
! ls: cannot access 'c.exr': No such file or directory
= 2
$ (trap '' XFSZ; ulimit -f 8; TMPDIR=/nowhere small -o - >c.exr)
! retex-render: error: cannot write a temporary file in /tmp: File too large
= 2
$ wc -c <c.exr
> 0

# The file is the same for any number of threads.
$ for n in 1 2 7; do
+     retex-render -q --size 96x70 --spp 2 -t floor -t red=Red cornell-box/cornell-box.pov --threads $n -o t$n.exr
+ done
$ cmp t1.exr t2.exr && cmp t1.exr t7.exr

# A set takes little more memory than a picture: here it has 70 million numbers, which the film does not keep.
$ set -- -q --size 1280x720 --spp 1 -t floor cornell-box/cornell-box.pov --stats - -o
+ for mode in --plain --no-denoise-data; do retex-render $mode "$@" big.exr; done |
+     sed -n 's/.*peak_memory_bytes": \([0-9]*\),/\1/p' | tr '\n' ' ' |
+     awk '{ print ($2 - $1 < 100e6 ? "little" : $2 - $1) }'
> little
