#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_layers must see every kind of violation: each test plants one in a small tree of its own."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent.parent


def run_check(files):
    """Exit code and output of check_layers on a tree with these files: {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        floors = REPOSITORY / "src/patency/floors.txt"
        for path, text in {"src/patency/floors.txt": floors.read_text(), **files}.items():
            (tree / path).parent.mkdir(parents=True, exist_ok=True)
            (tree / path).write_text(text)
        result = subprocess.run([sys.executable, REPOSITORY / "tools/check_layers", tree], capture_output=True, text=True)
        return result.returncode, result.stdout


class CheckLayers(unittest.TestCase):
    def expect_sentence(self, files, *parts):
        code, output = run_check(files)
        self.assertEqual(code, 1, output)
        for part in parts:
            self.assertIn(part, output)

    def test_passes_on_includes_that_go_down(self):
        code, output = run_check({
            "src/patency/base/vec.h": "#include <cmath>\n",
            "src/patency/pairs/loop.h": '#include "patency/base/vec.h"\n#include "patency/pairs/pair.h"\n',
            "src/patency/pairs/pair.h": "",
            "src/patency/io/vtk.cpp": "#include <vtkPolyData.h>\n#include <hdf5.h>\n",
            "app/main.cpp": '#include "commands.h"\n#include "patency/stages/run.h"\n#include <CLI/CLI.hpp>\n',
        })
        self.assertEqual(code, 0, output)

    def test_finds_an_include_that_goes_up(self):
        self.expect_sentence({"src/patency/base/vec.h": '#include <cmath>\n\n#include "patency/pairs/loop.h"\n'},
                             "src/patency/base/vec.h:3: ", "base (floor 0)", "pairs (floor 4)")

    def test_finds_an_include_that_goes_sideways(self):
        self.expect_sentence({"src/patency/physics/eos.h": '  #  include "patency/particles/field.h"\n'},
                             "src/patency/physics/eos.h:1: ", "particles (floor 2)")

    def test_finds_an_upward_include_in_angle_brackets(self):
        self.expect_sentence({"src/patency/search/cells.cpp": "#include <patency/io/vtk.h>\n"}, "cells.cpp:1: ")

    def test_finds_a_relative_include(self):
        self.expect_sentence({"src/patency/base/vec.h": '#include "../pairs/loop.h"\n'}, "vec.h:1: ", "patency/FOLDER/FILE")

    def test_finds_a_folder_without_floor(self):
        self.expect_sentence({"src/patency/attic/old.h": ""}, "attic stands on no floor")
        self.expect_sentence({"src/patency/io/a.h": '#include "patency/attic/old.h"\n'}, "io/a.h:1: ")

    def test_finds_a_circle(self):
        self.expect_sentence({"src/patency/base/a.h": '\n#include "patency/base/b.h"\n',
                              "src/patency/base/b.h": '#include "patency/base/a.h"\n'},
                             "src/patency/base/a.h:2: ", "a.h -> src/patency/base/b.h -> src/patency/base/a.h")

    def test_finds_library_headers_outside_their_fence(self):
        for file, header in [("io/vtk.h", "vtkPolyData.h"), ("stages/run.cpp", "vtkPolyData.h"),
                             ("schemes/s.cpp", "openvdb/openvdb.h"), ("shape/s.h", "openvdb/tools/LevelSet.h"),
                             ("config/c.cpp", "hdf5.h"), ("config/c.h", "yaml-cpp/yaml.h"),
                             ("shape/s.h", "Eigen/Dense"), ("base/log.cpp", "spdlog/spdlog.h")]:
            with self.subTest(file=file, header=header):
                self.expect_sentence({f"src/patency/{file}": f"#include <{header}>\n"}, f"{file}:1: {header}")

    def test_finds_two_types_of_one_name(self):
        two = {"src/patency/base/a.h": "namespace patency {\n\nstruct Box {\n};\n\n}   // namespace patency\n"}
        self.expect_sentence({**two, "src/patency/base/b.h": "namespace patency {\nclass Box : Thing {\n};\n}\n"},
                             "src/patency/base/b.h:2: patency::Box is defined in src/patency/base/a.h:3 too")
        for other in ("namespace patency::deck {\nstruct Box {\n};\n}\n",                        # another namespace
                      "namespace patency {\nnamespace {\nstruct Box {\n};\n}   // namespace\n}\n",
                      "namespace patency {\nstruct Box;\n}\n"):
            with self.subTest(other=other):
                code, output = run_check({**two, "src/patency/base/b.cpp": other})
                self.assertEqual(code, 0, output)

    def test_says_when_there_is_no_tree(self):
        result = subprocess.run([sys.executable, REPOSITORY / "tools/check_layers", "/nowhere"], capture_output=True)
        self.assertEqual(result.returncode, 2)


if __name__ == "__main__":
    unittest.main()
