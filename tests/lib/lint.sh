#!/bin/sh
# Rules that a script can check: make lint.
#   - includes between directories: libretex <- renderer <- oiio_plugins; tools -> libretex
#   - order of the rooms of tools/libretex and of the renderer; no circles of headers, of files, nor of units; their size
#   - symbols of libretex begin with retex_; its README names all files; what no other file uses is static
#   - one definition of the sRGB curve, of luminance, the clock, the version,
#     the choice of vector instructions, the AOVs, the features of denoising
#   - each public header compiles alone, as C11 and as C++17; its calls fail in the same way
#   - files and functions that comments, READMEs and man pages name exist
#   - one sense a word, by the glossary
#   - man pages without complaints of mandoc
#   - no line over 120 bytes, no tab, no trailing blank in sources
#   - shell scripts parse
#   - tools/setup.sh installs what the Debian packages are built with
#   - figures that texts quote are those of docs/*.csv: tests/figures/quotes.txt
#   - mutants: the text of each is in its file, and its tests exist
# --tap: as one test of make check.
set -u
status=0
[ "${1-}" != --tap ] || echo 1..1
if ! git rev-parse --git-dir >/dev/null 2>&1; then
    echo "ok 1 - rules of the house # SKIP not a git checkout"
    exit 0
fi
complain() { echo "lint: $*" >&2; status=1; }

# files of a directory that include what matches
forbid() { # directory pattern why
    found=$(grep -rnE "#include *[<\"]($2)" "$1" --include='*.[ch]' --include='*.cpp' --include='*.hpp' 2>/dev/null)
    [ -z "$found" ] || complain "$3:
$found"
}
renderer_headers=$(cd renderer && find . -name '*.h' | sed 's|^\./||' | tr '\n' '|' | sed 's/|$//')
forbid tools "renderer/|$renderer_headers" "libretex and the tools must not know the renderer"
found=$(grep -rl '#include *<embree' tools | grep -v '^tools/import/space/space\.c$')
[ -z "$found" ] || complain "of the tools, only tools/import/space/space.c asks Embree: $found"
forbid tools/libretex 'cli\.h' "the library must not know the command line"
forbid tools/libretex 'OpenImageIO|OpenColorIO' "only the bridge may include OpenImageIO or OpenColorIO"
forbid renderer 'OpenImageIO|OpenColorIO|ImfHeader|openexr|jpeglib|zip\.h' "the renderer knows libretex only"
forbid renderer 'libretex/|bridge|(io|exr|picture|texture|set|edit|retexture|solve|denoise|metrics|compact|pack|files)/' \
    "the renderer uses libretex's public headers only"
forbid renderer 'oiio_plugins|set_input|(pack|scene)_source|scene_options' "the renderer must not know the plugins"
forbid tools 'oiio_plugins|set_input|(pack|scene)_source|scene_options' "libretex and the tools must not know the plugins"
forbid oiio_plugins \
    'cli\.h|texture_args|texture_table|libretex/|(io|exr|picture|set|edit|retexture|solve|denoise|metrics|compact|pack|files)/' \
    "the plugins use libretex's public headers only"
for file in renderer/*/*.[ch] renderer/*/*/*.[ch]; do
    [ -e "$file" ] || continue
    ! grep -qE '#include *"common/cli\.h"' "$file" || complain "$file: only mains may include cli.h"
done

# The objects that the sources of a directory became, where they were built.
objects() { # directory, ending of the sources
    find "${BUILD:-build}/obj/$1" -name '*.o' 2>/dev/null | while read -r object; do
        source=${object#"${BUILD:-build}/obj/"}
        [ ! -e "${source%.o}.$2" ] || echo "$object"
    done
}
# FILE NEEDED SYMBOL for each symbol that a file's object takes from another's, without suffix
needs() { # directory
    objects "$1" c | xargs -r nm -A | awk -v prefix="${BUILD:-build}/obj/$1/" '
        { file = substr($1, length(prefix) + 1); sub(/\.o:.*/, "", file) }
        $(NF - 1) ~ /^[TDBRV]$/ { of[$NF] = file }
        $(NF - 1) == "U" { from[++n] = file; symbol[n] = $NF }
        END { for (i = 1; i <= n; i++) if (symbol[i] in of) print from[i], of[symbol[i]], symbol[i] }'
}

