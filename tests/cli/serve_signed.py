# What serve_signed.t asks of a retex-serve that answers signed URLs alone. Signatures are those of Python's hmac.
import base64, hashlib, hmac, json, subprocess, sys

sys.dont_write_bytecode = True
from serve_ask import ask, expect, run, send, wait_for

OLD, NEW = bytes(range(16)), bytes(range(100, 164))  # the shortest and the longest key


def signature(key, path):
    return base64.urlsafe_b64encode(hmac.new(key, path.encode(), hashlib.sha256).digest()).decode().rstrip('=')


def signed(path, key=NEW, of=None):
    return f'/{signature(key, of or path)}{path}'


def signed_urls(server):
    """A URL is answered if one of the keys has signed it, and it alone."""
    for path in ('/v1', '/v1/small', '/v1/small/full.png', '/v1/small/Floor=oak;Floor.scale=2/32x.jpg?quality=80',
                 '/v1/small/Wall=%23ff8800/32x24.png?exposure=.5', '/metrics', '/health'):
        for key in NEW, OLD:
            expect(path, ask(server, signed(path, key)).status, 200)
    expect('unsigned health', ask(server, '/health').status, 200)
    path = '/v1/small/full.png'
    right = signature(NEW, path)
    other = right[:-1] + chr(ord(right[-1]) + 1)  # of which base64 decodes the same bytes, or one bit more
    for url in (path, '/v1', '/metrics', '/', '/' + right, '/' + right + '/', '/' + right + '/v1', f'/{right}//v1/small/full.png',
                f'/{right}{path}?quality=90', f'/{right}{path}?', f'/{right}/v1/small/ful%6c.png', f'/{other}{path}',
                f'/{right}={path}', f'/{right[:-1]}{path}', f'/{right[:-1]}%{ord(right[-1]):02X}{path}',
                signed(path, bytes(16)), signed(path, OLD + b'\1'), f'/{right}{signed(path)}', '/health?x=1', '/health/'):
        answer = ask(server, url)
        expect(url, (answer.status, answer.body, answer.getheader('Cache-Control')),
               (403, b'the URL is not signed by a key of this server\n', 'no-store'))
    expect('signed, but wrong', [ask(server, signed(path)).status for path in ('/v1/none/full.jpg', '/v1/small/9x9x.jpg')],
           [404, 404])
    long = '/v1/small/full.png?' + 'x' * (4096 - 19)
    expect('long', [ask(server, signed(path)).status for path in (long, long + 'x')], [400, 414])
    first, second = (ask(server, signed('/v1/small/Floor=oak/full.png', key)) for key in (OLD, NEW))
    expect('one picture', (first.body == second.body, first.getheader('ETag')), (True, second.getheader('ETag')))
    lines = [json.loads(line) for line in open('log')]
    expect('log', (lines[0]['path'], [line['path'] for line in lines if line['status'] == 200 and NEW[:3].hex() in line['path']]),
           ('/v1', []))
    # a server that has other keys, or a path that somebody has changed, must not tell signatures to who reads logs
    moved = f'/{right[:20]}+{right[21:]}', f'/{right[:20]}/{right[21:]}/x', f'/a{right}', f'/{right}/none', f'/{right}/{right}', f'/%{ord(right[0]):02x}{right[1:]}'
    for url in (*moved, *(url + path for url in moved), f'/x?s={right}', path + f'?s={right}', f'/wp-login.php?{right}'):
        expect(url, ask(server, url).status, 403)
    ask(server, '/favicon.ico'), ask(server, '/v1/small/Floor=oak;Floor.scale=2/unsigned.png')
    wait_for(lambda: '/unsigned.png' in open('log').read())  # a line is written after its answer
    told = open('log').read()
    signatures = [signature(key, path) for key in (NEW, OLD, bytes(16), OLD + b'\1')] + [other]
    expect('no signature in the log', [s for s in signatures for at in range(32) if s[at:at + 12] in told], [])
    paths = [json.loads(line)['path'] for line in told.splitlines()]
    expect('before paths', [p for p in paths if '/v1' in p[1:] and not p.startswith('/v1')], [])
    expect('what was asked for', [p in paths for p in (path, '/favicon.ico', '/v1/small/Floor=oak;Floor.scale=2/unsigned.png')],
           [True, True, True])


def signed_images(server):
    """The signature of an image of IIIF holds for what is asked for below it, and for no other image."""
    image = '/iiif/3/small;Floor=oak'
    url = signed(image)
    info = json.loads(ask(server, url + '/info.json').body)
    expect('id', info['id'], f'http://127.0.0.1:{server.port}{url}')
    expect('base', ask(server, url).getheader('Location'), info['id'] + '/info.json')
    picture = ask(server, url + '/0,0,32,32/16,/0/default.png')
    expect('canonical', picture.getheader('Link').split('>')[0], f'<{info["id"]}/0,0,32,32/16,16/0/default.png')
    other = ask(server, signed('/iiif/3/small%3bFloor=oak') + '/info.json')  # another spelling of it
    expect('another spelling', json.loads(other.body)['id'], info['id'])
    for path in ('/iiif/3/small;Floor=brick/info.json', '/iiif/3/small/info.json', '/iiif/3/small%3bFloor=oak/info.json',
                 '/v1/small/full.png', '/iiif/2/small;Floor=oak/info.json'):
        expect(path, ask(server, '/' + signature(NEW, image) + path).status, 403)


def signed_uploads(server):
    """An image is received only at a signed URL; the texture that it becomes is asked for by signed ones."""
    image = open('outside.jpg', 'rb').read()
    name = hashlib.sha256(image).hexdigest() + '.jpg'
    for path in '/v1/uploads', signed('/v1/uploads', bytes(16)), signed('/v1/uploads', of='/v1'):
        expect(path, [send(server, image, path, method).status for method in ('POST', 'OPTIONS')], [403, 403])
    path = signed('/v1/small/Floor=oak/32x.png?v=/v1/uploads')
    expect('of a picture', [send(server, image, path, method).status for method in ('POST', 'OPTIONS')], [405, 405])
    path = signed('/v1/uploads')
    expect('asked before', send(server, b'', path, 'OPTIONS').status, 204)
    told = send(server, image, path)
    expect('kept', (told.status, json.loads(told.body)['texture']), (201, name))
    expect('shown', [ask(server, url).status for url in (f'/v1/small/Floor={name}/32x.png',
                                                         signed(f'/v1/small/Floor={name}/32x.png'))], [403, 200])


def printed(server):
    """--sign prints what the server answers."""
    for path in ('/v1/small/Floor=oak/32x.png?quality=80', '/iiif/3/small;Floor=oak', '/iiif/3/small;Floor=oak/full/max/0/default.jpg',
                 '/v1/uploads', '/metrics'):
        for host in '', 'https://rooms.example.org', 'http://[::1]:8080':
            got = subprocess.run(['retex-serve', '--key-file', 'keys', '--sign', host + path], capture_output=True, text=True)
            of = path[:path.find('/', 8)] if path.endswith('default.jpg') else path
            expect(path, (got.stdout, got.stderr, got.returncode), (f'{host}{signed(path, of=of)}\n', '', 0))


KEYS = ['--key-file', 'keys', '--uploads', 'uploads']
run(globals(), dict.fromkeys(sys.argv[1:], KEYS), '--textures', 'textures')
