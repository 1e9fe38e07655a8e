# retex-render: errors of usage and of scenes, with file, line and column; the whole pipe.
$ ln -s "$SCENES" scenes; retex-render -q --size 32x24 --spp 2 -t floor scenes/cornell-box/cornell-box.pov -o s.exr; retex-info --check s.exr
> s.exr: ok
$ retex-render -q --size 32x24 --spp 2 -t floor scenes/cornell-box/cornell-box.pov | retex-sample -q - --texture floor=scenes/textures/brick.jpg | retex-combine -q - -o y.png; retex-combine -q s.exr --texture floor=scenes/textures/brick.jpg -o z.png; cmp y.png z.png
$ for n in 1 2 7; do retex-render -q --threads $n --size 32x24 --spp 2 -t floor scenes/cornell-box/cornell-box.pov -o $n.exr; done; cmp 1.exr 2.exr; cmp 1.exr 7.exr; cmp 1.exr s.exr
$ rm ?.exr ?.png

$ retex-render
! retex-render: error: which scene? (try --help)
= 2
$ retex-render none.pov -o x.exr
! retex-render: error: none.pov: cannot open `none.pov`: No such file or directory
= 2
$ printf 'sphere { 0, 1\n  pigment { rgb 1 }\n  nonsense\n}\n' >bad.pov; retex-render bad.pov -o x.exr
! retex-render: error: bad.pov:3:3: expected an object modifier or }, found `nonsense`, which is not declared
= 2
$ printf 'camera { location -z }\nbox { 0, 1\n' >open.pov; retex-render open.pov -o x.exr
! retex-render: error: open.pov:3:1: expected an object modifier or }, found the end of the file
= 2
$ printf '#declare A = 1;\n#include "missing.inc"\n' >include.pov; retex-render include.pov -o x.exr
! retex-render: error: include.pov:2:10: cannot find the file `missing.inc` in the scene's folder or the include path
= 2
$ printf '#while (1) #end\n' >forever.pov; retex-render forever.pov -o x.exr 2>err; echo $?; grep -c '^retex-render: error: forever.pov:1:' err
> 2
> 1
$ retex-render -t Nope scenes/cornell-box/cornell-box.pov -o x.exr
! retex-render: error: no texture, pigment, material or object `Nope` in the scene; there are: Floor, White, Red, Green
= 2
$ retex-render --size 0x5 bad.pov -o x.exr
! retex-render: error: --size wants WxH, not `0x5`
= 2
$ retex-render --crop 1,2 bad.pov -o x.exr
! retex-render: error: --crop wants X,Y,W,H, not `1,2`
= 2
$ retex-render --spp 0 bad.pov -o x.exr
! retex-render: error: --spp: expected a whole number from 1 to 1048576, not '0'
= 2
$ retex-render --layout cubist scenes/cornell-box/cornell-box.pov -o x.exr
! retex-render: error: --layout knows paper, not `cubist`
= 2
$ retex-render --replace floor=none.jpg -q --size 32x24 --spp 1 scenes/cornell-box/cornell-box.pov -o x.exr
! retex-render: error: cannot read none.jpg: No such file or directory
= 2
$ retex-render -q --size 32x24 --spp 1 --plain scenes/cornell-box/cornell-box.pov -o nowhere/x.exr
! retex-render: error: cannot write nowhere/x.exr: No such file or directory
= 2
$ retex-render -q --size 32x24 --spp 1 --plain scenes/cornell-box/cornell-box.pov -o /dev/full
! retex-render: error: cannot write /dev/full: No space left on device
= 2
$ retex-render -q --size 32x24 --spp 1 -t floor scenes/cornell-box/cornell-box.pov >/dev/full
! retex-render: error: cannot write standard output: No space left on device
= 2
$ { sleep 1; retex-render -q --size 32x24 --spp 1 -t floor scenes/cornell-box/cornell-box.pov; echo $? >&2; } | :
! retex-render: error: cannot write standard output: Broken pipe
! 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# An old file is whole after a failure.
$ echo old >old.exr; retex-render bad.pov -o old.exr 2>/dev/null; cat old.exr; ls -A
> old
> bad.pov
> err
> forever.pov
> include.pov
> old.exr
> open.pov
> scenes
