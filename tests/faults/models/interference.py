"""User code of an action: it executes the command in a file, once."""

import os
import signal
import sys
import threading
import time
from pathlib import Path

import rclpy
from rclpy.node import Node

FILE = Path(os.environ.get("INTERFERENCE", ""))


def interfere(node: Node) -> None:
    """Do what the file says, and remove it, so that the next process is not affected."""
    if not FILE.is_file():
        return
    how = FILE.read_text(encoding="ascii")
    FILE.unlink()
    node.get_logger().warning(f"interference: {how}")
    if how == "throw":
        raise OSError("no horn")
    if how == "throw something else":
        raise GeneratorExit
    if how == "exit":
        sys.exit(0)
    if how == "exit at once":
        os._exit(0)
    if how == "shutdown":
        rclpy.shutdown()
    if how == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if how == "who":
        node.get_logger().info(f"process {os.getpid()} of user {os.geteuid()}")
    if how == "wait":
        while not FILE.with_suffix(".over").exists():
            time.sleep(0.01)
    if how == "start a thread and throw":
        threading.Thread(target=threading.Event().wait).start()
        raise OSError("no horn")
