"""System descriptions to launch files in XML and YAML."""
