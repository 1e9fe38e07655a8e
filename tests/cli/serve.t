# retex-serve: its answers beside retex-combine's pictures, and what it refuses; serve.py has the checks.
% serve() { /usr/bin/python3 "$TESTS/serve.py" "$@"; }
$ mkdir rooms textures
$ make_set rooms/raw.exr 64 48 denoise
$ retex-pack -q rooms/raw.exr -o rooms/small.retex
$ make_set other.exr 64 48
$ retex-pack -q other.exr --quality 50 -o second.retex
$ cp "$SCENES/textures/brick.jpg" textures
$ cp "$SCENES/living-room/textures/oak-planks.jpg" textures/oak.jpg
$ cp textures/oak.jpg outside.jpg
$ serve pictures parts conditions
> pictures
> parts
> conditions
$ serve replaced folders contents refused lists metrics
> replaced
> folders
> contents
> refused
> lists
> metrics
$ serve together texts crowd slow nuls deadline end
> together
> texts
> crowd
> slow
> nuls
> deadline
> end
$ mkdir presets
$ retex-combine -q rooms/raw.exr --texture:rotate=30 Floor=textures/oak.jpg --texture Wall=tan --exposure .5 \
+     --view Filmic -o x.png --save-preset presets/warm.json
$ cp presets/warm.json outside.json
$ ln -s ../outside.json presets/outside.json
$ echo broken >presets/broken.json
$ echo '{"retex-preset": 1, "edit": "Floor=gone.jpg"}' >presets/gone.json
$ cp presets/warm.json presets/.x.json
$ serve developed presets
> developed
> presets

# Images that clients send.
$ mkdir uploads
$ touch uploads/.incoming-9.jpg
$ make_picture wide.png size=1200x1000
$ make_picture third.png size=8x8
$ serve uploads documented off heads
> uploads
> documented
> off
> heads
$ ln -s uploads linked
$ timeout 20 retex-serve rooms --port 0 --uploads linked/
! retex-serve: error: --uploads: linked/ is a link; give the folder that it leads to
= 2
$ mkdir moving away
$ serve moved
> moved
$ mkdir strange
$ python3 "$TESTS/decoder.py"
$ serve decoders hurried
> decoders
> hurried

# What one client may have, and what it may tell.
$ serve shared proxied clients crawling
> shared
> proxied
> clients
> crawling
$ retex-serve rooms --trusted-proxy example.org
! retex-serve: error: --trusted-proxy: expected an address such as 127.0.0.1, or a network such as 10.0.0.0/8, not 'example.org'
= 2

# What cannot start.
$ retex-serve rooms --uploads none --port 0
! retex-serve: error: --uploads: there is no folder none
= 2
$ retex-serve
! retex-serve: error: no folder of rooms given
= 2
$ retex-serve none --port 0
! retex-serve: error: cannot read none: No such file or directory
= 2
$ retex-serve rooms --textures none --port 0
! retex-serve: error: --textures: there is no folder none
= 2
$ retex-serve rooms --listen nowhere.invalid --port 0 2>&1 | sed 's/invalid: .*/invalid/; q'
> retex-serve: error: --listen nowhere.invalid
$ retex-serve rooms --base-url example.org
! retex-serve: error: --base-url: expected a URL such as https://example.org, without a slash at its end, not 'example.org'
= 2
$ retex-serve rooms rooms
! retex-serve: error: one folder of rooms is enough; is -o rooms meant?
= 2
