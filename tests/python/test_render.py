"""Pictures from Python are right: against closed forms, the program, and each other."""

import logging
import os
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import tetcast
from support import cube, run

PARALLEL = tetcast.Camera((0.5, 0.5, 5), (0.5, 0.5, 0.5), (0, 1, 0), parallel_projection=True, parallel_scale=0.75)
ONE = dict(camera=PARALLEL, window_size=(33, 33), opacity_stop=1)  # the middle ray crosses a length of 1


def middle(mesh, **options):
    image = tetcast.render(mesh, **{**ONE, **options})
    return image[image.shape[0] // 2, image.shape[1] // 2]


class ClosedForms(unittest.TestCase):
    def test_opacity_of_a_constant_field_is_not_the_closed_form(self):
        points, cells = cube(3)
        mesh = tetcast.Mesh(points, cells, np.full(len(points), 2.0))
        for a, unit in ((0.7, 0.5), (3, 2), (0, 1)):
            alpha = 1 - np.exp(-a * 1 / unit)
            got = middle(mesh, opacity=a, opacity_unit_distance=unit, cmap=[[1, 0, 0], [0, 0.5, 1]])
            np.testing.assert_allclose(got, alpha * np.array([0.5, 0.25, 0.5, 1 if alpha else 0]), atol=2e-6)

    def test_the_unit_distance_is_not_paraview_s(self):
        points, cells = cube(3)
        mesh = tetcast.Mesh(points, cells, np.zeros(len(cells)), "cell")
        self.assertAlmostEqual(mesh.unit_distance, 3**0.5 / len(cells)**(1 / 3))
        self.assertAlmostEqual(float(middle(mesh, opacity=0.3)[3]), 1 - np.exp(-0.3 / mesh.unit_distance), delta=2e-6)

    def test_values_over_clim_and_pairs_are_laid_elsewhere(self):
        points, cells = cube(2)
        mesh = tetcast.Mesh(points, cells, points[:, 2])  # s goes from 1 to 0 along the ray
        one = dict(opacity_unit_distance=1)
        depth = lambda **options: -np.log1p(-float(middle(mesh, **one, **options)[3]))
        self.assertAlmostEqual(depth(opacity=[0, 2]), 1, delta=1e-5)
        self.assertAlmostEqual(depth(opacity=[0, 2, 0]), 1, delta=1e-5)
        self.assertAlmostEqual(depth(opacity=[0, 2], clim=(0, 0.5)), 0.5 + 1, delta=1e-5)
        self.assertAlmostEqual(depth(opacity=[[0, 0], [0.25, 2], [0.25, 4], [1, 4]]), 0.25 + 3, delta=1e-5)
        self.assertAlmostEqual(depth(opacity="0:0,1:2"), 1, delta=1e-5)
        np.testing.assert_allclose(  # the front half is blue
            middle(mesh, **one, opacity=50.0, cmap=[[0, 1, 0, 0], [0.5, 1, 0, 0], [0.5, 0, 0, 1], [1, 0, 0, 1]]),
            [0, 0, 1, 1], atol=1e-5)

    def test_colours_in_an_array_are_laid_elsewhere_than_a_map_s(self):
        colors = np.array([[0.1, 0.9, 0.3], [0.8, 0.2, 0.4], [0.3, 0.3, 1]])
        at = np.linspace(2, 4, 3)
        want = tetcast.TransferFunction(colors, 0.5, (2, 4)).knots
        for cmap, clim in ((np.column_stack([at, colors]), None), (np.column_stack([at - 2, colors]), (2, 4)),
                           (lambda x: np.column_stack([np.interp(x, [0, 0.5, 1], c) for c in (*colors.T, 1 - at)]), (2, 4))):
            knots = tetcast.TransferFunction(cmap, 0.5, clim, data_range=(-7, 9)).knots
            for channel in (1, 2, 3, 4):
                np.testing.assert_allclose(np.interp(np.linspace(2, 4, 9), knots[:, 0], knots[:, channel]),
                                           np.interp(np.linspace(2, 4, 9), want[:, 0], want[:, channel]), atol=0.005)
        np.testing.assert_allclose(np.interp(3, want[:, 0], want[:, 1]), 0.8, atol=1e-12)

    def test_a_logarithmic_function_is_laid_elsewhere(self):
        tf = tetcast.TransferFunction([[0, 0, 0], [1, 1, 1]], [0, 1, 0], (1, 100), log_scale=True)
        at = lambda s, channel: np.interp(s, tf.knots[:, 0], tf.knots[:, channel])
        self.assertAlmostEqual(at(10, 1), 0.5, delta=0.01)
        self.assertAlmostEqual(at(10, 4), 1, delta=0.01)
        self.assertAlmostEqual(at(100, 4), 0, delta=1e-9)
        knots = [[1, 0, 0, 0], [10, 1, 1, 1], [1000, 0, 0, 0]]
        tf = tetcast.TransferFunction(knots, 1.0, log_scale=True, data_range=(1, 5))
        self.assertAlmostEqual(at(10, 1), 1, delta=0.01)
        self.assertAlmostEqual(at(100, 1), 0.5, delta=0.01)

    def test_row_0_is_not_the_top_or_width_is_height(self):
        points, cells = cube()
        image = tetcast.render(tetcast.Mesh(points, cells, points[:, 1]), cmap=[[1, 0, 0], [0, 0, 1]], opacity=9.0,
                               camera=PARALLEL, window_size=(60, 30))
        self.assertEqual(image.shape, (30, 60, 4))
        self.assertGreater(image[6, 30, 2], image[6, 30, 0])
        self.assertGreater(image[24, 30, 0], image[24, 30, 2])


class SamePixels(unittest.TestCase):
    def test_the_program_makes_another_picture(self):
        mesh = tetcast.synth("heatsink", 4000)
        with tempfile.TemporaryDirectory() as folder:
            data, picture = os.path.join(folder, "a.vtu"), os.path.join(folder, "a.png")
            mesh.save(data)
            run("render", data, "--size", "160x120", "--azimuth", "30", "--elevation", "20", "--color-map", "Viridis",
                "--opacity", "20:0.2,60:3", "--range", "20,70", "--shade", "vertex", "--samples", "4", "-o", picture)
            camera = mesh.camera(window_size=(160, 120))
            camera.azimuth(30)
            camera.elevation(20)
            options = dict(cmap="viridis", opacity=[(20, 0.2), (60, 3)], clim=(20, 70), shade=True, samples=4,
                           camera=camera, window_size=(160, 120))
            image = tetcast.render(mesh, **options)
            np.testing.assert_array_equal(tetcast.render(tetcast.read(data), **options), image)
            written = tetcast.read_image(picture)
            self.assertEqual(written.shape, (120, 160, 4))
            self.assertGreater((image[..., 3] > 0.1).sum(), 1000)
            levels = tetcast.to_uint8(image)
            levels[levels[..., 3] == 0] = 0  # a colour that cannot be seen is not read
            np.testing.assert_array_equal(np.rint(tetcast.straight(written) * 255).astype(np.uint8), levels)
            tetcast.save(image, os.path.join(folder, "b.png"), {"made by": "Python"})
            np.testing.assert_array_equal(tetcast.read_image(os.path.join(folder, "b.png")), written)
            tetcast.save(image, os.path.join(folder, "c.png"), bits=16, level=9)
            np.testing.assert_allclose(tetcast.read_image(os.path.join(folder, "c.png")), image, atol=1.01 / 65535)

    def test_a_background_is_not_behind_the_picture(self):
        mesh = tetcast.synth("kuhn")
        plain = tetcast.render(mesh, window_size=(40, 40))
        for color, numbers in (("white", (1, 1, 1, 1)), ("#3366cc", (0.2, 0.4, 0.8, 1)), ((0.5, 0, 1, 0.5), (0.25, 0, 0.5, 0.5))):
            want = plain + (1 - plain[..., 3:]) * np.array(numbers, np.float32)
            np.testing.assert_allclose(tetcast.render(mesh, window_size=(40, 40), background=color), want, atol=1e-6)

    def test_camera_positions_are_not_pyvista_s(self):
        points, cells = cube(2)
        mesh = tetcast.Mesh(points, cells, points @ [1.0, 2.0, 4.0])
        small = dict(window_size=(48, 48), opacity=2.0)
        for cpos, direction, up in (("xy", (0, 0, 1), (0, 1, 0)), ("xz", (0, -1, 0), (0, 0, 1)),
                                    ("yz", (1, 0, 0), (0, 0, 1)), ("zy", (-1, 0, 0), (0, 1, 0)),
                                    ("iso", (1, 1, 1), (0, 0, 1))):
            camera = mesh.camera(cpos)
            away = np.subtract(camera.position, camera.focal_point)
            np.testing.assert_allclose(away / np.linalg.norm(away), direction / np.linalg.norm(direction), atol=1e-12)
            np.testing.assert_allclose(camera.focal_point, (0.5, 0.5, 0.5))
            self.assertEqual(camera.view_up, tuple(map(float, up)))
            want = tetcast.render(mesh, camera=camera, **small)
            np.testing.assert_array_equal(tetcast.render(mesh, camera=cpos, **small), want)
            np.testing.assert_allclose(
                tetcast.render(mesh, camera=(camera.position, camera.focal_point, up), **small), want, atol=1e-5)
        moved = mesh.camera()
        moved.azimuth(90)
        np.testing.assert_allclose(np.subtract(moved.position, moved.focal_point) > 0.1, (True, False, False))
        self.assertNotEqual(moved.position, mesh.camera().position)
        parallel = mesh.camera(parallel_projection=True)
        self.assertTrue(parallel.parallel_projection and parallel.parallel_scale > 0.5)
        parallel.zoom(2)
        self.assertAlmostEqual(parallel.parallel_scale * 2, mesh.camera(parallel_projection=True).parallel_scale)

    def test_settings_of_a_look_do_nothing(self):
        points, cells = cube(4)
        mesh = tetcast.Mesh(points, cells, ((points - 0.5)**2).sum(1), name="r2")
        pictures = [tetcast.render(mesh, window_size=(40, 40), opacity=0.4, camera="iso", **options) for options in (
            {}, dict(shade=True), dict(shade="cell"), dict(shade=True, ambient=0.9), dict(shade=True, specular=1, specular_power=3),
            dict(model="mip"), dict(model="xray"), dict(model="isosurface", isosurfaces=0.2), dict(isosurfaces=[0.1, 0.2]),
            dict(opacity_unit_distance=0.1), dict(log_scale=True, clim=(0.01, 1)), dict(cmap="Turbo"), dict(samples=16))]
        for i, a in enumerate(pictures):
            for b in pictures[:i]:
                self.assertGreater(np.abs(a - b).max(), 1e-3, i)

    def test_missing_values_are_not_shown_as_asked(self):
        points, cells = cube(3)
        mesh = tetcast.Mesh(points, cells, np.full(len(cells), np.nan))
        self.assertEqual(float(middle(mesh)[3]), 0)
        shown = middle(mesh, nan_color=(0, 1, 0), nan_opacity=2, opacity_unit_distance=1)
        np.testing.assert_allclose(shown, (1 - np.exp(-2)) * np.array([0, 1, 0, 1]), atol=1e-5)
        masked = np.ma.masked_greater(points[:, 0], 0.5)
        self.assertEqual(tetcast.Mesh(points, cells, masked).report["nonfinite_scalars"], masked.mask.sum())


class Kept(unittest.TestCase):
    def test_what_stays_is_sent_again(self):
        renderer = tetcast.Renderer()
        points, cells = cube(6)
        mesh = tetcast.Mesh(points, cells, points[:, 0])
        renderer.render(mesh, window_size=(32, 32), count=True)
        first = renderer.stats
        self.assertGreater(first["gpu_bytes_sent"], 0)
        self.assertEqual(first["fragments_per_pass"][0], first["rays"])
        self.assertGreater(first["ms_table"], 0)
        function = renderer._transfer
        renderer.render(mesh, window_size=(32, 32), camera="iso")
        self.assertEqual(renderer.stats["gpu_bytes_sent"], 0)
        self.assertIs(renderer._transfer, function)
        self.assertFalse({"ms_pack", "ms_upload", "ms_table", "fragments_per_pass"} & set(renderer.stats), renderer.stats)
        renderer.render(mesh, window_size=(32, 32), opacity="linear")
        self.assertIsNot(renderer._transfer, function)

        old = renderer.render(mesh, window_size=(32, 32))
        mesh.set_scalars(1 - points[:, 0])
        new = renderer.render(mesh, window_size=(32, 32))
        self.assertLess(0, renderer.stats["gpu_bytes_sent"])
        self.assertLess(renderer.stats["gpu_bytes_sent"], 0.3 * first["gpu_bytes_sent"])
        fresh = tetcast.Mesh(points, cells, 1 - points[:, 0]).render(window_size=(32, 32))
        np.testing.assert_allclose(new, fresh, atol=1e-6)
        self.assertGreater(np.abs(new - old).max(), 0.01)
        mesh.set_scalars(np.arange(len(cells)))
        self.assertEqual(mesh.report["association"], "cell")
        self.assertEqual(mesh.scalar_range, (0, len(cells) - 1))

    def test_two_renderers_disturb_each_other(self):
        a, b = tetcast.Renderer(), tetcast.Renderer(driver="reference", threads=1)
        sink, ball = tetcast.synth("heatsink", 3000), tetcast.synth("ball", 3000)
        size = dict(window_size=(24, 24), opacity_stop=1)
        want = [b.render(sink, **size), b.render(ball, cmap="Turbo", **size)]
        for _ in range(2):
            np.testing.assert_allclose(a.render(sink, **size), want[0], atol=4e-3)
            np.testing.assert_array_equal(b.render(ball, cmap="Turbo", **size), want[1])
            np.testing.assert_allclose(a.render(ball, cmap="Turbo", **size), want[1], atol=4e-3)
        self.assertEqual((b.stats["driver"], a.stats["rays_lost"]), ("reference", 0))
        image = a.render(ball, window_size=(64, 64))
        wrong = a.verify(image, 500)
        self.assertEqual(wrong["pixels"], 500)
        self.assertLess(wrong["max_abs_error"], 4e-3)
        with self.assertRaisesRegex(tetcast.Error, "only the last picture"):
            a.verify(want[0])

    def test_a_renderer_of_another_kind_of_context_disturbs_one(self):
        mesh, size = tetcast.synth("ball", 2000), dict(window_size=(32, 32))
        for kinds in (("egl", "osmesa"), ("osmesa", "egl")):
            try:
                a, b = (tetcast.Renderer(gl=kind) for kind in kinds)
            except tetcast.Error as error:
                self.assertEqual(error.status, "TC_E_GL")
                self.skipTest(str(error))
            want = a.render(mesh, **size)
            np.testing.assert_allclose(b.render(mesh, **size), want, atol=4e-3)
            np.testing.assert_array_equal(a.render(mesh, **size), want)
            b.close()
            np.testing.assert_array_equal(a.render(mesh, **size), want)

    def test_steps_and_arrays_of_a_file_are_not_read(self):
        points, cells = cube(2)
        with tempfile.TemporaryDirectory() as folder:
            names = [os.path.join(folder, name) for name in ("a.vtu", "b.vtu", "c.vtu")]
            tetcast.Mesh(points, cells, points[:, 0], name="heat").save(names[0])
            tetcast.Mesh(points, cells, 3 * points[:, 0], name="heat").save(names[1])
            tetcast.Mesh(2 * points, cells, points[:, 0], name="heat").save(names[2])
            mesh = tetcast.read(names[0], "heat")
            self.assertEqual((mesh.n_points, mesh.n_cells, mesh.scalar_range), (27, 48, (0, 1)))
            self.assertEqual(mesh.source["arrays"][0], ("heat", "point"))
            handle = mesh._handle
            mesh.read_values("heat", path=names[1])
            self.assertEqual((mesh.scalar_range, mesh._handle is handle), ((0, 3), True))
            mesh.read_values("heat", path=names[2])
            self.assertEqual((mesh.scalar_range, mesh.bounds), ((0, 1), (0, 2, 0, 2, 0, 2)))
            self.assertGreater(mesh.render(window_size=(16, 16))[8, 8, 3], 0)
            with self.assertRaisesRegex(tetcast.Error, "cold.*heat|heat.*cold"):
                tetcast.read(names[0], "cold")


class Threads(unittest.TestCase):
    def test_other_python_threads_wait_while_a_picture_is_made(self):
        mesh = tetcast.synth("ball", 50000)
        renderer = tetcast.Renderer(driver="reference", threads=1)
        ticks, done = [], threading.Event()

        def tick():
            while not done.wait(0.002):
                ticks.append(time.monotonic())

        other = threading.Thread(target=tick)
        other.start()
        size, spent = 64, 0
        while spent < 0.5 and size < 4096:  # long enough to be told from a pause
            begin = time.monotonic()
            renderer.render(mesh, window_size=(size, size))
            end = time.monotonic()
            size, spent = 2 * size, end - begin
        done.set()
        other.join()
        self.assertTrue([t for t in ticks if begin + 0.2 * spent < t < end - 0.2 * spent])

    def test_threads_make_other_pictures(self):
        mesh = tetcast.synth("heatsink", 3000)
        want = tetcast.render(mesh, window_size=(48, 48))
        pictures = {}

        def work(i):
            for _ in range(3):
                pictures[i] = tetcast.render(mesh, window_size=(48, 48))

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(pictures), 4)
        for picture in pictures.values():
            np.testing.assert_array_equal(picture, want)

    def test_a_renderer_of_another_thread_is_used(self):
        renderer, caught = tetcast.Renderer(driver="reference"), []

        def work():
            try:
                renderer.render(tetcast.synth("kuhn"))
            except tetcast.Error as error:
                caught.append(str(error))

        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        self.assertRegex(caught[0], "belongs to the thread that made it")


