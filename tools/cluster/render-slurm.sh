#!/bin/sh
# Renders a set in N shards as a Slurm job array, and merges them in a job that waits for the array:
#     render-slurm.sh N OUTPUT.exr SCENE.pov [options of retex-render]
# Prints the numbers of both jobs.
set -eu
here=$(dirname "$0")
export SHARDS="$1"
shift
mkdir -p "$1.shards"
array=$(sbatch --parsable --array="1-$SHARDS" "$here/render.sbatch" "$@")
merge=$(sbatch --parsable --dependency="afterok:$array" "$here/merge.sbatch" "$@")
echo "$array $merge"
