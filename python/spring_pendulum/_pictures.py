"""Pictures of a run, with the colours and labels of the package. Only this file needs matplotlib."""
import numpy as np

try:
    from matplotlib import pyplot
except ImportError as error:
    raise ImportError('pictures need matplotlib: install python3-matplotlib') from error

PARTICLE, GRID, BORDER, TRAIL = '#2f3640', '#ececec', '#a0a0a0', '#e67814'
ENERGY_COLORS = {'total': '#2f3640', 'kinetic': '#1f5fa8', 'gravity': '#b8860b', 'spring': '#c1440e',
                 'dissipated': '#8a8a8a'}
SHOWN_SPRINGS = 1000  # of a longer chain, only every k-th particle is drawn
SHOWN_CHAINS = 5


def plot(run, axes=None):
    if axes is None:
        _, axes = pyplot.subplots(1, 2, figsize=(10, 4.2), constrained_layout=True)
    chain, energy = axes
    stride = max(1, run.positions.shape[1] // SHOWN_SPRINGS)
    last = len(run.time) - 1
    for number, frame in enumerate(np.unique(np.linspace(0, last, SHOWN_CHAINS).astype(int))):
        chain.plot(*run.positions[frame, ::stride].T, 'o-', color=PARTICLE, alpha=0.2 + 0.2 * number,
                   markersize=4 if run.positions.shape[1] <= 100 else 0)
    chain.plot(*run.positions[0, 0], 's', color=PARTICLE)
    chain.plot(*run.positions[:, -1].T, color=TRAIL, linewidth=0.6, zorder=0)
    chain.set_aspect('equal', adjustable='datalim')
    chain.set(xlabel='x in m', ylabel='y in m', title='%s, t = 0 to %.4g s' % (run.method, run.time[-1]))
    for name, color in ENERGY_COLORS.items():
        energy.plot(run.time, getattr(run.energy, name), color=color, label=name)
    energy.set(xlabel='t in s', ylabel='energy in J')
    energy.legend()
    for each in axes:
        each.grid(color=GRID)
        each.set_axisbelow(True)
        for spine in each.spines.values():
            spine.set_color(BORDER)
    return chain.figure
