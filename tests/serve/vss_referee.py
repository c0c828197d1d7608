"""Plays VSSReferee, from the description of its protocol alone: vss_referee.py PORT_OFFSET. Calls to `vsss serve --referee
external` with a team of ours (`vsss field --camera firasim:`, yellow) on the network, waits for its placement, places as
the real one does, and checks in the world's datagrams what each call does to both teams. Says what is wrong, exits with 1."""
import math
import sys
import time

from league_client import *

PATIENCE_S = 20  # a loaded machine
NAMES = ["free kick", "penalty", "goal kick", "free ball", "kick-off", "stop", "game on", "halt"]
# Where the ball and blue go: by the rules' marks, blue's three anywhere legal. Yellow's come from its placement.
KICK_OFF = ((0, 0), [(-0.675, 0), (-0.2, 0), (-0.4, 0.3)])
FREE_BALL_3 = ((-0.375, -0.4), [(-0.675, 0), (-0.575, -0.4), (-0.3, 0.1)])
PENALTY_BLUE = ((0.375, 0), [(-0.675, 0), (0.2, 0), (-0.1, 0.4)])
GOAL_KICK_YELLOW_1 = ((0.6, 0.35), [(-0.675, 0), (-0.2, 0.1), (-0.3, -0.3)])
FREE_KICK_BLUE = ((0.375, 0), [(-0.675, 0), (0.2, 0), (-0.1, 0.4)])
# Each row is a transition from the row before: call, team, quadrant, places.
ROWS = [
    (HALT, NONE, 0, None),
    (KICKOFF, BLUE, 0, KICK_OFF),
    (KICKOFF, YELLOW, 0, KICK_OFF),  # corrected in the same second
    (STOP, NONE, 0, None),
    (GAME_ON, NONE, 0, None),
    (FREE_BALL, NONE, 3, FREE_BALL_3),
    (GAME_ON, NONE, 0, None),
    (STOP, NONE, 0, None),
    (PENALTY, BLUE, 0, PENALTY_BLUE),
    (HALT, NONE, 0, None),
    (GAME_ON, NONE, 0, None),
    (GOAL_KICK, YELLOW, 1, GOAL_KICK_YELLOW_1),
    (STOP, NONE, 0, None),
    (GAME_ON, NONE, 0, None),
    (FREE_KICK, BLUE, 0, FREE_KICK_BLUE),
    (GAME_ON, NONE, 0, None),
    (HALT, NONE, 0, None),
]


class Referee:
    def __init__(self, offset):
        self.net = Network(offset)
        self.to = (REFEREE, 10003 + offset)
        self.placements = join(REFEREE, 10004 + offset)
        self.what = "the start"

    def fail(self, why):
        sys.exit("referee: after %s: %s" % (self.what, why))

    def call(self, foul, team, quadrant, at):
        body = number(1, foul) + number(2, team) + number(3, quadrant) + double(4, at) + number(5, 1)
        for _ in range(10):
            self.net.send(body, self.to)

    def placement(self):
        """Robot -> (x, y, rad) of the one placement that yellow sends."""
        if not select.select([self.placements], [], [], PATIENCE_S)[0]:
            self.fail("yellow sent no placement")
        frame = fields(one(fields(self.placements.recv(512)), 1, b""))
        if one(frame, 1) != YELLOW:
            self.fail("a placement of team %d" % one(frame, 1))
        robots = [fields(r) for r in frame.get(2, [])]
        out = {one(r, 1): (one(r, 2, 0.0), one(r, 3, 0.0), math.radians(one(r, 4, 0.0))) for r in robots}
        if sorted(out) != [0, 1, 2]:
            self.fail("a placement of robots %s" % sorted(out))
        return out

    def until(self, what, holds, n=10):
        """n worlds in a row for which it holds."""
        row, end = 0, time.monotonic() + PATIENCE_S
        self.net.catch_up()
        while row < n:
            world = self.net.world(PATIENCE_S)
            if world is None or time.monotonic() > end:
                self.fail("never %s" % what)
            row = row + 1 if holds(world) else 0
        return world


def speed(robot):
    return math.hypot(robot.vx, robot.vy) + 0.04 * abs(robot.omega)


def stands(robots):
    return all(speed(r) < 0.02 for r in robots.values())


def drives(robots):
    return max(speed(r) for r in robots.values()) > 0.05


def is_at(robots, places, near=0.01, turned=0.1):
    turn = lambda r, p: abs(math.remainder(r.theta - p[2], 2 * math.pi))
    return all(math.hypot(robots[i].x - p[0], robots[i].y - p[1]) < near and turn(robots[i], p) < turned for i, p in places.items())


def place(referee, places):
    """Yellow says where it wants to stand and drives there by itself, touching nobody; then all are put in their places."""
    ball, blue = places
    yellow = referee.placement()
    begun = referee.net.world(PATIENCE_S).step
    there = referee.until("yellow drives to its places", lambda w: is_at(w.robots[1], yellow, 0.02, 0.15), 3)
    took_s = (there.step - begun) / 1000
    if took_s > 8:
        referee.fail("yellow took %.1f s to its places" % took_s)
    blue = {i: (x, y, 0.0) for i, (x, y) in enumerate(blue)}
    robots = [(t, i, x, y, math.degrees(a)) for t, all_ in ((BLUE, blue), (YELLOW, yellow)) for i, (x, y, a) in all_.items()]
    referee.net.send(replacement((ball[0], ball[1], 0.0, 0.0), robots))
    at = lambda w: is_at(w.robots[0], blue) and is_at(w.robots[1], yellow) and math.dist(w.ball[:2], ball) < 0.01
    referee.until("placed as it was asked for", at)


def main():
    referee = Referee(int(sys.argv[1]))
    referee.until("a world in which all stand, uncalled", lambda w: stands(w.robots[0]) and stands(w.robots[1]), 60)
    at, seen = 0.0, []
    for k, (foul, team, quadrant, places) in enumerate(ROWS):
        referee.what = "row %d, %s" % (k, NAMES[foul])
        referee.call(foul, team, quadrant, at)
        if foul == GAME_ON:
            referee.until("blue drives", lambda w: drives(w.robots[0]), 3)
            referee.until("yellow drives", lambda w: drives(w.robots[1]), 3)
            at += 1
        else:
            referee.until("blue stands", lambda w: stands(w.robots[0]))
            if not places:
                referee.until("yellow stands", lambda w: stands(w.robots[1]))
        if places:
            place(referee, places)
    if select.select([referee.placements], [], [], 0)[0]:
        referee.fail("a placement too many")
    print("referee: %d transitions" % len(ROWS))


main()
