"""Checks of `retex-render --live`, by name, against renders of the same views."""
import os
import signal
import subprocess
import sys

import numpy
import OpenImageIO as oiio

from live_client import Live, clock, rgba

W, H = 70, 50  # tiles at the edges are smaller
CAMERA = '1,2,-4:0,.5,0:50'
FAR = '300,200,-400:0,.5,0:2'  # beyond what the ray structure is made for


files = []


def part(path, name):
    """The pixels of a set's part."""
    for k in range(100):
        buffer = oiio.ImageBuf(path, k, 0)
        if buffer.spec().getattribute('oiio:subimagename') == name or buffer.spec().getattribute('name') == name:
            return buffer.get_pixels(oiio.FLOAT)
    raise KeyError(name)


def render(*options):
    files.append(f'r{len(files)}.exr')  # each file once: OpenImageIO keeps what it has read
    subprocess.run(['retex-render', '-q', '--size', f'{W}x{H}', *options, '-o', files[-1]], check=True)
    return files[-1]


def same_as_render():
    options = ('-l', 'sun=light_source#1', '--light', 'sun=#ffd080', 'live.pov')
    live = Live(*options)
    for camera in ('-', CAMERA, FAR, '-'):
        pictures = live.view(W, H, camera, 20)
        got = pictures[-1][1]
        at = () if camera == '-' else ('--camera', camera)
        want = oiio.ImageBuf(render('--plain', '--spp', '20', *at, *options)).get_pixels(oiio.FLOAT)[..., :3]
        first = oiio.ImageBuf(render('--plain', '--spp', '1', *at, *options)).get_pixels(oiio.FLOAT)[..., :3]
        print([n for n, _ in pictures], (got[..., :3] == want.astype(numpy.float16)).all(),
              (pictures[0][1][..., :3] == first.astype(numpy.float16)).all(), (got[..., 3] == 1).all())
    print(live.end())


def mean_square(a, b):
    return numpy.square(a[..., :3].astype(float) - b[..., :3]).mean()


def denoised():
    """Near to what retex-render denoises, also before the view is done, which then goes on as ever."""
    scene = os.environ['SCENES'] + '/cornell-box/cornell-box.pov'
    live = Live(scene)
    print(live.denoise()[0])
    live.view(W, H, '-', 1)
    print(live.denoise()[0])
    plain = live.view(W, H, '-', 32)
    live.send(f'view {W} {H} - 32')
    again, got = [], []
    while len(again) < len(plain):
        head, data = live.answer()
        again.append((head['picture'], rgba(head, data)))
        if head['picture'] in (2, 8, 32):
            got.append(live.denoise())
            while 'denoised' not in got[-1][0]: # the view was faster
                again.append((got[-1][0]['picture'], rgba(*got[-1])))
                got[-1] = live.answer()
    print([n for n, _ in again], all((a == b).all() for (_, a), (_, b) in zip(plain, again)))
    print((rgba(*live.denoise()) == rgba(*got[-1])).all(), (rgba(*got[-1])[..., 3] == 1).all())
    print([head['picture'] for head, _ in got])
    converged = live.view(W, H, '-', 1024)[-1][1]
    # Of views that are done: before that, a denoised picture has up to twice the samples of the one before it.
    clean, times = [], []
    for n in (2, 8, 32):
        noisy = live.view(W, H, '-', n)[-1][1]
        clean.append(mean_square(rgba(*live.denoise()), converged))
        times.append(mean_square(noisy, converged) / clean[-1])
    print(all(t > 1.7 for t in times) or times)
    want = oiio.ImageBuf(render('--plain', '--spp', '32', '--denoise=preview', scene)).get_pixels(oiio.FLOAT)
    print(clean[-1] < 1.5 * mean_square(want, converged) or (clean[-1], mean_square(want, converged)))
    live.view(800, 600, '-', 2)
    live.send('denoise', 'look')
    print(live.answer()[0], live.end())


