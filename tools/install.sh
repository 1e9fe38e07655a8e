#!/bin/sh
# Installs retex, or removes it: install.sh install|uninstall ENTRY…; make install and make uninstall call it.
#
# An entry is MODE:SOURCE:PLACE. PLACE is below PREFIX; below LIBDIR if it begins with `lib/`; with a final slash the
# file keeps its name. MODE is that of the file, or
#     fill   644, and what templates leave open (@VERSION@ and the like, /usr/local) is filled in
#     link   a symbolic link to SOURCE
# From the environment: PREFIX, LIBDIR, DESTDIR, INSTALL; and for templates VERSION, REQUIRES, LIBS, STATIC_LIBS.
# PREFIX and the others may contain spaces. Removing removes these files, and folders that are empty then.
set -eu
action=$1
shift
: "${PREFIX:=/usr/local}" "${LIBDIR:=$PREFIX/lib}" "${DESTDIR:=}" "${INSTALL:=install}"

path_of() { # PLACE SOURCE: its path, without DESTDIR
    place=$1
    case $place in */) place=$place${2##*/} ;; esac
    case $place in
    lib/*) printf '%s\n' "$LIBDIR/${place#lib/}" ;;
    *) printf '%s\n' "$PREFIX/$place" ;;
    esac
}

# As the replacement of sed's s|||.
quoted() { printf '%s\n' "$1" | sed 's/[\\&|]/\\&/g'; }

fill() { # TEMPLATE PATH: to standard output
    folder=${2%/*}
    up=$(realpath -ms --relative-to="$folder" "$PREFIX")
    libdir=$(realpath -ms --relative-to="$folder" "$LIBDIR")
    # pkg-config knows the folder of its file, and escapes its spaces.
    case $2 in
    *.pc) up="\${pcfiledir}/$up" libdir="\${pcfiledir}/$libdir" ;;
    esac
    # systemd takes a path with spaces in quotes.
    case $PREFIX in
    *\ *) program="=\"$(quoted "$PREFIX")/bin/\\1\"" ;;
    *) program="=$(quoted "$PREFIX")/bin/\\1" ;;
    esac
    sed -e "s|=/usr/local/bin/\([^ ]*\)|$program|" -e "s|/usr/local|$(quoted "$PREFIX")|" \
        -e "s|@UP@|$(quoted "$up")|" -e "s|@LIBDIR_HERE@|$(quoted "$libdir")|" -e "s|@VERSION@|${VERSION-}|" \
        -e "s|@REQUIRES@|${REQUIRES-}|" -e "s|@LIBS@|${LIBS-}|" -e "s|@STATIC_LIBS@|${STATIC_LIBS-}|" "$1"
}

put() { # MODE SOURCE PATH
    $INSTALL -d "$DESTDIR${3%/*}"
    case $1 in
    link) ln -sf "$2" "$DESTDIR$3" ;;
    fill)
        fill "$2" "$3" >"$DESTDIR$3"
        chmod 644 "$DESTDIR$3"
        ;;
    *) $INSTALL -m "$1" "$2" "$DESTDIR$3" ;;
    esac
}

# The folders that a system has in any case stay, even if nothing is in them any more.
stays() { # folder
    case $DESTDIR$PREFIX in
    /usr | /usr/local) case $1 in */retex*) return 1 ;; esac ;;
    *) [ "$1" = "$PREFIX" ] || [ -z "$1" ] ;;
    esac
}

for entry; do
    mode=${entry%%:*} place=${entry##*:} source=${entry#*:}
    source=${source%:*}
    path=$(path_of "$place" "$source")
    if [ "$action" = install ]; then
        put "$mode" "$source" "$path"
        continue
    fi
    rm -f "$DESTDIR$path"
    folder=${path%/*}
    while ! stays "$folder" && rmdir "$DESTDIR$folder" 2>/dev/null; do
        folder=${folder%/*}
    done
done
