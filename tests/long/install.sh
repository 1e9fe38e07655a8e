#!/bin/sh
# What make install leaves, in the hands of others: programs in C and C++ by pkg-config and by CMake, from PREFIX=/usr
# below DESTDIR with a multiarch folder, from a PREFIX with spaces, and from a tree that was moved. Then the interface:
# programs that were linked with the library of interface-2.txt must run with this one.
set -u
. tests/lib/tap.sh
stage=$here/tests/install/stage.sh compile=$here/tests/install/compile.sh
make_set "$work/room.exr" 48 32 3
oiiotool --pattern fill:topleft=1,0,0:topright=0,1,0:bottomleft=0,0,1:bottomright=1,1,1 16x16 3 -d uint8 \
    -o "$work/wood.tif"
retex-combine -q "$work/room.exr" --texture Floor="$work/wood.tif" -o "$work/expected.exr"

# works PROGRAM LIBDIR NAME: it makes the picture that retex-combine makes, with a TIFF, through the installed bridge
works() {
    rm -f "$work/actual.exr"
    (cd / && LD_LIBRARY_PATH=$2 "$1" "$work/room.exr" Floor="$work/wood.tif" "$work/actual.exr") 2>&1 | sed 's/^/# /'
    cmp -s "$work/expected.exr" "$work/actual.exr"
    result $((!$?)) "$3"
}

# tree PREFIX-AS-STAGED LIBDIR NAME: all ways to build against it
tree() {
    for source in c cpp; do
        "$compile" "$2/pkgconfig" "$here/tests/install/outsider.$source" "$work/outsider" &&
            works "$work/outsider" "$2" "$3: $source by pkg-config"
    done
    if ! command -v cmake >/dev/null; then
        skip "$3: by CMake" "cmake is not on this machine"
        return
    fi
    rm -rf "$work/cmake"
    mkdir "$work/cmake"
    if CMAKE_PREFIX_PATH=$1 cmake -S tests/install -B "$work/cmake" >"$work/log" 2>&1 &&
        cmake --build "$work/cmake" >>"$work/log" 2>&1; then
        for program in outsider-c outsider-cpp; do works "$work/cmake/$program" '' "$3: $program by CMake"; done
        RETEX_BRIDGE=$2/libretex-oiio.so
        export RETEX_BRIDGE
        works "$work/cmake/outsider-static" '' "$3: static, by CMake"
        unset RETEX_BRIDGE
        result "$(readelf -d "$work/cmake/outsider-static" | grep -c 'libretex\.so' | sed 's/0/1/;t;s/.*/0/')" \
            "$3: the static one does not need the shared library"
    else
        sed 's/^/# /' "$work/log"
        result 0 "$3: by CMake"
    fi
}

multiarch=$(${CC:-gcc} -print-multiarch)
"$stage" install "$work/debian" /usr LIBDIR="/usr/lib/$multiarch"
tree "$work/debian/usr" "$work/debian/usr/lib/$multiarch" "PREFIX=/usr"
"$stage" uninstall "$work/debian" /usr LIBDIR="/usr/lib/$multiarch"
result "$([ "$(find "$work/debian" | wc -l)" = 2 ] && echo 1)" "PREFIX=/usr: nothing is left"

"$stage" install '' "$work/my tools"
tree "$work/my tools" "$work/my tools/lib" "PREFIX with a space"
cp -r "$work/my tools" "$work/moved here"
"$stage" uninstall '' "$work/my tools"
result "$([ "$(find "$work/my tools" | wc -l)" = 1 ] && echo 1)" "PREFIX with a space: nothing is left"
tree "$work/moved here" "$work/moved here/lib" "moved"

# A program of an older release, with the library that make asan tests.
oiiotool "$work/wood.tif" -o "$work/wood.png"
(cd "$work" && "$here/tests/install/older.sh" "$BUILD/asan/lib") >"$work/printed" 2>&1
different=$(sed -n "s/^> //p" tests/cli/older.t | diff - "$work/printed")
result $((!$?)) "an older program, AddressSanitizer"
[ -z "$different" ] || echo "$different" | sed "s/^/# /"

if command -v abidiff >/dev/null; then
    python3 tests/install/interface.py --stub tests/install/interface-2.txt "$work/libretex.so.2"
    abidiff "$work/libretex.so.2" "$BUILD/lib/libretex.so.2" >"$work/changes" 2>&1
    # Calls may be added; a structure that begins with its size may grow, and is recorded then.
    result "$(grep -c 'Functions changes summary: 0 Removed, 0 Changed' "$work/changes")" "functions of interface-2.txt"
    result "$(grep -c 'Variables changes summary: 0 Removed, 0 Changed' "$work/changes")" "tables of interface-2.txt"
    sed 's/^/# /' "$work/changes"
else
    skip "the library's interface" "abidiff is not on this machine (abigail-tools)"
fi
finish
