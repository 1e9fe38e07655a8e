# Signals that end a tool: one line, nothing left behind, and the signal again, so that a shell sees 128 + its number.
# `end SIGNAL COMMAND…` sends it once the tool runs, and kills what has not ended after five seconds: 137.
$ cat >end <<'END'
+ signal=$1
+ shift
+ exec 4<never
+ env --default-signal=INT,TERM,HUP "$@" <&4 &
+ tool=$!
+ for i in $(seq 500); do [ "$(ls /proc/$tool/task | wc -l)" -lt 2 ] || break; sleep 0.02; done
+ sleep ${AFTER:-0.1}
+ kill -$signal $tool
+ [ -z "${AGAIN-}" ] || { sleep 0.1; kill -$AGAIN $tool; }
+ sh -c "sleep 5; kill -KILL $tool" 2>/dev/null &
+ late=$!
+ wait $tool 2>/dev/null
+ echo $?
+ kill $late 2>/dev/null
+ END
$ cp -r "$SCENES/cornell-box" .
$ make_set set.exr 16 16
$ mkfifo never
$ mkdir out
$ chmod +x end

# Each tool, while it waits for its input or traces.
$ (
+     sleep 900 >never &
+     echo $! >writer
+ )
$ for s in INT TERM HUP; do
+     for t in "retex-info -" "retex-diff - set.exr" "retex-pack - -o out/a.retex" "retex-denoise - -o out/a.exr" \
+         "retex-sample - --texture floor=rgb(1,0,0) -o out/a.exr" "retex-combine - -o out/a.png" \
+         "retex-combine set.exr --batch -" \
+         "retex-render --spp 1000000 --size 16x16 -t floor -o out/a.exr cornell-box/cornell-box.pov"; do
+         ./end $s $t
+     done
+ done
> 130
> 130
> 130
> 130
> 130
> 130
> 130
> 130
> 143
> 143
> 143
> 143
> 143
> 143
> 143
> 143
> 129
> 129
> 129
> 129
> 129
> 129
> 129
> 129
! retex-info: error: ended by SIGINT
! retex-diff: error: ended by SIGINT
! retex-pack: error: ended by SIGINT
! retex-denoise: error: ended by SIGINT
! retex-sample: error: ended by SIGINT
! retex-combine: error: ended by SIGINT
! retex-combine: error: ended by SIGINT
! retex-render: error: ended by SIGINT
! retex-info: error: ended by SIGTERM
! retex-diff: error: ended by SIGTERM
! retex-pack: error: ended by SIGTERM
! retex-denoise: error: ended by SIGTERM
! retex-sample: error: ended by SIGTERM
! retex-combine: error: ended by SIGTERM
! retex-combine: error: ended by SIGTERM
! retex-render: error: ended by SIGTERM
! retex-info: error: ended by SIGHUP
! retex-diff: error: ended by SIGHUP
! retex-pack: error: ended by SIGHUP
! retex-denoise: error: ended by SIGHUP
! retex-sample: error: ended by SIGHUP
! retex-combine: error: ended by SIGHUP
! retex-combine: error: ended by SIGHUP
! retex-render: error: ended by SIGHUP
$ ls -A out

# Where it is at work: reading a scene, one pixel of which takes minutes, with rows to keep and without, filtering.
$ echo '#while(1) #end' >endless.pov
$ AFTER=0.5 ./end TERM retex-render endless.pov -o out/a.exr
> 143
! retex-render: error: ended by SIGTERM
$ for o in "" --resume "--plain --noise 0.0001" "--aov irradiance" --caustics-guide; do
+     AFTER=0.5 ./end TERM retex-render -q --spp 1000000 -t floor $o cornell-box/cornell-box.pov -o out/a.exr
+ done
> 143
> 143
> 143
> 143
> 143
! retex-render: error: ended by SIGTERM
! retex-render: error: ended by SIGTERM
! retex-render: error: ended by SIGTERM
! retex-render: error: ended by SIGTERM
! retex-render: error: ended by SIGTERM
$ ls -A out
$ retex-render -q --spp 2 --size 480x360 -t floor cornell-box/cornell-box.pov -o noisy.exr
$ make_set big.exr 1000 1000
$ for t in "retex-denoise --threads 1 --radius 10 noisy.exr -o out/a.exr" "retex-pack noisy.exr -o out/a.retex" \
+     "retex-pack --lossless big.exr -o out/a.retex" "retex-sample big.exr --texture Wall=big.exr -o out/a.exr" \
+     "retex-diff big.exr big.exr --all-parts"; do
+     ./end TERM $t
+ done
> 143
> 143
> 143
> 143
> 143
! retex-denoise: error: ended by SIGTERM
! retex-pack: error: ended by SIGTERM
! retex-pack: error: ended by SIGTERM
! retex-sample: error: ended by SIGTERM
! retex-diff: error: ended by SIGTERM
$ ls -A out

