"""What simulate and check return."""
from typing import Any, NamedTuple, Optional


class Verdict(NamedTuple):
    """Whether a run can be trusted: docs/reliability.md."""
    kind: str  # 'ok', 'not checked', 'sensitive', 'inaccurate', 'drift', 'gained energy', 'diverged'
    text: str
    time: float  # s

    def __str__(self):
        return self.text


class Energy(NamedTuple):
    """Energies at the frames, each of shape (F,), as in the file of the option energy."""
    kinetic: Any  # J
    gravity: Any  # J, 0 at the height of the first particle
    spring: Any  # J
    total: Any  # J
    dissipated: Any  # J, by the dampers since the start
    residual: Any  # J, total + dissipated - total at the start
    relative_residual: Any  # in units of the energy scale of the scene


class Report(NamedTuple):
    """What check found out. Its text is that of Exercise3 --check."""
    text: str
    verdict: Optional[Verdict]  # None: the run takes too long to be tried
    largest_position_error: Optional[float]  # m
    largest_stable_step: Optional[float]  # s; inf: the whole run; 0: none tried; None: not known, or no fixed steps
    largest_accurate_step: Optional[float]  # s

    def __str__(self):
        return self.text.rstrip()


class Run:
    """The F frames of a run of N particles.

    Attributes:
        time: (F,), s
        positions: (F, N, 2), m
        velocities: (F, N, 2), m/s
        energy: an Energy
        position_error: (F,), m, measured against a reference run; NaN where that is not known
        verdict: a Verdict
        method: its name
        chain: the Chain, with the masses and springs
        seconds: wall-clock time of the integration
        force_evaluations: their number
        closing_line: what Exercise3 prints at the end
    """

    def __init__(self, states, numbers, verdict, **others):
        self.positions = states[:, :2].transpose(0, 2, 1)
        self.velocities = states[:, 2:].transpose(0, 2, 1)
        self.time = numbers[0]
        self.energy = Energy(*numbers[1:8])
        self.position_error = numbers[8]
        self.verdict = Verdict(*verdict)
        self.__dict__.update(others)

    def __repr__(self):
        return self.closing_line

    def plot(self, axes=None):
        """Draws the chain at the first, the last and some other frames, and its energies.

        Args:
            axes: two matplotlib axes; None: those of a new figure

        Returns:
            the matplotlib figure
        """
        from ._pictures import plot
        return plot(self, axes)
