"""Pictures that state their colours, and what these are in scene-linear Rec.709, by published matrices and curves.

For each case NAME.FORMAT has the encoded colours, and NAME.expected.exr the linear ones. bad-*.FORMAT state their
colours wrongly. adobe.icc is one of the profiles.
"""
import struct
import zlib

import numpy
import OpenImageIO as oiio

# ---- colours ----

# From the profile connection space (D50) to linear Rec.709; Lindbloom, Bradford's adaptation.
FROM_D50 = numpy.array([[3.1338561, -1.6168667, -0.4906146],
                        [-0.9787684, 1.9161415, 0.0334540],
                        [0.0719453, -0.2289914, 1.4052427]])
# Columns of profiles as their makers publish them.
ADOBE = [(.60974, .31111, .01947), (.20528, .62567, .06087), (.14919, .06322, .74457)]
P3 = [(.51512, .24120, -.00105), (.29198, .69225, .04189), (.15710, .06657, .78407)]
SRGB = [(.43607, .22249, .01392), (.38515, .71687, .09708), (.14307, .06061, .71410)]
# From other primaries of white D65; Rec. ITU-R BT.2087 and SMPTE EG 432.
FROM_2020 = numpy.array([[1.6604910, -.5876411, -.0728499],
                         [-.1245505, 1.1328999, -.0083494],
                         [-.0181508, -.1005789, 1.1187297]])
FROM_P3 = numpy.array([[1.2249402, -.2249402, 0], [-.0420570, 1.0420570, 0], [-.0196376, -.0786361, 1.0982736]])


def srgb(v):
    return numpy.where(v <= .04045, v / 12.92, ((v + .055) / 1.055) ** 2.4)


def video(v):
    return numpy.where(v < .0812429, v / 4.5, ((v + .0992968) / 1.0992968) ** (1 / .45))


def power(exponent):
    return lambda v: v ** exponent


def linear(v):
    return v


def convert(codes, curve, matrix):
    return curve(codes) @ numpy.asarray(matrix).T


# ---- ICC profiles, byte by byte ----


def fixed(x):
    return struct.pack('>i', round(x * 65536))


def curve_tag(curve):
    if isinstance(curve, float):
        return b'curv' + bytes(4) + struct.pack('>IH', 1, round(curve * 256)) + bytes(2)
    table = [round(65535 * float(curve(numpy.float64(i / 1023)))) for i in range(1024)]
    return b'curv' + bytes(4) + struct.pack('>I1024H', 1024, *table)


def profile(curve, columns=None, space=b'RGB '):
    def xyz(v):
        return b'XYZ ' + bytes(4) + b''.join(fixed(x) for x in v)

    white = (.9642, 1, .8249)
    tags = {b'wtpt': xyz(white), b'cprt': b'text' + bytes(4) + b'none\0\0\0\0',
            b'desc': b'desc' + bytes(4) + struct.pack('>I', 2) + b'x\0' + bytes(78)}
    if columns:
        for letter, column in zip(b'rgb', columns):
            tags[bytes([letter]) + b'XYZ'] = xyz(column)
            tags[bytes([letter]) + b'TRC'] = curve_tag(curve)
    else:
        tags[b'kTRC'] = curve_tag(curve)
    at, table, data = 132 + 12 * len(tags), b'', b''
    for name, tag in tags.items():
        tag += bytes(-len(tag) % 4)
        table += name + struct.pack('>II', at + len(data), len(tag))
        data += tag
    size = at + len(data)
    head = struct.pack('>I4sI4s4s4s', size, bytes(4), 0x02400000, b'mntr', space, b'XYZ ') + bytes(12) + b'acsp'
    head = head.ljust(68, b'\0') + b''.join(fixed(x) for x in white)
    return head.ljust(128, b'\0') + struct.pack('>I', len(tags)) + table + data


# ---- files ----


def chunk(name, data):
    return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))


