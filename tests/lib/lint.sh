#!/bin/sh
# Rules of the house that a script can check: make lint.
#   - arrows between directories: libretex <- renderer <- oiio_plugins; tools -> libretex
#   - each public header compiles alone, as C11 and as C++17
#   - man pages without complaints of mandoc
#   - no line over 120 bytes, no tab, no trailing blank in sources
#   - shell scripts parse
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
renderer_headers=$(cd renderer && find . -name '*.h' | sed 's|^\./||; s|.*/\(.*/.*\)|\1|' | tr '\n' '|' | sed 's/|$//')
forbid tools "renderer/|embree|$renderer_headers" "libretex and the tools must not know the renderer"
forbid tools/libretex 'cli\.h' "the library must not know the command line"
forbid tools/libretex 'OpenImageIO|OpenColorIO' "only the bridge may include OpenImageIO or OpenColorIO"
forbid renderer 'OpenImageIO|OpenColorIO|ImfHeader|openexr|turbojpeg|zip\.h' "the renderer knows libretex only"
forbid renderer 'libretex/|bridge|exr_io|half\.h|manifest\.h|pack_|input\.h|output\.h' \
    "the renderer uses libretex's public headers only"
forbid renderer 'oiio_plugins|set_input|(pack|scene)_source|scene_options' "the renderer must not know the plugins"
forbid tools 'oiio_plugins|set_input|(pack|scene)_source|scene_options' "libretex and the tools must not know the plugins"
forbid oiio_plugins 'cli\.h|texture_args|texture_table|libretex/|exr_io|half\.h|manifest\.h|pack_(codec|format)|input\.h' \
    "the plugins use libretex's public headers only"
for file in renderer/*/*.[ch]; do
    [ -e "$file" ] || continue
    ! grep -qE '#include *"cli\.h"' "$file" || complain "$file: only mains may include cli.h"
done

probe=$(mktemp -d)
trap 'rm -rf "$probe"' EXIT
for header in tools/libretex/include/retex/*.h; do
    name=retex/${header##*/}
    printf '#include <%s>\nint probe;\n' "$name" | tee "$probe/a.c" >"$probe/a.cpp"
    ${CC:-gcc} -std=c11 -Wall -Wextra -Werror -pedantic -fsyntax-only -Itools/libretex/include "$probe/a.c" ||
        complain "$name does not compile alone as C11"
    ${CXX:-g++} -std=c++17 -Wall -Wextra -Werror -fsyntax-only -Itools/libretex/include "$probe/a.cpp" ||
        complain "$name does not compile alone as C++17"
done

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
if [ "${1-}" = --tap ]; then
    [ "$status" = 0 ] && echo "ok 1 - rules of the house" || echo "not ok 1 - rules of the house"
    exit 0
fi
[ "$status" != 0 ] || echo "lint: nothing to complain about"
exit $status
