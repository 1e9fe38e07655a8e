#!/bin/sh
# A minute each of random scenes against plain loops, other ones each time; what fails names its seed.
set -u
. tests/lib/tap.sh
against() { # PROGRAM NAME
    if RETEX_ORACLE_SEED=$(date +%s) RETEX_ORACLE_SECONDS=60 "$BUILD/tests/unit/$1" >"$work/log" 2>&1; then ok=1; else ok=0; fi
    grep -a '^#\|ERROR' "$work/log" | sed 's/^#* */# /'
    result $ok "$2"
}
against test_accel_oracle "ray queries against a plain loop"
against test_csg "CSG against all crossings"
finish
