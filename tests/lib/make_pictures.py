"""make_pictures.py FOLDER: picture files of the formats that OpenImageIO writes, PNG files of every kind, and files of
formats that it only reads. make_jpegs and make_tiffs have more of JPEG and TIFF."""
import struct
import sys
import zlib

import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT = 61, 47


def pixels(channels, top):
    """Edges, a gradient and noise; alpha from 0 to 1."""
    y, x, c = np.mgrid[0:HEIGHT, 0:WIDTH, 0:channels]
    noise = ((x * 73 + y * 151 + c * 37).astype(np.uint64) * 2654435761 & 0xffffffff) >> 28
    values = (x * 2 + y + (((x // 9 + y // 7 + c) % 3) == 0) * 60 + noise) / 255
    if channels in (2, 4):
        values[:, :, -1] = np.clip(x[:, :, -1] / (WIDTH / 2), 0, 1)
    return values.astype(np.float32) if top == 1 else np.floor(values * top + 0.5)


def write(path, channels, kind, attributes=(), frames=1):
    """By OpenImageIO."""
    out = oiio.ImageOutput.create(path)
    spec = oiio.ImageSpec(WIDTH, HEIGHT, channels, kind)
    tiled = dict(attributes).get("tile")
    if tiled:
        spec.tile_width = spec.tile_height = tiled
    spec.attribute("DateTime", "2000:01:01 00:00:00")  # else the time at which it is written
    for name, value in attributes:
        if name != "tile":
            spec.attribute(name, value)
    if not out:
        return
    for frame in range(frames):
        if frames > 1 and frame == 0:
            assert out.open(path, (spec,) * frames) or out.open(path, spec), out.geterror()
        else:
            assert out.open(path, spec, "Create" if frame == 0 else "AppendSubimage"), (path, out.geterror())
        assert out.write_image(np.ascontiguousarray(pixels(channels, 1) * (1 - frame / 4))), (path, out.geterror())
    out.close()


def by_openimageio(folder):
    """One file of each kind."""
    for compression in "none rle zip zips piz pxr24 b44 b44a dwaa dwab".split():
        for kind in "half", "float":
            write(f"{folder}/exr-{compression}-{kind}.exr", 3, kind, [("compression", compression)])
    write(f"{folder}/exr-tiled.exr", 4, "half", [("tile", 32), ("compression", "zip")])
    write(f"{folder}/exr-tiled-piz.exr", 4, "half", [("tile", 16), ("compression", "piz")])
    write(f"{folder}/exr-integers.exr", 3, "uint", [("compression", "zip")])
    write(f"{folder}/exr-parts.exr", 3, "half", [("compression", "zip"), ("name", "one")])
    for channels in 1, 3, 4:
        write(f"{folder}/bmp-{channels}.bmp", channels, "uint8")
        write(f"{folder}/sgi-{channels}.sgi", channels, "uint8", [("compression", "rle")])
        write(f"{folder}/sgi-plain-{channels}.sgi", channels, "uint8", [("compression", "none")])
        write(f"{folder}/fits-{channels}.fits", channels, "float")
        write(f"{folder}/rla-{channels}.rla", channels, "uint8")
        write(f"{folder}/jp2-{channels}.jp2", channels, "uint8")
        write(f"{folder}/dpx-8-{channels}.dpx", channels, "uint8")
    for kind in "uint16", "float":
        write(f"{folder}/rla-{kind}.rla", 3, kind)
    write(f"{folder}/sgi-16.sgi", 3, "uint16", [("compression", "rle")])
    write(f"{folder}/jp2-16.jp2", 3, "uint16")
    write(f"{folder}/j2k.j2k", 3, "uint8")
    for bits in 10, 12, 16:
        write(f"{folder}/dpx-{bits}.dpx", 3, "uint16", [("oiio:BitsPerSample", bits)])
    for channels in 3, 4:
        for compression in "none", "rle":
            write(f"{folder}/tga-{compression}-{channels}.tga", channels, "uint8", [("compression", compression)])
            if channels == 4:  # of three, OpenImageIO writes a few bytes less than its reader expects
                write(f"{folder}/iff-{compression}.iff", channels, "uint8", [("compression", compression)])
        write(f"{folder}/webp-{channels}.webp", channels, "uint8", [("compression", "webp:80")])
        write(f"{folder}/webp-lossless-{channels}.webp", channels, "uint8", [("compression", "lossless:60")])
        write(f"{folder}/heif-{channels}.heic", channels, "uint8", [("compression", "heif:75")])
    write(f"{folder}/ico.ico", 4, "uint8")
    write(f"{folder}/ico-png.ico", 4, "uint8", [("ico:PNG", 1)])
    write(f"{folder}/gif.gif", 3, "uint8")
    write(f"{folder}/gif-interlaced.gif", 3, "uint8", [("gif:Interlacing", 1)])
    write(f"{folder}/gif-alpha.gif", 4, "uint8")
    write(f"{folder}/gif-frames.gif", 3, "uint8", frames=3)
    write(f"{folder}/hdr.hdr", 3, "float")
    write(f"{folder}/zfile.zfile", 1, "float")
    for ending, channels in ("pgm", 1), ("ppm", 3):
        write(f"{folder}/pnm-{ending}.{ending}", channels, "uint8")
        write(f"{folder}/pnm-16-{ending}.{ending}", channels, "uint16")
        write(f"{folder}/pnm-text-{ending}.{ending}", channels, "uint8", [("pnm:binary", 0)])
    write(f"{folder}/tiff-mipmapped.tif", 3, "uint8", [("tile", 16), ("compression", "zip")], frames=2)


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png_rows(rows, bits):
    """Rows of samples as a PNG stores them, filtered by kinds in turn."""
    lines, before = [], None
    bytes_a_pixel = max(1, rows.shape[2] * bits // 8)
    for y, row in enumerate(rows.reshape(rows.shape[0], -1)):
        if bits == 16:
            line = np.frombuffer(row.astype(">u2").tobytes(), np.uint8)
        elif bits == 8:
            line = row.astype(np.uint8)
        else:
            fields = (row.astype(np.uint8)[:, None] >> np.arange(bits - 1, -1, -1)) & 1
            line = np.packbits(fields.reshape(-1))
        kind = y % 3  # none, left, above
        other = np.zeros_like(line)
        if kind == 1:
            other[bytes_a_pixel:] = line[:-bytes_a_pixel]
        elif kind == 2 and before is not None:
            other = before
        lines.append(bytes([kind]) + (line - other).tobytes())
        before = line
    return b"".join(lines)


def png(color, bits, interlaced=False, before=(), after=(), pieces=1, surplus=b"", damage=False):
    """A PNG. before, after: chunks beside the pixels. surplus: what the compressed data have beyond the pixels."""
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color]
    samples = pixels(channels, 2**bits - 1).clip(0, 2**bits - 1).astype(np.uint16)
    steps = [(0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1)]
    passes = [samples[y::dy, x::dx] for y, x, dy, dx in steps] if interlaced else [samples]
    data = bytearray(zlib.compress(b"".join(png_rows(p, bits) for p in passes) + surplus))
    if damage:
        data[-1] ^= 1  # the sum of the compressed data
    cut = [len(data) * i // pieces for i in range(pieces + 1)]
    head = struct.pack(">IIBBBBB", WIDTH, HEIGHT, bits, color, 0, 0, int(interlaced))
    palette = [chunk(b"PLTE", bytes((i * (c + 1)) & 255 for i in range(2**bits) for c in range(3)))] * (color == 3)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        [chunk(b"IHDR", head), *before[:1], *palette, *before[1:],
         *(chunk(b"IDAT", bytes(data[a:b])) for a, b in zip(cut, cut[1:])), *after, chunk(b"IEND", b"")])


def pngs(folder):
    """Every kind of colours, and strange files that are whole."""
    files = {}
    for color, depths in (0, (1, 2, 4, 8, 16)), (2, (8, 16)), (3, (1, 2, 4, 8)), (4, (8, 16)), (6, (8, 16)):
        for bits in depths:
            files[f"{color}-{bits}"] = png(color, bits)
            files[f"{color}-{bits}-interlaced"] = png(color, bits, True)
    text = chunk(b"tEXt", b"Comment\0after the pixels")
    files["text-after"] = png(2, 8, after=[text])
    files["unknown-after"] = png(2, 8, after=[chunk(b"prVt", b"whatever"), text])
    files["pieces"] = png(2, 8, pieces=40)
    files["trailing"] = png(2, 8) + bytes(1000)
    files["gamma"] = png(2, 8, before=[chunk(b"gAMA", struct.pack(">I", 100000))])
    files["gamma-interlaced"] = png(2, 8, True, before=[chunk(b"gAMA", struct.pack(">I", 45455))])
    files["time-wrong"] = png(2, 8, before=[chunk(b"tIME", b"\x07\xe7\x0d\x20\x00\x00\x00")])
    files["clear"] = png(2, 8, before=[chunk(b"gAMA", struct.pack(">I", 45455)), chunk(b"tRNS", bytes(6))])
    turned = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0"
    files["turned"] = png(2, 8, before=[chunk(b"eXIf", turned)])
    files["surplus"] = png(2, 8, surplus=bytes(100))
    files["surplus-gamma"] = png(2, 8, surplus=bytes(100), before=[chunk(b"gAMA", struct.pack(">I", 100000))])
    for name, data in files.items():
        with open(f"{folder}/png-{name}.png", "wb") as out:
            out.write(data)


def others(folder):
    """Formats that OpenImageIO only reads, and strange files of others."""
    grey, rgb = pixels(1, 255).clip(0, 255).astype(np.uint8), pixels(3, 255).clip(0, 255).astype(np.uint8)
    with open(f"{folder}/pfm.pfm", "wb") as out:
        out.write(b"PF\n%d %d\n-1.0\n" % (WIDTH, HEIGHT) + pixels(3, 1).astype("<f4")[::-1].tobytes())
    bits = np.packbits(grey[:, :, 0] < 100, axis=1)
    with open(f"{folder}/pnm-pbm.pbm", "wb") as out:
        out.write(b"P4\n# a comment\n%d %d\n" % (WIDTH, HEIGHT) + bits.tobytes())
    head = b"8BPS" + struct.pack(">H6xHIIHH", 1, 3, HEIGHT, WIDTH, 8, 3)
    planes = rgb.transpose(2, 0, 1)
    with open(f"{folder}/psd.psd", "wb") as out:
        out.write(head + struct.pack(">IIIH", 0, 0, 0, 0) + planes.tobytes())
    runs = [b"".join(bytes([0, v]) for v in row.tobytes()) for plane in planes for row in plane]
    with open(f"{folder}/psd-packed.psd", "wb") as out:
        out.write(head + struct.pack(">IIIH", 0, 0, 0, 1) + struct.pack(f">{len(runs)}H", *map(len, runs)) +
                  b"".join(runs))
    head = struct.pack("<4s7I44xII4s5I4I4x", b"DDS ", 124, 0x100f, HEIGHT, WIDTH, WIDTH * 3, 0, 0, 32, 0x40, b"", 24,
                       0xff0000, 0xff00, 0xff, 0, 0x1000, 0, 0, 0)
    with open(f"{folder}/dds.dds", "wb") as out:
        out.write(head + rgb[:, :, ::-1].tobytes())
    palette = b"".join(bytes([i, i, i, 0]) for i in range(256))
    rows = b"".join(row.tobytes() + bytes(-WIDTH % 4) for row in grey[::-1, :, 0])
    for name, tail in ("palette", b""), ("trailing", bytes(100)):
        with open(f"{folder}/bmp-{name}.bmp", "wb") as out:
            out.write(b"BM" + struct.pack("<IHHI", 54 + 1024 + len(rows), 0, 0, 54 + 1024) +
                      struct.pack("<IiiHHIIiiII", 40, WIDTH, HEIGHT, 1, 8, 0, 0, 0, 0, 256, 0) + palette + rows + tail)
    with open(f"{folder}/bmp-top-down.bmp", "wb") as out:
        out.write(b"BM" + struct.pack("<IHHI", 0, 0, 0, 54 + 1024) +  # some programs leave the size of the file 0
                  struct.pack("<IiiHHIIiiII", 40, WIDTH, -HEIGHT, 1, 8, 0, 0, 0, 0, 256, 0) + palette + rows)
    for name, left in ("gif-trailing.gif", bytes(100)), ("webp-trailing.webp", bytes(10)), ("jp2-trailing.jp2", b""):
        like = {"gif-trailing.gif": "gif.gif", "webp-trailing.webp": "webp-3.webp", "jp2-trailing.jp2": "jp2-3.jp2"}[name]
        with open(f"{folder}/{like}", "rb") as one, open(f"{folder}/{name}", "wb") as out:
            out.write(one.read() + left)
    with open(f"{folder}/gif.gif", "rb") as one, open(f"{folder}/gif-unended.gif", "wb") as out:
        out.write(one.read().rstrip(b";"))  # without the trailer, as some programs write it
    with open(f"{folder}/tiff-plain.tif", "rb") as one:
        data = bytearray(one.read())
    (first,) = struct.unpack_from("<I", data, 4)
    (count,) = struct.unpack_from("<H", data, first)
    entries = [data[first + 2 + 12 * i:first + 14 + 12 * i] for i in range(count)]
    data[first + 2:first + 2 + 12 * count] = b"".join(reversed(entries))
    with open(f"{folder}/tiff-unsorted.tif", "wb") as out:
        out.write(data)
    with open(f"{folder}/hdr-flat.hdr", "wb") as out:  # without runs
        rgbe = np.concatenate([rgb, np.full((HEIGHT, WIDTH, 1), 128, np.uint8)], axis=2)
        out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH) + rgbe.tobytes())


def main():
    folder = sys.argv[1]
    by_openimageio(folder)
    pngs(folder)
    others(folder)


if __name__ == "__main__":
    main()
