"""`vsss replay --mcap FILE`, read by the mcap package of PyPI: topics, schemas, counts, and the match's score."""
import json
import os
import subprocess
import tempfile
import unittest

try:
    from mcap.reader import make_reader
except ImportError:
    make_reader = None

VSSS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "vsss")


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
                self.assertEqual(sorted(topics), ["ball", "commands", "field", "robots", "score"])
                for c in topics.values():
                    self.assertEqual(c.message_encoding, "json")
                    schema = summary.schemas[c.schema_id]
                    self.assertEqual((schema.name, schema.encoding), (c.topic, "jsonschema"))
                    self.assertEqual(json.loads(schema.data)["type"], "object")
                messages = [(c.topic, m.log_time, json.loads(m.data)) for _, c, m in reader.iter_messages()]
            self.assertEqual(len(messages), summary.statistics.message_count)
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
            goals = [m for m in by_topic["score"] if m["event"] == "goal"]
            self.assertEqual(len(goals), sum(match["score"]))
            if goals:
                self.assertEqual([goals[-1]["blue"], goals[-1]["yellow"]], match["score"])
            times = [m[1] for m in messages]
            self.assertEqual((min(times), max(times)),
                             (summary.statistics.message_start_time, summary.statistics.message_end_time))

    def test_wrong_use_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            refused = run("replay", folder + "/none", "--mcap", "x", "--check")
            self.assertEqual(refused.returncode, 2)
            self.assertIn("choose one", refused.stderr)


if __name__ == "__main__":
    unittest.main()
