"""Arrays in and out: nothing is copied that need not be, memory lives as long as it is used and no longer, and wrong input
is refused in a sentence."""

import gc
import itertools
import os
import tempfile
import tracemalloc
import unittest

import numpy as np

import _tetcast as c
import tetcast
from support import cube, resident


def spied(name, action):
    """Arguments of the calls of a function of the library, or of _tetcast, during action()."""
    seen, real = [], getattr(c, name)

    def spy(*arguments):
        seen.append(arguments)
        return real(*arguments)

    setattr(c, name, spy)
    try:
        action()
    finally:
        setattr(c, name, real)
    return seen


class Copies(unittest.TestCase):
    def test_arrays_of_the_right_type_are_copied_in_python(self):
        points, cells = cube(40)
        scalars = points[:, 0].copy()
        for array in (points, cells, scalars):
            array.flags.writeable = False
        made = []
        tracemalloc.start()
        calls = spied("call", lambda: made.append(tetcast.Mesh(points, cells, scalars)))
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        arrays = next(arguments[2]._obj for arguments in calls if arguments[0] == "tc_mesh_create")
        self.assertEqual([arrays.vertex, arrays.tet, arrays.scalar], [a.ctypes.data for a in (points, cells, scalars)])
        self.assertLess(peak, 0.2 * scalars.nbytes)

        calls = spied("call", lambda: made[0].set_scalars(scalars))
        self.assertEqual(next(a[2].value for a in calls if a[0] == "tc_mesh_set_scalar"), scalars.ctypes.data)

    def test_a_picture_is_copied_in_python(self):
        mesh = tetcast.synth("kuhn")
        tetcast.render(mesh, window_size=(512, 512))
        tracemalloc.start()
        image = tetcast.render(mesh, window_size=(512, 512), background="black")
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        self.assertEqual((image.shape, image.dtype, image.nbytes), ((512, 512, 4), np.float32, 4 << 20))
        self.assertFalse(image.flags.owndata)
        self.assertTrue(image.flags.writeable and image.flags.c_contiguous)
        self.assertLess(peak, 0.1 * image.nbytes)

    def test_saving_a_picture_copies_it_in_python(self):
        image = tetcast.render(tetcast.synth("kuhn"), window_size=(64, 64))
        with tempfile.TemporaryDirectory() as folder:
            calls = spied("call", lambda: tetcast.save(image, os.path.join(folder, "a.png")))
        self.assertEqual(calls[0][1]._obj.rgba, image.ctypes.data)

    def test_other_types_and_orders_give_another_picture(self):
        points, cells = cube(4)
        scalars = points @ [1.0, 2.0, 3.0]
        want = tetcast.Mesh(points, cells, scalars).render(window_size=(64, 64))
        others = [
            (points.astype(">f8"), cells.astype(np.int64), scalars.tolist()),
            (np.asfortranarray(points), cells.astype(np.uint16), np.repeat(scalars, 2)[::2]),
            (points.tolist(), cells.astype(np.uint64), scalars.astype(np.float64).reshape(5, 5, 5).ravel()),
        ]
        for other in others:
            np.testing.assert_array_equal(tetcast.Mesh(*other).render(window_size=(64, 64)), want)


