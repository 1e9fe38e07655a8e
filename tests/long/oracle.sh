#!/bin/sh
# A minute of random scenes against a plain loop, other ones each time; what fails names its seed.
set -u
. tests/lib/tap.sh
RETEX_ORACLE_SEED=$(date +%s) RETEX_ORACLE_SECONDS=60 "$BUILD/tests/unit/test_accel_oracle" >"$work/log" 2>&1
if [ $? = 0 ]; then ok=1; else ok=0; fi
grep -a '^#\|ERROR' "$work/log" | sed 's/^#* */# /'
result $ok "ray queries against a plain loop"
finish
