"""What simulate and check return."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Tuple

from . import _pictures
from ._core import Chain

if TYPE_CHECKING:
    from numpy.typing import NDArray
    import numpy as np
    Array = NDArray[np.float64]


class Verdict(NamedTuple):
    """Whether a run can be trusted: docs/reliability.md."""
    kind: str  # 'ok', 'not checked', 'sensitive', 'inaccurate', 'drift', 'gained energy', 'diverged'
    text: str
    time: float  # s

    def __str__(self) -> str:
        return self.text


class Energy(NamedTuple):
    """Energies at the frames, each of shape (F,), as in the file of the option energy."""
    kinetic: Array  # J
    gravity: Array  # J, 0 at the height of the first particle
    spring: Array  # J
    total: Array  # J
    dissipated: Array  # J, by the dampers since the start
    residual: Array  # J, total + dissipated - total at the start
    relative_residual: Array  # in units of the energy scale of the scene


class Report(NamedTuple):
    """What check found out. Its text is that of Exercise3 --check."""
    text: str
    verdict: Optional[Verdict]  # None: the run takes too long to be tried
    largest_position_error: Optional[float]  # m
    largest_stable_step: Optional[float]  # s; inf: the whole run; 0: none tried; None: not known, or no fixed steps
    largest_accurate_step: Optional[float]  # s

    def __str__(self) -> str:
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

    def __init__(self, states: Array, numbers: Array, chain: Chain, method: str,
                 verdict: Tuple[str, str, float], seconds: float, force_evaluations: int, closing_line: str) -> None:
        self.positions: Array = states[:, :2].transpose(0, 2, 1)
        self.velocities: Array = states[:, 2:].transpose(0, 2, 1)
        self.time: Array = numbers[0]
        self.energy = Energy(*numbers[1:8])
        self.position_error: Array = numbers[8]
        self.chain = chain
        self.method = method
        self.verdict = Verdict(*verdict)
        self.seconds = seconds
        self.force_evaluations = force_evaluations
        self.closing_line = closing_line

    def __repr__(self) -> str:
        return self.closing_line

    def _repr_html_(self) -> str:
        return _pictures.html_of(self)

    def plot(self, axes: Any = None) -> Any:
        """Draws the chain at the first, the last and some other frames, and its energies.

        Args:
            axes: two matplotlib axes; None: those of a new figure

        Returns:
            the matplotlib figure
        """
        return _pictures.plot(self, axes)

    def animate(self, path: Any = None, trail: float = 1.5) -> Any:
        """Animates the chain at the speed of the motion.

        Args:
            path: GIF to write; None: none
            trail: how long the path of the last particle stays visible, s

        Returns:
            the matplotlib FuncAnimation; keep it as long as it runs
        """
        return _pictures.animate(self, path, trail)
