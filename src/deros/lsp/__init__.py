"""The language server: models in editors. The only room that imports pygls and lsprotocol."""
