"""A client of the simulation league, written from the description of its protocol alone (messages, ports, groups), to
check `vsss serve` as a team's program sees it. Standard library only; used by conformance.py."""
import math
import select
import socket
import struct

VISION, REFEREE = "224.0.0.1", "224.5.23.2"
FREE_KICK, PENALTY, GOAL_KICK, FREE_BALL, KICKOFF, STOP, GAME_ON, HALT = range(8)
BLUE, YELLOW, NONE = range(3)
TEAM = {"blue": BLUE, "yellow": YELLOW}


# --- protobuf's wire format ---------------------------------------------------------------------------------------------
def varint(value):
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def number(field, value):
    return b"" if value == 0 else varint(field << 3) + varint(value)


def double(field, value):
    return b"" if value == 0 else varint(field << 3 | 1) + struct.pack("<d", value)


def message(field, body):
    return varint(field << 3 | 2) + varint(len(body)) + body


def read_varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at += 1
        if byte < 0x80:
            return value, at
        shift += 7


def fields(data):
    """Field number -> list of values: int, float or bytes."""
    out, at = {}, 0
    while at < len(data):
        key, at = read_varint(data, at)
        kind = key & 7
        if kind == 0:
            value, at = read_varint(data, at)
        elif kind == 1:
            value, at = struct.unpack_from("<d", data, at)[0], at + 8
        elif kind == 2:
            size, at = read_varint(data, at)
            value, at = data[at : at + size], at + size
            if len(value) != size:
                raise ValueError("cut short")
        else:
            raise ValueError("wire type %d" % kind)
        out.setdefault(key >> 3, []).append(value)
    return out


def one(found, field, default=0):
    return found.get(field, [default])[-1]


# --- messages -----------------------------------------------------------------------------------------------------------
class Robot:
    def __init__(self, data):
        f = fields(data)
        self.id = one(f, 1)
        self.x, self.y, self.theta, self.vx, self.vy, self.omega = (one(f, k, 0.0) for k in range(2, 8))


class World:
    def __init__(self, data):
        f = fields(data)
        self.size = len(data)
        self.step, self.goals = one(f, 1), (one(f, 4), one(f, 5))
        frame = fields(one(f, 2, b""))
        self.ball = [one(fields(one(frame, 1, b"")), k, 0.0) for k in range(1, 7)]
        self.robots = [{r.id: r for r in map(Robot, frame.get(field, []))} for field in (3, 2)]  # blue, yellow
        self.field = [one(fields(one(f, 3, b"")), k, 0.0) for k in range(1, 9)]


class Call:
    def __init__(self, data):
        f = fields(data)
        self.foul, self.team, self.quadrant, self.time, self.half = (one(f, k) for k in range(1, 6))


def commands(team, wheels):
    """wheels: robot -> (left, right)."""
    rows = b"".join(
        message(1, number(1, i) + number(2, team) + double(6, l) + double(7, r)) for i, (l, r) in wheels.items())
    return message(1, rows)


def replacement(ball=None, robots=()):
    """ball: x, y, vx, vy; robots: (team, id, x, y, orientation)."""
    body = b"" if ball is None else message(1, b"".join(double(k + 1, v) for k, v in enumerate(ball)))
    for team, i, x, y, theta in robots:
        position = number(1, i) + double(2, x) + double(3, y) + double(4, theta)
        body += message(2, message(1, position) + number(5, team) + number(6, 1))
    return message(2, body)


def placement(team, robots):
    """robots: id -> (x, y, degrees)."""
    rows = b"".join(message(2, number(1, i) + double(2, x) + double(3, y) + double(4, d)) for i, (x, y, d) in robots.items())
    return message(1, number(1, team) + rows)


# --- the network --------------------------------------------------------------------------------------------------------
def join(group, port):
    """As most clients do it: no interface named."""
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    s.bind(("", port))
    for address in ("0.0.0.0", "127.0.0.1"):
        try:
            s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + socket.inet_aton(address))
            break
        except OSError:
            pass  # a machine without a route: loopback it is
    s.setblocking(False)
    return s


class Network:
    def __init__(self, offset, command=20011, most=512):
        self.most = most  # a client reads no more
        self.vision, self.referee = join(VISION, 10002 + offset), join(REFEREE, 10003 + offset)
        self.to = ("127.0.0.1", command + offset)
        self.placer = (REFEREE, 10004 + offset)
        self.out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))

    def send(self, data, to=None):
        self.out.sendto(data, to or self.to)

    def world(self, timeout=30):
        """The next world; None: the server is silent."""
        if not select.select([self.vision], [], [], timeout)[0]:
            return None
        return World(self.vision.recv(self.most + 1))

    def catch_up(self):
        """Forgets the worlds that wait."""
        while select.select([self.vision], [], [], 0)[0]:
            self.vision.recv(self.most)

    def calls(self):
        out = []
        while True:
            try:
                out.append(Call(self.referee.recv(512)))
            except BlockingIOError:
                return out


def drive(robot, x, y, speed=30.0, gain=12.0):
    """Wheels that bring a robot to a point, backwards if that is nearer."""
    angle = math.atan2(y - robot.y, x - robot.x) - robot.theta
    angle = math.atan2(math.sin(angle), math.cos(angle))
    forward = 1.0
    if abs(angle) > math.pi / 2:
        angle -= math.copysign(math.pi, angle)
        forward = -1.0
    forward *= speed * max(0.0, math.cos(angle)) ** 2
    return forward - gain * angle, forward + gain * angle


def attack(robot, ball, goal):
    """Round the ball, then through it into the goal."""
    bx, by = ball[0], ball[1]
    length = math.hypot(goal - bx, by) or 1.0
    ux, uy = (goal - bx) / length, -by / length
    along = (robot.x - bx) * ux + (robot.y - by) * uy
    across = -(robot.x - bx) * uy + (robot.y - by) * ux
    if along < 0 and abs(across) < 0.03 + 0.15 * -along:
        return drive(robot, bx + 0.2 * ux, by + 0.2 * uy, speed=45.0)
    side = math.copysign(0.12, across) if along > -0.05 else 0.0
    return drive(robot, bx - 0.15 * ux - side * uy, by - 0.15 * uy + side * ux)
