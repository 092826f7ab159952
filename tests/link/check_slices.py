"""Random closed meshes, sliced twice: by the library and here, by other means.

    check_slices.py LINK_TOOL

A torus, its edges flipped, split and collapsed at random, gets random integer heights with many
ties (or random real ones, or the z of its vertices). Here opposites come from a dictionary of
edges, and the successor from the digraph of faces (paper, 5d): in a triangle there is one rising
crossing, so it is the one in the neighbour's face. For other faces it is the next rising crossing
around the face. α, β, opposite, successor, colour and g must agree to the last bit.
"""
import subprocess
import sys
import tempfile

import numpy as np

from read_mlk import MultiLink, check_equations, same


def torus(n, m, quads=False):
    def at(i, j):
        return i % n * m + j % m
    u, w = np.divmod(np.arange(n * m), m)
    u, w = 2 * np.pi * u / n, 2 * np.pi * w / m
    places = np.stack([np.sin(w), (2 + np.cos(w)) * np.cos(u), (2 + np.cos(w)) * np.sin(u)], 1)
    faces = []
    for i in range(n):
        for j in range(m):
            q = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1))
            faces += [q] if quads else [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    return faces, places


class Mesh:
    """Triangles by number, and the triangle to the left of each directed edge."""

    def __init__(self, faces, places):
        self.face, self.left = {}, {}
        self.place = [np.array(p) for p in places]
        self.next = 0
        for f in faces:
            self.add(*f)

    def add(self, a, b, c):
        self.face[self.next] = (a, b, c)
        for e in ((a, b), (b, c), (c, a)):
            assert e not in self.left
            self.left[e] = self.next
        self.next += 1

    def drop(self, t):
        a, b, c = self.face.pop(t)
        for e in ((a, b), (b, c), (c, a)):
            del self.left[e]

    def third(self, a, b):
        return sum(self.face[self.left[a, b]]) - a - b

    def flip(self, a, b):
        c, d = self.third(a, b), self.third(b, a)
        if c == d or (c, d) in self.left or (d, c) in self.left:
            return
        self.drop(self.left[a, b])
        self.drop(self.left[b, a])
        self.add(d, b, c)
        self.add(c, a, d)

    def split(self, a, b):
        c, d, m = self.third(a, b), self.third(b, a), len(self.place)
        self.place.append((self.place[a] + self.place[b]) / 2)
        self.drop(self.left[a, b])
        self.drop(self.left[b, a])
        for f in ((a, m, c), (m, b, c), (b, m, d), (m, a, d)):
            self.add(*f)

    def around(self, a):
        return {x for x, y in self.left if y == a}

    def collapse(self, a, b):
        """b into a, where the link condition keeps it a surface."""
        shared = self.around(a) & self.around(b)
        if shared != {self.third(a, b), self.third(b, a)} or len(self.face) <= 12:
            return
        if any(len(self.around(c)) <= 3 for c in shared):
            return
        old = [t for t, f in self.face.items() if b in f]
        new = [self.face[t] for t in old if a not in self.face[t]]
        for t in old:
            self.drop(t)
        for f in new:
            self.add(*(a if v == b else v for v in f))

    def shuffle(self, random, steps):
        for _ in range(steps):
            edges = sorted(self.left)
            a, b = edges[random.integers(len(edges))]
            (self.flip, self.flip, self.split, self.collapse)[random.integers(4)](a, b)

    def arrays(self):
        faces = [self.face[t] for t in sorted(self.face)]
        used = sorted({v for f in faces for v in f})
        number = {v: i for i, v in enumerate(used)}
        return [tuple(number[v] for v in f) for f in faces], np.array([self.place[v] for v in used])


def double_link(faces):
    first = np.concatenate([[0], np.cumsum([len(f) for f in faces])]).astype(np.int32)
    origin = np.concatenate(faces).astype(np.int32)
    alpha = np.arange(len(origin)) + 1
    alpha[first[1:] - 1] = first[:-1]
    dart = {(u, w): a for a, (u, w) in enumerate(zip(origin, origin[alpha]))}
    assert len(dart) == len(origin)
    opposite = np.array([dart[w, u] for u, w in zip(origin, origin[alpha])])
    beta = np.empty_like(opposite)
    beta[alpha] = opposite
    face = np.repeat(np.arange(len(faces)), np.diff(first))
    return first, origin, alpha, beta, opposite, face


def successors(h, r, alpha, opposite, face):
    rising = np.nonzero((h <= r) & (r < h[alpha]))[0]
    if np.bincount(face[rising], minlength=1).max() <= 1:
        of_face = dict(zip(face[rising], rising))
        return rising, np.array([of_face[face[opposite[a]]] for a in rising], int)
    is_rising = set(rising)
    next_dart = []
    for a in rising:
        c = alpha[opposite[a]]
        while c not in is_rising:
            c = alpha[c]
        next_dart.append(c)
    return rising, np.array(next_dart, int)


def compare(tool, scratch, faces, places, heights, levels):
    """The library's answer for these faces against the one above; returns crossings, contours."""
    first, origin, alpha, beta, opposite, face = double_link(faces)
    paths = [scratch + "/" + name for name in ("input.bin", "surface.mlk", "contours.mlk")]
    with open(paths[0], "wb") as out:
        counts = [places.shape[1], len(faces), len(places), len(levels), 0]
        for block in (np.array(counts, "<i4"), first, origin, places.astype("<f8"),
                      heights.astype("<f8"), np.array(levels, "<f8")):
            out.write(block.tobytes())
    subprocess.run([tool, "slice"] + paths, check=True)
    surface, contours = MultiLink(paths[1]), MultiLink(paths[2])
    check_equations(surface)
    check_equations(contours)
    assert same(surface.map["α"], alpha) and same(surface.map["β"], beta)
    assert same(surface.map["β"][surface.map["α"]], opposite)
    assert same(surface.projection["f"], face) and same(surface.projection["v"], origin)
    assert same(surface.g, places[origin])

    dart, colour, phi = contours.projection["dart"], contours.projection["c"], contours.map["φ"]
    assert same(np.lexsort((colour, dart)), np.arange(contours.size))
    h, total, loops = heights[origin], 0, 0
    for level, r in enumerate(levels):
        rising, following = successors(h, r, alpha, opposite, face)
        assert same(np.sort(following), rising)
        here = np.nonzero(colour == level)[0]
        assert same(dart[here], rising)
        assert same(dart[phi[here]], following) and (colour[phi[here]] == level).all()
        end = alpha[rising]
        t = (r - h[rising]) / (h[end] - h[rising])
        g = places[origin]
        assert same(contours.g[here], g[rising] + t[:, None] * (g[end] - g[rising]))
        total += len(rising)
        seen = set()
        for a in here:
            loops += a not in seen
            while a not in seen:
                seen.add(a)
                a = phi[a]
    assert total == contours.size
    return total, loops


def main(tool):
    random = np.random.default_rng(17)
    crossings = contours = meshes = 0
    with tempfile.TemporaryDirectory() as scratch:
        for turn in range(24):
            mesh = Mesh(*torus(int(random.integers(5, 14)), int(random.integers(4, 10))))
            mesh.shuffle(random, 30 * turn)
            faces, places = mesh.arrays()
            assert sorted(sum(faces, ())) and len(faces) % 2 == 0
            assert 2 * len(places) == len(faces)  # a torus still
            heights, levels = [
                (random.integers(0, 4, len(places)), [-1, 0, 1, 1.5, 2, 3]),
                (random.integers(0, 9, len(places)), np.arange(-1, 10) / 1.0),
                (places[:, 2], np.linspace(-3.2, 3.2, 17)),
                (random.standard_normal(len(places)), np.linspace(-2, 2, 9)),
            ][turn % 4]
            k, n = compare(tool, scratch, faces, places, np.asarray(heights, float), levels)
            crossings, contours, meshes = crossings + k, contours + n, meshes + 1
        for turn in range(4):  # quads on which heights have saddles, in R^5
            faces, places = torus(8 + turn, 7, quads=True)
            places = np.hstack([places, random.standard_normal((len(places), 2))])
            heights = random.integers(0, 3, len(places)).astype(float)
            k, n = compare(tool, scratch, faces, places, heights, [0, 0.5, 1, 2])
            crossings, contours, meshes = crossings + k, contours + n, meshes + 1
    assert crossings > 10000 and contours > 500
    print("%d meshes, %d crossings, %d contours agree" % (meshes, crossings, contours))


if __name__ == "__main__":
    main(sys.argv[1])