def surfaces():
    live = Live('live.pov')
    head, data = live.ask(f'surfaces {W} {H} -')
    planes = numpy.frombuffer(data, numpy.uint16).reshape(4, H, W)
    for scope, plane in zip(('material', 'object', 'flat', 'level'), planes):
        for index in [k for k in numpy.unique(plane) if k]:
            one = head['surfaces'][index - 1]
            text = one['text']
            seen = [part(render('--spp', '1', '--aov', 'albedo', '-t', f'X={text}', '--replace', f'X=rgb({c})',
                                'live.pov'), 'albedo') for c in ('1,0,1', '0,1,0')]
            is_right = ((abs(seen[0] - seen[1]) > .01).any(-1) == (plane == index)).all()
            print(scope, text, one['name'], is_right, abs(one['share'] - (plane == index).mean()) < 1e-5)
    print('nothing' if (planes[0] == 0).any() else 'all')


def levels():
    """All levels that are a thousandth of the picture: more than there are of anything else. Smaller ones are none."""
    boxes = [f'box {{ <{x}.1,0,{z}.1>, <{x}.9,{.5 + .08 * (9 * z + x)},{z}.9> pigment {{ rgb .5 }} }}'
             for z in range(9) for x in range(9)]
    open('many.pov', 'w').write('camera { orthographic sky z location <4.5,20,4.5> look_at <4.5,0,4.5> up y*9 '
                                'right x*9 } light_source { 9 1 } '
                                'box { <-.02,0,-.02>, <.09,8,.09> pigment { rgb 1 } }' + ''.join(boxes))
    live = Live('many.pov')
    head, data = live.ask('surfaces 270 270 -')
    objects, found = (numpy.frombuffer(data, numpy.uint16).reshape(4, -1)[k] for k in (1, 3))
    pairs = {(o, l) for o, l in zip(objects, found) if o}
    small = min(pairs, key=lambda pair: (objects == pair[0]).sum())
    print(len(pairs), len({l for _, l in pairs}), small[1], (objects == small[0]).sum() < 270 * 270 / 1000)
    print(min((found == l).mean() for _, l in pairs if l) >= .001, live.end())


def uv():
    live = Live('-t', 'Floor', '-t', 'Box=#3:uv=box', '--unit', 'cm', 'live.pov')
    head, data = live.ask(f'uv {W} {H} -')
    pixels = W * H
    targets = numpy.frombuffer(data[:2 * pixels], numpy.uint16).reshape(H, W)
    got = numpy.frombuffer(data[2 * pixels:], numpy.float32).reshape(2, H, W)
    want = part(render('--spp', '1', '--aov', 'uv', '-t', 'Floor', '-t', 'Box=#3:uv=box', '--unit', 'cm', 'live.pov'),
                'uv')
    print(head['uv'], sorted(set(targets.flat)))
    for k, one in enumerate(head['uv']):
        mask = targets == k + 1
        print(one['target'], all(numpy.allclose(got[c][mask], want[..., c + 1][mask] * one['unit'][c], 1e-5, 1e-6)
                                 for c in (0, 1)))


def lines():
    live = Live('live.pov')
    for line in ('', 'view 3 x - 5', 'view 0 5 - 5', 'view 3 3 - 0', 'view 3 3', 'view 3 3 1,2,3 5',
                 'view 3 3 1,2,3:1,2,3 5', 'view 3 3 1,2,3:0,0,0:171 5', 'view 3 3 nan,2,3:0,0,0 5',
                 'view 99999 99999 - 5', 'look', 'x' * 5000, 'uv 1 1', 'surfaces'):
        live.send(line)
        if line:
            print(live.answer())
    print(live.view(3, 3, '-', 5)[-1][1].shape, live.is_quiet(.2))
    before = os.times()
    print(live.is_quiet(.5))
    live.send('view 640 480 - 1000000')
    live.answer()
    live.send('stop')
    start = clock()
    while not live.is_quiet(.5):
        live.answer()
    print('stopped', clock() - start < 3)
    live.send('view 640 480 - 1000000')
    live.answer()
    start = clock()
    print('followed', live.view(8, 6, '-', 1)[-1][0], clock() - start < 2)
    live.send('view 640 480 - 1000000')
    print(live.end()[0])


def endings():
    live = Live('live.pov', stderr=subprocess.DEVNULL)
    live.send('view 640 480 - 1000000')
    live.process.send_signal(signal.SIGTERM)
    print(live.process.wait(5))
    live = Live('live.pov', stderr=subprocess.PIPE)
    live.process.stdout.close()
    live.send('view 64 48 - 4')
    print(live.process.wait(5), live.process.stderr.read())


os.environ['RETEX_MAX_TIME'] = '1000'
globals()[sys.argv[1]]()
