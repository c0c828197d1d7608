"""Checks `vsss serve` as its clients see it: conformance.py CASE PORT_OFFSET; conformance.py time_out PORT_OFFSET VSSS, which
starts the server itself, on a terminal; conformance.py punctual PORT_OFFSET SECONDS, which prints how evenly worlds come. Says what is wrong and exits with 1."""
import collections
import math
import os
import pty
import signal
import sys
import time

from league_client import *

NAMES = ["free kick", "penalty", "goal kick", "free ball", "kick-off", "stop", "game on", "halt"]


def check(what, ok):
    if not ok:
        sys.exit("conformance: " + what)


def near(a, b, tolerance):
    return abs(a - b) <= tolerance


def check_world(world, before, steps, robots=3, most=512, field=(1.3, 1.5, 0.4, 0.1)):
    check("a datagram of %d bytes: clients read %d" % (world.size, most), world.size <= most)
    check("robots %s" % [sorted(r) for r in world.robots], all(sorted(r) == list(range(robots)) for r in world.robots))
    check("field %s" % world.field, len(world.field) >= len(field) and all(near(a, b, 1e-9) for a, b in zip(world.field, field)))
    check("a number that is none", all(math.isfinite(v) for v in world.ball))
    if before:
        check("steps %d then %d" % (before.step, world.step), world.step - before.step in steps)


def full_match(net):
    """Two teams in one process, in step with the server: blue attacks and places itself at kick-offs, yellow never places;
    it gets out of the way, and
    its keeper keeps from blue's third goal on."""
    calls, run = [], []  # every datagram; [call, count] without the repeats
    last, goals, kick_offs, placed_checks = None, (0, 0), collections.Counter(), 0
    expected = None  # the kick-off whose placing is to be checked
    place = {0: (-0.70, 0.05, 90.0), 1: (-0.15, 0.0, 0.0), 2: (-0.30, 0.25, -30.0)}
    play = False
    while True:
        world = net.world()
        check("no world for 30 s", world is not None)
        check_world(world, last, (16, 17))
        new_goals = (world.goals[0] - goals[0], world.goals[1] - goals[1])
        check("goals went from %s to %s" % (goals, world.goals), new_goals in ((0, 0), (1, 0), (0, 1)))
        if new_goals != (0, 0):
            at = last.ball if last else world.ball
            check("goal with the ball at %s" % world.ball[:2], abs(world.ball[0]) > 0.7 or abs(at[0]) > 0.7)
        goals, last = world.goals, world
        for call in net.calls():
            if run and (run[-1][0].foul, run[-1][0].team, run[-1][0].time) == (call.foul, call.team, call.time):
                run[-1][1] += 1
                continue
            if run:
                check("%s was sent %d times" % (NAMES[run[-1][0].foul], run[-1][1]), run[-1][1] == 10)
            run.append([call, 1])
            play = call.foul == GAME_ON
            if call.foul == KICKOFF:
                kick_offs[call.team] += 1
                expected = call.team
                net.send(placement(BLUE, place if call.team == BLUE else {i: (x - 0.2 * (i == 1), y, d) for i, (x, y, d) in place.items()}), net.placer)
            elif call.foul not in (STOP, GAME_ON, HALT):
                expected = None
        if run and run[-1][0].foul == STOP and run[-1][1] == 3 and expected is not None:
            blue, yellow = world.robots
            check("kick-off without the ball in the middle: %s" % world.ball[:2], math.hypot(*world.ball[:2]) < 0.005)
            for i, (x, y, d) in place.items():
                x -= 0.2 * (i == 1 and expected != BLUE)
                turn = math.remainder(blue[i].theta - math.radians(d), 2 * math.pi)
                check("blue %d was placed at %.3f %.3f %.2f" % (i, blue[i].x, blue[i].y, blue[i].theta),
                      near(blue[i].x, x, 0.01) and near(blue[i].y, y, 0.01) and near(turn, 0, 0.05))
            # Nobody placed yellow: keeper, attacker, support of the default kick-off, seen from +x.
            for i, x in enumerate((0.675, 0.2, 0.4)):
                check("yellow %d stands at %.3f %.3f" % (i, yellow[i].x, yellow[i].y),
                      near(yellow[i].x, x, 0.01) and near(yellow[i].y, 0, 0.01))
            expected = None
            placed_checks += 1
        if run and run[-1][0].foul == HALT and run[-1][1] == 10:
            break
        if play:
            blue = world.robots[0]
            goal_y = max(-0.15, min(0.15, world.ball[1]))
            net.send(commands(BLUE, {0: drive(blue[0], -0.68, goal_y), 1: attack(blue[1], world.ball, 0.85), 2: drive(blue[2], -0.2, -0.3)}))
            net.send(commands(YELLOW, {i: drive(r, (0.69, 0.3, 0.3)[i], (goal_y if goals[0] > 2 else 0.5, 0.5, -0.5)[i]) for i, r in world.robots[1].items()}))
        else:
            for team in (BLUE, YELLOW):
                net.send(commands(team, {i: (0.0, 0.0) for i in range(3)}))
        if last.step % 1000 < 16:  # while the server's referee is in charge nobody else may place
            net.send(replacement(ball=(0.5, 0.5, 0.0, 0.0)))
    fouls = [r[0].foul for r in run]
    check("calls begin with %s" % [NAMES[f] for f in fouls[:3]], fouls[:3] == [KICKOFF, STOP, GAME_ON])
    check("the first kick-off is not blue's", run[0][0].team == BLUE and run[0][0].half == 1)
    for before, after in zip(fouls, fouls[1:]):
        allowed = {STOP: (GAME_ON,), GAME_ON: (PENALTY, GOAL_KICK, FREE_BALL, KICKOFF, HALT)}.get(before, (STOP,))
        check("%s follows %s" % (NAMES[after], NAMES[before]), after in allowed)
    check("blue scored nothing", goals[0] >= 1)
    check("kick-offs %s for %s goals" % (dict(kick_offs), goals), kick_offs[YELLOW] == goals[0] + 1)  # and the second half's
    check("no kick-off was looked at", placed_checks >= 2)
    check("halves %s" % {r[0].half for r in run}, {r[0].half for r in run} == {1, 2})
    print("conformance: %d : %d, %d calls" % (goals[0], goals[1], len(run)))


