# What serve_formats.t asks of retex-serve: AVIF and JPEG XL, decoded by libheif and djxl, beside PNG and JPEG.
import subprocess, sys, time

sys.dont_write_bytecode = True
import numpy
import OpenImageIO as oiio
from serve_ask import ask, combine, expect, run

TYPES = {'avif': 'image/avif', 'jxl': 'image/jxl', 'webp': 'image/webp', 'jpg': 'image/jpeg', 'png': 'image/png'}


def decode(name):
    if name.endswith('.jxl'):
        subprocess.run(['djxl', name, name + '.png'], check=True, stderr=subprocess.DEVNULL)
        name += '.png'
    file = oiio.ImageInput.open(name)
    pixels = numpy.array(file.read_image('uint8'), dtype=float)
    file.close()
    return pixels


def get(server, url, ending):
    answer = ask(server, url)
    expect(url, (answer.status, answer.getheader('Content-Type')), (200, TYPES[ending]))
    open('got.' + ending, 'wb').write(answer.body)
    return decode('got.' + ending)[:, :, :3], answer


def luma_error(a, b):
    return numpy.sqrt(numpy.mean(((a - b) @ [.299, .587, .114]) ** 2))


def qualities(server):
    """The picture is that of the PNG, with about the error of a JPEG of that quality, in fewer bytes."""
    plain, _ = get(server, '/v1/room/floor=oak/full.png', 'png')
    for quality in 70, 95:
        url = f'/v1/room/floor=oak/full.%s?quality={quality}'
        of_jpeg, jpeg = get(server, url % 'jpg', 'jpg')
        for ending in 'avif', 'jxl':
            got, answer = get(server, url % ending, ending)
            expect(ending + ' size', got.shape, plain.shape)
            ratio = luma_error(got, plain) / luma_error(of_jpeg, plain)
            share = len(answer.body) / len(jpeg.body)
            if not .5 < ratio < 1.6 or share > .95:
                print(f'{ending}, quality {quality}: {ratio:.2f} times the error, {share:.2f} of the size')
            drift = numpy.abs((got - plain).mean(axis=(0, 1))).max()
            if drift > 1.2:
                print(f'{ending}, quality {quality}: colours differ by {drift:.2f} in the mean')


def colours(server):
    """The files say that they are sRGB."""
    get(server, '/v1/room/full.avif', 'avif')
    data = open('got.avif', 'rb').read()
    at = data.find(b'colrnclx') + 8  # primaries of BT.709, transfer of sRGB, matrix of BT.601, full range
    expect('avif', data[at:at + 7].hex(), '0001000d000680')
    get(server, '/v1/room/full.jxl', 'jxl')
    told = subprocess.run(['jxlinfo', 'got.jxl'], capture_output=True, text=True).stdout
    expect('jxl', 'sRGB primaries, sRGB transfer function' in told or told, True)


def negotiated(server):
    """What a client takes decides, and each file has its tag."""
    browsers = {'avif': 'image/avif,image/webp,image/apng,image/svg+xml,image/*,*/*;q=0.8', 'jxl': 'image/jxl,image/webp,*/*;q=0.8',
                'webp': 'image/webp,*/*;q=0.8', 'jpg': '*/*', 'png': 'image/png'}
    tags = set()
    for ending, accept in browsers.items():
        answer = ask(server, '/v1/room/32x', Accept=accept)
        expect(accept, (answer.getheader('Content-Type'), answer.getheader('Vary')), (TYPES[ending], 'Accept'))
        expect('the same', answer.body == ask(server, '/v1/room/32x.' + ending).body, True)
        tag = answer.getheader('ETag')
        tags.add(tag)
        expect('unchanged', ask(server, '/v1/room/32x', Accept=accept, If_None_Match=tag).status, 304)
        expect('IIIF', ask(server, f'/iiif/3/room/full/32,/0/default.{ending}').body == answer.body, True)
    expect('tags', len(tags), 5)


def odd_sizes(server):
    """Any size, and parts."""
    for size in '1x1', '1x', 'x1', '3x5', '63x47':
        for ending in 'avif', 'jxl':
            got, _ = get(server, f'/v1/room/{size}.{ending}', ending)
            plain, _ = get(server, f'/v1/room/{size}.png', 'png')
            expect(size, got.shape, plain.shape)
            if numpy.abs(got - plain).max() > 40:
                print(size, ending, numpy.abs(got - plain).max())


def large(server):
    """Pictures that are encoded by another process have the bytes of retex-combine."""
    for ending in 'webp', 'avif', 'jxl', 'png':
        for quality in 95, 60:
            url = f'/v1/large/floor=oak/full.{ending}?quality={quality}'
            answer = ask(server, url)
            expect(url, answer.status, 200)
            wanted = combine('x.' + ending, 'rooms/large.retex', '--texture', 'floor=textures/oak.jpg', '--quality', str(quality))
            expect(url + ' bytes', answer.body == wanted, True)
    expect('half', get(server, '/v1/large/500x.avif', 'avif')[0].shape, get(server, '/v1/large/500x.png', 'png')[0].shape)


def late(server):
    """An encoder that takes too long is ended, and others go on. RETEX_DECODER is one that never ends."""
    for ending in 'avif', 'webp', 'jxl':
        began = time.time()
        answer = ask(server, f'/v1/large/full.{ending}')
        expect(ending, (answer.status, answer.body[:40], answer.getheader('Retry-After')), (503, b'the server is busy\n', '2'))
        if not 1 <= time.time() - began < 6:
            print(f'{ending}: {time.time() - began:.1f} s')
    expect('nothing is left', subprocess.run(['pgrep', '-f', 'sleep 98765'], capture_output=True).stdout, b'')
    expect('a small one', [ask(server, f'/v1/large/64x.{ending}').status for ending in ('avif', 'webp', 'png')], 3 * [200])


run(globals(), {'late': ['--deadline', '2']}, '--textures', 'textures')
