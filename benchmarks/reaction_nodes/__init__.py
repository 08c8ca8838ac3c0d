"""The processes that the safety node's reaction is compared with, and the load it is put under."""
