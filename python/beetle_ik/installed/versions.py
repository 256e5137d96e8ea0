"""Versions of this library and its dependencies, for reports of problems."""

import os
import platform
from collections.abc import Iterator

from .._core import __version__, _instructions

EXTRAS = {
    "bags": ["rosbags"],
    "cli": ["rich", "typer"],
    "distributed": ["dask", "distributed", "zarr"],
    "interop": ["pandas"],
    "jax": ["jax"],
    "plot": ["matplotlib"],
    "report": ["jinja2"],
    "robots": ["robot_descriptions", "xacro"],
    "ros": ["cyclonedds"],
    "sim": ["mujoco"],
    "surfaces": ["trimesh"],
    "torch": ["torch"],
    "view": ["pycollada", "trimesh", "viser"],
    "vision": ["scikit-image"],
}
"""The packages that each extra adds."""


def show_versions() -> None:
    """Prints the versions of beetle-ik and its dependencies, the installed extras, instructions and threads."""
    for name, value in versions():
        print(f"{name:<10} {value}")


def versions() -> Iterator[tuple[str, str]]:
    """Yields the names and values that `show_versions` prints."""
    yield "beetle-ik", __version__
    yield "Python", f"{platform.python_version()} ({platform.python_implementation()})"
    yield "system", f"{platform.system()} {platform.release()}, {platform.machine()}"
    yield "CPU", f"{os.cpu_count()} threads, kernels with {_instructions} instructions"
    yield "numpy", _installed("numpy")
    for extra, packages in EXTRAS.items():
        yield f"[{extra}]", ", ".join(f"{package} {_installed(package)}" for package in packages)


def _installed(package: str) -> str:
    from importlib.metadata import PackageNotFoundError, version  # slow to import

    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"
