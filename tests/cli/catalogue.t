# Catalogues: large batches with a manifest, in parts, resumed and verified.
$ make_set s.exr 48 32
$ cp "$SCENES/textures/brick.jpg" .
$ cp "$SCENES/textures/fans.jpg" oak.jpg
% batch() { retex-combine s.exr --batch t --manifest m "$@"; }
% many() { retex-combine s.exr --batch many --manifest m "$@"; }
% # What differs from run to run has a letter: seconds, bytes, checksums.
% masked() {
%     sed -e 's/"seconds": [0-9.]*/"seconds": S/' -e 's/"bytes": [0-9]*/"bytes": B/' \
%         -e 's/"\(crc32\|set\)": "[0-9a-f ]*"/"\1": "C"/g' -e 's/\.jpg\([^"]*\) [0-9a-f]* [0-9]*"/.jpg\1 C"/g' \
%         -e 's/, [0-9.]* s$/, S/' -e 's/[0-9]* bytes instead of [0-9]*/N bytes instead of M/'
% }
$ cat >t <<'END'
+ output,floor,Wall
+ a.png,brick.jpg,
+ b.png,:scale=2:rotate=30 oak.jpg,"rgb(.5,.25,.125)"
+ c.jpg,,oak.jpg
+ d.png
+ END

# What is planned, made, found good, and kept.
$ batch --plan | sed 's/about .*//'
> rows 1 to 4 of 4: 4 to make, 0 kept
> to make:
$ ls m
! ls: cannot access 'm': No such file or directory
= 2
$ batch --plan | grep -c 'by 4 trial pictures of 2\..* kB'
> 1
$ batch --texture wall=brick.jpg --quality 80 2>&1 | masked
> retex-combine: a.png: Floor <- brick.jpg, Wall <- brick.jpg, 48 x 32, S
> retex-combine: b.png: Floor <- oak.jpg, Wall <- rgb(0.5,0.25,0.125), 48 x 32, S
> retex-combine: c.jpg: Wall <- oak.jpg, 48 x 32, S
> retex-combine: d.png: Wall <- brick.jpg, 48 x 32, S
> retex-combine: 4 pictures, S
$ masked <m
> {"output": "a.png", "version": "0.1.0", "set": "C", "samples": "", "options": "quality=80 cross=3 display= view= colorspace= ocio=00000000", "textures": {"Floor": "brick.jpg C", "wall": "brick.jpg C"}, "bytes": B, "crc32": "C", "seconds": S}
> {"output": "b.png", "version": "0.1.0", "set": "C", "samples": "", "options": "quality=80 cross=3 display= view= colorspace= ocio=00000000", "textures": {"Floor": ":scale=2,2:rotate=30 oak.jpg C", "Wall": "rgb(0.5,0.25,0.125)"}, "bytes": B, "crc32": "C", "seconds": S}
> {"output": "c.jpg", "version": "0.1.0", "set": "C", "samples": "", "options": "quality=80 cross=3 display= view= colorspace= ocio=00000000", "textures": {"Wall": "oak.jpg C"}, "bytes": B, "crc32": "C", "seconds": S}
> {"output": "d.png", "version": "0.1.0", "set": "C", "samples": "", "options": "quality=80 cross=3 display= view= colorspace= ocio=00000000", "textures": {"wall": "brick.jpg C"}, "bytes": B, "crc32": "C", "seconds": S}
$ rm m
$ batch -q
$ wc -l <m
> 4
$ batch --verify
> 4 of 4 pictures good
$ batch --resume --progress json 2>&1 | masked
> {"total": 4, "made": 0, "failed": 0, "kept": 4, "seconds": S}
$ batch --resume 2>&1 | masked
> retex-combine: 0 pictures, 4 kept, S
$ batch --plan --resume
> rows 1 to 4 of 4: 0 to make, 4 kept
$ wc -l <m
> 4

# The manifest's checksums are those that zlib computes.
$ cat >../check.py <<'END'
+ import json, os, zlib
+ def crc(name):
+     return f"{zlib.crc32(open(name, 'rb').read()):08x}"
+ for row in map(json.loads, open("m")):
+     name = row["output"]
+     source = crc("s.exr") + " " + str(os.path.getsize("s.exr"))
+     print(name, row["crc32"] == crc(name), row["bytes"] == os.path.getsize(name), row["set"] == source)
+ END
$ /usr/bin/python3 ../check.py
> a.png True True True
> b.png True True True
> c.jpg True True True
> d.png True True True

