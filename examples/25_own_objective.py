"""
Your own objective
==================

``minimize`` applies any derivative-free solver to your own function. Here it finds
where to mount a planar arm, so that it moves well at four positions.
"""

import matplotlib.pyplot as plt
import numpy as np

import beetle_ik as bik

PLACES = np.array([
    [0.2, 0.9, 0.0],
    [0.9, 0.9, 0.0],
    [1.2, 0.4, 0.0],
    [0.6, 0.5, 0.0],
])
arm = bik.Robot.planar([0.4, 0.4, 0.3])


def worst(base: np.ndarray) -> float:
    """Returns minus the lowest manipulability over the places; base at (x, y)."""
    best = []
    for place in PLACES - [*base, 0.0]:
        posture = bik.solve(
            arm,
            place,
            goals=bik.goals.Manipulability(motion="position"),
            stop=bik.Stop(max_iterations=60),
        )
        best.append(
            arm.manipulability(posture.q, motion="position")
            if posture.success
            else 0.0
        )
    return -min(best)


# %%
# A swarm of 15 particles and at most 900 evaluations. The history records each
# improvement.
found = bik.minimize(
    worst,
    [-0.5, -0.5],
    [1.5, 1.5],
    solver=bik.papers.PSO(population=15),
    stop=bik.Stop(max_evaluations=900),
    seed=1,
)
print(found.message)
print(f"base at {np.round(found.x, 3)}, worst manipulability {-found.value:.3f}")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
left.scatter(
    *PLACES[:, :2].T, marker="*", s=120, color="black", label="places", zorder=3
)
left.plot(
    *found.x,
    marker="s",
    markersize=10,
    linestyle="none",
    color="#D55E00",
    label="base",
)
for place in PLACES:
    solution = bik.solve(
        arm,
        place - [*found.x, 0.0],
        goals=bik.goals.Manipulability(motion="position"),
    )
    left.plot(
        *(arm.link_poses(solution.q)[:, :2, 3] + found.x).T,
        color="#0072B2",
        marker="o",
        alpha=0.6,
    )
left.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
left.legend()
right.step(found.history[:, 0], -found.history[:, 1], where="post")
right.set(xlabel="evaluations", ylabel="worst manipulability, best so far")
plt.show()
