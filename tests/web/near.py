"""Compares pictures of a folder for browsers, as reference.py makes them, with those of retex-combine: near.py SET FOLDER.
Each line of standard input is a case: DB [TARGET=IMAGE|r,g,b[:OPTIONS]]... [light:LAMP=VALUE]... [finish:TARGET=NAME]...
Nothing is printed of one whose PSNR is at least DB decibels."""
import subprocess
import sys

import reference


def option(word):
    """Of retex-combine."""
    name, value = word.split("=", 1)
    kind, colon, of = name.partition(":")
    if colon:
        return ["--" + kind, f"{of}={value}"]  # light and finish
    image, *placed = value.split(":")
    return [":".join(["--texture", *placed]), f"{name}={image}" if "/" in image else f"{name}=rgb({image})"]


given, folder = sys.argv[1:]
room = reference.Room(folder)
for case in sys.stdin:
    least, *words = case.split()
    options = [text for word in words for text in option(word)]
    subprocess.run(["retex-combine", "-q", given, *options, "-o", "near-a.exr"], check=True)
    reference.write("near-b.exr", room.picture(*words))
    if subprocess.run(["retex-diff", "-q", "near-a.exr", "near-b.exr", "--fail-psnr", least], check=False).returncode:
        print("too far:", *words)