# Missing, damaged, unknown and stale pictures. --verify changes nothing; --resume makes them, and no others.
$ cp -r . ../good
$ echo x >>a.png
$ rm b.png
$ sed -i 's/^d.png/d.png,"rgb(1,1,1)"/' t
$ cp a.png e.png
$ echo e.png >>t
$ find . -type f -printf '%p %T@ %s\n' | sort >../before
$ batch --verify >../verdict
= 1
$ masked <../verdict
> a.png: damaged: N bytes instead of M
> b.png: missing
> d.png: stale: its row or an image of it has changed
> e.png: unknown
> 1 of 5 pictures good; 1 missing, 1 unknown, 1 stale, 1 damaged
$ batch --verify -q --report ../report
= 1
$ grep -c '"status": "good"\|"status": "failed"' ../report
> 2
$ find . -type f -printf '%p %T@ %s\n' | sort | diff ../before -
$ batch --resume --dry-run
> a.png: Floor <- brick.jpg
> b.png: Floor <- oak.jpg, Wall <- rgb(0.5,0.25,0.125)
> d.png: Floor <- rgb(1,1,1)
> e.png: original textures
$ batch --resume --plan | sed 's/about .*//'
> rows 1 to 5 of 5: 4 to make, 1 kept (1 missing, 1 unknown, 1 stale, 1 damaged)
> to make:
$ batch --resume 2>&1 | masked
> retex-combine: a.png: Floor <- brick.jpg, 48 x 32, S
> retex-combine: b.png: Floor <- oak.jpg, Wall <- rgb(0.5,0.25,0.125), 48 x 32, S
> retex-combine: d.png: Floor <- rgb(1,1,1), 48 x 32, S
> retex-combine: e.png: original textures, 48 x 32, S
> retex-combine: 4 pictures, 1 kept, S
$ batch --verify
> 5 of 5 pictures good
$ wc -l <m
> 8
$ cmp a.png ../good/a.png
$ cmp b.png ../good/b.png
# A plan makes its trials in memory: it needs no folder, and tells the pictures' bytes.
$ mkdir ../plan
$ for f in x.png y.jpg z.exr w.tif; do
+     printf 'output,floor\n%s,brick.jpg\n' $f >../p
+     TMPDIR=/nowhere retex-combine s.exr --batch ../p --plan | sed -n 's/.* of \(.*\) and .*/\1/p'
+     ls $f 2>/dev/null
+     retex-combine -q s.exr --batch ../p --batch-root ../plan
+     stat -c %s ../plan/$f | awk '{ printf "%.3g kB\n", $1 / 1000 }'
+ done | uniq -c | sed 's/ [0-9.]* kB//'
>       2
>       2
>       2
>       2
$ cp s.exr ../cut.exr && printf '\377\377\377\377' | dd of=../cut.exr bs=1 seek=$(($(stat -c %s s.exr) / 2)) conv=notrunc 2>../log
$ retex-combine ../cut.exr --batch t --plan --memory 0
! retex-combine: error: ../cut.exr: part t0_indep3 is damaged or truncated
= 2

