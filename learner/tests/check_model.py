"""Checks an exported actor with ONNX's own checker and runs it: check_model.py MODEL REFERENCE"""
import json
import sys

try:
    import numpy
    import onnx
    from onnx.reference import ReferenceEvaluator
except ImportError:
    print("skipped: python3 -m pip install onnx numpy")
    sys.exit(0)

model = onnx.load(sys.argv[1])
onnx.checker.check_model(model, full_check=True)
contract = json.loads(next(entry.value for entry in model.metadata_props if entry.key == "vodca.contract"))
scale, offset = numpy.array(contract["observation"]["scale"]), numpy.array(contract["observation"]["offset"])
cases = json.load(open(sys.argv[2]))["cases"]
state = numpy.array([case["observation"] for case in cases]).reshape(len(cases), -1, 2)
state = ((state - offset) * scale).astype(numpy.float32).reshape(len(cases), -1)
mean, log_std = ReferenceEvaluator(model).run(["mean", "log_std"], {"state": state})
for name, got in [("mean", mean), ("log_std", log_std)]:
    error = abs(got - numpy.array([case[name] for case in cases])).max()
    assert error < 1e-5, (name, error)
print(f"{len(cases)} states answered alike")
