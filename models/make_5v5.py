#!/usr/bin/env python3
"""Writes the models of 5 against 5 beside those of 3 against 3, of which they are made: the field's numbers are replaced and two
robots a team are added. `make_5v5.py --check` says whether the files are what it would write (tests/lint.sh does)."""
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
NOTE = "<!-- Made by make_5v5.py of %s: change that, and run it. -->\n"

# x, y of robots 3 and 4 of blue; yellow's are turned by pi.
START = {3: (-0.375, 0.4), 4: (-0.375, -0.4)}
# (length, width) / 2 = (1.1, 0.9), goals 0.4 x 0.15, corners 0.07: include/vsss/division.h.
FIELD = [
    ("blocks beside the goal: y = 0.20 to 0.65", "y = 0.20 to 0.65", "y = 0.20 to 0.90"),
    ("side walls", 'size=".75 .05 .1" pos="0 .65 .05"', 'size="1.1 .05 .1" pos="0 .9 .05"'),
    ("side walls", 'size=".75 .05 .1" pos="0 -.65 .05"', 'size="1.1 .05 .1" pos="0 -.9 .05"'),
    ("goal ends", 'pos="-.85 0 .05"', 'pos="-1.25 0 .05"'),
    ("goal ends", 'pos=".85 0 .05"', 'pos="1.25 0 .05"'),
    ("corners", '.715 .615 .05"', '1.065 .865 .05"'),
    ("corners", '.715 -.615 .05"', '1.065 -.865 .05"'),
    ("end walls", 'size=".1 .225 .1"', 'size=".15 .35 .1"'),
    ("end walls", '.85 .425 .1"', '1.25 .55 .1"'),
    ("end walls", '.85 -.425 .1"', '1.25 -.55 .1"'),
    ("floor", '<geom name="floor" type="plane" size="1 1 .1"', '<geom name="floor" type="plane" size="1.5 1.5 .1"'),
    ("header", "Sizes are those of include/vsss/field.h", "Sizes are those of include/vsss/division.h"),
]
VISUAL = [
    ("floor", 'width="1700" height="1300"', 'width="2500" height="1800"'),
    ("floor", '<geom name="floor" type="plane" size="0.85 0.65 1"', '<geom name="floor" type="plane" size="1.25 0.90 1"'),
    ("extent", 'extent="1.5"', 'extent="2.2"'),
    ("side walls", 'size="0.775 0.0125 0.035" pos="0 0.6625 0.015"', 'size="1.125 0.0125 0.035" pos="0 0.9125 0.015"'),
    ("side walls", 'size="0.775 0.0125 0.035" pos="0 -0.6625 0.015"', 'size="1.125 0.0125 0.035" pos="0 -0.9125 0.015"'),
    ("goal ends", '0.8625 0 0.0153"', '1.2625 0 0.0153"'),
    ("end walls", 'size="0.0125 0.225 0.035" pos="0.7625 0.425 0.015"', 'size="0.0125 0.35 0.035" pos="1.1125 0.55 0.015"'),
    ("end walls", 'size="0.0125 0.225 0.035" pos="0.7625 -0.425 0.015"', 'size="0.0125 0.35 0.035" pos="1.1125 -0.55 0.015"'),
    ("end walls", 'size="0.0125 0.225 0.035" pos="-0.7625 0.425 0.015"', 'size="0.0125 0.35 0.035" pos="-1.1125 0.55 0.015"'),
    ("end walls", 'size="0.0125 0.225 0.035" pos="-0.7625 -0.425 0.015"', 'size="0.0125 0.35 0.035" pos="-1.1125 -0.55 0.015"'),
    ("goal sides", 'size="0.05 0.0125 0.035" pos="0.80 ', 'size="0.075 0.0125 0.035" pos="1.175 '),
    ("goal sides", 'size="0.05 0.0125 0.035" pos="-0.80 ', 'size="0.075 0.0125 0.035" pos="-1.175 '),
    ("corners", "0.7325 0.6325", "1.0825 0.8825"),
    ("corners", "0.7325 -0.6325", "1.0825 -0.8825"),
    ("header", "Sizes are field.h's", "Sizes are division.h's"),
]
# Twice the contacts, with room to spare.
ROOM = [("room", 'nconmax="80" njmax="260"', 'nconmax="160" njmax="600"')]


def replace(text, rows, name):
    for what, old, new in rows:
        if old not in text:
            sys.exit(f"make_5v5.py: {name}: {what}: no '{old}'")
        text = text.replace(old, new)
    return text


def renamed(text, team, number):
    return text.replace(f"{team}2", f"{team}{number}")


def more_bodies(text):
    """After each team's robot 2 its robots 3 and 4."""
    for team in ("blue", "yellow"):
        body = re.search(rf'    <body name="{team}2".*?\n    </body>\n', text, re.S)
        if not body:
            sys.exit(f"make_5v5.py: no body {team}2")
        added = ""
        for number, (x, y) in START.items():
            x, y = (x, y) if team == "blue" else (-x, -y)
            copy = renamed(body.group(0), team, number)
            copy = re.sub(r'(<body [^>]*pos=")-?0\.375 -?0\.2 0"', rf'\g<1>{x:g} {y:g} 0"', copy)
            copy = re.sub(r'(class="x" ref=")[^"]*', rf"\g<1>{x:g}", copy)
            copy = re.sub(r'(class="y" ref=")[^"]*', rf"\g<1>{y:g}", copy)
            added += copy
        text = text.replace(body.group(0), body.group(0) + added)
    return text


def more_lines(text):
    """Lines about a team's robot 2 alone, again for 3 and 4; couples of robots anew."""
    couple = r'(?:    <pair class="robot_robot" geom1=[^\n]*\n)+'
    names = [f"{team}{i}" for team in ("blue", "yellow") for i in range(5)]
    couples = "".join(f'    <pair class="robot_robot" geom1="{a}" geom2="{b}"/>\n'
                      for k, a in enumerate(names) for b in names[k + 1:])
    text, found = re.subn(couple, "@couples@", text)
    for team in ("blue", "yellow"):
        # A run of lines that all name robot 2 is followed by the same run for 3 and for 4.
        text = re.sub(rf'((?:    <(?:pair|velocity|texture|material) [^\n]*"{team}2[_"][^\n]*\n)+)',
                      lambda run: run.group(1) + renamed(run.group(1), team, 3) + renamed(run.group(1), team, 4), text)
    return text.replace("@couples@", couples) if found else text


def made():
    with_names = [('file="field.xml"', 'file="field_5v5.xml"'), ('file="contacts.xml"', 'file="contacts_5v5.xml"')]
    for name, rows in (("field", FIELD), ("contacts", []), ("vsss_contact", ROOM), ("vsss_planar", ROOM), ("vsss_visual", VISUAL)):
        with open(os.path.join(HERE, name + ".xml"), encoding="utf-8") as file:
            text = replace(file.read(), rows, name)
        if "<body " in text:
            text = more_bodies(text)
        text = more_lines(text)
        for old, new in with_names:
            text = text.replace(old, new)
        text = re.sub(r'<mujoco model="([^"]*)"', r'<mujoco model="\1_5v5"', text)
        yield name + "_5v5.xml", NOTE % (name + ".xml") + text


def main():
    stale = []
    for name, text in made():
        path = os.path.join(HERE, name)
        if sys.argv[1:] == ["--check"]:
            if not os.path.exists(path) or open(path, encoding="utf-8").read() != text:
                stale.append(name)
            continue
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    if stale:
        sys.exit(f"models: not what make_5v5.py makes: {' '.join(stale)}; run python3 models/make_5v5.py")


main()
