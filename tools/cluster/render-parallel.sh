#!/bin/sh
# Renders a set in N shards with GNU parallel, then merges them:
#     render-parallel.sh N OUTPUT.exr SCENE.pov [options of retex-render]
# PARALLEL, which parallel(1) reads itself, adds options: PARALLEL='--sshlogin a,b --workdir .' uses other machines.
# After a failure the same command goes on.
set -eu
shards=$1 output=$2
shift 2
mkdir -p "$output.shards"

# One job a core. A job that fails is tried three times; then no new ones are begun. The log tells which are done.
seq "$shards" | parallel --jobs "$(nproc)" --joblog "$output.shards/log" --resume-failed --retries 3 \
    --halt soon,fail=1 --quote retex-render -q --threads 1 "$@" --shard "{}/$shards" -o "$output.shards/{}"

for shard in $(seq "$shards"); do
    set -- "$@" --merge "$output.shards/$shard"
done
retex-render "$@" -o "$output"
rm -r "$output.shards"
