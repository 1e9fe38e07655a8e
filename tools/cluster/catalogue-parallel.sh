#!/bin/sh
# Makes the pictures of a table in N processes with GNU parallel, and verifies them:
#     catalogue-parallel.sh N SET TABLE.csv MANIFEST [options of retex-combine]
# After a failure, or a change of the table, a texture or the set, the same command makes what is missing or stale.
set -eu
shards=$1 set=$2 table=$3 manifest=$4
shift 4

# Each job has its own part of the table. The manifest tells what is done, so parallel needs no log.
seq "$shards" | parallel --jobs "$(nproc)" --retries 3 --halt soon,fail=1 --quote \
    retex-combine -q "$set" --batch "$table" --manifest "$manifest" --resume --mkdir --threads 1 "$@" --shard "{}/$shards"

retex-combine "$set" --batch "$table" --manifest "$manifest" "$@" --verify
