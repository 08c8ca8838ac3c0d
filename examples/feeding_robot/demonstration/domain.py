"""A ROS domain and a ROS home of the demo's own, on the loopback alone."""

from __future__ import annotations

import contextlib
import fcntl
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

_DOMAINS = range(1, 102)  # the ports of higher ones may be taken by outgoing connections
_PROFILES = Path(__file__).with_name("loopback.xml")
_FAST_DDS = {"", "rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp"}
_LOCKS = Path(tempfile.gettempdir()) / "deros-test-domains"  # shared with the project's tests


@contextlib.contextmanager
def own_domain() -> Iterator[None]:
    """Confine this process and its children to a domain and a home that nobody else here uses.

    Raises:
        RuntimeError: if all domains are taken.
    """
    if os.environ.get("RMW_IMPLEMENTATION", "") in _FAST_DDS:
        os.environ["FASTRTPS_DEFAULT_PROFILES_FILE"] = str(_PROFILES)
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "SUBNET"
    else:
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    _LOCKS.mkdir(mode=0o777, exist_ok=True)
    for number in reversed(_DOMAINS):
        with (_LOCKS / str(number)).open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            os.environ["ROS_DOMAIN_ID"] = str(number)
            # What the safety node remembers over a restart is not to be of an earlier run.
            with tempfile.TemporaryDirectory() as os.environ["ROS_HOME"]:
                yield
            return
    raise RuntimeError("all ROS domains are in use")
