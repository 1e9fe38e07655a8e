# What studio.t asks of retex-studio: starts it, runs the checks of the functions that are named, each with a server and
# a folder of its own, and prints what differs, and at last the name of the function.
import fcntl, http.client, json, os, re, shutil, signal, socket, subprocess, sys, tempfile, threading, time

SCENE = '''camera { location <0, 1, -3> look_at <0, 1, 0> angle 50 }
light_source { <1, 3, -2> color rgb 2 }
#declare Floor = texture { pigment { color rgb <.5, .4, .3> } }
plane { y, 0 texture { Floor } }
sphere { <0, 1, 0>, .7 pigment { color rgb .6 } }
'''


def project_of(**members):
    return json.dumps({'retex-studio': 1, 'model': 'room.pov', **members})


class Server:
    def __init__(self, *options, folder=None, environment=None, browser=False, address='address'):
        self.folder = folder or tempfile.mkdtemp(dir='.')
        if not os.path.exists(f'{self.folder}/room.pov'):
            open(f'{self.folder}/room.pov', 'w').write(SCENE)
        os.makedirs(f'{self.folder}/home', exist_ok=True)
        options = '-o', address, *options
        address = f'{self.folder}/{address}'
        if os.path.exists(address):
            os.remove(address)
        self.process = subprocess.Popen(
            ['retex-studio', 'room.pov', *([] if browser else ['--no-browser']), *options],
            cwd=self.folder, env={**os.environ, 'HOME': os.path.abspath(self.folder) + '/home', **(environment or {})},
            stderr=open(f'{self.folder}/log', 'w'))
        for _ in range(1000):
            if os.path.exists(address):
                break
            time.sleep(.01)
        else:
            sys.exit('no server: ' + open(f'{self.folder}/log').read())
        self.port, self.token = re.fullmatch(r'http://127\.0\.0\.1:(\d+)/([0-9a-f]{32})/\n',
                                             open(address).read()).groups()
        self.port = int(self.port)

    def ask(self, path, method='GET', body=None, whole=None, **headers):
        connection = http.client.HTTPConnection('127.0.0.1', self.port, timeout=60)
        if isinstance(body, dict):
            body = json.dumps(body)
        connection.request(method, whole or f'/{self.token}/{path}', body,
                           {name.replace('_', '-'): value for name, value in headers.items()})
        answer = connection.getresponse()
        answer.body = answer.read()
        connection.close()
        return answer

    def json(self, *arguments, **options):
        return json.loads(self.ask(*arguments, **options).body)

    def job(self, *args, tool='retex-render'):
        return self.json('api/jobs', 'POST', {'tool': tool, 'args': args, 'label': 'a job'}).get('job')

    def wait(self, number, states=('done', 'failed', 'stopped'), seconds=120):
        until = time.time() + seconds
        while time.time() < until:
            job = [job for job in self.json('api/jobs') if job['job'] == number][0]
            if job['state'] in states:
                return job
            time.sleep(.02)
        sys.exit(f'job {number} is {job}')

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        expect('exit status', self.process.wait(60), 0)


def expect(what, got, wanted):
    if got != wanted:
        print(f'{what}: {got!r}, not {wanted!r}')


def status(server, *arguments, **options):
    return server.ask(*arguments, **options).status


def render(output, *options, size='160x120'):
    return [*options, '--size', size, '-t', 'Floor', '-o', 'room.pov.studio/' + output, '--', 'room.pov']


LISTS = ['--list-lamps', '--', 'room.pov']


# ---- who may ask ----

def gate(server):
    token, port = server.token, server.port
    expect('the page', status(server, ''), 200)
    expect('localhost', status(server, '', Host=f'localhost:{port}', Origin=f'http://localhost:{port}'), 200)
    for what, options in (('no token', {'whole': '/'}), ('another token', {'whole': f'/{"0" * 32}/api/state'}),
                          ('a part of it', {'whole': f'/{token[:31]}/api/state'}),
                          ('more of it', {'whole': f'/{token}0/api/state'}),
                          ('another name', {'Host': 'evil.example'}), ('another port', {'Host': f'127.0.0.1:{port + 1}'}),
                          ('another page', {'Origin': 'http://evil.example'}), ('a page of a file', {'Origin': 'null'}),
                          ('another scheme', {'Origin': f'https://127.0.0.1:{port}'})):
        expect(what, status(server, 'api/state', **options), 403)
    expect('quit by another page', status(server, 'api/quit', 'POST', Origin='http://evil.example'), 403)
    for head in f'Host: 127.0.0.1:{port}\r\nHost: 127.0.0.1:{port}\r\n', '':
        with socket.create_connection(('127.0.0.1', port), 10) as raw:
            raw.sendall(f'GET /{token}/api/state HTTP/1.1\r\n{head}Connection: close\r\n\r\n'.encode())
            expect('hosts', raw.recv(12)[9:], b'400')
    expect('another method', status(server, 'api/state', 'POST'), 405)
    expect('another address', status(server, 'api/nothing'), 404)


