# Renders that go on from what an earlier one finished: the files are those of one undisturbed render, to the bit.
# cut BLOCKS COMMAND...: a render that leaves finished rows of at most so many blocks of 512 bytes.
% cut() { (ulimit -f "$1"; shift; "$@" --resume --threads 1); }
$ cp -r "$SCENES/cornell-box" .
$ echo 'exec retex-render -q --size 64x120 --spp 8 -t floor cornell-box/cornell-box.pov "$@"' >render
$ chmod +x render
$ ./render -o ref.exr && ./render --resume -o a.exr && cmp a.exr ref.exr
$ ls
> a.exr
> cornell-box
> ref.exr
> render

# Killed at any moment.
$ (for k in 05 1 15 2 25 3 4; do timeout --foreground -s KILL 0.$k ./render --resume -o k.exr && break; done; true) \
+     2>/dev/null
$ ./render --resume --threads 1 -o k.exr
$ cmp k.exr ref.exr
$ ls
> a.exr
> cornell-box
> k.exr
> ref.exr
> render
$ for m in "exr --plain" "png --replace floor=rgb(0.1,0.2,0.3)" "exr --denoise" "png --denoise"; do
+     e=${m%% *} m=${m#* }
+     ./render $m -o p.$e
+     (for k in 05 1 15 2; do timeout --foreground -s KILL 0.$k ./render $m --resume -o q.$e && break; done) 2>/dev/null
+     ./render $m --resume -o q.$e
+     cmp p.$e q.$e
+ done
! retex-render: warning: p.png holds the picture only: a set needs .exr or .retex
! retex-render: warning: q.png holds the picture only: a set needs .exr or .retex
$ ./render -o p.retex
$ (timeout --foreground -s KILL 0.3 ./render --resume -o q.retex || true) 2>/dev/null
$ ./render --resume -o q.retex
$ cmp p.retex q.retex
$ ls *.partial
! ls: cannot access '*.partial': No such file or directory
= 2

# Ctrl-C, with --resume and without: the first one keeps finished rows and says how to go on.
$ echo 'exec retex-render -q --threads 1 --size 16x4096 --spp 8 -t floor cornell-box/cornell-box.pov "$@"' >long
$ chmod +x long
$ ./long -o long.exr
$ cat >stop <<'END'
+ signal=$1
+ shift
+ env --default-signal=INT ./long "$@" &
+ until [ "$(cut -d" " -f14 /proc/$!/stat)" -ge 70 ]; do sleep 0.02; done
+ kill -$signal $!
+ wait $!
+ END
$ chmod +x stop
$ for o in 'INT --resume' TERM; do
+     ./stop $o -o i.exr 2>err
+     echo $?
+     sed '/^Terminated/d; s/[0-9]* of 256/N of 256/' err
+     ls i.exr
+     ./long --resume -o i.exr
+     cmp i.exr long.exr
+     rm i.exr
+ done
> 130
> retex-render: error: ended by SIGINT; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
> 143
> retex-render: error: ended by SIGTERM; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
! ls: cannot access 'i.exr': No such file or directory
! ls: cannot access 'i.exr': No such file or directory
$ ls i.*
! ls: cannot access 'i.*': No such file or directory
= 2
$ set -- --plain --spp 24
+ ./stop INT "$@" -o i.png 2>err
+ sed '/^Terminated/d; s/[0-9]* of 256/N of 256/' err
+ ./long --plain --spp 1 -o i.png 2>&1
+ ./long "$@" -o ref.png
+ ./long "$@" --resume -o i.png
> retex-render: error: ended by SIGINT; N of 256 bands are finished and in i.png.partial: the same command with --resume goes on
> retex-render: warning: i.png.partial is unchanged: --resume continues from it
$ cmp i.png ref.png
$ ls *.partial
! ls: cannot access '*.partial': No such file or directory
= 2
$ ./stop INT --plain --spp 24 --replace:tint=red floor=tan -o i.png 2>err
= 130
$ ./long --plain --spp 24 --replace:tint=blue floor=tan --resume -o i.png
! retex-render: error: i.png.partial is of another render: other options, another scene or build
= 2
$ rm -f *.partial
$ ./stop TERM -o - >i.exr 2>err; ls *.partial
! ls: cannot access '*.partial': No such file or directory
= 2

# Rows are not a set yet.
$ cut 1500 ./render -o s.exr
! retex-render: error: cannot write s.exr.partial: File too large
= 2
$ mv s.exr.partial s1
$ retex-info s1
! retex-info: error: s1 is not a set yet, but rows of one: retex-render goes on from them with --resume
= 2
$ retex-combine s1 -o x.png
! retex-combine: error: s1 is not a set yet, but rows of one: retex-render goes on from them with --resume
= 2
# Two at once with the same output; the first is then killed, which costs the bands in progress only.
$ ./long --resume -o one.exr &
+ until [ -s one.exr.partial ] && [ "$(stat -c %s one.exr.partial)" -gt 9000 ]; do sleep .02; done
+ ./long --resume -o one.exr
+ kill -KILL $!
+ wait $! 2>/dev/null
! retex-render: error: one.exr.partial is in use by another render
= 137
$ ./long --resume -o one.exr
$ cmp one.exr long.exr
$ ls one*
> one.exr
$ rm one.exr
# Another build, told by its build ID.
$ objcopy --dump-section .note.gnu.build-id=id "$(command -v retex-render)" other
$ printf x | dd of=id bs=1 seek=20 conv=notrunc 2>/dev/null
$ objcopy --update-section .note.gnu.build-id=id other 2>/dev/null
$ sed "s,exec retex-render,exec ./other," render >other-render
$ cp s1 x.exr.partial
$ sh other-render --resume -o x.exr
! retex-render: error: x.exr.partial is of another render: other options, another scene or build
= 2
$ cmp s1 x.exr.partial
$ rm id other other-render x.exr.partial

# Layout paper. With several targets, paths make the images of their terms, of which finished rows may lack some.
$ echo 'exec retex-render -q --layout paper --size 64x112 --spp 4 "$@"' >paper
$ chmod +x paper
$ cat >two.pov <<'END'
+ camera{location<0,0,-5> look_at 0}
+ light_source{<4,6,-6>,1}
+ #declare F=texture{pigment{rgb<.7,.6,.5>}finish{#ifdef(Retex) roughness .1 specular .3 #end}}
+ #declare G=texture{pigment{rgb<.5,.8,.4>}}
+ plane{y,-1 texture{F}}
+ plane{z,3 texture{G}}
+ sphere{<1,0,0>,1 pigment{rgb .8} finish{reflection .8}}
+ END
$ for s in "-t floor cornell-box/cornell-box.pov" "-t floor -t white cornell-box/cornell-box.pov" "-t F -t G two.pov" \
+     "-t F -t G --strict-paper two.pov" "-t F -t G --denoise two.pov"; do
+     ./paper $s -o w.exr
+     for k in 300 1000; do
+         cut $k ./paper $s -o r.exr 2>/dev/null
+         cp r.exr.partial p$k
+         ./paper $s --resume -o r.exr
+         cmp w.exr r.exr
+         rm r.exr
+     done
+     retex-info --json w.exr | grep -o '"radiance":"[a-z0-9_]*"' | grep -vc beauty
+ done
> 21
> 44
> 41
> 37
> 41
$ cp p300 m.exr.partial
$ for s in "-t F" "-t F -t G --strict-paper" "-t F -t G --orders 5" "-t F -t G --layout footprints"; do
+     ./paper $s two.pov --resume -o m.exr
+ done
! retex-render: error: m.exr.partial is of another render: other options, another scene or build
! retex-render: error: m.exr.partial is of another render: other options, another scene or build
! retex-render: error: m.exr.partial is of another render: other options, another scene or build
! retex-render: error: m.exr.partial is of another render: other options, another scene or build
= 2
$ rm m.exr.partial
$ sed 's/^exec.*-t floor/exec retex-render -q --threads 1 --layout paper --size 16x4096 --spp 8 -t floor -t white/' \
+     long >long2
$ chmod +x long2
$ ./long2 -o long2.exr
$ sed 's/long/long2/' stop >stop2
$ chmod +x stop2
$ rm i.exr
+ ./stop2 TERM -o i.exr 2>err
+ echo $?
+ sed '/^Terminated/d; s/[0-9]* of 256/N of 256/' err
+ ls i.exr
+ ./long2 --resume -o i.exr
+ cmp i.exr long2.exr
> 143
> retex-render: error: ended by SIGTERM; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
! ls: cannot access 'i.exr': No such file or directory
$ ls *.partial
! ls: cannot access '*.partial': No such file or directory
= 2

# A checkpoint may have lost its end, or more.
$ cp s1 x.exr.partial; printf 'something' >>x.exr.partial; ./render --resume -o x.exr; cmp x.exr ref.exr
$ for n in 10 47 48 100 20000; do
+     head -c $n s1 >x.exr.partial
+     rm x.exr
+     ./render --resume -o x.exr
+     cmp x.exr ref.exr
+ done
$ for n in 50 9000; do
+     (
+         head -c $n s1
+         printf x
+         tail -c +$((n + 2)) s1
+     ) >x.exr.partial
+     rm x.exr
+     ./render --resume -o x.exr
+     cmp x.exr ref.exr
+ done

# That of another render is not touched.
$ cp s1 y.exr.partial; ./render --resume --spp 4 -o y.exr; cmp s1 y.exr.partial
! retex-render: error: y.exr.partial is of another render: other options, another scene or build
$ sed 's/0.73/0.74/' cornell-box/cornell-box.pov >cornell-box/other.pov
$ cmp -s cornell-box/cornell-box.pov cornell-box/other.pov ||
+     retex-render -q --size 64x120 --spp 8 -t floor cornell-box/other.pov --resume -o y.exr
! retex-render: error: y.exr.partial is of another render: other options, another scene or build
= 2
$ cmp s1 y.exr.partial
$ echo text >z.exr.partial; ./render --resume -o z.exr; cat z.exr.partial; ./render -o z.exr; cmp z.exr ref.exr
> text
! retex-render: error: z.exr.partial is no unfinished render
! retex-render: warning: z.exr.partial is unchanged: --resume continues from it

# What does not go together.
$ ./render --resume
! retex-render: error: --resume needs an output file: -o FILE
= 2
$ ./render --resume --list-targets
! retex-render: error: --resume cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants, --control or --control-data
= 2
$ ./render --resume -o nowhere/x
! retex-render: error: cannot write nowhere/x: No such file or directory
= 2
$ ./render --resume -o /dev/null
! retex-render: error: --resume needs an output file, which /dev/null is not
= 2

# A render is gone on with by the program that began it, and a program is the same bytes wherever it is built: it does
# not hold the folder's name.
$ for p in retex-render retex-combine; do grep -azxF "${TESTS%/tests/cli}" "$(command -v $p)"; done
= 1