class Lifetime(unittest.TestCase):
    def test_a_picture_ends_with_its_mesh_or_renderer(self):
        renderer = tetcast.Renderer(driver="reference", threads=1)
        mesh = tetcast.synth("kuhn")
        image = renderer.render(mesh, opacity=3.0, window_size=(64, 64))
        part = image[10:20, 10:20]
        want = image.copy()
        renderer.close()
        del renderer, mesh, image
        gc.collect()
        tetcast.render(tetcast.synth("kuhn"), window_size=(64, 64))  # would write over what was freed
        np.testing.assert_array_equal(part, want[10:20, 10:20])
        self.assertGreater(part[..., 3].max(), 0)
        np.testing.assert_array_equal(part.base, want)

    def test_the_library_s_objects_are_not_freed_or_freed_twice(self):
        freed = []
        real = c.free

        def work():
            points, cells = cube(2)
            with tetcast.Renderer(driver="reference", threads=1) as renderer:
                image = renderer.render(tetcast.Mesh(points, cells), window_size=(8, 8))
                renderer.close()
            del image

        c.free = lambda destroy, address: (freed.append((destroy, address)), real(destroy, address))
        try:
            work()
            gc.collect()
        finally:
            c.free = real
        self.assertEqual(sorted(name for name, _ in freed),
                         ["tc_image_destroy", "tc_mesh_destroy", "tc_renderer_destroy", "tc_transfer_destroy"])

    def test_memory_grows_with_the_number_of_pictures(self):
        mesh = tetcast.synth("kuhn")
        for _ in range(5):
            tetcast.render(mesh)
        before = resident()
        for i in range(100):  # 4 MiB each, each with a function of its own
            tetcast.render(mesh, opacity=[0, 1 + i])
        self.assertLess(resident() - before, 30 << 20)

    def test_memory_grows_with_the_number_of_meshes_and_values(self):
        points, cells = cube(20)
        values = points[:, 0].copy()

        def one():
            mesh = tetcast.Mesh(points, cells, values)
            mesh.set_scalars(values + 1)
            return tetcast.render(mesh, window_size=(16, 16))

        for _ in range(5):
            one()
        before = resident()
        for _ in range(25):  # 48 000 tetrahedra each, some 3 MB
            one()
        self.assertLess(resident() - before, 30 << 20)


