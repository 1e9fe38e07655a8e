#!/bin/sh
# Installs the build, or uninstalls it: stage.sh install|uninstall DESTDIR PREFIX [NAME=VALUE…], where NAMEs are make's.
set -eu
action=$1 stage=$2 prefix=$3
shift 3
root=$(cd "$(dirname "$0")/../.." && pwd)
# What runs the tests may be make: its jobs and variables are not for this one.
env -u MAKEFLAGS -u MAKELEVEL -u MFLAGS make -s -C "$root" -j1 BUILD="${BUILD:-build}" DESTDIR="$stage" \
    PREFIX="$prefix" "$@" "$action" >/dev/null
