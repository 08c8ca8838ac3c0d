"""What runs on another host before the script does: it takes the script from where it starts."""

from __future__ import annotations

# The text of these functions goes over a connection, each alone, to a Python of any age. So they
# import what they need, and are called with values that stand in the text.


def source_first(setup: str, command: str) -> None:
    """Have a shell source a file and run a command; what is not read yet is for that."""
    import os
    from pathlib import Path
    import sys

    path = Path.cwd() / Path(setup).expanduser()
    if not path.is_file():
        sys.exit(f'there is no setup file {path}')
    fault = '{ echo "the setup file $0 fails" >&2; exit 1; }'
    code = ' '.join(['source "$0" < /dev/null ||', fault + ';', command])
    try:
        os.execvp('bash', ['bash', '-c', code, str(path)])
    except OSError as error:
        sys.exit(f'bash cannot be run, which has to source {path}: {error}')


def run_script(size: int) -> None:
    """Read a script, files to go beside it and its words, so many bytes, and run it."""
    import json
    import os
    from pathlib import Path
    import sys
    import tempfile

    if sys.version_info < (3, 10):  # noqa: UP036
        version = '.'.join(map(str, sys.version_info[:2]))
        sys.exit(f'{sys.executable} is Python {version}, and 3.10 is needed')
    data = b''
    while len(data) < size:
        more = os.read(0, size - len(data))
        if not more:
            sys.exit('the connection is lost')
        data += more
    note = json.loads(data.decode())
    with tempfile.TemporaryDirectory(prefix='deros-') as folder:
        for name, text in note['files'].items():
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open('w', encoding='utf-8', newline='') as file:
                file.write(text)
        script = str(Path(folder, note['script']))
        sys.argv = [script, *note['words']]
        own = globals()
        own['__file__'] = script
        exec(compile(note['files'][note['script']], script, 'exec'), own)