class Calls:
    """The referee's calls without their repeats: [call, count]."""

    def __init__(self, net):
        self.net, self.run = net, []

    def hear(self):
        """Those that are new."""
        new = []
        for call in self.net.calls():
            last = self.run[-1][0] if self.run else None
            if last and (last.foul, last.team, last.time, last.half) == (call.foul, call.team, call.time, call.half):
                self.run[-1][1] += 1
                continue
            if last:
                check("%s was sent %d times" % (NAMES[last.foul], self.run[-1][1]), self.run[-1][1] == 10)
            self.run.append([call, 1])
            new.append(call)
        return new

    def over(self):
        return bool(self.run) and self.run[-1][0].foul == HALT and self.run[-1][1] == 10


def knockout(net):
    """Nobody scores: extra time, then the shoot-out, where blue scores and yellow stands. Blue's second goal is more than yellow
    can still score with its third kick."""
    calls, play, kicker, still = Calls(net), False, None, {i: (0.0, 0.0) for i in range(3)}
    kicks = []
    while not calls.over():
        world = net.world()
        check("no world for 30 s", world is not None)
        check("goals %s: those of a shoot-out are not the match's" % (world.goals,), world.goals == (0, 0))
        for call in calls.hear():
            play = call.foul == GAME_ON
            if call.foul == PENALTY:
                kicker = call.team
                kicks.append(call)
        blue, yellow = dict(still), dict(still)
        if play and calls.run[-1][0].half == 5:
            yellow[0] = (-20.0, -20.0)  # its keeper leaves the line, backwards along the goal
            if kicker == BLUE:
                blue[1] = attack(world.robots[0][1], world.ball, 0.85)
                yellow[0] = drive(world.robots[1][0], 0.69, 0.5)
        net.send(commands(BLUE, blue))
        net.send(commands(YELLOW, yellow))
    halves = []
    for call, _ in calls.run:
        if not halves or halves[-1] != call.half:
            halves.append(call.half)
    check("halves %s" % halves, halves == [1, 2, 3, 4, 5])
    kick_offs = [(c.half, c.team) for c, _ in calls.run if c.foul == KICKOFF]
    check("kick-offs %s" % kick_offs, kick_offs == [(1, BLUE), (2, YELLOW), (3, BLUE), (4, YELLOW)])
    check("kicks by %s" % [k.team for k in kicks], [k.team for k in kicks] == [BLUE, YELLOW, BLUE, YELLOW])
    check("kicks in halves %s" % [k.half for k in kicks], all(k.half == 5 for k in kicks))
    last = [c.foul for c, _ in calls.run][-4:]
    check("it ends with %s" % [NAMES[f] for f in last], last == [PENALTY, STOP, GAME_ON, HALT])
    print("conformance: knockout")


