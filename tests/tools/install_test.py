#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""cmake --install of a finished build into a folder of its own.

usage: install_test.py CMAKE BUILD
exit code: 0 everything is there and the program runs from there; 1 not
"""
import gzip
import subprocess
import sys
import tempfile
from pathlib import Path

SHARED = ["man/man1/patency.1.gz", "bash-completion/completions/patency", "zsh/vendor-completions/_patency",
          "patency/cases/stented_bifurcation.yaml", "patency/cases/verify/pipe.yaml", "doc/patency/USER_GUIDE.md",
          "doc/patency/LICENSE"]


def main(cmake, build):
    with tempfile.TemporaryDirectory(suffix=" with space") as folder:
        root = Path(folder)
        subprocess.run([cmake, "--install", build, "--prefix", root], check=True, stdout=subprocess.DEVNULL)
        missing = [name for name in SHARED if not (root / "share" / name).is_file()]
        assert not missing, missing
        manual = gzip.decompress((root / "share/man/man1/patency.1.gz").read_bytes()).decode()
        assert manual.startswith(".TH PATENCY 1"), manual[:100]
        deck = root / "share/patency/cases/stented_bifurcation.yaml"   # which finds its network beside it
        for arguments, words in [(["version"], "patency "), (["check", deck], "the deck is right")]:
            done = subprocess.run([root / "bin/patency", *arguments], cwd="/", capture_output=True, text=True)
            assert done.returncode == 0 and words in done.stdout, (arguments, done)
        return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