# Rooms, lowest first: each may use those before it, and none of its own rank. Looked for in includes and in symbols. Files
# of the directory itself stand on top.
rooms() { # directory rank:room…
    directory=$1; shift
    { grep -rE '^#include "' "$directory" --include='*.[ch]' | sed -nE \
          "s|^$directory/([^:]*)/[^/:]*:#include \"(.*)/[^/]*\"|\1 \2 \1 includes \2|p"
      needs "$directory" | awk '{ a = $1; b = $2; sub("/[^/]*$", "", a); sub("/[^/]*$", "", b)
          if ($1 ~ /\//) print a, b, $1, "needs", $3, "of", $2 }'
    } | awk -v order="$*" '
        BEGIN { n = split(order, list); for (i = 1; i <= n; i++) { split(list[i], pair, ":"); rank[pair[2]] = pair[1] } }
        $1 == $2 || !($2 in rank) { next }
        !($1 in rank) { print "no room " $1; next }
        rank[$2] >= rank[$1] { $1 = $2 = ""; print }' | sort -u
}
back=$(rooms tools/libretex 1:base 2:io 3:exr 4:picture 5:texture 6:set 7:edit 7:precision 8:retexture 9:solve 9:denoise 9:metrics 9:compact 10:reduce \
    11:pack 12:web 12:files)
[ -z "$back" ] || complain "rooms of tools/libretex, from one that stands later:
$back"
back=$(rooms tools 1:common 2:batch 2:http 2:decode 3:combine 3:page 3:studio 3:try \
    2:import/base 2:import/space 3:import/gltf 4:import/read 4:import/sense 5:import/scene 6:import \
    3:serve/request 3:serve/answer 3:serve/clients 4:serve/files 5:serve/site 6:serve/http)
[ -z "$back" ] || complain "rooms of tools, from one that stands later:
$back"
back=$(rooms renderer 1:base 2:function 2:scene 3:sdl/lang 3:shape 3:pattern 4:faces 4:shade 5:medium 5:camera 6:accel 6:light \
    7:sdl/state 8:sdl/texture 9:sdl/medium 10:sdl/object 11:sdl/camera 12:sdl/place 13:sdl \
    7:film 8:film/footprints 8:film/paper 9:path 14:render 15:job)
[ -z "$back" ] || complain "rooms of the renderer, from one that stands later:
$back"

# No circles. Of headers: none includes, by however many steps, itself. Of files of the library and of the renderer: no
# two need symbols of each other, by however many steps; but for the rooms of the scene language, whose grammar is
# recursive.
no_circle() { # pairs of names, what
    found=$(echo "$1" | tsort 2>&1 >/dev/null | sed 's/^tsort: //')
    [ -z "$found" ] || complain "$2:
$found"
}
for root in tools tools/libretex renderer oiio_plugins tests/lib; do
    no_circle "$(grep -rE '^#include "' "$root" --include='*.h' --include='*.hpp' |
        sed -nE "s|^$root/([^:]*):#include \"(.*)\"|\1 \2|p")" "headers of $root that include each other"
done
no_circle "$(grep -rE '^#include <retex/' tools/libretex/include/retex |
    sed -nE 's|^.*/(retex/[^:]*):#include <(.*)>|\1 \2|p')" "public headers that include each other"
no_circle "$(needs tools/libretex | awk '{ print $1, $2 }')" "files of tools/libretex that need each other"
for room in import serve studio http; do
    no_circle "$(needs tools/$room | awk '{ print $1, $2 }')" "files of tools/$room that need each other"
done
recursive='^sdl/'
no_circle "$(needs renderer | awk -v may="$recursive" '!($1 ~ may && $2 ~ may) { print $1, $2 }')" \
    "files of the renderer that need each other"
# Nor of units, a file with its header each, by what they include.
found=$(/usr/bin/python3 tests/lib/circles.py renderer "$recursive"
    /usr/bin/python3 tests/lib/circles.py tools/libretex)
[ -z "$found" ] || complain "units that include each other's headers, by however many steps:
$found"

# Rooms of the renderer that can be overlooked.
for room in $(find renderer -type d); do
    [ "$(find "$room" -maxdepth 1 -type f | wc -l)" -le 40 ] || complain "$room has more than 40 files"
