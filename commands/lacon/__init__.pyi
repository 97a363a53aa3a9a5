"""The types of what `import lacon` offers; docs/python.md says what each does."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib.figure
import meshio
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
StrPath = str | os.PathLike[str]

version: str

class Error(Exception):
    messages: list[Any]
    @property
    def id_message(self) -> str: ...
    @property
    def message(self) -> str: ...

class Mesh:
    label: str
    dimension: int
    points: Floats
    connectivity: tuple[Integers, Integers]
    cell_types: NDArray[np.str_]
    cells: dict[str, tuple[Integers, Integers]]
    groups: dict[str, Integers]
    node_groups: dict[str, Integers]
    patches: list[Integers]
    patch_zones: list[tuple[str, int, int]]
    boundary: dict[int, tuple[Integers, Integers]]
    def cells_of_dimension(self, dimension: int) -> dict[str, tuple[Integers, Integers]]: ...
    def polygons(self, cells: Sequence[int]) -> list[Integers]: ...
    def to_meshio(self, points: Floats | None = None) -> meshio.Mesh: ...
    def plot(self) -> matplotlib.figure.Figure: ...

class Field:
    name: str
    quantity: str
    location: str
    components: list[str]
    order: int
    instant: float
    support: Integers
    offset: Integers | None
    values: Floats
    present: NDArray[np.bool_]
    def __getitem__(self, component: str) -> Floats: ...
    def on_nodes(self, count: int, counted: bool = False) -> tuple[Floats, NDArray[np.bool_]]: ...

class Patches:
    instant: float
    groups: list[str]
    status: Integers
    pressure: Floats
    gap: Floats
    coverage: Floats
    zone: Integers
    area: Floats
    centre: Floats
    masters: tuple[Integers, Integers, Floats] | None
    def masters_of(self, patch: int) -> dict[int, float]: ...
    def __len__(self) -> int: ...

class Attempt:
    instant: float
    at: float
    iterations: list[dict[str, Any]]
    solved: bool

class Journal:
    attempts: list[Attempt]
    instants: list[float]
    limits: dict[str, float | None]
    patches: int
    ended: bool
    completed: bool
    def iterations(self) -> list[tuple[Attempt, dict[str, Any]]]: ...
    def reached(self) -> float: ...
    def share(self, instant: float) -> float: ...
    def seconds_left(self) -> float | None: ...

class States:
    label: str
    orders: list[int]
    instants: Floats
    complete: bool
    mesh: Mesh
    parameters: dict[str, Floats]
    journal: Journal | None
    def order_of(self, instant: float | None = None, order: int | None = None) -> int: ...
    def field(self, name: str, instant: float | None = None, order: int | None = None) -> Field: ...
    def displacements(self, instant: float | None = None, order: int | None = None) -> Floats: ...
    def contact(self, instant: float | None = None, order: int | None = None) -> Patches | None: ...
    def to_meshio(self, instant: float | None = None, order: int | None = None) -> meshio.Mesh: ...
    def plot(self, instant: float | None = None, order: int | None = None, scale: float = 1.0, field: str | None = None,
             component: str | None = None) -> matplotlib.figure.Figure: ...
    def plot_pressure(self, instant: float | None = None, order: int | None = None) -> matplotlib.figure.Figure: ...
    def plot_convergence(self) -> matplotlib.figure.Figure: ...

class Result(States):
    failed_step: FailedStep | None
    is_of_revolution: bool
    @property
    def fields(self) -> dict[str, list[float]]: ...

class FailedStep(States):
    instant: float
    begins: float
    message: str
    reason: str
    @property
    def fields(self) -> dict[str, list[int]]: ...

class Base:
    folder: Path
    def __init__(self, folder: StrPath) -> None: ...
    @property
    def running(self) -> dict[str, Any] | None: ...
    @property
    def meshes(self) -> dict[str, Mesh]: ...
    @property
    def results(self) -> dict[str, Result]: ...
    @property
    def failed_steps(self) -> dict[str, FailedStep]: ...
    def __getitem__(self, label: str) -> Any: ...
    def only_result(self, label: str | None = None) -> Result | FailedStep: ...

def open(folder: StrPath) -> Base: ...

class Run:
    status: int
    diagnostic: str
    output: str
    log: str
    checks: list[dict[str, Any]]
    base: Base | None

class RunFailed(Exception):
    run: Run

def run_study(*files: StrPath, units: dict[int, StrPath] | None = None, base: StrPath | None = None, fresh: bool = False,
              threads: int | None = None, check: bool = True) -> Run: ...

class Study:
    F: type[dict[str, Any]]
    CO: Callable[[str], Any]
    def __init__(self, base: StrPath, units: dict[int, StrPath] | None = None, fresh: bool = False, threads: int | None = None,
                 quiet: bool = True) -> None: ...
    def __enter__(self) -> Study: ...
    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None: ...
    @property
    def base(self) -> Base: ...
    @property
    def checks(self) -> list[Any]: ...
    def __getattr__(self, name: str) -> Callable[..., Any]: ...
