"""Programs of students for the exercise, right or with mistakes, independent of the library.

frames(scene, method, mistakes, ...) returns N x 2 arrays; write(...) prints them as programs do.
"""
import numpy as np

DEFAULTS = dict(k_s=50.0, k_d=1.0, L_0=1.0, g=9.81, air=0.0, h=0.01, steps=10)
RK2 = dict(start=[(), (0.5,)], weights=(0, 1))
HEUN = dict(start=[(), (1,)], weights=(0.5, 0.5))
RK4 = dict(start=[(), (0.5,), (0, 0.5), (0, 0, 1)], weights=(1 / 6, 1 / 3, 1 / 3, 1 / 6))


def read_scene(path):
    rows = [line.split('#')[0].split() for line in open(path)]
    return np.array([[float(word) for word in row] for row in rows if row])


def accelerations(p, v, m, c, wrong, real):
    """Spring by spring, unlike the library, which sums the forces on each particle."""
    force = np.zeros_like(p)
    d = p[1:] - p[:-1]
    length = np.sqrt((d * d).sum(axis=1, dtype=real))[:, None]
    r = d / length
    if 'degrees' in wrong or 'angles' in wrong:
        angle = np.arctan2(d[:, 1], d[:, 0]) * (180 / np.pi if 'degrees' in wrong else 1)
        r = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    if 'length_squared' in wrong:
        length = length * length
    if 'length_integer' in wrong:
        length = np.trunc(length)
    w = v[1:] - v[:-1]
    sign = real(-1 if 'damping_sign' in wrong else 0 if 'no_damping' in wrong else 1)
    damping = w if 'damping_not_projected' in wrong else (w * r).sum(axis=1)[:, None] * r
    if 'damping_absolute' in wrong:
        damping = np.abs((w * r).sum(axis=1)[:, None]) * r
    f = real(c['k_s']) * (length - real(c['L_0'])) * r + sign * real(c['k_d']) * damping
    if 'force_sign' in wrong:
        f = -f
    if 'last_spring' in wrong:
        f[-1] = 0
    if 'every_second_spring' in wrong:
        f[1::2] = 0
    if 'one_spring_next' not in wrong:
        force[1:] -= f
    if 'one_spring_previous' not in wrong:
        force[:-1] += f
    force -= real(c['air']) * v
    if 'mass_of_neighbour' in wrong:
        a = force / np.concatenate([m[:1], m[:-1]])
    else:
        a = force if 'mass_not_divided' in wrong else force / m
    g = np.tile(np.array([0, real(c['g'])], dtype=real), (len(p), 1))
    if 'gravity_on_last' in wrong:
        g[:-1] = 0
    a = a - (g / m if 'gravity_divided' in wrong else g)
    if 'first_moves' not in wrong:
        a[0] = 0
    return a.astype(real)


def euler_step(p, v, f, h, wrong):
    if 'in_place' in wrong:
        for i in range(len(p)):
            a = f(p, v)[i]
            old = v[i].copy()
            v[i] = v[i] + h * a
            p[i] = p[i] + h * (v[i] if 'semi_implicit' in wrong else old)
        return p, v
    a = f(p, v)
    new = v + h * a
    return p + h * (new if 'semi_implicit' in wrong else v), new


def implicit_step(p, v, f, h):
    """Solved by iteration, which converges for the springs and steps of the exercise."""
    new = v
    for _ in range(100):
        new, last = v + h * f(p + h * new, new), new
        if np.abs(new - last).max() < 1e-10:
            break
    return p + h * new, new


def runge_kutta_step(p, v, f, h, tableau, wrong):
    slopes = []
    real = p.dtype.type
    for row in tableau['start']:
        pos, vel = p.copy(), v.copy()
        for weight, (kp, kv) in zip(row, slopes):
            pos = pos + h * real(weight) * kp
            vel = vel + h * real(weight) * kv
        if 'semi_implicit_stages' in wrong and row:
            pos = p + h * real(sum(row)) * vel
        slopes.append((vel, f(pos, vel)))
    new_v, new_p = v.copy(), p.copy()
    for weight, (kp, kv) in zip(tableau['weights'], slopes):
        new_v = new_v + h * real(weight) * kv
        new_p = new_p + h * real(weight) * kp
    if 'semi_implicit' in wrong:
        new_p = p + h * real(sum(tableau['weights'])) * new_v
    return new_p, new_v


def frames(scene, method='Runge-Kutta-4', wrong=(), count=500, tableau=None, **constants):
    c = dict(DEFAULTS, **constants)
    real = np.float32 if 'single_precision' in wrong else np.float64
    p, v, m = scene[:, :2].astype(real), np.zeros((len(scene), 2), real), scene[:, 2:].astype(real)
    tableau = tableau or {'Runge-Kutta-2': RK2, 'Runge-Kutta-4': RK4}.get(method)
    if 'heun' in wrong:
        tableau = HEUN
    h = real(c['h'])

    def f(pos, vel):
        return accelerations(pos, vel, m, c, wrong, real)

    def step(pos, vel):
        if method == 'Euler':
            return euler_step(pos, vel, f, h, wrong)
        if method == 'Backward-Euler':
            return implicit_step(pos, vel, f, h)
        return runge_kutta_step(pos, vel, f, h, tableau, wrong)

    result = []
    if 'frame_late' in wrong:
        for _ in range(c['steps']):
            p, v = step(p, v)
    with np.errstate(all='ignore'):
        for n in range(count):
            rows = p[::-1] if 'reversed' in wrong else p
            result.append((rows[:, ::-1] if 'swapped' in wrong else rows).astype(float).copy())
            if n == 0 and 'frame_early' in wrong or 'no_motion' in wrong:
                continue
            for _ in range(c['steps']):
                p, v = step(p, v)
    return result


def number(value, form):
    """Text as programs print it: '6g' like C++ streams, '6f' like printf, 'r' the shortest, 's' that of a float in C++."""
    short = np.float32(value) if form == 's' else value
    return repr(float(value)) if form == 'r' else format(value, '.' + form) if form != 's' else (
        str(int(short)) if 1e8 <= abs(short) < 1e12 else str(short))


def write(folder, result, form='17g', separator=' ', first=0):
    folder.mkdir(parents=True, exist_ok=True)
    for n, frame in enumerate(result):
        text = ''.join(separator.join(number(x, form) for x in row) + '\n' for row in frame)
        (folder / f'frame_{n + first:04d}.txt').write_text(text)
