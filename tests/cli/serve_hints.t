# retex-serve: the size auto, by client hints; serve_hints.py has the checks.
$ mkdir rooms; make_set raw.exr 500 100; retex-pack -q raw.exr -o rooms/room.retex; /usr/bin/python3 "$TESTS/serve_hints.py" widths headers bounded
> widths
> headers
> bounded
