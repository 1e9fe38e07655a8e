# Renders that go on from what an earlier one finished, and renders in shards: the files are those of one undisturbed
# render, to the bit.
$ cp -r "$SCENES/cornell-box" .
$ echo 'exec retex-render -q --size 64x120 --spp 16 -t floor cornell-box/cornell-box.pov "$@"' >render
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
$ for m in --plain "--replace floor=rgb(0.1,0.2,0.3)" --denoise; do for e in exr png; do
+     ./render $m -o p.$e
+     (for k in 05 1 15 2; do timeout --foreground -s KILL 0.$k ./render $m --resume -o q.$e && break; done) 2>/dev/null
+     ./render $m --resume -o q.$e
+     cmp p.$e q.$e
+ done; done
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
$ for o in --resume ''; do for s in INT TERM; do
+     ./stop $s $o -o i.exr 2>err
+     echo $?
+     sed '/^Terminated/d; s/[0-9]* of 256/N of 256/' err
+     ls i.exr
+     ./long --resume -o i.exr
+     cmp i.exr long.exr
+     rm i.exr
+ done; done
> 130
> retex-render: error: ended by SIGINT; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
> 143
> retex-render: error: ended by SIGTERM; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
> 130
> retex-render: error: ended by SIGINT; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
> 143
> retex-render: error: ended by SIGTERM; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
! ls: cannot access 'i.exr': No such file or directory
! ls: cannot access 'i.exr': No such file or directory
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

# Shards are put together, in any order; all are needed, each once, and of one render.
$ for k in 1 2 3; do ./render --shard $k/3 -o s$k; done
$ ./render --merge s2 --merge s1 --merge s3 -o m.exr
$ cmp m.exr ref.exr
$ ./render --merge s2 --merge s1 --merge s3 --aov depth -o m.exr
$ ./render --aov depth -o d.exr
$ cmp m.exr d.exr
$ ls s?
> s1
> s2
> s3
$ ./render --merge s2 --merge s1 --merge s3 -o m.retex
$ retex-pack -q ref.exr -o ref.retex
$ retex-diff --fail-abs 0 m.retex ref.retex >/dev/null && echo same
> same
$ rm m.retex ref.retex
$ rm m.exr; ./render --merge s2 --merge s3 -o m.exr
! retex-render: error: --merge: 3 of 8 bands are in none of the files: a shard is missing or damaged
= 2
$ for n in 50 200 9000 30000; do
+     (
+         head -c $n s2
+         printf x
+         tail -c +$((n + 2)) s2
+     ) >bad
+     ./render --merge s1 --merge bad --merge s3 -o m.exr 2>err
+     echo "$? $(sed 's/[0-9] of/N of/' err)"
+ done
> 2 retex-render: error: --merge: N of 8 bands are in none of the files: a shard is missing or damaged
> 2 retex-render: error: --merge: N of 8 bands are in none of the files: a shard is missing or damaged
> 2 retex-render: error: --merge: N of 8 bands are in none of the files: a shard is missing or damaged
> 2 retex-render: error: --merge: N of 8 bands are in none of the files: a shard is missing or damaged
$ ls m.exr
! ls: cannot access 'm.exr': No such file or directory
= 2
$ ./render --merge s2 --merge s1 --merge s2 --merge s3 -o m.exr
! retex-render: error: s2 and s2 have the same rows: is a shard given twice?
= 2
$ ./render --merge s1 --merge s2 --merge s3 --spp 17 -o m.exr
! retex-render: error: s1 is of another render: other options, another scene or build
= 2
$ ./render --merge s1 --merge s2 --merge ref.exr -o m.exr
! retex-render: error: ref.exr is no unfinished render
= 2
$ ./render --merge s1 --merge nowhere -o m.exr
! retex-render: error: cannot open nowhere: No such file or directory
= 2
$ retex-info s1
! retex-info: error: s1 is not a set yet, but rows of one: retex-render goes on from them with --resume or --merge
= 2
$ retex-combine s1 -o x.png
! retex-combine: error: s1 is not a set yet, but rows of one: retex-render goes on from them with --resume or --merge
= 2
$ for k in 1 2; do
+     ./render --plain --shard $k/2 -o t$k
+     ./render --denoise --shard $k/2 -o u$k
+ done
$ ./render --plain -o ref.png
$ ./render --plain --merge t1 --merge t2 -o t.png
$ cmp t.png ref.png
$ ./render --denoise -o v.exr
$ ./render --denoise --merge u1 --merge u2 -o u.exr
$ cmp u.exr v.exr
# Of a set, shards make a picture alone too.
$ for k in 1 2; do ./render --shard $k/2 -o u$k.png; done
$ ./render --merge u1.png --merge u2.png -o u.png
! retex-render: warning: u.png holds the picture only: a set needs .exr or .retex
$ ./render -o ref.png
! retex-render: warning: ref.png holds the picture only: a set needs .exr or .retex
$ cmp u.png ref.png
$ rm u*