def time_out(offset, vsss):
    """A person at the server's terminal gives yellow a time-out in play and ends it, twice; a third one it has not."""
    arguments = ["serve", "--ports", "+%d" % offset, "--sync", "--answer", "30", "--pause", "0.2", "--seconds", "60", "--drive", "planar"]
    server, terminal = pty.fork()
    if server == 0:
        os.execv(vsss, [vsss] + arguments)
    net = Network(offset)
    calls, said, halts, worlds = Calls(net), b"", [], 0
    try:
        while b"had all its time-outs" not in said:
            check("the server said %s" % said, net.world() is not None or worlds == 0)
            worlds += 1
            if select.select([terminal], [], [], 0)[0]:
                said += os.read(terminal, 4096)
            for call in calls.hear():
                before = calls.run[-2][0] if len(calls.run) > 1 else None
                check("%s after a time-out" % NAMES[call.foul], not (before and before.foul == HALT) or call.foul == FREE_BALL)
                if call.foul == GAME_ON:
                    os.write(terminal, b"y")  # nobody plays: there will be a free ball after 5 s
                if call.foul == HALT:
                    check("the time-out is of team %d" % call.team, call.team == YELLOW)
                    halts.append(worlds)
            if halts and worlds == halts[-1] + 60 and calls.run[-1][0].foul == HALT:
                os.write(terminal, b"y")
            for team in (BLUE, YELLOW):
                net.send(commands(team, {i: (0.0, 0.0) for i in range(3)}))
        check("%d time-outs" % len(halts), len(halts) == 2)
    finally:
        os.kill(server, signal.SIGINT)
        while os.waitpid(server, os.WNOHANG) == (0, 0):
            try:
                said += os.read(terminal, 4096) if select.select([terminal], [], [], 0.05)[0] else b""
            except OSError:  # it has closed its end
                pass
        os.close(terminal)
    for text in (b"yellow asks for a time-out", b"time-out of yellow, 1 of 2: 120 s", b"time-out of yellow, 2 of 2", b"yellow is ready"):
        check("the server said %s" % said, text in said)
    print("conformance: time-outs")


