# What the tests of retex-serve have in common: a server at a port that the system chooses, and questions to it.
import http.client, os, re, socket, subprocess, sys, time


def start(*options, log='log'):
    if os.path.exists('address'):
        os.remove('address')
    server = subprocess.Popen(['retex-serve', 'rooms', '--port', '0', '-o', 'address', '--threads', '2', *options],
                              stderr=open(log, 'w'))
    for _ in range(2000):
        if os.path.exists('address'):
            server.port = int(open('address').read().strip().rsplit(':', 1)[1])
            return server
        if server.poll() is not None:
            break
        time.sleep(.01)
    sys.exit('no server: ' + open(log).read())


def ask(server, path, method='GET', source='127.0.0.1', **headers):
    connection = http.client.HTTPConnection('127.0.0.1', server.port, timeout=60, source_address=(source, 0))
    connection.request(method, path, headers={name.replace('_', '-'): value for name, value in headers.items()})
    answer = connection.getresponse()
    answer.body = answer.read()
    connection.close()
    return answer


def cover(pixels, count):
    """Rows of pixels as `count` rows, each the mean of what it covers."""
    import numpy
    edges = numpy.arange(count + 1) * len(pixels) / count
    sums = numpy.concatenate([numpy.zeros_like(pixels[:1]), numpy.cumsum(pixels, axis=0)])
    at = numpy.minimum(edges.astype(int), len(pixels) - 1)
    sums = sums[at] + (edges - at)[:, None, None] * pixels[at]
    return (sums[1:] - sums[:-1]) * count / len(pixels)


def send_all(server, paths, headers=''):
    """Sends requests without waiting for an answer, and returns their sockets."""
    clients = []
    for path in paths:
        clients.append(socket.create_connection(('127.0.0.1', server.port), 60))
        clients[-1].sendall(f'GET {path} HTTP/1.1\r\nHost: a\r\nConnection: close\r\n{headers}\r\n'.encode())
    return clients


def receive_all(clients):
    """The answers to what send_all() has sent."""
    answers = []
    for client in clients:
        with client:
            answers.append(http.client.HTTPResponse(client))
            answers[-1].begin()
            answers[-1].body = answers[-1].read()
    return answers


def expect(what, got, wanted):
    if got != wanted:
        print(f'{what}: {got!r}, not {wanted!r}')


def metric(server, name):
    found = re.search('^retex_serve_' + re.escape(name) + ' (.*)$', ask(server, '/metrics').body.decode(), re.M)
    return float(found[1]) if found else 0


def combine(output, *options, told=None):
    subprocess.run(['retex-combine', '-q', *options, '-o', output], check=True, stderr=told)
    return open(output, 'rb').read()


def ended(client):
    """Whether the server has closed a connection."""
    try:
        return client.recv(100) == b''
    except OSError:
        return True


def wait_for(condition, seconds=20, pause=.02):
    until = time.time() + seconds
    while not condition():
        if time.time() > until:
            return False
        time.sleep(pause)
    return True


def send(server, body, path='/v1/uploads', method='POST', source='127.0.0.1', **headers):
    connection = http.client.HTTPConnection('127.0.0.1', server.port, timeout=60, source_address=(source, 0))
    try:
        connection.request(method, path, body, {name.replace('_', '-'): value for name, value in headers.items()})
    except BrokenPipeError:  # the server has answered, and closed, before it had all; its answer is there to be read
        pass
    answer = connection.getresponse()
    answer.body = answer.read()
    connection.close()
    return answer


def run(functions, options, *textures):
    """Starts a server for each function that is named on the command line, with its options, runs it and ends the server.
    Prints what differs, and at last the name of the function."""
    for name in sys.argv[1:]:
        server = start(*textures, *options.get(name, []))
        try:
            functions[name](server)
            print(name)
        finally:
            if server.poll() is None:
                server.terminate()
            try:
                expect('exit status', server.wait(60), 0)
            except subprocess.TimeoutExpired:
                server.kill()
                sys.exit('the server does not end')
