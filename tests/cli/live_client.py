"""A client of `retex-render --live`: it starts the program, sends lines, and reads answers."""
import json
import os
import select
import subprocess
import time

import numpy


class Live:
    def __init__(self, *arguments, stderr=None):
        self.process = subprocess.Popen(['retex-render', '--live', *arguments], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=stderr, bufsize=0)
        self.buffer = b''
        self.hello, _ = self.answer()

    def send(self, *lines):
        self.process.stdin.write(''.join(line + '\n' for line in lines).encode())

    def _fill(self, timeout):
        if not select.select([self.process.stdout], [], [], timeout)[0]:
            raise TimeoutError(f'no answer within {timeout} s')
        more = os.read(self.process.stdout.fileno(), 1 << 20)
        if not more:
            raise EOFError('the program has ended')
        self.buffer += more

    def answer(self, timeout=60):
        """The next answer: its members, and its data."""
        while b'\n' not in self.buffer:
            self._fill(timeout)
        line, self.buffer = self.buffer.split(b'\n', 1)
        head = json.loads(line)
        assert list(head)[-1] == 'bytes', line
        while len(self.buffer) < head['bytes']:
            self._fill(timeout)
        data, self.buffer = self.buffer[:head['bytes']], self.buffer[head['bytes']:]
        return head, data

    def is_quiet(self, seconds):
        """Whether nothing more comes for some time."""
        return not self.buffer and not select.select([self.process.stdout], [], [], seconds)[0]

    def ask(self, line):
        """The answer to one line that has one, whatever pictures come before it."""
        self.send(line)
        while True:
            head, data = self.answer()
            if 'picture' not in head:
                return head, data

    def denoise(self):
        """Ask for a denoised picture; the answer, but of a view that runs the next picture of that may come first."""
        self.send('denoise')
        return self.answer()

    def view(self, width, height, camera, spp):
        """All pictures of a view, each as its number of samples and RGBA."""
        self.send(f'view {width} {height} {camera} {spp}')
        pictures = []
        while not pictures or pictures[-1][0] != spp:
            head, data = self.answer()
            assert 'error' not in head, head
            if head['width'] == width and head['height'] == height:
                pictures.append((head['picture'], rgba(head, data)))
        return pictures

    def end(self):
        """Close standard input; the exit status."""
        self.process.stdin.close()
        rest = self.process.stdout.read()
        return self.process.wait(20), rest


def rgba(head, data):
    return numpy.frombuffer(data, numpy.float16).reshape(head['height'], head['width'], 4)


def clock():
    return time.monotonic()
