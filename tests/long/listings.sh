#!/bin/sh
# What is listed of scenes with all combinations of -t, -l, --finish, --camera and --crop, under the address and
# undefined-behaviour sanitizers: of the project's scenes and those of $RETEX_SHARED or ../shared. It takes minutes a
# scene; LISTINGS=N takes N combinations of each. The sanitized program is made by `make sanitized-fuzz`, which check-all
# does first.
set -u
. tests/lib/tap.sh
ASAN_OPTIONS=quarantine_size_mb=16:intercept_tls_get_addr=0
LSAN_OPTIONS=suppressions=$here/tests/lib/lsan.supp:print_suppressions=0
export ASAN_OPTIONS LSAN_OPTIONS
find scenes docs tests/golden/room.pov tests/cli/finishes.pov "${RETEX_SHARED:-../shared}" -name '*.pov' \
    ! -path '*/attack*' | sort >"$work/list" # those were made to take memory and time
set --
while read -r scene; do set -- "$@" "$scene"; done <"$work/list"
/usr/bin/python3 -B tests/lib/listings.py "$BUILD/asan/bin/retex-render" "${LISTINGS:-0}" 1 "$@"
