#!/bin/sh
# Compiles older.c against shortened headers and runs it with the library of a build: older.sh LIBRARY-FOLDER
# It works in the current folder, and prints what older.c prints.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
# A library with sanitizers needs them in the program.
sanitizers=$(nm -D "$1/libretex.so" | grep -o '__[at]san_init' | sed 's/__asan_init/-fsanitize=address,undefined/
    s/__tsan_init/-fsanitize=thread/')
python3 "$here/shorten.py" "$here/../../tools/libretex/include" older-headers >older-calls
# shellcheck disable=SC2086
${CC:-cc} -std=c11 -D_GNU_SOURCE -O -g -Wall -Wextra -Werror $sanitizers -Iolder-headers "$here/older.c" -o older \
    -L"$1" -lretex -Wl,-rpath,"$(cd "$1" && pwd)"
./older room.exr Floor=wood.png .
# A call that older.c forgets
while read -r call; do grep -q "\<$call\>" "$here/older.c" || echo "$call is not called"; done <older-calls