def five(net):
    """5 against 5: ten robots on 2.2 x 1.8 m, placements of five, goals behind the longer field; the fifth robot is commanded
    as any other."""
    field = (1.8, 2.2, 0.4, 0.15, 0.25, 0.5, 0.15, 0.375)
    place = {0: (-1.03, 0.05, 90.0), 1: (-0.24, 0.0, 0.0), 2: (-0.5, 0.3, 0.0), 3: (-0.5, -0.3, 0.0), 4: (-0.8, -0.6, 45.0)}
    default = ((1.03, 0.0), (0.3, 0.0), (0.45, 0.2), (0.45, -0.2), (0.7, 0.0))
    calls, last, play, placed, moved = Calls(net), None, False, 0, 0.0
    while not calls.over():
        world = net.world()
        check("no world for 30 s", world is not None)
        check_world(world, last, (16, 17), 5, 1024, field)
        if last and world.goals != last.goals:
            check("goal with the ball at %s" % last.ball[:2], abs(last.ball[0]) > 1.0 or abs(world.ball[0]) > 1.0)
        last = world
        for call in calls.hear():
            play = call.foul == GAME_ON
            if call.foul == KICKOFF and call.team == BLUE:
                net.send(placement(BLUE, place), net.placer)
            if call.foul == GAME_ON and calls.run[-3][0].foul == KICKOFF and calls.run[-3][0].team == BLUE:
                blue, yellow = world.robots
                for i, (x, y, d) in place.items():
                    check("blue %d was placed at %.3f %.3f" % (i, blue[i].x, blue[i].y), near(blue[i].x, x, 0.01) and near(blue[i].y, y, 0.01))
                for i, (x, y) in enumerate(default):
                    check("yellow %d stands at %.3f %.3f" % (i, yellow[i].x, yellow[i].y), near(yellow[i].x, x, 0.01) and near(yellow[i].y, y, 0.01))
                placed += 1
        blue = {i: (0.0, 0.0) for i in range(5)}
        yellow = dict(blue)
        if play:
            blue[1] = attack(world.robots[0][1], world.ball, 1.2)
            blue[4] = drive(world.robots[0][4], 0.0, -0.7)
            yellow = {i: drive(r, 0.5, 0.75 if i % 2 else -0.75) for i, r in world.robots[1].items()}
            moved = max(moved, world.robots[0][4].x + 0.8)
        net.send(commands(BLUE, blue))
        net.send(commands(YELLOW, yellow))
    check("blue scored nothing", last.goals[0] >= 1)
    check("no kick-off was looked at", placed >= 1)
    check("blue 4 moved by %.2f m" % moved, moved > 0.5)
    print("conformance: 5v5 %d : %d" % last.goals)


def settle(net, send, frames, steps):
    """Answers so many worlds with the same datagrams; returns the last world."""
    last = None
    for _ in range(frames):
        world = net.world()
        check("no world for 30 s", world is not None)
        check_world(world, last, steps)
        last = world
        for data, to in send:
            net.send(data, to)
    return last


