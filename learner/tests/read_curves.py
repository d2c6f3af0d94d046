"""Reads the curves back with TensorBoard's own reader: read_curves.py FOLDER"""
import sys

try:
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator
except ImportError:
    print("skipped: python3 -m pip install tensorboard")
    sys.exit(0)

curves = EventAccumulator(sys.argv[1])
curves.Reload()
assert sorted(curves.Tags()["scalars"]) == ["alpha", "loss/critic"], curves.Tags()
assert [point.value for point in curves.Scalars("alpha")] == list(range(20))
points = curves.Scalars("loss/critic")
print(f"{len(points)} points of loss/critic, the last at {points[-1].step}: {points[-1].value:.4g}")
