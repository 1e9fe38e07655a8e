"""What run.sh measured: lines of scene, renderer and JSON, one a turn."""
import json
from statistics import median


class Run:
    """Net seconds are those of all samples without what is done once, which a rendering of one sample tells."""

    def __init__(self, size, figures):
        self.size, self.figures, self.paths = size, figures, figures["paths"]
        self.samples = self.paths / size ** 2
        share = self.samples / (self.samples - 1)
        self.wall = (figures["wall"] - figures["wall_once"]) * share
        self.cpu = (figures["cpu"] - figures["cpu_once"]) * share


def read(path):
    """Of scene and renderer, the turns: Run, or the figures of embree."""
    found = {}
    with open(path, encoding="ascii") as file:
        for line in file:
            scene, size, renderer, figures = line.split(" ", 3)
            figures = json.loads(figures)
            found.setdefault(scene, {}).setdefault(renderer, []).append(
                figures if renderer == "embree" else Run(int(size), figures))
    return found


def middle(values):
    """Median and range."""
    values = list(values)
    return f"{median(values):.2f} ({min(values):.2f} .. {max(values):.2f})"
