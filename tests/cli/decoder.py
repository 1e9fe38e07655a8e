"""Pictures that take far more memory or time than their size and their format let one think."""
import struct
import zlib


def tiff(name, width, height, channels, bits, data, tile=None, floats=False):
    """One directory, compressed by deflate, one strip or tiles."""
    tags = {256: (4, [width]), 257: (4, [height]), 258: (3, [bits] * channels), 259: (3, [8]), 262: (3, [1]),
            277: (3, [channels]), 284: (3, [1]), 339: (3, [3 if floats else 1] * channels)}
    if channels > 1:
        tags[338] = (3, [0] * (channels - 1))
    if tile:
        tags.update({322: (4, [tile]), 323: (4, [tile]), 324: (4, [0]), 325: (4, [len(data)])})
    else:
        tags.update({278: (4, [height]), 273: (4, [0]), 279: (4, [len(data)])})
    extra, at = b"", 8 + 2 + 12 * len(tags) + 4
    packed = {}
    for tag, (kind, values) in tags.items():
        text = struct.pack("<%d%s" % (len(values), "HI"[kind - 3]), *values)
        if len(text) > 4:
            packed[tag] = struct.pack("<I", at + len(extra))
            extra += text + b"\0" * (len(text) % 2)
        else:
            packed[tag] = text.ljust(4, b"\0")
    packed[324 if tile else 273] = struct.pack("<I", at + len(extra))
    rows = b"".join(struct.pack("<HHI", tag, tags[tag][0], len(tags[tag][1])) + packed[tag] for tag in sorted(tags))
    with open(name, "wb") as file:
        file.write(b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", len(tags)) + rows + b"\0\0\0\0" + extra + data)


def jpeg(name, width, height, scans):
    """Progressive, grey: the same empty scan many times."""
    def segment(marker, body):
        return bytes([0xff, marker]) + struct.pack(">H", len(body) + 2) + body
    blocks = ((width + 7) // 8) * ((height + 7) // 8)
    out = b"\xff\xd8" + segment(0xdb, b"\0" + bytes([1] * 64))
    out += segment(0xc2, struct.pack(">BHHB", 8, height, width, 1) + bytes([1, 0x11, 0]))
    out += segment(0xc4, bytes([0x00, 1] + [0] * 15 + [0])) + segment(0xc4, bytes([0x10, 1] + [0] * 15 + [0xe0]))
    out += segment(0xda, bytes([1, 1, 0, 0, 0, 0])) + bytes((blocks + 7) // 8)
    bits = ("0" + "1" * 14) * ((blocks + 32766) // 32767)
    bits += "1" * (-len(bits) % 8)
    scan = int(bits, 2).to_bytes(len(bits) // 8, "big").replace(b"\xff", b"\xff\0")
    out += (segment(0xda, bytes([1, 1, 0, 1, 63, 0])) + scan) * (scans - 1) + b"\xff\xd9"
    with open(name, "wb") as file:
        file.write(out)


def png(name, megabytes):
    """8 x 8 pixels, and behind them many zeros."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    first = packer.compress(bytes(1 << 20)) + packer.flush(zlib.Z_FULL_FLUSH)
    data = b"\x78\xda" + first * megabytes + b"\3\0" + struct.pack(">HH", (megabytes << 20) % 65521, 1)
    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", data) + chunk(b"IEND", b""))


if __name__ == "__main__":
    tiff("tile.tif", 8, 8, 1, 8, zlib.compress(b""), tile=40000)
    tiff("channels.tif", 8, 8, 128, 8, zlib.compress(bytes(8 * 8 * 128)))
    tiff("wide.tif", 1000, 500, 60, 32, zlib.compress(bytes(1000 * 500 * 60 * 4), 1), floats=True)
    tiff("few.tif", 8, 8, 3, 8, zlib.compress(bytes(256 * 256 * 3)), tile=256)
    jpeg("scans.jpg", 64, 64, 201)
    jpeg("most.jpg", 64, 64, 200)
    png("long.png", 4000)