def address(server):
    """The file with the address is for the user alone, also where there was one that others could read."""
    mode = lambda: oct(os.stat(f'{server.folder}/address').st_mode & 0o777)
    expect('its mode', mode(), '0o600')
    server.end()
    open(f'{server.folder}/address', 'w').write('old')
    os.chmod(f'{server.folder}/address', 0o666)
    process = subprocess.Popen(['retex-studio', 'room.pov', '--no-browser', '-o', 'address'], cwd=server.folder)
    while (text := open(f'{server.folder}/address').read()) == 'old':
        time.sleep(.01)
    expect('its mode again', (mode(), text.startswith('http://')), ('0o600', True))
    process.terminate()
    process.wait(60)
    os.remove(f'{server.folder}/address')
    server.__init__(folder=server.folder)
    server.ask('api/upload?name=x', 'POST', b'x')
    rights = lambda name: os.stat(f'{server.folder}/{name}').st_mode & 0o777
    expect('other files', rights('room.pov.studio/files/x'), rights('room.pov'))


def strangers(server):
    """Connections without the token, however many, do not take the places of the user's."""
    kept = http.client.HTTPConnection('127.0.0.1', server.port, timeout=20)
    kept.request('GET', f'/{server.token}/api/events')
    stream = kept.getresponse()
    stream.readline()
    idle = []
    for number in range(450):
        idle.append(socket.create_connection(('127.0.0.1', server.port), timeout=5))
        if number % 150 == 149:
            begin = time.time()
            expect('the user', (status(server, 'api/state'), time.time() - begin < 5), (200, True))
    server.json('api/jobs', 'POST', {'tool': 'retex-render', 'args': LISTS, 'label': ''})
    expect('a window that was there', b'event: ' in b''.join(stream.readline() for _ in range(8)), True)
    for one in idle:
        one.close()
    kept.close()


# ---- what comes from a stranger ----

def given(server, files=(), links=(), folders=()):
    """Start the server anew where a stranger's archive was unpacked."""
    server.end()
    home = os.path.abspath(server.folder) + '/home'
    os.makedirs(home + '/mine/scene')
    open(home + '/mine/scene/scene.pov', 'w').write('my own work')
    server.folder += '/gift'
    os.makedirs(server.folder)
    for folder in folders:
        os.makedirs(f'{server.folder}/{folder}')
    for name, text in dict(files).items():
        open(f'{server.folder}/{name}', 'w').write(text)
    for name, target in dict(links).items():
        os.symlink(target, f'{server.folder}/{name}')
    return home


