"""Where and how the programs of a system run: processes, containers, hosts, start and end."""
