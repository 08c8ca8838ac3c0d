"""Launch files in XML and YAML to system descriptions: the way back from the generated ones."""
