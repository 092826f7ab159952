"""Nasty but plausible models: arrays of triangles (n, 3, 3), millimetres, made from a seeded generator.

Each maker takes the generator and returns (triangles, traits). Traits say what a test may expect:
"closed": every shell is a closed surface that turns outwards (cavities inwards), so that a winding
number says what is inside; "thick": nothing narrower than about ten beads of 0.45 mm, so that a solid
print holds the model's volume; "spoilt": defects, which may also be refused.
"""
import math

import numpy

# ---- pieces ----


def grid_faces(rows, columns, wrap_rows, wrap_columns):
    """Indices of the triangles of a grid of rows x columns vertices."""
    r = numpy.arange(rows if wrap_rows else rows - 1)
    c = numpy.arange(columns if wrap_columns else columns - 1)
    r, c = (a.ravel() for a in numpy.meshgrid(r, c, indexing="ij"))
    at = lambda i, j: (i % rows) * columns + j % columns
    a, b, d, e = at(r, c), at(r, c + 1), at(r + 1, c), at(r + 1, c + 1)
    return numpy.concatenate([numpy.stack([a, b, e], 1), numpy.stack([a, e, d], 1)])


def box(low, high):
    low, high = numpy.asarray(low, float), numpy.asarray(high, float)
    corner = numpy.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    face = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
            [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
    return (low + corner * (high - low))[numpy.array(face)]


def ear_clip(polygon):
    """Triangles of a simple polygon that turns counter-clockwise."""
    left = list(range(len(polygon)))
    cross = lambda o, a, b: ((a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]))
    made = []
    while len(left) > 3:
        for i in range(len(left)):
            a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
            pa, pb, pc = polygon[a], polygon[b], polygon[c]
            if cross(pa, pb, pc) <= 0:
                continue
            rest = polygon[[k for k in left if k not in (a, b, c)]]
            inside = ((cross(pa, pb, rest.T) >= 0) & (cross(pb, pc, rest.T) >= 0)
                      & (cross(pc, pa, rest.T) >= 0))
            if not inside.any():
                made.append((a, b, c))
                del left[i]
                break
        else:
            break
    made.append(tuple(left[:3]))
    return numpy.array(made)


def prism(polygon, low, high, caps=None):
    """A polygon, counter-clockwise, drawn up from low to high."""
    polygon = numpy.asarray(polygon, float)
    caps = ear_clip(polygon) if caps is None else caps
    at = lambda z: numpy.column_stack([polygon, numpy.full(len(polygon), z)])
    bottom, top = at(low), at(high)
    i = numpy.arange(len(polygon))
    j = (i + 1) % len(polygon)
    return numpy.concatenate([
        bottom[caps[:, ::-1]], top[caps],
        numpy.stack([bottom[i], bottom[j], top[j]], 1),
        numpy.stack([bottom[i], top[j], top[i]], 1)])


def circle(radius, count, phase=0.0):
    angle = numpy.arange(count) * 2 * math.pi / count + phase
    return radius * numpy.column_stack([numpy.cos(angle), numpy.sin(angle)])


def cylinder(radius, low, high, count, tip=1.0):
    """A frustum; tip 0 makes a cone."""
    base = numpy.column_stack([circle(radius, count), numpy.full(count, low)])
    top = numpy.column_stack([circle(radius * tip, count), numpy.full(count, high)])
    i = numpy.arange(count)
    j = (i + 1) % count
    below = numpy.broadcast_to([0.0, 0.0, low], (count, 3))
    above = numpy.broadcast_to([0.0, 0.0, high], (count, 3))
    made = [numpy.stack([below, base[j], base[i]], 1), numpy.stack([base[i], base[j], top[j]], 1)]
    if tip > 0:
        made += [numpy.stack([base[i], top[j], top[i]], 1), numpy.stack([above, top[i], top[j]], 1)]
    return numpy.concatenate(made)


def sphere(radius, rows, columns, bumps=None):
    """Rows x columns; bumps(directions) multiplies the radius."""
    theta = numpy.linspace(0, math.pi, rows + 1)[1:-1]
    phi = numpy.arange(columns) * 2 * math.pi / columns
    t, p = numpy.meshgrid(theta, phi, indexing="ij")
    body = numpy.stack([numpy.sin(t) * numpy.cos(p), numpy.sin(t) * numpy.sin(p), numpy.cos(t)], 2)
    vertex = numpy.concatenate([body.reshape(-1, 3), [[0, 0, 1.0]], [[0, 0, -1.0]]])
    if bumps is not None:
        vertex = vertex * bumps(vertex)[:, None]
    i = numpy.arange(columns)
    j = (i + 1) % columns
    last = (rows - 2) * columns
    north = numpy.stack([numpy.full(columns, len(body) * columns), i, j], 1)
    south = numpy.stack([numpy.full(columns, len(body) * columns + 1), last + j, last + i], 1)
    faces = numpy.concatenate([grid_faces(rows - 1, columns, False, True)[:, ::-1], north, south])
    return radius * vertex[faces]


