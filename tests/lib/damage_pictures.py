"""damage_pictures.py FROM TO CUTS COUNT SEED: copies of FROM's files in TO, damaged: cut off at the tenths CUTS, such as
159, and COUNT times each with a run of zeros, with one byte flipped in a bit, with a byte missing and with a surplus
one."""
import os
import random
import sys


def damaged(data, kind, chance):
    """The bytes with one damage. It is beyond the first 24, which say what the file is."""
    at = chance.randrange(24, len(data))
    if kind == "zeros":
        length = chance.choice([4, 40, 400])
        return data[:at] + bytes(min(length, len(data) - at)) + data[at + length:]
    if kind == "flip":
        return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1:]
    if kind == "missing":
        return data[:at] + data[at + 1:]
    return data[:at] + bytes([chance.randrange(256)]) + data[at:]


def main():
    source, target, cuts, count = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
    chance = random.Random(int(sys.argv[5]))
    for name in sorted(os.listdir(source)):
        with open(os.path.join(source, name), "rb") as file:
            data = file.read()
        base, ending = os.path.splitext(name)
        copies = {f"cut-{tenth}": data[:len(data) * int(tenth) // 10] for tenth in cuts}
        for kind in "zeros", "flip", "missing", "surplus":
            for number in range(count):
                copies[f"{kind}-{number}"] = damaged(data, kind, chance)
        for kind, copy in copies.items():
            if copy != data:
                with open(os.path.join(target, f"{base}@{kind}{ending}"), "wb") as file:
                    file.write(copy)


if __name__ == "__main__":
    main()
