"""What goes to another host: no shell on the way reads anything else in it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from deros.generators.system.script.standalone.hosts.connection import (
    FAILED,
    NOT_FOUND,
    Host,
    meaning,
    sent,
    ssh_command,
)
from tests.support.needs import may_run, needs

SCRIPT = (
    "import json, os, sys; own = os.path.dirname(__file__); "
    "beside = open(os.path.join(own, 'files/beside.txt'), encoding='utf-8', newline='').read(); "
    "rest = sys.stdin.buffer.read().decode(); "
    "print(json.dumps([sys.argv[1:], beside, rest, os.environ.get('SEEN'), own]))"
)
NASTY = 'it\'s "$HOME" `x` \\ ! ~ * \n;& %s {0} é \t#'
LETTERS = st.sampled_from([*"ab'\"$`\\!~*?[]{}()<>|&;#% \t\n\r=-^", "é", "\u2028", "😀", "\x7f"])
WORDS = st.text(LETTERS, max_size=20)
NAMES = st.text(LETTERS, min_size=1, max_size=20).filter(lambda name: name not in (".", ".."))
HOST = Host("robot", "robot.test")


def run(shell: str, folder: Path, setup: str, words: list[str], beside: str) -> list[object]:
    """Have a shell run what ssh would give it; return what the script has found."""
    data, size = sent(setup, "s.py", {"s.py": SCRIPT, "files/beside.txt": beside}, words)
    command = ssh_command("ssh", HOST, 10.0, size)[-1]
    done = subprocess.run(
        [shell, "-c", command],
        input=data + b"go\n",
        capture_output=True,
        cwd=folder,
        env={"PATH": os.environ["PATH"], "HOME": str(folder)},
        check=True,
    )
    found: list[object] = json.loads(done.stdout)
    return found


@needs("sh", "bash")
@pytest.mark.parametrize("shell", ["sh", "bash"])
@settings(deadline=None, max_examples=20)
@given(name=NAMES, word=WORDS, beside=WORDS)
@example(name=NASTY, word=NASTY, beside=NASTY)
@example(name="-x", word="--only", beside="\r\n")
def test_any_text_arrives(shell: str, name: str, word: str, beside: str) -> None:
    """The path of the setup file, words and files: each as it is, and nothing read too far."""
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        (folder / name).write_text("export SEEN=yes; cat")
        *found, own = run(shell, folder, f"{folder}/{name}", [word], beside)
        assert found == [[word], beside, "go\n", "yes"]
        assert isinstance(own, str)
        assert not Path(own).exists()


@needs("sh", "bash")
def test_setup_file_may_be_below_the_home_folder(tmp_path: Path) -> None:
    """A relative path begins there, and so does `~`; without one, nothing is sourced."""
    (tmp_path / "setup.bash").write_text("export SEEN=home")
    for setup, seen in (("setup.bash", "home"), ("~/setup.bash", "home"), ("", None)):
        assert run("sh", tmp_path, setup, [], "")[3] == seen


@may_run("fish", "csh", "zsh", "dash")
@pytest.mark.parametrize("shell", ["fish", "csh", "zsh", "dash"])
def test_other_shells_read_the_same(shell: str, tmp_path: Path) -> None:
    """The shell on a host is that of its user."""
    if shutil.which(shell) is None:
        pytest.skip(f"no {shell}")
    assert run(shell, tmp_path, "", [NASTY], NASTY)[:2] == [[NASTY], NASTY]


@pytest.mark.parametrize("address", ["", "-oProxyCommand=x", "a b", "a\n", "a\x00", "\u2028"])
def test_address_that_is_none(address: str) -> None:
    """An option, or several words, would be read as such."""
    assert Host("robot", address).fault() is not None


@pytest.mark.parametrize(
    "address", ["robot", "me@192.168.7.2", "ssh://me@robot:2222", "fe80::1%eth0"]
)
def test_address_for_ssh(address: str) -> None:
    """Any destination of ssh is one, an alias of its configuration as well."""
    host = Host("robot", address)
    assert host.fault() is None
    words = ssh_command("ssh -F 'my conf'", host, 1.5, 3)
    assert " ".join(words[:4]) == "ssh -F my conf -T"
    assert words[-3:-1] == ["--", address]
    assert "ConnectTimeout=2" in words


@pytest.mark.parametrize(
    ("code", "said", "advice"),
    [
        (FAILED, b"ssh: Could not resolve hostname robot.test: Name unknown", "is it on"),
        (FAILED, b"me@robot.test: Permission denied (publickey).", "ssh-copy-id robot.test"),
        (FAILED, b"Host key verification failed.\r", "connect once by hand"),
        (NOT_FOUND, b"sh: 1: exec: python3: not found", "install it there"),
        (2, b"Programs not found", "for the reason above"),
    ],
)
def test_failure_is_one_line_that_says_what_to_do(code: int, said: bytes, advice: str) -> None:
    """With the name of the host."""
    line = meaning(HOST, code, [b"", said, b""])
    assert "robot" in line
    assert advice in line
    assert "\n" not in line