def torus(ring, tube, rows, columns):
    u, v = numpy.meshgrid(numpy.arange(rows) * 2 * math.pi / rows,
                          numpy.arange(columns) * 2 * math.pi / columns, indexing="ij")
    out = ring + tube * numpy.cos(v)
    vertex = numpy.stack([out * numpy.cos(u), out * numpy.sin(u), tube * numpy.sin(v)], 2)
    return vertex.reshape(-1, 3)[grid_faces(rows, columns, True, True)[:, ::-1]]


def moved(triangles, by):
    return triangles + numpy.asarray(by, float)


def inverted(triangles):
    return triangles[:, ::-1]


def turned(triangles, random):
    """Any rotation of space."""
    q = random.normal(size=4)
    w, x, y, z = q / numpy.linalg.norm(q)
    matrix = numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    # Rounded before it is used: equal corners stay equal, whatever the order of sums.
    return numpy.float32(triangles).astype(float) @ matrix.T


def quantised(triangles, step):
    return numpy.round(triangles / step) * step


def piece(random, size):
    kind = random.integers(5)
    if kind == 0:
        half = size * random.uniform(0.3, 1, 3)
        return box(-half, half)
    if kind == 1:
        return cylinder(size * random.uniform(0.3, 1), -size, size, int(random.integers(3, 40)))
    if kind == 2:
        return sphere(size, int(random.integers(4, 16)), int(random.integers(3, 24)))
    if kind == 3:
        return torus(size * 0.7, size * random.uniform(0.15, 0.5), int(random.integers(4, 24)),
                     int(random.integers(3, 14)))
    return cylinder(size, -size, size, int(random.integers(3, 30)), random.choice([0, 0.3]))


# ---- models ----


def heap(random):
    """Shells that overlap anyhow."""
    size = random.uniform(2, 15)
    made = []
    for _ in range(random.integers(2, 9)):
        part = piece(random, size * random.uniform(0.3, 1))
        if random.random() < 0.5:
            part = turned(part, random)
        made.append(moved(part, random.uniform(-size, size, 3)))
    made = numpy.concatenate(made)
    if random.random() < 0.3:
        made = quantised(made, 0.1)
    return made, {"closed"}


def crate(random):
    """Boxes with corners on a coarse grid: many faces, edges and corners in common."""
    step = float(random.choice([0.1, 0.4, 1.0]))
    made = []
    for _ in range(random.integers(3, 14)):
        low = random.integers(0, 12, 3)
        made.append(box(low * step, (low + random.integers(1, 9, 3)) * step))
    return numpy.concatenate(made), {"closed"}


def nest(random):
    """Shells in shells, cavities and solids in turn."""
    made, size, inside = [], random.uniform(4, 15), False
    kind = random.integers(3)
    while size > 0.4:
        if kind == 0:
            part = box([-size] * 3, [size] * 3)
        elif kind == 1:
            part = sphere(size, 12, 24)
        else:
            part = cylinder(size, -size, size, 32)
        made.append(inverted(part) if inside else part)
        inside = not inside
        size -= random.choice([0.05, 0.3, 1.0, 2.5])
    return numpy.concatenate(made), {"closed"}


def touching(random):
    """Boxes that share a face, an edge or a corner."""
    size = float(random.choice([1, 3, 5, 8]))
    made = [box([0] * 3, [size] * 3)]
    for _ in range(random.integers(1, 5)):
        at = random.integers(-1, 2, 3) * size
        made.append(box(at, at + size))
    made = numpy.concatenate(made)
    if random.random() < 0.3:
        made = turned(made, random)
    return made, {"closed"}


def stairs(random):
    """Faces in the planes of layers and in those that cut them."""
    rise = float(random.choice([0.1, 0.2, 0.05, 0.3]))
    count = int(random.integers(5, 30))
    polygon = [[0, 0], [count * 1.0, 0]]
    for k in range(count):
        polygon += [[count - k * 1.0, rise * (k + 1)], [count - k - 1.0, rise * (k + 1)]]
    lying = prism(polygon[:-1] + [[0, rise * count]] if polygon[-1] != [0, rise * count]
                  else polygon, 0, 10)
    return lying[:, :, [2, 0, 1]], {"closed"}


