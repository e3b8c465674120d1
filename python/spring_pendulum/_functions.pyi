import os
from typing import Literal, Union

from numpy.typing import ArrayLike

from ._run import Report, Run

_Path = Union[str, os.PathLike[str]]

def simulate(
    particles: Union[_Path, ArrayLike] = ...,
    *,
    # BEGIN of generated keywords except particles (scripts/generate.sh)
    method: str = ...,
    resume: bool = ...,
    output: _Path = ...,
    no_frames: bool = ...,
    energy: _Path = ...,
    save_state: _Path = ...,
    start: Literal['file', 'at_rest'] = ...,
    on_divergence: Literal['stop', 'continue'] = ...,
    reference: Literal['auto', 'always', 'never'] = ...,
    frames: int = ...,
    steps_per_frame: int = ...,
    time_step: float = ...,
    tolerance: float = ...,
    frame_interval: float = ...,
    stiffness: float = ...,
    damping: float = ...,
    rest_length: float = ...,
    gravity: float = ...,
    air_drag: float = ...,
    threads: int = ...,
    sleep: float = ...,
    # END of generated keywords
) -> Run: ...
def check(
    particles: Union[_Path, ArrayLike] = ...,
    *,
    # BEGIN of generated keywords except particles (scripts/generate.sh)
    method: str = ...,
    resume: bool = ...,
    output: _Path = ...,
    no_frames: bool = ...,
    energy: _Path = ...,
    save_state: _Path = ...,
    start: Literal['file', 'at_rest'] = ...,
    on_divergence: Literal['stop', 'continue'] = ...,
    reference: Literal['auto', 'always', 'never'] = ...,
    frames: int = ...,
    steps_per_frame: int = ...,
    time_step: float = ...,
    tolerance: float = ...,
    frame_interval: float = ...,
    stiffness: float = ...,
    damping: float = ...,
    rest_length: float = ...,
    gravity: float = ...,
    air_drag: float = ...,
    threads: int = ...,
    sleep: float = ...,
    # END of generated keywords
) -> Report: ...
