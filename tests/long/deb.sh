#!/bin/sh
# The Debian packages: built twice from the files that git knows, to the same bytes; checked by lintian; installed into a
# new system by apt with the tutorial's own command; used there by an ordinary user, who follows the whole tutorial
# without the source tree; tested by autopkgtest; removed and purged, and nothing of them is left. The system is made by
# mmdebstrap from the sources that this machine's apt has.
#
# DEB_FOLDER=FOLDER takes the packages that are in FOLDER and builds none. What apt has fetched is kept in
# $BUILD/deb-archives. TUTORIAL_AS_WRITTEN= makes the tutorial's pictures small.
set -u
. tests/lib/tap.sh
for needed in autopkgtest dh dpkg-buildpackage lintian mmdebstrap; do
    command -v $needed >/dev/null || missing="${missing-} $needed"
done
if [ -n "${missing-}" ] || [ "$(id -u)" != 0 ]; then
    skip "Debian packages" "${missing:+missing:$missing; }root is needed, and autopkgtest, debhelper, lintian, mmdebstrap"
    finish
    exit
fi
show() { sed 's/^/# /' "$work/log"; }
# judge NAME: of the command before; its output is shown if it failed.
judge() {
    status=$?
    result $((!status)) "$1"
    [ $status = 0 ] || show
}

deb=${DEB_FOLDER:-$BUILD/deb}
if [ -z "${DEB_FOLDER:-}" ]; then
    nice tools/deb.sh "$deb" >"$work/log" 2>&1
    status=$?
    result $((!status)) "make deb"
    [ $status = 0 ] || { tail -n 20 "$work/log" | sed 's/^/# /'; finish; exit; }
    # Elsewhere, later, by another user's habits, and compiled anew.
    (umask 077 && LC_ALL=C.UTF-8 TZ=Pacific/Auckland HOME=/nonexistent CCACHE_DISABLE=1 nice tools/deb.sh \
        "$work/a folder of another length/deb") >"$work/log" 2>&1 || tail -n 20 "$work/log" | sed 's/^/# /'
    differ=$(cd "$deb" && for file in *.deb *.tar.* *.dsc; do
        cmp -s "$file" "$work/a folder of another length/deb/$file" || echo "$file"
    done)
    result "$([ -z "$differ" ] && echo 1)" "a second build gives the same bytes"
    [ -z "$differ" ] || echo "# other bytes:" $differ
    rm -rf "$work/a folder of another length"
fi
# These packages are for no archive: they close no bug of Debian's.
lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$deb"/*.changes >"$work/log" 2>&1
judge "lintian has no errors and warnings"

root=$work/root archives=$BUILD/deb-archives
mkdir -p "$archives/partial"
# shellcheck disable=SC1091
. /etc/os-release
# python3 belongs to every standard system; curl is the test's.
# shellcheck disable=SC2046 # several files
mmdebstrap --quiet --variant=apt --include=python3,curl "$VERSION_CODENAME" "$root" \
    $(find /etc/apt -name '*.sources' -o -name 'sources.list' -o -path '*/sources.list.d/*.list') >"$work/log" 2>&1
