"""The example in README.md runs as it stands there and makes the picture that it says; so do those of docs/python.md."""

import os
import re
import tempfile
import unittest

import numpy as np

import tetcast
from support import SOURCE, cube


def examples(name):
    """Its Python blocks, in order."""
    with open(os.path.join(SOURCE, *name.split("/")), encoding="utf-8") as file:
        return re.findall(r"```python\n(.*?)```", file.read(), re.S)


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def test_the_readme_s_example_does_not_run(self):
        (code,) = examples("README.md")
        self.assertLessEqual(len([line for line in code.splitlines() if line and not line.startswith("import")]), 5)
        names = {}
        exec(compile(code, "README.md", "exec"), names)
        image = names["image"]
        self.assertEqual((image.shape, image.dtype), ((512, 512, 4), np.float32))
        written = tetcast.read_image("gyroid.png")
        self.assertLess(np.abs(written - image).max(), 0.502 / 255)
        red, green, blue = (image[..., i] for i in range(3))
        self.assertGreater((red > blue + 0.3).mean(), 0.05)  # the field's largest values
        self.assertGreater((blue > red + 0.3).mean(), 0.05)  # and its least
        self.assertGreater((image.min(axis=-1) == 1).mean(), 0.3)  # the background

    def test_the_reference_s_examples_do_not_run(self):
        names = {}
        points, cells = cube(6)
        tetcast.Mesh(points, cells, 100 * points[:, 2], name="temperature").save("data.vtu")
        found = examples("docs/python.md")
        self.assertGreater(len(found), 3)
        for code in found:
            exec(compile(code, "docs/python.md", "exec"), names)
        for name in re.findall(r'"(\w+\.png)"', "".join(found)):
            self.assertTrue(os.path.exists(name), name)


if __name__ == "__main__":
    unittest.main()