def free_play(net, radians, team_ports, hz):
    """Without a referee: replacements, saturation, what is not a number, a held command, goals."""
    steps = (1,) if radians else (16, 17)
    to = {BLUE: team_ports[0], YELLOW: team_ports[1]} if team_ports else {BLUE: None, YELLOW: None}
    idle = [(commands(t, {i: (0.0, 0.0) for i in range(3)}), to[t]) for t in (BLUE, YELLOW)]
    net.catch_up()
    settle(net, idle, 10, steps)
    turn = math.pi / 2 if radians else 90.0
    park = [(BLUE, 0, -0.6, -0.5, 0.0), (BLUE, 1, -0.6, 0.5, 0.0), (BLUE, 2, -0.3, -0.5, 0.0),
            (YELLOW, 0, 0.6, 0.5, turn), (YELLOW, 1, 0.6, -0.5, 0.0), (YELLOW, 2, 0.3, 0.5, 0.0)]
    net.send(replacement((0.2, -0.1, 0.0, 0.0), park))
    world = settle(net, idle, 5, steps)
    check("the ball went to %s" % world.ball[:2], near(world.ball[0], 0.2, 0.005) and near(world.ball[1], -0.1, 0.005))
    check("yellow 0 turned to %.2f" % world.robots[1][0].theta, near(world.robots[1][0].theta, math.pi / 2, 0.03))
    check("blue 2 went to %.2f" % world.robots[0][2].x, near(world.robots[0][2].x, -0.3, 0.01))
    # Faster than any wheel: as fast as it goes, straight ahead, not refused.
    fast = [(commands(BLUE, {0: (2000.0, 2000.0), 1: (442.0, -442.0)}), to[BLUE]), idle[1]]
    world = settle(net, fast, hz // 2, steps)
    speed = world.robots[0][0].vx
    check("2000 rad/s drives at %.2f m/s" % speed, 0.4 < speed < 1.5)
    check("it drove a curve: y %.3f" % world.robots[0][0].y, near(world.robots[0][0].y, -0.5, 0.03))
    check("442 rad/s turns at %.1f rad/s" % world.robots[0][1].omega, world.robots[0][1].omega < -5)
    # Not a number: dropped, the command before it holds.
    nan = [(commands(BLUE, {0: (math.nan, 10.0), 1: (0.0, 0.0)}), to[BLUE]), idle[1]]
    world = settle(net, nan, 6, steps)
    check("not a number stopped it: %.2f m/s" % world.robots[0][0].vx, world.robots[0][0].vx > 0.3)
    settle(net, idle, hz, steps)
    # A shot into each goal is counted.
    for shot, expected in (((0.6, 0.0, 2.0, 0.0), (1, 0)), ((-0.6, 0.0, -2.0, 0.0), (1, 1))):
        net.send(replacement(shot))
        world = settle(net, idle, hz // 2, steps)
        check("goals %s after a shot, expected %s" % (world.goals, expected), world.goals == expected)
    if team_ports:  # a team's port takes that team's commands only, the replacement port none
        wrong = [(commands(BLUE, {0: (30.0, 30.0)}), to[YELLOW]), (commands(BLUE, {0: (30.0, 30.0)}), None)]
        world = settle(net, wrong + idle, hz // 2, steps)
        check("blue was driven through another port", abs(world.robots[0][0].vx) < 0.02)
    print("conformance: free play")


def punctual(net, seconds):
    """How evenly worlds come at real time: by the kernel's stamp of their arrival, and by when this program has them. None is
    lost."""
    SO_TIMESTAMPNS = 35  # Linux; Python does not name it
    net.vision.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
    net.catch_up()
    stamps, times, last = [], [], None
    while not stamps or stamps[-1] - stamps[0] < seconds:
        check("no world for 30 s", select.select([net.vision], [], [], 30)[0])
        data, control, _, _ = net.vision.recvmsg(512, 64)
        times.append(time.monotonic())
        stamps += [s + 1e-9 * ns for _, kind, c in control if kind == SO_TIMESTAMPNS for s, ns in [struct.unpack("qq", c[:16])]]
        world = World(data)
        check_world(world, last, (16, 17))
        last = world
        for team in (BLUE, YELLOW):
            net.send(commands(team, {i: (10.0, -10.0) for i in range(3)}))
    for what, at in (("arrival", stamps), ("client", times)):
        off = sorted(abs(b - a - 1 / 60) for a, b in zip(at, at[1:]))
        print("jitter by %s: p50 %.3f ms, p99 %.3f ms, max %.3f ms, %d worlds, none lost" % (
            what, *(1e3 * off[min(int(q * len(off)), len(off) - 1)] for q in (0.5, 0.99, 1)), len(at)))


def main():
    case, offset = sys.argv[1], int(sys.argv[2])
    if case == "time_out":
        time_out(offset, sys.argv[3])
        return
    net = Network(offset, most=1024 if case == "five" else 512)
    net.send(commands(BLUE, {0: (0.0, 0.0)}))
    if case == "match":
        full_match(net)
    elif case == "punctual":
        punctual(net, float(sys.argv[3]))
    elif case == "five":
        five(net)
    elif case == "knockout":
        knockout(net)
    elif case == "firasim":
        free_play(net, False, None, 60)
    elif case == "travesim":
        free_play(net, True, (("127.0.0.1", 20013 + offset), ("127.0.0.1", 20012 + offset)), 100)
    else:
        sys.exit("conformance: no case '%s'" % case)


main()
