"""`vsss replay --mcap FILE`, read by the mcap package of PyPI: topics, schemas, counts, the match's score, and what
Foxglove's documentation asks for: schemas that are JSON Schema of an object, names of a SceneUpdate's fields."""
import json
import math
import os
import subprocess
import tempfile
import unittest

try:
    import jsonschema
    from mcap.reader import make_reader
except ImportError:
    make_reader = None

VSSS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "vsss")


# docs.foxglove.dev, message schemas: what there is at each place of a SceneUpdate.
TIME = {"sec", "nsec"}
XYZ = {"x", "y", "z"}
POSE = {"pose": {"position": XYZ, "orientation": XYZ | {"w"}}, "color": {"r", "g", "b", "a"}}
SOLID = {**POSE, "size": XYZ}
ARROW = {**POSE, **dict.fromkeys(("shaft_length", "shaft_diameter", "head_length", "head_diameter"))}
ENTITY = {"timestamp": TIME, "lifetime": TIME, "frame_id": None, "id": None, "frame_locked": None, "cubes": [SOLID],
          "spheres": [SOLID], "arrows": [ARROW]}
SCENE = {"deletions": [set()], "entities": [ENTITY]}


def closed(schema):
    """The same, but nothing may be there that it does not name."""
    if isinstance(schema, dict):
        out = {k: closed(v) for k, v in schema.items()}
        return {**out, "additionalProperties": False} if "properties" in schema else out
    return schema


def names(schema):
    """Of its properties, as in SCENE."""
    if schema["type"] == "array":
        return [names(schema["items"])]
    if schema["type"] != "object":
        return None
    inside = {k: names(v) for k, v in schema.get("properties", {}).items()}
    return set(inside) if all(v is None for v in inside.values()) else inside


def run(*arguments):
    return subprocess.run([VSSS, *arguments], capture_output=True, text=True)


@unittest.skipUnless(make_reader, "no mcap package")
@unittest.skipUnless(os.path.exists(VSSS), "no ./vsss here")
class Mcap(unittest.TestCase):
    def test_export_is_read_by_the_reference_reader(self):
        port = str(22000 + os.getpid() % 8000)
        with tempfile.TemporaryDirectory() as folder:
            log, path = folder + "/log", folder + "/out.mcap"
            served = run("serve", "--ports", "+" + port, "--blue", "emc:", "--yellow", "random:", "--sync", "--pause", "0",
                         "--seconds", "20", "--drive", "planar", "--json", "--record", log)
            if "built without" in served.stderr:
                self.skipTest(served.stderr.strip())
            self.assertEqual(served.returncode, 0, served.stderr)
            match = json.loads(served.stdout)
            made = run("replay", log, "--mcap", path)
            self.assertEqual(made.returncode, 0, made.stderr)
            with open(path, "rb") as f:
                reader = make_reader(f)
                summary = reader.get_summary()
                topics = {c.topic: c for c in summary.channels.values()}
                self.assertEqual(sorted(topics), ["ball", "commands", "field", "robots", "scene", "score"])
                schemas = {}
                for c in topics.values():
                    self.assertEqual(c.message_encoding, "json")
                    schema = summary.schemas[c.schema_id]
                    known = {"scene": "foxglove.SceneUpdate"}
                    self.assertEqual((schema.name, schema.encoding), (known.get(c.topic, c.topic), "jsonschema"))
                    schemas[c.topic] = json.loads(schema.data)
                    self.assertEqual(schemas[c.topic]["type"], "object")
                    jsonschema.Draft202012Validator.check_schema(schemas[c.topic])
                messages = [(c.topic, m.log_time, json.loads(m.data)) for _, c, m in reader.iter_messages()]
            self.assertEqual(len(messages), summary.statistics.message_count)
            check = {t: jsonschema.Draft202012Validator(closed(s)) for t, s in schemas.items()}
            for topic, _, message in messages[:3000]:
                check[topic].validate(message)
            self.assertEqual(names(schemas["scene"]), SCENE)
            count = {t: sum(1 for m in messages if m[0] == t) for t in topics}
            for topic, c in topics.items():
                self.assertEqual(summary.statistics.channel_message_counts[c.id], count[topic])
            self.assertEqual(count["field"], 1)
            self.assertGreaterEqual(count["robots"], 600)
            self.assertEqual(count["ball"], count["robots"])
            self.assertGreater(count["commands"], 100)
            by_topic = {t: [m[2] for m in messages if m[0] == t] for t in topics}
            self.assertEqual(by_topic["field"][0]["length_m"], 1.5)
            for world in by_topic["robots"]:
                self.assertEqual([r["id"] for r in world["blue"] + world["yellow"]], [0, 1, 2, 0, 1, 2])
                for r in world["blue"]:
                    self.assertLess(abs(r["x_m"]), 0.9)
            # A scene at most every 33 ms: with 60 worlds a second every second one. Robots stand where the worlds have them.
            self.assertGreaterEqual(count["scene"], count["robots"] // 3)
            self.assertLessEqual(count["scene"], count["robots"] // 2 + 1)
            first = {e["id"]: e for e in by_topic["scene"][0]["entities"]}
            self.assertEqual(sorted(first), ["ball", "field", "robots"])
            self.assertEqual([len(first["robots"]["cubes"]), len(first["robots"]["arrows"])], [6, 6])
            self.assertEqual(first["field"]["cubes"][0]["size"]["x"], 1.5)
            at = first["robots"]["cubes"][3]["pose"]
            yellow = by_topic["robots"][0]["yellow"][0]
            self.assertAlmostEqual(at["position"]["x"], yellow["x_m"], 3)
            turn = 2 * math.atan2(at["orientation"]["z"], at["orientation"]["w"]) - yellow["theta_rad"]
            self.assertAlmostEqual(math.remainder(turn, 2 * math.pi), 0, 3)
            self.assertEqual(sorted(e["id"] for e in by_topic["scene"][1]["entities"]), ["ball", "robots"])
            goals = [m for m in by_topic["score"] if m["event"] == "goal"]
            self.assertEqual(len(goals), sum(match["score"]))
            if goals:
                self.assertEqual([goals[-1]["blue"], goals[-1]["yellow"]], match["score"])
            times = [m[1] for m in messages]
            # Played in a moment (--sync), watched at its own pace: 60 worlds a second.
            self.assertAlmostEqual((max(times) - min(times)) * 1e-9, count["robots"] / 60, delta=0.1)
            self.assertEqual((min(times), max(times)),
                             (summary.statistics.message_start_time, summary.statistics.message_end_time))

    def test_wrong_use_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            refused = run("replay", folder + "/none", "--mcap", "x", "--check")
            self.assertEqual(refused.returncode, 2)
            self.assertIn("choose one", refused.stderr)


if __name__ == "__main__":
    unittest.main()
