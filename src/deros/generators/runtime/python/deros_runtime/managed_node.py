"""Managed nodes, with what rclpy leaves out."""

from __future__ import annotations

from collections.abc import Callable
import traceback
from typing import Any

from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE

HOOKS = ('configure', 'activate', 'deactivate', 'cleanup', 'shutdown', 'error')

# The results of a hook after which publishers, handlers and timers are left as they are.
UNLESS = {
    'activate': (SUCCESS,),
    'deactivate': (SUCCESS, FAILURE),  # the hook deactivates them; if it fails, the node is active
    'shutdown': (),
}


class ManagedNode(LifecycleNode):
    """
    A managed node whose publishers, handlers and timers are inactive unless the node is active.

    rclpy deactivates them in on_deactivate() alone: not when the node is shut down while it is
    active, nor when a hook that activates or deactivates it raises or fails. And it does not log
    the exception of a hook.
    """

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        """Wrap the hooks, which rclpy looks up once; the arguments are those of its class."""
        for name in HOOKS:
            hook = getattr(self, f'on_{name}')
            setattr(self, f'on_{name}', self._wrapped(name, hook))
        super().__init__(node_name, **kwargs)

    def _wrapped(self, name: str, hook: Callable[[Any], Any]) -> Callable[[Any], Any]:
        """Return a hook that logs its exceptions, and deactivates the node where it has to."""
        unless = UNLESS.get(name)

        def run(state: Any) -> Any:
            result = None
            try:
                result = hook(state)
            except Exception:
                log = self.get_logger()  # type: ignore[no-untyped-call]
                log.error(f'on_{name} failed:\n{traceback.format_exc()}')
                raise
            finally:
                if unless is not None and result not in unless:
                    LifecycleNode.on_deactivate(self, state)
            return result

        return run
