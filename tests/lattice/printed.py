"""What a printer would leave of a G-code file: beads, and how much of a window they fill.

Two measures that share nothing but the reading of the file: bead volume is the filament that goes
in between the window's walls; the voxel count asks of points on a fine grid whether a bead covers
them. A bead is a box as wide as its filament makes it at the layer's height, with round corners
where the nozzle turns. Beads over beads count once, and plastic can't be pressed together: what
they have too much flows into seams and to the sides near by, as far as there is so much, and as far
as there is room for it; what is buried deeper is lost for this count. Nor does it come from
nothing: round corners take it from the beads.
"""
import math
import re

import numpy as np

FILAMENT = math.pi / 4 * 1.75**2
WORD = re.compile(r"([XYZEF])(-?[0-9.]+)")


# mm. Seams are up to twice SEAM wide, about a bead; beads swell by SIDE at most; plastic flows about
# a millimetre, so that squares of FLOW keep theirs.
SEAM, SIDE, FLOW = 0.2, 0.1, 2.0
STRIPS = 10  # of a bead, side by side


def swell(grid, radius):
    """All points within so many steps of one of the grid's; beyond its border there is none."""
    out = grid.copy()
    for dx in range(-radius, radius + 1):
        for dy in range(-radius, radius + 1):
            if 0 < dx * dx + dy * dy <= radius * radius:
                x = slice(max(dx, 0), grid.shape[0] + min(dx, 0))
                y = slice(max(dy, 0), grid.shape[1] + min(dy, 0))
                u = slice(max(-dx, 0), grid.shape[0] + min(-dx, 0))
                v = slice(max(-dy, 0), grid.shape[1] + min(-dy, 0))
                out[x, y] |= grid[u, v]
    return out


def summed(grid, tiles):
    """Over each of so many tiles."""
    rows = np.array_split(np.arange(grid.shape[0]), tiles[0])
    columns = np.array_split(np.arange(grid.shape[1]), tiles[1])
    return np.array([[grid[r[0]:r[-1] + 1, c[0]:c[-1] + 1].sum() for c in columns] for r in rows])


