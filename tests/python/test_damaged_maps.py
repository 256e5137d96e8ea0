"""Map files with invalid arrays."""

from pathlib import Path

import numpy as np
import pytest

import beetle_ik as bik

CORPUS = Path(__file__).parents[1] / "corpus" / "map" / "map.npz"


@pytest.mark.parametrize(
    ("name", "array", "problem"),
    [
        ("reachability_map", np.zeros(2), "a map of format [0. 0.]; this library reads format 2: compute it again"),
        ("reachability_map", np.array(["1"]), "a map of format ['1']; this library reads format 2: compute it again"),
        (
            "manipulability",
            np.zeros(5),
            "damaged reachability map: manipulability: expected shape (4, 4, 5) of float32, got (5,) of float64",
        ),
        (
            "clearance",
            np.zeros((4, 4, 5), "S3"),
            "damaged reachability map: clearance: expected shape (4, 4, 5) of float32, got (4, 4, 5) of |S3",
        ),
    ],
)
def test_arrays_that_are_no_maps_are_refused(tmp_path: Path, name: str, array: np.ndarray, problem: str) -> None:
    arrays = dict(np.load(CORPUS))
    assert bik.ReachabilityMap.load(CORPUS).shape == (4, 4, 5)
    file = tmp_path / "map.npz"
    np.savez(file, **{**arrays, name: array})
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.ReachabilityMap.load(file)
    assert str(caught.value) == f"{file}: {problem}"
