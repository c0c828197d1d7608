"""rSim (rc-robosim), the simulator under rSoccer: three robots against three, a call is 25 ms in five steps of 5 ms.
Random wheel speeds, drawn anew every call (robots tremble on the spot: few contacts) or every 40 calls (they drive into each
other and the walls: many). The pieces are put down anew every 30 simulated seconds."""
import numpy as np
import robosim

from timing import rate, say

STEP_MS, ROBOTS, EPISODE = 25, 3, 1200


class Match:
    def __init__(self, hold):
        self.rng = np.random.default_rng(1)
        self.hold, self.calls = hold, 0
        self.wheels = [self.rng.uniform(-46, 46, (2 * ROBOTS, 2)) for _ in range(1000)]
        self.sim = robosim.VSS(0, ROBOTS, ROBOTS, STEP_MS, *self.places())

    def places(self):
        # A grid of 4 x 3 places, 35 cm apart, shuffled: nobody stands on another.
        spots = [(x, y) for x in (-0.525, -0.175, 0.175, 0.525) for y in (-0.35, 0.0, 0.35)]
        chosen = [spots[i] for i in self.rng.permutation(len(spots))[: 2 * ROBOTS + 1]]
        robots = np.array([[x, y, self.rng.uniform(0, 360)] for x, y in chosen[1:]])
        return np.array([*chosen[0], 0.0, 0.0]), robots[:ROBOTS], robots[ROBOTS:]

    def step(self):
        self.sim.step(self.wheels[self.calls // self.hold % len(self.wheels)])
        self.calls += 1
        if self.calls % EPISODE == 0:
            self.sim.reset(*self.places())


for name, hold in (("rsim", 1), ("rsim_hold", 40)):
    say(name, rate(Match(hold).step, 8.0, 50) * STEP_MS / 1000)
