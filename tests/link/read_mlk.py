"""Read a multi-link file with numpy.fromfile, by docs/link-file.md alone.

As a script: read the samples that `link-tool samples` writes and check every equation of their
kinds, and the values that are known from elsewhere.

    read_mlk.py LINK_TOOL
"""
import subprocess
import sys
import tempfile

import numpy as np

KINDS = ["link", "coloured link", "square-link", "triangulation", "square patch", "double-link",
         "cubic-link", "n-cube-link", "contour-filling link"]
STORED, CYCLIC, CLAMPED, COORDINATE = range(4)


class MultiLink:
    def __init__(self, path):
        self.path = path
        head = np.fromfile(path, "<i4", 16)
        assert head[:2].tobytes() == b"ISOLINK\n", path
        version, at, kind, self.size, maps, projections, self.dimension, number = head[2:10]
        assert version == 1 and not head[10:].any()
        self.kind = KINDS[kind]
        rows = np.fromfile(path, [("name", "S16"), ("rule", "<i4"), ("stride", "<i4"),
                                  ("length", "<i4"), ("range", "<i4")], maps + projections,
                           offset=64)
        assert at == 64 + rows.nbytes
        self.at = int(at)
        self.range = {}
        self.map = dict(self.column(row) for row in rows[:maps])
        self.g = None
        if self.dimension:
            flat = self.block("<f%d" % number, self.size * self.dimension)
            self.g = flat.reshape(self.size, self.dimension)
        self.projection = dict(self.column(row) for row in rows[maps:])

    def block(self, form, count):
        values = np.fromfile(self.path, form, count, offset=self.at)
        assert len(values) == count
        self.at += -(-values.nbytes // 8) * 8
        return values

    def column(self, row):
        name = row["name"].decode()
        self.range[name] = int(row["range"])
        if row["rule"] == STORED:
            return name, self.block("<i4", self.size)
        a = np.arange(self.size, dtype=np.int32)
        stride, length = row["stride"], row["length"]
        place = a // stride % length
        if row["rule"] == COORDINATE:
            return name, place
        end = a if row["rule"] == CLAMPED else a - place * stride
        return name, np.where(place + 1 < length, a + stride, end)


def same(x, y):
    return np.array_equal(x, y)


def power(f, n):
    result = np.arange(len(f))
    for _ in range(n):
        result = f[result]
    return result


def check_equations(m):
    """Composition: (fg)(a) = f[g[a]], so fg is f[g]."""
    one = np.arange(m.size)
    f = list(m.map.values())
    p = list(m.projection.values())
    for name, image in m.map.items():
        assert m.range[name] == m.size and ((0 <= image) & (image < m.size)).all()
    for name, image in m.projection.items():
        assert ((0 <= image) & (image < m.range[name])).all()
    if m.kind == "coloured link":
        assert same(p[0][f[0]], p[0])
    if m.kind in ("square-link", "cubic-link", "n-cube-link"):
        for x in f:
            for y in f:
                assert same(x[y], y[x])
    if m.kind in ("triangulation", "square patch"):
        theta, phi = f
        n = 3 if m.kind == "triangulation" else 4
        assert same(power(theta, n), one) and same(power(theta, n - 1), phi[theta[phi]])
        assert same(m.g[phi], m.g)
    if m.kind == "double-link":
        alpha, beta = f
        assert same(alpha[beta[alpha[beta]]], one) and same(beta[alpha[beta[alpha]]], one)
        assert same(p[0][alpha], p[0]) and same(p[1][beta], p[1])
        assert m.g is None or same(m.g[beta], m.g)
        assert (alpha != one).all() and (beta[alpha] != one).all()
    if m.kind == "contour-filling link":
        r, s, g = f
        for x in f:
            assert same(x[x], one)
        q, c = p[:2]
        assert same(q[r], q) and same(q[s], q) and same(c[g], c)


def check_cylinder(m, exact):
    """The seed's formulas, counting from 1."""
    x = np.arange(1, 721)
    alpha, beta = x + 1, np.where(x <= 360, x + 360, x)
    alpha[359], alpha[719] = 1, 361
    assert same(m.map["α"], alpha - 1) and same(m.map["β"], beta - 1)
    angle = 2 * np.pi * np.where(x <= 360, x, x - 360) / 360
    g = np.stack([np.cos(angle), np.sin(angle), x > 360], 1)
    assert np.abs(m.g - g).max() < (1e-15 if exact else 1e-7)
    assert len(np.unique(m.map["β"])) == 360


def check_samples(folder):
    found = {}
    for name in ("link coloured cylinder cylinder32 triangulation patch double cubic cube filling "
                 "slices").split():
        m = found[name] = MultiLink("%s/%s.mlk" % (folder, name))
        assert m.at == len(open(m.path, "rb").read())
        check_equations(m)
    assert {m.kind for m in found.values()} == set(KINDS)
    check_cylinder(found["cylinder"], True)
    check_cylinder(found["cylinder32"], False)
    tetrahedron = found["double"]
    assert tetrahedron.size == 12 and same(tetrahedron.projection["f"], np.arange(12) // 3)
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    assert same(tetrahedron.g, corners[tetrahedron.projection["v"]])
    assert same(tetrahedron.map["α"], found["triangulation"].map["θ"])
    assert same(tetrahedron.map["β"], found["triangulation"].map["φ"])
    x, y, z = np.arange(24) % 3, np.arange(24) // 3 % 2, np.arange(24) // 6
    voxels = found["cubic"]
    assert same(voxels.map["α"], np.minimum(x + 1, 2) + 3 * (y + 2 * z))
    assert same(voxels.map["β"], x + 3 * ((y + 1) % 2 + 2 * z))
    assert same(voxels.map["γ"], x + 3 * (y + 2 * np.minimum(z + 1, 3)))
    assert same(voxels.projection["p"], np.arange(24) % 3)
    assert same(voxels.g, np.outer(np.arange(24), [1, 2, 3]) / 7)
    assert found["cube"].size == 120 and list(found["cube"].map) == ["α₁", "α₂", "α₃", "α₄"]
    d = np.arange(8)
    assert same(found["filling"].map["r"], d ^ 2) and same(found["filling"].map["s"], d ^ 1)
    prism = found["slices"]
    assert same(np.bincount(prism.projection["c"]), [6, 6, 6, 6])
    assert same(prism.g[:, 2], prism.projection["c"] / 4) and prism.range["dart"] == 36
    print("%d files read and their equations checked" % len(found))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run([sys.argv[1], "samples", scratch], check=True)
        check_samples(scratch)