class Talk(unittest.TestCase):
    def test_warnings_are_lost_or_raised_through_c(self):
        image = tetcast.render(tetcast.synth("kuhn"), model="emission", window_size=(16, 16))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.png")
            with self.assertWarnsRegex(tetcast.Warning, "more light than opacity") as caught:
                tetcast.save(image, path)
            self.assertEqual(caught.filename, __file__)
            os.remove(path)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                self.assertRaises(tetcast.Warning, tetcast.save, image, path)
            self.assertTrue(os.path.exists(path))

    def test_talk_does_not_reach_the_logger(self):
        with self.assertLogs("tetcast", logging.DEBUG) as logs:
            tetcast.Renderer()
        self.assertTrue(all(record.levelno <= logging.INFO for record in logs.records))

    def test_a_program_that_ends_with_everything_alive_fails(self):
        import subprocess
        code = ("import tetcast, threading\n"
                "mesh = tetcast.synth('kuhn'); image = tetcast.render(mesh, window_size=(16, 16))\n"
                "r = tetcast.Renderer(); keep = r.render(mesh, window_size=(16, 16))\n"
                "t = threading.Thread(target=lambda: tetcast.render(mesh, window_size=(16, 16))); t.start()\n")
        done = subprocess.run([sys.executable, "-X", "dev", "-c", code], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