def foreign(server):
    """Nothing is run or written for a project that somebody else has made, before the user agrees; then it is known."""
    given(server, {'room.pov.studio.json': project_of(look='Floor=red')}, folders=['room.pov.studio/files'])
    server.__init__(folder=server.folder)
    home = os.path.abspath(server.folder) + '/home'
    job = {'tool': 'retex-render', 'args': render('x.exr'), 'label': ''}
    asked = (('a job', 'api/jobs', 'POST', job, {}), ('the preview', 'api/preview/start', 'POST', {'scene': 'room.pov'}, {}),
             ('a file', 'api/upload?name=x', 'POST', b'x', {}), ('folders', 'api/textures', 'POST', {'path': home}, {}),
             ('the project', 'api/project', 'PUT', project_of(), {'If_Match': server.ask('api/project').headers['ETag']}))
    state = server.json('api/state')
    expect('it is told', (state['foreign'], state['project']['look']), ('your retex-studio has not made its folder', 'Floor=red'))
    for what, path, method, body, headers in asked:
        answer = server.ask(path, method, body, **headers)
        expect(what, (answer.status, json.loads(answer.body)), (403, {
            'error': 'room.pov may come from a stranger, for your retex-studio has not made its folder: '
                     'agree first to go on with it'}))
    expect('no job', server.json('api/jobs'), [])
    expect('of another', status(server, 'api/trust', 'POST', {'model': home + '/room.pov'}), 404)
    path = os.path.abspath(server.folder) + '/room.pov'
    expect('agreed', server.json('api/trust', 'POST', {'model': path})['foreign'], None)
    expect('the project then', status(server, 'api/project', 'PUT', project_of(), If_Match=server.ask('api/project').headers['ETag']), 200)
    expect('a job then', server.wait(server.job(*LISTS))['state'], 'done')
    foreign = lambda: server.json('api/state')['foreign']
    server.end()
    server.__init__(folder=server.folder)
    expect('the next time', foreign(), None)
    server.end()
    shutil.move(f'{server.folder}/room.pov.studio', f'{server.folder}/was')
    shutil.copytree(f'{server.folder}/was', f'{server.folder}/room.pov.studio')
    server.__init__(folder=server.folder)
    expect('another of its name', foreign() is None, False)
    server.end()
    server.__init__(folder=server.folder, environment={'XDG_DATA_HOME': '/dev/null'})
    server.json('api/trust', 'POST', {'model': path})
    expect('where nothing can be kept', foreign(), None)
    if os.geteuid() == 0:
        server.end()
        os.chown(f'{server.folder}/room.pov.studio', 65534, 65534)
        server.__init__(folder=server.folder)
        expect("another user's", foreign(), "its folder is another user's")


def options(server):
    """A project whose members look like options, or lead elsewhere, is not shown, and not written over."""
    for member in ({'renders': [{'set': '--help', 'done': True, 'args': []}]}, {'model': '../room.pov'}, {'look': 'a\x1b'}):
        open(f'{server.folder}/room.pov.studio.json', 'w').write(project_of(**member))
        answer = server.ask('api/project')
        expect(str(member), (answer.status, b'the project is damaged: ' in answer.body), (422, True))
        expect('state', server.json('api/state')['project'], {})
        expect('not over it', server.ask('api/project', 'PUT', project_of(), If_None_Match='*').status, 412)
    os.remove(f'{server.folder}/room.pov.studio.json')
    expect('nor written', server.ask('api/project', 'PUT', project_of(renders=[{'set': '--help'}]), If_None_Match='*').status, 422)


def links(server):
    """Links of an archive do not lead the studio to files of the user."""
    home = given(server, links={'room.pov.studio': '../home/mine'})
    mine = lambda: sorted(os.path.relpath(f'{top}/{name}', home) for top, _, names in os.walk(home) for name in names if 'retex' not in top)
    open(f'{server.folder}/room.pov', 'w').write(SCENE)
    run = subprocess.run(['retex-studio', 'room.pov', '--no-browser'], cwd=server.folder, capture_output=True, text=True,
                         env={**os.environ, 'HOME': home}, timeout=60)
    expect('its folder', (run.returncode, run.stdout, run.stderr), (2, '', 'retex-studio: error: ' + os.path.abspath(server.folder) +
           '/room.pov.studio is a link: retex-studio writes into a folder of its own; remove the link\n'))
    os.remove(f'{server.folder}/room.pov.studio')
    server.__init__(folder=server.folder)
    os.symlink('../../home/mine/scene', f'{server.folder}/room.pov.studio/scene')
    for what, tool, args in (('a picture', 'retex-combine', ['-o', 'room.pov.studio/scene/scene.pov', '--', 's.exr']),
                             ('beside it', 'retex-render', render('x.exr'))):
        answer = server.ask('api/jobs', 'POST', {'tool': tool, 'args': args, 'label': ''})
        expect(what, (answer.status >= 400, 'link' in answer.body.decode()), (True, True))
    expect('its file', status(server, 'files/room.pov.studio/scene/scene.pov'), 403)
    os.remove(f'{server.folder}/room.pov.studio/scene')
    os.symlink('../../home/mine', f'{server.folder}/room.pov.studio/files')
    expect('a file that is sent', status(server, 'api/upload?name=look.json', 'POST', b'{}'), 403)
    os.remove(f'{server.folder}/room.pov.studio/files')
    open(f'{home}/other.json', 'w').write(project_of())
    os.symlink('../home/other.json', f'{server.folder}/room.pov.studio.json')
    expect('a project', [status(server, 'api/project'), status(server, 'api/project', 'PUT', project_of(), If_None_Match='*')], [500, 507])
    expect('mine', (mine(), open(home + '/mine/scene/scene.pov').read()), (['mine/scene/scene.pov', 'other.json'], 'my own work'))


