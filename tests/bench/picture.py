"""Float pictures, premultiplied RGBA, row 0 at the top: raw with a JSON side-car, and TIFF that `tetcast compare` reads."""

import json
import struct

import numpy


def write_raw(path, rgba):
    """rgba: float32 [height][width][4] to path, its shape to path + ".json"."""
    rgba.astype("<f4").tofile(path)
    with open(path + ".json", "w", encoding="utf-8") as file:
        json.dump({"width": rgba.shape[1], "height": rgba.shape[0], "channels": "RGBA", "type": "float32",
                   "byte_order": "little", "first_row": "top", "alpha": "premultiplied"}, file)


def read_raw(path):
    with open(path + ".json", encoding="utf-8") as file:
        shape = json.load(file)
    return numpy.fromfile(path, "<f4").reshape(shape["height"], shape["width"], 4)


def write_tiff(path, rgba):
    """One uncompressed strip of 32-bit floats; tags by TIFF 6.0, section 8; ExtraSamples 1: associated alpha."""
    height, width, _ = rgba.shape
    pixels = rgba.astype("<f4").tobytes()
    shorts = [struct.pack("<4H", 32, 32, 32, 32), struct.pack("<4H", 3, 3, 3, 3)]  # bits, sample format
    at = 8 + len(pixels)
    tags = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 4, at), (259, 3, 1, 1), (262, 3, 1, 2), (273, 4, 1, 8),
            (277, 3, 1, 4), (278, 4, 1, height), (279, 4, 1, len(pixels)), (284, 3, 1, 1), (338, 3, 1, 1),
            (339, 3, 4, at + 8)]
    with open(path, "wb") as file:
        file.write(struct.pack("<2sHI", b"II", 42, at + 16))
        file.write(pixels)
        file.write(b"".join(shorts))
        file.write(struct.pack("<H", len(tags)))
        for tag, kind, count, value in tags:
            file.write(struct.pack("<HHII", tag, kind, count, value))
        file.write(struct.pack("<I", 0))


def difference(a, b):
    """Mean and largest absolute difference over channels of the pixels that either picture covers."""
    covered = (a[..., 3] > 0) | (b[..., 3] > 0)
    if not covered.any():
        return {"covered": 0}
    d = numpy.abs(a[covered].astype("f8") - b[covered])
    return {"covered": int(covered.sum()), "mean_abs": float(d.mean()), "max_abs": float(d.max()),
            "p999_abs": float(numpy.quantile(d, 0.999))}
