"""The policy of a system for SROS2: what each node may publish, subscribe, request and reply."""
