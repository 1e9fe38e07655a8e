#!/bin/sh
# Sees to it that what retex is built from (`setup.sh build`) or tested with (`setup.sh test`) is on this machine.
#
# Present: says nothing, exits 0. Absent: installs the Debian packages when it may (root, a sudo that asks no password,
# or a sudo on a terminal); else prints the one command that would, and exits 1. `setup.sh config` prints what
# $(BUILD)/config.mk holds: the compilers' and linkers' flags found by pkg-config.
set -eu

# kind  what it is known by   the Debian package it comes from
# Of packs: libjpeg-dev reads and writes the coefficients of JPEGs, libblosc-dev compresses their planes, jansson reads
# and writes manifests. libisal-dev deflates and inflates.
needs_build='
command gcc build-essential
command g++ build-essential
header stdlib.h build-essential
command pkg-config pkg-config
pkg OpenImageIO libopenimageio-dev
pkg OpenEXR libopenexr-dev
pkg OpenColorIO libopencolorio-dev
pkg lcms2 liblcms2-dev
embree rtcore.h libembree-dev
pkg libjpeg libjpeg-dev
pkg blosc libblosc-dev
pkg jansson libjansson-dev
pkg zlib zlib1g-dev
pkg libisal libisal-dev
file /usr/share/povray-3.7/include/colors.inc povray-includes
'
needs_test='
pkg libzip libzip-dev
pkg cmocka libcmocka-dev
command mandoc mandoc
command oiiotool openimageio-tools
command transicc liblcms2-utils
python OpenImageIO python3-openimageio
python numpy python3-numpy
'

CC=${CC:-gcc}
CXX=${CXX:-g++}
PKG_CONFIG=${PKG_CONFIG:-pkg-config}

# The name of the Embree library that both has a header here and links: embree4, embree3 or nothing.
embree() {
    probe=$(mktemp -d)
    for name in embree4 embree3; do
        printf '#include <%s/rtcore.h>\nint main(void) { return rtcNewDevice(0) == 0; }\n' $name >"$probe/a.c"
        if "$CC" "$probe/a.c" -o "$probe/a" -l$name 2>/dev/null; then
            echo $name
            break
        fi
    done
    rm -rf "$probe"
}

present() { # kind what
    case $1 in
    command) command -v "$2" >/dev/null 2>&1 ;;
    header) echo "#include <$2>" | "$CC" -E -x c - >/dev/null 2>&1 ;;
    pkg) "$PKG_CONFIG" --exists "$2" 2>/dev/null ;;
    embree) [ -n "$(embree)" ] ;;
    python) /usr/bin/python3 -c "import $2" >/dev/null 2>&1 ;;
    file) [ -e "$2" ] ;;
    esac
}

missing_packages() { # list of needs -> the packages of those that are absent, each once
    echo "$1" | while read -r kind what package; do
        [ -z "$kind" ] || present "$kind" "$what" || echo "$package"
    done | sort -u | tr '\n' ' '
}

# Root's prefix for a command: nothing, sudo, or a failure where there is no way to become root without a person.
as_root() {
    if [ "$(id -u)" = 0 ]; then
        echo env
    elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
        echo sudo
    elif command -v sudo >/dev/null 2>&1 && [ -t 0 ] && [ -t 2 ]; then
        echo sudo
    else
        return 1
    fi
}

ensure() { # list of needs
    missing=$(missing_packages "$1")
    [ -n "$missing" ] || return 0
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "retex: missing here; these are the names of the Debian packages: $missing" >&2
        return 1
    fi
    if root=$(as_root); then
        echo "retex: installing $missing" >&2
        $root apt-get update -qq >&2 && $root env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 $missing >&2 || true
        missing=$(missing_packages "$1")
        [ -n "$missing" ] || return 0
        echo "retex: installing did not help; still missing: $missing" >&2
        return 1
    fi
    echo "retex: packages are missing. As root, run this once, then make again:" >&2
    echo "    apt-get update && apt-get install -y --no-install-recommends $missing" >&2
    return 1
}

# Foreign headers are system headers: their warnings are not ours to mend.
cflags() { "$PKG_CONFIG" --cflags "$@" | sed 's/-I/-isystem /g'; }

config() {
    embree_name=$(embree)
    echo "# Made by tools/setup.sh; remove it after installing other versions of the libraries."
    echo "LIBRETEX_CFLAGS := $(cflags OpenEXR jansson libjpeg blosc zlib libisal)"
    echo "LIBRETEX_LIBS := $("$PKG_CONFIG" --libs-only-L OpenEXR jansson libjpeg blosc zlib libisal)" \
        "$("$PKG_CONFIG" --libs-only-l OpenEXR | tr ' ' '\n' | grep OpenEXRCore)" \
        "$("$PKG_CONFIG" --libs jansson libjpeg blosc zlib libisal) -ldl -lm"
    echo "BRIDGE_CFLAGS := $(cflags OpenImageIO OpenColorIO OpenEXR lcms2)"
    echo "BRIDGE_LIBS := $("$PKG_CONFIG" --libs OpenImageIO OpenColorIO lcms2)"
    echo "RENDER_CFLAGS := -DRETEX_$(echo "$embree_name" | tr a-z A-Z)"
    echo "RENDER_LIBS := -l$embree_name"
}

case ${1-} in
build) ensure "$needs_build" ;;
test) ensure "$needs_test" ;;
config) config ;;
*)
    echo "usage: $0 build | test | config" >&2
    exit 2
    ;;
esac