# A picture with the right size is damaged: only its checksum tells.
$ printf x | dd of=a.png bs=1 seek=100 conv=notrunc 2>/dev/null
$ batch --verify
> a.png: damaged: its checksum is wrong
> 4 of 5 pictures good; 1 damaged
= 1
$ batch --resume 2>&1 | masked
> retex-combine: 0 pictures, 5 kept, S
$ batch --resume --verify 2>&1 | masked
> retex-combine: a.png: Floor <- brick.jpg, 48 x 32, S
> retex-combine: 1 picture, 4 kept, S
$ batch --verify
> 5 of 5 pictures good
# All options that change pictures are noted, the cut and the size among them.
$ retex-combine -q s.exr --batch t --batch-root ../cut --mkdir --manifest ../n --depth 8 --crop 1,2,20,10 --size 10x5
$ sed 's/.*"options": "//; s/".*//' ../n | sort -u
> quality=95 cross=3 display= view= colorspace= ocio=00000000 depth=8 crop=1,2,20,10 size=10x5
$ retex-combine s.exr --batch t --batch-root ../cut --manifest ../n --depth 8 --crop 1,2,20,11 --size 10x5 --verify | tail -1
> 0 of 5 pictures good; 5 stale
# Other sources: the set, an image that keeps its name, the options, the samples, the version; an image that is gone.
$ make_set s.exr 48 32 2
$ batch --verify | cut -c 1-60
> a.png: stale: the set has changed
> b.png: stale: the set has changed
> c.jpg: stale: the set has changed
> d.png: stale: the set has changed
> e.png: stale: the set has changed
> 0 of 5 pictures good; 5 stale
$ cp ../good/s.exr .
$ cp brick.jpg oak.jpg
$ batch --verify
> b.png: stale: its row or an image of it has changed
> c.jpg: stale: its row or an image of it has changed
> 3 of 5 pictures good; 2 stale
= 1
$ cp ../good/oak.jpg .
$ batch --verify --quality 80 | tail -2
> e.png: stale: the options have changed
> 0 of 5 pictures good; 5 stale
$ batch --verify --depth 8 | tail -1
> 0 of 5 pictures good; 5 stale
$ batch --verify --texture wall=brick.jpg
> a.png: stale: its row or an image of it has changed
> d.png: stale: its row or an image of it has changed
> e.png: stale: its row or an image of it has changed
> 2 of 5 pictures good; 3 stale
= 1
$ retex-sample -q s.exr --texture floor=oak.jpg -o x.exr
$ retex-combine s.exr x.exr --batch t --manifest m --verify | tail -2
> e.png: stale: the samples have changed
> 0 of 5 pictures good; 5 stale
$ sed 's/"version": "0/"version": "7/' m >m7
$ retex-combine s.exr --batch t --manifest m7 --verify | tail -2
> e.png: stale: another version of the program made it
> 0 of 5 pictures good; 5 stale
$ rm oak.jpg
$ batch --verify
> b.png: stale: cannot read oak.jpg: No such file or directory
> c.jpg: stale: cannot read oak.jpg: No such file or directory
> 3 of 5 pictures good; 2 stale
= 1
$ batch --resume
! retex-combine: error: t:3: cannot read oak.jpg: No such file or directory
! retex-combine: error: t:4: cannot read oak.jpg: No such file or directory
= 2
$ cp ../good/oak.jpg .
$ batch --verify
> 5 of 5 pictures good

