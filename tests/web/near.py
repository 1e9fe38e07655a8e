"""Compares the picture of a folder for browsers, as reference.py makes it, with retex-combine's:
near.py SET FOLDER DB [TARGET=IMAGE|r,g,b[:OPTIONS]]... [light:LAMP=VALUE]... [finish:TARGET=NAME]...
prints nothing if the PSNR is at least DB decibels."""
import os
import subprocess
import sys

given, folder, least, *textures = sys.argv[1:]
options = []
for text in textures:
    name, image = text.split("=", 1)
    if name.startswith("light:"):
        options += ["--light", f"{name[6:]}={image}"]
        continue
    if name.startswith("finish:"):
        options += ["--finish", f"{name[7:]}={image}"]
        continue
    image, *placed = image.split(":")
    options += [":".join(["--texture", *placed]), f"{name}={image}" if "/" in image else f"{name}=rgb({image})"]
here = os.path.dirname(os.path.abspath(__file__))
subprocess.run(["retex-combine", "-q", given, *options, "-o", "near-a.exr"], check=True)
subprocess.run([sys.executable, "-B", f"{here}/reference.py", folder, "near-b.exr", *textures], check=True)
if subprocess.run(["retex-diff", "-q", "near-a.exr", "near-b.exr", "--fail-psnr", least], check=False).returncode:
    print("too far:", *textures)
