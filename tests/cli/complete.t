# Completion. --complete of the tools says what can stand in place of the last word; bash, zsh and fish call it.
$ make_set room.exr 64 48
$ cp room.exr 'my room.exr'
$ retex-pack -q room.exr -o room.retex
$ mkdir folder
$ touch oak.jpg oak.txt table.csv
$ cat >box.pov <<'END'
+ camera { location <0,1,-3> look_at 0 }
+ light_source { <1,3,-3> 1 }
+ #declare Floor = pigment { rgb .5 }
+ #declare Wall = pigment { rgb .7 }
+ plane { y, -1 pigment { Floor } }
+ plane { z, 5 pigment { Wall } }
+ END

# Words without a tab are for people, here without what --help says.
$ retex-info --complete ''
> :files		exr retex
$ retex-info --complete --
> --json	print the manifest and the sizes as JSON
> --check	check the checksums of all parts; exit status 1 if one is wrong
> --layers	write the set's images as the layers of a flat EXR, for compositors
> --output	write to FILE; - is standard output
> --threads	use N threads; 0, the default, uses all cores
> --safe	refuse devices and rare picture formats; scenes read only their own folder; limits of 2G, 60 seconds and 33177600 pixels, unless others are given; also RETEX_SAFE=1
> --accept-damaged	read damaged pictures as far as possible, with a warning; also RETEX_ACCEPT_DAMAGED=1
> --max-memory	use at most SIZE of memory, such as 4G, 512M, or a number of MB; default three quarters of the machine's; also RETEX_MAX_MEMORY
> --max-time	stop after this time; also RETEX_MAX_TIME
> --max-pixels	refuse pictures of more pixels; default 268435456; also RETEX_MAX_PIXELS
> --quiet	print only warnings and errors
> --verbose	print more
> --help	print this help and exit
> --version	print the version and exit
$ retex-info --complete - | cut -f1 | tr '\n' ' '
> --json --check --layers --output -o --threads --safe --accept-damaged --max-memory --max-time --max-pixels --quiet -q --verbose -v --help -h --version -V
$ retex-combine --complete room.exr --texture ''
> Floor=	40.0 % of the picture
> Wall=	40.0 % of the picture
$ retex-combine --complete room.retex -o x.png --cross 2 -q --texture Fl
> Floor=	40.0 % of the picture
> Wall=	40.0 % of the picture
$ retex-combine --complete none.exr --texture ''
$ retex-combine --complete --texture ''
$ retex-combine --complete box.pov --texture ''
$ mkfifo pipe && retex-combine --complete pipe --texture ''
$ retex-combine --complete room.exr --texture Floor=oa
> :files	Floor=	
$ retex-combine --complete room.exr --texture:scale=2 Wall=
> :files		exr
$ retex-combine --complete room.exr --texture=Wall=folder/
> :files	--texture=Wall=	
$ retex-combine --complete room.exr ''
> :files		exr
$ retex-combine --complete room.exr room.exr ''
$ retex-combine --complete -- ''
> :files		exr retex
$ retex-combine --complete -- -
> :files		exr retex
$ retex-combine --complete room.exr -- ''
> :files		exr
$ retex-combine --complete --batch ''
> :files		csv
$ retex-combine --complete --batch=
> :files	--batch=	csv
$ retex-combine --complete --batch-root ''
> :folders	
$ retex-combine --complete --error ''
> :files		exr
$ retex-combine --complete -o ''
> :files		
$ retex-combine --complete -ox
> :files	-o	
$ retex-combine --complete -qo ''
> :files		
$ retex-combine --complete --quality ''
$ retex-combine --complete --quality=
$ retex-combine --complete --no-such=
$ retex-combine --complete --memory 1 ''
> :files		exr retex
$ retex-combine --complete --cross ''
> 0	
> 2	
> 3	
$ retex-combine --complete --cross=
> --cross=0	
> --cross=2	
> --cross=3	
$ retex-combine --complete --progress ''
> json	
$ retex-combine --complete --texture: | cut -f1 | tr '\n' ' '
> --texture:scale= --texture:rotate= --texture:offset= --texture:flip= --texture:width= --texture:wrap= --texture:repeat= --texture:colorspace= --texture:finish= --texture:normal= --texture:grout= --texture:groutcolor= --texture:vary= --texture:tiles= --texture:at= --texture:hue= --texture:saturation= --texture:gain= --texture:gamma= --texture:contrast= --texture:blur= --texture:invert= --texture:tint= --texture:colorize=
$ retex-combine --complete --texture:scale=2:wrap=r
> --texture:scale=2:wrap=repeat	
> --texture:scale=2:wrap=mirror	
> --texture:scale=2:wrap=clamp	
> --texture:scale=2:wrap=black	
$ retex-combine --complete --texture:scale=
$ retex-render --complete --layout ''
> footprints	
> paper	
$ retex-render --complete --aov depth,alb | head -3
> depth,beauty	
> depth,depth	
> depth,albedo	
$ retex-render --complete ''
> :files		pov ini
$ retex-render --complete --control ''
> :files		exr retex
$ retex-render --complete --list-targets=
> :files	--list-targets=	
$ retex-render --complete --list-targets ''
> :files		pov ini
$ retex-serve --complete ''
> :folders	
$ retex-diff --complete a.exr ''
> :files		
$ retex-pack --complete --web ''
> :folders	
$ retex-import --complete --up ''
> y	
> z	

