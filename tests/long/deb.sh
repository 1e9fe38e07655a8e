#!/bin/sh
# The Debian packages: built from the files that git knows, checked by lintian, installed into a new system by apt, used
# there by an ordinary user, and removed. The system is made by mmdebstrap from the sources that this machine's apt has.
set -u
. tests/lib/tap.sh
for needed in dpkg-buildpackage dh lintian mmdebstrap; do
    command -v $needed >/dev/null || missing="${missing-}$needed "
done
if [ -n "${missing-}" ] || [ "$(id -u)" != 0 ]; then
    skip "Debian packages" "${missing:+missing: $missing}root is needed, and debhelper, lintian, mmdebstrap"
    finish
    exit
fi
deb=$BUILD/deb
nice tools/deb.sh "$deb" >"$work/log" 2>&1
result $((!$?)) "make deb"
tail -n 5 "$work/log" | sed 's/^/# /'
# These packages are for no archive: they close no bug of Debian's, and no mail reaches their maintainers.
lintian --allow-root --fail-on error,warning \
    --suppress-tags initial-upload-closes-no-bugs,bogus-mail-host,bogus-mail-host-in-debian-changelog "$deb"/*.changes >"$work/log" 2>&1
result $((!$?)) "lintian has no errors and warnings"
sed 's/^/# /' "$work/log"

root=$work/root
# shellcheck disable=SC1091
. /etc/os-release
sources=$(find /etc/apt -name '*.sources' -o -name 'sources.list' -o -path '*/sources.list.d/*.list')
# shellcheck disable=SC2086 # several files
mmdebstrap --quiet --variant=apt "$VERSION_CODENAME" "$root" $sources >"$work/log" 2>&1 || {
    sed 's/^/# /' "$work/log"
    result 0 "a new system"
    finish
    exit
}
inside() { # COMMAND…: in the new system, as root
    unshare --mount --pid --fork --mount-proc="$root/proc" chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@" </dev/null
}
cp /etc/resolv.conf "$root/etc/" 2>/dev/null
mkdir "$root/packages"
cp "$deb"/*.deb debian/tests/render debian/tests/retexture debian/tests/link "$root/packages"
inside useradd -m student
inside sh -c 'cd packages && apt-get update -qq && apt-get install -qq -y --no-install-recommends ./*.deb' \
    >"$work/log" 2>&1
result $((!$?)) "apt installs them"
tail -n 3 "$work/log" | sed 's/^/# /'
inside apt-get install -qq -y --no-install-recommends povray-includes fonts-povray openimageio-tools cmake make g++ pkgconf \
    >"$work/log" 2>&1
for test in render retexture link; do
    inside runuser -u student -- sh -c 'cd && mkdir '$test' && AUTOPKGTEST_TMP=$HOME/'$test' /packages/'$test \
        >"$work/log" 2>&1
    result $((!$?)) "an ordinary user: $test"
    sed 's/^/# /' "$work/log"
done
# Everything that a page describes is there, and every tool tells what it is.
inside runuser -u student -- sh -c 'for tool in /usr/bin/retex-*; do "$tool" --version || exit 1; done' >"$work/log" 2>&1
result $((!$?)) "every tool runs"
inside apt-get purge -qq -y $(cd "$deb" && for file in *.deb; do echo "${file%%_*}"; done | grep -v dbgsym) \
    >"$work/log" 2>&1
result $((!$?)) "apt removes them"
rm -rf "$root/packages" "$root/home/student"
left=$(find "$root" -xdev -name '*retex*' ! -path '*/proc/*' ! -path '*/var/lib/apt/lists/*' ! -path '*/var/log/*' \
    ! -path '*/var/cache/apt/*')
result "$([ -z "$left" ] && echo 1)" "nothing is left"
echo "$left" | sed '/^$/d; s/^/# /'
finish