class Refused(unittest.TestCase):
    def refused(self, sentence, function, *arguments, **options):
        with self.assertRaises(ValueError) as caught:
            function(*arguments, **options)
        self.assertIsInstance(caught.exception, tetcast.Error)
        self.assertRegex(str(caught.exception), sentence)

    def test_wrong_meshes_are_taken(self):
        points, cells = cube()
        bad = points.copy()
        bad[3, 1] = np.nan
        far = points.copy()
        far[5, 0] = np.inf
        self.refused(r"points: 1 of 8 are not finite, the first is 3", tetcast.Mesh, bad, cells)
        self.refused(r"the first is 5", tetcast.Mesh, far, cells)
        self.refused(r"points has the shape \(8, 2\); n x 3 is needed", tetcast.Mesh, points[:, :2], cells)
        self.refused(r"points has the shape \(24,\)", tetcast.Mesh, points.ravel(), cells)
        self.refused(r"numbers are needed, not complex", tetcast.Mesh, points * 1j, cells)
        self.refused(r"numbers are needed", tetcast.Mesh, [["a", "b", "c"]], cells)
        self.refused(r"n x 4 point ids", tetcast.Mesh, points, cells[:, :3])
        self.refused(r"give cells\[:, 1:\]", tetcast.Mesh, points, np.insert(cells, 0, 4, axis=1))
        self.refused(r"whole numbers are needed, not float64", tetcast.Mesh, points, cells * 1.0)
        self.refused(r"scalars has 5 values; the mesh has 8 points and 6 cells", tetcast.Mesh, points, cells, np.ones(5))
        self.refused(r"values of cells were asked for", tetcast.Mesh, points, cells, np.ones(8), "cell")
        self.refused(r"scalars has the shape \(8, 1\)", tetcast.Mesh, points, cells, np.ones((8, 1)))
        self.refused(r"association is 'points'; it can be 'point', 'cell'", tetcast.Mesh, points, cells, None, "points")
        self.refused(r"reentry is 'x'", tetcast.Mesh, points, cells, reentry="x")

    def test_ids_out_of_range_are_taken(self):
        points, cells = cube()
        for kind, wrong in itertools.product((np.int32, np.int64), (8, -1)):
            ids = cells.astype(kind)
            ids[4, 2] = wrong
            with self.assertRaisesRegex(tetcast.Error, r"\b4\b.*"):
                tetcast.Mesh(points, ids)
        ids = cells.astype(np.int64)
        ids[2, 1] += 1 << 32  # the same id in 32 bits
        self.refused(r"cell 2 ", tetcast.Mesh, points, ids)

    def test_wrong_new_values_are_taken(self):
        mesh = tetcast.Mesh(*cube())
        self.refused(r"scalars has 7 values", mesh.set_scalars, np.ones(7))
        self.refused(r"use set_scalars", mesh.read_values)
        self.refused(r"is of a file|has \d+ values", tetcast.synth("kuhn").set_scalars, np.ones(7))

    def test_wrong_settings_of_a_picture_are_taken(self):
        mesh = tetcast.Mesh(*cube(), np.arange(8.0))

        def refused(sentence, **options):
            self.refused(sentence, tetcast.render, mesh, **options)

        refused(r"no colour map \"Viridos\".*Viridis", cmap="Viridos")
        refused(r"cmap has the shape \(3, 2\)", cmap=np.zeros((3, 2)))
        refused(r"must ascend; .* give cmap\[:, :3\]", cmap=[[1, 0, 0, 1], [0, 1, 0, 1]])
        refused(r"colours must lie in 0 … 1", cmap=[[0, 0, 0], [255, 0, 0]])
        refused(r"finite and not below 0", opacity=[0, -1])
        refused(r"opacity", opacity="steep")
        refused(r"opacity_unit_distance is 0; a length above 0", opacity_unit_distance=0)
        refused(r"clim is 2, 1; it must be finite and ascending", clim=(2, 1))
        refused(r"log_scale needs scalars above 0", log_scale=True)
        refused(r"window_size is 512", window_size=512)
        refused(r"window_size is \(0, 5\)", window_size=(0, 5))
        refused(r"background is 'whitish'", background="whitish")
        refused(r"background is \(1, 2, 3\)", background=(1, 2, 3))
        refused(r"camera is 'up'|cpos is 'up'", camera="up")
        refused(r"camera is \[1, 2\]", camera=[1, 2])
        refused(r"samples is 3; it can be 1, 4, 16, 'adaptive'", samples=3)
        refused(r"integrator is 'best'", integrator="best")
        refused(r"model is 'fog'", model="fog")
        refused(r"ambient: there is light only with shade=True", ambient=0.5)
        refused(r"TransferFunction, which has its own", cmap=tetcast.TransferFunction(), opacity=1.0)
        self.refused(r"mesh is a str", tetcast.render, "mesh.vtu")
        self.refused(r"driver", tetcast.Renderer, driver="fast")

    def test_wrong_pictures_are_written(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.png")
            self.refused(r"\(4, 4, 4\) of uint8; H x W x 4 floats", tetcast.save, np.zeros((4, 4, 4), np.uint8), path)
            self.refused(r"\(4, 4, 3\)", tetcast.save, np.zeros((4, 4, 3), np.float32), path)
            self.refused(r"gif", tetcast.save, np.zeros((4, 4, 4), np.float32), os.path.join(folder, "a.gif"))
            with self.assertRaises(tetcast.Error) as caught:
                tetcast.save(np.zeros((4, 4, 4)), os.path.join(folder, "no", "a.png"))
            self.assertEqual(caught.exception.status, "TC_E_FILE")
            with self.assertRaisesRegex(tetcast.Error, "missing.vtu"):
                tetcast.read(os.path.join(folder, "missing.vtu"))
            self.assertEqual(os.listdir(folder), [])

    def test_a_closed_renderer_is_used(self):
        renderer = tetcast.Renderer(driver="reference")
        renderer.close()
        renderer.close()
        self.refused("closed", renderer.render, tetcast.synth("kuhn"))


if __name__ == "__main__":
    unittest.main()
