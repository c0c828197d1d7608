"""A strategy in Python against EMC, which played in competitions: a keeper and two robots that push the ball.

python strategy_against_emc.py [--matches 10]
"""

import argparse

import numpy as np

import vsss

LIMIT_RADPS, WHEEL_M, HALF_TRACK_M = 46.66, 0.03, 0.035


def drive_to(robot, x_m, y_m, speed_mps):
    """Wheels in rad/s that take a robot (x, y, theta, ...) towards a point, forwards or backwards."""
    ahead = np.arctan2(y_m - robot[1], x_m - robot[0]) - robot[2]
    ahead = np.arctan2(np.sin(ahead), np.cos(ahead))
    sense = 1.0
    if abs(ahead) > np.pi / 2:  # the back is nearer
        sense, ahead = -1.0, ahead - np.sign(ahead) * np.pi
    forward, turn = sense * speed_mps * np.cos(ahead), 8.0 * ahead
    return [(forward - turn * HALF_TRACK_M) / WHEEL_M, (forward + turn * HALF_TRACK_M) / WHEEL_M]


@vsss.strategy
class KeeperAndPushers:
    """One object for each team and match; what it remembers stays in it."""

    def __init__(self) -> None:
        self.pusher = 1

    def __call__(self, world: vsss.World, dt_s: float):
        x, y, vx, vy = world.ball
        soon_x, soon_y = x + 0.2 * vx, y + 0.2 * vy
        away = np.hypot(*(world.own[1:, :2] - world.ball[:2]).T)
        if away[2 - self.pusher] + 0.1 < away[self.pusher - 1]:
            self.pusher = 3 - self.pusher  # the other one is clearly nearer
        wheels = np.zeros((3, 2))
        wheels[0] = drive_to(world.own[0], -0.70, np.clip(soon_y, -0.18, 0.18), min(1.0, 6 * abs(soon_y - world.own[0][1])))
        me = world.own[self.pusher]
        to_goal = np.array([0.80 - soon_x, -soon_y]) / np.hypot(0.80 - soon_x, soon_y)
        behind = np.array([soon_x, soon_y]) - 0.10 * to_goal
        beside = (me[:2] - [soon_x, soon_y]) @ to_goal > -0.03  # not yet behind the ball
        target = behind if beside else [soon_x + 0.1 * to_goal[0], soon_y + 0.1 * to_goal[1]]
        wheels[self.pusher] = drive_to(me, *target, 0.9)
        other = 3 - self.pusher
        wheels[other] = drive_to(world.own[other], min(x - 0.3, 0.1), -0.4 * np.sign(y), 0.6)
        return np.clip(wheels, -LIMIT_RADPS, LIMIT_RADPS)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--matches", type=int, default=10)
    parser.add_argument("--match-seconds", type=float, default=120)
    arguments = parser.parse_args()
    for opponent in ("random:", "emc:"):
        print(
            vsss.evaluate(
                KeeperAndPushers, opponent, arguments.matches, drive="planar", episode_s=arguments.match_seconds
            )
        )


if __name__ == "__main__":
    main()
