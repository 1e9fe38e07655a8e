"""Compares the means, by channel, of pictures made from a set and from a pack of it, or a folder for browsers: of all light,
of each lamp alone and of each finish. For pack-means.sh: SET PACK MOST OPTIONS... prints each that is off by more than
MOST, in percent, and the most. Pictures of folders are those of tests/web/reference.py."""
import os, re, subprocess, sys
import numpy as np, OpenImageIO as oiio

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)) + "/../web")
import reference


def picture(name, options):
    subprocess.run(["retex-combine", "-q", name, *options, "-o", name + ".picture.exr"], check=True)
    file = oiio.ImageInput.open(name + ".picture.exr")  # an ImageBuf would be that of the first picture of this name
    pixels = file.read_image("float")[..., :3].astype(float)
    file.close()
    return pixels


def words_of(options):
    """The same edit in the words of reference.py; textures are colours."""
    for option, text in zip(options[::2], options[1::2]):
        if option == "--texture":
            yield re.sub(r"rgb\((.*)\)", r"\1", text)
        elif option == "--solo":
            yield from ("light:*=0", f"light:{text}=1")
        else:
            yield f"{option[2:]}:{text}"


given, packed, most, wrong, worst_block = sys.argv[1], sys.argv[2], float(sys.argv[3]), [], 0
room = reference.Room(packed) if os.path.isdir(packed) else None
worst = 0
for options in sys.argv[4:]:
    a = picture(given, options.split())
    b = room.picture(*words_of(options.split())) if room else picture(packed, options.split())
    off = 100 * np.abs(b.mean(axis=(0, 1)) / a.mean(axis=(0, 1)) - 1)
    worst = max(worst, off.max())
    if not off.max() <= most:
        wrong.append(f"{options}: {off.round(3)} %")
    height, width = (n // 16 * 16 for n in a.shape[:2])
    blocks = [x[:height, :width].reshape(height // 16, 16, width // 16, 16, 3).mean(axis=(1, 3)) for x in (a, b)]
    lit = blocks[0] > 0.1 * a.mean(axis=(0, 1))
    worst_block = max(worst_block, 100 * np.quantile(np.abs(blocks[1][lit] / blocks[0][lit] - 1), 0.95))
print("\n".join([f"# {worst:.3f} % at most, in 95 of 100 blocks {worst_block:.1f} %"] + wrong))
sys.exit(bool(wrong))