# Targets of scenes, by --list-targets, if that takes no more than a second.
$ RETEX_MAX_TIME=60 retex-render --complete box.pov -q -D clock=1 -t ''
> Floor	57.71 % of the picture
> Wall	42.29 % of the picture
$ RETEX_MAX_TIME=60 retex-render --complete box.pov --replace '' | cut -f1
> Floor=
> Wall=
$ echo '#while (1) #end' >endless.pov
$ retex-render --complete endless.pov -t ''
$ echo 'nonsense' >wrong.pov
$ retex-render --complete wrong.pov -t ''

# Names of targets come from files: what a shell might obey, or a terminal, is left out.
$ make_set named.exr 64 48 'name:A plain wall' 'name:B$(touch x)' && retex-combine --complete named.exr --texture ''
> A plain wall=	40.0 % of the picture
$ for name in 'a;b' 'a`b' "$(printf 'a\033[1m')" "$(printf 'a\tb')" 'a"b' "a'b" 'a\b' 'a|b' '-a' '~a' 'a!b' 'a&b' \
+     'a<b' 'a*b' ' '; do
+     make_set x.exr "name:$name" && retex-combine --complete x.exr --texture ''
+ done | grep -v ^Wall
= 1
$ make_set x.exr 'name:Größe' && retex-combine --complete x.exr --texture ''
> Größe=	40.0 % of the picture
> Wall=	40.0 % of the picture

# The values in the tables are those that the tools' own messages name.
$ for option in layout filter control-mode control-data; do
+     retex-render --$option '?' box.pov 2>&1 | sed 's/.*expected //; s/, not .*//; s/, / /g; s/ or / /' |
+         tr ' ' '\n' >a.txt
+     retex-render --complete --$option '' | cut -f1 | cmp - a.txt && cat a.txt | tr '\n' ' '
+ done
> footprints paper box gaussian unbiased halves biased biased unbiased
$ retex-render --aov '?' box.pov 2>&1 | sed 's/.*expected //; s/, not .*//; s/, / /g' | tr ' ' '\n' >a.txt
$ retex-render --complete --aov '' | cut -f1 | cmp - a.txt
$ for value in $(retex-render --complete --layout '' | cut -f1); do
+     retex-render --layout $value box.pov --size 8x6 --spp 1 -t Floor -q -o /dev/null || echo $value
+ done
$ for value in $(retex-combine --complete --texture:wrap= | cut -f1 | sed 's/.*=//'); do
+     retex-combine room.exr --texture:wrap=$value Floor=rgb\(1,0,0\) -q -o /dev/null || echo $value
+ done

# retex: commands, and what their tools say.
$ retex --complete '' | cut -f1 | tr '\n' ' '
> try import render denoise sample combine pack info diff serve studio help
$ retex --complete --
> --help	print this help and exit
> --version	print the version and exit
$ retex --complete help '' | cut -f1 | tr '\n' ' '
> try import render denoise sample combine pack info diff serve studio
$ retex --complete combine room.exr --texture ''
> Floor=	40.0 % of the picture
> Wall=	40.0 % of the picture
$ retex --complete combine ''
> :files		exr retex
$ retex --complete nonsense ''
$ retex --complete help combine ''

