"""Pictures of a run, with the colours and labels of the package. Only these functions need matplotlib."""
import base64
import html
import io

import numpy as np

PARTICLE, GRID, BORDER, TRAIL = '#2f3640', '#ececec', '#a0a0a0', '#e67814'
ENERGY_COLORS = {'total': '#2f3640', 'kinetic': '#1f5fa8', 'gravity': '#b8860b', 'spring': '#c1440e',
                 'dissipated': '#8a8a8a'}
SHOWN_SPRINGS = 1000  # of a longer chain, only every k-th particle is drawn
SHOWN_CHAINS = 5


def _matplotlib():
    try:
        from matplotlib import pyplot  # type: ignore
    except ImportError as error:
        raise ImportError('pictures need matplotlib: install python3-matplotlib') from error
    return pyplot


def _strain_colors(lengths, rest_length):
    """From blue (a quarter shorter) over grey to red (a quarter longer), shape (n, 3)."""
    strain = lengths / rest_length - 1 if rest_length > 0 else np.zeros(len(lengths))
    share = np.clip(4 * strain, -1, 1)[:, None]
    grey, blue, red = np.array([[150, 150, 158], [25, 90, 210], [214, 40, 30]]) / 255
    return np.where(share < 0, grey - share * (blue - grey), grey + share * (red - grey))


def _segments(positions):
    return np.stack([positions[:-1], positions[1:]], axis=1)


class _Picture:
    """The axes with the chain, which is drawn again for each frame."""

    def __init__(self, run, axes):
        stride = max(1, run.positions.shape[1] // SHOWN_SPRINGS)
        self.positions = run.positions[:, ::stride]
        self.rest_length = stride * run.chain.rest_length
        self.axes = axes
        axes.set_aspect('equal', adjustable='datalim')
        axes.grid(color=GRID)
        axes.set_axisbelow(True)
        axes.set_xlabel('x in m')
        axes.set_ylabel('y in m')
        for spine in axes.spines.values():
            spine.set_color(BORDER)

    def chain(self, frame, alpha=1.0):
        from matplotlib.collections import LineCollection  # type: ignore
        places = self.positions[frame]
        segments = _segments(places)
        colors = _strain_colors(np.hypot(*np.diff(places, axis=0).T), self.rest_length)
        springs = self.axes.add_collection(LineCollection(segments, colors=colors, linewidths=2, alpha=alpha))
        size = 4 if len(places) <= 100 else 0
        particles, = self.axes.plot(places[:, 0], places[:, 1], 'o', color=PARTICLE, markersize=size, alpha=alpha)
        self.axes.plot(*places[0], 's', color=PARTICLE, markersize=6)
        return springs, particles


def plot(run, axes=None):
    pyplot = _matplotlib()
    if axes is None:
        _, axes = pyplot.subplots(1, 2, figsize=(10, 4.2), constrained_layout=True)
    picture = _Picture(run, axes[0])
    last = len(run.time) - 1
    for number, frame in enumerate(np.unique(np.linspace(0, last, SHOWN_CHAINS).astype(int))):
        picture.chain(frame, alpha=0.25 + 0.75 * number / (SHOWN_CHAINS - 1))
    axes[0].plot(run.positions[:, -1, 0], run.positions[:, -1, 1], color=TRAIL, linewidth=0.6, zorder=0)
    axes[0].set_title('%s, t = 0 to %.4g s' % (run.method, run.time[-1]))
    for name, color in ENERGY_COLORS.items():
        axes[1].plot(run.time, getattr(run.energy, name), color=color, label=name)
    axes[1].grid(color=GRID)
    axes[1].set_xlabel('t in s')
    axes[1].set_ylabel('energy in J')
    axes[1].legend()
    return axes[0].figure


def animate(run, path=None, trail=1.5):
    pyplot = _matplotlib()
    from matplotlib.animation import FuncAnimation, PillowWriter  # type: ignore
    interval = float(run.time[1] - run.time[0]) if len(run.time) > 1 else 1.0
    stride = max(1, round(0.04 / interval))  # at most 25 pictures per second
    figure, axes = pyplot.subplots(figsize=(4.8, 4.8))
    picture = _Picture(run, axes)
    springs, particles = picture.chain(0)
    tip, = axes.plot([], [], color=TRAIL, linewidth=1.5, zorder=0)
    places = picture.positions
    low, high = places.min(axis=(0, 1)), places.max(axis=(0, 1))
    middle, half = 0.5 * (low + high), 0.55 * max(*(high - low), 1e-3)
    axes.set_adjustable('box')
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))

    def show(frame):
        now = places[frame]
        springs.set_segments(_segments(now))
        springs.set_color(_strain_colors(np.hypot(*np.diff(now, axis=0).T), picture.rest_length))
        particles.set_data(now[:, 0], now[:, 1])
        tip.set_data(*places[max(0, frame - int(trail / interval)):frame + 1, -1].T)
        axes.set_title('t = %.2f s' % run.time[frame])
        return springs, particles, tip

    animation = FuncAnimation(figure, show, frames=range(0, len(run.time), stride),
                              interval=1000 * stride * interval)
    if path is not None:
        animation.save(path, writer=PillowWriter(fps=1 / (stride * interval)))
    return animation


def html_of(run):
    """A small table, and a picture if matplotlib is installed."""
    frames, particles, _ = run.positions.shape
    errors = run.position_error[np.isfinite(run.position_error)]
    rows = {'method': run.method, 'particles': particles, 'frames': frames,
            'force evaluations': run.force_evaluations, 'integrated in': '%.3g ms' % (1e3 * run.seconds),
            'largest position error': '%.2g m' % errors.max() if len(errors) else 'not measured',
            'verdict': run.verdict.text}
    text = ''.join('<tr><th>%s</th><td>%s</td></tr>' % (name, html.escape(str(value)))
                   for name, value in rows.items())
    try:
        pyplot = _matplotlib()
    except ImportError:
        return '<table>%s</table>' % text
    figure = plot(run)
    image = io.BytesIO()
    figure.savefig(image, format='png', dpi=70)
    pyplot.close(figure)
    return '<table>%s</table><img src="data:image/png;base64,%s"/>' % (
        text, base64.b64encode(image.getvalue()).decode())
