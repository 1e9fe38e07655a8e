"""Requests whose bytes two programs may read differently, which is how one request is hidden in another: RFC 9112. Each
of BAD is to be refused, and its connection closed; each of GOOD is to be answered as it says.
"""
import re
import socket

INNER = b"GET /v1 HTTP/1.1\r\nHost: x\r\n\r\n"
_N = len(INNER)


def _get(*lines, rest=b"", end=b"\r\n"):
    return end.join([b"GET /v1 HTTP/1.1", *lines, b"", b""]) + rest


def _post(*lines, rest=b""):
    return b"\r\n".join([b"POST /v1/uploads HTTP/1.1", *lines, b"", b""]) + rest


_HOST = b"Host: x"
_CHUNKED = b"Transfer-Encoding: chunked"

BAD = {
    "TE and CL": _get(_HOST, b"Content-Length: %d" % (5 + _N), _CHUNKED, rest=b"0\r\n\r\n" + INNER),
    "TE and CL of an upload": _post(_HOST, b"Content-Length: 3", _CHUNKED, rest=b"3\r\nabc\r\n0\r\n\r\n" + INNER),
    "CL and TE of an upload": _post(_HOST, _CHUNKED, b"Content-Length: 3", rest=b"3\r\nabc\r\n0\r\n\r\n" + INNER),
    "space before the colon of TE": _get(_HOST, b"Transfer-Encoding : chunked", rest=b"0\r\n\r\n" + INNER),
    "tab before the colon of CL": _get(_HOST, b"Content-Length\t: %d" % _N, rest=INNER),
    "space before the colon of CL": _get(_HOST, b"Content-Length : %d" % _N, rest=INNER),
    "CL of 0, and another": _get(_HOST, b"Content-Length: 0", b"Content-Length: %d" % _N, rest=INNER),
    "CL, and another of 0": _get(_HOST, b"Content-Length: %d" % _N, b"Content-Length: 0", rest=INNER),
    "CL twice the same": _get(_HOST, b"Content-Length: 0", b"Content-Length: 0", rest=INNER),
    "CL twice in one line": _get(_HOST, b"Content-Length: 0, 0", rest=INNER),
    "CL of an upload twice": _post(_HOST, b"Content-Length: 3", b"Content-Length: 40", rest=b"abc" + INNER),
    "CL of +0": _get(_HOST, b"Content-Length: +0", rest=INNER),
    "CL of -1": _get(_HOST, b"Content-Length: -1", rest=INNER),
    "CL in hexadecimal": _post(_HOST, b"Content-Length: 0x3", rest=b"abc" + INNER),
    "CL that is empty": _post(_HOST, b"Content-Length:", rest=INNER),
    "CL with a space inside": _post(_HOST, b"Content-Length: 3 0", rest=b"abc" + INNER),
    "CL beyond 64 bits": _post(_HOST, b"Content-Length: 18446744073709551619", rest=b"abc" + INNER),
    "folded CL": _get(_HOST, b"X: y", b" Content-Length: %d" % _N, rest=INNER),
    "folded TE": _post(_HOST, b"X: y", b"\tTransfer-Encoding: chunked", b"Content-Length: 0", rest=INNER),
    "folded first line": _get(b" Host: x", _HOST, rest=INNER),
    "folded value": _get(_HOST, b"Content-Length:", b" %d" % _N, rest=INNER),
    "fold of blanks": _get(_HOST, b"X: y", b"  ", b"Z: w", rest=INNER),
    "fold at the end": _get(_HOST, b"X: y", b" z", rest=INNER),
    "bare CR": _get(_HOST, b"X: a\rContent-Length: %d" % _N, rest=INNER),
    "bare CR before the name": _get(_HOST, b"\rX: a", rest=INNER),
    "bare CR at the end": _get(_HOST, b"X: a\r", rest=INNER),
    "bare CR in the first line": b"GET /v1\r HTTP/1.1\r\nHost: x\r\n\r\n" + INNER,
    "NUL in a value": _get(_HOST, b"X: a\0b", b"Content-Length: %d" % _N, rest=INNER),
    "NUL at the end of a value": _get(_HOST, b"X: a\0", rest=INNER),
    "NUL in a name": _get(_HOST, b"X\0Y: a", rest=INNER),
    "NUL as a line": _get(_HOST, b"\0", b"Content-Length: %d" % _N, rest=INNER),
    "NUL in the URL": b"GET /v1\0/x HTTP/1.1\r\nHost: x\r\n\r\n" + INNER,
    "control character in a value": _get(_HOST, b"X: a\x0bb", rest=INNER),
    "DEL in a value": _get(_HOST, b"X: a\x7fb", rest=INNER),
    "TE of another kind": _get(_HOST, b"Transfer-Encoding: xchunked", rest=INNER),
    "TE of another kind, of an upload": _post(_HOST, b"Transfer-Encoding: xchunked", rest=b"0\r\n\r\n" + INNER),
    "TE of gzip, chunked": _post(_HOST, b"Transfer-Encoding: gzip, chunked", rest=b"0\r\n\r\n" + INNER),
    "TE twice": _post(_HOST, _CHUNKED, _CHUNKED, rest=b"0\r\n\r\n" + INNER),
    "TE identity and chunked": _post(_HOST, b"Transfer-Encoding: identity", _CHUNKED, rest=b"0\r\n\r\n" + INNER),
    "TE in HTTP/1.0": b"POST /v1/uploads HTTP/1.0\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n" + INNER,
    "two hosts": _get(_HOST, b"Host: y", rest=INNER),
    "the same host twice": _get(_HOST, _HOST, rest=INNER),
    "no host": _get(rest=INNER),
    "an empty host": _get(b"Host:", rest=INNER),
    "a host with a slash": _get(b"Host: x/y", rest=INNER),
    "a host with a space": _get(b"Host: x y", rest=INNER),
    "a name with a space": _get(_HOST, b"X Y: a", rest=INNER),
    "an empty name": _get(_HOST, b": a", rest=INNER),
    "no colon": _get(_HOST, b"X", rest=INNER),
    "no version": b"GET /v1\r\n\r\n" + INNER,
    "a version of the future": b"GET /v1 HTTP/9.9\r\nHost: x\r\n\r\n" + INNER,
    "a version in small letters": b"GET /v1 http/1.1\r\nHost: x\r\n\r\n" + INNER,
    "a method that is no word": b"G\"T /v1 HTTP/1.1\r\nHost: x\r\n\r\n" + INNER,
    "a space in the URL": b"GET /v1/small x HTTP/1.1\r\nHost: x\r\n\r\n" + INNER,
    "a negative chunk": _post(_HOST, _CHUNKED, rest=b"-3\r\nabc\r\n0\r\n\r\n" + INNER),
    "a chunk beyond 64 bits": _post(_HOST, _CHUNKED, rest=b"ffffffffffffffff0\r\nabc\r\n0\r\n\r\n" + INNER),
    "a chunk with a prefix": _post(_HOST, _CHUNKED, rest=b"0x3\r\nabc\r\n0\r\n\r\n" + INNER),
    "a chunk longer than it says": _post(_HOST, _CHUNKED, rest=b"3\r\nabcd\r\n0\r\n\r\n" + INNER),
}
# nginx 1.22 has no doubt where these end: it sends them on, some in another form, or answers them itself
REFUSALS = {400, 403, 404, 405, 413, 414, 501, 505}
ONLY_DIRECT = {"bare CR at the end", "no colon", "control character in a value", "DEL in a value"}