# Installed, in real shells. For each line: what the key of completion makes of it, and all candidates.
$ "$TESTS/../install/stage.sh" install "$PWD/a root" /usr &&
+     find 'a root/usr/share' -path '*complet*' ! -type d -o -path '*/zsh/*' ! -type d | sort
> a root/usr/share/bash-completion/completions/retex
> a root/usr/share/bash-completion/completions/retex-combine
> a root/usr/share/bash-completion/completions/retex-denoise
> a root/usr/share/bash-completion/completions/retex-diff
> a root/usr/share/bash-completion/completions/retex-import
> a root/usr/share/bash-completion/completions/retex-info
> a root/usr/share/bash-completion/completions/retex-pack
> a root/usr/share/bash-completion/completions/retex-render
> a root/usr/share/bash-completion/completions/retex-sample
> a root/usr/share/bash-completion/completions/retex-serve
> a root/usr/share/bash-completion/completions/retex-studio
> a root/usr/share/bash-completion/completions/retex-try
> a root/usr/share/fish/vendor_completions.d/retex-combine.fish
> a root/usr/share/fish/vendor_completions.d/retex-denoise.fish
> a root/usr/share/fish/vendor_completions.d/retex-diff.fish
> a root/usr/share/fish/vendor_completions.d/retex-import.fish
> a root/usr/share/fish/vendor_completions.d/retex-info.fish
> a root/usr/share/fish/vendor_completions.d/retex-pack.fish
> a root/usr/share/fish/vendor_completions.d/retex-render.fish
> a root/usr/share/fish/vendor_completions.d/retex-sample.fish
> a root/usr/share/fish/vendor_completions.d/retex-serve.fish
> a root/usr/share/fish/vendor_completions.d/retex-studio.fish
> a root/usr/share/fish/vendor_completions.d/retex-try.fish
> a root/usr/share/fish/vendor_completions.d/retex.fish
> a root/usr/share/zsh/site-functions/_retex
$ RETEX_MAX_TIME=60 "$TESTS/complete.sh" bash "$PWD/a root/usr/share/bash-completion/completions" | tee bash.txt
> retex-combine : <retex-combine>
>     all: <retex-combine><a root><folder><my room.exr><named.exr><room.exr><room.retex><x.exr>
> retex-combine my: <retex-combine><my room.exr>
>     all: <retex-combine><my room.exr>
> retex-combine "my ro: <retex-combine><my room.exr>
>     all: <retex-combine><my room.exr>
> retex-combine ~/ro: <retex-combine><HOME/room.>
>     all: <retex-combine><HOME/room.exr><HOME/room.retex>
> retex-combine room.exr --texture : <retex-combine><room.exr><--texture>
>     all: <retex-combine><room.exr><--texture><Floor=><Wall=>
> retex-combine room.exr --texture Fl: <retex-combine><room.exr><--texture><Floor=>
>     all: <retex-combine><room.exr><--texture><Floor=>
> retex-combine my\ room.exr --texture W: <retex-combine><my room.exr><--texture><Wall=>
>     all: <retex-combine><my room.exr><--texture><Wall=>
> retex-combine "my room.exr" --texture W: <retex-combine><my room.exr><--texture><Wall=>
>     all: <retex-combine><my room.exr><--texture><Wall=>
> retex-combine room.exr --texture Floor=oa: <retex-combine><room.exr><--texture><Floor=oak.>
>     all: <retex-combine><room.exr><--texture><Floor=oak.jpg><oak.txt>
> retex-combine room.exr --texture=Floor=fo: <retex-combine><room.exr><--texture=Floor=folder/>
>     all: <retex-combine><room.exr><--texture=Floor=folder>
> retex-combine room.exr --texture:scale=2:wr: <retex-combine><room.exr><--texture:scale=2:wrap=>
>     all: <retex-combine><room.exr><--texture:scale=2:wrap=>
> retex-combine room.exr --texture:wrap=mir: <retex-combine><room.exr><--texture:wrap=mirror>
>     all: <retex-combine><room.exr><--texture:wrap=mirror>
> retex-combine room.exr --cros: <retex-combine><room.exr><--cross>
>     all: <retex-combine><room.exr><--cross>
> retex-combine room.exr --cross : <retex-combine><room.exr><--cross>
>     all: <retex-combine><room.exr><--cross><0><2><3>
> retex-combine room.exr --batch : <retex-combine><room.exr><--batch>
>     all: <retex-combine><room.exr><--batch><a root><folder><table.csv>
> retex-combine room.exr --batch-root=: <retex-combine><room.exr><--batch-root=>
>     all: <retex-combine><room.exr><--batch-root=a root><folder>
> retex-info --: <retex-info><-->
>     all: <retex-info><--accept-damaged><--check><--help><--json><--layers><--max-memory><--max-pixels><--max-time><--output><--quiet><--safe><--threads><--verbose><--version>
> retex-render box: <retex-render><box.pov>
>     all: <retex-render><box.pov>
> retex-render --layout p: <retex-render><--layout><paper>
>     all: <retex-render><--layout><paper>
> retex-render --layout=p: <retex-render><--layout=paper>
>     all: <retex-render><--layout=paper>
> retex-render --aov depth,met: <retex-render><--aov><depth,metallic>
>     all: <retex-render><--aov><depth,metallic>
> retex-render box.pov -t : <retex-render><box.pov><-t>
>     all: <retex-render><box.pov><-t><Floor><Wall>
> retex comb: <retex><combine>
>     all: <retex><combine>
> retex help com: <retex><help><combine>
>     all: <retex><help><combine>
> retex combine room.exr --texture : <retex><combine><room.exr><--texture>
>     all: <retex><combine><room.exr><--texture><Floor=><Wall=>
> retex-combine named.exr --texture A: <retex-combine><named.exr><--texture><A plain wall=>
>     all: <retex-combine><named.exr><--texture><A plain wall=>
# zsh makes the same of them but for what is printed here, after bash's.
$ RETEX_MAX_TIME=60 "$TESTS/complete.sh" zsh "$PWD/a root/usr/share/zsh/site-functions" | diff bash.txt -
> 18,19c18,19
> <     all: <retex-combine><room.exr><--texture><Floor=oak.jpg><oak.txt>
> < retex-combine room.exr --texture=Floor=fo: <retex-combine><room.exr><--texture=Floor=folder/>
> ---
> >     all: <retex-combine><room.exr><--texture><Floor=oak.jpg><Floor=oak.txt>
> > retex-combine room.exr --texture=Floor=fo: <retex-combine><room.exr><--texture=Floor=folder>
> 32c32
> <     all: <retex-combine><room.exr><--batch-root=a root><folder>
> ---
> >     all: <retex-combine><room.exr><--batch-root=a root><--batch-root=folder>
= 1
$ RETEX_MAX_TIME=60 "$TESTS/complete.sh" fish "$PWD/a root/usr/share/fish/vendor_completions.d"
> retex-combine : a root/ folder/ my room.exr named.exr room.exr room.retex x.exr
> retex-combine my: my room.exr
> retex-combine "my ro: my room.exr
> retex-combine ~/ro: ~/room.exr ~/room.retex
> retex-combine room.exr --texture : Floor= Wall=
> retex-combine room.exr --texture Fl: Floor=
> retex-combine my\ room.exr --texture W: Wall=
> retex-combine "my room.exr" --texture W: Wall=
> retex-combine room.exr --texture Floor=oa: Floor=oak.jpg Floor=oak.txt
> retex-combine room.exr --texture=Floor=fo: --texture=Floor=folder/
> retex-combine room.exr --texture:scale=2:wr: --texture:scale=2:wrap=
> retex-combine room.exr --texture:wrap=mir: --texture:wrap=mirror
> retex-combine room.exr --cros: --cross
> retex-combine room.exr --cross : 0 2 3
> retex-combine room.exr --batch : a root/ folder/ table.csv
> retex-combine room.exr --batch-root=: --batch-root=a root/ --batch-root=folder/
> retex-info --: --accept-damaged --check --help --json --layers --max-memory --max-pixels --max-time --output --quiet --safe --threads --verbose --version
> retex-render box: box.pov
> retex-render --layout p: paper
> retex-render --layout=p: --layout=paper
> retex-render --aov depth,met: depth,metallic
> retex-render box.pov -t : Floor Wall
> retex comb: combine
> retex help com: combine
> retex combine room.exr --texture : Floor= Wall=
> retex-combine named.exr --texture A: A plain wall=

# bash-completion finds the file by the command's name, also of a program that is called by its path.
$ cat >load.bash <<'END'
+ . /usr/share/bash-completion/bash_completion
+ _completion_loader retex-pack
+ complete -p retex-pack
+ _completion_loader "$(command -v retex-info)"
+ complete -p retex-info
+ END
$ XDG_DATA_DIRS="$PWD/a root/usr/share" bash --norc load.bash
> complete -F _retex retex-pack
> complete -F _retex retex-info
