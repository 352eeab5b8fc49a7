"""A sauropod as a triangle mesh, for tools/make-scene-assets: bones with a skin around them, cut into triangles.

Every limb is a chain of tapered capsules along a smooth curve. The skin is where the smooth minimum of the distances to
all limbs is 0, with scales on it; surface nets (one vertex for each cell of a grid that the skin passes through, one
quad for each edge of the grid that it crosses) make triangles of it. Cells are followed from neighbour to neighbour, so
that nothing is looked at but the skin.
"""
import math

CELL = 0.0427  # edge of a grid cell; chosen for about 33 000 triangles
SMOOTH = 0.05  # how far limbs melt into each other
SCALES, SCALE_HEIGHT = 34.0, 0.0035
PER_SPAN = 7  # capsules between two points of a curve

# Curves: x (forward), y (to the left), z (up), radius.
SPINE = [(-3.55, 1.05, 0.62, 0.02), (-3.0, 1.12, 0.50, 0.06), (-2.3, 0.86, 0.62, 0.12), (-1.6, 0.40, 0.94, 0.22),
         (-0.95, 0.06, 1.26, 0.42), (-0.3, 0.0, 1.38, 0.60), (0.35, 0.0, 1.36, 0.57), (0.85, 0.0, 1.46, 0.42),
         (1.2, -0.02, 1.74, 0.285), (1.45, -0.06, 2.16, 0.21), (1.66, -0.14, 2.62, 0.17), (1.94, -0.28, 2.98, 0.15),
         (2.26, -0.44, 3.06, 0.17), (2.52, -0.58, 2.94, 0.15), (2.76, -0.70, 2.82, 0.10)]
LEGS = [[(0.62, 0.30, 1.15, 0.30), (0.86, 0.42, 0.66, 0.20), (0.84, 0.43, 0.26, 0.155), (0.94, 0.43, 0.06, 0.20)],
        [(0.58, -0.30, 1.15, 0.30), (0.56, -0.42, 0.64, 0.20), (0.36, -0.43, 0.28, 0.155), (0.42, -0.43, 0.06, 0.20)],
        [(-0.55, 0.32, 1.20, 0.38), (-0.52, 0.44, 0.70, 0.25), (-0.80, 0.46, 0.32, 0.165), (-0.72, 0.46, 0.06, 0.21)],
        [(-0.55, -0.32, 1.20, 0.38), (-0.30, -0.44, 0.70, 0.25), (-0.42, -0.46, 0.32, 0.165), (-0.30, -0.46, 0.06, 0.21)]]
TOES, TOE = 3, 0.075
EYE = (2.33, 0.13, 0.10, 0.052)  # x, distance from the middle of the head, height above it, radius
CREST = 24  # spikes along the back


def spline(points, per_span=PER_SPAN):
    """A Catmull-Rom curve through all points, the first and the last doubled."""
    padded, out = [points[0]] + points + [points[-1]], [points[0]]
    for i in range(len(points) - 1):
        p, q, r, s = padded[i:i + 4]
        for j in range(1, per_span + 1):
            t = j / per_span
            out.append(tuple(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t +
                                    (3 * (b - c) + d - a) * t * t * t) for a, b, c, d in zip(p, q, r, s)))
    return out


def spikes(spine):
    """Cones on the back, from the neck to the tail, higher in the middle."""
    first, last = int(0.10 * len(spine)), int(0.80 * len(spine))
    for i in range(CREST):
        share = i / (CREST - 1)
        at = first + share * (last - first)
        k = min(int(at), len(spine) - 2)
        x, y, z, r = (a + (at - k) * (b - a) for a, b in zip(spine[k], spine[k + 1]))
        ahead = (spine[k + 1][0] - spine[k][0], spine[k + 1][2] - spine[k][2])
        size = math.hypot(*ahead)
        up = (-ahead[1] / size, ahead[0] / size)  # across the spine, in the plane of x and z
        tall = 0.09 + 0.15 * math.sin(math.pi * share)
        wide = 0.30 * tall + 0.015
        root, tip = 0.9 * r, r + tall
        yield [(x + root * up[0], y, z + root * up[1], wide),
               (x + tip * up[0] - 0.4 * tall * ahead[0] / size, y, z + tip * up[1] - 0.4 * tall * ahead[1] / size, 0.012)]


