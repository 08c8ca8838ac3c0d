"""``python -m deros``: the same as ``deros``."""

from deros.cli.start import main

if __name__ == "__main__":
    main()
