"""Runs as Python objects."""
from . import _core


class Run:
    def __init__(self, states, numbers, **others):
        self.positions = states[:, :2].transpose(0, 2, 1)
        self.velocities = states[:, 2:].transpose(0, 2, 1)
        self.time = numbers[0]
        self.__dict__.update(others)

    def __repr__(self):
        return self.closing_line


def simulate(particles="particle.txt", **options):
    return Run(**_core.simulate(particles, options))