def served(server):
    """What lies below a project is data: no document or script of the studio's address."""
    for name in 'index.html', 'x.svg', 'retex-room.js', 'x.xml', 'room.json', 'oak.jpg':
        open(f'{server.folder}/room.pov.studio/{name}', 'w').write('<script>fetch("../../api/quit", {method: "POST"})</script>')
    plain = "default-src 'none'; sandbox; frame-ancestors 'none'"
    for name, kind in (('index.html', 'application/octet-stream'), ('x.svg', 'application/octet-stream'), ('x.xml', 'application/octet-stream'),
                       ('retex-room.js', 'application/octet-stream'), ('room.json', 'application/json'), ('oak.jpg', 'image/jpeg')):
        head = server.ask(f'files/room.pov.studio/{name}').headers
        expect(name, [head[key] for key in ('Content-Type', 'X-Content-Type-Options', 'Content-Security-Policy')], [kind, 'nosniff', plain])
    expect('an answer', server.ask('api/state').headers['Content-Security-Policy'], plain)
    for host in f'127.0.0.1:{server.port}', f'localhost:{server.port}':
        policy = server.ask('', Host=host).headers['Content-Security-Policy'].split('; ')
        scripts = [f'http://{host}/{server.token}/{name}' for name in ('studio.js', 'retex-room.js')]
        expect('scripts', [part for part in policy if part.startswith('script-src')], ['script-src ' + ' '.join(scripts)])
        expect('the rest', {"default-src 'none'", "object-src 'none'", "base-uri 'none'", "form-action 'none'", "frame-ancestors 'none'"} - set(policy), set())
    for name in 'studio.js', 'retex-room.js':
        answer = server.ask(name)
        expect(name, (answer.status, answer.headers['Content-Type']), (200, 'text/javascript; charset=utf-8'))


def browsers(server):
    """The browser gets a page that leads to the address, which no other user can read; where there is a display."""
    top = os.path.abspath(server.folder)
    os.makedirs(top + '/bin')
    with open(top + '/bin/xdg-open', 'w') as script:
        script.write('#!/bin/sh\n(echo "$# $1"; stat -c %a "$1"; cat "$1") >seen.part\nmv seen.part seen\n')
    os.chmod(top + '/bin/xdg-open', 0o755)
    environment = {'PATH': f'{top}/bin:{os.environ["PATH"]}', 'XDG_RUNTIME_DIR': top, 'WAYLAND_DISPLAY': ''}
    for display, browser in ('', True), (':7', False), (':7', True):
        server.end()
        server.__init__(folder=server.folder, environment={**environment, 'DISPLAY': display}, browser=browser)
        for _ in range(50 if not (display and browser) else 1000):
            if os.path.exists(top + '/seen'):
                break
            time.sleep(.01)
        expect('a browser', os.path.exists(top + '/seen'), bool(display and browser))
    words, mode, page = open(top + '/seen').read().split('\n', 2)
    page_file = f'{top}/retex-studio-{server.process.pid}.html'
    expect('its words', words, f'1 {page_file}')
    expect('its mode', mode, '600')
    expect('its page', f'url=http://127.0.0.1:{server.port}/{server.token}/"' in page, True)
    quits(server)
    expect('its page at the end', os.path.exists(page_file), False)


# ---- files ----