# A shard goes on from what it has, and is refused at once where its output is of another render or another shard.
$ cp s1 again
$ ./render --shard 1/3 -o again
$ head -c 9000 s1 >again
$ ./render --shard 1/3 -o again
$ ./render --merge again --merge s2 --merge s3 -o m.exr
$ cmp m.exr ref.exr
$ cp s1 again
$ ./render --shard 2/3 -o again
! retex-render: error: again has rows of another shard: each shard needs an output of its own
= 2
$ ./render --shard 1/3 --spp 17 -o again
! retex-render: error: --shard replaces only an earlier output of the same shard: again is of another render: other options, another scene or build
= 2
$ cmp again s1
$ cp s1 left.partial
$ ./render --shard 2/3 -o left
! retex-render: error: left.partial has rows of another shard: each shard needs an output of its own
= 2
$ cp ref.exr text
$ ./render --shard 1/3 -o text
! retex-render: error: --shard replaces only an earlier output of the same shard: text is no unfinished render
= 2
$ cmp text ref.exr
$ ls again* left* text*
> again
> left.partial
> text
$ rm again left* text m.exr
# Two at once with the same output; the first is then killed, which costs the bands in progress only.
$ ./long --shard 1/2 -o one &
+ until [ -s one.partial ] && [ "$(stat -c %s one.partial)" -gt 9000 ]; do sleep .02; done
+ ./long --shard 2/2 -o one
+ ./long --shard 1/2 -o one
+ kill -KILL $!
+ wait $! 2>/dev/null
! retex-render: error: one.partial is in use by another render
! retex-render: error: one.partial is in use by another render
= 137
$ ./long --shard 2/2 -o one
! retex-render: error: one.partial has rows of another shard: each shard needs an output of its own
= 2
$ ./long --shard 1/2 -o one
$ ./long --shard 2/2 -o two
$ ./long --merge one --merge two -o m.exr
$ cmp m.exr long.exr
$ ls one* two*
> one
> two
$ rm one two m.exr
# Another build, told by its build ID.
$ objcopy --dump-section .note.gnu.build-id=id "$(command -v retex-render)" other
$ printf x | dd of=id bs=1 seek=20 conv=notrunc 2>/dev/null
$ objcopy --update-section .note.gnu.build-id=id other 2>/dev/null
$ sed "s,exec retex-render,exec ./other," render >other-render
$ sh other-render --merge s1 --merge s2 --merge s3 -o m.exr
! retex-render: error: s1 is of another render: other options, another scene or build
= 2
$ sh other-render --shard 1/3 -o s1
! retex-render: error: --shard replaces only an earlier output of the same shard: s1 is of another render: other options, another scene or build
= 2
$ rm id other other-render
# All files are checked before pixels of any are read, so the second wrong one is told of while the first is damaged.
$ (
+     head -c 9000 s2
+     printf x
+     tail -c +9002 s2
+ ) >bad
$ ./render --merge s1 --merge bad --merge ref.exr -o m.exr
! retex-render: error: ref.exr is no unfinished render
= 2
$ ./render --merge s1 --merge bad --merge s1 -o m.exr
! retex-render: error: s1 and s1 have the same rows: is a shard given twice?
= 2
$ rm bad

