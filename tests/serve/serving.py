"""What the checks of retex-serve share: a server to start and stop, requests, sizes of received files, TAP."""
import atexit
import http.client
import os
import re
import signal
import struct
import subprocess
import sys
import time


class Tap:
    """Lines of TAP; figures as comments."""
    count = 0

    @classmethod
    def result(cls, passed, name, why=""):
        cls.count += 1
        print(f"{'ok' if passed else 'not ok'} {cls.count} - {name}")
        if not passed and why:
            print(f"# {why}")
        sys.stdout.flush()

    @classmethod
    def skip(cls, name, why):
        cls.count += 1
        print(f"ok {cls.count} - {name} # SKIP {why}")

    @staticmethod
    def note(text):
        print(f"# {text}")
        sys.stdout.flush()

    @classmethod
    def finish(cls):
        print(f"1..{cls.count}")


def end_with_the_checks(process):
    """Kill a process if it is still there at the end, whatever happened."""
    atexit.register(lambda: process.poll() is None and process.kill())


class Server:
    """retex-serve on a port that the system chooses, or that it had before. Its log is kept in a file."""

    def __init__(self, rooms, textures, *options, log, port=0):
        self.log = log
        with open(log, "ab") as messages:
            self.process = subprocess.Popen(
                ["retex-serve", "--port", str(port), "--textures", textures, *options, rooms],
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=messages)
        end_with_the_checks(self.process)
        line = self.process.stdout.readline().decode()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)\n", line)
        if not found:
            raise RuntimeError(f"the server did not start: {line!r}, see {log}")
        self.port = int(found[1])

    def is_alive(self):
        return self.process.poll() is None

    def memory(self):
        """Megabytes of memory that the process has."""
        with open(f"/proc/{self.process.pid}/status") as status:
            return int(re.search(r"VmRSS:\s+(\d+) kB", status.read())[1]) / 1024

    def stop(self):
        """End it as a service manager does. Returns its exit status and the processor time it took."""
        if self.is_alive():
            self.process.send_signal(signal.SIGTERM)
        self.process.stdout.close()
        _, status, usage = os.wait4(self.process.pid, 0)
        self.process.returncode = os.waitstatus_to_exitcode(status)
        return self.process.returncode, usage.ru_utime + usage.ru_stime

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()


class Reply:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    def __getitem__(self, name):
        return self.headers.get(name, "")


def fetch(port, path, method="GET", headers=None, timeout=60, body=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=timeout)
    try:
        try:
            connection.request(method, path, body, headers or {})
        except (BrokenPipeError, ConnectionResetError):  # refused before all was sent; the answer is there to be read
            pass
        reply = connection.getresponse()
        return Reply(reply.status, reply.headers, reply.read())
    finally:
        connection.close()


def metric(server, name):
    found = re.search(f"^retex_serve_{re.escape(name)} (\\S+)$", fetch(server.port, "/metrics").body.decode(), re.M)
    return float(found[1])


def wait_until(condition, seconds=30):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if condition():
            return True
        time.sleep(0.05)
    return False


def size_of(data):
    """Width and height of a JPEG, PNG or WebP by its own headers, or None."""
    if data.startswith(b"\x89PNG\r\n\x1a\n"):
        return struct.unpack(">II", data[16:24])
    if data.startswith(b"RIFF") and data[8:12] == b"WEBP":
        if data[12:16] == b"VP8 ":
            width, height = struct.unpack("<HH", data[26:30])
            return width & 0x3fff, height & 0x3fff
        if data[12:16] == b"VP8L":
            bits = struct.unpack("<I", data[21:25])[0]
            return (bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1
        if data[12:16] == b"VP8X":
            return 1 + int.from_bytes(data[24:27], "little"), 1 + int.from_bytes(data[27:30], "little")
    if data.startswith(b"\xff\xd8"):
        at = 2
        while at + 9 < len(data):
            marker, length = data[at + 1], struct.unpack(">H", data[at + 2:at + 4])[0]
            if 0xc0 <= marker <= 0xcf and marker not in (0xc4, 0xc8, 0xcc):
                height, width = struct.unpack(">HH", data[at + 5:at + 9])
                return width, height
            at += 2 + length
    return None
