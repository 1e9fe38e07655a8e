#!/bin/sh
# Installs the Debian packages that retex needs to be built (`setup.sh build`), tested (`setup.sh test`; `setup.sh serve`
# for retex-serve with nginx and many clients, `setup.sh web` for the player in a browser, `setup.sh cluster` for parts
# of work on several machines, `setup.sh guided` for fuzzing guided by coverage), made into Debian packages
# (`setup.sh deb`) or compared with POV-Ray (`setup.sh parity`).
#
# If nothing is missing, it prints nothing and exits with 0. It installs packages as root, or by sudo where sudo needs no
# password or runs on a terminal. Otherwise it prints the command that installs them, and exits with 1. With --list it
# only prints the names of all packages that it would look for.
# `setup.sh config` prints the contents of $(BUILD)/config.mk: flags for compilers and linkers, found by pkg-config.
set -eu

# Each line: the kind of check, what is looked for, the Debian package that has it.
# libjpeg-dev reads and writes DCT coefficients of JPEG files in packs, libblosc-dev compresses planes in packs, jansson
# reads and writes manifests, libdeflate-dev compresses EXR, libisal-dev PNG, libpng-dev reads PNG, libfreetype-dev the
# fonts of text in scenes, libgif-dev palettes of pictures, libavif-dev and libjxl-dev write AVIF and JPEG XL,
# libassimp-dev models for retex-import, libdraco-dev and libmeshoptimizer-dev meshes of glTF that are compressed,
# libmicrohttpd-dev HTTP and nettle-dev the names of uploads, and signatures, for retex-serve. esbuild makes one small
# script of the modules of web pages.
# fonts-povray has the fonts that are built into POV-Ray: timrom.ttf, cyrvetic.ttf, crystal.ttf, povlogo.ttf.
needs_build='
command gcc build-essential
command g++ build-essential
header stdlib.h build-essential
command pkg-config pkg-config
pkg OpenImageIO libopenimageio-dev
pkg OpenEXR libopenexr-dev
pkg OpenColorIO libopencolorio-dev
pkg lcms2 liblcms2-dev
pkg libtiff-4 libtiff-dev
pkg libavif libavif-dev
pkg libjxl libjxl-dev
embree rtcore.h libembree-dev
pkg libjpeg libjpeg-dev
pkg blosc libblosc-dev
pkg jansson libjansson-dev
pkg zlib zlib1g-dev
pkg libisal libisal-dev
pkg libdeflate libdeflate-dev
pkg freetype2 libfreetype-dev
pkg libpng libpng-dev
header gif_lib.h libgif-dev
pkg assimp libassimp-dev
pkg draco libdraco-dev
header meshoptimizer.h libmeshoptimizer-dev
pkg libmicrohttpd libmicrohttpd-dev
pkg nettle nettle-dev
command esbuild esbuild
file /usr/share/fonts/truetype/povray/timrom.ttf fonts-povray
file /usr/share/povray-3.7/include/colors.inc povray-includes
'
needs_test='
pkg libzip libzip-dev
pkg cmocka libcmocka-dev
command mandoc mandoc
command cmark cmark
command curl curl
python pip python3-pip
python setuptools python3-setuptools
python wheel python3-wheel
command oiiotool openimageio-tools
command djxl libjxl-tools
command tsc node-typescript
command transicc liblcms2-utils
command zsh zsh
command fish fish
file /usr/share/bash-completion/bash_completion bash-completion
command node nodejs
file /usr/share/nodejs/jsdom/package.json node-jsdom
python OpenImageIO python3-openimageio
python numpy python3-numpy
'
needs_deb="$needs_build
command dpkg-buildpackage dpkg-dev
command dh debhelper
file /usr/share/perl5/Debian/Debhelper/Sequence/python3.pm dh-python
file /usr/bin/python3 python3
"
needs_guided="
command clang clang
command llvm-symbolizer llvm
runtime libclang_rt.fuzzer_no_main-$(uname -m).a libclang-rt-dev
"
needs_web='
command chromium chromium
python websocket python3-websocket
'
needs_parity='
command povray povray
file /usr/share/doc/povray/examples povray-examples
'
needs_serve='
command wrk wrk
file /usr/sbin/nginx nginx-light
python OpenImageIO python3-openimageio
python numpy python3-numpy
'
needs_cluster='
command parallel parallel
command sbatch slurm-wlm
command munged munge
python yaml python3-yaml
'

CC=${CC:-gcc}
CXX=${CXX:-g++}
PKG_CONFIG=${PKG_CONFIG:-pkg-config}