class Beads:
    """x0 y0 x1 y1 of every bead (mm), its width, its layer; `linked` where it goes on from the one
    before without a travel. Layers have bottom and height."""

    def __init__(self, path):
        at, z, tool, begun = [0.0, 0.0], 0.0, 0, True
        ends, area, layer, linked, tools, self.layers = [], [], [], [], [], []
        drawing = False
        with open(path) as file:
            for line in file:
                if line.startswith(";Z:"):
                    z = float(line[3:])
                    begun = False
                elif line.startswith(";HEIGHT:") and not begun:
                    height, begun = float(line[8:]), True  # later ones are of single beads
                    self.layers.append((z - height, height))
                elif line[0] == "T" and line[1:2].isdigit():
                    tool = int(line[1:])
                elif line.startswith(("G1 ", "G0 ")):
                    words = dict(WORD.findall(line.split(";")[0]))
                    to = [float(words.get("X", at[0])), float(words.get("Y", at[1]))]
                    length, e = math.dist(at, to), float(words.get("E", 0))
                    if length > 0 and e > 0:
                        ends.append((*at, *to))
                        area.append(e * FILAMENT / length)
                        layer.append(len(self.layers) - 1)
                        linked.append(drawing)
                        tools.append(tool)
                    if length > 0:
                        drawing = e > 0
                    at = to
        self.ends = np.array(ends).reshape(-1, 4)
        self.layer = np.array(layer, int)
        self.tool = np.array(tools, int)
        self.linked = np.array(linked, bool)
        heights = np.array([h for _, h in self.layers])
        self.width = np.array(area) / heights[self.layer] if len(area) else np.zeros(0)

    def share_of_filament(self, low, high):
        """Of the box from low to high, the part that the filament put there would fill."""
        dx, dy = self.ends[:, 2] - self.ends[:, 0], self.ends[:, 3] - self.ends[:, 1]
        length = np.hypot(dx, dy)
        section = self.width * self.thickness(low[2], high[2])[self.layer]
        volume = 0.0
        for strip in range(STRIPS):  # beads lie on both sides of the window's walls
            off = self.width * ((strip + 0.5) / STRIPS - 0.5) / length
            begin, end = np.zeros(len(dx)), np.ones(len(dx))
            for axis, d, a in ((0, dx, self.ends[:, 0] - off * dy),
                               (1, dy, self.ends[:, 1] + off * dx)):
                with np.errstate(divide="ignore", invalid="ignore"):
                    t0, t1 = (low[axis] - a) / d, (high[axis] - a) / d
                inside = (a >= low[axis]) & (a <= high[axis])
                t0, t1 = (np.where(d == 0, np.where(inside, 0, 1), np.minimum(t0, t1)),
                          np.where(d == 0, np.where(inside, 1, 0), np.maximum(t0, t1)))
                begin, end = np.maximum(begin, t0), np.minimum(end, t1)
            volume += (length * np.maximum(end - begin, 0) * section).sum() / STRIPS
        return volume / np.prod(np.subtract(high, low))

    def thickness(self, low, high):
        """Of each layer, as much as lies between the two heights."""
        return np.array([max(0, min(z + h, high) - max(z, low)) for z, h in self.layers])

    def share_of_voxels(self, low, high, step=0.05):
        """The same by points on a grid, in the middle of each layer."""
        thickness = self.thickness(low[2], high[2])
        counts = [int(round((high[k] - low[k]) / step)) for k in (0, 1)]
        tiles = [max(1, int(round((high[k] - low[k]) / FLOW))) for k in (0, 1)]
        share = 0.0
        margin = int(round(SEAM / step))
        inner = slice(margin, -margin)
        for layer in np.flatnonzero(thickness):
            wide, laid = self.cover(layer, [v - margin * step for v in low], step,
                                    [n + 2 * margin for n in counts])
            room = ~swell(~swell(wide, margin), margin) | swell(wide, int(round(SIDE / step)))
            room = (room & ~wide)[inner, inner]
            wide, laid = wide[inner, inner], laid[inner, inner]
            over = summed(laid - wide, tiles)  # below 0: round corners are drawn out of beads
            full = wide.sum() + np.minimum(over, summed(room, tiles)).sum()
            share += thickness[layer] * full / wide.size
        return share / (high[2] - low[2])

    def cover(self, layer, low, step, counts):
        """Is a point covered, and how often is plastic laid there?"""
        grid, laid = np.zeros(counts, bool), np.zeros(counts, np.int16)
        near = self.layer == layer
        for axis in (0, 1):
            a, b = self.ends[:, axis], self.ends[:, axis + 2]
            near &= np.maximum(a, b) + self.width / 2 > low[axis]
            near &= np.minimum(a, b) - self.width / 2 < low[axis] + counts[axis] * step
        for k in np.flatnonzero(near):
            x0, y0, x1, y1 = self.ends[k]
            half = self.width[k] / 2
            first = [max(0, int((min(p) - half - low[axis]) / step))
                     for axis, p in ((0, (x0, x1)), (1, (y0, y1)))]
            last = [min(counts[axis], int((max(p) + half - low[axis]) / step) + 2)
                    for axis, p in ((0, (x0, x1)), (1, (y0, y1)))]
            if first[0] >= last[0] or first[1] >= last[1]:
                continue
            x = low[0] + (np.arange(first[0], last[0])[:, None] + 0.5) * step
            y = low[1] + (np.arange(first[1], last[1])[None, :] + 0.5) * step
            length = math.hypot(x1 - x0, y1 - y0)
            ux, uy = (x1 - x0) / length, (y1 - y0) / length
            along = (x - x0) * ux + (y - y0) * uy
            across = np.abs((y - y0) * ux - (x - x0) * uy)
            part = (along >= 0) & (along < length) & (across <= half)
            here = slice(first[0], last[0]), slice(first[1], last[1])
            laid[here] += part
            if self.linked[k]:
                part |= (x - x0)**2 + (y - y0)**2 <= min(half, self.width[k - 1] / 2)**2
            grid[here] |= part
        return grid, laid