judge "a new system"
[ $status = 0 ] || { finish; exit; }
# alone COMMAND…: with mounts that end with it.
alone() {
    root=$root archives=$archives unshare --mount --pid --fork sh -c '
        mount -t proc proc "$root/proc"
        mount --bind "$archives" "$root/var/cache/apt/archives"
        exec "$@"' alone "$@"
}
inside() { # COMMAND…: in the new system, as root
    alone chroot "$root" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
        ${http_proxy:+"http_proxy=$http_proxy"} ${https_proxy:+"https_proxy=$https_proxy"} \
        DEBIAN_FRONTEND=noninteractive "$@" </dev/null
}
student() { inside runuser -u student -- sh -c "cd && $1"; }
cp /etc/resolv.conf "$root/etc/" 2>/dev/null
echo 'APT::Keep-Downloaded-Packages "true";' >"$root/etc/apt/apt.conf.d/keep"
mkdir "$root/packages"
cp "$deb"/*.deb "$root/packages"
inside useradd -m student
inside apt-get update -qq >"$work/log" 2>&1
judge "apt-get update"

# The tutorial's commands for packages, and then its blocks, from the page that is installed.
install=$(sed -n 's/^    sudo apt install /apt-get install -qq -y /p' docs/tutorial.md)
examples=$(sed -n 's/^    scenes=\(\/usr.*\)/\1/p' docs/tutorial.md)
inside sh -c "cd /packages && $install" >"$work/log" 2>&1
judge "apt installs what the tutorial says"
mkdir -p "$root/check/tests/docs" "$root/check/tests/lib"
cp tests/docs/tutorial.sh "$root/check/tests/docs"
cp tests/lib/tap.sh tests/lib/page_blocks.sh "$root/check/tests/lib"
ln -s /usr/share/doc/retex-doc/docs "$root/check/docs"
student "cd /check && BUILD=/none TUTORIAL_INSTALLED=$examples TUTORIAL_AS_WRITTEN=${TUTORIAL_AS_WRITTEN-1} \
    TUTORIAL_FOLDER=\$HOME/tutorial sh tests/docs/tutorial.sh" >"$work/tutorial" 2>&1
result "$(grep -c '^1\.\.[1-9]' "$work/tutorial")" "the tutorial ends"
while read -r line; do
    case $line in
    'ok '*) result 1 "the tutorial: ${line#* - }" ;;
    'not ok '*) result 0 "the tutorial: ${line#* - }" ;;
    *) echo "# $line" ;;
    esac
done <"$work/tutorial"

inside sh -c 'cd /packages && apt-get install -qq -y ./*.deb' >"$work/log" 2>&1
judge "apt installs all of them"
student 'for tool in /usr/bin/retex-*; do "$tool" --version && ls "/usr/share/man/man1/${tool##*/}.1.gz" || exit 1
    done' >"$work/log" 2>&1
judge "every tool runs and has its page"
for page in "$root"/usr/share/doc/retex-doc/docs/*.md; do
    grep -o ']([^)#:]*[)#]' "$page" | sed 's|](||; s|.$||; /^$/d' | while read -r link; do
        [ -e "${page%/*}/$link" ] || echo "${page##*/}: $link"
    done
done >"$work/log"
[ ! -s "$work/log" ]
judge "links between the guides lead somewhere"
# What root runs leaves nothing behind either.
inside python3 -c 'import retex; print(retex.__file__)' >"$work/log" 2>&1
judge "root, too, has the Python module"
packages=$(cd "$deb" && for file in *.deb; do echo "${file%%_*}"; done | grep -v dbgsym)
# shellcheck disable=SC2086 # several packages
inside dpkg-query -L $packages | grep '^/[^.]' | sort -u >"$root/files"
result "$(at_least "$(wc -l <"$root/files")" 200)" "$(wc -l <"$root/files") files and folders"

(cd "$work" && dpkg-source -q -x "$deb"/*.dsc source)
alone autopkgtest --user=student --no-built-binaries --summary-file="$work/summary" "$deb"/*.deb "$work/source/" \
    -- chroot "$root" >"$work/log" 2>&1
status=$?
for test in $(sed -n 's/^Tests: //p' debian/tests/control); do
    result "$(grep -c "^$test  *PASS" "$work/summary")" "autopkgtest: $test"
done
[ $status = 0 ] || show

# shellcheck disable=SC2086
inside apt-get remove -qq -y $packages >"$work/log" 2>&1
judge "apt removes them"
# For apt, a package without configuration files is gone by now.
# shellcheck disable=SC2086
inside dpkg --purge $packages >"$work/log" 2>&1
judge "dpkg purges them"
rm -rf "$root/packages" "$root/home/student" "$root/check"
left=$(
    find "$root" -xdev -name '*retex*' ! -path "$root/proc/*" ! -path "$root/tmp/*" ! -path '*/var/lib/apt/*' \
        ! -path '*/var/log/*' ! -path '*/var/cache/apt/*'
    # folders that other packages have too stay
    inside sh -c 'while read -r path; do [ ! -e "$path" ] || dpkg-query -S "$path" >/dev/null 2>&1 || echo "$path"
        done </files'
)
result "$([ -z "$left" ] && echo 1)" "nothing is left"
echo "$left" | sed '/^$/d; s/^/# /'
finish