# Prints the name of the Embree library that is installed: embree4, embree3 or nothing. A test program must link.
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

is_present() { # kind what
    case $1 in
    command) command -v "$2" >/dev/null 2>&1 ;;
    header) echo "#include <$2>" | "$CC" -E -x c - >/dev/null 2>&1 ;;
    pkg) "$PKG_CONFIG" --exists "$2" 2>/dev/null ;;
    embree) [ -n "$(embree)" ] ;;
    python) /usr/bin/python3 -c "import $2" >/dev/null 2>&1 ;;
    file) [ -e "$2" ] ;;
    runtime) [ -e "$(clang -print-file-name="$2" 2>/dev/null)" ] ;; # of clang
    esac
}

missing_packages() { # list; prints the packages of the lines whose check fails, each once
    echo "$1" | while read -r kind what package; do
        [ -z "$kind" ] || is_present "$kind" "$what" || echo "$package"
    done | sort -u | tr '\n' ' '
}

# Prints the command that runs another one as root: env for root itself, else sudo. Fails if sudo is absent, or needs a
# password and there is no terminal.
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

install_missing() { # list
    missing=$(missing_packages "$1")
    [ -n "$missing" ] || return 0
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "retex: error: libraries or programs are missing. The names of their Debian packages are: $missing" >&2
        return 1
    fi
    if root=$(as_root); then
        echo "retex: installing packages: $missing" >&2
        $root apt-get update -qq >&2 && $root env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0 $missing >&2 || true
        missing=$(missing_packages "$1")
        [ -n "$missing" ] || return 0
        echo "retex: error: these packages could not be installed: $missing" >&2
        return 1
    fi
    echo "retex: error: packages are missing. Run this command as root, then run make again:" >&2
    echo "    apt-get update && apt-get install -y --no-install-recommends $missing" >&2
    return 1
}

# Headers of libraries are system headers, so that the compiler reports no warnings in them.
cflags() { "$PKG_CONFIG" --cflags "$@" | sed 's/-I/-isystem /g'; }

config() {
    embree_name=$(embree)
    modules="jansson libjpeg libpng blosc zlib libisal libdeflate"
    exr_core=$("$PKG_CONFIG" --libs-only-l OpenEXR | tr ' ' '\n' | grep OpenEXRCore)
    echo "# Made by tools/setup.sh. Delete this file after other versions of the libraries have been installed."
    echo "LIBRETEX_CFLAGS := $(cflags OpenEXR $modules)"
    echo "LIBRETEX_LIBS := $("$PKG_CONFIG" --libs-only-L OpenEXR $modules) $exr_core" \
        "$("$PKG_CONFIG" --libs $modules) -ldl -lm"
    # for retex.pc, so that others can link the static library
    echo "LIBRETEX_REQUIRES := $modules"
    echo "LIBRETEX_PRIVATE_LIBS := $("$PKG_CONFIG" --libs-only-L OpenEXR) $exr_core -ldl -lm -pthread"
    echo "BRIDGE_CFLAGS := $(cflags OpenImageIO OpenColorIO OpenEXR lcms2 libtiff-4 libdeflate zlib libavif libjxl)"
    echo "BRIDGE_LIBS := $("$PKG_CONFIG" --libs OpenImageIO OpenColorIO lcms2 libtiff-4 libdeflate zlib libavif libjxl)"
    echo "IMPORT_CFLAGS := $(cflags assimp)"
    echo "IMPORT_LIBS := $("$PKG_CONFIG" --libs assimp draco) -lmeshoptimizer -lstdc++"
    echo "SERVE_CFLAGS := $(cflags libmicrohttpd nettle)"
    echo "SERVE_LIBS := $("$PKG_CONFIG" --libs libmicrohttpd nettle)"
    echo "RENDER_CFLAGS := -DRETEX_$(echo "$embree_name" | tr a-z A-Z) $(cflags freetype2 libpng)"
    echo "RENDER_LIBS := -l$embree_name $("$PKG_CONFIG" --libs freetype2 libpng) -lgif"
}

case ${1-} in
config) config ;;
build | test | deb | parity | serve | web | cluster | guided)
    eval "list=\$needs_$1"
    if [ "${2-}" = --list ]; then
        echo "$list" | awk 'NF { print $3 }' | sort -u
    else
        install_missing "$list"
    fi
    ;;
*)
    echo "usage: $0 build | test | deb | parity | serve | web | cluster | guided [--list], or $0 config" >&2
    exit 2
    ;;
esac
