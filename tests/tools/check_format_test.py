#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_format must see a source that is not in house style, and pass one that is."""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent.parent
SKIPPED = 77


def run_check(text):
    """Exit code and output of check_format on a tree with one source."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        shutil.copy(REPOSITORY / ".clang-format", tree)
        (tree / "src").mkdir()
        (tree / "src/a.cpp").write_text(text)
        result = subprocess.run([sys.executable, REPOSITORY / "tools/check_format", tree], capture_output=True, text=True)
        return result.returncode, result.stdout


class CheckFormat(unittest.TestCase):
    def test_passes_a_source_in_house_style(self):
        code, output = run_check("int one() { return 1; }\n")
        self.assertEqual(code, 0, output)
        self.assertIn("1 files, 0 not in house style", output)

    def test_names_a_source_that_is_not(self):
        code, output = run_check("int one()\n{\n  return 1;\n}\n")
        self.assertEqual(code, 1, output)
        self.assertIn("src/a.cpp: not in house style", output)


if __name__ == "__main__":
    if run_check("")[0] == SKIPPED:
        print("check_format skips with this clang-format, and so does its test")
        sys.exit(SKIPPED)
    unittest.main()