def needles(random):
    made = []
    for _ in range(random.integers(1, 30)):
        part = cylinder(random.uniform(0.01, 1), 0, random.uniform(2, 40),
                        int(random.integers(3, 12)), random.choice([0, 0.01, 1]))
        made.append(moved(part, [*random.uniform(-10, 10, 2), 0]))
    if random.random() < 0.5:
        made.append(box([-10, -10, 0], [10, 10, 0.4]))
    return numpy.concatenate(made), {"closed"}


def plate(random):
    size = numpy.array([random.uniform(5, 40), random.uniform(5, 40), random.uniform(0.1, 1)])
    part = box([0] * 3, size)
    order = list(random.permutation(3))
    part = part[:, :, order] if random.random() < 0.5 else part
    if random.random() < 0.4:
        part = turned(part, random)
    volume = numpy.einsum("ij,ij->i", part[:, 0], numpy.cross(part[:, 1], part[:, 2])).sum()
    return (part if volume > 0 else inverted(part)), {"closed"}


def comb(random):
    """A plate with many teeth."""
    count, gap = int(random.integers(10, 400)), random.uniform(0.05, 1.5)
    thick = random.uniform(0.1, 1.5)
    pitch = gap + thick
    polygon = [[0, 0], [count * pitch, 0]]
    for k in reversed(range(count)):
        x = k * pitch
        polygon += [[x + pitch, 2], [x + thick, 2], [x + thick, 12], [x, 12]]
    polygon = numpy.array(polygon + [[0, 2]])[:-1]
    keep = (polygon != numpy.roll(polygon, 1, 0)).any(1)
    made = prism(polygon[keep], 0, random.uniform(0.5, 4))
    return made * min(1.0, 150 / (count * pitch)), {"closed"}


def forest(random):
    """Thousands of islands a layer."""
    count = int(random.integers(5, 38))
    pitch = random.uniform(0.5, 5)
    size = pitch * random.uniform(0.2, 1.02)
    pillar = box([0, 0, 0], [size, size, random.uniform(0.3, 3)])
    if random.random() < 0.3:
        pillar = moved(cylinder(size / 2, 0, 2, 6), [size / 2, size / 2, 0])
        count = min(count, 25)
    at = numpy.array([[i * pitch, j * pitch, 0] for i in range(count) for j in range(count)])
    return (pillar[None] + at[:, None, None]).reshape(-1, 3, 3), {"closed"}


def sieve(random):
    """A plate with many holes: cavities that go from face to face, as a lattice of bars."""
    count = int(random.integers(3, 24))
    pitch, bar = random.uniform(1, 5), random.uniform(0.1, 1.2)
    size = pitch * count
    made = []
    for k in range(count + 1):
        made.append(box([k * pitch, 0, 0], [k * pitch + bar, size + bar, 1.0]))
        low, high = (0, 1.0) if random.random() < 0.5 else (0.5, 1.5)
        made.append(box([0, k * pitch, low], [size + bar, k * pitch + bar, high]))
    made = numpy.concatenate(made)
    if random.random() < 0.4:
        made = turned(made, random)
    return made * min(1.0, 100 / size), {"closed"}


def huge(random):
    polygon = circle(400, int(random.choice([4, 5, 60, 999])))
    if random.random() < 0.5:
        polygon = polygon * random.uniform(0.3, 1, len(polygon))[:, None]
    count = len(polygon)
    middle = numpy.concatenate([polygon, [[0, 0]]])
    i = numpy.arange(count)
    caps = numpy.stack([i, (i + 1) % count, numpy.full(count, count)], 1)
    high = random.uniform(0.5, 1.5)
    at = lambda z: numpy.column_stack([middle, numpy.full(len(middle), z)])
    j = (i + 1) % count
    low, top = at(0), at(high)
    return numpy.concatenate([
        low[caps[:, ::-1]], top[caps], numpy.stack([low[i], low[j], top[j]], 1),
        numpy.stack([low[i], top[j], top[i]], 1)]), {"closed", "huge"}


def tiny(random):
    return piece(random, random.uniform(0.1, 0.6)), {"closed"}


def fine(random):
    """Triangles far smaller than a bead."""
    rows = int(random.integers(30, 70))
    size = random.uniform(0.3, 4)
    if random.random() < 0.5:
        return torus(size, size / 3, rows * 2, rows), {"closed"}
    return sphere(size, rows, rows * 2), {"closed"}