done
for header in $(find renderer -name '*.h'); do
    [ "$(wc -l <"$header")" -le 350 ] || complain "$header has more than 350 lines"
done

# What the product defines once. Tests may compute it by themselves, as a reference; man pages and texts may name it.
one_definition() { # file pattern what
    found=$(grep -rnE "$2" tools renderer oiio_plugins scenes --include='*.[ch]' --include='*.cpp' --include='*.hpp' |
        grep -v "^$1:")
    [ -z "$found" ] || complain "$3 is defined by $1 alone:
$found"
    grep -qE "$2" "$1" || complain "$1 does not define $3"
}
one_definition tools/libretex/include/retex/color.h '(^|[^0-9])0?\.(0031308|04045)|12\.92|(^|[^0-9])1\.055' 'the sRGB curve'
one_definition tools/libretex/include/retex/color.h '(^|[^0-9])0?\.(2126f?|7152f?|0722f?) *\*' 'luminance'
one_definition tools/libretex/base/clock.c '(^|[^_])(clock_gettime|gettimeofday)|timespec_get|std::chrono' 'the clock'
version=$(sed -nE 's/^#define RETEX_VERSION "(.*)"$/\1/p' tools/libretex/include/retex/version.h | sed 's/\./[.]/g')
one_definition tools/libretex/include/retex/version.h "\"([^\"]* )?${version:-no version}" 'the version'
one_definition tools/libretex/base/cpu.c '__builtin_cpu|target_clones|ifunc|getauxval|cpuid' 'what the processor can do'
one_definition tools/libretex/include/retex/host/cpu.h '__attribute__ *\(\(target|GCC target|__x86_64__' 'how kernels are compiled for a processor'

one_definition tools/libretex/include/retex/host/aov.h '"irradiance"|"roughness, |, roughness"' 'the list of AOVs'
one_definition tools/libretex/include/retex/host/denoise_data.h '"guide_|"noise_("|%|indep|beauty)' 'names of what denoising reads'

# What no other file uses is static, but for what is public and what tests call.
alone=$(for folder in tools renderer oiio_plugins; do
    objects "$folder" c | xargs -r nm -A -g
    objects "$folder" cpp | xargs -r nm -A -u
done | awk -v prefix="${BUILD:-build}/obj/" '
    $(NF - 1) ~ /^[TDBR]$/ { sub(/\.o:.*/, "", $1); of[$NF] = substr($1, length(prefix) + 1) }
    $(NF - 1) == "U" { used[$NF] }
    END { for (symbol in of) if (!(symbol in used) && symbol != "main") print symbol, of[symbol] }' | sort)
words=$(echo "$alone" | cut -d ' ' -f 1)
[ -z "$words" ] || words=$(git grep -ohwFe "$words" -- tests/unit tests/lib tests/fuzz tests/bench tests/faults \
    tools/libretex/include | sort -u)
found=$(echo "$alone" | awk -v known="$words" 'BEGIN { n = split(known, list, "\n"); for (i = 1; i <= n; i++) is[list[i]] }
    NF && !($1 in is) { print $2 ".c: " $1 }')
[ -z "$found" ] || complain "used by no other file nor test, and not static:
$found"

# Symbols of the library that others can see begin with retex_.
unprefixed=$(objects tools/libretex c | xargs -r nm -A -g --defined-only |
    awk '$NF !~ /^retex_/ { sub(/:.*/, "", $1); print $1 ": " $NF }')
[ -z "$unprefixed" ] || complain "symbols of libretex without retex_:
$unprefixed"

# Each room's files are named in its section of the README, x.h by x.c.
for room in base io exr picture texture set edit precision retexture solve denoise metrics compact reduce pack web files; do
    section=$(awk -v head="### $room" '/^##/ { inside = $0 == head } inside' tools/libretex/README.md)
    for file in tools/libretex/$room/*.[ch]; do
        name=${file##*/}
        case $section in *"\`$name\`"*) continue ;; esac
        [ "$name" != "${name%.h}" ] && [ -e "${file%.h}.c" ] && continue
        complain "$file: not in tools/libretex/README.md"
    done
done

