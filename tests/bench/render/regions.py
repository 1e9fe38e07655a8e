"""Parts of a picture of which both renderers must have the same mean radiance."""
import numpy as np

LIMIT, DEVIATIONS = 0.01, 3
EYE, HALF_ANGLE = 3.9, 20
MARGIN = 0.12                                                 # of a wall's edges
BALLS, NEAR = [(-0.4, -0.6, 0.3), (0.4, -0.6, -0.2)], 0.55    # their radius is 0.4
ROWS = COLUMNS = 4


def walls(size):
    """What the camera sees of each in the Cornell box, away from edges, balls and lamp; y is up, z into the picture."""
    at = (np.arange(size) + 0.5) / size * 2 - 1
    x, y = np.meshgrid(at, -at)
    ray = np.stack([x, y, np.full_like(x, 1 / np.tan(np.radians(HALF_ANGLE)))], -1)
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    eye, clear = np.array([0, 0, -EYE]), np.ones_like(x, bool)
    for ball in BALLS:
        to = np.array(ball) - eye
        clear &= np.linalg.norm(np.cross(np.broadcast_to(to, ray.shape), ray), axis=-1) > NEAR
    planes = {"floor": (1, -1), "ceiling": (1, 1), "back": (2, 1), "left": (0, -1), "right": (0, 1)}
    found = {}
    for name, (axis, where) in planes.items():
        with np.errstate(divide="ignore"):
            t = (where - eye[axis]) / ray[..., axis]
        hit = eye + t[..., None] * ray
        inside = (np.abs(np.delete(hit, axis, -1)) < 1 - MARGIN).all(-1)
        lamp = (np.abs(hit[..., [0, 2]]) < 0.45).all(-1) & (name == "ceiling")
        found[name] = (t > 0) & inside & clear & ~lamp
    return found


def grid(size):
    row, column = np.arange(size) * ROWS // size, np.arange(size) * COLUMNS // size
    return {f"{'ABCDEFGH'[r]}{c + 1}": (row == r)[:, None] & (column == c)
            for r in range(ROWS) for c in range(COLUMNS)}


def variance(pictures, reference, mask):
    """Of the mean of a picture's region. Pixels are independent; their own errors tell how noisy they are."""
    errors = np.mean([(p.mean(-1) - reference.mean(-1))[mask] ** 2 for p in pictures])
    return errors / mask.sum()


def compare(scene, references, pictures, share):
    """pictures: of each renderer, new for retex, so that they show whether a renderer that changed still has the mean
    of its reference. share: their number of samples over the references'. False if a mean differs by more than LIMIT
    and what noise explains."""
    print(f"  mean radiance of the converged pictures, and of {len(pictures['retex'])} new ones of retex"
          + ("" if scene == "cornell" else "; A is the top row, 1 the left column"))
    print(f"  {'':<12}{'pixels':>10}{'retex':>10}{'Cycles':>10}{'off by':>10}{'noise':>10}{'new ones':>10}")
    agree = True
    new = np.mean(pictures["retex"], axis=0)
    for name, mask in (walls if scene == "cornell" else grid)(len(new)).items():
        ours, theirs, now = (p[mask].mean() for p in (references["retex"], references["cycles"], new))
        noise = np.sqrt(share / (1 + share) * sum(variance(pictures[r], references[r], mask) for r in references))
        allowed = LIMIT * theirs + DEVIATIONS * noise
        good = abs(ours - theirs) <= allowed
        agree &= good
        print(f"  {name:<12}{mask.sum():>10}{ours:>10.4f}{theirs:>10.4f}{100 * (ours / theirs - 1):>+9.2f}%"
              f"{100 * noise / theirs:>9.2f}%{100 * (now / theirs - 1):>+9.2f}%"
              f"{'' if good else f'  more than {100 * allowed / theirs:.1f} %'}")
    return agree
