#!/bin/sh
# Two copies of the sources, in folders of different names, give the same library to the byte: what is built does not
# depend on where. No compiler cache is used, which would give the second one what the first one made. Unoptimised, which
# is quick; debug information, which holds names of folders, is there.
set -u
. tests/lib/tap.sh
PATH=$(echo "$PATH" | tr : '\n' | grep -v ccache | paste -s -d :)
unset MAKEFLAGS CCACHE_NOHASHDIR
# built FOLDER: the library's name there
built() {
    mkdir -p "$work/$1"
    tar -c --exclude=./.git --exclude=./build . | tar -x -C "$work/$1"
    mkdir -p "$work/$1/build"
    cp "$BUILD/config.mk" "$work/$1/build"
    (cd "$work/$1" && BUILD=build CCACHE_DISABLE=1 make -j2 CFLAGS='-O0 -g' build/lib/libretex.so.2) >"$work/log" 2>&1 ||
        tail -n 3 "$work/log" >&2
    echo "$work/$1/build/lib/libretex.so.2"
}
one=$(built a) other=$(built 'another folder/below')
result "$(cmp "$one" "$other" >&2 && echo 1)" "two folders give one library"
result "$(readelf --debug-dump=info "$one" | grep -c "$work" | grep -qx 0 && echo 1)" "it does not name its folder"
result "$(readelf --debug-dump=info "$one" | grep -q 'DW_AT_comp_dir' && echo 1)" "it has debug information"
finish
