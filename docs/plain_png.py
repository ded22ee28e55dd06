#!/usr/bin/python3
"""Takes the texts out of PNG files, in place: tetcast's name the files that a picture was made of by where they were.

  docs/plain_png.py FILE.png ...
"""

import os
import struct
import sys

SIGNATURE = b"\x89PNG\r\n\x1a\n"
TEXTS = (b"tEXt", b"iTXt", b"zTXt", b"tIME")


def plain(path):
    with open(path, "rb") as file:
        data = file.read()
    if not data.startswith(SIGNATURE):
        sys.exit(f"{path} is no PNG file")
    out, at = [SIGNATURE], len(SIGNATURE)
    while at + 12 <= len(data):
        end = at + 12 + struct.unpack(">I", data[at:at + 4])[0]
        if data[at + 4:at + 8] not in TEXTS:
            out.append(data[at:end])
        at = end
    with open(path + ".part", "wb") as file:
        file.write(b"".join(out))
    os.replace(path + ".part", path)


if __name__ == "__main__":
    for name in sys.argv[1:]:
        plain(name)
