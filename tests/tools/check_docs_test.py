#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_docs must see every kind of mistake: each test plants one in a small tree of its own."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent.parent
THEORY = "## 1. One\n$$a \\tag{1.1}$$\nfollows from (1.2) below\n$$b \\tag{1.2}$$\n## 2. Two\n$$c \\tag{2.1}$$\n"


def run_check(files):
    """Exit code and output of check_docs on a tree with these files: {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        for path, text in {"docs/THEORY.md": THEORY, **files}.items():
            (tree / path).parent.mkdir(parents=True, exist_ok=True)
            (tree / path).write_text(text)
        result = subprocess.run([sys.executable, REPOSITORY / "tools/check_docs", tree], capture_output=True, text=True)
        return result.returncode, result.stdout


class CheckDocs(unittest.TestCase):
    def expect_sentence(self, files, sentence):
        code, output = run_check(files)
        self.assertEqual(code, 1, output)
        self.assertIn(sentence, output)

    def test_passes_on_good_citations_and_links(self):
        code, output = run_check({"src/a.h": "/// THEORY (1.1), (2.1)\n// as THEORY.md (1.2) says\n",
                                  "README.md": "[theory](docs/THEORY.md#1-one) [web](https://example.org)\n"})
        self.assertEqual(code, 0, output)

    def test_finds_a_number_that_does_not_exist(self):
        for text in ("/// THEORY (1.3)\n", "/// THEORY.md (1.1), (1.3)\n", "/// THEORY (1.1) to (1.3)\n"):
            with self.subTest(text=text):
                self.expect_sentence({"src/a.h": text}, "src/a.h:1: there is no equation (1.3)")
        self.expect_sentence({"docs/THEORY.md": THEORY + "see (3.1)\n"}, "docs/THEORY.md:7: there is no equation (3.1)")

    def test_finds_numbers_out_of_order_and_twice(self):
        self.expect_sentence({"docs/THEORY.md": THEORY.replace("{1.2}", "{1.1}").replace("(1.2)", "")}, "where (1.2) is due")
        self.expect_sentence({"docs/THEORY.md": THEORY.replace("{2.1}", "{1.3}")}, "where (2.1) is due")

    def test_finds_a_dead_link(self):
        self.expect_sentence({"README.md": "see\n[guide](docs/GUIDE.md)\n"}, "README.md:2: the link docs/GUIDE.md")


if __name__ == "__main__":
    unittest.main()
