"""Models for tests and pictures, as lists of triangles: ((x, y, z), (x, y, z), (x, y, z))."""

import math
import struct


def write_stl(path, triangles):
    with open(path, "wb") as file:
        file.write(b"made by a test".ljust(80) + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            corners = [coordinate for corner in triangle for coordinate in corner]
            file.write(struct.pack("<12fH", 0, 0, 0, *corners, 0))


def box(low, high):
    corner = [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [[corner[q[i]] for i in ids] for q in quads for ids in ((0, 1, 2), (0, 2, 3))]


def torus(big, small, rings, sides):
    def point(i, j):
        u, v = 2 * math.pi * (i % rings) / rings, 2 * math.pi * (j % sides) / sides
        r = big + small * math.cos(v)
        return (r * math.cos(u), r * math.sin(u), small * math.sin(v))

    triangles = []
    for i in range(rings):
        for j in range(sides):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            triangles += [(a, b, c), (a, c, d)]
    return triangles


def turned(profile, sides=48, lobes=0, depth=0.0, twist=0.0):
    """What a line of points (radius, height) sweeps around the Z axis, closed by discs below and
    above; `lobes` waves around of the share `depth` of the radius, turned by `twist` up to the top."""
    top = profile[-1][1]

    def point(k, i):
        r, z = profile[k]
        angle = 2 * math.pi * (i % sides) / sides
        turn = twist * z / top
        r *= 1 + depth * math.cos(lobes * (angle - turn))
        return (r * math.cos(angle), r * math.sin(angle), z)

    triangles = []
    for i in range(sides):
        triangles.append(((0, 0, profile[0][1]), point(0, i + 1), point(0, i)))
        for k in range(len(profile) - 1):
            a, b, c, d = point(k, i), point(k, i + 1), point(k + 1, i + 1), point(k + 1, i)
            triangles += [(a, b, c), (a, c, d)]
        triangles.append(((0, 0, top), point(-1, i), point(-1, i + 1)))
    return triangles


def dome(radius=14, rim=9, curvature=60, sides=48):
    """A cylinder whose top is a piece of a sphere; its foot's middle is at 0, 0, 0."""
    below = rim - math.sqrt(curvature ** 2 - radius ** 2)
    top = [below + math.sqrt(curvature ** 2 - r ** 2) for r in (*range(radius, 0, -2), 0.2)]
    return turned([(radius, 0), *zip((*range(radius, 0, -2), 0.2), top)], sides)


def sleeve(outer=8, inner=6, length=16, sides=48):
    """A tube that lies along x."""
    def point(i, radius, x):
        angle = 2 * math.pi * (i % sides) / sides
        return (x, radius * math.cos(angle), radius * math.sin(angle))

    triangles = []
    for i in range(sides):
        for a, b in (((outer, 0), (outer, length)), ((outer, length), (inner, length)),
                     ((inner, length), (inner, 0)), ((inner, 0), (outer, 0))):
            p, q, r, s = point(i, *a), point(i + 1, *a), point(i + 1, *b), point(i, *b)
            triangles += [(p, q, r), (p, r, s)]
    return triangles


def moved(triangles, x, y, z=0):
    return [[(p[0] + x, p[1] + y, p[2] + z) for p in triangle] for triangle in triangles]


def prism(outlines, low, high):
    """Outlines are convex rings of points (x, y), counter-clockwise, each a piece of its own."""
    triangles = []
    for ring in outlines:
        for i in range(len(ring)):
            (ax, ay), (bx, by) = ring[i], ring[(i + 1) % len(ring)]
            a, b, c, d = (ax, ay, low), (bx, by, low), (bx, by, high), (ax, ay, high)
            triangles += [(a, b, c), (a, c, d)]
        for i in range(1, len(ring) - 1):
            triangles.append([(*ring[j], low) for j in (0, i + 1, i)])
            triangles.append([(*ring[j], high) for j in (0, i, i + 1)])
    return triangles


def plate_with_hole(half, height, radius, sides=32):
    """A square plate with a round hole through its middle."""
    def outer(i):
        angle = 2 * math.pi * (i % sides) / sides
        c, s = math.cos(angle), math.sin(angle)
        k = half / max(abs(c), abs(s))
        return k * c, k * s

    def inner(i):
        angle = 2 * math.pi * (i % sides) / sides
        return radius * math.cos(angle), radius * math.sin(angle)

    triangles = []
    for i in range(sides):
        a, b, c, d = outer(i), outer(i + 1), inner(i + 1), inner(i)
        for (p, q), (z, w) in (((a, b), (0, height)), ((c, d), (0, height))):
            triangles += [((*p, z), (*q, z), (*q, w)), ((*p, z), (*q, w), (*p, w))]
        triangles += [((*a, height), (*b, height), (*c, height)),
                      ((*a, height), (*c, height), (*d, height))]
        triangles += [((*a, 0), (*c, 0), (*b, 0)), ((*a, 0), (*d, 0), (*c, 0))]
    return triangles
