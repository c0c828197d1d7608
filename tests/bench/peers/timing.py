"""How every peer is timed: a second to warm up, then `seconds` of wall time, the clock read every few calls only."""
import time


def rate(call, seconds, at_once=20):
    """Calls of `call` per second of wall time."""
    for limit in (1.0, seconds):
        count, start = 0, time.perf_counter()
        while (elapsed := time.perf_counter() - start) < limit:
            for _ in range(at_once):
                call()
            count += at_once
    return count / elapsed


def say(name, value):
    print(f"peer {name} {value:.6g}", flush=True)
