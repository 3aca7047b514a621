"""The network of a policy as an ONNX file for other programs."""

from pathlib import Path
from typing import Any

import numpy as np

from suchus.core.errors import InvalidDesign, SuchusError
from suchus.core.writing import write
from suchus.robot.control.policy import Policy, action_mirror, observation_mirror
from suchus.robot.design import Robot

_OPSET, _IR_VERSION = 17, 8
INPUT, OUTPUT = "observation", "correction"
"""Names of the input, shape (run, reading), and of the output, shape (run, action)."""


class NoOnnx(SuchusError, ImportError):
    """The library that writes ONNX is not installed."""


def export_onnx(policy: Policy, robot: Robot, path: str | Path) -> Path:
    """Write the network of a policy, its symmetry and its spans included, and return the path.

    The file says in its metadata what the columns of input and output are. The table is not in it: the output is what
    is added to the parameters of the table.

    Args:
        policy: the policy.
        robot: the robot.
        path: the file.

    Raises:
        NoOnnx: the library onnx is not installed.
        InvalidDesign: the policy has no network.
        Unwritable: the place cannot be written to.
    """
    try:
        import onnx  # noqa: PLC0415  an optional extra
        from onnx import TensorProto, helper, numpy_helper  # noqa: PLC0415
    except ImportError as error:
        raise NoOnnx("writing ONNX needs onnx; install it with: pip install 'suchus[onnx]'.") from error
    policy.check_robot(robot)
    if not policy.layers:
        raise InvalidDesign(
            f"policy {policy.name!r} is a table without a network, and ONNX holds networks: train one with "
            "--network-generations above 0."
        )
    constants: list[Any] = []

    def constant(name: str, values: np.ndarray) -> str:
        constants.append(numpy_helper.from_array(values, name))
        return name

    nodes: list[Any] = []

    def forward(source: str, branch: str) -> str:
        """Add the layers and the clipping to -1 and 1 of one branch, and return the name of its result."""
        for number in range(len(policy.layers)):
            product, total = f"{branch}_product_{number}", f"{branch}_sum_{number}"
            nodes.append(helper.make_node("MatMul", [source, f"weights_{number}"], [product]))
            nodes.append(helper.make_node("Add", [product, f"bias_{number}"], [total]))
            source = total
            if number < len(policy.layers) - 1:
                source = f"{branch}_hidden_{number}"
                nodes.append(helper.make_node("Softsign", [total], [source]))
        nodes.append(helper.make_node("Clip", [source, "least", "greatest"], [f"{branch}_answer"]))
        return f"{branch}_answer"

    for number, layer in enumerate(policy.layers):
        constant(f"weights_{number}", np.array(layer.weights, np.float32))
        constant(f"bias_{number}", np.array(layer.bias, np.float32))
    constant("least", np.array(-1.0, np.float32))
    constant("greatest", np.array(1.0, np.float32))
    constant("spans", np.array(policy.spans, np.float32))
    answer = forward(INPUT, "plain")
    if policy.is_symmetric:
        columns, signs = observation_mirror(robot, policy.gait, policy.readings)
        action_columns, action_signs = action_mirror(policy)
        constant("mirror_columns", columns.astype(np.int64))
        constant("mirror_signs", signs.astype(np.float32))
        constant("action_columns", action_columns.astype(np.int64))
        constant("action_signs", (0.5 * action_signs).astype(np.float32))
        constant("half", np.array(0.5, np.float32))
        nodes.append(helper.make_node("Gather", [INPUT, "mirror_columns"], ["gathered"], axis=1))
        nodes.append(helper.make_node("Mul", ["gathered", "mirror_signs"], ["mirrored"]))
        image = forward("mirrored", "mirror")
        nodes.append(helper.make_node("Gather", [image, "action_columns"], ["image"], axis=1))
        nodes.append(helper.make_node("Mul", ["image", "action_signs"], ["half_image"]))
        nodes.append(helper.make_node("Mul", [answer, "half"], ["half_answer"]))
        nodes.append(helper.make_node("Add", ["half_answer", "half_image"], ["mean"]))
        answer = "mean"
    nodes.append(helper.make_node("Mul", [answer, "spans"], [OUTPUT]))
    graph = helper.make_graph(
        nodes,
        policy.name,
        [helper.make_tensor_value_info(INPUT, TensorProto.FLOAT, ["run", len(policy.layers[0].weights)])],
        [helper.make_tensor_value_info(OUTPUT, TensorProto.FLOAT, ["run", len(policy.spans)])],
        constants,
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", _OPSET)], producer_name="suchus")
    model.ir_version = _IR_VERSION
    limbs = ["", *policy.limbs]
    action_texts = [f"{name} {limbs[limb + 1]}".rstrip() for name, limb in policy.action_columns]
    helper.set_model_props(
        model,
        {
            "robot": policy.robot,
            "task": policy.task,
            "readings": ", ".join(policy.readings),
            "actions": ", ".join(action_texts),
            "decision": f"{policy.decision:g} s",
        },
    )
    onnx.checker.check_model(model)
    return write(path, model.SerializeToString())
