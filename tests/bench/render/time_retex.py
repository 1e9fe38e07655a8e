"""retex-render's times, in the form of cycles_render.py: time_retex.py SCENE.pov SIZE SAMPLES SEED OUT.exr

Prints a line of JSON: the wall seconds that it says rendering took and the processor seconds of the whole program, with
that many samples and with one, and its counts of paths and rays.
"""
import json
import os
import subprocess
import sys

# Cycles' 8 bounces are those between the camera's segment and the one to the light.
FLAGS = ["--plain", "--max-depth", "10", "--threads", "2", "-q"]


def timed(path, size, samples, seed, out):
    stats = out + ".json"
    command = ["retex-render", *FLAGS, "--size", f"{size}x{size}", "--spp", str(samples), "--seed", seed,
               "--stats", stats, "-o", out, path]
    with subprocess.Popen(command) as process:
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit("bench-render: retex-render failed")
    with open(stats, encoding="ascii") as file:
        return json.load(file), used.ru_utime + used.ru_stime


def main(path, size, samples, seed, out):
    once, whole = timed(path, size, 1, seed, out), timed(path, size, int(samples), seed, out)
    counts = {name: whole[0][name] for name in ("paths", "segments", "shadow_rays")}
    print(json.dumps({"wall": whole[0]["render_seconds"], "wall_once": once[0]["render_seconds"], "cpu": whole[1],
                      "cpu_once": once[1], **counts}))


main(*sys.argv[1:])