def write_png(name, codes, *chunks, bits=8):
    grey = codes.shape[2] == 1
    levels = numpy.round(codes * (2 ** bits - 1)).astype('>u2' if bits == 16 else 'u1')
    rows = b''.join(b'\0' + row.tobytes() for row in levels)
    head = struct.pack('>IIBBBBB', codes.shape[1], codes.shape[0], bits, 0 if grey else 2, 0, 0, 0)
    with open(name, 'wb') as f:
        f.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + b''.join(chunk(*c) for c in chunks) +
                chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))


def write_tiff(name, pixels, icc):
    """Of 8-bit integers or of floats, uncompressed, with the profile as tag 34675."""
    height, width = pixels.shape[:2]
    floats = name.endswith('-f.tif')
    data = pixels.astype('<f4').tobytes() if floats else numpy.round(pixels * 255).astype('u1').tobytes()
    bits = struct.pack('<HHH', *(3 * [32 if floats else 8]))
    forms = struct.pack('<HHH', *(3 * [3 if floats else 1]))
    at = 8
    places = []
    for part in (data, bits, forms, icc):
        places.append(at)
        at += len(part) + len(part) % 2
    short, long_, undefined = 3, 4, 7
    tags = [(256, long_, 1, width), (257, long_, 1, height), (258, short, 3, places[1]), (259, short, 1, 1),
            (262, short, 1, 2), (273, long_, 1, places[0]), (277, short, 1, 3), (278, long_, 1, height),
            (279, long_, 1, len(data)), (339, short, 3, places[2]), (34675, undefined, len(icc), places[3])]
    with open(name, 'wb') as f:
        f.write(struct.pack('<2sHI', b'II', 42, at))
        for part in (data, bits, forms, icc):
            f.write(part + bytes(len(part) % 2))
        f.write(struct.pack('<H', len(tags)) + b''.join(struct.pack('<HHII', *t) for t in tags) + bytes(4))


def write(name, pixels, form='uint8', **attributes):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], form)
    for key, value in attributes.items():
        spec.attribute(key, value)
    out = oiio.ImageOutput.create(name)
    assert out.open(name, spec) and out.write_image(numpy.ascontiguousarray(pixels, dtype='float32')), out.geterror()
    out.close()


def write_jpeg(name, pixels, icc):
    write(name, pixels, Compression='jpeg:100', **{'jpeg:subsampling': '4:4:4'})
    with open(name, 'rb') as f:
        data = f.read()
    marker = b'ICC_PROFILE\0\1\1' + icc
    with open(name, 'wb') as f:
        f.write(data[:2] + b'\xff\xe2' + struct.pack('>H', 2 + len(marker)) + marker + data[2:])


def iccp(data):
    return b'iCCP', b'x\0\0' + zlib.compress(data)


def number(*values):
    return b''.join(struct.pack('>I', round(v * 100000)) for v in values)


def expect(name, colours):
    write(name + '.expected.exr', numpy.broadcast_to(colours, colours.shape[:2] + (3,)), form='float')


# Patches of 8x8 pixels, so that JPEG keeps them: levels of 8 bits, saturated and grey.
levels = [0, 30, 90, 128, 200, 255]
patches = [(r, g, b) for r in levels for g in levels for b in levels]
codes = numpy.array(patches, dtype=float).reshape(12, 18, 3).repeat(8, 0).repeat(8, 1) / 255
greys = codes[:, :, :1]
adobe, p3, plain = profile(2.19921875, ADOBE), profile(srgb, P3), profile(srgb, SRGB)
by_adobe = convert(codes, power(2.19921875), FROM_D50 @ numpy.array(ADOBE).T)
by_p3 = convert(codes, srgb, FROM_D50 @ numpy.array(P3).T)
by_srgb = srgb(codes)
open('adobe.icc', 'wb').write(adobe)