# what to send, and the statuses that come back
GOOD = {
    "no space before the value": (_get(b"Host:x", b"X:"), [200]),
    "tabs and spaces around values": (_get(b"Host: \t x", b"X: \t a b\t "), [200]),
    "names in other letters": (_get(b"hOST: x", b"X-1_2.3~!: a"), [200]),
    "bytes beyond ASCII in a value": (_get(_HOST, b"X: \xc3\xa4\xff"), [200]),
    "hosts": (b"".join(_get(b"Host: " + host) for host in (b"a.example:80", b"[::1]:80", b"a_b-c")), [200] * 3),
    "HTTP/1.0 without a host": (b"GET /v1 HTTP/1.0\r\n\r\n", [200]),
    "no header": (b"GET /health HTTP/1.0\r\n\r\n", [200]),
    "empty lines before": (b"\r\n\r\n" + INNER, [200]),
    "CL of 0": (_get(_HOST, b"Content-Length: 0", rest=INNER), [200, 200]),
    "one after another": (INNER * 3, [200] * 3),
    "many": (_get(_HOST, *(b"X-%d: %s" % (n, b"y" * (n % 97)) for n in range(180)), rest=INNER), [200, 200]),
    "long": (_get(_HOST, b"Cookie: a=" + b"b" * 12000 + b"; c", b"X: y", rest=INNER), [200, 200]),
    "a query and escapes": (b"GET /v1/small/full.jpg?quality=8%30 HTTP/1.1\r\nHost: x\r\n\r\n" + INNER, [200, 200]),
    "an upload in chunks": (_post(_HOST, _CHUNKED, rest=b"3;a=b\r\nabc\r\n0\r\nX: y\r\n\r\n" + INNER), [415, 200]),
    "an upload with a length": (_post(_HOST, b"Content-Length: 3", rest=b"abc" + INNER), [415, 200]),
}


def statuses(port, data, pieces=1, timeout=3, source="127.0.0.1", wanted=0):
    """The statuses that come back, and whether the connection was then closed by the server. After `wanted` statuses it
    does not wait long for more."""
    received, closed, status = b"", True, re.compile(rb"HTTP/1\.[01] (\d{3}) ")
    with socket.create_connection(("127.0.0.1", port), timeout, (source, 0)) as connection:
        try:
            size = -(-len(data) // pieces)
            for at in range(0, len(data), size):
                connection.sendall(data[at:at + size])
            while chunk := connection.recv(65536):
                received += chunk
                if wanted and len(status.findall(received)) >= wanted:
                    connection.settimeout(.1)
        except TimeoutError:
            closed = False
        except OSError:  # reset, as it sent more than was read
            pass
    return [int(found) for found in status.findall(received)], closed


def faults(port, proxied=False):
    """What is wrong with the answers to BAD and GOOD, as lines of text."""
    found = []
    for name, data in BAD.items():
        if proxied and name in ONLY_DIRECT:
            continue
        got, closed = statuses(port, data)
        # libmicrohttpd 0.9.75 sends the head of its own refusal of a Content-Length twice
        if len(set(got)) > 1 or len(got) > 2 or not closed or set(got) - REFUSALS:
            found.append(f"{name}: {got}{'' if closed else ', left open'}")
    for name, (data, wanted) in GOOD.items():
        if proxied:
            continue
        for pieces in 1, 7, len(data) if len(data) < 500 else 40:
            got, _ = statuses(port, data, pieces, timeout=20, wanted=len(wanted))
            if got != wanted:
                found.append(f"{name}: {got}, not {wanted}, in {pieces} pieces")
    return found
