"""Names of the experiments. A module is loaded at its first use."""

from importlib import import_module

from .. import UnknownNameError
from .experiment import Experiment

# Modules of this folder, with "_" for "-"; each defines EXPERIMENT.
_NAMES = ("cheng2020", "khan2022", "pso-tracking", "wang2019", "yuan2016")


def names() -> list[str]:
    """Returns the names of the experiments, in the order in which "all" runs them."""
    return list(_NAMES)


def experiment(name: str) -> Experiment:
    """Returns the experiment of this name.

    Raises:
        UnknownNameError: no experiment of that name; the message lists them.
    """
    if name not in _NAMES:
        raise UnknownNameError(f"no experiment is named '{name}'; known experiments: {', '.join(_NAMES)}, or all")
    module = import_module(f".{name.replace('-', '_')}", __package__)
    found: Experiment = module.EXPERIMENT
    return found
