# What serve_textures.t asks of retex-serve: thumbnails of textures, beside means that numpy computes.
import json, os, shutil, sys, time

sys.dont_write_bytecode = True
import numpy
import OpenImageIO as oiio
from serve_ask import ask, cover, expect, metric, run, send


def linear(codes):
    return numpy.where(codes <= .04045, codes / 12.92, ((codes + .055) / 1.055) ** 2.4)


def encoded(light):
    return numpy.where(light <= .0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - .055)


def write(name, pixels, kind):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    spec.attribute('oiio:UnassociatedAlpha', 1)
    out = oiio.ImageOutput.create(name)
    out.open(name, spec)
    out.write_image(pixels.astype(numpy.float32))
    out.close()


def read(data):
    open('thumbnail.png', 'wb').write(data)
    file = oiio.ImageInput.open('thumbnail.png')
    pixels = numpy.array(file.read_image('uint8'), dtype=float)[:, :, :3] / 255
    file.close()
    return pixels


def make(name, width, height, channels, kind):
    """Writes a texture of large squares and fine noise, and returns the light of it, over white."""
    random = numpy.random.default_rng(len(name))
    squares = (numpy.indices((height, width)) // 40).sum(0)[:, :, None] % 2
    codes = numpy.clip(.2 + .6 * squares * [.9, .5, .2, 1][:channels] + random.uniform(-.2, .2, (height, width, channels)), 0, 1)
    levels = {'uint8': 255, 'uint16': 65535}.get(kind, 0)
    codes = numpy.round(codes * levels) / levels if levels else codes * 3
    write('textures/' + name, codes, kind)
    light = numpy.minimum(codes.astype(numpy.float16), 1).astype(float) if kind == 'half' else linear(codes)
    if channels == 4:
        alpha = codes[:, :, 3:]
        return linear(codes[:, :, :3]) * alpha + 1 - alpha
    return numpy.repeat(light, 3, 2) if channels == 1 else light


def thumbnails(server):
    """Each pixel is the mean of the light that it covers, in the colours that the file shows."""
    for name, width, height, size, channels, kind in (
            ('a.png', 600, 400, (256, 171), 3, 'uint8'), ('b.png', 300, 512, (150, 256), 4, 'uint8'),
            ('c.png', 257, 256, (256, 255), 1, 'uint16'), ('d.exr', 400, 400, (256, 256), 3, 'half'),
            ('e.png', 40, 30, (40, 30), 3, 'uint8'), ('f.png', 3000, 2, (256, 1), 3, 'uint8')):
        light = make(name, width, height, channels, kind)
        answer = ask(server, f'/v1/textures/{name}/thumbnail.png')
        expect(name, answer.status, 200)
        got, wanted = read(answer.body), encoded(cover(cover(light, size[1]).transpose(1, 0, 2), size[0]).transpose(1, 0, 2))
        expect(name + ' size', got.shape, wanted.shape)
        if numpy.abs(got - wanted).max() > .5 / 255 + 1e-4:
            print(name, 'differs by', numpy.abs(got - wanted).max() * 255)
    expect('without ending', ask(server, '/v1/textures/a/thumbnail.png').body, ask(server, '/v1/textures/a.png/thumbnail.png').body)


def formats(server):
    """Formats, quality, tags and the cache are those of pictures."""
    plain = ask(server, '/v1/textures/a/thumbnail', Accept='image/png')
    expect('by Accept', (plain.getheader('Content-Type'), plain.getheader('Vary')), ('image/png', 'Accept'))
    first = ask(server, '/v1/textures/a/thumbnail.jpg')
    tag = first.getheader('ETag')
    expect('tags', len({tag, *(ask(server, '/v1/textures/' + path).getheader('ETag') for path in (
        'a/thumbnail.png', 'a/thumbnail.jpg?quality=60', 'b/thumbnail.jpg'))}), 4)
    before = metric(server, 'cache_total{cache="hit"}')
    expect('unchanged', ask(server, '/v1/textures/a/thumbnail.jpg', If_None_Match=tag).status, 304)
    expect('kept', (ask(server, '/v1/textures/a/thumbnail.jpg').body == first.body, metric(server, 'cache_total{cache="hit"}')),
           (True, before + 2))
    expect('counted', metric(server, 'requests_total{route="texture",status="200"}') > 0, True)
    time.sleep(.2)
    shutil.copy('textures/b.png', 'textures/new'), os.rename('textures/new', 'textures/a.png')
    answer = ask(server, '/v1/textures/a/thumbnail.jpg', If_None_Match=tag)
    expect('replaced', (answer.status, answer.body), (200, ask(server, '/v1/textures/b/thumbnail.jpg').body))


def refusals(server):
    """What is not there, or no picture."""
    os.symlink(os.path.abspath('outside.png'), 'textures/outside.png')
    open('textures/broken.png', 'wb').write(open('textures/b.png', 'rb').read()[:3000])
    for path, status in (('none/thumbnail.jpg', 404), ('outside/thumbnail.jpg', 404), ('a/800x.jpg', 404), ('a/full.jpg', 404),
                         ('a/thumbnail.gif', 400), ('a/thumbnail.jpg?quality=0', 400), ('a/thumbnail.jpg?crop=0,0,1,1', 400),
                         ('a/thumbnail.jpg?preset=x', 400), ('a/thumbnail.jpg?view=Filmic', 400), ('broken/thumbnail.jpg', 500),
                         ('broken/thumbnail.jpg?Floor.scale=2', 400), ('..%2Fa/thumbnail.jpg', 400), ('a/b/thumbnail.jpg', 404)):
        answer = ask(server, '/v1/textures/' + path)
        expect(path, (answer.status, os.getcwd().encode() in answer.body), (status, False))
    expect('a name', ask(server, '/v1/textures/none/thumbnail.jpg').body, b"there is no texture 'none'; /v1 lists them\n")
    os.remove('textures/outside.png'), os.remove('textures/broken.png')


def rooms(server):
    """A room of that name is still one."""
    expect('room', [ask(server, path).status for path in ('/v1/textures', '/v1/textures/thumbnail.jpg', '/v1/textures/Floor=a/32x.jpg')],
           3 * [200])


def sent(server):
    """Images of visitors, and folders."""
    image = open('textures/b.png', 'rb').read()
    name = json.loads(send(server, image).body)['texture']
    wanted = ask(server, '/v1/textures/b/thumbnail.png').body
    expect('sent', ask(server, f'/v1/textures/{name}/thumbnail.png').body == wanted, True)
    os.makedirs('textures/wood')
    shutil.copy('textures/b.png', 'textures/wood/wood_diff.png'), shutil.copy('textures/c.png', 'textures/wood/wood_rough.png')
    time.sleep(.2)  # files that have changed just now are not kept
    for hits in 0, 1:
        before = metric(server, 'cache_total{cache="hit"}')
        expect('folder', ask(server, '/v1/textures/wood/thumbnail.png').body == wanted, True)
        expect('kept', metric(server, 'cache_total{cache="hit"}') - before, hits)


if 'OCIO' in os.environ:
    os.environ['OCIO'] = os.path.abspath(os.environ['OCIO'])
run(globals(), {'sent': ['--uploads', 'uploads']}, '--textures', 'textures')
