"""A club's program for tests of `vsss league`: plays the team and the ports that its environment names."""
import os

from league_client import *

team = TEAM[os.environ["VSSS_TEAM"]]
net = Network(int(os.environ["VSSS_VISION_PORT"]) - 10002)
net.to = ("127.0.0.1", int(os.environ["VSSS_COMMAND_PORT"]))
side = 1 if team == BLUE else -1
net.send(commands(team, {0: (0.0, 0.0)}))
while True:
    world = net.world(timeout=5)
    if world is None:
        continue
    own = world.robots[team]
    y = max(-0.15, min(0.15, world.ball[1]))
    net.send(commands(team, {0: drive(own[0], -0.68 * side, y), 1: attack(own[1], world.ball, 0.85 * side), 2: drive(own[2], -0.2 * side, -0.3)}))
