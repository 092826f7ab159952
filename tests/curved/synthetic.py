"""Curved prints whose figures are known, as G-code: layers that fill a part exactly, and what goes wrong on purpose."""
import math

HEAD = "G21\nG90\nM83\n"
FILAMENT = math.pi / 4 * 1.75 ** 2


def between(bottom, height, radius, rings=40, sides=180):
    """Triangles of what lies between z = bottom(r) and bottom(r) + height, r from 0 to `radius`."""
    def point(k, j, top):
        r, a = radius * k / rings, 2 * math.pi * (j % sides) / sides
        return (r * math.cos(a), r * math.sin(a), bottom(r) + (height if top else 0))

    triangles = []
    for j in range(sides):
        for k in range(rings):
            for top in (False, True):
                a, b, c, d = (point(k, j, top), point(k + 1, j, top), point(k + 1, j + 1, top), point(k, j + 1, top))
                turn = (lambda t: t) if top else (lambda t: t[::-1])
                triangles.append(turn([a, b, c]))
                if k > 0:
                    triangles.append(turn([a, c, d]))
        a, b = point(rings, j, False), point(rings, j + 1, False)
        c, d = point(rings, j + 1, True), point(rings, j, True)
        triangles += [[a, b, c], [a, c, d]]
    return triangles


class Writer:
    """G-code in the middle of a bed of 200 x 200 mm, on a machine that may turn the part."""

    def __init__(self):
        self.lines = [HEAD]

    def layer(self, height):
        self.lines.append(f";LAYER_CHANGE\n;HEIGHT:{height:.5f}\n")

    def travel(self, **words):
        self.lines.append("G1 " + " ".join(f"{k}{v:.4f}" for k, v in words.items()) + " F6000\n")

    def bead(self, volume, **words):
        self.lines.append("G1 " + " ".join(f"{k}{v:.4f}" for k, v in words.items()) +
                          f" E{volume / FILAMENT:.6f}\n")

    def save(self, path):
        with open(path, "w") as file:
            file.writelines(self.lines)


def ring_stack(bottom, height, radius, layers, spacing=0.4, flow=1.0, missing=(), shift=(0, 0, 0), shifted=None):
    """Circles around the middle, on layers that are all like `bottom`: each fills the room between itself and its
    neighbours exactly. Layers in `missing` are left out; all, or the one that is `shifted`, are moved by `shift`."""
    out, dr, foot = Writer(), height / layers, min(bottom(radius * k / 100) for k in range(101))
    rings, sides = round(radius / spacing), 180
    spacing = radius / rings
    for layer in range(layers):
        if layer in missing:
            continue
        out.layer(dr)
        by = shift if shifted in (None, layer) else (0, 0, 0)
        for ring in range(rings):
            r = (ring + 0.5) * spacing
            rise, volume = (bottom(r + 1e-4) - bottom(r - 1e-4)) / 2e-4, 2 * math.pi * r * spacing * dr / sides
            # beads hang from the nozzle across the layer: their middles are to be at r
            across = dr / 2 / (1 + rise * rise)
            z, r = bottom(r) - foot + (layer + 0.5) * dr + across, r - across * rise
            place = [{"X": 100 + by[0] + r * math.cos(2 * math.pi * j / sides),
                      "Y": 100 + by[1] + r * math.sin(2 * math.pi * j / sides),
                      "Z": z + by[2]} for j in range(sides + 1)]
            out.travel(**place[0])
            for to in place[1:]:
                out.bead(flow * volume, **to)
    return out


def tube(inner, outer, length, sides=720):
    """A tube along X."""
    def point(i, j):
        r, x = ((inner, 0), (outer, 0), (outer, length), (inner, length))[i % 4]
        a = 2 * math.pi * (j % sides) / sides
        return (x, r * math.cos(a), r * math.sin(a))

    triangles = []
    for j in range(sides):
        for i in range(4):
            a, b, c, d = point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)
            triangles += [[a, b, c], [a, c, d]]
    return triangles


def wound_tube(inner, outer, length, layers, spacing=0.4, step=5, rounds=1):
    """Rings on shells around a mandrel along X, which turns by A below the nozzle; axis at Y = 100, Z = outer."""
    out, dr, count = Writer(), (outer - inner) / layers, round(length / spacing)
    for layer in range(layers):
        out.layer(dr)
        low, r = inner + layer * dr, inner + (layer + 1) * dr
        for i in range(count):
            x = 100 - length / 2 + (i + 0.5) * length / count
            out.travel(X=x, Y=100, Z=outer + r, A=0)
            volume = math.pi * (r * r - low * low) * length / count
            for j in range(step, 361, step):
                out.bead(volume * step / 360 * rounds, X=x, Y=100, Z=outer + r, A=j)
    return out