def limbs():
    """Chains of (x, y, z, radius)."""
    spine = spline(SPINE)
    chains = [spine] + [spline(leg) for leg in LEGS]
    for leg in LEGS:
        x, y, z, _ = leg[-1]
        for toe in range(TOES):
            a = 0.75 * (toe - (TOES - 1) / 2)
            chains.append([(x, y, z, TOE), (x + 0.19 * math.cos(a), y + 0.19 * math.sin(a), z - 0.01, TOE)])
    x, aside, above, r = EYE
    for side in (-1, 1):  # the head looks along (0.87, -0.46)
        chains.append([(x - 0.46 * -side * aside, -0.48 + 0.87 * side * aside, 3.03 + above, r)] * 2)
    return chains + list(spikes(spine))


class Skin:
    """The distance to the skin, about, and its gradient."""

    COARSE = 0.2  # cells that know which capsules are near

    def __init__(self, chains):
        self.capsules = []
        for number, chain in enumerate(chains):
            for (ax, ay, az, ar), (bx, by, bz, br) in zip(chain, chain[1:]):
                dx, dy, dz = bx - ax, by - ay, bz - az
                length2 = dx * dx + dy * dy + dz * dz
                self.capsules.append((number, ax, ay, az, ar, dx, dy, dz, br - ar, 1 / length2 if length2 > 0 else 0.0))
        self.near = {}

    @staticmethod
    def to_capsule(capsule, x, y, z):
        """Distance and gradient; along a tapered capsule the radius changes with the nearest point of its axis."""
        _, ax, ay, az, ar, dx, dy, dz, dr, inverse = capsule
        t = ((x - ax) * dx + (y - ay) * dy + (z - az) * dz) * inverse
        slope = dr * inverse if 0 < t < 1 else 0.0
        t = min(max(t, 0.0), 1.0)
        ex, ey, ez = x - ax - t * dx, y - ay - t * dy, z - az - t * dz
        away = math.sqrt(ex * ex + ey * ey + ez * ez) + 1e-12
        return away - ar - t * dr, (ex / away - slope * dx, ey / away - slope * dy, ez / away - slope * dz)

    def candidates(self, x, y, z):
        """What may count at a point: capsules beyond the nearest by less than the cell and the melting take."""
        key = (math.floor(x / self.COARSE), math.floor(y / self.COARSE), math.floor(z / self.COARSE))
        if key not in self.near:
            middle = [(k + 0.5) * self.COARSE for k in key]
            reach = 2 * 0.87 * self.COARSE + 10 * SMOOTH
            distances = [self.to_capsule(c, *middle)[0] for c in self.capsules]
            least = min(distances)
            self.near[key] = [c for c, d in zip(self.capsules, distances) if d < least + reach]
        return self.near[key]

    def __call__(self, x, y, z):
        chains = {}
        for capsule in self.candidates(x, y, z):
            found = self.to_capsule(capsule, x, y, z)
            if capsule[0] not in chains or found[0] < chains[capsule[0]][0]:
                chains[capsule[0]] = found
        least = min(d for d, _ in chains.values())
        total = gx = gy = gz = 0.0
        for d, (dx, dy, dz) in chains.values():
            w = math.exp((least - d) / SMOOTH)
            total, gx, gy, gz = total + w, gx + w * dx, gy + w * dy, gz + w * dz
        (sx, cx), (sy, cy), (sz, cz) = ((math.sin(SCALES * v), math.cos(SCALES * v)) for v in (x, y, z))
        h, f = SCALE_HEIGHT, SCALE_HEIGHT * SCALES
        return (least - SMOOTH * math.log(total) - h * sx * sy * sz,
                (gx / total - f * cx * sy * sz, gy / total - f * sx * cy * sz, gz / total - f * sx * sy * cz))


