"""Write a big, clean system description: a fleet of carts, ten nodes each, wired in a chain.

Every node is nine lines, as in hand-written systems: a comment, the instance with two parameters
and two wirings, and its share of the declared topics. The node types stand in three ``.rnd`` files.
"""

from __future__ import annotations

import argparse
from pathlib import Path

NODES_PER_CART = 10

DRIVER = """\
node driver : cart_sensors "Reads one sensor and publishes its distance"
parameters
  name rate : double = 20.0 [Hz] in [1.0, 100.0]
  name frame_id : string = "sensor_link"
publishes
  topic distance : sensor_msgs.Range qos best_effort depth 5
subscribes
  topic trigger : std_msgs.Bool
"""

FILTER = """\
node smoother : cart_filters "Smooths what the stage before it publishes"
parameters
  name window : int = 5 in [1, 50]
  name mode : string = "mean" one_of ["mean", "median"]
publishes
  topic smoothed : sensor_msgs.Range
subscribes
  topic raw : sensor_msgs.Range qos best_effort
"""

BRAKE = """\
node brake : cart_brakes "Brakes when the way ahead is too short"
parameters
  name threshold : double = 0.8 [m]
  name label : string = "front"
publishes
  topic braking : std_msgs.Bool
subscribes
  topic ahead : sensor_msgs.Range
"""


def _cart(number: int) -> tuple[list[str], list[str]]:
    """Return the topic lines and the subsystem lines of one cart."""
    base = f"/cart_{number}"
    topics = [f"  topic {base}/braking"]
    topics += [f"  topic {base}/stage_{stage}" for stage in range(NODES_PER_CART - 1)]
    lines = [
        f"subsystem cart_{number} {{",
        f"  // the range sensor of cart {number}",
        f"  node driver_{number} : driver",
        "  parameters",
        "    param rate = 25.0",
        f'    param frame_id = "cart_{number}_link"',
        "  wirings",
        f"    connect trigger to {base}/braking",
        f"    connect distance to {base}/stage_0",
    ]
    for stage in range(1, NODES_PER_CART - 1):
        lines += [
            f"  // smooths stage {stage - 1} into stage {stage}",
            f"  node smoother_{number}_{stage} : smoother",
            "  parameters",
            f"    param window = {stage + 2}",
            '    param mode = "median"',
            "  wirings",
            f"    connect raw to {base}/stage_{stage - 1}",
            f"    connect smoothed to {base}/stage_{stage}",
        ]
    lines += [
        "  // stops the cart when the way ahead is short",
        f"  node brake_{number} : brake",
        "  parameters",
        "    param threshold = 1.25",
        f'    param label = "cart {number}"',
        "  wirings",
        f"    connect ahead to {base}/stage_{NODES_PER_CART - 2}",
        f"    connect braking to {base}/braking",
        "}",
        "",
    ]
    return topics, lines


def write(directory: Path, nodes: int) -> Path:
    """Write the models of about ``nodes`` nodes into ``directory``; return the system's path."""
    for name, text in (("driver", DRIVER), ("smoother", FILTER), ("brake", BRAKE)):
        (directory / f"{name}.rnd").write_text(text, encoding="utf-8")
    carts = [_cart(number) for number in range(max(1, nodes // NODES_PER_CART))]
    lines = ["system Fleet", "imports"]
    lines += [f'  import "{name}.rnd"' for name in ("driver", "smoother", "brake")]
    lines.append("topics")
    for topics, _ in carts:
        lines += topics
    for _, subsystem in carts:
        lines += subsystem
    path = directory / "fleet.system"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


STAGE = """\
node stage : cart_stages "Works on what the stage before it publishes, and reports on itself"
parameters
  name window : int = 5 in [1, 50]
publishes
  topic result : sensor_msgs.Range
  topic load : std_msgs.Float64
  topic alive : std_msgs.Bool
subscribes
  topic work : sensor_msgs.Range
"""

STAGE_TOPICS = 3


def write_in_files(directory: Path, nodes: int, files: int) -> Path:
    """Write a system of ``nodes`` nodes, each with topics of its own, that uses ``files`` files.

    Each of the files is a chain of nodes that ends where it begins; what the nodes report of
    themselves is read from outside.
    """
    (directory / "stage.rnd").write_text(STAGE, encoding="utf-8")
    main = ["system Plant", "imports"]
    uses = []
    for number in range(files):
        count = nodes * (number + 1) // files - nodes * number // files
        (directory / f"line_{number}.system").write_text(_line(number, count), encoding="utf-8")
        main.append(f'  import "line_{number}.system"')
        uses.append(f"subsystem line_{number} : Line{number} namespace /line_{number}")
    path = directory / "plant.system"
    path.write_text("\n".join([*main, *uses, ""]), encoding="utf-8")
    return path


def _line(number: int, nodes: int) -> str:
    lines = [f"system Line{number}", "imports", '  import "stage.rnd"', "topics"]
    for stage in range(nodes):
        lines.append(f"  topic stage_{stage}/result")
        lines += [f"  external topic stage_{stage}/{name}" for name in ("load", "alive")]
    for stage in range(nodes):
        lines += [
            f"node stage_{stage} : stage",
            "  parameters",
            f"    param window = {stage % 50 + 1}",
            "  wirings",
            f"    connect work to stage_{(stage or nodes) - 1}/result",
            *(f"    connect {n} to stage_{stage}/{n}" for n in ("result", "load", "alive")),
        ]
    return "\n".join([*lines, ""])


def main() -> None:
    """Write a system of the size asked for into a directory."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", type=Path)
    parser.add_argument("--nodes", type=int, default=1000)
    arguments = parser.parse_args()
    arguments.directory.mkdir(parents=True, exist_ok=True)
    print(write(arguments.directory, arguments.nodes))


if __name__ == "__main__":
    main()