def roots(server):
    """Nothing outside of the folders is read, wherever paths and links lead."""
    os.makedirs(f'{server.folder}/room.pov.studio/page')
    os.makedirs(f'{server.folder}/home/.ssh', exist_ok=True)
    open(f'{server.folder}/home/.ssh/id', 'w').write('secret')
    open(f'{server.folder}/room.pov.studio/page/room.json', 'w').write('0123456789')
    os.symlink('/etc/passwd', f'{server.folder}/room.pov.studio/passwd')
    os.symlink('/etc', f'{server.folder}/room.pov.studio/etc')
    answer = server.ask('files/room.pov.studio/page/room.json')
    expect('a file', (answer.status, answer.body, answer.headers['Content-Type']),
           (200, b'0123456789', 'application/json'))
    expect('unchanged', status(server, 'files/room.pov.studio/page/room.json', If_None_Match=answer.headers['ETag']), 304)
    for range_of, wanted in ('2-4', (206, b'234')), ('7-', (206, b'789')), ('-3', (206, b'789')), ('4-99', (206, b'456789')):
        part = server.ask('files/room.pov.studio/page/room.json', Range='bytes=' + range_of)
        expect(range_of, (part.status, part.body), wanted)
    expect('no such part', status(server, 'files/room.pov.studio/page/room.json', Range='bytes=10-'), 416)
    for path in ('room.pov', 'room.pov.studio/passwd', 'room.pov.studio/etc/passwd', '/etc/passwd', 'room.pov.studio/../room.pov',
                 'room.pov.studio/%2e%2e/room.pov', 'room.pov.studio/page/../../address', '/proc/self/environ'):
        expect('files/' + path, status(server, 'files/' + path), 403)
    expect('no file', status(server, 'files/room.pov.studio/none'), 404)
    home = os.path.abspath(server.folder) + '/home'
    for path in '/etc', home + '/.ssh', '..', 'room.pov.studio/etc', '/':
        expect('list of ' + path, status(server, 'api/folder?path=' + path), 403)
        expect('thumbnail of ' + path, status(server, 'api/thumb?path=' + path + '/x.png'), 403)
        expect('opening ' + path, status(server, 'api/open', 'POST', {'path': path + '/x.pov'}), 403)
    kinds = {entry['name']: (entry['kind'], entry['path']) for entry in server.json('api/folder')['entries']}
    expect('scene', kinds['room.pov'], ('scene', 'room.pov'))
    expect('no folder', status(server, 'api/folder?path=none'), 404)
    expect('a folder to come', server.json('api/folder?path=room.pov.studio/files')['entries'], [])
    expect('page', server.json('api/folder?path=room.pov.studio')['entries'][-1]['kind'] in ('page', 'file'), True)


def uploads(server):
    send = lambda name, body: server.ask('api/upload?name=' + name, 'POST', body)
    path = lambda answer: json.loads(answer.body).get('path')
    expect('a file', path(send('oak.jpg', b'oak')), 'room.pov.studio/files/oak.jpg')
    expect('again', path(send('oak.jpg', b'oak')), 'room.pov.studio/files/oak.jpg')
    expect('another', path(send('oak.jpg', b'elm')), 'room.pov.studio/files/oak-2.jpg')
    expect('upwards', path(send('..%2F..%2F.ssh/%00id', b'x'))[:22], 'room.pov.studio/files/')
    expect('folders', path(send('a/../b\\c:d.png', b'x')), 'room.pov.studio/files/a/b/c_d.png')
    expect('no name', send('..', b'x').status, 422)
    expect('too large', status(server, 'api/upload?name=x', 'POST', b'', Content_Length=str(1 << 40)), 413)
    os.symlink('/tmp', f'{server.folder}/room.pov.studio/files/out')
    expect('through a link', send('out/x', b'x').status, 403)
    expect('a model', path(server.ask('api/upload?name=m.pov&as=model', 'POST', SCENE)),
           'home/retex-studio/m.pov')
    with socket.create_connection(('127.0.0.1', server.port), 10) as raw: # a window that is closed
        raw.sendall(f'POST /{server.token}/api/upload?name=half HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n'
                    'Content-Length: 1000\r\n\r\nhalf'.encode())
    time.sleep(.3)
    left = lambda: [name for name in os.listdir(f'{server.folder}/room.pov.studio/files') if 'half' in name or name.startswith('.')]
    expect('what is left', left(), [])
    with socket.create_connection(('127.0.0.1', server.port), 10) as raw: # a server that is killed
        raw.sendall(f'POST /{server.token}/api/upload?name=half HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n'
                    'Content-Length: 1000\r\n\r\nhalf'.encode())
        for _ in range(500):
            if left():
                break
            time.sleep(.01)
        server.process.kill()
        server.process.wait()
    expect('what a dead one leaves', len(left()), 1)
    server.__init__(folder=server.folder)
    expect('what is left then', left(), [])


