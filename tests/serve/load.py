"""retex-serve under load: many clients, a full queue, kills and restarts, and its processor time beside a batch's."""
import hashlib
import os
import random
import re
import subprocess
import threading
import time

from serving import Server, Tap, fetch, metric, wait_until

# Two thirds of the requests are for a few pictures, the others for pictures that nobody asked for before.
WRK = """
local seed = {seed}
function setup(thread) seed = seed + 1; thread:set("seed", seed) end
function init(args) math.randomseed(seed) end
local names = {{"brick", "damask", "fans", "terrazzo"}}
function request()
    local path
    if math.random(3) > 1 then
        path = "/v1/small/Floor=" .. names[math.random(4)] .. "/" .. 80 * math.random(4) .. "x.jpg"
    else
        path = string.format("/v1/small/Floor=rgb(%.4f,%.4f,.3);Wall=%s;Wall.rotate=%d/320x.jpg", math.random(),
                             math.random(), names[math.random(4)], math.random(360))
    end
    return wrk.format("GET", path)
end
"""


def measure_clients(server, seconds, work):
    """64 clients of wrk: what it prints, and figures."""
    script, sizes = os.path.join(work, "load.lua"), []
    with open(script, "w", encoding="ascii") as file:
        file.write(WRK.format(seed=1))
    before = metric(server, "processor_seconds_total")
    process = subprocess.Popen(["wrk", "-t2", "-c64", f"-d{seconds}s", "--timeout", "30s", "--latency", "-s", script,
                                f"http://127.0.0.1:{server.port}"], stdout=subprocess.PIPE, text=True)
    while process.poll() is None:
        sizes.append(server.memory())
        time.sleep(seconds / 40)
    text = process.stdout.read()
    process.stdout.close()
    rate, p99 = re.search(r"Requests/sec:\s+([\d.]+)", text), re.search(r"99%\s+([\d.]+)(us|ms|s|m)\b", text)
    errors = re.findall(r"(?:Socket errors|Non-2xx or 3xx responses): (.*)", text)
    return text, {"errors": sum(int(count) for line in errors for count in re.findall(r"\d+", line)),
                  "answers_per_s": float(rate[1]) if rate else 0,
                  "p99_s": float(p99[1]) * {"us": 1e-6, "ms": 1e-3, "s": 1, "m": 60}[p99[2]] if p99 else 0,
                  "processor_s": metric(server, "processor_seconds_total") - before,
                  "memory_mb_early": max(sizes[len(sizes) // 4:len(sizes) // 2]),
                  "memory_mb_late": max(sizes[-len(sizes) // 4:])}


def check_clients(server, seconds, work):
    text, figures = measure_clients(server, seconds, work)
    Tap.note(f"64 clients for {seconds} s: {figures}")
    Tap.result(figures["answers_per_s"] > 1 and not figures["errors"], "64 clients: no error", text.replace("\n", " | "))
    Tap.result(figures["memory_mb_late"] < 1.1 * figures["memory_mb_early"] + 16, "memory does not grow under load")


def color(rng):
    return ",".join(f"{rng.random():.5f}" for _ in range(3))


def check_queue(rooms, textures, log):
    """One thread, two places in the queue, forty requests at once."""
    server = Server(rooms, textures, "--threads", "1", "--queue", "2", "-q", log=log)
    rng, replies = random.Random(3), []
    fetch(server.port, "/v1/small/Floor=brick/full.png")
    paths = [f"/v1/small/Floor=brick;Wall=rgb({color(rng)})/full.png" for _ in range(40)]
    threads = [threading.Thread(target=lambda p=path: replies.append(fetch(server.port, p))) for path in paths]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    busy = [r for r in replies if r.status == 503]
    Tap.note(f"40 requests, 2 may wait: {len(busy)} answered by 503")
    Tap.result(busy and all(r["Retry-After"].isdigit() and "no-store" in r["Cache-Control"] for r in busy) and
               sum(r.status == 200 for r in replies) == 40 - len(busy) >= 1,
               "what does not fit into the queue gets 503 with Retry-After")
    again = [fetch(server.port, path).status for path in paths[:5]]
    Tap.result(again == [200] * 5, "and is served later", str(again))
    status, _ = server.stop()
    Tap.result(status == 0, "the server ends when it is told to", str(status))


def digest_of(folder):
    digest = hashlib.sha256()
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), "rb") as file:
            digest.update(name.encode() + hashlib.sha256(file.read()).digest())
    return digest.hexdigest()


def check_kills(rooms, textures, log, kills):
    """Killed under load and started again, as its unit does. Each reply is complete and right, or there is none."""
    paths = [f"/v1/small/Floor={name};Wall=rgb(.{n},.3,.2)/240x.png" for name in ("brick", "fans") for n in range(1, 9)]
    server = Server(rooms, textures, "-q", log=log)
    port = server.port
    right = {path: hashlib.sha256(fetch(port, path).body).digest() for path in paths}
    before, wrong, counts, ended = digest_of(rooms) + digest_of(textures), [], [0, 0], threading.Event()
    down = threading.Event()

    def run(number):
        rng = random.Random(number)
        while not ended.is_set():
            path, began_down = rng.choice(paths), down.is_set()
            try:
                reply = fetch(port, path, timeout=30)
            except Exception:  # no reply, or a part of one: the connection was lost
                counts[1] += 1
                if not began_down and not down.is_set():
                    wrong.append(f"{path}: lost while the server was up")
                time.sleep(0.05)
                continue
            counts[0] += 1
            if reply.status != 200 or hashlib.sha256(reply.body).digest() != right[path]:
                wrong.append(f"{path}: {reply.status}, {len(reply.body)} bytes")

    threads = [threading.Thread(target=run, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for _ in range(kills):
        time.sleep(1)
        down.set()
        server.kill()
        server = Server(rooms, textures, "-q", log=log, port=port)
        wait_until(lambda: fetch(port, "/health").status == 200)
        time.sleep(0.5)  # requests that were lost with the old process have ended
        down.clear()
    time.sleep(1)
    ended.set()
    for thread in threads:
        thread.join()
    Tap.note(f"{kills} kills under load: {counts[0]} replies, {counts[1]} connections lost with the server")
    Tap.result(not wrong and counts[0] > kills, "no reply is torn, none is lost but with the server", str(wrong[:5]))
    Tap.result(digest_of(rooms) + digest_of(textures) == before, "rooms and textures are as they were")
    Tap.result(all(hashlib.sha256(fetch(port, path).body).digest() == right[path] for path in paths),
               "the server that was started again serves the same")
    server.stop()


def processor_time(command):
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime if process.returncode == 0 else None


def quoted(wall):
    return f'"rgb({wall})"'


def edits(floor, wall):
    return ";".join((floor and [f"Floor={floor}"] or []) + (wall and [f"Wall=rgb({wall})"] or []))


def measure_throughput(rooms, textures, work, log, count):
    """The server's pictures a second of processor time over the batch's, of three turns, sorted; and whether all were
    the batch's to the byte. The same rows, none cached, of the large room: processes as a whole, so starts and the first
    reading too. Half of the rows change one target: then both sides read what corrects the other."""
    rng, turns, same = random.Random(5), [], True
    names = sorted(os.path.splitext(name)[0] for name in os.listdir(textures))
    rows = [(rng.choice(names), color(rng)) for _ in range(count)]
    rows = [(floor if n % 4 != 1 else "", wall if n % 4 != 2 else "") for n, (floor, wall) in enumerate(rows)]
    table = os.path.join(work, "rows.csv")
    with open(table, "w", encoding="ascii") as file:
        file.write("output,Floor,Wall\n")
        for number, (floor, wall) in enumerate(rows):
            file.write(f"{work}/row{number}.jpg,{floor and f'{textures}/{floor}.jpg'},{wall and quoted(wall)}\n")
    for _ in range(3):
        batch = processor_time(["retex-combine", "-q", "--threads", "1", f"{rooms}/large.retex", "--batch", table])
        server = Server(rooms, textures, "--threads", "1", "-q", log=log)
        replies = [fetch(server.port, f"/v1/large/{edits(*row)}/full.jpg") for row in rows]
        status, served = server.stop()
        turns.append((batch or 0) / served)
        same = same and status == 0 and all(reply.status == 200 for reply in replies)
        for number, reply in enumerate(replies):
            with open(f"{work}/row{number}.jpg", "rb") as file:
                same = same and file.read() == reply.body
        Tap.note(f"{count} pictures, processor time: batch {batch:.2f} s, server {served:.2f} s")
    return sorted(turns), same


def check_throughput(rooms, textures, work, log, count):
    turns, same = measure_throughput(rooms, textures, work, log, count)
    Tap.note(f"the server makes {turns[1]:.3f} times the batch's pictures a second of processor time")
    Tap.result(same, "pictures of 1920x1080 are the batch's to the byte")
    Tap.result(turns[1] >= 0.9, "at least 0.9 of the batch's throughput", f"{turns}")
