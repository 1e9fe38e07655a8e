# The size `auto` is the width that the browser's hints mean, rounded up to 320, 480, 640 ... pixels (retex-serve(1)), and
# at most the room's, which is 500 wide. serve_hints.py has the checks.
$ mkdir rooms
$ make_set raw.exr 500 100
$ retex-pack -q raw.exr -o rooms/room.retex
$ /usr/bin/python3 "$TESTS/serve_hints.py" widths
> widths
$ /usr/bin/python3 "$TESTS/serve_hints.py" headers
> headers
$ /usr/bin/python3 "$TESTS/serve_hints.py" bounded
> bounded