CORNERS = [(i & 1, i >> 1 & 1, i >> 2 & 1) for i in range(8)]
EDGES = [(a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1]


class Net:
    """The triangles of a skin."""

    def __init__(self, skin, inside):
        self.skin, self.values, self.vertex_of = skin, {}, {}
        self.points, self.normals, self.triangles = [], [], []
        cells = self.follow(inside)
        for cell in cells:
            self.add_vertex(cell)
        for cell in cells:
            self.add_quads(cell)

    def value(self, corner):
        if corner not in self.values:
            self.values[corner] = self.skin(*(CELL * c for c in corner))[0]
        return self.values[corner]

    def corner_values(self, cell):
        return [self.value((cell[0] + i, cell[1] + j, cell[2] + k)) for i, j, k in CORNERS]

    def follow(self, inside):
        """All cells that the skin passes through, in order, found from a point inside of it."""
        cell = tuple(math.floor(c / CELL) for c in inside)
        while max(self.corner_values(cell)) < 0:
            cell = (cell[0] + 1, cell[1], cell[2])
        found, waiting = {cell}, [cell]
        while waiting:
            x, y, z = waiting.pop()
            values = self.corner_values((x, y, z))
            for axis in range(3):
                for side in (0, 1):
                    signs = {values[i] < 0 for i, corner in enumerate(CORNERS) if corner[axis] == side}
                    step = [0, 0, 0]
                    step[axis] = 2 * side - 1
                    neighbour = (x + step[0], y + step[1], z + step[2])
                    if len(signs) == 2 and neighbour not in found:
                        found.add(neighbour)
                        waiting.append(neighbour)
        return sorted(found)

    def add_vertex(self, cell):
        """In the middle of where the cell's edges are crossed, taken to the skin."""
        values, crossings = self.corner_values(cell), []
        for a, b in EDGES:
            if (values[a] < 0) != (values[b] < 0):
                t = values[a] / (values[a] - values[b])
                crossings.append([p + t * (q - p) for p, q in zip(CORNERS[a], CORNERS[b])])
        p = [CELL * (c + sum(axis) / len(crossings)) for c, axis in zip(cell, zip(*crossings))]
        for _ in range(2):
            d, g = self.skin(*p)
            size2 = sum(c * c for c in g)
            p = [c - d * e / size2 for c, e in zip(p, g)]
        _, g = self.skin(*p)
        size = math.sqrt(sum(c * c for c in g))
        self.vertex_of[cell] = len(self.points)
        self.points.append(tuple(p))
        self.normals.append(tuple(c / size for c in g))

    def add_quads(self, cell):
        """For the edges that begin at the cell's first corner: a quad of the four cells around each, front outwards."""
        here = self.value(cell)
        for axis in range(3):
            end = list(cell)
            end[axis] += 1
            there = self.value(tuple(end))
            if (here < 0) == (there < 0):
                continue
            u, v = (axis + 1) % 3, (axis + 2) % 3
            quad = []
            for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                around = list(cell)
                around[u] -= du
                around[v] -= dv
                quad.append(self.vertex_of[tuple(around)])
            if here >= 0:
                quad.reverse()
            a, b, c, d = quad

            def apart(i, j):
                return sum((p - q) ** 2 for p, q in zip(self.points[i], self.points[j]))

            if apart(a, c) <= apart(b, d):
                self.triangles += [(a, b, c), (a, c, d)]
            else:
                self.triangles += [(a, b, d), (b, c, d)]


def make_sauropod():
    """Vertices, their normals, and triangles, counter-clockwise seen from outside; it stands on z = 0 and looks along x."""
    net = Net(Skin(limbs()), (0.0, 0.0, 1.3))
    return net.points, net.normals, net.triangles
