"""Parts that curved layers suit, as lists of triangles (models.py writes them)."""
import math


def surface(top, bottom, columns, rows):
    """What lies between two grids of points, [rows + 1][columns + 1], the one above the other."""
    triangles = []
    for j in range(rows):
        for i in range(columns):
            for grid, up in ((top, True), (bottom, False)):
                a, b, c, d = grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]
                triangles += [[a, b, c], [a, c, d]] if up else [[c, b, a], [d, c, a]]
    edge = ([(j, 0) for j in range(rows, 0, -1)] + [(0, i) for i in range(columns)] +
            [(j, columns) for j in range(rows)] + [(rows, i) for i in range(columns, 0, -1)])
    for (j, i), (l, k) in zip(edge, edge[1:] + edge[:1]):
        a, b, c, d = bottom[j][i], bottom[l][k], top[l][k], top[j][i]
        triangles += [t for t in ([a, b, c], [a, c, d]) if len(set(t)) == 3]
    return triangles


def dome(diameter=24.0, ball=40.0, rim=10.0, rings=24, sides=120):
    """A cap of a ball on a low cylinder."""
    base = diameter / 2
    sunk = math.sqrt(ball * ball - base * base)

    def point(k, j, top):
        r, a = base * k / rings, 2 * math.pi * (j % sides) / sides
        return (r * math.cos(a), r * math.sin(a), rim + math.sqrt(ball * ball - r * r) - sunk if top else 0.0)

    triangles = []
    for j in range(sides):
        for k in range(rings):
            a, b, c, d = point(k, j, True), point(k + 1, j, True), point(k + 1, j + 1, True), point(k, j + 1, True)
            triangles += [[a, b, c]] + ([[a, c, d]] if k else [])
            a, b, c, d = (point(n, i, False) for n, i in ((k, j), (k + 1, j), (k + 1, j + 1), (k, j + 1)))
            triangles += [[c, b, a]] + ([[d, c, a]] if k else [])
        a, b = point(rings, j, False), point(rings, j + 1, False)
        c, d = point(rings, j + 1, True), point(rings, j, True)
        triangles += [[a, b, c], [a, c, d]]
    return triangles


def wing(chord=60.0, span=20.0, thickness=0.08, plate=4.0, columns=90):
    """Half a NACA 00xx section on a plate, along y: flat below, shallow and curved on top. Its nose and its tail are
    cut off: x from -26.4 to 28.8 mm of the chord's middle."""
    def height(t):
        return plate + chord * thickness * 5 * (0.2969 * math.sqrt(t) - 0.1260 * t - 0.3516 * t ** 2 +
                                                0.2843 * t ** 3 - 0.1036 * t ** 4)

    span_of = [0.06 + 0.92 * i / columns for i in range(columns + 1)]
    top = [[(chord * (t - 0.5), y, height(t)) for t in span_of] for y in (-span / 2, span / 2)]
    bottom = [[(x, y, 0.0) for x, y, _ in row] for row in top]
    return surface(top, bottom, columns, 1)


def elbow(bend=30.0, outer=10.0, inner=7.0, degrees=90.0, rings=60, sides=96):
    """A bent pipe, from an opening on the bed (z = 0, around x = 0) around an axis along y at x = -bend."""
    def point(i, j, r):
        u, v = math.radians(degrees) * i / rings, 2 * math.pi * (j % sides) / sides
        far = bend + r * math.cos(v)
        return (far * math.cos(u) - bend, r * math.sin(v), far * math.sin(u))

    triangles = []
    for j in range(sides):
        for i in range(rings):
            for r, outward in ((outer, True), (inner, False)):
                a, b, c, d = point(i, j, r), point(i, j + 1, r), point(i + 1, j + 1, r), point(i + 1, j, r)
                triangles += [[a, b, c], [a, c, d]] if outward else [[c, b, a], [d, c, a]]
        for i, first in ((0, True), (rings, False)):
            a, b, c, d = point(i, j, inner), point(i, j, outer), point(i, j + 1, outer), point(i, j + 1, inner)
            triangles += [[c, b, a], [d, c, a]] if first else [[a, b, c], [a, c, d]]
    return triangles


def volume(triangles):
    total = 0.0
    for (a, b, c) in triangles:
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    return total
