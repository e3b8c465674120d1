"""Pictures of a run, with the colours and labels of the package. Only this file needs matplotlib."""
import numpy as np

try:
    from matplotlib import pyplot
    from matplotlib.collections import LineCollection
except ImportError as error:
    raise ImportError('pictures need matplotlib: install python3-matplotlib') from error

PARTICLE, GRID, BORDER, TRAIL = '#2f3640', '#ececec', '#a0a0a0', '#e67814'
ENERGY_COLORS = {'total': '#2f3640', 'kinetic': '#1f5fa8', 'gravity': '#b8860b', 'spring': '#c1440e',
                 'dissipated': '#8a8a8a'}
SHOWN_SPRINGS = 1000  # of a longer chain, only every k-th particle is drawn
SHOWN_CHAINS = 5


def _strain_colors(lengths, rest_length):
    """From blue (a quarter shorter) over grey to red (a quarter longer), shape (n, 3)."""
    strain = lengths / rest_length - 1 if rest_length > 0 else np.zeros(len(lengths))
    share = np.clip(4 * strain, -1, 1)[:, None]
    grey, blue, red = np.array([[150, 150, 158], [25, 90, 210], [214, 40, 30]]) / 255
    return np.where(share < 0, grey - share * (blue - grey), grey + share * (red - grey))


def _draw_chain(axes, places, rest_length, alpha):
    colors = _strain_colors(np.hypot(*np.diff(places, axis=0).T), rest_length)
    axes.add_collection(LineCollection(np.stack([places[:-1], places[1:]], axis=1), colors=colors, linewidths=2,
                                       alpha=alpha))
    axes.plot(*places.T, 'o', color=PARTICLE, markersize=4 if len(places) <= 100 else 0, alpha=alpha)
    axes.plot(*places[0], 's', color=PARTICLE, markersize=6)


def plot(run, axes=None):
    if axes is None:
        _, axes = pyplot.subplots(1, 2, figsize=(10, 4.2), constrained_layout=True)
    chain, energy = axes
    stride = max(1, run.positions.shape[1] // SHOWN_SPRINGS)
    last = len(run.time) - 1
    for number, frame in enumerate(np.unique(np.linspace(0, last, SHOWN_CHAINS).astype(int))):
        _draw_chain(chain, run.positions[frame, ::stride], stride * run.chain.rest_length,
                    0.25 + 0.75 * number / (SHOWN_CHAINS - 1))
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
