# retex-studio: who may ask, what is read and written, projects, jobs; studio/client.py has the checks.
$ studio() { /usr/bin/python3 "$TESTS/../studio/client.py" "$@"; }; studio gate address strangers browsers roots uploads thumbs
> gate
> address
> strangers
> browsers
> roots
> uploads
> thumbs
$ studio() { /usr/bin/python3 "$TESTS/../studio/client.py" "$@"; }; studio full project windows models events
> full
> project
> windows
> models
> events
$ studio() { /usr/bin/python3 "$TESTS/../studio/client.py" "$@"; }; studio jobs killed resumed crashed quits
> jobs
> killed
> resumed
> crashed
> quits
$ studio() { /usr/bin/python3 "$TESTS/../studio/client.py" "$@"; }; studio idle busy
> idle
> busy
$ studio() { /usr/bin/python3 "$TESTS/../studio/client.py" "$@"; }; studio foreign options links served
> foreign
> options
> links
> served
$ retex-studio none.glb --no-browser
! retex-studio: error: none.glb: No such file or directory
= 2
$ retex-studio --textures none --no-browser
! retex-studio: error: there is no folder none
= 2
$ retex-studio --unsafe --safe
! retex-studio: error: --unsafe cannot be given with --safe or RETEX_SAFE
= 2
