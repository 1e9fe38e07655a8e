# What serve.t and serve_finishes.t ask of retex-serve: starts it at a port that the system chooses, runs the checks of one function of this
# file, and ends it. Prints what differs, and at last the name of the function.
import hashlib, http.client, json, os, re, select, shutil, signal, socket, struct, subprocess, sys, threading, time

sys.path.append(os.path.join(os.path.dirname(__file__), '..', 'serve'))
sys.dont_write_bytecode = True
import heads as heads_sent
from serve_ask import ask, combine, cover, ended, expect, metric, receive_all, run, send, send_all, wait_for


# ---- pictures ----

def pictures(server):
    """The same bytes as retex-combine's, of packs and sets."""
    for room, file in ('small', 'rooms/small.retex'), ('raw', 'rooms/raw.exr'):
        for edits, textures in (('', []),
                                ('Floor=oak;Wall=rgb(.2,.3,.4)/', ['--texture', 'Floor=textures/oak.jpg', '--texture',
                                                                  'Wall=rgb(.2,.3,.4)']),
                                ('Floor=oak.jpg;Floor.scale=2,3;Floor.rotate=30;Floor.wrap=mirror/',
                                 ['--texture:scale=2,3:rotate=30:wrap=mirror', 'Floor=textures/oak.jpg']),
                                ('Wall=oak;Wall.repeat=brick;Floor=oak/',
                                 ['--texture:repeat=brick', 'Wall=textures/oak.jpg', '--texture',
                                  'Floor=textures/oak.jpg'])):
            for ending, quality in ('jpg', 95), ('png', 95), ('jpg', 70), ('webp', 95):
                url = f'/v1/{room}/{edits}full.{ending}?quality={quality}'
                answer = ask(server, url)
                expect(url, answer.status, 200)
                wanted = combine('a.' + ending, file, '--quality', str(quality), *textures)
                if answer.body != wanted:
                    print(f'{url}: not the bytes of retex-combine')
    for ending, at, signature in ('jpg', 0, b'\xff\xd8'), ('png', 0, b'\x89PNG'), ('webp', 8, b'WEBP'), ('avif', 8, b'avif'):
        answer = ask(server, '/v1/small/full.' + ending)
        if answer.status != 400 or ending in json.loads(ask(server, '/v1').body)['formats']:
            expect('a file of ' + ending, answer.body[at:at + len(signature)], signature)
    expect('type by Accept', ask(server, '/v1/small/full', Accept='image/png').getheader('Content-Type'), 'image/png')
    expect('Vary', ask(server, '/v1/small/full', Accept='image/png').getheader('Vary'), 'Accept')