def thumbs(server):
    for name, wanted in ('red.png', 200), ('broken.png', 422), ('none.png', 404):
        if wanted == 200:
            subprocess.run(['make_picture', f'{server.folder}/{name}', 'size=600x300'], check=True)
        elif wanted == 422:
            open(f'{server.folder}/{name}', 'w').write('no picture')
        answer = server.ask(f'api/thumb?path={name}&size=64')
        expect(name, answer.status if wanted == 200 else answer.status >= 400, wanted if wanted == 200 else True)
        if wanted == 200:
            expect('JPEG', answer.body[:2], b'\xff\xd8')
            expect('again', status(server, f'api/thumb?path={name}&size=64', If_None_Match=answer.headers['ETag']), 304)
    expect('size', status(server, 'api/thumb?path=red.png&size=5000'), 400)
    expect('no file', status(server, 'api/thumb?path=none.png'), 404)


def full(server):
    """A disk that is full: the error says so and nothing is left."""
    server.end()
    server.__init__(folder=server.folder, environment={})
    import resource
    resource.prlimit(server.process.pid, resource.RLIMIT_FSIZE, (100000, 100000))
    answer = server.ask('api/upload?name=large', 'POST', b'x' * 300000)
    expect('large', (answer.status, json.loads(answer.body)), (507, {'error': 'the disk is full: the file was not kept'}))
    expect('what is left', os.listdir(f'{server.folder}/room.pov.studio/files'), [])
    answer = server.ask('api/project', 'PUT', json.dumps(json.loads(project_of(look='x' * 200000))), If_None_Match='*')
    expect('project', (answer.status, [name for name in os.listdir(server.folder) if 'json' in name]), (507, []))
    expect('small', status(server, 'api/upload?name=small', 'POST', b'x'), 200)


# ---- the project ----

def project(server):
    put = lambda text, **headers: server.ask('api/project', 'PUT', text, **headers)
    expect('none', status(server, 'api/project'), 404)
    expect('no condition', put('{}').status, 428)
    expect('no object', put('[1]', If_None_Match='*').status, 422)
    expect('no JSON', put('{', If_None_Match='*').status, 422)
    text = [project_of(a=a) for a in range(6)]
    first = put(text[1], If_None_Match='*')
    expect('first', first.status, 200)
    expect('first again', put(text[2], If_None_Match='*').status, 412)
    second = put(text[2], If_Match=first.headers['ETag'])
    expect('second', second.status, 200)
    answer = put(text[3], If_Match=first.headers['ETag'])
    expect('old', (answer.status, json.loads(answer.body)), (412, {'error': 'another window has changed the project'}))
    now = server.ask('api/project')
    expect('now', (now.body, now.headers['ETag']), (text[2].encode(), second.headers['ETag']))
    open(f'{server.folder}/room.pov.studio.json', 'w').write(text[4])
    expect('changed on disk', put(text[5], If_Match=second.headers['ETag']).status, 412)
    expect('kept', open(f'{server.folder}/room.pov.studio.json').read(), text[4])
    expect('too large', put('', If_None_Match='*', Content_Length=str(5 << 20)).status, 413)


def windows(server):
    """Two servers of one project: of two changes of the same state one is written, the other is told."""
    one = Server(folder=server.folder, address='other-address')
    put = lambda of, text, **headers: of.ask('api/project', 'PUT', text, **headers)
    etag, seen = put(server, project_of(), If_None_Match='*').headers['ETag'], []
    for i in range(60):
        barrier, answers = threading.Barrier(2), {}

        def change(of, k):
            text = project_of(a=[k, i] * 500)
            barrier.wait()
            answers[k] = put(of, text, If_Match=etag)
        threads = [threading.Thread(target=change, args=of) for of in ((server, 0), (one, 1))]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]
        seen.append(sorted(answer.status for answer in answers.values()))
        winner = min(answers, key=lambda k: answers[k].status)
        etag = server.ask('api/project').headers['ETag']
        if seen[-1] == [200, 412]:
            expect('what is there', etag, answers[winner].headers['ETag'])
    expect('both at once', [(pair, seen.count(pair)) for pair in ([200, 200], [200, 412], [412, 412])],
           [([200, 200], 0), ([200, 412], 60), ([412, 412], 0)])
    # whoever holds the lock is waited for, not for ever
    folder = os.open(server.folder, os.O_RDONLY)
    fcntl.flock(folder, fcntl.LOCK_EX)
    thread = threading.Thread(target=lambda: seen.append(put(server, project_of(b=1), If_Match=etag).status))
    thread.start()
    time.sleep(.5)
    expect('before its turn', (len(seen), server.ask('api/project').headers['ETag']), (60, etag))
    fcntl.flock(folder, fcntl.LOCK_UN)
    thread.join()
    expect('in its turn', seen[-1], 200)
    etag = server.ask('api/project').headers['ETag']
    fcntl.flock(folder, fcntl.LOCK_EX)
    answer = put(server, project_of(b=2), If_Match=etag)
    expect('locked', (answer.status, json.loads(answer.body)),
           (507, {'error': 'another program keeps the project locked'}))
    os.close(folder)
    expect('locked no more', put(server, project_of(b=3), If_Match=etag).status, 200)
    one.end()


