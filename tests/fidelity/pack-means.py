"""Means of pictures from a pack over those from its set, by channel and with one colour on all targets: those of all
light, of each lamp alone and of each finish. For pack-means.sh: SET PACK MOST OPTIONS... prints each that is off by more
than MOST, in percent, and the most."""
import subprocess, sys
import numpy as np, OpenImageIO as oiio


def picture(name, options):
    subprocess.run(["retex-combine", "-q", name, *options, "-o", name + ".picture.exr"], check=True)
    file = oiio.ImageInput.open(name + ".picture.exr")  # an ImageBuf would be that of the first picture of this name
    pixels = file.read_image("float")[..., :3].astype(float)
    file.close()
    return pixels


most, wrong, worst_block = float(sys.argv[3]), [], 0
worst = 0
for options in sys.argv[4:]:
    a, b = (picture(name, options.split()) for name in sys.argv[1:3])
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
