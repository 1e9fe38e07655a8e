#!/bin/sh
# ARM64: the whole tree is cross-compiled against Debian's packages for arm64, unpacked below $BUILD/arm64/root by
# mmdebstrap from the sources that this machine's apt has, and the unit tests run in qemu-aarch64.
#
# qemu is slow: ARM64_SECONDS (1800) of processor time are a test's limit. ARM64_TESTS='test_access test_set' chooses.
# What is there is not made again.
set -u
. tests/lib/tap.sh
for needed in aarch64-linux-gnu-gcc aarch64-linux-gnu-g++ mmdebstrap qemu-aarch64; do
    command -v $needed >/dev/null || missing="${missing-} $needed"
done
if [ -n "${missing-}" ]; then
    skip "ARM64" "missing:$missing (gcc-aarch64-linux-gnu, g++-aarch64-linux-gnu, mmdebstrap, qemu-user)"
    finish
    exit
fi
arm=$BUILD/arm64 root=$BUILD/arm64/root
mkdir -p "$arm"

# Nothing of these packages is run or set up. Links to absolute paths, which would lead into this machine, become relative.
unpack() {
    # shellcheck disable=SC1091
    . /etc/os-release
    libraries=$(sed '/^Package/q' debian/control | grep -o '[a-z0-9]*-dev' | sort -u | paste -sd,)
    # shellcheck disable=SC2046 # several files
    mmdebstrap --quiet --variant=extract --architectures=arm64 --include="libc6-dev,$libraries" "$VERSION_CODENAME" \
        "$root.new" $(find /etc/apt -name '*.sources' -o -name 'sources.list' -o -path '*/sources.list.d/*.list') &&
        find "$root.new" -type l -lname '/*' | while read -r link; do
            ln -sfn "$(realpath -ms --relative-to="${link%/*}" "$root.new$(readlink "$link")")" "$link"
        done &&
        mv "$root.new" "$root"
}
[ -d "$root" ] || { rm -rf "$root.new"; unpack >"$work/log" 2>&1; }
result "$([ -d "$root" ] && echo 1)" "Debian's packages for arm64"
[ -d "$root" ] || { sed 's/^/# /' "$work/log"; finish; exit; }

# These two libraries are found through alternatives, which nobody has set up.
libraries=/usr/lib/aarch64-linux-gnu
for tool in gcc g++; do
    cat >"$arm/$tool" <<END
#!/bin/sh
exec aarch64-linux-gnu-$tool "--sysroot=$root" "-Wl,-rpath-link=$root$libraries/blas:$root$libraries/lapack" "\$@"
END
    chmod +x "$arm/$tool"
done
# The root's own folders are the compiler's already. Named once more, they would come before those of C++, whose <math.h>
# must be the first.
make_arm() { # TARGET…
    env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS PKG_CONFIG_SYSROOT_DIR="$root" \
        PKG_CONFIG_LIBDIR="$root$libraries/pkgconfig:$root/usr/share/pkgconfig" \
        PKG_CONFIG_SYSTEM_INCLUDE_PATH="/usr/include:$root/usr/include" \
        PKG_CONFIG_SYSTEM_LIBRARY_PATH="/usr/lib:$libraries:$root/usr/lib:$root$libraries" \
        make -s -j"${JOBS:-2}" BUILD="$arm" CC="$arm/gcc" CXX="$arm/g++" AR=aarch64-linux-gnu-ar "$@"
}
make_arm all unit-tests >"$work/log" 2>&1
status=$?
warnings=$(grep -c 'warning:' "$work/log")
result "$([ $status = 0 ] && echo 1)" "make for arm64"
result "$([ "$warnings" = 0 ] && echo 1)" "without warnings"
grep -E 'warning:|error:|\*\*\*' "$work/log" | head -n 20 | sed 's/^/# /'
[ $status = 0 ] || { finish; exit; }

# The loader is called by its path. `qemu-aarch64 -L FOLDER` would take every absolute path that FOLDER has from there, `/`
# among them: what walks from `/` to a file, as safe access does, would not find it.
cat >"$arm/run" <<END
#!/bin/sh
exec env "RETEX_BRIDGE=$arm/lib/libretex-oiio.so" CMOCKA_MESSAGE_OUTPUT=TAP qemu-aarch64 \\
    "$root/lib/ld-linux-aarch64.so.1" --library-path \\
    "$root/lib/aarch64-linux-gnu:$root$libraries:$root/usr/lib:$root$libraries/blas:$root$libraries/lapack" "\$@"
END
chmod +x "$arm/run"
export arm work
export ARM64_SECONDS="${ARM64_SECONDS:-1800}"
# Processor time limits a test, for other work on the machine takes none of it.
run_test='
(ulimit -t "$ARM64_SECONDS"; exec "$arm/run" "$arm/tests/unit/$1") >"$work/$1.log" 2>&1
echo "# exit status $?" >>"$work/$1.log"
'
tests=${ARM64_TESTS:-$(cd tests/unit && ls test_*.c | sed 's/\.c$//')}
for test in $tests; do echo "$test"; done | xargs -P "${JOBS:-2}" -I TEST sh -c "$run_test" run TEST
for test in $tests; do
    log=$work/$test.log
    passed=$(grep -c '^ok ' "$log") failed=$(grep -c '^not ok ' "$log")
    good=$(tail -n 1 "$log" | grep -c '^# exit status 0$')
    [ "$passed" -gt 0 ] && [ "$failed" = 0 ] || good=0
    [ "$good" = 1 ] || sed 's/^/#   /' "$log"
    result "$good" "$test: $passed passed, $failed failed"
done
finish
