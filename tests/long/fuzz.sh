#!/bin/sh
# A short run of every fuzz driver, always the same inputs as far as time reaches. `make fuzz` runs them for longer,
# with other inputs. The sanitized programs are made by `make sanitized-fuzz`, which check-all does first.
set -u
. tests/lib/tap.sh
KEEP=$BUILD/fuzz
BUILD=$BUILD/asan
export KEEP BUILD
for name in edit request ini manifest pack set scene gltf import upload player; do
    if tests/fuzz/run.sh 10 1 $name >"$work/log" 2>&1; then ok=1; else ok=0; fi
    sed 's/^/# /' "$work/log"
    result $ok "$name"
done
finish