def hedgehog(random):
    """A star with noise at all scales."""
    rows = int(random.integers(20, 60))
    wave = random.normal(size=(6, 3)) * random.uniform(2, 12)
    phase = random.uniform(0, 6, 6)
    noise = random.uniform(0, 0.2)

    def bumps(v):
        smooth = 1 + 0.08 * numpy.sin(v @ wave.T + phase).sum(1)
        return smooth * (1 + noise * random.uniform(-1, 1, len(v)))
    return sphere(random.uniform(1, 20), rows, rows * 2, bumps), {"closed"}


def crumpled(random):
    """Slightly self-intersecting: corners moved at random."""
    part = torus(8, 3, int(random.integers(10, 50)), int(random.integers(6, 30)))
    keys, index = numpy.unique(numpy.float32(part).reshape(-1, 3), axis=0, return_inverse=True)
    keys = keys + random.normal(size=keys.shape) * random.choice([0.001, 0.05, 0.3, 1.0])
    return keys[index.ravel()].reshape(-1, 3, 3), {"closed"}


def holed(random):
    """Missing triangles."""
    part, _ = hedgehog(random) if random.random() < 0.5 else heap(random)
    keep = numpy.ones(len(part), bool)
    keep[random.integers(0, len(part), int(random.integers(1, 12)))] = False
    return part[keep], {"spoilt"}


