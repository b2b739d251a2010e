# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes' textures, computed: arrays (height, width, 3) of linear Rec. 709, rows from the bottom, numpy only.

All repeat without a seam where their texture coordinates do.
"""

import numpy as np


def grid(width, height):
    """Pixel centres: u and v, each (height, width), 0 to 1."""
    return np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)


def noise(seed, width, height, wavelength, aspect=1.0, slope=2.0):
    """Periodic Gaussian noise, mean 0, deviation 1. Power falls by frequency^−slope above 1/wavelength (a share of the
    width) and is flat below; `aspect` > 1 stretches it along u."""
    white = np.random.RandomState(seed).normal(size=(height, width))
    fu = np.fft.fftfreq(width) * width * aspect
    fv = np.fft.fftfreq(height) * width
    frequency = np.hypot(*np.meshgrid(fu, fv)) * wavelength
    amplitude = np.where(frequency < 1, 1.0, np.maximum(frequency, 1) ** -slope)
    amplitude[0, 0] = 0
    smooth = np.fft.ifft2(np.fft.fft2(white) * amplitude).real
    return smooth / smooth.std()


def mix(a, b, t):
    """a where t is 0, b where it is 1; colours a and b, t (height, width)."""
    t = np.asarray(t)[..., None]
    return np.asarray(a, float) * (1 - t) + np.asarray(b, float) * t


def edge(x, width):
    """0 below −width/2, 1 above width/2, a soft step between."""
    t = np.clip(x / width + 0.5, 0, 1)
    return t * t * (3 - 2 * t)


def normal_map(height, metres_u, metres_v):
    """The tangent-space normals (OpenGL's convention, as 0…1) of a periodic height in metres over one repeat of
    metres_u × metres_v."""
    rows, columns = height.shape
    du = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * columns / (2 * metres_u)
    dv = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) * rows / (2 * metres_v)
    normal = np.stack([-du, -dv, np.ones_like(du)], -1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True) / 2 + 0.5


def checker(first, second, size=64):
    """Two by two squares."""
    u, v = grid(size, size)
    return mix(first, second, (u < 0.5) != (v < 0.5))


def wood(seed, width, height, boards, dark, light):
    """Boards along u, each with its own tone and grain."""
    u, v = grid(width, height)
    board = np.minimum((v * boards).astype(int), boards - 1)
    random = np.random.RandomState(seed)
    tone = random.uniform(-0.22, 0.22, boards)[board]
    shift = random.randint(0, width, boards)
    bend = noise(seed + 1, width, height, 0.5, aspect=3, slope=3)
    across = (v * boards - board) * random.uniform(2.2, 4.0, boards)[board] + random.uniform(0, 9, boards)[board]
    rows = np.arange(height)[:, None]
    bend = bend[rows, (np.arange(width)[None] + shift[board[:, :1]]) % width]
    rings = 0.5 + 0.5 * np.sin(2 * np.pi * (across + 0.42 * bend))
    fibre = noise(seed + 2, width, height, 0.012, aspect=14, slope=1.3)
    t = 0.36 + 0.27 * rings**1.4 + tone + 0.06 * fibre
    seam = np.minimum(v * boards - board, board + 1 - v * boards) / boards
    t = t * (0.35 + 0.65 * edge(seam - 0.0022, 0.003))
    return mix(dark, light, np.clip(t, 0, 1))


def parquet(seed, pixels, dark, light):
    """Basket weave: 4 × 4 squares of four staves, turned in turn."""
    u, v = grid(pixels, pixels)
    square_u, square_v = (u * 4).astype(int), (v * 4).astype(int)
    turned = (square_u + square_v) % 2 == 1
    along, across = np.where(turned, v * 4 - square_v, u * 4 - square_u), np.where(turned, u * 4 - square_u,
                                                                                  v * 4 - square_v)
    stave = np.minimum((across * 4).astype(int), 3)
    tone = np.random.RandomState(seed).uniform(0.15, 0.75, (4, 4, 4))[square_u, square_v, stave]
    grain_u, grain_v = noise(seed + 1, pixels, pixels, 0.02, 8, 1.2), noise(seed + 2, pixels, pixels, 0.02, 8, 1.2).T
    t = tone + 0.09 * np.where(turned, grain_v, grain_u)
    gap = np.minimum(across * 4 - stave, stave + 1 - across * 4) / 4
    gap = np.minimum(gap, np.minimum(along, 1 - along))
    return mix(dark, light, np.clip(t, 0, 1) * (0.45 + 0.55 * edge(gap - 0.012, 0.016)))


def glazed_bands(width, height, ground, ink, second):
    """A painted bowl: u around, v from the foot up the outside, over the rim and down the inside."""
    u, v = grid(width, height)
    picture = np.broadcast_to(np.asarray(ground, float), (height, width, 3)).copy()
    soft = 2.0 / height

    def stripe(low, high):
        return edge(v - low, soft) * edge(high - v, soft)

    def paint(color, cover):
        picture[:] = picture * (1 - cover[..., None]) + np.asarray(color, float) * cover[..., None]

    for low, high, color in ((0.10, 0.115, ink), (0.13, 0.137, ink), (0.158, 0.182, second), (0.203, 0.211, ink),
                             (0.452, 0.460, ink), (0.476, 0.504, ink), (0.522, 0.542, second), (0.66, 0.667, ink)):
        paint(color, stripe(low, high))
    # A band of leaves between the lines: lens shapes, with a dot above and below each gap.
    count, low, high = 16, 0.222, 0.441
    x = (u * count) % 1 - 0.5
    y = (v - low) / (high - low)
    lens = 0.36 * np.sin(np.pi * np.clip(y, 0, 1)) ** 1.2
    inside = (y > 0) & (y < 1)
    paint(ink, np.where(inside, edge(lens - np.abs(x), 0.05), 0))
    paint(ground, np.where(inside, edge(lens * 0.62 - np.abs(x), 0.05), 0))
    paint(second, np.where(inside, edge(lens * 0.36 - np.abs(x), 0.05), 0))
    x2 = ((u * count + 0.5) % 1 - 0.5) / count * 3.2
    for centre in (0.262, 0.401):
        paint(ink, edge(0.018 - np.hypot(x2, v - centre), 0.008))
    # Inside: waves under the rim.
    wave = 0.6 + 0.018 * np.sin(2 * np.pi * u * count)
    paint(ink, edge(0.009 - np.abs(v - wave), soft * 2))
    return picture


def plaster(seed, pixels, color, amount):
    """A nearly plain wall: a colour with slow clouds of light and dark."""
    clouds = noise(seed, pixels, pixels, 0.35, slope=1.7)
    return np.asarray(color, float) * (1 + amount * np.clip(clouds, -2, 2))[..., None]


def pages(seed, width, height):
    """The cut edge of a book's pages, lines along u."""
    lines = np.random.RandomState(seed).uniform(-1, 1, (height, 1)) * np.ones((1, width))
    lines = lines + 0.25 * noise(seed, width, height, 0.3, aspect=2, slope=2)
    return mix((0.80, 0.70, 0.52), (0.56, 0.46, 0.31), np.clip(0.4 + 0.35 * lines, 0, 1))


def studio_sky(width, height):
    """A dim room seen from its table: grey-brown walls, a tall window to the left, a paler one to the right behind."""
    u, v = grid(width, height)
    up = np.sin((v - 0.5) * np.pi)
    picture = mix((0.07, 0.055, 0.045), (0.22, 0.215, 0.21), edge(up, 1.6))
    # u = 1/2 − longitude/2π with longitude from +x towards +y: −y (behind the camera) is u = 0.75, −x is u = 0 or 1.
    for centre, half, low, high, color in ((0.90, 0.055, 0.50, 0.74, (1.0, 0.97, 0.90)),
                                           (0.62, 0.035, 0.52, 0.70, (0.42, 0.50, 0.62))):
        x, soft = (u - centre + 0.5) % 1 - 0.5, 0.008
        glass = edge(half - np.abs(x), soft) * edge(v - low, 2 * soft) * edge(high - v, 2 * soft)
        bars = edge(np.abs(x) - 0.003, 0.003) * edge(np.abs(v - (low + high) / 2) - 0.005, 0.004)
        picture = picture * (1 - glass[..., None]) + np.asarray(color) * (glass * bars)[..., None]
    return picture


def gradient_sky(seed, width, height):
    """A summer sky in linear radiance up to 1: pale horizon, deep zenith, some clouds; dull green below."""
    u, v = grid(width, height)
    up = np.sin((v - 0.5) * np.pi)
    sky = mix((0.72, 0.82, 0.92), (0.16, 0.34, 0.72), np.clip(up, 0, 1) ** 0.55)
    cloud = np.clip(0.55 * noise(seed, width, height, 0.11, aspect=0.6, slope=2.2) - 0.25, 0, 1) * edge(up - 0.2, 0.3)
    sky = mix(sky, (0.95, 0.95, 0.96), np.zeros_like(up)) * (1 - cloud[..., None]) + 0.95 * cloud[..., None]
    ground = mix((0.16, 0.19, 0.10), (0.30, 0.33, 0.24), edge(up + 0.15, 0.25))
    t = edge(up, 0.02)[..., None]
    return ground * (1 - t) + sky * t


def painting(kind, width, height):
    """Three abstract pictures for the gallery's walls, after no one: "fields", "hills" and "rings"."""
    u, v = grid(width, height)
    if kind == "fields":
        random = np.random.RandomState(5)
        palette = np.array([(0.62, 0.10, 0.06), (0.85, 0.55, 0.12), (0.80, 0.76, 0.66), (0.06, 0.13, 0.24),
                            (0.10, 0.32, 0.36), (0.75, 0.72, 0.62)])
        us, vs = np.sort(random.uniform(0.08, 0.92, 4)), np.sort(random.uniform(0.08, 0.92, 5))
        index = random.randint(0, len(palette), (len(us) + 1, len(vs) + 1))
        picture = palette[index[np.searchsorted(us, u), np.searchsorted(vs, v)]]
        line = np.min([np.abs(u - x) * width / height for x in us] + [np.abs(v - y) for y in vs], 0)
        return mix((0.02, 0.02, 0.025), (1, 1, 1), edge(line - 0.012, 0.006)) * picture
    if kind == "hills":
        picture = mix((0.95, 0.62, 0.30), (0.20, 0.38, 0.62), np.clip(v * 1.25 - 0.2, 0, 1))
        sun = edge(0.09 - np.hypot((u - 0.67) * width / height, v - 0.66), 0.01)
        picture = mix(np.zeros(3), np.array([1.0, 0.86, 0.62]), sun) + picture * (1 - sun[..., None])
        for k, color in enumerate([(0.36, 0.42, 0.55), (0.22, 0.30, 0.42), (0.14, 0.24, 0.26), (0.06, 0.13, 0.12)]):
            random = np.random.RandomState(20 + k)
            ridge = 0.60 - 0.14 * k
            for f in range(1, 6):
                ridge = ridge + 0.10 / f**1.3 * np.sin(2 * np.pi * f * u + random.uniform(0, 6.28)) * (0.5 + 0.14 * k)
            picture = picture * (1 - edge(ridge - v, 0.006))[..., None] + np.asarray(color) * edge(ridge - v, 0.006)[
                ..., None]
        return picture
    if kind == "rings":
        picture = np.broadcast_to(np.array([0.80, 0.75, 0.64]), (height, width, 3)).copy()
        aspect = width / height
        for x, y, r, color in ((0.38, 0.60, 0.30, (0.72, 0.16, 0.08)), (0.62, 0.36, 0.24, (0.07, 0.20, 0.36)),
                               (0.70, 0.72, 0.13, (0.86, 0.58, 0.12)), (0.26, 0.24, 0.10, (0.08, 0.30, 0.28))):
            distance = np.hypot((u - x) * aspect, v - y)
            cover = edge(r - distance, 0.006) * (0.62 + 0.38 * edge(np.sin(distance / r * 4.5 * np.pi), 0.25))
            picture = picture * (1 - cover[..., None]) + np.asarray(color) * picture / 0.8 * cover[..., None]
        return picture
    raise ValueError(f"no painting {kind!r}")


def linen(width, height, ground, stripe):
    """A runner: plain weave, with stripes along both long sides. u runs along the cloth, v across."""
    u, v = grid(width, height)
    side = np.minimum(v, 1 - v)
    cover = sum(edge(side - low, 0.006) * edge(high - side, 0.006)
                for low, high in ((0.075, 0.085), (0.10, 0.15), (0.165, 0.175)))
    weave = 1 + 0.035 * noise(71, width, height, 0.008, 8, 0.8) + 0.035 * noise(72, width, height, 0.02, 0.12, 0.8)
    return mix(ground, stripe, 0.9 * cover) * weave[..., None]


def book_cover(width, height, leather, gold):
    """Leather with two gold rules near each end. u runs along the spine."""
    u, v = grid(width, height)
    side = np.minimum(u, 1 - u)
    rules = sum(edge(side - low, 0.008) * edge(high - side, 0.008) for low, high in ((0.10, 0.122), (0.135, 0.143)))
    panel = edge(0.16 - np.abs(u - 0.5), 0.01) * 0.9
    frame = panel * (1 - edge(0.145 - np.abs(u - 0.5), 0.01))
    mottle = 1 + 0.07 * noise(81, width, height, 0.06, slope=1.4)
    return mix(np.asarray(leather) * mottle[..., None], gold, np.clip(rules + frame, 0, 1))
