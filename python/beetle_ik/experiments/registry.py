"""Names of the experiments. A module is loaded when it is first needed."""

from importlib import import_module

from .. import UnknownNameError
from .experiment import Experiment

# One module of this folder each, of the same name with "_" for "-"; it holds EXPERIMENT.
_NAMES = ("cheng2020", "khan2022", "pso-tracking", "wang2019", "yuan2016")


def names() -> list[str]:
    """The experiments, in the order in which "all" runs them."""
    return list(_NAMES)


def experiment(name: str) -> Experiment:
    """The experiment of this name.

    Raises:
        UnknownNameError: there is none; lists them.
    """
    if name not in _NAMES:
        raise UnknownNameError(f"no experiment is named '{name}'; known experiments: {', '.join(_NAMES)}, or all")
    module = import_module(f".{name.replace('-', '_')}", __package__)
    found: Experiment = module.EXPERIMENT
    return found