# Parts of a table make the files that one process makes, each picture once, and share a manifest or have their own.
$ mkdir ../parts
$ cp s.exr t *.jpg ../parts
$ rm ../parts/c.jpg
% cd ../parts
$ for k in 1 2 3; do batch --shard $k/3 2>&1 | masked; done
> retex-combine: a.png: Floor <- brick.jpg, 48 x 32, S
> retex-combine: 1 picture, S
> retex-combine: b.png: Floor <- oak.jpg, Wall <- rgb(0.5,0.25,0.125), 48 x 32, S
> retex-combine: c.jpg: Wall <- oak.jpg, 48 x 32, S
> retex-combine: 2 pictures, S
> retex-combine: d.png: Floor <- rgb(1,1,1), 48 x 32, S
> retex-combine: e.png: original textures, 48 x 32, S
> retex-combine: 2 pictures, S
$ for f in [a-e].???; do cmp $f ../here/$f; done
$ batch --verify
> 5 of 5 pictures good
$ rm -f [a-e].??? m
$ for k in 2 1; do retex-combine -q s.exr --batch t --rows 2-5 --shard $k/2 --manifest m$k; done
$ ls [a-e].*
> b.png
> c.jpg
> d.png
> e.png
$ cat m1 m2 >m
$ batch --verify
> a.png: missing
> 4 of 5 pictures good; 1 missing
= 1
$ batch --rows 2-5 --verify
> 4 of 4 pictures good
$ batch --rows 5-5 --shard 1/2 --plan
> 0 to make, 0 kept
$ batch --rows 2-5 --shard 3/3 --dry-run
> d.png: Floor <- rgb(1,1,1)
> e.png: original textures
$ batch --shard 7/9 --resume --report ../report 2>&1 | masked
> retex-combine: 0 pictures, 0 kept, S
$ grep '"row"' ../report | masked
# Two processes with rows in common: the second is refused before it makes anything. Killed, the first leaves them free.
% cd ../here
$ {
+     echo output,floor
+     for k in $(seq 4000); do echo "out/$k.png,\"rgb(0.$k,0.5,0)\""; done
+ } >many
$ retex-combine s.exr --batch many --manifest m -q --mkdir &
+ until [ -e out/20.png ]; do sleep .02; done
+ kill -STOP $!
+ many --shard 3/3 --mkdir
+ many --rows 1-1 --mkdir --resume
+ batch --rows 1-1 -q
+ kill -KILL $!
+ wait $! 2>/dev/null
! retex-combine: error: another process with m makes some of these rows
! retex-combine: error: another process with m makes some of these rows
= 137
$ n=$(ls out | grep -c 'png$')
+ many --resume --mkdir --report r -q
+ kept=$(grep -c '"status": "kept"' r)
+ test $kept -gt 18 && test $n -ge $kept && test $n -lt 4000 && echo "kept what was made"
> kept what was made
$ rm -f out/*.png.*
$ make_peak ../peak retex-combine s.exr --batch many --manifest m --verify
> 4000 of 4000 pictures good
$ awk '{ print ($1 < 64 ? "little" : $1) }' ../peak
> little
$ many --resume 2>&1 | masked
> retex-combine: 0 pictures, 4000 kept, S
$ ls out | wc -l
> 4000
# A line that was cut off costs its picture only; what is appended begins on a line of its own. The last line of a
# picture counts.
$ rm -r m out
$ batch -q
$ truncate -s -30 m
$ batch --verify
> e.png: unknown
> 4 of 5 pictures good; 1 unknown
= 1
$ batch --resume 2>&1 | masked
> retex-combine: e.png: original textures, 48 x 32, S
> retex-combine: 1 picture, 4 kept, S
$ batch --verify
> 5 of 5 pictures good
$ wc -l <m
> 6
$ sed 's/"crc32": "[0-9a-f]*"/"crc32": "00000000"/' m >m0
$ cat m m0 >w
$ retex-combine s.exr --batch t --manifest w --verify | tail -1
> 0 of 5 pictures good; 5 damaged
$ cat m0 m >w
$ retex-combine s.exr --batch t --manifest w --verify
> 5 of 5 pictures good

# What cannot be a manifest, and what cannot have one.
$ mkfifo pipe
$ printf 'output,floor\na.png,pipe\n' >p
$ echo text >text
$ for f in text . /dev/null none/m a.png s.exr t p; do retex-combine -q s.exr --batch p --manifest $f; done
! retex-combine: error: text is no manifest of a batch
! retex-combine: error: cannot open .: Is a directory
! retex-combine: error: /dev/null is no regular file
! retex-combine: error: cannot open none/m: No such file or directory
! retex-combine: error: a.png: the output of the table's line 2 and --manifest are the same file
! retex-combine: error: s.exr: --manifest would replace the set
! retex-combine: error: t is no manifest of a batch
! retex-combine: error: p: --manifest would replace the table
= 2
$ retex-combine -q - --batch t --manifest m <s.exr
! retex-combine: error: --manifest needs the set and the samples in files, not in standard input
= 2
$ retex-combine s.exr --batch t --verify --manifest none
! retex-combine: error: cannot open none: No such file or directory
= 2
$ cat text
> text
$ retex-combine s.exr --batch p --manifest m
! retex-combine: error: pipe is no regular file: it has no checksum
= 2
$ printf 'output,floor\n/dev/null.png,\n' >p
$ retex-combine s.exr --batch t --manifest m --plan --batch-root nowhere
! retex-combine: error: --batch-root nowhere: no such folder
= 2
$ for o in --resume \
+     --verify '--manifest m --plan --dry-run' '--manifest m --verify --plan' '--manifest m --verify --dry-run' \
+     '--rows 0-1' '--rows 3-2' '--rows 2' '--rows 1-6' '--shard 0/2' '--shard 3/2' '--shard 1-2' '--shard 1/2x'; do
+     retex-combine s.exr --batch t $o
+ done
! retex-combine: error: --resume needs the pictures' checksums: --manifest
! retex-combine: error: --verify needs the pictures' checksums: --manifest
! retex-combine: error: --plan, --dry-run and --verify without --resume exclude each other
! retex-combine: error: --plan, --dry-run and --verify without --resume exclude each other
! retex-combine: error: --plan, --dry-run and --verify without --resume exclude each other
! retex-combine: error: --rows: expected A-B, A from 1 to B, not '0-1'
! retex-combine: error: --rows: expected A-B, A from 1 to B, not '3-2'
! retex-combine: error: --rows: expected A-B, not '2'
! retex-combine: error: --rows: the table has 5 rows
! retex-combine: error: --shard: expected I/N, I from 1 to N, not '0/2'
! retex-combine: error: --shard: expected I/N, I from 1 to N, not '3/2'
! retex-combine: error: --shard: expected I/N, not '1-2'
! retex-combine: error: --shard: expected I/N, not '1/2x'
= 2
$ for o in '--manifest m' --resume --verify --plan '--rows 1-2' '--shard 1/2'; do
+     retex-combine s.exr -o x.png $o
+ done
! retex-combine: error: --manifest needs a table of pictures: --batch
! retex-combine: error: --resume needs a table of pictures: --batch
! retex-combine: error: --verify needs a table of pictures: --batch
! retex-combine: error: --plan needs a table of pictures: --batch
! retex-combine: error: --rows needs a table of pictures: --batch
! retex-combine: error: --shard needs a table of pictures: --batch
= 2
