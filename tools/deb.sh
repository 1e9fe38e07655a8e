#!/bin/sh
# Builds Debian packages of the files that git knows, as they are now: deb.sh FOLDER; make deb calls it. The folder gets
# the packages. Missing packages that it needs are installed first, as setup.sh does; nothing else outside of the folder
# changes. DEB_BUILD_OPTIONS and DEB_BUILD_PROFILES are those of dpkg-buildpackage; unless they say otherwise, unit tests
# are not run (make check runs them), and packages of debug symbols are not made.
# The packages are the same to the byte whenever, and in whatever folder, they are built.
set -eu
folder=$1
# A make that called this one has no say in the packages, by its variables nor by its jobs.
unset MAKEFLAGS MAKELEVEL MFLAGS BUILD PREFIX LIBDIR DESTDIR
umask 022
tools/setup.sh deb
version=$(dpkg-parsechangelog -S Version)
upstream=${version%-*}
rm -rf "$folder"
mkdir -p "$folder/retex-$upstream"
epoch=$(dpkg-parsechangelog -S Timestamp)
git ls-files -z | tar --null -T - --mode=go=u,go-w -cf - | tar -xf - -C "$folder/retex-$upstream"
tar -C "$folder" --sort=name --mtime="@$epoch" --owner=0 --group=0 --numeric-owner --exclude="retex-$upstream/debian" \
    -cf - "retex-$upstream" | gzip -n >"$folder/retex_$upstream.orig.tar.gz"
cd "$folder/retex-$upstream"
# Without tests, the packages that only tests need are not asked for either.
[ -n "${DEB_BUILD_OPTIONS+set}" ] || export DEB_BUILD_PROFILES="${DEB_BUILD_PROFILES-nocheck}"
DEB_BUILD_OPTIONS=${DEB_BUILD_OPTIONS-nocheck noautodbgsym parallel=$(nproc)} dpkg-buildpackage -us -uc
cd ..
rm -rf "retex-$upstream"
ls -- *.deb
