"""Every example runs, without a warning, and draws at least one picture."""

import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
NEEDS_MUJOCO = {"29_wrong_model"}  # a program with an argument; the plant it drives has tests of its own
SIMULATED = {"46_torques_in_mujoco"}
NEEDS_JAX = {"37_learned_redundancy", "38_hand_eye_by_gradient"}
GALLERY = sorted(path.stem for path in EXAMPLES.glob("*.py") if path.stem not in NEEDS_MUJOCO)


@pytest.mark.filterwarnings("ignore:FigureCanvasAgg is non-interactive")
@pytest.mark.parametrize("name", GALLERY)
def test_the_example_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if name in NEEDS_JAX:
        pytest.importorskip("jax", reason="JAX is not installed")
    if name in SIMULATED:
        pytest.importorskip("mujoco", reason="MuJoCo is not installed (extra 'sim')")
    monkeypatch.chdir(tmp_path)  # some write files
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    assert plt.get_fignums()


def test_every_example_has_a_title_that_the_gallery_shows() -> None:
    for name in GALLERY:
        _, title, line, *_ = (EXAMPLES / f"{name}.py").read_text(encoding="utf-8").splitlines()
        assert title
        assert line == "=" * len(title)
