#!/bin/sh
# Compiles a program of somebody else by pkg-config: compile.sh FOLDER-OF-retex.pc SOURCE OUTPUT [--static]
set -eu
export PKG_CONFIG_PATH="$1"
case $2 in
*.c) compiler="${CC:-cc} -std=c11" ;;
*) compiler="${CXX:-c++} -std=c++17" ;;
esac
# Spaces in paths are escaped for a shell.
eval "$compiler -O -Wall -Wextra -Werror -pedantic '$2' -o '$3' $(pkg-config ${4-} --cflags --libs retex)"
