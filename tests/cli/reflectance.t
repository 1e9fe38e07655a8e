# The AOV `reflectance`, of all kinds of finishes, by closed forms. It is the albedo times what the finish makes of it.

$ skip-unless /usr/bin/python3 -c 'import numpy, OpenImageIO'
$ /usr/bin/python3 -B "$TESTS/reflectance.py"
