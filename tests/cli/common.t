# What every tool answers alike: --version, wrong options, values out of range.
$ retex-diff --version
> retex-diff 0.1.0
$ retex-pack --version
> retex-pack 0.1.0
$ retex-sample --version
> retex-sample 0.1.0
$ retex-combine --version
> retex-combine 0.1.0
$ retex-denoise --version
> retex-denoise 0.1.0
$ retex-info --version
> retex-info 0.1.0
$ retex-import --version
> retex-import 0.1.0
$ retex-render --version
> retex-render 0.1.0

$ for t in diff pack sample combine denoise info render; do retex-$t --nonsense; echo $?; done
> 2
> 2
> 2
> 2
> 2
> 2
> 2
! retex-diff: error: unknown option --nonsense; try --help
! retex-pack: error: unknown option --nonsense; try --help
! retex-sample: error: unknown option --nonsense; try --help
! retex-combine: error: unknown option --nonsense; try --help
! retex-denoise: error: unknown option --nonsense; try --help
! retex-info: error: unknown option --nonsense; try --help
! retex-render: error: unknown option --nonsense; try --help

# Behind `--` stand names alone, whatever they look like.
$ for t in diff pack sample combine denoise info import render serve studio; do
+     retex-$t -- --version >out 2>err; echo "$t $? $(wc -l <out) $(grep -c 'error: ' err)"
+ done
> diff 2 0 1
> pack 2 0 1
> sample 2 0 1
> combine 2 0 1
> denoise 2 0 1
> info 2 0 1
> import 2 0 1
> render 2 0 1
> serve 2 0 1
> studio 2 0 1
$ make_set s.exr 16 12 && mv s.exr ./-q && retex-pack -q -o ./-o -- -q && retex-info -q --check -- -o && retex-diff -q -- -q -q

# --help goes to standard output and names every option.
$ for t in diff pack sample combine denoise info render; do
+     retex-$t --help >help || echo $t
+     grep -c -e '--threads N' help
+ done
> 1
> 1
> 1
> 1
> 1
> 1
> 1
$ for t in diff pack sample combine denoise info render; do retex-$t --help | awk 'length > 79'; done

# It lists what the man page has, which is nothing that is refused.
$ "$TESTS/options.sh"

$ retex-pack --threads many set.exr
! retex-pack: error: --threads: expected a whole number from 0 to 256, not 'many'
= 2
$ retex-pack --threads 257 set.exr
! retex-pack: error: --threads: expected a whole number from 0 to 256, not '257'
= 2
$ retex-pack --threads
! retex-pack: error: --threads needs an argument: N
= 2
$ retex-diff --json=yes a b
! retex-diff: error: --json takes no argument
= 2
$ retex-diff --part:x=1 a b
! retex-diff: error: --part takes no modifiers (':x=1')
= 2
$ retex-diff -Q a b
! retex-diff: error: unknown option -Q; is -q meant?
= 2

# Control characters of a file's name do not reach the terminal.
$ retex-diff "$(printf 'a\033[2J')" b
! retex-diff: error: cannot read a?[2J: No such file or directory
= 2

# A full disk and a closed pipe are seen, --help's text included.
$ retex-diff --help >/dev/full
! retex-diff: error: standard output: No space left on device
= 2
$ { sleep 0.3; retex-diff --help; echo $? >&2; } | :
! 141
# Where SIGPIPE is ignored it is an error like others.
$ { trap '' PIPE; sleep 0.3; retex-diff --help; echo $? >&2; } | :
! retex-diff: error: standard output: Broken pipe
! 2
$ retex-diff --version >&-
! retex-diff: error: standard output: Bad file descriptor
= 2

# A terminal is neither read nor written: `script` is one.
$ skip-without script no terminal to try
$ make_set s.exr
$ for c in 'retex-render s.pov' 'retex-combine s.exr -o -' 'retex-combine s.exr -o /dev/stdout' \
+     'retex-combine s.exr -o /dev/tty' 'retex-pack s.exr'; do
+     timeout 10 script -qec "$c" /dev/null </dev/null
+ done | tr -d '\r'
> retex-render: error: no output file: give -o FILE, or redirect standard output
> retex-combine: error: standard output is a terminal; redirect it or name a file: -o FILE
> retex-combine: error: /dev/stdout is a terminal; name a file: -o FILE
> retex-combine: error: /dev/tty is a terminal; name a file: -o FILE
> retex-pack: error: no output file: give -o FILE, or redirect standard output
$ for c in 'retex-sample - --texture a=b -o x.exr' 'retex-combine - -o x.png' 'retex-combine s.exr --batch -' \
+     'retex-pack - -o x.retex' 'retex-denoise - -o x.exr' 'retex-info -' 'retex-diff - s.exr'; do
+     sleep 1 | timeout 10 script -qec "$c" /dev/null
+ done | tr -d '\r'
> retex-sample: error: standard input is a terminal; expected a set, as from retex-render
> retex-combine: error: standard input is a terminal; expected a set, as from retex-render or retex-sample
> retex-combine: error: standard input is a terminal; expected a table
> retex-pack: error: standard input is a terminal; expected a set, as from retex-render
> retex-denoise: error: standard input is a terminal; expected a set, as from retex-render
> retex-info: error: standard input is a terminal; expected a set, as from retex-render
> retex-diff: error: standard input is a terminal; expected an OpenEXR file
