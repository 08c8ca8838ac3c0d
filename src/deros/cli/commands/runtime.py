"""``deros runtime``: the ROS 2 packages that safety packages depend on."""

from __future__ import annotations

from pathlib import Path

import click

from deros.cli.streams import say
from deros.cli.writing import file_errors


@click.command()
@click.argument("directory", type=click.Path(file_okay=False, path_type=Path))
@click.option("--overwrite", is_flag=True, help="Replace files that were edited by hand, too.")
def runtime(directory: Path, overwrite: bool) -> None:
    """Write the packages deros_runtime and deros_runtime_cpp.

    DIRECTORY is the source folder of a workspace. The packages that 'deros generate' makes of rules
    depend on one of the two, and build only with the version of this deros. 'deros generate' writes
    it too, if the workspace lacks it.
    """
    from deros.cli.commands.generate import report_written
    from deros.cli.findings import show
    from deros.generators.output.claims import RUNTIME, record_claims
    from deros.generators.output.writer import write
    from deros.generators.runtime.interface import runtime_packages

    with file_errors():
        files = runtime_packages()
        written = write(files, directory, overwrite=overwrite)
        record_claims(files, directory, RUNTIME)
    show(written.diagnostics)
    say(report_written(written))
