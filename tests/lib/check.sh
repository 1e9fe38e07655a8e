#!/bin/sh
# Runs suites of tests and adds up their results: check.sh SUITE… or check.sh SUITE/TEST… The suite quick is the tests
# that tests/quick.txt names.
#
# Every test program prints TAP (`ok N - name`, `not ok N - name`, `ok N - name # SKIP why`, a plan `1..N`) and is one
# job of a suite; JOBS of them run at a time. It is one more failure if a job has a bad exit status without a failed
# test, reports fewer results than its plan, or reports none. Failures and skips are printed with their output. The
# whole output is kept in $BUILD/tests/log/SUITES/. The last line is `N passed, M failed, K skipped`; exit 1 after a
# failure. A job that is not done after 20 minutes is killed and fails; those of long and mutants, and the one that lets
# every call fail, take their time.
#
# CI=true: a skip is a failure unless the job's name is listed in tests/lib/may-skip.
set -u
BUILD=${BUILD:-build}
JOBS=${JOBS:-2}
logs=$BUILD/tests/log/$(echo "$*" | tr ' ' -)
rm -rf "$logs"
mkdir -p "$logs"

# The jobs of a suite, one a line: a name and the command that runs it.
jobs_of() {
    case $1 in
    unit) for t in tests/unit/test_*.c; do
            [ -e "$t" ] || continue
            t=${t##*/}
            echo "unit/${t%.c} env CMOCKA_MESSAGE_OUTPUT=TAP $BUILD/tests/unit/${t%.c}"
        done ;;
    cli | oiio) for t in tests/"$1"/*.t; do
            [ ! -e "$t" ] || { t=${t##*/}; echo "$1/${t%.t} tests/lib/case.sh $1 $t"; }
        done ;;
    man) for t in man/*.[137] man/retex-edit.5; do # retex(3) stands beside retex(1)
            [ ! -e "$t" ] || { t=${t##*/}; n=${t%.?}; [ "$t" = "$n.1" ] || [ ! -e "man/$n.1" ] || n=$t
            echo "man/$n tests/lib/man.sh man/$t"; }
        done ;;
    python) for t in tests/python/test_*.py; do
            [ ! -e "$t" ] || { n=${t##*/}; n=${n%.py}; echo "python/${n#test_} /usr/bin/python3 -B $t"; }
        done ;;
    web) for t in tests/web/test_*.mjs tests/web/test_*.sh; do
            [ ! -e "$t" ] || { n=${t##*/test_}; case $t in *.sh) run=sh ;; *) run=node ;; esac; echo "web/${n%.*} $run $t"; }
        done ;;
    golden) for t in tests/golden/*/; do
            [ ! -e "$t/command" ] || { t=${t%/}; echo "golden/${t##*/} tests/lib/golden.sh $t"; }
        done ;;
    docs | fidelity | long) for t in tests/"$1"/*.sh; do
            [ ! -e "$t" ] || { t=${t##*/}; echo "$1/${t%.sh} sh tests/$1/$t"; }
        done ;;
    faults) echo "faults/calls sh tests/faults/faults.sh" ;;
    mutants) echo "mutants/list tests/mutants/run.py" ;;
    lint) echo "lint/house sh tests/lib/lint.sh --tap" ;;
    quick) for s in lint unit cli web oiio python man docs golden faults fidelity; do jobs_of $s; done |
            awk 'NR == FNR { commands[$1] = $0; next } /^#/ { next } $1 in commands { print commands[$1]; next }
                { print "missing/" $1, "false" }' - tests/quick.txt ;;
    esac
}

for suite; do
    case $suite in
    */*) jobs_of "${suite%%/*}" | grep "^$suite " || { echo "there is no $suite" >&2; : >"$logs/missing"; } ;;
    *) jobs_of "$suite" ;;
    esac
done >"$logs/jobs"

# One job: its output into NAME.log, its exit status as the last line of it.
export BUILD logs
run_job='
name=$1; shift
log=$logs/$(echo "$name" | tr / .).log
case $name,${RETEX_FAULTS:-} in long/*,* | mutants/*,* | faults/*,all) limit=0 ;; *) limit=${JOB_SECONDS:-1200} ;; esac
timeout --foreground -k 10 "$limit" "$@" >"$log" 2>&1 </dev/null
status=$?
times >"$log.times" # in a file: a command substitution would be another process, without children
echo "# exit status $status after $(sed -n 2p "$log.times") of processor time" >>"$log"
rm "$log.times"
'
xargs -r -P "$JOBS" -L 1 sh -c "$run_job" job <"$logs/jobs"

passed=0 failed=0 skipped=0
while read -r name _; do
    log=$logs/$(echo "$name" | tr / .).log
    counts=$(awk -v name="$name" -v ci="${CI:-}" -v may_skip="$(cat tests/lib/may-skip 2>/dev/null | tr '\n' ' ')" '
        BEGIN { allowed = !ci || index(" " may_skip, " " name " ") }
        /^1\.\.[0-9]+/ { plan += substr($1, 4); planned = 1; next }
        /^# exit status/ { status = $4; next }
        /^(not )?ok / {
            results++
            if (!/# SKIP/ && /^ok/) { passed++; next }
            if (!/# SKIP/) failed++
            else if (allowed) skipped++
            else { failed++; told = told "    must not be skipped here:\n" }
        }
        { told = told "    " $0 "\n" }
        END {
            if (status == 124 || status == 137) ended = "killed: it did not end in time"
            else if (!planned || results < plan) ended = "ended early, status " status
            else if (status != 0 && !failed) ended = "status " status
            if (ended) { failed++; told = told "    " ended "\n" }
            if (failed) printf "FAIL %s\n%s", name, told > "/dev/stderr"
            else if (skipped) printf "skip %s\n%s", name, told > "/dev/stderr"
            print passed + 0, failed + 0, skipped + 0
        }' "$log")
    set -- $counts
    passed=$((passed + $1)) failed=$((failed + $2)) skipped=$((skipped + $3))
done <"$logs/jobs"
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ] && [ ! -e "$logs/missing" ]
