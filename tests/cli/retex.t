# retex COMMAND: becomes the tool beside it, or one in $PATH; lists and explains the commands.
$ retex --version
> retex 0.1.0

# The list is of the programs beside it, each with the first sentence of what it says itself, in one line.
$ retex
> Usage: retex COMMAND [ARGUMENT ...]
>        retex help [COMMAND]
>
> Change the textures of a rendered picture without rendering it again. The
> commands are:
>
>   try      Make a web page of a model with another floor
>   import   Make a scene of a model of another program
>   render   Render a scene in POV-Ray's language into a set for retexturing
>   denoise  Remove the noise from a set once, and so from all its retextures
>   sample   Filter new textures at a set's footprints, for retex-combine
>   combine  Make a picture from a set, with its original textures or new ones
>   pack     Compress a set to one small file, or decompress one
>   info     Describe a set, samples or a pack, or check that it is whole
>   diff     Compare picture A with the reference B
>   serve    Serve pictures of sets and packs, with the textures that URLs name
>   studio   Retexture a model in the browser: see it, choose surfaces, render, change textures
>
> retex COMMAND is the program retex-COMMAND; --help after it lists its options,
> and retex help COMMAND shows its man page.
>
>   -h, --help                  print this help and exit
>   -V, --version               print the version and exit
$ retex --help | cmp - help.txt
! cmp: help.txt: No such file or directory
= 2
$ retex --help >help.txt
$ retex | cmp - help.txt && awk 'length > 79' help.txt
>   studio   Retexture a model in the browser: see it, choose surfaces, render, change textures
$ for tool in "$(dirname "$(command -v retex)")"/retex-*; do
+     name=${tool##*/retex-}
+     grep -q "^  $name  *[A-Z]" help.txt || echo "$name is not in the list"
+ done

# The same arguments, output, messages and exit status.
$ make_set room.exr 64 48 && retex info room.exr >a.txt && retex-info room.exr | cmp - a.txt
$ retex combine room.exr --texture 'Floor=rgb(.5,.1,.1)' -o a.exr -q &&
+     retex-combine room.exr --texture 'Floor=rgb(.5,.1,.1)' -o b.exr -q && cmp a.exr b.exr
$ retex info none.exr
! retex-info: error: cannot read none.exr: No such file or directory
= 2
$ retex info --jsn room.exr
! retex-info: error: unknown option --jsn; is --json meant?
= 2
$ retex diff a.exr room.exr --fail-abs 0 >out.txt
= 1
$ cat room.exr | retex info - --json >out.txt
$ head -c 14 out.txt
> {"file_bytes":
$ retex render --help >out.txt
$ head -1 out.txt
> Usage: retex-render [options] SCENE.pov|FILE.ini

# It takes the tool beside it, whatever $PATH says; and one of $PATH where none is beside it.
% bin=$(dirname "$(command -v retex)")
$ mkdir path
$ printf '#!/bin/sh\necho "mine: $*"\n' >path/retex-info
$ cp path/retex-info path/retex-mine
$ chmod +x path/retex-*
$ PATH=$PWD/path:$PATH retex info --version
> retex-info 0.1.0
$ PATH=$PWD/path:$PATH retex mine a 'b  c' --help
> mine: a b  c --help
$ ln -s "$bin/retex" linked
$ PATH=/usr/bin:/bin ./linked info --version
> retex-info 0.1.0
$ mkdir other
$ cp "$bin/retex" other
$ PATH=$bin:/usr/bin:/bin other/retex info --version
> retex-info 0.1.0

# Not a command: one line with the nearest name.
$ retex rendr
! retex: error: there is no command 'rendr'; is render meant?
= 2
$ retex combin room.exr
! retex: error: there is no command 'combin'; is combine meant?
= 2
$ retex nonsense
! retex: error: there is no command 'nonsense'; try --help
= 2
$ retex ../bin/retex-info
! retex: error: there is no command '../bin/retex-info'; try --help
= 2
$ mkdir other/retex-folder && cp path/retex-mine other/retex-folder/tool && other/retex folder/tool
! retex: error: there is no command 'folder/tool'; try --help
= 2
$ other/retex | grep folder
= 1
$ retex ''
! retex: error: there is no command ''; try --help
= 2
$ retex -q info
! retex: error: unknown option -q; options of a command follow its name, as in retex render --help
= 2
$ retex --texture
! retex: error: unknown option --texture; options of a command follow its name, as in retex render --help
= 2
$ retex help rendr
! retex: error: there is no command 'rendr'; is render meant?
= 2
$ retex help ../retex-info
! retex: error: there is no command '../retex-info'; try --help
= 2
$ retex help combine pack
! retex: error: help of one command at a time
= 2

# Pages of the manual: from the source's tree, or beside an installed program; without man, --help.
$ mkdir -p bin share/man/man1 fake
$ cp "$(command -v retex)" bin
$ printf '#!/bin/sh\necho "man $*"\n' >fake/man
$ chmod +x fake/man
$ : >share/man/man1/retex-combine.1
$ : >share/man/man1/retex-pack.1.gz
$ mkdir -p share/man/man5
$ : >share/man/man5/retex-set.5
$ for page in combine retex-combine pack set; do PATH=$PWD/fake:$PATH bin/retex help $page | sed "s|$PWD/||"; done
> man bin/../share/man/man1/retex-combine.1
> man bin/../share/man/man1/retex-combine.1
> man bin/../share/man/man1/retex-pack.1.gz
> man bin/../share/man/man5/retex-set.5
$ mkdir -p tree/build/bin tree/man
$ cp bin/retex tree/build/bin
$ : >tree/man/retex-combine.1
$ : >tree/man/retex.1
$ for page in combine retex; do PATH=$PWD/fake:$PATH tree/build/bin/retex help $page; done | sed "s|$PWD/||"
> man tree/build/bin/../../man/retex-combine.1
> man tree/build/bin/../../man/retex.1
$ PATH=$bin:/nonexistent bin/retex help combine >/dev/null
$ PATH=$bin:/nonexistent retex help combine >out.txt
$ retex-combine --help | head -1
> Usage: retex-combine SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE
$ PATH=/nonexistent "$bin/retex" help combine
> Usage: retex-combine SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE
>
> Make a picture from a set, with its original textures or new ones.
>
>       --texture[:opts] NAME=IMAGE
>                               put IMAGE, a file or a colour, on target NAME;
>                               opts as in retex-sample
>       --light NAME=VALUE      give lamp NAME another brightness or colour: 0,
>                               2.5, #ffd0a0, 3000K, 1.5*3000K
>       --finish TARGET=NAME    give TARGET another of the finishes that the set
>                               has for it
>       --solo NAME             turn off all lamps but NAME, and those of --light
>       --size WxH              a smaller picture: of WxH pixels, or Wx or xH to
>                               keep the aspect
>       --crop X,Y,W,H          only this rectangle of the picture
>       --preset FILE           what --save-preset wrote: textures, lamps,
>                               finishes, exposure, view; options go first
>       --save-preset FILE      write these options to a file, for --preset
>       --exposure STOPS        make the picture brighter, by 2^STOPS; -30 to 30
>       --auto-exposure         bring the picture's mean brightness to a middle
>                               grey, before --exposure
>       --white-balance KELVINS
>                               make light of so many kelvins white, 1000 to
>                               25000
>       --display NAME          OCIO display for the picture
>       --view NAME             view of that display: Standard, Filmic, Neutral,
>                               Raw, or one of $OCIO
>       --colorspace NAME       write in this OCIO colour space instead
>       --quality N             quality of a JPEG, 1 to 100; default 95
>       --depth 8|16            bits of a PNG, TIFF or other file of integers;
>                               default 8, of TIFF and DPX 16
>       --cross 0|2|3           use cross terms of paths with at most this many
>                               hits; default 3
>       --error FILE.exr        write the expected error against a new render,
>                               per pixel
>       --solve FILE            print which colours, lamps and finishes come
>                               nearest to a picture, or to a colour
>       --free LIST             with --solve: what is sought, as
>                               TARGET,light:LAMP,color:LAMP,finish:TARGET
>       --region X,Y,W,H        with --solve: only this part of the picture
>                               counts
>       --batch FILE.csv        make one picture per row of a table: its file,
>                               then one texture per target
>       --memory SIZE           with --batch: keep the set and samples in memory
>                               if they take at most SIZE; default 2048 MB
>       --frames A-B[xS]        make frames A to B, every S-th; %04d in names is
>                               the frame's number
>       --dry-run               check the table, print the pictures it would
>                               make, and stop
>       --keep-going            continue after a picture that fails
>       --mkdir                 create missing folders of pictures
>       --batch-root DIR        write pictures only below DIR
>       --report FILE.json      write the result of each picture; - is standard
>                               output
>       --rows A-B              with --batch: only the rows A to B of the table
>       --shard I/N             with --batch: only the Ith of N parts of these
>                               rows
>       --manifest FILE         append the sources and the checksum of each
>                               picture
>       --resume                make only pictures that are missing or differ
>                               from the manifest
>       --verify                compare pictures and sources with the manifest;
>                               make nothing without --resume
>       --plan                  print how many pictures it would make, their size
>                               and time, and stop
>       --progress json         print progress as lines of JSON on standard error
>
>   -o, --output FILE           write to FILE; - is standard output
>       --threads N             use N threads; 0, the default, uses all cores
>       --safe                  refuse devices and rare picture formats; scenes
>                               read only their own folder; limits of 2G, 60
>                               seconds and 33177600 pixels, unless others are
>                               given; also RETEX_SAFE=1
>       --accept-damaged        read damaged pictures as far as possible, with a
>                               warning; also RETEX_ACCEPT_DAMAGED=1
>       --max-memory SIZE       use at most SIZE of memory, such as 4G, 512M, or
>                               a number of MB; default three quarters of the
>                               machine's; also RETEX_MAX_MEMORY
>       --max-time SECONDS      stop after this time; also RETEX_MAX_TIME
>       --max-pixels N          refuse pictures of more pixels; default
>                               268435456; also RETEX_MAX_PIXELS
>   -q, --quiet                 print only warnings and errors
>   -v, --verbose               print more
>   -h, --help                  print this help and exit
>   -V, --version               print the version and exit
$ retex help | cmp - help.txt
$ retex >/dev/full
! retex: error: standard output: No space left on device
= 2