def parts(server):
    """A part, scaled, is the mean of the pixels it covers; mirrored and turned as it should be."""
    import numpy
    import OpenImageIO as oiio

    def read(name):
        file = oiio.ImageInput.open(name)
        pixels = numpy.array(file.read_image('uint8'), dtype=float)[:, :, :3] / 255
        file.close()
        return numpy.where(pixels <= .04045, pixels / 12.92, ((pixels + .055) / 1.055) ** 2.4)

    combine('whole.png', 'rooms/small.retex', '--texture', 'Floor=textures/oak.jpg')
    whole = read('whole.png')
    for place, size, turn in (((0, 0, 64, 48), (32, 24), '0'), ((0, 0, 64, 48), (17, 11), '0'),
                              ((5, 7, 40, 30), (40, 30), '0'), ((5, 7, 40, 30), (13, 29), '!0'),
                              ((1, 2, 60, 40), (30, 20), '90'), ((1, 2, 60, 40), (30, 20), '!270'),
                              ((0, 0, 64, 48), (64, 48), '180'), ((63, 47, 1, 1), (1, 1), '0')):
        url = '/iiif/3/small;Floor=oak/%d,%d,%d,%d/%d,%d/%s/default.png' % (*place, *size, turn)
        answer = ask(server, url)
        expect(url, answer.status, 200)
        open('part.png', 'wb').write(answer.body)
        x, y, width, height = place
        wanted = whole[y:y + height, x:x + width]
        wanted = cover(cover(wanted, size[1]).transpose(1, 0, 2), size[0]).transpose(1, 0, 2)
        wanted = wanted[:, ::-1] if turn[0] == '!' else wanted
        wanted = numpy.rot90(wanted, -int(turn.strip('!')) // 90)
        got = read('part.png')
        expect(url + ' size', got.shape, wanted.shape)
        # pictures of 8 bits differ by half a code, in the darkest codes by more in linear light
        if numpy.abs(got - wanted).max() > .008:
            print(url, 'differs by', numpy.abs(got - wanted).max())


def conditions(server):
    """Entity tags, HEAD, ranges."""
    url = '/v1/small/Floor=oak/full.jpg'
    first = ask(server, url)
    etag = first.getheader('ETag')
    expect('tag', bool(re.fullmatch('"[0-9a-f]{32}"', etag)), True)
    again = ask(server, url)
    expect('again', (again.body == first.body, again.getheader('ETag')), (True, etag))
    expect('hits', metric(server, 'cache_total{cache="hit"}'), 1)
    for match in etag, 'W/' + etag, '"x", ' + etag, '*':
        answer = ask(server, url, If_None_Match=match)
        expect('304 of ' + match, (answer.status, answer.body, answer.getheader('ETag')), (304, b'', etag))
    expect('another tag', ask(server, url, If_None_Match='"x"').status, 200)
    head = ask(server, url, 'HEAD')
    expect('HEAD', (head.status, head.body, head.getheader('Content-Length'), head.getheader('ETag')),
           (200, b'', str(len(first.body)), etag))
    for wanted, part in (('bytes=0-9', slice(0, 10)), ('bytes=100-', slice(100, None)), ('bytes=-7', slice(-7, None))):
        answer = ask(server, url, Range=wanted)
        expect(wanted, (answer.status, answer.body == first.body[part]), (206, True))
    outside = ask(server, url, Range='bytes=99999999-')
    expect('outside', (outside.status, outside.body, outside.getheader('Content-Range')),
           (416, b'', f'bytes */{len(first.body)}'))
    expect('no type of nothing', outside.getheader('Content-Type'), None)
    expect('HEAD has no ranges', ask(server, url, 'HEAD', Range='bytes=0-9').status, 200)
    expect('two ranges', ask(server, url, Range='bytes=0-1,4-5').status, 200)
    expect('If-Range', ask(server, url, Range='bytes=0-9', If_Range='"x"').status, 200)
    expect('others', len({ask(server, path).getheader('ETag') for path in (
        url, url + '?quality=80', '/v1/small/Floor=oak/full.png', '/v1/small/Floor=oak/32x24.jpg', '/v1/small/full.jpg',
        '/v1/raw/Floor=oak/full.jpg', '/v1/small/Wall=oak/full.jpg', '/v1/small/Floor=oak;Floor.scale=2/full.jpg')}), 8)
    expect('one edit in several words', len({(answer.status, answer.getheader('ETag')) for answer in (
        ask(server, f'/v1/small/{edits}/full.jpg') for edits in (
            'Wall=tan;Floor=oak;Floor.scale=2', 'Floor.scale=2,2.0;Floor=oak;Wall=%23D2B48C',
            'Floor=oak;Floor.rotate=0;Wall=Tan;Floor.scale=2e0'))}), 1)


def replaced(server):
    """A room or a texture that is replaced has another tag and another picture; a broken room does no harm."""
    url = '/v1/other/Floor=t/full.png'
    shutil.copy('rooms/small.retex', 'rooms/other.retex')
    shutil.copy('textures/oak.jpg', 'textures/t.jpg')
    before = ask(server, url)
    expect('before', before.status, 200)
    time.sleep(.2)  # files that have changed just now are not kept
    shutil.copy('textures/brick.jpg', 'textures/new'), os.rename('textures/new', 'textures/t.jpg')
    texture = ask(server, url, If_None_Match=before.getheader('ETag'))
    expect('texture', (texture.status, texture.body != before.body), (200, True))
    shutil.copy('second.retex', 'rooms/new'), os.rename('rooms/new', 'rooms/other.retex')
    room = ask(server, url, If_None_Match=texture.getheader('ETag'))
    expect('room', (room.status, room.body not in (before.body, texture.body)), (200, True))
    time.sleep(.2)
    expect('again', ask(server, url).body, room.body)
    expect('rooms that are open', metric(server, 'rooms_open'), 1)
    with open(f'/proc/{server.pid}/stat') as stat, open(f'/proc/{server.pid}/statm') as statm:
        used = sum(map(int, stat.read().rsplit(')', 1)[1].split()[11:13])) / os.sysconf('SC_CLK_TCK')
        resident = int(statm.read().split()[1]) * os.sysconf('SC_PAGESIZE')
    expect('processor time', max(used, 1e-3) <= metric(server, 'processor_seconds_total') <= used + .3, True)
    expect('memory', abs(metric(server, 'resident_bytes') / resident - 1) < .2, True)
    open('rooms/new', 'wb').write(open('second.retex', 'rb').read()[:5000]), os.rename('rooms/new', 'rooms/other.retex')
    broken = ask(server, url)
    expect('broken', (broken.status, b'rooms/' in broken.body), (500, False))
    expect('the others', ask(server, '/v1/small/full.png').status, 200)
    open('textures/t.jpg', 'w').write('no picture')
    expect('broken texture', ask(server, '/v1/small/Floor=t/full.png').status, 500)
    os.remove('rooms/other.retex'), os.remove('textures/t.jpg')
    expect('gone', ask(server, url).status, 404)


def folders(server):
    """A folder is the texture that it holds, unless there is a file of that name."""
    os.makedirs('textures/wood/textures'), os.makedirs('textures/empty'), os.makedirs('out')
    shutil.copy('textures/brick.jpg', 'textures/wood/textures/wood_diff_2k.jpg')
    shutil.copy('textures/brick.jpg', 'out/color.jpg'), os.symlink('../out', 'textures/away')
    shutil.copy('textures/oak.jpg', 'textures/wood/wood_rough_2k.jpg')
    url = '/v1/small/Floor={}/full.png'
    expect('folder', ask(server, url.format('wood')).body, ask(server, url.format('brick')).body)
    expect('listed', [name for name in json.loads(ask(server, '/v1').body)['textures'] if '.' not in name], ['wood'])
    expect('empty', [ask(server, url.format(name)).status for name in ('empty', 'away')], [404, 404])
    time.sleep(.2)
    shutil.copy('textures/oak.jpg', 'textures/wood/wood_diff_4k.jpg')
    expect('larger', ask(server, url.format('wood')).body, ask(server, url.format('oak')).body)
    shutil.copy('textures/brick.jpg', 'textures/wood.jpg')
    expect('file', ask(server, url.format('wood')).body, ask(server, url.format('brick')).body)
    os.remove('textures/wood.jpg'), os.remove('textures/away')
    for folder in 'textures/wood', 'textures/empty', 'out':
        shutil.rmtree(folder)


def bmp(color, width=8):
    pixels = (bytes(color) * width + bytes(-3 * width % 4)) * 8
    head = struct.pack('<IHHIIiiHHIIiiII', 54 + len(pixels), 0, 0, 54, 40, width, 8, 1, 24, 0, len(pixels), 0, 0, 0, 0)
    return b'BM' + head + pixels


def contents(server):
    """Entity tags are of what files hold, whatever their size and time, and also where names change all the time."""
    pictures = {}
    for name, color in ('red', (0, 0, 255)), ('blue', (255, 0, 0)):
        open(name, 'wb').write(bmp(color))
        os.utime(name, (1, 1))
        shutil.copy2(name, 'textures/new'), os.rename('textures/new', 'textures/t.bmp')
        pictures[name] = ask(server, '/v1/small/Floor=t/full.png')
    red, blue = pictures['red'], pictures['blue']
    expect('another tag', red.getheader('ETag') != blue.getheader('ETag') and red.body != blue.body, True)
    for tag, status in (red, 200), (blue, 304):
        expect('a known tag', ask(server, '/v1/small/Floor=t/full.png', If_None_Match=tag.getheader('ETag')).status, status)
    # two files take turns by a link, so that identities come back
    time.sleep(.2)
    os.remove('textures/t.bmp')
    shutil.copy('red', 'textures/a.dat'), shutil.copy('blue', 'textures/b.dat')
    os.symlink('a.dat', 'textures/t.bmp')
    is_over = threading.Event()

    def take_turns():
        for turn in range(10**9):
            if is_over.is_set():
                break
            os.symlink('ab'[turn % 2] + '.dat', 'textures/next'), os.rename('textures/next', 'textures/t.bmp')
            time.sleep(.0005)
    turns = threading.Thread(target=take_turns)
    turns.start()
    bodies = {}
    until = time.monotonic() + 3
    while time.monotonic() < until:
        for quality in range(1, 101, 4):
            paths = [f'/v1/small/Floor=t/full.png?quality={quality}'] * 4
            for answer in receive_all(send_all(server, paths)):
                expect('while names change', answer.status, 200)
                bodies.setdefault(answer.getheader('ETag'), set()).add(answer.body)
    is_over.set(), turns.join()
    expect('one body a tag', {len(of_tag) for of_tag in bodies.values()}, {1})
    for name, file in ('red', 'a.dat'), ('blue', 'b.dat'):
        os.remove('textures/t.bmp'), os.symlink(file, 'textures/t.bmp')
        expect('afterwards ' + name, {ask(server, f'/v1/small/Floor=t/full.png?quality={quality}').body
                                      for quality in range(1, 101, 4)}, {pictures[name].body})
    [os.remove('textures/' + name) for name in ('t.bmp', 'a.dat', 'b.dat')]


def refused(server):
    """What cannot be is refused, with a reason and without a trace of the server's files."""
    os.symlink('/etc/hostname', 'textures/link.png')
    os.symlink(os.path.abspath('outside.jpg'), 'textures/outside.jpg')
    for path, status in (('/', 404), ('/v2', 404), ('/v1/none/full.jpg', 404), ('/v1/small/Floor=none/full.jpg', 404),
                         ('/v1/small/Flor=oak/full.jpg', 404), ('/v1/small/65x48.jpg', 400),
                         ('/v1/small/full.jpg?crop=60,0,9,9', 200), ('/v1/small/full.jpg?crop=64,0,9,9', 400),
                         ('/v1/small/Floor=..%2Foutside/full.jpg', 400), ('/v1/small/Floor=outside/full.jpg', 404),
                         ('/v1/small/Floor=link/full.jpg', 404), ('/v1/..%2Frooms%2Fsmall/full.jpg', 400),
                         ('/v1/small/full.gif', 400), ('/v1/small/Floor=oak;Floor.width=2/full.jpg', 400),
                         ('/iiif/3/small/full/^999,/0/default.jpg', 501), ('/v1/' + 9000 * 'x', 414)):
        answer = ask(server, path)
        expect(path[:60], answer.status, status)
        if os.getcwd().encode() in answer.body:
            print(path, 'tells of a folder:', answer.body)
    for path, hint in (
            ('/v1/none', "there is no room 'none'; /v1 lists them"),
            ('/v1/small/Wall=oak;Floor.zoom=2/full.jpg', "Floor.zoom: there is no texture '2'; /v1 lists them"),
            ('/v1/small/Wall=rde/full.jpg', "Wall: there is no texture 'rde'; /v1 lists them; is red meant?"),
            ('/v1/small/Wall=%23ff88/full.jpg', "colour '#ff88': expected #rgb or #rrggbb with hexadecimal digits"),
            ('/v1/small/full.gif', 'pictures are not written as .gif; /v1 lists the formats'),
            ('/v1/small/', 'a part of the path is empty: there are two slashes, or one at its end'),
            ('/iiif/2/small/info.json', 'of IIIF there is version 3 of the Image API: /iiif/3/ID/info.json')):
        expect(path, ask(server, path).body.decode(), hint + '\n')
    expect('POST', (ask(server, '/v1/small/full.jpg', 'POST').status), 405)
    for path, methods in ('/v1', 'GET, HEAD'), ('/v1/uploads', 'POST, OPTIONS'):
        expect('Allow', ask(server, path, 'DELETE').getheader('Allow'), methods)
    for text in b'GET\r\n\r\n', b'\x16\x03\x01\x02\x00\x01\x00\x01', b'GET / HTTP/9.9\r\n\r\n', b'\r\n' * 9 + b'\0\0':
        with socket.create_connection(('127.0.0.1', server.port), 10) as plain:
            plain.sendall(text), plain.shutdown(socket.SHUT_WR)
            got = plain.recv(100)
            if got and not got.startswith(b'HTTP/1.1 4') and not got.startswith(b'HTTP/1.1 5'):
                print(text, got)
    expect('afterwards', ask(server, '/health').body, b'ok\n')
    os.remove('textures/link.png'), os.remove('textures/outside.jpg')


def heads(server):
    """Requests that two programs may read differently are refused, and their connections are closed."""
    for fault in heads_sent.faults(server.port):
        print(fault)


def iiif_answers(server, source='127.0.0.1', **headers):
    """What the answers of IIIF say of the server's address."""
    return [json.loads(ask(server, '/iiif/3/small/info.json', source=source, **headers).body)['id'],
            ask(server, '/iiif/3/small', source=source, **headers).getheader('Location'),
            ask(server, '/iiif/3/small/full/max/0/default.png', source=source, **headers).getheader('Link').split(';')[0]]


def addresses(base):
    return [base + '/iiif/3/small', base + '/iiif/3/small/info.json', f'<{base}/iiif/3/small/full/max/0/default.png>']


TOLD = {'Host': 'pictures.example', 'X_Forwarded_Proto': 'https', 'X_Forwarded_Host': 'other.example'}


def shared(server):
    """What a client tells of the server stands in no answer, which a shared cache would give to others."""
    expect('ids', iiif_answers(server, **TOLD), addresses(f'http://127.0.0.1:{server.port}'))
    expect('afterwards', iiif_answers(server), addresses(f'http://127.0.0.1:{server.port}'))


def proxied(server):
    """A proxy that is trusted tells where the server is, and who asks: its clients have limits, and itself none."""
    expect('ids', iiif_answers(server, **TOLD), addresses('https://pictures.example'))
    expect('of another', iiif_answers(server, '127.0.0.2', **TOLD), addresses(f'http://127.0.0.1:{server.port}'))
    own = [begin_upload(server), begin_upload(server)]  # each expects to go on
    [connection.close() for connection in own]
    idle = [socket.create_connection(('127.0.0.1', server.port), 10) for _ in range(20)]
    image = open('outside.jpg', 'rb').read()
    expect('an upload', send(server, image).status in (200, 201), True)
    waiting = begin_upload(server, X_Forwarded_For='127.0.0.2, 192.0.2.1')
    for who, status in (('192.0.2.1', 429), ('192.0.2.2, 192.0.2.1', 429), ('192.0.2.1, 127.0.0.1', 429),
                        ('192.0.2.1:99', 429), ('192.0.2.1, 192.0.2.2', 200), ('2001:db8::1', 200), ('x', 200), ('', 200)):
        expect(who, send(server, image, X_Forwarded_For=who).status, status)
    unknown = begin_upload(server, X_Forwarded_For='unknown')  # whom a proxy does not know is one client
    expect('unknown', [send(server, image, X_Forwarded_For=who).status for who in
                       ('unknown', 'fe80::1%eth0', '', '192.0.2.1,', '192.0.2.7')], [429, 429, 429, 429, 200])
    unknown.close()
    network = begin_upload(server, X_Forwarded_For='2001:db8:1:2::1')
    expect('its network', [send(server, image, X_Forwarded_For=who).status for who in
                           ('2001:db8:1:2:ffff::', '2001:db8:1:3::1')], [429, 200])
    expect('of another', send(server, image, source='127.0.0.3', X_Forwarded_For='192.0.2.1').status, 200)
    expect('a picture', ask(server, '/v1/small/full.png', X_Forwarded_For='192.0.2.1').status, 200)
    waiting.close(), network.close()
    expect('afterwards', wait_for(lambda: send(server, image, X_Forwarded_For='192.0.2.1').status == 200), True)
    crowd = send_all(server, [f'/v1/raw/Floor=rgb(0,0,.{n})/full.png' for n in range(100, 160)],
                     'X-Forwarded-For: 192.0.2.1\r\n')
    expect('beside a crowd', ask(server, '/v1/small', X_Forwarded_For='192.0.2.2').status, 200)
    statuses = [answer.status for answer in receive_all(crowd)]
    expect('too many at once', (set(statuses), statuses.count(200) >= 8), ({200, 429}, True))
    [connection.close() for connection in idle]
    expect('log', {json.loads(line)['client'] for line in open('log')} >= {'127.0.0.1', '127.0.0.3', '192.0.2.1',
                                                                           '2001:db8::1'}, True)


def clients(server):
    """Who has as many connections, or uploads on their way, as one client may have shuts nobody else out."""
    idle = [socket.create_connection(('127.0.0.1', server.port), 10) for _ in range(30)]
    closed = lambda: len(select.select(idle, [], [], 0)[0])
    expect('too many are closed', wait_for(lambda: closed() == 14) or closed(), True)
    expect('another one', ask(server, '/v1/small/full.png', source='127.0.0.2').status, 200)
    [connection.close() for connection in idle]
    expect('afterwards', wait_for(lambda: can_ask(server, '/health')), True)
    for _ in range(40):  # who leaves in the middle of a request
        with socket.create_connection(('127.0.0.1', server.port), 10, ('127.0.0.3', 0)) as plain:
            plain.sendall(b'GET /v1')
        time.sleep(.01)
    expect('after those who left', wait_for(lambda: can_ask(server, '/health', '127.0.0.3'), 5), True)
    image = open('outside.jpg', 'rb').read()
    slow = [begin_upload(server) for _ in range(2)]
    third = send(server, image)
    expect('too many uploads', (third.status, third.getheader('Retry-After')), (429, '2'))
    expect('an upload of another one', send(server, image, source='127.0.0.2').status in (200, 201), True)
    expect('a picture', ask(server, '/v1/small/full.png').status, 200)
    [connection.close() for connection in slow]
    expect('uploads afterwards', wait_for(lambda: send(server, image).status == 200), True)


def crawling(server):
    """A body that comes by fewer bytes a second than it must is given up; one that comes by more is not."""
    slow, fair = begin_upload(server), begin_upload(server)
    began = time.time()
    while time.time() - began < 20 and not select.select([slow], [], [], .5)[0]:
        try:
            slow.sendall(bytes(100)), fair.sendall(bytes(2000))
        except OSError:
            break
    expect('cut off', 9 < time.time() - began < 15 and ended(slow), True)
    expect('in time', select.select([fair], [], [], 0)[0], [])


def lists(server):
    """What there is."""
    site = json.loads(ask(server, '/v1').body)
    expect('site', (site['rooms'], site['textures']), (['raw', 'small'], ['brick.jpg', 'oak.jpg']))
    room = json.loads(ask(server, '/v1/small').body)
    expect('room', (room['width'], room['height'], [target['name'] for target in room['targets']]),
           (64, 48, ['Floor', 'Wall']))
    info = ask(server, '/iiif/3/small%3BFloor=oak/info.json')
    expect('info', json.loads(info.body)['id'], f'http://127.0.0.1:{server.port}/iiif/3/small;Floor=oak')
    expect('base', ask(server, '/iiif/3/small').status, 303)
    expect('thumbnail', ask(server, '/v1/small/thumbnail').status, 200)


def metrics(server):
    """The text format of Prometheus: every line is one, every name has its type, and the numbers are those of what was
    asked for."""
    for path in '/v1', '/v1/small/full.jpg', '/v1/small/full.jpg', '/v1/none/full.jpg', '/nothing':
        ask(server, path)
    types, values = {}, {}
    for line in ask(server, '/metrics').body.decode().splitlines():
        head = re.fullmatch(r'# (HELP|TYPE) ([a-z_]+) (.+)', line)
        value = re.fullmatch(r'([a-z_]+)(\{[a-z]+="[^"]*"(?:,[a-z]+="[^"]*")*\})? ([-+0-9.e]+)', line)
        if head and head[1] == 'TYPE':
            types[head[2]] = head[3]
        elif value:
            values[value[1] + (value[2] or '')] = float(value[3])
            if re.sub('_(bucket|sum|count)$', '', value[1]) not in types and value[1] not in types:
                print('no type:', line)
        elif not head:
            print('no metric:', line)
    name = 'retex_serve_requests_total{route="%s",status="%d"}'
    expect('requests', [values.get(name % row) for row in (('rooms', 200), ('picture', 200), ('picture', 404),
                                                           ('none', 404))], [1, 2, 1, 1])
    buckets = [value for key, value in values.items() if key.startswith('retex_serve_request_seconds_bucket')]
    expect('histogram', (buckets == sorted(buckets), buckets[-1], values['retex_serve_request_seconds_count']),
           (True, 5, 5))
    expect('caches', [values['retex_serve_cache_total{cache="%s"}' % use] for use in ('hit', 'joined')], [1, 0])
    expect('memory', values['retex_serve_resident_bytes'] > 1e6 and values['retex_serve_rooms_bytes'] > 1e5, True)


def documented(server):
    """The man page names what the server prints: every key of its JSON, every metric and status."""
    page = open(os.environ['SCENES'] + '/../man/retex-serve.1').read()
    named = {name for line in re.findall(r'^\.(?:It )?Cm (.*)$', page, re.M) for name in re.split('[ ,.]+', line)}
    room, image = json.loads(ask(server, '/v1/small').body), open('outside.jpg', 'rb').read()
    printed = {*json.loads(ask(server, '/v1').body), *room, *room['targets'][0], *json.loads(send(server, image).body)}
    printed |= set(re.findall(r'^# TYPE retex_serve_(\w+)', ask(server, '/metrics').body.decode(), re.M))
    printed |= {key for line in open('log') for key in (*json.loads(line), json.loads(line)['cache'])}
    expect('not in the man page', sorted(printed - named), [])


# ---- uploads ----

def begin_upload(server, **headers):
    """Sends the beginning of an image, and returns its socket when the server has it."""
    client = socket.create_connection(('127.0.0.1', server.port), 60)
    head = ''.join(f'{name.replace("_", "-")}: {value}\r\n' for name, value in headers.items())
    client.sendall(f'POST /v1/uploads HTTP/1.1\r\nHost: a\r\nContent-Length: 900000\r\n'
                   f'Expect: 100-continue\r\n{head}\r\n'.encode())
    expect('continue', client.recv(100), b'HTTP/1.1 100 Continue\r\n\r\n')
    client.sendall(b'\xff\xd8')
    return client


def can_ask(server, path, source='127.0.0.1'):
    try:
        return ask(server, path, source=source).status == 200
    except OSError:
        return False


def uploads(server):
    """An image that is sent is a texture, by the hash of its content."""
    image = open('outside.jpg', 'rb').read()
    name = hashlib.sha256(image).hexdigest() + '.jpg'
    expect('gone at the start', os.path.exists('uploads/.incoming-9.jpg'), False)
    expect('before', ask(server, f'/v1/small/Floor={name}/full.png').status, 404)
    answer = send(server, image, Content_Type='image/jpeg')
    told = json.loads(answer.body)
    expect('new', (answer.status, told['texture'], told['bytes'], answer.getheader('Cache-Control')),
           (201, name, len(image), 'no-store'))
    expect('time', re.fullmatch(r'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ', told['expires']) is not None, True)
    wanted = ask(server, '/v1/small/Floor=oak/full.png').body
    for given in name, name[:64]:
        expect('as a texture', ask(server, f'/v1/small/Floor={given}/full.png').body == wanted, True)
    expect('files', os.listdir('uploads'), [name])
    expect('again', send(server, (image[at:at + 7000] for at in range(0, len(image), 7000))).status, 200)  # in chunks
    expect('list', json.loads(ask(server, '/v1').body)['textures'], ['brick.jpg', 'oak.jpg'])
    expect('count', (metric(server, 'uploads'), metric(server, 'uploads_bytes')), (1, len(image)))
    for what, body, status in (
            ('no image', b'not an image', 415), ('nothing', b'', 415), ('half', image[:len(image) // 2], 415),
            ('a signature only', image[:10], 415), ('HTML', b'<html><script>', 415),
            ('a signature of another', b'\x89PNG\r\n\x1a\n' + image, 415), ('too large', bytes(1 << 20) + b'x', 413),
            ('too large, in chunks', (bytes(1 << 16) for _ in range(20)), 413),
            ('too many pixels', open('wide.png', 'rb').read(), 413)):
        expect(what, send(server, body).status, status)
    expect('length', send(server, b'', Content_Length='99999999999').status, 413)
    expect('elsewhere', send(server, image, '/v1/small').status, 405)
    expect('another method', send(server, image, method='PUT').status, 405)
    expect('asked before', (send(server, b'', method='OPTIONS').status, ask(server, '/v1', 'OPTIONS').status), (204, 405))
    with socket.create_connection(('127.0.0.1', server.port), 10) as plain:  # who leaves in the middle
        plain.sendall(b'POST /v1/uploads HTTP/1.1\r\nHost: x\r\nContent-Length: 9999\r\n\r\n' + image[:5000])
    expect('files', os.listdir('uploads'), [name])
    expect('second', send(server, open('textures/brick.jpg', 'rb').read()).status, 201)
    expect('full', send(server, open('third.png', 'rb').read()).status, 507)
    expect('one that is there', send(server, image).status, 200)
    open('uploads/mine.txt', 'w').write('not an upload')
    os.utime('uploads/' + name, (1, 1))
    for _ in range(200):
        if metric(server, 'uploads') == 1:
            break
        time.sleep(.1)
    expect('old ones go, other files stay', (os.path.exists('uploads/' + name), os.path.exists('uploads/mine.txt')),
           (False, True))
    expect('gone', ask(server, f'/v1/small/Floor={name}/full.png?quality=90').status, 404)
    subprocess.run(['retex-combine', '-q', 'rooms/small.retex', '-o', 'small.webp'], check=True)
    answer = send(server, open('small.webp', 'rb').read())
    expect('place, and a WebP', (answer.status, json.loads(answer.body)['texture'].endswith('.webp')), (201, True))
    expect('files', sum(file.startswith('.') for file in os.listdir('uploads')), 0)


def decoders(server):
    """Images that take too much are refused; meanwhile pictures of the server's own textures are made."""
    bombs = {name: open(name, 'rb').read() for name in ('tile.tif', 'channels.tif', 'scans.jpg', 'long.png')}
    for name in list(bombs)[:3]:
        expect(name, send(server, bombs[name]).status, 413)
    refused = []
    threads = [threading.Thread(target=lambda n=n: refused.append(send(server, bombs['long.png'] + bytes([n])).status))
               for n in range(3)]
    [thread.start() for thread in threads]
    expect('decoding', wait_for(lambda: metric(server, 'decoding')), True)
    pictures = [ask(server, f'/v1/small/Floor=oak/64x.png?Floor.scale=1,{n}').status for n in range(1, 6)]
    expect('meanwhile', (pictures, len(refused)), (5 * [200], 0))
    [thread.join() for thread in threads]
    expect('too long', refused, 3 * [413])
    expect('files', os.listdir('strange'), [])
    name = 64 * 'a' + '.png'  # which decoded quicker when it was sent
    shutil.copy('long.png', 'strange/' + name)
    slow = threading.Thread(target=lambda: refused.append(ask(server, f'/v1/small/Floor={name}/64x.png').status))
    slow.start()
    expect('decoding', wait_for(lambda: metric(server, 'decoding')), True)
    pictures = [ask(server, f'/v1/small/Floor=oak/64x.png?Floor.scale=2,{n}').status for n in range(1, 6)]
    expect('meanwhile', (pictures, len(refused)), (5 * [200], 3))
    slow.join()
    expect('in a picture', refused[3], 503)
    os.remove('strange/' + name)


def hurried(server):
    """The deadline of a request is that of its decoder."""
    began = time.time()
    expect('deadline', send(server, open('long.png', 'rb').read()).status, 503)
    expect('held', time.time() - began < 4, True)
    expect('lives', ask(server, '/v1/small/64x.png').status, 200)


def off(server):
    """Nobody can upload where that was not allowed."""
    expect('off', send(server, open('outside.jpg', 'rb').read()).status, 403)
    expect('body', send(server, b'x' * 10, '/v1/small/full.jpg', 'GET').status, 413)


def finishes(server):
    """Maps of finishes: pictures are retex-combine's, of two sets whose finishes differ, which share images."""
    def check(room, edits, *textures):
        answer = ask(server, f'/v1/{room}/{edits}/full.png')
        expect(edits, answer.status, 200)
        if answer.body != combine('a.png', f'rooms/{room}.retex', *textures, told=subprocess.DEVNULL):
            print(f'{room} {edits}: not the bytes of retex-combine')
        return answer

    plain, folder, wall = '--texture', ['--texture', 'Floor=textures/wood'], ['--texture', 'Wall=textures/oak.jpg']
    gloss, none = '--texture:finish=textures/gloss.png', '--texture:finish=none'
    for round in 1, 2:
        for room in 'three', 'two', 'three':
            with_map = check(room, 'Floor=oak;Floor.finish=gloss', gloss, 'Floor=textures/oak.jpg')
            check(room, 'Floor=oak;Floor.finish=gloss.png;Floor.scale=2;Wall=oak', gloss + ':scale=2',
                  'Floor=textures/oak.jpg', *wall)
            check(room, 'Floor=rgb(.1,.5,.3);Floor.finish=gloss', gloss, 'Floor=rgb(.1,.5,.3)')
            without = check(room, 'Floor=oak;Wall=oak', plain, 'Floor=textures/oak.jpg', *wall)
            check(room, 'Floor=oak;Floor.finish=none', none, 'Floor=textures/oak.jpg')
            rough = check(room, 'Floor=wood', *folder)
            smooth = check(room, 'Floor=wood;Floor.finish=none', none, 'Floor=textures/wood')
            check(room, 'Wall=wood', plain, 'Wall=textures/wood')
            expect('maps matter', (rough.body != smooth.body, with_map.body != without.body), (True, True))
    query = ask(server, '/v1/three/Floor=oak/full.png?Floor.finish=gloss')
    expect('in a query', (query.status, query.body), (200, combine('a.png', 'rooms/three.retex', gloss,
                                                                   'Floor=textures/oak.jpg')))
    expect('in IIIF', ask(server, '/iiif/3/three;Floor=oak;Floor.finish=gloss/full/max/0/default.png').body, query.body)
    # oak with the map for each room, without it for each room's wall and finish=none; the folder likewise
    expect('images', metric(server, 'images_read_total') < 14, True)
    for edits, status, reason in (
            ('Floor=oak;Floor.finish=none.png', 404, "Floor.finish: there is no texture 'none.png'; /v1 lists them"),
            ('Floor=oak;Floor.finish=wood', 404, "Floor.finish: there is no texture 'wood'; /v1 lists them"),
            ('Floor=rgb(1,0,0);Floor.finish=wood', 404, "Floor.finish: there is no texture 'wood'; /v1 lists them"),
            ('Floor=no;Floor.finish=gloss', 404, "Floor: there is no texture 'no'; /v1 lists them"),
            ('Floor=oak;Floor.finish=..gloss.png', 400, '`..gloss.png` cannot be the name of a texture'),
            ('Floor=oak;Floor.finish=..%2Fgloss.png', 400, 'the path is not well formed; expected UTF-8, '
             'percent-encoded, without ..'),
            ('Wall=oak;Wall.finish=gloss', 400, 'Wall has no finishes to choose from: finish= cannot be used on it; '
             'render the set with --finish Wall=NAME,NAME'),
            ('Wall=tan;Wall.finish=gloss', 400, 'Wall has no finishes to choose from: finish= cannot be used on it; '
             'render the set with --finish Wall=NAME,NAME'),
            ('Nil=oak;Nil.finish=gloss', 404, None)):
        answer = ask(server, f'/v1/three/{edits}/full.png')
        expect(edits, (answer.status, reason and answer.body.decode()), (status, reason and reason + '\n'))
    expect('none on a wall', ask(server, '/v1/three/Wall=oak;Wall.finish=none/full.png').status, 200)


def laid(server):
    """Adjusted, laid and layered textures: pictures are retex-combine's, also of images that are in memory."""
    oak, bodies = 'textures/oak.jpg', set()
    for round in 1, 2:
        for edits, *textures in (
                ('Floor=oak;Floor.hue=40', '--texture:hue=40', 'Floor=' + oak),
                ('Floor=oak;Floor.hue=80', '--texture:hue=80', 'Floor=' + oak),
                ('Floor=oak;Floor.width=.5;Floor.grout=.02', '--texture:width=.5:grout=.02', 'Floor=' + oak),
                ('Floor=oak;Floor.width=.6;Floor.grout=.02', '--texture:width=.6:grout=.02', 'Floor=' + oak),
                ('Floor=tan;Floor.width=.5;Floor.grout=.05', '--texture:width=.5:grout=.05', 'Floor=tan'),
                ('Floor=oak;Floor.vary=flip;Floor.tiles=gloss', '--texture:vary=flip:tiles=textures/gloss.png',
                 'Floor=' + oak),
                ('over:Floor=gloss;over:Floor.scale=.5', '--texture:over:scale=.5', 'Floor=textures/gloss.png'),
                ('Floor=oak;over:Floor=gloss;over:Floor.scale=.5', '--texture', 'Floor=' + oak,
                 '--texture:over:scale=.5', 'Floor=textures/gloss.png'),
                ('Floor=oak;over:Floor=gloss;over:Floor.scale=.7', '--texture', 'Floor=' + oak,
                 '--texture:over:scale=.7', 'Floor=textures/gloss.png')):
            answer = ask(server, f'/v1/two/{edits}/full.png')
            expect(edits, answer.status, 200)
            if answer.body != combine('a.png', 'rooms/two.retex', *textures, told=subprocess.DEVNULL):
                print(f'{edits}: not the bytes of retex-combine')
            bodies.add(answer.body)
    expect('different pictures', len(bodies), 9)
    for edits, name in ('Floor=oak;Floor.tiles=none', 'Floor.tiles'), ('over:Floor=none', 'over:Floor'):
        answer = ask(server, f'/v1/two/{edits}/full.png')
        expect(edits, (answer.status, answer.body.decode()),
               (404, f"{name}: there is no texture 'none'; /v1 lists them\n"))


def developed(server):
    """Exposure, white balance and views: pictures are retex-combine's; parts and tiles fit each other."""
    oak, tags = ['--texture', 'Floor=textures/oak.jpg'], set()
    for round in 1, 2:
        for query, *options in (
                ('', ), ('exposure=.5', '--exposure', '.5'), ('white-balance=4000', '--white-balance', '4000'),
                ('auto-exposure=yes', '--auto-exposure'), ('view=Filmic', '--view', 'Filmic'),
                ('exposure=-1&white-balance=9000&auto-exposure=yes&view=neutral', '--exposure', '-1', '--white-balance',
                 '9000', '--auto-exposure', '--view', 'neutral')):
            answer = ask(server, f'/v1/raw/Floor=oak/full.png?{query}')
            expect(query, answer.status, 200)
            if answer.body != combine('a.png', 'rooms/raw.exr', *oak, *options):
                print(f'{query}: not the bytes of retex-combine')
            said = ''.join(';picture:' + key for key in query.split('&') if key)
            for path in f'/v1/raw/Floor=oak{said}/full.png', f'/iiif/3/raw;Floor=oak{said}/full/max/0/default.png':
                expect(path, ask(server, path).body == answer.body, True)
            tags.add(answer.getheader('ETag'))
    expect('tags', len(tags), 6)
    query = 'exposure=1&white-balance=3000&auto-exposure=yes&view=Filmic'
    whole = ask(server, f'/v1/raw/full.png?{query}').body
    open('whole.png', 'wb').write(whole)
    open('part.png', 'wb').write(ask(server, f'/v1/raw/full.png?crop=9,5,20,30&{query}').body)
    subprocess.run('oiiotool whole.png --cut 20x30+9+5 -o cut.png; retex-diff -q part.png cut.png --fail-psnr 100',
                   shell=True, check=True)
    said = 'picture:auto-exposure=yes;picture:white-balance=2000'
    gray = ask(server, f'/iiif/3/raw;{said}/full/max/0/gray.png').body
    open('gray.png', 'wb').write(gray)
    channels = subprocess.run(['oiiotool', '--stats', 'gray.png'], capture_output=True, text=True).stdout
    expect('grey', len(set(re.search('Stats Avg: ([^(]*)', channels)[1].split())), 1)
    for query, status, reason in (
            ('exposure=31', 400, "exposure '31': expected stops, -30 to 30, as in 0.5"),
            ('auto-exposure=1', 400, "auto-exposure '1': expected yes or no"),
            ('exposure=1&exposure=1', 400, 'picture:exposure is given twice'),
            ('exposure=1&picture:exposure=1', 400, 'picture:exposure is given twice'),
            ('view=None', 404, "display sRGB has no view 'None'; there are Standard, Filmic, Neutral, Raw")):
        answer = ask(server, '/v1/raw/full.png?' + query)
        expect(query, (answer.status, answer.body.decode()), (status, reason + '\n'))


def presets(server):
    """Presets: what retex-combine writes, by name. What a URL says goes before them."""
    expect('list', json.loads(ask(server, '/v1').body)['presets'], ['broken', 'gone', 'outside', 'warm'])
    warm = combine('a.png', 'rooms/raw.exr', '--preset', 'presets/warm.json')
    for round in 1, 2:
        answer = ask(server, '/v1/raw/full.png?preset=warm')
        expect('a preset', (answer.status, answer.body == warm), (200, True))
    said = '/v1/raw/Floor=oak;Floor.rotate=30;Wall=tan;picture:exposure=.5;picture:view=Filmic/full.png'
    expect('the same edit', ask(server, said).body == warm, True)
    own = combine('a.png', 'rooms/raw.exr', '--preset', 'presets/warm.json', '--texture', 'Floor=red', '--exposure', '0')
    expect('more', ask(server, '/v1/raw/floor=red/full.png?exposure=0&preset=warm').body == own, True)
    for path, status, reason in (
            ('/v1/raw/full.png?preset=cold', 404, "there is no preset 'cold'; /v1 lists them"),
            ('/v1/raw/full.png?preset=outside', 404, "there is no preset 'outside'; /v1 lists them"),
            ('/v1/raw/full.png?preset=broken', 500, "the preset 'broken' cannot be used: not a preset, which is JSON"),
            ('/v1/raw/full.png?preset=gone', 404, "Floor: there is no texture 'gone.jpg'; /v1 lists them"),
            ('/v1/raw/full.png?preset=..%2Fother', 400, None), ('/v1/raw/full.png?preset=.x', 400, None),
            ('/v1/raw/full.png?preset=warm&preset=warm', 400, None), ('/v1/raw?preset=warm', 400, None)):
        answer = ask(server, path)
        expect(path, (answer.status, answer.body.decode()), (status, reason + '\n' if reason else answer.body.decode()))
    text = open('presets/warm.json').read()
    open('presets/new', 'w').write(text.replace('0.5', '1.5'))
    os.replace('presets/new', 'presets/warm.json')
    changed = ask(server, '/v1/raw/full.png?preset=warm')
    expect('after a change', changed.body == combine('a.png', 'rooms/raw.exr', '--preset', 'presets/warm.json'), True)


def normals(server):
    """Normal maps: pictures are retex-combine's; images in memory are shared only by textures that are turned alike."""
    def check(edits, *textures, room='walls'):
        answer = ask(server, f'/v1/{room}/{edits}/full.png')
        expect(edits, answer.status, 200)
        if answer.body != combine('a.png', f'rooms/{room}.retex', *textures, told=subprocess.DEVNULL):
            print(f'{room} {edits}: not the bytes of retex-combine')
        return answer

    oak, tiles, gloss = 'Wall=textures/oak.jpg', 'Wall=textures/tiles', '--texture:normal=textures/gloss.png'
    for round in 1, 2:
        up = check('Wall=oak;Wall.normal=gloss', gloss, oak)
        turned = check('Wall=oak;Wall.normal=gloss;Wall.rotate=90', gloss + ':rotate=90', oak)
        check('Wall=oak;Wall.normal=gloss;Wall.flip=u', gloss + ':flip=u', oak)
        check('Wall=oak;Wall.normal=gloss;Wall.scale=-2,2', gloss + ':scale=-2,2', oak)
        check('Wall=oak;Wall.normal=gloss;Wall.scale=2', gloss + ':scale=2', oak)
        down = check('Wall=oak;Wall.normal=gloss,dx', gloss + ',dx', oak)
        check('Wall=tan;Wall.normal=gloss', gloss, 'Wall=tan')
        plain = check('Wall=oak', '--texture', oak)
        folder = check('Wall=tiles', '--texture', tiles)
        check('Wall=tiles;Wall.normal=none', '--texture:normal=none', tiles)
        check('Wall=tiles', '--texture', tiles, room='three')
        expect('maps matter', len({a.body for a in (up, turned, down, plain)}), 4)
        expect('of a folder', folder.body == up.body, True)
    for edits, status, reason in (
            ('Wall=oak;Wall.normal=wood', 404, "Wall.normal: there is no texture 'wood'; /v1 lists them"),
            ('Wall=oak;Wall.finish=gloss', 400, 'Wall has no finishes to choose from: finish= cannot be used on it; '
             'render the set with --finish Wall=NAME,NAME'),
            ('Floor=oak;Floor.normal=gloss', 400, 'Floor takes no normal maps: normal= cannot be used on it; '
             'render the set with --finish Floor=normals')):
        answer = ask(server, f'/v1/walls/{edits}/full.png')
        expect(edits, (answer.status, answer.body.decode()), (status, reason + '\n'))
    expect('the room tells', b'"normal_tilt": 15' in ask(server, '/v1/walls').body, True)


def new_maps(server):
    """A map that is replaced changes tags and pictures where it is read, and nowhere else."""
    cases = {'Floor=oak;Floor.finish=gloss': 'gloss.png', 'Floor=tan;Floor.finish=gloss': 'gloss.png',
             'Floor=wood': 'wood/wood_rough.png'}
    urls = [f'/v1/three/{edits}/full.png' for edits in (*cases, 'Wall=wood', 'Wall=wood;Wall.finish=none')]
    before = {url: ask(server, url) for url in urls}
    expect('before', {answer.status for answer in before.values()}, {200})
    for url in urls:
        hits = metric(server, 'cache_total{cache="hit"}')
        expect('the tag of ' + url, ask(server, url).getheader('ETag'), before[url].getheader('ETag'))
        expect('kept ' + url, metric(server, 'cache_total{cache="hit"}'), hits + 1)
    for file in set(cases.values()):  # in another place of the same size and time
        shutil.copy('other.png', 'textures/new'), os.utime('textures/new', (1, 1))
        os.rename('textures/new', 'textures/' + file)
    for url, was in before.items():
        answer = ask(server, url, If_None_Match=was.getheader('ETag'))
        is_read = 'Wall' not in url
        expect(url, answer.status, 200 if is_read else 304)
        if is_read:
            expect('another tag and picture', (answer.getheader('ETag') != was.getheader('ETag'),
                                               answer.body != was.body), (True, True))
            expect('known', ask(server, url, If_None_Match=answer.getheader('ETag')).status, 304)
    os.remove('textures/gloss.png')
    expect('gone', ask(server, urls[0]).status, 404)
    image = ask(server, urls[2]).body
    shutil.copy('textures/oak.jpg', 'textures/gloss.jpg')
    time.sleep(.2)
    answers = receive_all(send_all(server, [f'/v1/{room}/{edits};Floor.scale={n}/full.png' for n in range(1, 9)
                                            for room in ('three', 'two') for edits in cases]))
    expect('at once', {answer.status for answer in answers}, {200})
    expect('the same', ask(server, urls[2]).body, image)


# ---- load, and the end ----

def together(server):
    """Many who ask for the same at once are answered by one piece of work; connections are kept open."""
    bodies = []
    threads = [threading.Thread(target=lambda: bodies.append(ask(server, '/v1/raw/Floor=oak;Wall=brick/full.png').body))
               for _ in range(12)]
    [thread.start() for thread in threads], [thread.join() for thread in threads]
    expect('bodies', (len(bodies), len(set(bodies))), (12, 1))
    expect('images', metric(server, 'images_read_total'), 2)
    expect('pictures', metric(server, 'cache_total{cache="miss"}'), 1)
    shutil.copy('rooms/small.retex', 'rooms/cold.retex')  # pictures that need different parts of a room decoded
    answers = []
    urls = [f'/v1/cold/{edits}/full.png?crop={n},0,9,9' for n in range(8) for edits in
            ('Floor=oak', 'Wall=brick', 'Floor=oak;Wall=brick')]
    threads = [threading.Thread(target=lambda url=url: answers.append(ask(server, url))) for url in urls]
    [thread.start() for thread in threads], [thread.join() for thread in threads]
    expect('cold', {answer.status for answer in answers}, {200})
    os.remove('rooms/cold.retex')
    connection = http.client.HTTPConnection('127.0.0.1', server.port, timeout=60)
    for _ in range(3):
        connection.request('GET', '/v1/small/full.jpg')
        kept = connection.sock
        expect('kept', len(connection.getresponse().read()) > 500, True)
        expect('the same connection', connection.sock is kept and kept is not None, True)


def texts(server):
    """What needs no pixels does not wait for pictures."""
    ask(server, '/v1')  # finds out which formats can be written

    def waiting(round):
        """How many of 300 pictures that were asked for before the texts are still to come after them."""
        clients = send_all(server, [f'/v1/raw/Floor=oak;Floor.scale={round}.{n:03}/full.png' for n in range(300)])
        for path in '/iiif/3/small/info.json', '/iiif/3/raw/info.json', '/v1/raw', '/v1':
            expect(path, ask(server, path).status, 200)
        left = len(clients) - len(select.select(clients, [], [], 0)[0])
        expect('pictures', {answer.status for answer in receive_all(clients)}, {200})
        return left
    # on a machine where this client gets no processor while the server has it, all may be there already
    expect('texts are there before the last pictures', any(waiting(round) >= 10 for round in range(1, 9)), True)


def crowd(server):
    """Beyond the queue there is 503, which says when to come again."""
    answers = receive_all(send_all(server, [f'/v1/raw/Floor=oak;Floor.scale=.{n}/full.png' for n in range(10, 50)]))
    statuses = {answer.status for answer in answers}
    expect('statuses', statuses, {200, 503})
    expect('Retry-After', {answer.getheader('Retry-After') for answer in answers if answer.status == 503}, {'2'})
    expect('afterwards', ask(server, '/v1/raw/full.png').status, 200)


def slow(server):
    """Who sends a request byte by byte, or nothing, is cut off; others are not kept waiting."""
    silent = socket.create_connection(('127.0.0.1', server.port), 10)
    trickle = socket.create_connection(('127.0.0.1', server.port), 10)
    began = time.time()
    try:
        for byte in b'GET /v1/small/full.jpg HTTP/1.1\r\nHost: slow\r\n' * 50:
            trickle.sendall(bytes([byte]))
            time.sleep(.05)
            if time.time() - began > 8:
                print('a slow sender is still heard')
                break
    except OSError:
        pass
    silent.settimeout(8)
    expect('silent', silent.recv(10), b'')
    expect('others', ask(server, '/v1/small/full.jpg').status, 200)


def moved(server):
    """A link that takes the place of the folder of images leads nothing elsewhere."""
    image = open('outside.jpg', 'rb').read()
    open('away/.incoming-9.jpg', 'w').close(), os.utime('away/.incoming-9.jpg', (0, 0))
    open(f'away/{"0" * 64}.jpg', 'w').close(), os.utime(f'away/{"0" * 64}.jpg', (0, 0))
    before = sorted(os.listdir('away'))
    os.rename('moving', 'moved'), os.symlink('away', 'moving')
    expect('refused', send(server, image).status in (415, 500, 503), True)
    time.sleep(6)  # old images are looked for
    expect('untouched', (sorted(os.listdir('away')), os.listdir('moved')), (before, []))


def nuls(server):
    """%00 is of no URL, whatever the method."""
    for path in ('/%00', '/v1%00', '/v1/small%00/full.png', '/v1/small/full.png%00', '/v1/small/Floor=oak%00/full.png',
                 '/v1/small/full.png?preset=a%00', '/v1/uploads%00', '/health%00', '/iiif/3/small%00/info.json'):
        expect(path, [ask(server, path, method).status for method in ('GET', 'HEAD', 'OPTIONS')] +
               [send(server, b'x', path).status], 4 * [400])


def deadline(server):
    """A picture that takes too long is given up."""
    expect('deadline', ask(server, '/v1/raw/Floor=oak/full.png').status, 503)


def end(server):
    """What was asked for before the end is still answered, and the log has a line for each request."""
    answers = []
    threads = [threading.Thread(target=lambda n=n: answers.append(ask(server, f'/v1/raw/Floor=rgb(0,0,.{n})/full.png')))
               for n in range(10, 20)]
    [thread.start() for thread in threads]
    asked = lambda: metric(server, 'queue_length') + metric(server, 'working') + len(answers) >= 10
    expect('all are there', wait_for(asked, pause=.001), True)
    server.send_signal(signal.SIGTERM)
    [thread.join() for thread in threads]
    expect('answers', [answer.status for answer in answers], 10 * [200])
    expect('status', server.wait(20), 0)
    lines = [json.loads(line) for line in open('log').read().splitlines()]  # nothing else: a stop is no error
    expect('log', [line['status'] for line in lines if 'rgb' in line['path']], 10 * [200])
    expect('keys', list(lines[0])[:8], ['time', 'client', 'method', 'path', 'status', 'bytes', 'seconds', 'cache'])


def levels(server):
    """Small pictures of a pack with levels, and parts: as retex-combine makes them."""
    for size, crop in (('162x20', ''), ('40x', ''), ('486x60', ''), ('81x10', '0,0,243,30'), ('80x10', '1,0,240,30')):
        combine('x.png', 'rooms/l.retex', '--texture', 'Floor=tan', '--size', size, *(['--crop', crop] if crop else []))
        for _ in range(2):
            answer = ask(server, f'/v1/l/Floor=tan/{size}.png' + (f'?crop={crop}' if crop else ''))
            expect(size, (answer.status, answer.body == open('x.png', 'rb').read()), (200, True))


OPTIONS = {'uploads': ['--uploads', 'uploads', '--upload-size', '1', '--upload-count', '2', '--upload-pixels', '1100000',
                       '--upload-age', '3600'],
           'decoders': ['--uploads', 'strange', '--upload-time', '2'],
           'hurried': ['--uploads', 'strange', '--deadline', '1'],
           'moved': ['--uploads', 'moving', '--upload-age', '1'],
           'documented': ['--uploads', 'uploads'], 'heads': ['--uploads', 'uploads'],
           'proxied': ['--uploads', 'uploads', '--trusted-proxy', '127.0.0.1', '--per-client', '8', '--threads', '1'],
           'clients': ['--uploads', 'uploads', '--per-client', '16'], 'crawling': ['--uploads', 'uploads'],
           'presets': ['--presets', 'presets'], 'texts': ['--threads', '1', '--per-client', '0'], 'refused': ['--timeout', '1'],
           'crowd': ['--queue', '0', '--threads', '1'],
           'slow': ['--timeout', '0.5'], 'deadline': ['--deadline', '0.001']}
run(globals(), OPTIONS, '--textures', 'textures')