for folder in $(find tools -type d); do
    [ "$(find "$folder" -maxdepth 1 -type f | wc -l)" -le 40 ] || complain "$folder has more than 40 files"
done

probe=$(mktemp -d)
trap 'rm -rf "$probe"' EXIT
headers=$(find tools/libretex/include -name '*.h' | sort)
for header in $headers; do
    name=${header#tools/libretex/include/}
    printf '#include <%s>\nint probe;\n' "$name" | tee "$probe/a.c" >"$probe/a.cpp"
    ${CC:-gcc} -std=c11 -Wall -Wextra -Werror -pedantic -fsyntax-only -Itools/libretex/include "$probe/a.c" ||
        complain "$name does not compile alone as C11"
    ${CXX:-g++} -std=c++17 -Wall -Wextra -Werror -fsyntax-only -Itools/libretex/include "$probe/a.cpp" ||
        complain "$name does not compile alone as C++17"
done

# Public calls that can fail return int, and take the error last, and the number of threads, if any, before it.
found=$(for header in $headers; do
    case ${header##*/} in error.h | parallel.h) continue ;; esac
    sed -z 's|/\*[^*]*\*\+\([^/*][^*]*\*\+\)*/||g' "$header" | grep -v '^#' | tr -s '\n ' ' ' | tr ';{}' '\n\n\n' |
        sed "s/ , /, /g; s|^ *|$header: |" | awk '
            /RetexError|nthreads/ && !/: (typedef )?int Retex[A-Za-z]*\(|: int retex_[a-z_]*\(/ ||
            /RetexError/ && !/RetexError \*err\)$/ || /nthreads/ && !/, int nthreads, RetexError \*err\)$/'
done)
[ -z "$found" ] || complain "public calls that can fail: int retex_…(…[, int nthreads], RetexError *err):
$found"

# What comments, READMEs and man pages name exists.
found=$(/usr/bin/python3 tests/lib/mentions.py) || complain "named, but not there:
$found"

# The glossary has a term once, and names in the code do not use its words for something else.
found=$(/usr/bin/python3 tests/lib/words.py) || complain "words with two senses:
$found"

for page in man/*.[1-9]; do
    [ -e "$page" ] || continue
    complaints=$(mandoc -Tlint -W warning "$page" | grep -v 'missing manual\|referenced manual not found')
    [ -z "$complaints" ] || complain "$complaints"
done

sources=$(git ls-files '*.c' '*.h' '*.cpp' '*.hpp' | grep -v /stb)
for file in $sources; do
    [ -e "$file" ] || continue
    LC_ALL=C awk -v file="$file" '
        length > 120 { print file ":" FNR ": " length " characters"; bad = 1 }
        /\t/ { print file ":" FNR ": tab"; bad = 1 }
        /[ ]$/ { print file ":" FNR ": trailing blank"; bad = 1 }
        END { exit bad }' "$file" >&2 || complain "see above"
done

for script in $(git ls-files '*.sh') .ci/run; do
    sh -n "$script" || complain "$script"
done
# Build-Depends, but for what only tests need; three of these names are provided by other packages.
listed=$(tools/setup.sh deb --list)
found=$(sed -n '/^Build-Depends:/,/^$/p' debian/control | sed -e 's/^Build-Depends://' -e '/<!nocheck>/d' |
    sed -e 's/debhelper-compat (= 13)/debhelper/; s/dh-sequence-python3/dh-python/; s/pkgconf,/pkg-config,/' |
    tr -d ' ,' | grep -vxF "$listed" | grep .)
[ -z "$found" ] || complain "in Build-Depends of debian/control, but not in tools/setup.sh: $found"

quoted=$(/usr/bin/python3 -B tests/figures/quote.py --check) || complain "$quoted"
old=$(/usr/bin/python3 -B tests/figures/ages.py) || complain "$old"
complaints=$(tests/mutants/run.py --lint) || complain "$complaints"
complaints=$(tests/mutants/quick.py --lint) || complain "$complaints"
if [ "${1-}" = --tap ]; then
    [ "$status" = 0 ] && echo "ok 1 - rules of the house" || echo "not ok 1 - rules of the house"
    exit 0
fi
[ "$status" != 0 ] || echo "lint: nothing to complain about"
exit $status