# Layout paper. With several targets, paths make the images of their terms, and no shard has all of them.
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
+     rm -f p?
+     for k in 1 2 3; do ./paper $s --shard $k/3 -o p$k; done
+     ./paper $s --merge p3 --merge p1 --merge p2 -o m.exr
+     cmp w.exr m.exr
+     for k in 1 3; do
+         cp p$k r.exr.partial
+         rm -f r.exr
+         ./paper $s --resume --threads 1 -o r.exr
+         cmp w.exr r.exr
+     done
+     retex-info --json w.exr | grep -o '"radiance":"[a-z0-9_]*"' | grep -vc beauty
+ done
> 21
> 44
> 41
> 37
> 41
$ retex-info --check m.exr
> m.exr: ok
$ rm m.exr
$ for s in "-t F" "-t F -t G --strict-paper" "-t F -t G --orders 5" "-t F -t G --layout footprints"; do
+     ./paper $s two.pov --merge p1 --merge p2 -o m.exr
+ done
! retex-render: error: p1 is of another render: other options, another scene or build
! retex-render: error: p1 is of another render: other options, another scene or build
! retex-render: error: p1 is of another render: other options, another scene or build
! retex-render: error: p1 is of another render: other options, another scene or build
= 2
$ ls m.exr
! ls: cannot access 'm.exr': No such file or directory
= 2
$ ./paper -t F -t G --denoise two.pov --merge p1 --merge p2 -o none.exr
! retex-render: error: --merge: 2 of 7 bands are in none of the files: a shard is missing or damaged
= 2
$ ls none.exr
! ls: cannot access 'none.exr': No such file or directory
= 2
$ sed 's/^exec.*-t floor/exec retex-render -q --threads 1 --layout paper --size 16x4096 --spp 8 -t floor -t white/' \
+     long >long2
$ chmod +x long2
$ ./long2 -o long2.exr
$ sed 's/long/long2/' stop >stop2
$ chmod +x stop2
$ for o in --resume ''; do
+     ./stop2 TERM $o -o i.exr 2>err
+     echo $?
+     sed '/^Terminated/d; s/[0-9]* of 256/N of 256/' err
+     ls i.exr
+     ./long2 --resume -o i.exr
+     cmp i.exr long2.exr
+     rm i.exr
+ done
> 143
> retex-render: error: ended by SIGTERM; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
> i.exr
> 143
> retex-render: error: ended by SIGTERM; N of 256 bands are finished and in i.exr.partial: the same command with --resume goes on
! ls: cannot access 'i.exr': No such file or directory
$ ls *.partial
! ls: cannot access '*.partial': No such file or directory
= 2

# A checkpoint may have lost its end, or more.
$ cp s1 x.exr.partial; printf 'something' >>x.exr.partial; ./render --resume -o x.exr; cmp x.exr ref.exr
$ for n in 10 40 47 48 100 5000 20000 60000; do
+     head -c $n s1 >x.exr.partial
+     rm x.exr
+     ./render --resume -o x.exr
+     cmp x.exr ref.exr
+ done
$ for n in 50 200 9000 30000; do
+     (
+         head -c $n s2
+         printf x
+         tail -c +$((n + 2)) s2
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
+     retex-render -q --size 64x120 --spp 16 -t floor cornell-box/other.pov --resume -o y.exr
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
$ ./render --shard 4/3 -o x
! retex-render: error: --shard: expected I/N, I from 1 to N, not `4/3`
= 2
$ ./render --shard 1 -o x
! retex-render: error: --shard: expected I/N, not `1`
= 2
$ ./render --merge s1 --resume -o x.exr
! retex-render: error: --merge renders no rows: no --resume or --shard
= 2
$ ./render --resume --list-targets
! retex-render: error: --resume cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants, --control or --control-data
= 2
$ ./render --shard 1/2 --aov depth -o x
! retex-render: error: --shard writes rows only: give --aov, --aov-dir and --stats with --merge
= 2
$ ./render --shard 1/2 -o nowhere/x
! retex-render: error: cannot write nowhere/x: No such file or directory
= 2
$ for o in '--shard 1/2' --resume; do ./render $o -o /dev/null; done
! retex-render: error: --shard needs an output file, which /dev/null is not
! retex-render: error: --resume needs an output file, which /dev/null is not
= 2

# Shards are merged if they are of one program, and a program is the same bytes wherever it is built: it does not hold the
# folder's name.
$ for p in retex-render retex-combine; do grep -azxF "${TESTS%/tests/cli}" "$(command -v $p)"; done
= 1