write_png('adobe.png', codes, iccp(adobe))
expect('adobe', by_adobe)
write_png('patch.png', numpy.broadcast_to(numpy.array([200, 90, 30]) / 255, (8, 8, 3)), iccp(adobe))
write_png('adobe16.png', codes, iccp(adobe), bits=16)
expect('adobe16', by_adobe)
write_tiff('adobe-t.tif', codes, adobe)
expect('adobe-t', by_adobe)
write_jpeg('adobe-j.jpg', codes, adobe)
expect('adobe-j', by_adobe)
write_jpeg('srgb-j.jpg', codes, plain)
write('plain-j.jpg', codes, Compression='jpeg:100', **{'jpeg:subsampling': '4:4:4'})
write_tiff('float-f.tif', codes, profile(1.0, P3))
expect('float-f', convert(codes, linear, FROM_D50 @ numpy.array(P3).T))
write_png('p3.png', codes, iccp(p3))
expect('p3', by_p3)
write_png('srgb.png', codes, iccp(plain))
expect('srgb', by_srgb)
write_png('none.png', codes)
expect('none', by_srgb)
write_png('grey.png', greys, iccp(profile(1.8, space=b'GRAY')))
expect('grey', greys ** 1.8)
# The first of these that a PNG has: cICP, iCCP, sRGB, gAMA with cHRM.
p3_primaries = number(.3127, .329, .68, .32, .265, .69, .15, .06)
write_png('cicp.png', codes, (b'cICP', bytes([12, 13, 0, 1])), iccp(adobe), (b'gAMA', number(1)))
expect('cicp', convert(codes, srgb, FROM_P3))
write_png('cicp-2020.png', codes, (b'cICP', bytes([9, 14, 0, 1])))
expect('cicp-2020', convert(codes, video, FROM_2020))
write_png('cicp-linear.png', codes, (b'cICP', bytes([1, 8, 0, 1])), bits=16)
expect('cicp-linear', codes)
write_png('icc-first.png', codes, iccp(adobe), (b'gAMA', number(1)), (b'cHRM', p3_primaries))
expect('icc-first', by_adobe)
write_png('srgb-first.png', codes, (b'sRGB', b'\0'), (b'gAMA', number(1)), (b'cHRM', p3_primaries))
expect('srgb-first', by_srgb)
write_png('gamma.png', codes, (b'gAMA', number(1 / 1.8)))
expect('gamma', codes ** 1.8)
write_png('gamma-srgb.png', codes, (b'gAMA', number(.45455)),
          (b'cHRM', number(.3127, .329, .64, .33, .3, .6, .15, .06)))
expect('gamma-srgb', by_srgb)
write_png('primaries.png', codes, (b'gAMA', number(.45455)), (b'cHRM', p3_primaries))
expect('primaries', convert(codes, power(2.2), FROM_P3))
write_png('primaries-alone.png', codes, (b'cHRM', p3_primaries))
expect('primaries-alone', convert(codes, srgb, FROM_P3))

# Wrong: of another kind of colours, cut off, empty, of random bytes; chunks that are too short or say nothing that is.
write_png('bad-cmyk.png', codes, iccp(profile(2.2, ADOBE, b'CMYK')))
write_tiff('bad-kind.tif', codes, profile(2.2, space=b'GRAY'))
write_tiff('bad-cut.tif', codes, adobe[:200])
write_tiff('bad-noise.tif', codes, numpy.random.default_rng(1).bytes(3000))
write_tiff('bad-noise-f.tif', codes, numpy.random.default_rng(2).bytes(3000))
write_jpeg('bad-tags.jpg', codes, adobe[:132] + bytes(range(256)) * 2)
write_png('bad-cicp.png', codes, (b'cICP', bytes([9, 16, 0, 1])))
write_png('bad-cicp-short.png', codes, (b'cICP', b'\x09'))
write_png('bad-primaries.png', codes, (b'gAMA', number(.5)), (b'cHRM', number(.3127, .329, .3, .3, .3, .3, .3, .3)))
write_png('bad-gamma.png', codes, (b'gAMA', number(0)))
# Damage by accident: many bytes of a good one are changed, one by one.
for i in range(40):
    data = bytearray(adobe)
    data[(i * 37) % len(data)] ^= 255
    write_tiff(f'hurt-{i}.tif', codes[:8, :8], bytes(data))
