#!/bin/sh
# Builds Debian packages of the files that git knows, as they are now: deb.sh FOLDER; make deb calls it. The folder gets
# the packages. Nothing outside of it changes, and nothing is downloaded. DEB_BUILD_OPTIONS is that of dpkg-buildpackage;
# unless it says otherwise, unit tests are not run (make check runs them), and packages of debug symbols are not made.
# The packages are the same to the byte whenever, and in whatever folder, they are built.
set -eu
folder=$1
# A make that called this one has no say in the packages, by its variables nor by its jobs.
unset MAKEFLAGS MAKELEVEL MFLAGS BUILD PREFIX LIBDIR DESTDIR
umask 022
for needed in dpkg-buildpackage dh; do
    command -v $needed >/dev/null || {
        echo "retex: error: $needed is missing; its packages are dpkg-dev and debhelper" >&2
        exit 1
    }
done
version=$(dpkg-parsechangelog -S Version)
upstream=${version%-*}
rm -rf "$folder"
mkdir -p "$folder/retex-$upstream"
epoch=$(dpkg-parsechangelog -S Timestamp)
git ls-files -z | tar --null -T - --mode=go=u,go-w -cf - | tar -xf - -C "$folder/retex-$upstream"
tar -C "$folder" --sort=name --mtime="@$epoch" --owner=0 --group=0 --numeric-owner --exclude="retex-$upstream/debian" \
    -cf - "retex-$upstream" | gzip -n >"$folder/retex_$upstream.orig.tar.gz"
cd "$folder/retex-$upstream"
DEB_BUILD_OPTIONS=${DEB_BUILD_OPTIONS-nocheck noautodbgsym parallel=$(nproc)} dpkg-buildpackage -us -uc
cd ..
rm -rf "retex-$upstream"
ls -- *.deb
