"""What `make install` installs is found and works wherever the tree is moved, with PYTHONPATH alone."""

import glob
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = os.environ["TC_BUILD"]
CODE = """
import tetcast, _tetcast
image = tetcast.render(tetcast.synth("heatsink", 2000, reentry="convexify"), window_size=(32, 32))
print(image[..., 3].max() > 0.01, tetcast.__file__, _tetcast.lib._name)
"""


def python(code, folder, **environment):
    kept = {name: value for name, value in os.environ.items() if name in ("PATH", "HOME", "LANG", "TMPDIR")}
    return subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, env={
        **kept, "PYTHONPATH": folder, "PYTHONDONTWRITEBYTECODE": "1", **environment})


class Install(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = holder.name

    def test_the_installed_module_does_not_find_the_library(self):
        stage, moved = os.path.join(self.folder, "stage"), os.path.join(self.folder, "moved")
        subprocess.run([os.environ.get("CMAKE", "cmake"), "--install", BUILD], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "DESTDIR": stage})
        (program,) = glob.glob(stage + "/**/bin/tetcast", recursive=True)
        os.rename(os.path.dirname(os.path.dirname(program)), moved)
        (module,) = glob.glob(moved + "/**/tetcast.py", recursive=True)
        done = python(CODE, os.path.dirname(module))
        self.assertEqual(done.stderr, "")
        seen, file, library = done.stdout.split()
        self.assertEqual((seen, file), ("True", module))
        self.assertTrue(os.path.realpath(library).startswith(os.path.realpath(moved) + os.sep), library)

    def test_a_library_that_is_not_there_or_wrong_is_no_sentence(self):
        for name in ("tetcast.py", "_tetcast.py"):
            shutil.copy(os.path.join(os.environ["TC_SOURCE"], "src", "python", name), self.folder)
        library = os.path.join(self.folder, "gone.so")
        done = python("import tetcast", self.folder, TETCAST_LIBRARY=library)
        self.assertRegex(done.stderr, r"ImportError: libtetcast cannot be loaded from \S*gone.so .*TETCAST_LIBRARY")
        done = python("import tetcast", self.folder, TETCAST_LIBRARY="libm.so.6")
        self.assertRegex(done.stderr, "ImportError: libm.so.6 has no tc_version: it is of another version")
        shutil.copy(os.path.realpath(os.path.join(BUILD, "libtetcast.so")), os.path.join(self.folder, "libtetcast.so.0"))
        done = python("import _tetcast; print(_tetcast.lib._name)", self.folder)
        self.assertEqual(done.stdout.strip(), os.path.join(os.path.realpath(self.folder), "libtetcast.so.0"))


if __name__ == "__main__":
    unittest.main()
