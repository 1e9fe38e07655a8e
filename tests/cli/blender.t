# The add-on for Blender, without Blender: it is Python that compiles, and nothing in it is undefined or unused.
$ /usr/bin/python3 -c "import sys; compile(open(sys.argv[1]).read(), sys.argv[1], 'exec')" $TESTS/../../tools/blender/retex_export.py
$ if command -v pyflakes3 >/dev/null; then pyflakes3 $TESTS/../../tools/blender/retex_export.py; fi
# The sockets of Principled shaders by the names of Blender 3.4, and by those of 4.
$ /usr/bin/python3 $TESTS/blender_stub.py $TESTS/../../tools/blender/retex_export.py