def muddled(random):
    """Triangles turned around."""
    part, _ = hedgehog(random) if random.random() < 0.5 else heap(random)
    part = part.copy()
    which = random.integers(0, len(part), int(random.integers(1, max(2, len(part) // 4))))
    part[which] = part[which][:, ::-1]
    return part, {"spoilt"}


def doubled(random):
    """Shells that occur twice: exactly, moved by next to nothing, or inside out."""
    part, _ = heap(random) if random.random() < 0.6 else nest(random)
    kind = random.integers(4)
    if kind == 0:
        return numpy.concatenate([part, part]), {"spoilt"}
    if kind == 1:
        return numpy.concatenate([part, moved(part, random.normal(size=3) * 1e-5)]), {"closed"}
    if kind == 2:
        return numpy.concatenate([part, inverted(part)]), {"spoilt"}
    return inverted(part), {"spoilt"}


def seams(random):
    """T-junctions: a box's faces divided each in its own way."""
    size = random.uniform(2, 20, 3)
    made = []
    for axis in range(3):
        for side in (0, 1):
            n, m = random.integers(1, 6, 2)
            u, v = (numpy.linspace(0, 1, k + 1) for k in (n, m))
            a, b = numpy.meshgrid(u, v, indexing="ij")
            vertex = numpy.zeros((a.size, 3))
            vertex[:, (axis + 1) % 3], vertex[:, (axis + 2) % 3] = a.ravel(), b.ravel()
            vertex[:, axis] = side
            faces = grid_faces(n + 1, m + 1, False, False)
            made.append((vertex * size)[faces if side == 0 else faces[:, ::-1]])
    made = numpy.concatenate(made)
    if random.random() < 0.5:
        made = turned(made, random)
    return made, {"spoilt"}


def spiral(random):
    """A long thin wall, wound up."""
    turns, thick = random.uniform(2, 12), random.uniform(0.1, 1.2)
    pitch = thick * random.uniform(1.05, 3)
    angle = numpy.linspace(1, turns * 2 * math.pi, int(turns * 40))
    out = 1 + pitch * angle / (2 * math.pi)
    ring = lambda r: numpy.column_stack([r * numpy.cos(angle), r * numpy.sin(angle)])
    inner, outer = ring(out), ring(out + thick)
    count = len(angle)
    polygon = numpy.concatenate([outer, inner[::-1]])
    i = numpy.arange(count - 1)
    back = 2 * count - 1 - i
    caps = numpy.concatenate([numpy.stack([i, i + 1, back - 1], 1),
                              numpy.stack([i, back - 1, back], 1)])
    return prism(polygon, 0, random.uniform(0.5, 3), caps), {"closed"}


def shallow(random):
    """Faces that are nearly, but not quite, level."""
    count = int(random.integers(4, 30))
    x = numpy.linspace(-12, 12, count)
    a, b = numpy.meshgrid(x, x, indexing="ij")
    z = float(random.choice([1.0, 1.1, 0.9])) + random.choice([1e-7, 1e-5, 1e-3, 0.05]) \
        * random.normal(size=a.shape)
    top = numpy.stack([a, b, z], 2).reshape(-1, 3)
    low = top * [1, 1, 0]
    faces = grid_faces(count, count, False, False)
    made = [top[faces][:, ::-1], low[faces]]
    index = numpy.arange(count * count).reshape(count, count)
    rim = numpy.concatenate([index[:-1, 0], index[-1, :-1], index[:0:-1, -1], index[0, :0:-1]])
    i, j = rim, numpy.roll(rim, -1)
    made += [numpy.stack([low[i], low[j], top[j]], 1), numpy.stack([low[i], top[j], top[i]], 1)]
    return numpy.concatenate(made), {"closed"}


def tower(random):
    """Many layers."""
    return cylinder(random.uniform(0.3, 3), 0, random.uniform(50, 150),
                    int(random.integers(3, 9)), random.choice([0, 0.5, 1])), {"closed"}


def block(random):
    """Thick, plain, for the volume."""
    size = random.uniform(8, 20)
    kind = random.integers(4)
    if kind == 0:
        part = box([-size] * 3, [size, size * random.uniform(0.5, 1), 0])
    elif kind == 1:
        part = cylinder(size, 0, size, int(random.integers(3, 100)))
    elif kind == 2:
        part = cylinder(size, 0, size / 2, 6, 0.6)
    else:
        part = prism(circle(size, 10) * numpy.tile([1, 0.6], 5)[:, None], 0, 5)
    if random.random() < 0.5:
        angle = random.uniform(0, 6)
        c, s = math.cos(angle), math.sin(angle)
        part = part @ numpy.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return part, {"closed", "thick"}


MAKERS = [heap, crate, nest, touching, stairs, needles, plate, comb, forest, sieve, huge, tiny, fine,
          hedgehog, crumpled, holed, muddled, doubled, seams, spiral, shallow, tower, block]


def write_stl(path, triangles):
    record = numpy.zeros(len(triangles), [("normal", "<f4", 3), ("corner", "<f4", (3, 3)),
                                          ("word", "<u2")])
    record["corner"] = triangles
    with open(path, "wb") as file:
        file.write(b" " * 80 + numpy.uint32(len(triangles)).tobytes() + record.tobytes())


# ---- what is inside, by columns ----


def layer_volume(triangles, middles, heights, random, side=48):
    """The volume of layers where the winding number at their middles is positive, from a jittered
    grid of side x side columns: its mean and the error that one may expect of it."""
    t = numpy.float32(triangles).astype(float)
    low = t.reshape(-1, 3).min(0)
    extent = t.reshape(-1, 3).max(0) - low
    cell = extent[:2] / side
    jitter = random.random((side, side, 2))
    x = low[0] + (numpy.arange(side)[:, None] + jitter[:, :, 0]) * cell[0]
    y = low[1] + (numpy.arange(side)[None, :] + jitter[:, :, 1]) * cell[1]
    winding = numpy.zeros((side, side, len(middles) + 1), numpy.int32)
    levels = numpy.asarray(middles) + low[2]
    for a, b, c in t:
        det = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if det == 0:
            continue
        span = [slice(max(0, int((min(a[k], b[k], c[k]) - low[k]) / cell[k])),
                      int((max(a[k], b[k], c[k]) - low[k]) / cell[k]) + 1) for k in (0, 1)]
        px, py = x[span[0], span[1]], y[span[0], span[1]]
        u = ((px - a[0]) * (c[1] - a[1]) - (py - a[1]) * (c[0] - a[0])) / det
        v = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / det
        hit = numpy.nonzero((u >= 0) & (v >= 0) & (u + v <= 1))
        if len(hit[0]) == 0:
            continue
        z = a[2] + u[hit] * (b[2] - a[2]) + v[hit] * (c[2] - a[2])
        # Seen from above the surface turns left: material below it, so levels under z count up.
        below = numpy.searchsorted(levels, z)
        step = 1 if det > 0 else -1
        numpy.add.at(winding, (hit[0] + span[0].start, hit[1] + span[1].start, 0), step)
        numpy.add.at(winding, (hit[0] + span[0].start, hit[1] + span[1].start, below), -step)
    inside = numpy.cumsum(winding, 2)[:, :, :-1] > 0
    column = inside @ numpy.asarray(heights, float)
    area = cell[0] * cell[1]
    # Neighbouring columns that differ hold an edge; each errs on its own.
    across = numpy.diff(column, axis=0, append=0) ** 2 + numpy.diff(column, axis=1, append=0) ** 2
    return column.sum() * area, math.sqrt(across.sum() / 4) * area