# OpenImageIO's own temporary file, of a format that needs a name to write to.
$ mkdir temporary
$ if retex-combine -q set.exr -o small.jp2 2>err; then
+     TMPDIR=$PWD/temporary retex-combine -q big.exr -o out/a.jp2 &
+     tool=$!
+     for i in $(seq 1000); do
+         [ -z "$(ls temporary)" ] || break
+         sleep 0.01
+     done
+     ls temporary | sed 's/.*\././'
+     kill -TERM $tool
+     wait $tool || true
+ else
+     echo .jp2 # OpenImageIO cannot write it here
+ fi 2>/dev/null
> .jp2
$ ls -A temporary out
> out:
>
> temporary:
$ rm big.exr

# A reader that goes away ends a tool as SIGPIPE does: without a word, at once, and nothing is left; the report is
# written. `gone COMMAND…` starts it when nobody reads its output any more.
$ make_set s.exr 48 32
% gone() { { sleep 0.3; "$@"; echo $? >&2; } | :; }
$ {
+     echo output,floor
+     for k in $(seq 3000); do echo "a-folder-of-a-long-name-$k.png,\"rgb(0,0,1)\""; done
+ } >t.csv
$ for c in "retex-info s.exr" "retex-info --json s.exr" "retex-diff s.exr s.exr" "retex-pack s.exr" \
+     "retex-sample s.exr --texture floor=rgb(1,0,0)" "retex-combine s.exr" "retex-denoise noisy.exr" \
+     "retex-render --size 16x16 --spp 1 -t floor cornell-box/cornell-box.pov" \
+     "retex-render --size 16x16 --spp 1 --list-targets cornell-box/cornell-box.pov" \
+     "retex-combine s.exr --batch t.csv --dry-run" "retex-combine s.exr --batch t.csv --dry-run --report out/report" \
+     "retex-import --help" "retex-serve --version" "retex help" "retex info s.exr"; do
+     gone $c 2>&1
+ done
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
> 141
$ sed -n 's/.*"error"/"error"/p' out/report
> "error": "ended by SIGPIPE",
$ ls -A out
> report
$ rm out/report
$ {
+     retex-combine s.exr --batch t.csv --dry-run
+     echo $? >&2
+ } | head -1
> a-folder-of-a-long-name-1.png: Floor <- rgb(0,0,1)
! 141
$ retex-pack s.exr | head -c 3 | wc -c
> 3
$ mkfifo pipe.exr
$ {
+     retex-combine -q noisy.exr -o pipe.exr
+     echo $? >&2
+ } &
+ head -c 1 pipe.exr | wc -c
+ wait
> 1
! 141

# Ignored signals stay ignored.
$ AGAIN=TERM ./end HUP sh -c 'trap "" HUP; exec retex-render -q --spp 1000000 -o out/a.exr cornell-box/cornell-box.pov'
> 143
! retex-render: error: ended by SIGTERM

# A file that would grow beyond the limit is a full disk: no signal ends the tool, nothing is left, the old file is
# whole.
$ cp set.exr out/old.exr
$ make_set wide.exr 256 256
$ retex-pack -q --lossless wide.exr -o wide.retex
$ (
+     ulimit -f 8
+     for t in "retex-render -q --spp 1 --size 64x64 -t floor cornell-box/cornell-box.pov -o out/old.exr" \
+         "retex-render -q --spp 1 --size 64x64 -t floor --resume cornell-box/cornell-box.pov -o out/new.exr" \
+         "retex-render -q --spp 1 --size 64x64 --plain cornell-box/cornell-box.pov -o out/new.tif" \
+         "retex-sample wide.exr --texture floor=rgb(1,0,0) -o out/old.exr" "retex-combine wide.exr -o out/new.exr" \
+         "retex-combine wide.exr -o out/new.pfm" "retex-denoise noisy.exr -o out/new.exr" \
+         "retex-pack --lossless wide.exr -o out/new.retex" "retex-pack --unpack wide.retex -o out/new.exr"; do
+         $t
+         echo $?
+     done 2>&1
+ ) | sed 's/in [^:]*:/in DIR:/; s/tif: cannot write.*/tif: cannot write/'
> retex-render: error: cannot write a temporary file in DIR: File too large
> 2
> retex-render: error: cannot write out/new.exr.partial: File too large
> 2
> retex-render: error: cannot write out/new.tif: File too large
> 2
> retex-sample: error: cannot write a temporary file in DIR: File too large
> 2
> retex-combine: error: cannot write out/new.exr: File too large
> 2
> retex-combine: error: cannot write out/new.pfm: File too large
> 2
> retex-denoise: error: cannot write out/new.exr: File too large
> 2
> retex-pack: error: cannot write out/new.retex: File too large
> 2
> retex-pack: error: cannot write out/new.exr: File too large
> 2
$ cmp set.exr out/old.exr
$ ls -A out
> new.exr.partial
> old.exr
$ for t in "retex-info set.exr" "retex-diff set.exr set.exr"; do
+     (
+         ulimit -f 0
+         $t 3>&1 >out/text 2>&3
+         echo $?
+     ) | cat
+ done
> retex-info: error: standard output: File too large
> 2
> retex-diff: error: standard output: File too large
> 2

$ kill $(cat writer) 2>/dev/null || true
