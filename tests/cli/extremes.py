#!/usr/bin/python3
"""No tool writes what another one refuses: random scenes with extreme numbers are rendered with all AOVs, and the sets
checked, denoised, packed and combined.

extremes.py COUNT [FIRST] [FOLDER]    scenes of the seeds FIRST, FIRST + 1, …; files in FOLDER, default the current one

A render may refuse a scene, in one line. Prints what is wrong, and how many sets there were. Exit status 1: something
is wrong; the scene is kept as FOLDER/SEED.pov."""
import os
import random
import subprocess
import sys

EXTREME = ["0", "-0", "1e-320", "1e-45", "1e-38", "1e-20", "1e-10", "1e-4", "1e4", "65504", "65520", "7e4", "1e9", "1e19",
           "1e30", "1e38", "3.4028235e38", "3.5e38", "1e40", "1e77", "1e154", "1e300", "1e308*10", "-1e308*10",
           "(1e308*10-1e308*10)", "-1", "-1e-3", "-1e10", "-1e39"]
SECONDS = 60


class Scene:
    def __init__(self, seed):
        self.random = random.Random(seed)
        # Few of a scene's numbers are extreme, or it would show nothing.
        self.share = self.random.choice([0.02, 0.05, 0.1, 0.3])

    def number(self, low, high):
        r = self.random
        return r.choice(EXTREME) if r.random() < self.share else f"{r.uniform(low, high):.3g}"

    def vector(self, low, high):
        return "<" + ",".join(self.number(low, high) for _ in range(3)) + ">"

    def colour(self):
        r = self.random
        kind = r.choice(["rgb", "rgb", "rgb", "rgbf", "rgbt"])
        return f"{kind} <" + ",".join(self.number(0, 1) for _ in range(3 if kind == "rgb" else 4)) + ">"

    def pigment(self):
        r = self.random
        pattern = r.choice(["checker", "bozo", "gradient x", "marble", "granite", "agate", "wood", "crackle"])
        if r.random() < 0.5:
            return f"pigment {{ {self.colour()} }}"
        if pattern == "checker":
            body = f"checker {self.colour()}, {self.colour()}"
        else:
            body = f"{pattern} color_map {{ [0 {self.colour()}] [{self.number(0, 1)} {self.colour()}] [1 {self.colour()}] }}"
        if r.random() < 0.4:
            body += f" scale {self.vector(0.2, 2)}"
        if r.random() < 0.3:
            body += f" translate {self.vector(-1, 1)}"
        if r.random() < 0.3:
            body += f" turbulence {self.number(0, 1)}"
        if r.random() < 0.3:
            body = "uv_mapping " + body
        return f"pigment {{ {body} }}"

    def finish(self):
        r = self.random
        names = ["ambient", "diffuse", "emission", "specular", "roughness", "phong", "phong_size", "brilliance",
                 "metallic", "reflection"]
        chosen = r.sample(names, r.randint(0, 4))
        return "finish { " + " ".join(f"{name} {self.number(0.01, 1)}" for name in chosen) + " }"

    def normal(self):
        r = self.random
        if r.random() < 0.8:
            return ""
        return f"normal {{ {r.choice(['bumps', 'ripples', 'dents'])} {self.number(0, 1)} scale {self.number(.1, 1)} }}"

    def texture(self):
        return f"texture {{ {self.pigment()} {self.normal()} {self.finish()} }}"

    def thing(self):
        r = self.random
        shape = r.choice([
            f"sphere {{ {self.vector(-1, 1)}, {self.number(.3, 1)}",
            f"box {{ {self.vector(-1, 0)}, {self.vector(0, 1)}",
            f"cylinder {{ {self.vector(-1, 0)}, {self.vector(0, 1)}, {self.number(.2, .6)}",
            f"cone {{ {self.vector(-1, 0)}, {self.number(.2, .6)}, {self.vector(0, 1)}, {self.number(0, .3)}",
            f"torus {{ {self.number(.5, 1)}, {self.number(.1, .4)}",
            f"disc {{ {self.vector(-1, 1)}, {self.vector(-1, 1)}, {self.number(.5, 1)}",
            f"triangle {{ {self.vector(-1, 1)}, {self.vector(-1, 1)}, {self.vector(-1, 1)}",
            f"superellipsoid {{ <{self.number(.2, 1)}, {self.number(.2, 1)}>",
        ])
        texture = "texture { Target }" if r.random() < 0.4 else self.texture()
        more = "".join(f" {word} {self.vector(.5, 1.5)}" for word in ("scale", "rotate", "translate") if r.random() < .2)
        if r.random() < 0.2:
            more += f" interior {{ ior {self.number(1, 2)} fade_distance {self.number(1, 2)} fade_power 1 }}"
        return f"{shape} {texture}{more} }}"

    def text(self):
        r = self.random
        lines = ["#version 3.7; global_settings { assumed_gamma 1 }",
                 f"camera {{ location <0,1,-4> look_at 0 angle {self.number(40, 60)} }}",
                 f"#declare Target = {self.texture()}",
                 f"light_source {{ {self.vector(-3, 3)}, {self.colour()}"
                 + (f" fade_distance {self.number(1, 3)} fade_power {self.number(1, 2)}" if r.random() < .3 else "") + " }",
                 f"plane {{ y, {self.number(-1.5, -1)} texture {{ Target }} }}"]
        if r.random() < 0.3:
            lines.append(f"background {{ {self.colour()} }}")
        if r.random() < 0.2:
            lines.append(f"sky_sphere {{ {self.pigment()} }}")
        if r.random() < 0.15:
            lines.append(f"fog {{ distance {self.number(1, 20)} {self.colour()} }}")
        if r.random() < 0.1:
            lines.append(f"media {{ scattering {{ 1, {self.colour()} }} absorption {self.colour()} "
                         f"emission {self.colour()} }}")
        lines += [self.thing() for _ in range(r.randint(1, 4))]
        return "\n".join(lines) + "\n"

    def options(self):
        r = self.random
        options = ["--size", "16x12", "--spp", r.choice(["2", "4"]), "-t", "Target"]
        options += ["--aov", "depth,albedo,normal,position,uv,object,roughness,metallic,irradiance,albedo_mean,normal_mean"]
        options += r.choice([[], [], ["--layout", "paper"]])
        options += r.choice([[], [], ["--full-precision"], ["--denoise"]])
        options += r.choice([[], [], [], ["--control-data", "biased"], ["--ambient"]])
        if "paper" not in options and "--control-data" not in options:
            options += r.choice([[], ["--lamps", "each"]])
        return options


