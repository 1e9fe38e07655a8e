# retex-serve with --key-file: signed URLs, and files of keys; serve_signed.py has the checks.
$ mkdir rooms textures uploads
$ make_set raw.exr 64 48
$ retex-pack -q raw.exr -o rooms/small.retex
$ cp "$SCENES/textures/brick.jpg" textures
$ cp "$SCENES/living-room/textures/oak-planks.jpg" textures/oak.jpg
$ cp textures/oak.jpg outside.jpg
$ /usr/bin/python3 - <<'END' >keys
+ new, before = bytes(range(100, 164)), bytes(range(16))
+ print("# new", new.hex(), "", "\t# the one before", "  " + before.hex().upper() + " \r", sep="\n")
+ END
$ chmod 640 keys
$ /usr/bin/python3 "$TESTS/serve_signed.py" signed_urls signed_images signed_uploads printed
> signed_urls
> signed_images
> signed_uploads
> printed

# Files of keys. What they hold is never printed.
$ retex-serve rooms --key-file none
! retex-serve: error: cannot read none: No such file or directory
= 2
$ mkdir -m 700 folder
$ retex-serve rooms --key-file folder
! retex-serve: error: cannot read folder: Is a directory
= 2
$ cp keys open
$ chmod 644 open
$ retex-serve rooms --key-file open
! retex-serve: error: everybody may use the keys in open; `chmod o= open` helps
= 2
$ (
+     umask 027
+     : >empty
+     echo '# none' >comment
+ )
$ for f in empty comment; do retex-serve rooms --key-file $f; done
! retex-serve: error: there is no key in empty
! retex-serve: error: there is no key in comment
= 2
$ umask 027 && head -c 20000 /dev/zero >zero
$ retex-serve rooms --key-file zero
! retex-serve: error: zero is too large for a file of keys
= 2
% # A file of keys with the text is refused.
% refuse() {
%     umask 027
%     printf "$1" >bad
%     retex-serve rooms --key-file bad --sign /v1
% }
% key=000102030405060708090a0b0c0d0e0f
$ refuse secret
! retex-serve: error: bad:1: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ refuse "$key\n${key}0\n"
! retex-serve: error: bad:2: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ refuse "\n${key%??}\n"
! retex-serve: error: bad:2: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ refuse "$key $key\n"
! retex-serve: error: bad:1: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ refuse "$key$key$key$key$key\n"
! retex-serve: error: bad:1: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ refuse "$key\n0x$key\n"
! retex-serve: error: bad:2: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ refuse "${key}\\0\n"
! retex-serve: error: bad:1: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ refuse "$(printf %0130d 0)\n"
! retex-serve: error: bad:1: expected a key of 32 to 128 hexadecimal digits, an even number, and nothing else
= 2
$ umask 027
+ for i in 1 2 3 4 5 6 7 8 9; do echo $key; done >many
$ retex-serve rooms --key-file many
! retex-serve: error: many:9: at most 8 keys are taken
= 2
$ umask 027
+ {
+     printf '#%0500d\n' 0
+     echo $key
+ } >long
$ retex-serve --key-file long --sign /v1 | wc -c
> 48

# What cannot be signed.
$ retex-serve --sign /v1
! retex-serve: error: --sign needs a key: add --key-file FILE
= 2
$ retex-serve --key-file keys --sign v1
! retex-serve: error: --sign: expected a URL such as https://example.org/v1/room/full.jpg, or its path, not 'v1'
= 2
$ retex-serve --key-file keys --sign https://example.org
! retex-serve: error: --sign: expected a URL such as https://example.org/v1/room/full.jpg, or its path, not 'https://example.org'
= 2
$ retex-serve --key-file keys --sign '/v1/a room/full.jpg'
! retex-serve: error: --sign: in '/v1/a room/full.jpg' there are characters to be percent-encoded, the first one behind '/v1/a'
= 2
$ retex-serve --key-file keys --sign '/v1/room/Wall=#ff8800/full.jpg'
! retex-serve: error: --sign: in '/v1/room/Wall=#ff8800/full.jpg' there are characters to be percent-encoded, the first one behind '/v1/room/Wall='
= 2
$ retex-serve --key-file keys --sign /v1/room/full.bmp
! retex-serve: error: --sign: pictures are not written as .bmp; /v1 lists the formats
= 2
$ retex-serve --key-file keys --sign ''
! retex-serve: error: --sign: expected a URL such as https://example.org/v1/room/full.jpg, or its path, not ''
= 2
$ retex-serve --key-file keys --sign /v1 -o signed
$ wc -c <signed
> 48
