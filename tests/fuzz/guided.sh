#!/bin/sh
# Runs fuzz drivers guided by coverage, one after the other: guided.sh SECONDS [NAME…] (of fuzz_NAME.c; by default all
# but import, which runs other programs). $BUILD holds programs that are linked with libFuzzer. A run begins with the
# seeds and with corpus/NAME.tar.xz. What reaches new code is kept in $KEEP/corpus/NAME for the next run, and findings in
# $KEEP. With FUZZ_MINIMIZE=1 the smallest inputs that reach all that was reached take the place of the corpus, but for
# scene: its inputs are made of other people's scenes too, and stay in $KEEP. Exit 1 when something was found.
set -u
seconds=$1
shift
[ $# != 0 ] || set -- edit request ini manifest pack set scene gltf upload
. tests/fuzz/inputs.sh
begin
keep

cd "$work" || exit 2
status=0
for name; do
    program=$BUILD/tests/fuzz/fuzz_$name known=$work/known-$name kept=$KEEP/corpus/$name
    mkdir -p "$known" "$kept"
    # shellcheck disable=SC2046 # words wanted
    "$program" --seeds "$known" $(seeds_of "$name") || exit 2
    corpus=$here/tests/fuzz/corpus/$name.tar.xz
    [ ! -e "$corpus" ] || tar -C "$known" -xJf "$corpus"
    limits="-timeout=60 -rss_limit_mb=2048 -max_len=65536" words=
    [ ! -s words ] || words=-dict=words
    # shellcheck disable=SC2086
    nice "$program" $limits -max_total_time="$seconds" $words -print_final_stats=1 \
        -artifact_prefix="$KEEP/$name-" "$kept" "$known" 2>"$KEEP/$name.guided" || {
        status=1
        sed -n '/^==.*ERROR\|runtime error\|SUMMARY\|Test unit written/p' "$KEEP/$name.guided"
    }
    echo "fuzz_$name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$KEEP/$name.guided") inputs," \
        "$(sed -n 's/^#.*\(cov: [0-9]* ft: [0-9]*\).*/\1/p' "$KEEP/$name.guided" | tail -n 1)"
    [ "${FUZZ_MINIMIZE-}" = 1 ] && [ "$name" != scene ] || continue
    mkdir smallest
    # shellcheck disable=SC2086
    "$program" $limits -merge=1 smallest "$kept" "$known" 2>/dev/null
    tar -C smallest --sort=name --mtime=@0 --owner=0 --numeric-owner -cJf "$corpus" .
    rm -rf smallest
done
exit $status