def models(server):
    """Each model has a project of its own, which names it."""
    open(f'{server.folder}/room.inc.pov', 'w').write(SCENE)
    opened = lambda path: (lambda state: (state['model']['name'], state['folder'], (state.get('project') or {}).get('model')))(
        server.json('api/open', 'POST', {'path': path}))
    expect('another model', opened('room.inc.pov'), ('room.inc.pov', 'room.inc.pov.studio', None))
    open(f'{server.folder}/room.pov.studio.json', 'w').write(project_of())
    expect('the model', opened('room.pov'), ('room.pov', 'room.pov.studio', 'room.pov'))
    expect('by the project', opened('room.pov.studio.json'), ('room.pov', 'room.pov.studio', 'room.pov'))
    open(f'{server.folder}/none.pov.studio.json', 'w').write(project_of())
    expect('a project without its model', status(server, 'api/open', 'POST', {'path': 'none.pov.studio.json'}), 404)


def events(server):
    """What changes on disk is told, and what happens to jobs; first what is there, jobs that are over too."""
    over = server.job(*LISTS)
    server.wait(over)
    stream = http.client.HTTPConnection('127.0.0.1', server.port, timeout=20)
    stream.request('GET', f'/{server.token}/api/events')
    answer = stream.getresponse()

    def until(name):
        event = None
        for line in answer:
            line = line.decode().strip()
            if line.startswith('event: '):
                event = line[7:]
            elif line.startswith('data: ') and event == name:
                return json.loads(line[6:])

    expect('model of the beginning', until('model')['there'], True)
    told = until('job')
    expect('job of the beginning', (told['job'], told['state']), (over, 'done'))
    open(f'{server.folder}/room.pov', 'a').write('// changed\n')
    expect('model', until('model')['there'], True)
    open(f'{server.folder}/new', 'w').write(project_of())
    os.rename(f'{server.folder}/new', f'{server.folder}/room.pov.studio.json')
    expect('project', until('project')['etag'], server.ask('api/project').headers['ETag'])
    number = server.job(*LISTS)
    expect('job', until('job')['job'], number)
    os.remove(f'{server.folder}/room.pov')
    while until('model')['there']:
        pass
    stream.close()


# ---- jobs ----

def batch(server):
    """A table of --batch names an output elsewhere."""
    open(f'{server.folder}/room.pov.studio/t.csv', 'w').write('output,Floor\n../../x.png,red\n')
    job = server.wait(server.job('-q', '--batch', 'room.pov.studio/t.csv', '--batch-root', 'room.pov.studio/catalogue', '--mkdir', '--',
                                 'room.pov.studio/sets/r.exr', tool='retex-combine'))
    return job['state'], [name for name in os.listdir(server.folder) if name == 'x.png'], len(job['lines']) > 0


def jobs(server):
    job = server.wait(server.job(*render('sets/r.exr', '--spp', '4')))
    expect('render', (job['state'], job['status'], job['progress'], job['memory'] > 1 << 20), ('done', 0, 1, True))
    expect('the set', os.path.exists(f'{server.folder}/room.pov.studio/sets/r.exr'), True)
    expect('small', 'light_source' in server.wait(server.job(*LISTS))['stdout'], True)
    for tool in '/bin/sh', 'retex-serve', 'retex-studio', '../bin/retex-render', '':
        expect(tool, status(server, 'api/jobs', 'POST', {'tool': tool, 'args': []}), 422)
    for output in (['-o', 'x.exr'], ['-o../x.exr'], ['--output=/tmp/x.exr'], ['-o', 'room.pov.studio/../x.exr'], ['-qo', 'x.exr'],
                   ['--stats', 'stats.json'], ['--aov-dir', 'room.pov.studio'], ['room.pov']):
        answer = server.ask('api/jobs', 'POST', {'tool': 'retex-render', 'args': output + ['--', 'room.pov']})
        expect(output, (answer.status, len(json.loads(answer.body)['error'].splitlines())), (422, 1))
    expect('a table that leads out', batch(server), ('failed', [], True))
    expect('args', status(server, 'api/jobs', 'POST', {'tool': 'retex-pack', 'args': 'x'}), 422)
    broken = server.wait(server.job('--', 'none.pov'))
    expect('broken', (broken['state'], broken['status'], len(broken['lines'])), ('failed', 2, 1))
    expect('no job', status(server, 'api/jobs/999/stop', 'POST'), 404)


