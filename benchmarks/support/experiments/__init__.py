"""The paper's experiments, repeated: what is done, recorded, found in the recordings and shown."""
