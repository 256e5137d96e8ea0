"""An arm that differs from its model, tracked with the model and without any.

The simulated iiwa (MuJoCo: position servos, gravity, a sensor with 0.05 mm of noise
on each axis) has a link 2 cm longer than its model, and joints that are 2 degrees
off. Joint positions computed with the model miss the circle by centimetres.
`BroydenBAS` uses no model: it sends one command per tick, measures the tip, and
stays within a millimetre.

    pip install 'beetle-ik[plot,sim]'
    python examples/29_wrong_model.py OUT

writes OUT/wrong_model.gif and OUT/wrong_model.png.
"""

import argparse
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import beetle_ik as bik
from beetle_ik.sim import MujocoPlant

DT = 0.2  # s
START = np.array([
    0.5449219327,
    0.1036664288,
    0.0969337234,
    -0.8713896072,
    0.1027968992,
    0.617944106,
    0.0,
])
CIRCLE = bik.paths.circle((0.3, 0.3, 1.0), diameter=0.2, duration=30.0)
SETTLED = 20  # ticks for the first antennae and the approach to the circle
EVERY = 5  # ticks per frame
VIEW = partial(
    MujocoPlant.picture,
    width=400,
    height=360,
    azimuth=-60.0,
    elevation=-50.0,
    distance=1.3,
    look_at=(0.2, 0.2, 0.8),
)

Array = NDArray[np.float64]


def iiwa(*, third_link: float = 0.42, offset: float = 0.0) -> bik.Robot:
    """The iiwa 14 (m, rad); the offsets of its joints alternate in sign."""
    return bik.Robot.from_dh(
        a=np.zeros(7),
        alpha=np.radians([-90, 90, 90, -90, -90, 90, 0]),
        d=[0.36, 0.0, third_link, 0.0, 0.40, 0.0, 0.126],
        theta=offset * np.array([1, -1, 1, -1, 1, -1, 1]),
        convention="standard",
    )


class Filmed:
    """A plant that is filmed while it is moved."""

    def __init__(self, plant: MujocoPlant) -> None:
        """Starts at rest."""
        plant.reset(START)
        self.plant = plant
        self.tips: list[Array] = []
        self.frames: list[NDArray[np.uint8]] = []

    def move(self, q: Array) -> Array:
        """Moves the arm to q and returns the measured tip."""
        measured = self.plant.move(q)
        self.tips.append(self.plant.tip)
        if len(self.tips) % EVERY == 0:
            path = CIRCLE.position(np.linspace(0.0, CIRCLE.duration, 90))
            self.frames.append(VIEW(self.plant, trail=self.tips, target=path))
        return measured

    @property
    def error(self) -> Array:
        """Distances of the tip from the path (m), after the approach."""
        reference = CIRCLE.position(DT * np.arange(len(self.tips)))
        return np.asarray(np.linalg.norm(self.tips - reference, axis=1)[SETTLED:])


def main() -> None:
    """Follows the circle twice and writes the film."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path)
    out: Path = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    built = iiwa(third_link=0.44, offset=np.radians(2.0))

    by_model = Filmed(MujocoPlant(built, dt=DT, noise=5e-5))
    for q in bik.track(iiwa(), CIRCLE, START, dt=DT).q:
        by_model.move(q)
    print(f"with the model: {1e3 * by_model.error.max():.1f} mm off at most")

    without = Filmed(MujocoPlant(built, dt=DT, noise=5e-5))
    controller = bik.BroydenBAS(max_evaluations_per_step=1)
    limits = bik.Limits(velocity=2.0)
    bik.track_model_free(
        without, CIRCLE, START, dt=DT, controller=controller, limits=limits
    )
    print(
        f"without a model: {1e3 * without.error.max():.2f} mm off at most, "
        f"one command per tick of {DT} s"
    )

    frames = [
        Image.fromarray(np.concatenate(pair, axis=1))
        for pair in zip(by_model.frames, without.frames, strict=False)
    ]
    frames[0].save(
        out / "wrong_model.gif",
        save_all=True,
        append_images=frames[1:],
        duration=100,
        loop=0,
    )
    frames[-1].save(out / "wrong_model.png")
    print(f"left with the model, right without: {out / 'wrong_model.gif'}")


if __name__ == "__main__":
    main()