def killed(server):
    number = server.job(*render('r.exr', '--spp', '100000'))
    server.wait(number, ('running',))
    time.sleep(.3)
    children = open(f'/proc/{server.process.pid}/task/{server.process.pid}/children').read().split()
    os.kill(int(children[0]), signal.SIGKILL)
    job = server.wait(number)
    expect('killed', (job['state'], job['status'], job['lines'][-1]),
           ('failed', 137, 'retex-studio: the program was ended by a signal: Killed'))


def resumed(server):
    """A render that was stopped, by a window or by the server's end, has the same bits as one in one go."""
    expect('whole', server.wait(server.job(*render('whole.exr', '--spp', '64', size='320x240')))['state'], 'done')
    line = render('parts.exr', '--spp', '64', '--resume', size='320x240')

    def some_progress(number):
        while not any(job['job'] == number and job['progress'] > .1 for job in server.json('api/jobs')):
            time.sleep(.05)

    number = server.job(*line)
    some_progress(number)
    server.json(f'api/jobs/{number}/stop', 'POST')
    expect('stopped', server.wait(number)['state'], 'stopped')
    partial = [name for name in os.listdir(f'{server.folder}/room.pov.studio') if 'partial' in name]
    expect('rows are kept', len(partial) > 0, True)
    server.job(*line)
    time.sleep(1)
    server.end()
    server.__init__(folder=server.folder)
    expect('resumed', server.wait(server.job(*line))['state'], 'done')
    expect('the same', open(f'{server.folder}/room.pov.studio/parts.exr', 'rb').read() ==
           open(f'{server.folder}/room.pov.studio/whole.exr', 'rb').read(), True)


def crashed(server):
    """The programs of a server that is killed end; it can be started again."""
    server.ask('api/project', 'PUT', project_of(a=1), If_None_Match='*')
    number = server.job(*render('r.exr', '--spp', '100000'))
    server.wait(number, ('running',))
    children = open(f'/proc/{server.process.pid}/task/{server.process.pid}/children').read().split()
    server.process.kill()
    server.process.wait()
    for _ in range(500):
        if not os.path.exists(f'/proc/{children[0]}') or ') Z ' in open(f'/proc/{children[0]}/stat').read():
            break
        time.sleep(.01)
    else:
        print('the render runs on')
    server.__init__(folder=server.folder)
    expect('project', server.json('api/project')['a'], 1)


# ---- time ----

def processor_time(server):
    text = open(f'/proc/{server.process.pid}/stat').read().rsplit(')', 1)[1].split()
    return int(text[11]) + int(text[12])


def idle(server):
    """With a window that listens, the server takes no processor time."""
    stream = http.client.HTTPConnection('127.0.0.1', server.port, timeout=20)
    stream.request('GET', f'/{server.token}/api/events')
    stream.getresponse().readline()
    time.sleep(1)
    before = processor_time(server)
    time.sleep(4)
    expect('ticks', processor_time(server) - before <= 1, True)
    stream.close()


def busy(server):
    """Answers come soon while a render takes all cores."""
    number = server.job(*render('r.exr', '--spp', '1000000'))
    server.wait(number, ('running',))
    time.sleep(.5)
    times = []
    for _ in range(40):
        begin = time.time()
        server.ask('api/state')
        times.append(time.time() - begin)
        time.sleep(.02)
    if sorted(times)[36] > .1:
        print(f'answers take {sorted(times)[36]:.3f} s')
    server.json(f'api/jobs/{number}/stop', 'POST')


def quits(server):
    expect('quit', status(server, 'api/quit', 'POST'), 200)
    expect('exit status', server.process.wait(30), 0)
    server.__init__(folder=server.folder)


for name in sys.argv[1:]:
    server = Server()
    try:
        globals()[name](server)
        server.end()
    finally:
        server.process.kill()
    print(name)
