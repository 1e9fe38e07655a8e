"""Textures and normal maps for normals.t, as PPM: waves of up to 10 degrees; the same turned and mirrored beforehand."""
import math

SIZE = 64


def write(name, pixels):
    with open(name + ".ppm", "wb") as file:
        file.write(b"P6 %d %d 255\n" % (SIZE, SIZE))
        file.write(bytes(min(255, max(0, round(channel))) for row in pixels for pixel in row for channel in pixel))


def encoded(normal):
    return [127.5 + 127.5 * component for component in normal]


def wave(row, column, degrees):
    """The normal of waves along two directions: x to the right, y up."""
    u, v = (column + 0.5) / SIZE, 1 - (row + 0.5) / SIZE
    a, b = math.cos(2 * math.pi * (2 * u + v)), math.cos(2 * math.pi * (3 * v - u))
    slope = math.tan(math.radians(degrees)) / 5
    x, y = slope * (2 * a - b), slope * (a + 3 * b)
    length = math.sqrt(x * x + y * y + 1)
    return x / length, y / length, 1 / length


def rows(value):
    return [[value(row, column) for column in range(SIZE)] for row in range(SIZE)]


def color(row, column):
    return 90 + 2 * row, 200 - 2 * column, 160 if (row // 8 + column // 16) % 2 else 90


def main():
    last = SIZE - 1
    for degrees in (10, 30):
        write(f"waves{degrees}", rows(lambda r, c, d=degrees: encoded(wave(r, c, d))))
    write("flat", rows(lambda r, c: (128, 128, 255)))
    write("other", rows(lambda r, c: (127, 128, 255)))
    steep = math.radians(30)  # every texel the other way than its neighbour: flat on average
    write("ridges", rows(lambda r, c: encoded(((-1) ** c * math.sin(steep), 0, math.cos(steep)))))
    steep = math.radians(75)  # so steep that the sum of three normals is below 0
    write("steep", rows(lambda r, c: encoded(((-1) ** (r // 16 + c // 16) * math.sin(steep), 0, math.cos(steep)))))
    write("color", rows(color))

    def down(r, c):
        red, green, blue = encoded(wave(r, c, 10))
        return red, 255 - green, blue

    write("waves_nor_dx", rows(down))
    write("plain_down", rows(down))

    # Laid with rotate=90, (u, v) shows what is at (1 - v, u), and what points right there points down here.
    def turned(r, c):
        x, y, z = wave(last - c, r, 10)
        return encoded((y, -x, z))

    write("turned", rows(turned))
    write("turned_color", rows(lambda r, c: color(last - c, r)))

    def flipped(r, c):
        x, y, z = wave(r, last - c, 10)
        return encoded((-x, y, z))

    write("flipped", rows(flipped))
    write("flipped_color", rows(lambda r, c: color(r, last - c)))


main()