def run(*command):
    """The exit status and the lines of standard error that are no warnings."""
    try:
        done = subprocess.run(command, capture_output=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return -1, [f"more than {SECONDS} s"]
    lines = done.stderr.decode(errors="replace").splitlines()
    return done.returncode, [line for line in lines if ": warning: " not in line]


def uses(name, is_denoised, has_lamps):
    """What other tools do with a set: commands that must succeed."""
    yield ["retex-info", "-q", "--check", name]
    yield ["retex-combine", "-q", name, "-o", "own.exr"]
    yield ["retex-combine", "-q", name, "--texture", "Target=rgb(.2,.4,.8)", "-o", "c.png"]
    yield ["retex-sample", "-q", name, "--texture", "Target=rgb(.2,.4,.8)", "-o", "t.exr"]
    yield ["retex-combine", "-q", name, "t.exr", "-o", "c.exr"]
    yield ["retex-pack", "-q", name, "-o", "p.retex"]
    yield ["retex-pack", "-q", "--lossless", name, "-o", "l.retex"]
    if not is_denoised:
        yield ["retex-denoise", "-q", name, "-o", "d.exr"]
    for made in ("p.retex", "l.retex") if is_denoised else ("p.retex", "l.retex", "d.exr"):
        yield ["retex-info", "-q", "--check", made]
        yield ["retex-combine", "-q", made, "--texture", "Target=rgb(.2,.4,.8)", "-o", "c.exr"]
        if has_lamps:
            yield ["retex-combine", "-q", made, "--solo", "light1", "-o", "c.exr"]
            yield ["retex-combine", "-q", made, "--light", "light1=1e3*2700K", "--texture", "Target=tomato", "-o", "c.png"]


def check(seed):
    """What is wrong, or None; and whether there was a set."""
    scene = Scene(seed)
    with open("scene.pov", "w", encoding="ascii") as file:
        file.write(scene.text())
    options = scene.options()
    status, lines = run("retex-render", "-q", *options, "scene.pov", "-o", "s.exr")
    if status:
        fine = status == 2 and len(lines) == 1 and not os.path.exists("s.exr")
        return (None if fine else f"render: {status} {lines}"), False
    if lines:
        return f"render: {lines}", True
    for command in uses("s.exr", "--denoise" in options, "--lamps" in options):
        status, lines = run(*command)
        if status or lines:
            return f"{' '.join(command)}: {status} {lines} after {' '.join(options)}", True
    return None, True


def main():
    count = int(sys.argv[1])
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    if len(sys.argv) > 3:
        os.chdir(sys.argv[3])
    wrong = sets = 0
    for seed in range(first, first + count):
        problem, is_set = check(seed)
        sets += is_set
        if problem:
            wrong += 1
            os.rename("scene.pov", f"{seed}.pov")
            print(f"{seed}: {problem}")
        for name in ("s.exr", "own.exr", "c.png", "c.exr", "t.exr", "p.retex", "l.retex", "d.exr"):
            if os.path.exists(name):
                os.remove(name)
    print(f"{sets} sets of {count} scenes, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
