# While a set is rendered, finished rows go to a temporary file; nothing of it is left behind, and when it can hold no
# more, that is said.
$ cp -r "$SCENES/cornell-box" .; set -- -q --size 96x64 --spp 2 -t floor cornell-box/cornell-box.pov; retex-render "$@" -o a.exr && retex-render "$@" --threads 1 -o - >b.exr && retex-render "$@" -o - | cmp - b.exr && retex-info --check a.exr | tail -1; ls -A
> a.exr: ok
> a.exr
> b.exr
> cornell-box
$ sh -c 'trap "" XFSZ; ulimit -f 8; retex-render -q --size 96x64 --spp 2 -t floor cornell-box/cornell-box.pov -o c.exr'; echo $?; ls c.exr
> 2
! retex-render: error: cannot write a temporary file in .: File too large
! ls: cannot access 'c.exr': No such file or directory
= 2
$ sh -c 'trap "" XFSZ; ulimit -f 8; TMPDIR=/nowhere retex-render -q --size 96x64 --spp 2 -t floor cornell-box/cornell-box.pov -o -' >c.exr; echo $?; wc -c <c.exr
> 2
> 0
! retex-render: error: cannot write a temporary file in /tmp: File too large

# The file is the same for any number of threads.
$ for n in 1 2 7; do retex-render -q --size 96x70 --spp 2 -t floor -t red=Red cornell-box/cornell-box.pov --threads $n -o t$n.exr; done; cmp t1.exr t2.exr && cmp t1.exr t7.exr

# A set takes little more memory than a picture: here it has 70 million numbers, which the film does not keep.
$ set -- -q --size 1280x720 --spp 1 -t floor cornell-box/cornell-box.pov --stats - -o; for mode in --plain --no-denoise-data; do retex-render $mode "$@" big.exr; done | sed -n 's/.*peak_memory_bytes": \([0-9]*\),/\1/p' | tr '\n' ' ' | awk '{ print ($2 - $1 < 100e6 ? "little" : $2 - $1) }'
> little
