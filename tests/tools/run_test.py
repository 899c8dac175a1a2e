#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The script ./run, copied to a folder of its own, with stand-ins for every program it calls: nothing is installed or
built here. Held to: the usage, what is installed and when, and that exit codes pass through."""
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent.parent
# Knows every package but those in the variable MISSING, as dpkg-query prints with ./run's format.
DPKG = """for name; do
    case $name in -W | -f | '$'*) ;; *) [[ " $MISSING " == *" $name "* ]] || printf 'installed:%s ' "$name" ;; esac
done"""


class Run(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(suffix=" with space")
        self.addCleanup(self.folder.cleanup)
        self.tree = Path(self.folder.name)
        shutil.copy(REPOSITORY / "run", self.tree)
        self.programs = self.tree / "bin"
        for name in ("bash", "env", "dirname", "readlink", "cat", "rm", "mkdir", "uname"):
            self.add_link(name)
        self.add_program("bin/dpkg-query", DPKG)
        self.add_program("bin/id", "echo 0")
        for name in ("apt-get", "cmake", "ctest", "cpack"):
            self.add_program(f"bin/{name}", f'echo "{name} $*"')

    def add_link(self, name):
        self.programs.mkdir(exist_ok=True)
        (self.programs / name).symlink_to(shutil.which(name))

    def add_program(self, path, text):
        file = self.tree / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"#!{shutil.which('bash')}\n{text}\n")
        file.chmod(0o755)

    def run_it(self, *arguments, missing=""):
        """Exit code and everything printed."""
        result = subprocess.run([self.tree / "run", *arguments], cwd="/", text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, env={"PATH": str(self.programs), "MISSING": missing})
        return result.returncode, result.stdout

    def test_explains_itself(self):
        for arguments, code in [((), 2), (("dance",), 2), (("help",), 0)]:
            with self.subTest(arguments=arguments):
                self.assertEqual(self.run_it(*arguments)[0], code)
                self.assertIn("usage: ./run COMMAND", self.run_it(*arguments)[1])

    def test_installs_nothing_when_nothing_is_missing(self):
        code, output = self.run_it("build")
        self.assertEqual(code, 0, output)
        self.assertNotIn("apt-get", output)
        self.assertIn("cmake --preset release", output)

    def test_installs_exactly_what_is_missing(self):
        code, output = self.run_it("build", missing="ninja-build libvtk9-dev")
        self.assertEqual(code, 0, output)
        self.assertIn("--no-install-recommends ninja-build libvtk9-dev\n", output)

    def test_brings_node_where_there_is_none_and_a_browser_for_tests_only(self):
        absent = "nodejs npm chromium"
        self.assertIn("--no-install-recommends nodejs npm\n", self.run_it("build", missing=absent)[1])
        self.assertIn("--no-install-recommends nodejs npm chromium\n", self.run_it("test", missing=absent)[1])
        for name in ("node", "npm", "chromium"):   # whoever brought them
            self.add_program(f"bin/{name}", "exit 0")
        self.assertNotIn("apt-get", self.run_it("test", missing=absent)[1])

    def test_uses_sudo_when_not_root_and_says_what_to_do_without(self):
        self.add_program("bin/id", "echo 1000")
        code, output = self.run_it("build", missing="cmake")
        self.assertEqual(code, 1, output)
        self.assertIn("as root: apt-get install cmake", output)
        self.add_program("bin/sudo", 'echo "sudo $1"; exec "$@"')
        code, output = self.run_it("build", missing="cmake")
        self.assertEqual(code, 0, output)
        self.assertIn("sudo apt-get", output)

    def test_says_when_the_installation_fails(self):
        self.add_program("bin/apt-get", "exit 100")
        code, output = self.run_it("test", missing="cmake")
        self.assertEqual(code, 1, output)
        self.assertIn("apt-get update failed", output)

    def test_configures_only_once(self):
        self.add_program("build/release/build.ninja", "")
        self.assertNotIn("--preset", self.run_it("build")[1])

    def test_passes_arguments_and_exit_codes_through(self):
        self.add_program("build/release/patency", 'echo "patency $*"; exit 5')
        self.add_program("bin/ctest", 'echo "ctest $*"; exit 8')
        code, output = self.run_it("bench", "--json")
        self.assertEqual(code, 5, output)
        self.assertIn("patency bench flow --json", output)
        self.assertEqual(self.run_it("demo")[0], 5)
        code, output = self.run_it("test", "-R", "particles")
        self.assertEqual(code, 8, output)
        self.assertIn("-R particles", output)

    def test_checks_the_unit_tests_in_a_build_of_their_own(self):
        self.add_program("bin/ctest", 'echo "ctest $*"; exit 8')
        code, output = self.run_it("sanitize", "-R", "pairs")
        self.assertEqual(code, 8, output)
        folder = f"{self.tree}/build/sanitize"
        self.assertIn(f"cmake --preset sanitize\ncmake --build {folder} --target unit_tests\nctest --test-dir {folder} ", output)
        self.assertTrue(output.endswith(" -R pairs\n"), output)

    def test_makes_a_package_of_one_build_per_instruction_set(self):
        self.add_program("bin/cmake", '''echo "cmake $*"; [[ $1 != --build ]] || mkdir -p "$2"''')
        self.add_program("bin/cpack", "touch_package() { : > patency_1_amd64.deb; }; touch_package")
        code, output = self.run_it("package", missing="dpkg-dev file")
        self.assertEqual(code, 0, output)
        self.assertIn("--no-install-recommends dpkg-dev file\n", output)
        for name in ("baseline", "avx2", "avx512"):
            self.assertIn(f"cmake --preset {name}\ncmake --build {self.tree}/build/package/{name} --target all\n", output)
        self.assertTrue(output.endswith(f"\n{self.tree}/build/package/patency_1_amd64.deb\n"), output)
        self.add_program("bin/cpack", "echo no room; exit 3")
        code, output = self.run_it("package")
        self.assertEqual(code, 1, output)
        self.assertIn("no room", output)
        self.assertNotIn(".deb", output)

    def test_stops_when_the_build_fails(self):
        self.add_program("bin/cmake", "exit 3")
        code, output = self.run_it("test")
        self.assertEqual(code, 3, output)
        self.assertNotIn("ctest", output)


if __name__ == "__main__":
    unittest.main()
